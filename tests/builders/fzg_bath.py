"""FZG test box with C-type gears (16/24, m_n 4.5, a 91.5) in an oil bath; heights from the shaft centres."""

import math

from dynamics.losses.immersion import DippedGear, OilBath, RunningGear

MODULE = 4.5e-3
PINION_SPEED = 2170.0 * math.pi / 30.0
CENTRE_VOLUME, LOW_VOLUME = 1.25e-3, 0.75e-3
"""Oil in the box with the level at the shaft centres and 20 mm below [m3] (assumed)."""


def gear(teeth: int, shift: float, tip_radius: float, face_width: float) -> DippedGear:
    """Gear on a shaft of 30 mm, dedendum 1.25 modules."""
    return DippedGear(
        tip_radius=tip_radius,
        pitch_radius=0.5 * MODULE * teeth,
        root_radius=MODULE * (0.5 * teeth - 1.25 + shift),
        face_width=face_width,
        normal_module=MODULE,
        teeth=teeth,
        axis_height=0.0,
        shaft_radius=15e-3,
    )


def stage(face_width: float = 14e-3, pinion_speed: float = PINION_SPEED) -> tuple[RunningGear, RunningGear]:
    """Pinion and wheel with the tip diameters 82.46 and 118.36 mm."""
    return (
        RunningGear(place="test/pinion", gear=gear(16, 0.1817, 41.23e-3, face_width), speed=pinion_speed),
        RunningGear(
            place="test/wheel", gear=gear(24, 0.1715, 59.18e-3, face_width), speed=-pinion_speed * 16.0 / 24.0
        ),
    )


def bath(level: float = 0.0, volume: float = CENTRE_VOLUME, hydraulic_length: float | None = 0.1) -> OilBath:
    """FVA 3A at 90 degC: 842 kg/m3, 13.9 mm2/s."""
    return OilBath(
        level=level,
        volume=volume,
        density=842.0,
        viscosity=842.0 * 13.92e-6,
        hydraulic_length=hydraulic_length,
    )

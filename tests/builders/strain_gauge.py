"""Measuring points and synthetic records of P1's kind for tests."""

import math

import numpy as np

from rigdesign.strain_gauge.gauge import Bridge, StrainGauge
from rigdesign.strain_gauge.measuring_point import GaugePlacement, MeasuringPoint, RootRegion, SurfaceStress

STEEL = SurfaceStress(youngs_modulus=206e9, poisson_ratio=0.3)
REGION = RootRegion(face_width=25e-3, fillet_start=-2e-3, fillet_end=2e-3)
SPEED = 100.0 * math.pi / 30.0
"""P1's quasi-static speed [rad/s]."""


def gauge(**changes: object) -> StrainGauge:
    """A small chain gauge; P1 prints neither its k nor its grid."""
    return StrainGauge(**{"gauge_factor": 2.0, "grid_length": 0.6e-3, "grid_width": 1.0e-3, **changes})


def bridge(**changes: object) -> Bridge:
    """P1's circuit: one gauge and a passive resistor, three lines."""
    return Bridge(**{"kind": "half_passive", "gauge": gauge(), "supply_voltage": 5.0, **changes})


def measuring_point(name: str = "II", **changes: object) -> MeasuringPoint:
    """In the tooth root of P1's 25 mm wide pinion."""
    parts = {
        "bridge": bridge(), "surface": STEEL, "placement": GaugePlacement(face_position=-5e-3), "region": REGION,
    }  # fmt: skip
    return MeasuringPoint(name=name, **{**parts, **changes})


def root_stress(angle: np.ndarray) -> np.ndarray:
    """125 N/mm² at 0.35 rad of every turn, compression before and after it, none on the far side [Pa]."""
    place = np.mod(angle + math.pi, 2.0 * math.pi) - math.pi

    def bump(height: float, centre: float, width: float) -> np.ndarray:
        return height * np.exp(-(((place - centre) / width) ** 2))

    return bump(125e6, 0.35, 0.09) + bump(-12e6, 0.75, 0.1) + bump(-7e6, -0.05, 0.08)


def wandering_angle(time: np.ndarray, speed: float = SPEED) -> np.ndarray:
    """Angle of a speed that wanders by 5 % over seconds and by 1 % at about once a turn [rad]."""
    slow, quick = 2.0 * math.pi * 0.15, 0.9 * speed
    swing = 0.05 * (1.0 - np.cos(slow * time)) / slow + 0.01 * np.sin(quick * time) / quick
    return 0.3 + speed * (time + swing)


def wandering_speed(time: np.ndarray, speed: float = SPEED) -> np.ndarray:
    """Its derivative [rad/s]."""
    slow, quick = 2.0 * math.pi * 0.15, 0.9 * speed
    return speed * (1.0 + 0.05 * np.sin(slow * time) + 0.01 * np.cos(quick * time))

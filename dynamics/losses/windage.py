"""Drag of gears, discs and shafts in the air-oil mist of a gear chamber.

Default law: both faces as smooth rotating discs plus the impact of the mist on the tooth flanks,

    P = rho omega^3 R^5 / 2 (C_disc + C_teeth) ,

each part with the density of the mist as the marked assumption (1 to 20 times air). Dawson's expression is
not offered: as printed in W it gives a 1 m gear less than the skin friction of a smooth disc, and gears of
100 mm are outside his tests. The correlations of Diab and of Anderson and Loewenthal are for comparison: the first
is fitted to dry air and narrow gears, the second has a mist of one part oil in 34 of air built in, whatever the
chamber holds. The default keeps the density visible; it puts the tooth part in proportion to the face width, which
no test supports beyond `WIDTH_RANGE`: on a gear of 98 x 80 mm at 12,000 rpm in 5 kg/m3 it gives 1.5 times Anderson
and Loewenthal, on gears of 99 x 7 and 101 x 15 mm 1.1 and 0.9 times; on one of 225 x 140 mm in 2 kg/m3 2.8 times.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from dynamics.losses.loss import Loss, LossError

if TYPE_CHECKING:
    from dynamics.gear.pair import GearPair

LAMINAR_LIMIT = 3e5
"""omega R^2 / nu at which the boundary layer of a free disc turns turbulent (Schlichting)."""
DENSITY_RANGE = (0.5, 25.0)
"""Hot air to an oily mist about 20 times as dense [kg/m3]."""
WIDTH_RANGE = (0.08, 0.78)
"""Face width over pitch radius of the gears behind the tooth part (Diab et al.) [-]."""


@dataclass(frozen=True, kw_only=True)
class GearRotor:
    """Gear as the mist sees it.

    pitch_radius, tip_radius, face_width : [m]
    teeth : number of teeth
    tip_space_angle : angle open between two tooth tips, 2 pi / z minus tip thickness / tip radius [rad]
    free_faces : side faces exposed to the mist, 0 to 2; a face against its twin or a wall is not
    shielding : factor on the tooth part, 0.5 with flanges at both sides (Diab et al.), 1 without [-]
    """

    pitch_radius: float
    tip_radius: float
    face_width: float
    teeth: int
    tip_space_angle: float
    free_faces: int = 2
    shielding: float = 1.0

    def __post_init__(self) -> None:
        for name in ("pitch_radius", "tip_radius", "face_width", "teeth", "tip_space_angle"):
            value = getattr(self, name)
            if not value > 0.0:
                raise LossError(f"windage: {name} = {value:.6g}: must be above 0; correct the gear data")
        if not 0 <= self.free_faces <= 2:
            raise LossError(
                f"windage: free_faces = {self.free_faces}: must be 0, 1 or 2; a gear has two sides"
            )
        if not 0.0 <= self.shielding <= 1.0:
            raise LossError(f"windage: shielding = {self.shielding}: must lie within 0 to 1; it is a share")

    @classmethod
    def of_pair(cls, pair: "GearPair", index: int, free_faces: int = 2, shielding: float = 1.0) -> Self:
        """Pinion (index 0) or wheel (1) of a gear pair; the pitch radius is the reference radius."""
        gear = pair.gears[index]
        return cls(
            pitch_radius=gear.reference_radius,
            tip_radius=gear.tip_radius,
            face_width=pair.face_widths[index],
            teeth=pair.teeth[index],
            tip_space_angle=2.0 * math.pi / pair.teeth[index] - gear.tip_thickness / gear.tip_radius,
            free_faces=free_faces,
            shielding=shielding,
        )


@dataclass(frozen=True, kw_only=True)
class Mist:
    """What fills the chamber: density of the mixture [kg/m3], dynamic viscosity of its air [Pa s]."""

    density: float
    viscosity: float

    def __post_init__(self) -> None:
        if not (self.density > 0.0 and self.viscosity > 0.0):
            raise LossError(
                f"chamber mist: density = {self.density} kg/m3, viscosity = {self.viscosity} Pa s: both "
                "must be above 0; take air properties times the assumed factor"
            )

    def reynolds(self, omega: float, radius: float) -> float:
        """Reynolds number of a disc rho omega R^2 / eta [-]."""
        return self.density * abs(omega) * radius**2 / self.viscosity


def mist_density(air_density: float, oil_density: float, oil_volume_fraction: float) -> float:
    """Density of an air-oil mixture [kg/m3]; one part oil in 35 gives about 20 times air."""
    if not 0.0 <= oil_volume_fraction <= 1.0:
        raise LossError(f"oil volume fraction = {oil_volume_fraction}: must lie within 0 to 1; correct it")
    return (1.0 - oil_volume_fraction) * air_density + oil_volume_fraction * oil_density


def disc_coefficient(reynolds: float) -> float:
    """Moment coefficient 2 M / (rho omega^2 R^5) of both faces of a free disc [-].

    Laminar 3.87 Re^-0.5 (Cochran 1934), turbulent 0.146 Re^-0.2 (von Karman 1921), both in Schlichting,
    Boundary-Layer Theory; a turbulent disc keeps its laminar middle. Confidence high.
    """
    if reynolds <= 0.0:
        return 0.0
    if reynolds <= LAMINAR_LIMIT:
        return 3.87 / math.sqrt(reynolds)
    step = 0.146 * LAMINAR_LIMIT**-0.2 - 3.87 / math.sqrt(LAMINAR_LIMIT)
    turbulent: float = 0.146 * reynolds**-0.2 - step * (LAMINAR_LIMIT / reynolds) ** 2.5
    return turbulent


def tooth_coefficient(gear: GearRotor) -> float:
    """Coefficient of the impact on the teeth, to rho omega^3 R^5 / 2 at the pitch radius R [-].

    C = (z/4) (b/R) (R_tip/R)^4 (1 - cos phi) (1 + cos phi)^3, phi the tip space angle

    Source: Y. Diab, F. Ville, P. Velex, C. Changenet, Windage losses in high speed gears, ASME J. Mech. Des.
    126 (2004); gears of about 300 mm, 30 to 102 teeth. Confidence medium: it meets the correlation of
    the same authors within 10 % on their gears; no test is known at 100 mm.
    """
    cosine = math.cos(gear.tip_space_angle)
    shape = (1.0 - cosine) * (1.0 + cosine) ** 3
    ratio: float = (gear.tip_radius / gear.pitch_radius) ** 4
    return gear.shielding * 0.25 * gear.teeth * gear.face_width / gear.pitch_radius * ratio * shape


def gear_windage(place: str, gear: GearRotor, omega: float, mist: Mist) -> Loss:
    """Windage of one gear: friction of its free faces and impact on its teeth [W].

    place : name in the rig; omega : [rad/s], its sign does not matter; mist : what the gear rotates in

    Source: free disc (Schlichting, Boundary-Layer Theory) at the tip radius, tooth impact (Diab et al. 2004) at the
    pitch radius. Numbers outside the tests behind them are said in the warnings of the loss.
    """
    speed = abs(omega)
    reynolds = mist.reynolds(speed, gear.tip_radius)
    disc = 0.25 * gear.free_faces * mist.density * speed**3 * gear.tip_radius**5 * disc_coefficient(reynolds)
    teeth = 0.5 * mist.density * speed**3 * gear.pitch_radius**5 * tooth_coefficient(gear)
    return Loss(
        place=place,
        kind="windage",
        power=disc + teeth,
        details={
            "disc_power": disc,
            "tooth_power": teeth,
            "reynolds_number": reynolds,
            "mist_density": mist.density,
            "source": "free disc (Schlichting) plus tooth impact (Diab et al. 2004)",
        },
        warnings=_density_warning(mist) + _pitch_warning(gear) + _width_warning(gear),
    )


def shaft_windage(place: str, radius: float, length: float, omega: float, mist: Mist) -> Loss:
    """Windage of a smooth cylinder rotating in the open [W]: P = pi C rho omega^3 R^4 L.

    1 / sqrt(C) = -0.6 + 4.07 lg(Re sqrt(C)); laminar C = 4 / Re below Re = rho omega R^2 / eta of about 60.

    Source: T. Theodorsen, A. Regier, NACA Report 793 (1944), Re 70 to 4e5. Confidence high.
    """
    speed = abs(omega)
    reynolds = mist.reynolds(speed, radius)
    coefficient = _cylinder_coefficient(reynolds)
    return Loss(
        place=place,
        kind="windage",
        power=math.pi * coefficient * mist.density * speed**3 * radius**4 * length,
        details={
            "drag_coefficient": coefficient,
            "reynolds_number": reynolds,
            "mist_density": mist.density,
            "source": "Theodorsen and Regier, NACA Report 793",
        },
        warnings=_density_warning(mist),
    )


def anderson_loewenthal(pitch_radius: float, face_width: float, omega: float, oil_viscosity: float) -> float:
    """Windage of one gear in the oily mist of a jet-lubricated box [W], for comparison.

    P [kW] = 2.82e-7 (1 + 2.3 b/R) n^2.8 R^4.6 (0.028 eta + 0.019)^0.2     (m, 1/min, mPa s)

    The mist of 34 parts air and one part oil is built in. Source: N. E. Anderson, S. H. Loewenthal, NASA
    TP-1622 (1980). Confidence medium; radius [m], face width [m], omega [rad/s], viscosity [Pa s].
    """
    per_minute = abs(omega) * 30.0 / math.pi
    oil: float = (0.028 * oil_viscosity * 1e3 + 0.019) ** 0.2
    size: float = (1.0 + 2.3 * face_width / pitch_radius) * pitch_radius**4.6
    power: float = 2.82e-4 * size * per_minute**2.8 * oil
    return power


def _cylinder_coefficient(reynolds: float) -> float:
    """Drag coefficient of a free rotating cylinder by fixed-point steps on the implicit law."""
    if reynolds <= 0.0:
        return 0.0
    laminar = 4.0 / reynolds
    coefficient = 0.02
    for _ in range(100):
        bracket = -0.6 + 4.07 * math.log10(max(reynolds * math.sqrt(coefficient), 1.5))
        if bracket <= 0.0:
            return laminar
        better = 1.0 / bracket**2
        if abs(better - coefficient) < 1e-14:
            break
        coefficient = better
    return coefficient if reynolds > 60.0 else max(laminar, coefficient)


def _density_warning(mist: Mist) -> tuple[str, ...]:
    low, high = DENSITY_RANGE
    if low <= mist.density <= high:
        return ()
    return (
        f"chamber density = {mist.density:.3g} kg/m3: outside {low} to {high} kg/m3 (air to oily mist); "
        "scavenge the chamber or count churning instead of windage",
    )


def _pitch_warning(gear: GearRotor) -> tuple[str, ...]:
    if 30 <= gear.teeth <= 102 and 0.1 <= gear.pitch_radius <= 0.2:
        return ()
    return (
        f"windage: pitch radius = {gear.pitch_radius * 1e3:.1f} mm, {gear.teeth} teeth: the tooth part was "
        "tested at 100 to 200 mm and 30 to 102 teeth; judge it by the range of the chamber density",
    )


def _width_warning(gear: GearRotor) -> tuple[str, ...]:
    width = gear.face_width / gear.pitch_radius
    low, high = WIDTH_RANGE
    if low <= width <= high:
        return ()
    return (
        f"windage: face width / pitch radius = {width:.3g}: outside {low:g} to {high:g} of the tests behind the tooth "
        "part, which grows with the width here; compare it with Anderson and Loewenthal among the checks by hand",
    )

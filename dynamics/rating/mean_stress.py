"""Stress that a root holds at rest or at constant speed: centrifugal load of disc and teeth, press fit of the seat.

The gear is a disc of its root circle with its bore, in plane stress, and the teeth are a ring of half the density that
pulls at it. A rim on a web is held by less than such a disc: its stress is at least that of the rim as a free turning
ring at its mean radius, rho omega^2 r^2, with the teeth on it. That is a bound, as what the web holds is left out; the
seat keeps the pressure of the solid disc. The stress across the fillet is taken as the hoop stress at the root circle:
what the notch adds and what teeth that stand close take from it are both left out.
Source: rotating disc of constant thickness (Shigley and Mischke, Mechanical Engineering Design, 1989; Timoshenko and
Goodier, Theory of Elasticity, section 32), ring under pressure by Lame.
"""

from dataclasses import dataclass

from dynamics.errors import DynamicsInputError
from dynamics.standards.iso6336_3_2006 import IDLER_RATIO, Y_M

TOOTH_SHARE = 0.5
"""Share of the ring between root and tip circle that the teeth fill."""


@dataclass(frozen=True, kw_only=True)
class Solid:
    """Young's modulus [Pa], Poisson's ratio [-], density [kg/m3]."""

    young: float
    poisson: float
    density: float


@dataclass(frozen=True, kw_only=True)
class GearDisc:
    """A gear as a turning disc; lengths [m].

    bore : radius; 0 where the gear is one with its shaft
    rim : radial thickness of the rim under the root circle; None: solid down to the bore
    """

    bore: float
    root: float
    tip: float
    solid: Solid
    rim: float | None = None

    def __post_init__(self) -> None:
        if not 0.0 <= self.bore < self.root < self.tip:
            raise DynamicsInputError(
                f"gear disc: bore {1e3 * self.bore:.4g} mm, root {1e3 * self.root:.4g} mm, tip "
                f"{1e3 * self.tip:.4g} mm: radii must grow in this order; correct the bore diameter"
            )


@dataclass(frozen=True, kw_only=True)
class PressFit:
    """Seat of a gear on its shaft.

    interference : effective, on the diameter, at rest [m]; shaft_bore : radius of the hollow shaft, 0: solid [m]
    """

    interference: float
    shaft: Solid
    shaft_bore: float = 0.0


@dataclass(frozen=True, kw_only=True)
class MeanRootStress:
    """Tension along the root circle [Pa] by cause; disc : of the body, disc or rim."""

    disc: float
    teeth: float
    press_fit: float = 0.0

    @property
    def centrifugal(self) -> float:
        """Of body and teeth."""
        return self.disc + self.teeth

    @property
    def total(self) -> float:
        """Of all causes."""
        return self.disc + self.teeth + self.press_fit


def mean_stress_factor(R: float, M: float) -> float:  # noqa: N803
    """Y_M of ISO 6336-3:2006, Annex B, and below the stress ratio at which that ends.

    R : lowest over highest stress; M : slope of the Haigh diagram, `mean_stress_ratio`. Below R = -1.2 the straight
    line of the annex would go on to allow more amplitude the more the mean stress is compression, and Y_M of -1.2 for
    all of them still more: the amplitude that a root stands is held at that of -1.2, which is on the safe side.
    """
    if R >= -IDLER_RATIO:
        return Y_M(R, M)
    return Y_M(-IDLER_RATIO, M) * (1.0 + IDLER_RATIO) / (1.0 - R)


def mean_root_stress(gear: GearDisc, speed: float, fit: PressFit | None = None) -> MeanRootStress:
    """Hoop stress at the root circle of a gear that turns at ``speed`` [rad/s].

    With a rim, body and teeth have the bound of a free ring where that is above the disc.

    Raises DynamicsInputError for a press fit without a bore, or a shaft bore that is not inside the seat.
    """
    squared, pull = _share(gear), _pull(gear, speed)
    disc = _rotating(gear.solid, speed, near=gear.root, far=gear.bore)
    teeth = pull * (1.0 + squared) / (1.0 - squared)
    inner = gear.bore if gear.rim is None else gear.root - gear.rim
    if inner > gear.bore:
        ring = (inner / gear.root) ** 2
        disc = max(disc, gear.solid.density * (speed * 0.5 * (inner + gear.root)) ** 2)
        teeth = max(teeth, pull * (1.0 + ring) / (1.0 - ring))
    return MeanRootStress(
        disc=disc,
        teeth=teeth,
        press_fit=0.0 if fit is None else 2.0 * seat_pressure(gear, speed, fit) * squared / (1.0 - squared),
    )


def seat_pressure(gear: GearDisc, speed: float, fit: PressFit) -> float:
    """Pressure in the seat at speed [Pa]: the bore of the disc opens more than the shaft grows; 0 where it comes loose.

    Raises as `mean_root_stress`.
    """
    if not 0.0 <= fit.shaft_bore < gear.bore:
        raise DynamicsInputError(
            f"press fit: shaft bore {1e3 * fit.shaft_bore:.4g} mm and gear bore {1e3 * gear.bore:.4g} mm (radii): the "
            "shaft must fill the bore of the gear; state bore_diameter of the gear"
        )
    seat, squared, hollow = gear.bore, _share(gear), (fit.shaft_bore / gear.bore) ** 2
    at_bore = _rotating(gear.solid, speed, near=gear.bore, far=gear.root)
    at_bore += 2.0 * _pull(gear, speed) / (1.0 - squared)
    opening = seat * (
        at_bore / gear.solid.young
        - _rotating(fit.shaft, speed, near=seat, far=fit.shaft_bore) / fit.shaft.young
    )
    left = 0.5 * fit.interference - opening
    gear_part = ((1.0 + squared) / (1.0 - squared) + gear.solid.poisson) / gear.solid.young
    shaft_part = ((1.0 + hollow) / (1.0 - hollow) - fit.shaft.poisson) / fit.shaft.young
    return max(0.0, left / (seat * (gear_part + shaft_part)))


def _share(gear: GearDisc) -> float:
    return (gear.bore / gear.root) ** 2


def _rotating(solid: Solid, speed: float, *, near: float, far: float) -> float:
    """Hoop stress at the free edge ``near`` of a disc with the other edge ``far`` [Pa]; 0 for ``far``: no bore."""
    nu = solid.poisson
    return 0.25 * (3.0 + nu) * solid.density * speed**2 * (far**2 + (1.0 - nu) / (3.0 + nu) * near**2)


def _pull(gear: GearDisc, speed: float) -> float:
    """Radial tension of the teeth at the root circle [Pa]."""
    moment = (gear.tip**3 - gear.root**3) / 3.0
    return TOOTH_SHARE * gear.solid.density * speed**2 * moment / gear.root

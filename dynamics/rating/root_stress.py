"""Root stress over the path of contact: local lever by ISO 6336-3 factors, history from tooth forces.

The load of a tooth pair bends the tooth at whatever height it acts. Form and stress correction factor are
therefore taken at the load point of each path position instead of the one point that ISO 6336-3 rates, which
turns the mesh force history of one tooth into the stress history at its 30 degree tangent. No face spreading
and no share of neighbouring teeth: the line load at the root is that at the contact.
"""

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import MM, root_width, tooth_root
from dynamics.standards import iso6336_3_2006
from dynamics.standards.iso6336_3_2006 import IDLER_RATIO, Y_M

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class RootInfluence:
    """Stress at the 30 degree tangent of one gear per transverse line load at a path position.

    path : (n,) positions on the path from the pitch point, rising [m]
    value : (n,) stress per line load [Pa per N/m]
    width : face width of the root that carries the load [m]
    """

    path: Array
    value: Array
    width: float

    def at(self, path: ArrayLike) -> Array:
        """Influence at ``path`` positions [m], same shape [Pa per N/m]; held beyond the active path."""
        return np.asarray(np.interp(np.asarray(path, dtype=float), self.path, self.value))


def root_influence(pair: GearPair, index: int, *, n_path: int = 161) -> RootInfluence:
    """Local-lever root influence of gear ``index`` (0 pinion, 1 wheel) over the active path.

    sigma = F_bt/b cos(alpha_t)/m_n Y_F(s) Y_S(s) Y_beta (ISO 6336-3:2006, 5.2 with the load point moved); at
    the outer point of single contact this is the nominal stress of method B. Below the 30 degree section the
    value of the lowest load point above it is kept.
    """
    limits = pair.path
    root = tooth_root(pair, index)
    path = np.linspace(limits.start, limits.end, n_path)
    from_tip = limits.tip_end - path if index == 0 else path - limits.tip_start
    tip_roll = 0.5 * (root.d_an**2 - root.d_bn**2) ** 0.5
    roll = tip_roll - from_tip * MM / cos(pair.base_helix_angle)
    diameters = 2.0 * np.hypot(roll, 0.5 * root.d_bn)
    loaded = iso6336_3_2006.loaded_root(root, iso6336_3_2006.root_section(root), diameters)
    above = np.flatnonzero((loaded.h_Fe > 0.0) & (roll > 0.0))
    if not len(above):
        raise DynamicsInputError(
            f"gear {index}: no load point lies above its 30 degree section, so it has no bending lever; "
            "check addendum and root of both gears"
        )
    factors = np.zeros(n_path)
    factors[above] = loaded.Y_F[above] * loaded.Y_S[above]
    # the lowest load point of the pinion is at the start of the path, that of the wheel at its end
    factors[: above[0]] = factors[above[0]]
    factors[above[-1] + 1 :] = factors[above[-1]]
    helix = iso6336_3_2006.Y_beta(pair.overlap_ratio, root.beta)
    scale = cos(pair.transverse_pressure_angle) * helix / pair.gears[index].normal_module
    return RootInfluence(path=path, value=scale * factors, width=root_width(pair, index))


def root_stress_over_face(
    influence: RootInfluence, slice_forces: ArrayLike, path: ArrayLike, slice_shift: ArrayLike, width: float
) -> Array:
    """Root stress of one followed tooth by face slice [Pa], shape (n, n_slices).

    slice_forces : (n, n_slices) force of each slice [N]
    path : (n,) path position of the contact at mid-face [m]
    slice_shift : (n_slices,) lag of each slice on the path [m], as in ``MeshLaw``
    width : common face width [m]
    """
    loads = np.asarray(slice_forces, dtype=float)
    shift = np.asarray(slice_shift, dtype=float)
    if loads.ndim != 2 or loads.shape != (len(np.atleast_1d(path)), len(shift)):
        raise DynamicsInputError(
            f"slice_forces {loads.shape} must have a row for each of the {len(np.atleast_1d(path))} path "
            f"positions and a column for each of the {len(shift)} slices"
        )
    places = np.asarray(path, dtype=float)[:, None] - shift[None, :]
    return np.asarray(loads / (width / len(shift)) * influence.at(places))


# Stress that a root holds at rest or at constant speed: centrifugal load of disc and teeth, press fit of the seat.
#
# The gear is a disc of its root circle with its bore, in plane stress, and the teeth are a ring of half the density
# that pulls at it. A rim on a web is held by less than such a disc: its stress is at least that of the rim as a free
# turning ring at its mean radius, rho omega^2 r^2, with the teeth on it. That is a bound, as what the web holds is left
# out; the seat keeps the pressure of the solid disc. The stress across the fillet is taken as the hoop stress at the
# root circle: what the notch adds and what teeth that stand close take from it are both left out. Source: rotating disc
# of constant thickness (Shigley and Mischke, Mechanical Engineering Design, 1989; Timoshenko and Goodier, Theory of
# Elasticity, section 32), ring under pressure by Lame.

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

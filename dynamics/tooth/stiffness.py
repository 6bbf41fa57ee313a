"""Stiffness of one tooth pair over the path of contact: Weber and Banaschek's tooth, Hertzian flattening."""

from dataclasses import dataclass, replace
from math import cos, pi
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.gear.root_arc import ToothOutline, tooth_outline

Array = NDArray[np.float64]
Body = Literal["half_plane", "ring"]

SAINSOT: dict[str, tuple[float, float, float, float, float, float]] = {
    "L": (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
    "M": (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
    "P": (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
    "Q": (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
}
"""A .. F of L*, M*, P*, Q* (Sainsot, Velex, Duverger, ASME J. Mech. Des. 126 (2004), table 1)."""
RING_RATIO_RANGE = (1.4, 7.0)
ROOT_ANGLE_RANGE = (0.01, 0.12)


@dataclass(frozen=True, kw_only=True, eq=False)
class PairStiffness:
    """Stiffness of one tooth pair in the transverse line of action per unit face width.

    path : (n,) positions from the pitch point, rising, from the start to the end of the active path [m]
    value : (n,) stiffness [N/m per m = N/m2]
    base_pitch : transverse base pitch [m]
    """

    path: Array
    value: Array
    base_pitch: float
    warnings: tuple[str, ...] = ()

    def at(self, path: Array) -> Array:
        """Stiffness at ``path`` positions [m]; held at its end values beyond the active path."""
        return np.interp(path, self.path, self.value)

    @property
    def mesh_mean(self) -> float:
        """Mean over a base pitch of the sum of all pairs, rigid unmodified flanks [N/m2]."""
        return float(np.trapezoid(self.value, self.path)) / self.base_pitch

    def scaled(self, factor: float) -> Self:
        """The same stiffness with every value times ``factor`` (0.8: usual ratio of measured to calculated)."""
        if not factor > 0.0:
            raise DynamicsInputError(
                f"stiffness factor = {factor} must be positive; 1 leaves the stiffness as it is"
            )
        return replace(self, value=self.value * factor)

    def scaled_to(self, c_gamma_alpha: float) -> Self:
        """The same stiffness with the mesh mean ``c_gamma_alpha`` [N/m2] (1 N/(mm um) = 1e9 N/m2)."""
        return self.scaled(c_gamma_alpha / self.mesh_mean)


def pair_stiffness(
    pair: GearPair, line_load: float, *, n_path: int = 121, body: Body = "half_plane"
) -> PairStiffness:
    """Single-pair stiffness over the active path.

    ``line_load`` [N/m] is the transverse force per face width that flattens the contact (usually F_bt / b).
    ``body="ring"`` replaces the half plane under each tooth by the elastic ring of Sainsot et al. on the bore
    of the gear; out of its fitted range the result carries warnings. Raises DynamicsInputError for a load <= 0 or a
    ring without bore.
    """
    path = np.linspace(pair.path.start, pair.path.end, n_path)
    return PairStiffness(
        path=path,
        value=single_pair_stiffness(pair, path, line_load, body=body),
        base_pitch=pair.base_pitch,
        warnings=_ring_warnings(pair) if body == "ring" else (),
    )


def single_pair_stiffness(
    pair: GearPair, path: Array, line_load: float, *, body: Body = "half_plane"
) -> Array:
    """Stiffness of one tooth pair at ``path`` positions [m], per unit face width [N/m2].

    Bending, shear and body after Weber and Banaschek (VDI report 1953), bending counted from the root
    circle, the body's lever from the 30 degree tangent section; flattening after Weber (logarithmic form).
    A helical pair is taken in the normal section of its virtual spur gears and turned into the transverse
    plane with cos(beta_b).
    """
    if not line_load > 0.0:
        raise DynamicsInputError(
            f"line load = {line_load} N/m must be positive; the flattening depends on it"
        )
    cos_base = cos(pair.base_helix_angle)
    roll_1 = (path + pair.rolling_radii[0]) / cos_base
    roll_2 = (pair.rolling_radii[1] - path) / cos_base
    if not (np.all(roll_1 > 0.0) and np.all(roll_2 > 0.0)):
        raise DynamicsInputError(
            f"path positions {path.min():.6f}..{path.max():.6f} m must lie between the base tangent points "
            f"{-pair.rolling_radii[0]:.6f} and {pair.rolling_radii[1]:.6f} m; stay near the active path"
        )
    moduli = [(1.0 - nu**2) / e for nu, e in zip(pair.poisson_ratios, pair.youngs_moduli, strict=True)]
    radius = roll_1 * roll_2 / (roll_1 + roll_2)
    half_width = np.sqrt(4.0 * line_load * radius * sum(moduli) / pi)
    compliance = np.zeros_like(path)
    for index, roll in enumerate((roll_1, roll_2)):
        nu = pair.poisson_ratios[index]
        tooth, gear_body, depth = tooth_compliance(pair, index, roll, body=body)
        compliance += tooth
        compliance += gear_body
        compliance += moduli[index] / pi * (2.0 * np.log(2.0 * depth / half_width) - nu / (1.0 - nu))
    return cos_base / compliance


def tooth_compliance(
    pair: GearPair, index: int, roll: Array, *, body: Body = "half_plane"
) -> tuple[Array, Array, Array]:
    """Deflection of a tooth of gear ``index`` (0 pinion) without flattening, of the body under it, depth of its axis.

    roll : (n,) roll lengths in the normal section of the virtual spur gear [m]

    Returns the displacements along the normal per load per contact length by tooth and by body, (n,) [m2/N], and the
    distance from the flank to the tooth axis along the normal (n,) [m].
    """
    outline, nu = tooth_outline(pair.gears[index]), pair.poisson_ratios[index]
    modulus = (1.0 - nu**2) / pair.youngs_moduli[index]
    angle = roll / outline.base_radius - _half_base_angle(pair, index)
    tooth = _tooth_compliance(outline, angle, nu, modulus)
    if body == "ring":
        gear_body = _ring_compliance(pair, index, outline, angle)
    else:
        gear_body = _half_plane_compliance(outline, angle, nu, modulus)
    return tooth, gear_body, roll - outline.base_radius * np.tan(angle)


def _half_base_angle(pair: GearPair, index: int) -> float:
    """Half the angle of a tooth of the virtual gear on its base circle [rad]."""
    gear = pair.gears[index]
    base = 0.5 * gear.normal_module * gear.virtual_teeth * cos(gear.pressure_angle)
    return gear.virtual_half_angle(base)


def _lever(outline: ToothOutline, angle: Array, foot: float) -> Array:
    """Height of the load's crossing with the tooth axis above ``foot`` [m], not below zero."""
    return np.maximum(outline.base_radius / np.cos(angle) - foot, 0.0)


def _tooth_compliance(outline: ToothOutline, angle: Array, nu: float, modulus: float) -> Array:
    """Bending, shear and compression of the tooth, times unit face width [m2/N]."""
    foot = float(outline.y[0])
    lever = _lever(outline, angle, foot)
    y = np.linspace(0.0, float(lever.max()), 2001)
    thickness = 2.0 * np.interp(y + foot, outline.y, outline.x)
    moments = [cumulative_trapezoid(y**power / thickness**3, y, initial=0) for power in (0, 1, 2)]
    sums = [np.interp(lever, y, moment) for moment in moments]
    bending = lever**2 * sums[0] - 2.0 * lever * sums[1] + sums[2]
    shear = np.interp(lever, y, cumulative_trapezoid(1.0 / thickness, y, initial=0))
    tangent = np.tan(angle) ** 2
    total = 12.0 * bending + (2.4 / (1.0 - nu) + tangent) * shear
    return np.asarray(np.cos(angle) ** 2 * modulus * total)


def _half_plane_compliance(outline: ToothOutline, angle: Array, nu: float, modulus: float) -> Array:
    """Deflection of the body as an elastic half plane, times unit face width [m2/N]."""
    slenderness = _lever(outline, angle, outline.root_height) / outline.root_chord
    tilt = 18.0 / pi * slenderness**2 + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * slenderness
    shift = 4.8 / pi * (1.0 + (1.0 - nu) / 2.4 * np.tan(angle) ** 2)
    return np.asarray(np.cos(angle) ** 2 * modulus * (tilt + shift))


def _ring_shape(pair: GearPair, index: int) -> tuple[float, float]:
    """Root-to-bore ratio h and half root angle theta_f (of the 30 degree section) of one gear [-, rad]."""
    bore = 0.5 * pair.bore_diameters[index]
    if not bore > 0.0:
        raise DynamicsInputError(
            f"bore of gear {index + 1} = {pair.bore_diameters[index]} m must be positive for the ring body; give "
            "the bore"
        )
    outline = tooth_outline(pair.gears[index])
    return pair.gears[index].root_radius / bore, 0.5 * outline.root_chord / outline.root_radius


def _ring_compliance(pair: GearPair, index: int, outline: ToothOutline, angle: Array) -> Array:
    """Deflection of an elastic ring on its bore (Sainsot et al. 2004, equation 11) [m2/N]."""
    h, theta = _ring_shape(pair, index)
    terms = {
        name: a / theta**2 + b * h**2 + c * h / theta + d / theta + e * h + f
        for name, (a, b, c, d, e, f) in SAINSOT.items()
    }
    slenderness = _lever(outline, angle, outline.root_radius) / (2.0 * outline.root_radius * theta)
    shape = terms["L"] * slenderness**2 + terms["M"] * slenderness
    shape += terms["P"] * (1.0 + terms["Q"] * np.tan(angle) ** 2)
    return np.asarray(np.cos(angle) ** 2 * shape / pair.youngs_moduli[index])


def _ring_warnings(pair: GearPair) -> tuple[str, ...]:
    found = []
    for index, name in enumerate(("pinion", "wheel")):
        h, theta = _ring_shape(pair, index)
        for symbol, value, (low, high) in (
            ("root radius / bore radius", h, RING_RATIO_RANGE),
            ("half root angle [rad]", theta, ROOT_ANGLE_RANGE),
        ):
            if not low <= value <= high:
                found.append(
                    f"{name}: {symbol} = {value:.4f} outside {low}..{high} of the ring formula "
                    "(Sainsot et al. 2004); use the half plane"
                )
    return tuple(found)

"""Contact of the flanks along the path: curvature, speeds, line load, pressure. Basis of scuffing and micropitting.

Load sharing is that of ISO/TS 6336-20 and -22 (method B). A tooth contact analysis may give its own `line_load`
instead: what follows from it does not change.
"""

from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import MM, UM, tangential_force
from dynamics.standards import iso6336_2_2006 as iso
from dynamics.standards import iso6336_3_2006
from dynamics.standards import iso_ts_6336_20_2017 as scuffing
from dynamics.standards.iso6336_1_2006 import DynamicFactor, RunIn

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ContactFactors:
    """K factors of ISO 6336 for contact: application, dynamic, face load and transverse load factor."""

    application: float = 1.0
    dynamic: float = 1.0
    face_load: float = 1.0
    """K_Hbeta."""
    transverse: float = 1.0
    """K_Halpha."""

    @property
    def product(self) -> float:
        """All of them."""
        return self.application * self.dynamic * self.face_load * self.transverse


@dataclass(frozen=True, kw_only=True)
class FlankLoad:
    """Operating point of a mesh.

    torque, speed : of the pinion, both above 0 [N m], [rad/s]; pinion_drives : whether it gives the power
    factors : what raises the local load over the nominal one
    grade : ISO 1328-1 flank tolerance class of the coarser gear
    tip_reliefs : C_a of pinion and wheel [m]; optimum : C_eff, the relief the load asks for [m]
    """

    torque: float
    speed: float
    pinion_drives: bool = True
    factors: ContactFactors = ContactFactors()
    grade: int = 5
    tip_reliefs: tuple[float, float] = (0.0, 0.0)
    optimum: float = 0.0

    def __post_init__(self) -> None:
        for name in ("torque", "speed"):
            value = getattr(self, name)
            if not value > 0.0:
                raise DynamicsInputError(
                    f"flank load: {name} = {value:g}: must be above 0; rate an operating point that turns under load"
                )

    @property
    def relief_shares(self) -> tuple[float, float]:
        """C_a/C_eff of wheel and pinion, at most 1: what is relieved at A and at E [-]."""
        if self.optimum <= 0.0:
            return (0.0, 0.0)
        pinion, wheel = (min(relief / self.optimum, 1.0) for relief in self.tip_reliefs)
        return wheel, pinion


@dataclass(frozen=True)
class FlankContact:
    """A gear pair under a load; path positions count from the pitch point, growing to the pinion tip [m]."""

    pair: GearPair
    load: FlankLoad

    @property
    def base_load(self) -> float:
        """Nominal transverse load in the line of action over the common face width, F_bt/b [N/m]."""
        return self.load.torque / self.pair.base_radii[0] / self.pair.face_width

    @property
    def pitch_line_speed(self) -> float:
        """At the working pitch circle [m/s]."""
        return self.load.speed * self.pair.working_radii[0]

    @cached_property
    def reduced_modulus(self) -> float:
        """E_r = 2/sum((1 - nu^2)/E) [Pa]."""
        (e_1, e_2), (nu_1, nu_2) = self.pair.youngs_moduli, self.pair.poisson_ratios
        return 2.0 / ((1.0 - nu_1**2) / e_1 + (1.0 - nu_2**2) / e_2)

    @cached_property
    def points(self) -> dict[str, float]:
        """The seven points of ISO/TS 6336-22 by name: A, AB, B, C, D, DE, E [m]; C where it lies on the path."""
        path = self.pair.path
        start, end = path.start, path.end
        inner, outer = path.inner_single_contact, path.outer_single_contact
        positions = {
            "A": start,
            "AB": 0.5 * (start + inner),
            "B": inner,
            "C": 0.0,
            "D": outer,
            "DE": 0.5 * (outer + end),
            "E": end,
        }
        return {name: s for name, s in positions.items() if start <= s <= end}

    def radii(self, s: Array) -> tuple[Array, Array]:
        """Transverse radii of curvature of pinion and wheel flank [m], shape of ``s``."""
        reach_1, reach_2 = self.pair.rolling_radii
        return reach_1 + s, reach_2 - s

    def reduced_radius(self, s: Array) -> Array:
        """Relative radius of curvature in the normal section [m], shape of ``s``."""
        first, second = self.radii(s)
        return np.asarray(first * second / ((first + second) * cos(self.pair.base_helix_angle)))

    def rolling_speeds(self, s: Array) -> tuple[Array, Array]:
        """Speeds of both flanks along the profile [m/s], shape of ``s``."""
        first, second = self.radii(s)
        return self.load.speed * first, self.load.speed / self.pair.gear_ratio * second

    def path_parameter(self, s: Array) -> Array:
        """Gamma of ISO/TS 6336-20, path position over T1C [-]."""
        return np.asarray(s / self.pair.rolling_radii[0])

    @cached_property
    def parameters(self) -> scuffing.PathParameters:
        """Gamma of A, B, D, E."""
        path, reach = self.pair.path, self.pair.rolling_radii[0]
        return scuffing.PathParameters(
            A=path.start / reach,
            B=path.inner_single_contact / reach,
            D=path.outer_single_contact / reach,
            E=path.end / reach,
            AU=scuffing.BUTTRESS_LENGTH * sin(self.pair.base_helix_angle),
        )

    def sharing(self, s: Array) -> Array:
        """X_Gamma, share of the load of one tooth pair [-], shape of ``s``.

        Raises DynamicsInputError for a transverse contact ratio of 2 or more.
        """
        sharing = scuffing.Sharing(
            epsilon_alpha=self.pair.transverse_contact_ratio,
            epsilon_beta=self.pair.overlap_ratio,
            grade=self.load.grade,
            relief=self.load.relief_shares,
        )
        return scuffing.X_Gamma(self.path_parameter(s), self.parameters, sharing)

    def line_load(self, s: Array, least_share: float = 0.0) -> Array:
        """Normal load per length of contact with all K factors [N/m], shape of ``s``.

        The normal force is F_bt/cos(beta_b) and the contact line of a pair longer than b by the same: they cancel.

        least_share : share of the load that counts where the load sharing has less
        """
        return np.maximum(self.sharing(s), least_share) * self.base_load * self.load.factors.product

    def pressure(self, s: Array, least_share: float = 0.0) -> Array:
        """Hertzian pressure of that load [Pa], shape of ``s``."""
        loaded = self.line_load(s, least_share) * self.reduced_modulus / (2.0 * pi * self.reduced_radius(s))
        return np.asarray(np.sqrt(loaded))

    @property
    def sum_speed_factor(self) -> float:
        """Sum of both rolling speeds at the pitch point over the pitch line speed, 2 sin(alpha_wt) [-]."""
        return 2.0 * sin(self.pair.working_pressure_angle)

    @property
    def approach_excess(self) -> float:
        """C_eff less the tip relief of the driven gear [m]."""
        driven = 1 if self.load.pinion_drives else 0
        return self.load.optimum - self.load.tip_reliefs[driven]


def thermal_contact(conductivity: float, density: float, heat_capacity: float) -> float:
    """B_M = sqrt(lambda rho c) [W s^0.5/(m2 K)]; 13.6e3 for steels of gears."""
    return sqrt(conductivity * density * heat_capacity)


def single_contact_ratio(pair: GearPair, index: int) -> float:
    """M_1 or M_2 of ISO 6336-2: sqrt(rho_C/rho) at the inner point of single contact of pinion (0) or wheel (1) [-]."""
    reach_1, reach_2 = pair.rolling_radii
    s = pair.path.inner_single_contact if index == 0 else pair.path.outer_single_contact
    first, second = (reach_1 + s) / pair.base_radii[0], (reach_2 - s) / pair.base_radii[1]
    if min(first, second) <= 0.0:
        return 1.0
    return tan(pair.working_pressure_angle) / sqrt(first * second)


# Pitting load capacity of a gear pair, ISO 6336-2:2006 method B: SI in, SI out.

R_Z_OVER_RA = 6.0
"""R_z of a ground flank over its Ra (ISO 6336-2:2006, 12.3.3)."""


@dataclass(frozen=True, kw_only=True)
class FlankMaterials:
    """Both gears, pinion first.

    strengths : sigma_Hlim [Pa]; treatments : of their flanks; cycles : load cycles of one flank
    roughness : Ra [m]; hardness : Brinell hardness of a soft gear against a hard one; None: equally hard
    """

    strengths: tuple[float, float]
    cycles: tuple[float, float]
    roughness: tuple[float, float]
    treatments: tuple[RunIn, RunIn] = ("case_hardened", "case_hardened")
    hardness: float | None = None


@dataclass(frozen=True, kw_only=True)
class Pitting:
    """Contact stress and strength of one gear [Pa], with the factors by their printed symbols."""

    nominal: float
    """sigma_H0 at the pitch point."""
    stress: float
    """sigma_H at the inner point of single contact, or at the pitch point where that is higher."""
    strength: float
    """sigma_HG: pitting stress limit."""
    stress_factors: dict[str, float]
    """Z_H, Z_E [(N/mm2)^0.5], Z_epsilon, Z_beta and Z_B or Z_D."""
    strength_factors: dict[str, float]
    """Z_NT, Z_L, Z_v, Z_R, Z_W, Z_X."""

    @property
    def safety(self) -> float:
        """S_H = sigma_HG / sigma_H [-]."""
        return self.strength / self.stress

    @property
    def load_safety(self) -> float:
        """How many times its load the flank carries, S_H^2: stress grows with the root of the load [-]."""
        return self.safety**2


def pitting(
    pair: GearPair, load: FlankLoad, materials: FlankMaterials, viscosity_40: float
) -> tuple[Pitting, Pitting]:
    """Pitting rating of pinion and wheel.

    viscosity_40 : kinematic viscosity of the oil at 40 degC [m2/s]

    Raises DynamicsInputError for a load or a gear that gives no stress.
    """
    wanted = _stress_factors(pair)
    nominal = iso.sigma_H0(
        wanted["Z_H"] * wanted["Z_E"] * wanted["Z_epsilon"] * wanted["Z_beta"],
        tangential_force(pair, load.torque),
        2.0 * pair.reference_radii[0] * MM,
        pair.face_width * MM,
        pair.gear_ratio,
    )
    raised = nominal * sqrt(load.factors.product)
    first, second = (
        _pitting(pair, load, materials, viscosity_40, index, wanted, (nominal, raised)) for index in (0, 1)
    )
    return first, second


def _pitting(
    pair: GearPair, load: FlankLoad, materials: FlankMaterials, viscosity_40: float, index: int,
    wanted: dict[str, float], stresses: tuple[float, float],
) -> Pitting:  # fmt: skip
    contact = iso.Z_BD(single_contact_ratio(pair, index), pair.transverse_contact_ratio, pair.overlap_ratio)
    factors = permissible(pair, load, materials, viscosity_40, index)
    return Pitting(
        nominal=1e6 * stresses[0],
        stress=1e6 * contact * stresses[1],
        strength=materials.strengths[index] * factors.product,
        stress_factors=wanted | {("Z_B", "Z_D")[index]: contact},
        strength_factors=vars(factors).copy(),
    )


def _stress_factors(pair: GearPair) -> dict[str, float]:
    (e_1, e_2), (nu_1, nu_2) = pair.youngs_moduli, pair.poisson_ratios
    return {
        "Z_H": iso.Z_H(
            degrees(pair.transverse_pressure_angle),
            degrees(pair.working_pressure_angle),
            degrees(pair.base_helix_angle),
        ),
        "Z_E": iso.Z_E(1e-6 * e_1, nu_1, 1e-6 * e_2, nu_2),
        "Z_epsilon": contact_ratio_factor(pair),
        "Z_beta": iso.Z_beta(degrees(pair.helix_angle)),
    }


def contact_ratio_factor(pair: GearPair) -> float:
    """Z_epsilon of the active flanks [-]."""
    return iso.Z_epsilon(pair.transverse_contact_ratio, pair.overlap_ratio)


def permissible(
    pair: GearPair, load: FlankLoad, materials: FlankMaterials, viscosity_40: float, index: int
) -> iso.PermissibleFactors:
    """Factors between sigma_Hlim and sigma_HG of gear ``index`` (0 pinion, 1 wheel)."""
    softest = 1e-6 * min(materials.strengths)
    treatment = materials.treatments[index]
    reach_1, reach_2 = pair.rolling_radii
    roughness = R_Z_OVER_RA * UM * sum(materials.roughness) / 2.0
    return iso.PermissibleFactors(
        Z_NT=iso.Z_NT(materials.cycles[index], treatment),
        Z_L=iso.Z_L(viscosity_40 * 1e6, softest),
        Z_v=iso.Z_v(load.speed * pair.reference_radii[0], softest),
        Z_R=iso.Z_R(roughness, MM * reach_1 * reach_2 / (reach_1 + reach_2), softest),
        Z_W=iso.Z_W(materials.hardness),
        Z_X=iso.Z_X(pair.normal_module * MM, treatment),
    )


def transverse_load_factor(
    pair: GearPair, factor: DynamicFactor, *, dynamic: float = 1.0, face_load: float = 1.0
) -> float:
    """K_Halpha of ISO 6336-1:2006, 8.3.2, in the way of `iso_rating.transverse_load_factor`."""
    return iso.K_Halpha(
        pair.transverse_contact_ratio,
        pair.total_contact_ratio,
        contact_ratio_factor(pair),
        factor.stiffness.c_gamma_alpha,
        factor.f_pb_eff,
        factor.specific_load * dynamic * face_load,
    )


def face_load_factor(pair: GearPair, root_factor: float) -> float:
    """K_Hbeta that belongs to the K_Fbeta ``root_factor`` (ISO 6336-1:2006, 7.3), b/h of the lower of both [-]."""
    return iso.K_Hbeta(root_factor, _width_over_height(pair))


def root_face_load_factor(pair: GearPair, contact_factor: float) -> float:
    """K_Fbeta that follows from the K_Hbeta ``contact_factor`` (ISO 6336-1:2006, 7.3), b/h of the lower of both [-]."""
    return iso6336_3_2006.K_Fbeta(contact_factor, _width_over_height(pair))


def _width_over_height(pair: GearPair) -> float:
    """b/h of the gear with the higher teeth [-]."""
    heights = [tip - root for tip, root in zip(pair.tip_radii, pair.root_radii, strict=True)]
    return pair.face_width / max(heights)


def transverse_limits(pair: GearPair) -> tuple[float, float]:
    """Largest K_Halpha and K_Falpha (ISO 6336-1:2006, 8.3.4 and 8.3.5) [-]."""
    transverse, total = pair.transverse_contact_ratio, pair.total_contact_ratio
    return (
        iso.K_Halpha_limit(transverse, total, contact_ratio_factor(pair)),
        iso6336_3_2006.K_Falpha_limit(transverse, total),
    )

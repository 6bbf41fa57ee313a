"""Pitting load capacity of a gear pair, ISO 6336-2:2006 method B: SI in, SI out."""

from dataclasses import dataclass
from math import degrees, sqrt

from dynamics.gear.pair import GearPair
from dynamics.rating.flank_contact import FlankLoad, single_contact_ratio
from dynamics.rating.iso_rating import MM, UM, tangential_force
from dynamics.standards import iso6336_2_2006 as iso
from dynamics.standards import iso6336_3_2006
from dynamics.standards.iso6336_1_2006 import DynamicFactor, RunIn

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
        _one(pair, load, materials, viscosity_40, index, wanted, (nominal, raised)) for index in (0, 1)
    )
    return first, second


def _one(
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

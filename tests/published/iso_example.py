"""Rows of ISO/TR 6336-30:2017 example 1 (case V1 of the validation sheet), to the printed digits.

The values are those of the report as listed by the public MATLAB project gfsReboucas/Drivetrain. Its
c_gamma_alpha belongs to the contact ratio of the tip diameters rounded to 0.01 mm (159.66 and 872.35 mm):
with unrounded tips the last printed digits are missed.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import pi, radians

from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.pair import GearPair
from dynamics.rating.flank_contact import (
    ContactFactors,
    FlankLoad,
    FlankMaterials,
    pitting,
    transverse_load_factor,
)
from dynamics.rating.iso_rating import RatingOptions, dynamic_factor, mesh_data
from dynamics.standards import iso6336_3_2006
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from tests.published.rows import Gate, PublishedQuantity, ValidationRow, compare, compare_printed

SOURCE = "ISO/TR 6336-30 example 1"
TORQUE, SPEED = 9000.0, 360.0 * pi / 30.0
"""Pinion torque [N m] and speed [rad/s]."""
K_HBETA = 1.16
"""Face load factor as printed: an input of the ratings."""
HOURS = 50e3
FLANKS = FlankMaterials(
    strengths=(1500e6, 1500e6),
    cycles=(HOURS * 60.0 * 360.0, HOURS * 60.0 * 360.0 * 17.0 / 103.0),
    roughness=(1e-6, 1e-6),
)
"""Case-hardened gears of quality MQ, 50,000 h, Ra 1 um."""
VISCOSITY_40 = 320e-6
"""Of the oil [m2/s]."""
ROUNDED = Gate(1e-4)
"""Of stresses that are printed with K_V and K_Hbeta unrounded, which are known to three digits only."""


def example_1() -> GearPair:
    """The gear pair of the example."""
    return GearPair(
        normal_module=8e-3,
        helix_angle=radians(15.8),
        teeth=(17, 103),
        centre_distance=0.5,
        face_widths=(0.1, 0.1),
        profile_shifts=(0.145, 0.0),
        tip_diameters=(159.66e-3, 872.35e-3),
        racks=(Rack(dedendum=1.4, tip_radius=0.39),) * 2,
    )


def iso_example_rows() -> Iterator[ValidationRow]:
    """Gates on everything the tool models; K_Hbeta is an input."""
    pair = example_1()
    factor = dynamic_factor(pair, TORQUE, SPEED, RatingOptions(grade=5, tip_relief=70e-6))
    data = mesh_data(pair)
    printed = (
        ("F_t", "127352", factor.F_t, "N"),
        ("v", "2.664", factor.v, "m/s"),
        ("z_n1", "18.905", data.z_n1, "1"),
        ("z_n2", "114.543", data.z_n2, "1"),
        ("c'_th", "17.85584", factor.stiffness.c_prime_th, "N/(mm um)"),
        ("c'", "12.37047", factor.stiffness.c_prime, "N/(mm um)"),
        ("c_gamma_alpha", "17.46485", factor.stiffness.c_gamma_alpha, "N/(mm um)"),
        ("c_gamma_beta", "14.84512", factor.stiffness.c_gamma_beta, "N/(mm um)"),
        ("K_V", "1.003", factor.K_V, "1"),
    )
    for symbol, text, computed, unit in printed:
        yield compare_printed(
            _printed(symbol, text, unit),
            computed,
            assumptions="tip diameters rounded to 0.01 mm" if symbol.startswith("c_gamma") else "",
        )
    yield from _flank_rows(pair, factor)


def _flank_rows(pair: GearPair, factor: DynamicFactor) -> Iterator[ValidationRow]:
    """Pitting by ISO 6336-2, and the face load factors."""
    load = FlankLoad(
        torque=TORQUE,
        speed=SPEED,
        factors=ContactFactors(
            dynamic=factor.K_V,
            face_load=K_HBETA,
            transverse=transverse_load_factor(pair, factor, dynamic=factor.K_V, face_load=K_HBETA),
        ),
    )
    pinion, wheel = pitting(pair, load, FLANKS, VISCOSITY_40)
    heights = [tip - root for tip, root in zip(pair.tip_radii, pair.root_radii, strict=True)]
    wanted, allowed = pinion.stress_factors, pinion.strength_factors
    printed = (
        ("Z_H", "2.39533", wanted["Z_H"], "1"),
        ("Z_E", "189.8117", wanted["Z_E"], "(N/mm2)^0.5"),
        ("Z_epsilon", "0.803", wanted["Z_epsilon"], "1"),
        ("Z_beta", "1.01944", wanted["Z_beta"], "1"),
        ("Z_L", "1.04739", allowed["Z_L"], "1"),
        ("Z_v", "0.96911", allowed["Z_v"], "1"),
        ("Z_R", "0.96599", allowed["Z_R"], "1"),
        ("Z_NT1", "0.91", allowed["Z_NT"], "1"),
        ("Z_NT2", "0.962", wheel.strength_factors["Z_NT"], "1"),
        ("sigma_H0", "1206.58", 1e-6 * pinion.nominal, "MPa"),
        ("sigma_HP1", "1338.48", 1e-6 * pinion.strength, "MPa"),
        ("sigma_HP2", "1414.53", 1e-6 * wheel.strength, "MPa"),
    )
    for symbol, text, computed, unit in printed:
        yield compare_printed(_printed(symbol, text, unit), computed)
    for symbol, value, computed, unit in (
        ("sigma_H", 1301.35, 1e-6 * pinion.stress, "MPa"),
        ("S_H1", 1.02853, pinion.safety, "1"),
        ("S_H2", 1.08696, wheel.safety, "1"),
    ):
        yield compare(
            replace(_printed(symbol, None, unit), value=value), computed, "verification", ROUNDED,
            assumptions="K_V and K_Hbeta as printed, rounded to three digits",
        )  # fmt: skip
    yield compare(
        replace(_printed("K_Hbeta", None, "1"), value=K_HBETA), K_HBETA, "input",
        assumptions="input of the ratings: the shaft bending of method C is not computed",
    )  # fmt: skip
    yield compare(
        replace(_printed("K_Fbeta", None, "1"), value=1.12803),
        iso6336_3_2006.K_Fbeta(K_HBETA, pair.face_width / max(heights)),
        "verification", Gate(5e-4), assumptions="from K_Hbeta as printed, rounded to three digits",
    )  # fmt: skip


def _printed(symbol: str, text: str | None, unit: str) -> PublishedQuantity:
    return PublishedQuantity(
        id=f"TR6336-30-1-{symbol}", text=f"{symbol}, example 1", source=SOURCE, printed=text, unit=unit
    )

"""Rows of ISO/TR 6336-30:2017 example 1 (case V1 of the validation sheet), to the printed digits.

The values are those of the report as listed by the public MATLAB project gfsReboucas/Drivetrain. Its
c_gamma_alpha belongs to the contact ratio of the tip diameters rounded to 0.01 mm (159.66 and 872.35 mm):
with unrounded tips the last printed digits are missed.
"""

from collections.abc import Iterator
from math import pi, radians

from dynamics.gear.cylindrical_gear import Rack
from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import RatingOptions, dynamic_factor, mesh_data
from rigdesign.validation.rows import PublishedQuantity, ValidationRow, compare_printed, not_modelled

SOURCE = "ISO/TR 6336-30 example 1"
TORQUE, SPEED = 9000.0, 360.0 * pi / 30.0
"""Pinion torque [N m] and speed [rad/s]."""
PITTING = (
    ("Z_H", "2.39533"), ("Z_E", "189.8117"), ("Z_epsilon", "0.803"), ("Z_beta", "1.01944"), ("Z_L",
     "1.04739"),
    ("Z_v", "0.96911"), ("Z_R", "0.96599"), ("Z_NT", "0.91 / 0.962"), ("K_Hbeta", "1.16"), ("K_Fbeta",
     "1.12803"),
    ("sigma_H0", "1206.58"), ("sigma_H", "1301.35"), ("sigma_HP", "1338.48 / 1414.53"), ("S_H",
     "1.02853 / 1.08696"),
)  # fmt: skip


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
    """Gates on everything the tool models; the flank load capacity has no model yet."""
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
            PublishedQuantity(
                id=f"TR6336-30-1-{symbol}",
                text=f"{symbol}, example 1",
                source=SOURCE,
                printed=text,
                unit=unit,
            ),
            computed,
            assumptions="tip diameters rounded to 0.01 mm" if symbol.startswith("c_gamma") else "",
        )
    for symbol, text in PITTING:
        yield not_modelled(
            PublishedQuantity(
                id=f"TR6336-30-1-{symbol}",
                text=f"{symbol}, example 1",
                source=SOURCE,
                printed=text,
                unit="MPa" if symbol.startswith("sigma") else "1",
            ),
            "verification",
            reason="flank load capacity and face load factor (ISO 6336-1 clause 7, 6336-2) are not modelled",
        )

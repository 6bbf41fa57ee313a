"""Rows of P2's thermal model of the main rig (Figure 12): no case of that gearbox exists yet."""

from collections.abc import Iterator

from rigdesign.validation.rows import ValidationRow, not_modelled

REASON = (
    "no case of the main rig's gearbox: its housing, areas and materials are not printed; a fit would "
    "choose 12 parameters for 9 numbers"
)
NUMBERS = (
    ("P2-heat-field-convection", "convection of the clamping field", "1179", "W", "P2, Figure 12"),
    ("P2-heat-field-radiation-model", "radiation of the clamping field", "706", "W", "P2, Figure 12"),
    ("P2-heat-housing-warm", "convection of the warm housing", "800", "W", "P2, Figure 12"),
    ("P2-heat-housing-cold", "convection of the cold housing", "962", "W", "P2, Figure 12"),
    ("P2-heat-housing-radiation-model", "radiation of the housing", "617", "W", "P2, Figure 12"),
    ("P2-heat-bearings", "heat into the oil of the bearings", "345.23", "W", "P2, Figure 12"),
    ("P2-Tmax", "highest temperature of the test gearbox", "178.59", "degC", "P2, Figure 12"),
    ("P2-growth-pinion", "growth of the pinion shaft", "0.53", "mm", "P2, text"),
    ("P2-growth-wheel", "growth of the wheel shafts", "0.43", "mm", "P2, text"),
    ("P2-growth-seal-gap", "seal gap, hot", "still 0.6", "mm", "P2, text"),
)


def main_rig_rows() -> Iterator[ValidationRow]:
    """Every printed result of the thermal simulation."""
    for identity, quantity, published, unit, source in NUMBERS:
        yield not_modelled(
            id=identity, quantity=f"main rig, {quantity}", source=source, published=published, unit=unit,
            basis="fitted", reason=REASON, free_parameters=12,
        )  # fmt: skip

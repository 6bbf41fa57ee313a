"""Rule of the oil films on the teeth: every gear has one if they decide the split."""

from collections.abc import Iterator, Sequence

from rigdesign.base.errors import Fault
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import conditions_of
from rigdesign.case.housing import Housing
from rigdesign.case.surface_conditions import FlankFilm

GEAR_RIMS = "gear_*_rim"
"""Surfaces that stand for teeth."""


def flank_faults(name: str, gearbox: Gearbox, housing: Housing, names: Sequence[str]) -> Iterator[Fault]:
    """Rims without an oil film that the split of the friction heat needs.

    name : of the gearbox; names : every surface of the housing
    """
    at = f"gearboxes.{name}.housing.boundary"
    filmed = {
        surface
        for entry, surface, _ in conditions_of(housing, names)
        if isinstance(housing.boundary[entry], FlankFilm)
    }
    bare = [gear for gear, part in gearbox.gears.items() if f"gear_{part.shaft}_rim" not in filmed]
    if gearbox.heat_split.rule == "flank_film" and bare:
        yield Fault(
            f"gearboxes.{name}.heat_split.mesh", '"flank_film"',
            f"the rim of {' and '.join(bare)} has no flank film that could decide",
            f'write law = "flank_film" for gear_*_rim under {at}, or give mesh_into_gears',
        )  # fmt: skip

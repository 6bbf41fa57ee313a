"""Rules of the oil films on the teeth: where they may be, and that every gear has one if they decide the split."""

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase

from rigdesign.base.errors import Fault
from rigdesign.case.faults import written
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import conditions_of
from rigdesign.case.housing import FlankFilm, Housing

GEAR_RIMS = "gear_*_rim"
"""Surfaces that stand for teeth."""


def flank_faults(name: str, gearbox: Gearbox, housing: Housing, names: Sequence[str]) -> Iterator[Fault]:
    """Films on teeth that are no rims, coefficients too many or missing, rims without a film that the split needs.

    name : of the gearbox; names : every surface of the housing
    """
    at = f"gearboxes.{name}.housing.boundary"
    filmed = set()
    for entry, surface, _ in conditions_of(housing, names):
        if not isinstance(housing.boundary[entry], FlankFilm):
            continue
        if fnmatchcase(surface, GEAR_RIMS):
            filmed.add(surface)
        else:
            yield Fault(
                f"{at}.{entry}.surfaces", written(surface), "has no teeth",
                'law = "flank_film" is for gear_*_rim; write another law',
            )  # fmt: skip
    for entry, condition in housing.boundary.items():
        if isinstance(condition, FlankFilm):
            yield from _coefficient(f"{at}.{entry}", condition)
    bare = [gear for gear, part in gearbox.gears.items() if f"gear_{part.shaft}_rim" not in filmed]
    if gearbox.heat_split.rule == "flank_film" and bare:
        yield Fault(
            f"gearboxes.{name}.heat_split.mesh", '"flank_film"',
            f"the rim of {' and '.join(bare)} has no flank film that could decide",
            f'write law = "flank_film" for gear_*_rim under {at}, or give mesh_into_gears',
        )  # fmt: skip


def _coefficient(at: str, condition: FlankFilm) -> Iterator[Fault]:
    given = condition.heat_transfer_coefficient
    if condition.correlation == "constant" and given is None:
        yield Fault(
            f"{at}.heat_transfer_coefficient", "", 'correlation = "constant" needs it',
            'add it, e.g. heat_transfer_coefficient = "3000 W/(m2 K)"',
        )  # fmt: skip
    if condition.correlation != "constant" and given is not None:
        yield Fault(
            f"{at}.heat_transfer_coefficient", f"{given:g} W/(m2 K)",
            f'is not used: correlation = "{condition.correlation}" computes it',
            'remove it, or write correlation = "constant"',
        )  # fmt: skip

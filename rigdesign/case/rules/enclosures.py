"""Rules of the enclosures of a housing: which surfaces radiate at each other, and whether their view factors close."""

from collections.abc import Iterator, Mapping

import numpy as np

from rigdesign.base.errors import Fault
from rigdesign.case.enclosures import EnclosureInput
from rigdesign.case.faults import written
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import conditions_of, housing_geometry
from rigdesign.case.housing import Housing
from rigdesign.case.matching import matched
from rigdesign.case.paths import nearest
from rigdesign.case.surface_conditions import Insulated, ThermalRadiation
from thermal.conditions.view_factor_closure import EnclosureError, close_view_factors
from thermal.housing.surfaces import exact_areas


def enclosure_faults(name: str, gearbox: Gearbox, names: tuple[str, ...]) -> Iterator[Fault]:
    """What is wrong with the enclosures of a housing whose surfaces have ``names``."""
    housing = gearbox.housing
    assert housing is not None
    taken: dict[str, str] = {}
    for entry, enclosure in housing.enclosures.items():
        at = f"gearboxes.{name}.housing.enclosures.{entry}"
        surfaces = enclosure.emissivities(names)
        faults = [
            *_parts(at, enclosure, names),
            *_surfaces(at, entry, surfaces, taken),
            *_conditions(at, housing, tuple(surfaces), names),
        ]
        taken |= {surface: taken.get(surface, entry) for surface in surfaces}
        yield from faults
        if not faults and enclosure.view_factors != "computed":
            yield from _view_factors(at, enclosure, surfaces, gearbox)


def _parts(at: str, enclosure: EnclosureInput, names: tuple[str, ...]) -> Iterator[Fault]:
    """Patterns that name nothing, surfaces that two parts name."""
    owner: dict[str, str] = {}
    for part, entry in enclosure.parts.items():
        path = f"{at}.parts.{part}.surfaces"
        for pattern in entry.surfaces:
            if not matched([pattern], names):
                meant = nearest(pattern, names)
                hint = "did you mean " + " or ".join(meant) + "? " if meant else ""
                yield Fault(path, written(pattern), "no such surface", f"{hint}known: {', '.join(names)}")
        for surface in matched(entry.surfaces, names):
            if owner.setdefault(surface, part) != part:
                yield Fault(
                    path, written(surface), f"is in the part {owner[surface]} already", "name it once"
                )


def _surfaces(
    at: str, entry: str, surfaces: Mapping[str, float], taken: Mapping[str, str]
) -> Iterator[Fault]:
    """Too few surfaces, surfaces of another enclosure, none that radiates."""
    if len(surfaces) < 2:
        found = ", ".join(surfaces) or "none"
        yield Fault(
            at, "", f"needs two surfaces that radiate at each other, has {found}",
            'name a chamber of the box, or more surfaces in its parts; a lone surface takes law = "radiation"',
        )  # fmt: skip
    elif not any(surfaces.values()):
        yield Fault(at, "", "every emissivity is 0, nothing radiates", "write one above 0")
    for surface in surfaces:
        if surface in taken:
            yield Fault(
                at, written(surface), f"is a surface of the enclosure {taken[surface]} already",
                "name it in one of them",
            )  # fmt: skip


def _conditions(
    at: str, housing: Housing, surfaces: tuple[str, ...], names: tuple[str, ...]
) -> Iterator[Fault]:
    """Surfaces whose condition leaves no radiation to an enclosure."""
    for entry, surface, _ in conditions_of(housing, names):
        condition = housing.boundary[entry]
        if surface not in surfaces:
            continue
        if isinstance(condition, ThermalRadiation):
            yield Fault(
                at, written(surface), f"radiates to its surroundings by boundary.{entry} already",
                f"take it out of one of them, or give the enclosure an opening_temperature in place of {entry}",
            )  # fmt: skip
        elif isinstance(condition, Insulated):
            yield Fault(
                at, written(surface), f"passes no heat by boundary.{entry}",
                f"take it out of {entry}: the enclosure is a condition of its own; or write a film",
            )  # fmt: skip


def _view_factors(
    at: str, enclosure: EnclosureInput, surfaces: Mapping[str, float], gearbox: Gearbox
) -> Iterator[Fault]:
    """Given view factors: of the surfaces that take part, complete and reciprocal."""
    given = enclosure.view_factors
    assert given != "computed"
    path = f"{at}.view_factors"
    strange = set(given).union(*given.values()) - set(surfaces)
    if strange:
        yield Fault(
            path, written(", ".join(sorted(strange))), "is no surface of this enclosure",
            f"its surfaces: {', '.join(surfaces)}",
        )  # fmt: skip
        return
    housing = gearbox.housing
    assert housing is not None
    if housing.part_file is not None:
        return
    exact = exact_areas(housing_geometry(gearbox))
    areas = {surface: exact[surface] for surface in surfaces}
    rows = enclosure.rows(areas)
    assert rows is not None
    opening = enclosure.opening_temperature is not None
    try:
        close_view_factors(np.array(rows), np.array([*areas.values()]), list(surfaces), opening)
    except EnclosureError as error:
        problem, _, remedy = str(error).rpartition("; ")
        yield Fault(path, "", problem, remedy)

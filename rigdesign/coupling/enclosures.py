"""Chambers of a housing whose surfaces radiate at each other, as conditions of its temperature field."""

from collections.abc import Iterator

from rigdesign.rig.model import Rig
from thermal.conditions.enclosure import Enclosure

CHAMBER_RADIATION = "chamber_radiation"
"""Kind of their rows in the heat balance."""


def enclosure_conditions(rig: Rig, name: str) -> Iterator[Enclosure]:
    """Enclosures of the housing of gearbox ``name``; CaseError for view factors that do not close."""
    housing = rig.case.gearboxes[name].housing
    assert housing is not None
    for entry, enclosure in housing.enclosures.items():
        emissivities = enclosure.emissivities(rig.surface_names(name))
        surfaces = tuple(emissivities)
        opening = enclosure.opening_temperature
        at = f"gearboxes.{name}.housing.enclosures.{entry}.view_factors"
        views = rig.chamber_views
        rows = enclosure.rows(views.areas(name, surfaces))
        if rows is None:
            rows = views.between(name, surfaces, opening=opening is not None, at=at)
        else:
            views.require_closed(name, surfaces, rows, opening=opening is not None, at=at)
        yield Enclosure(
            name=entry,
            surfaces=surfaces,
            emissivities=tuple(emissivities.values()),
            view_factors=rows,
            opening_temperature=opening,
            kind=CHAMBER_RADIATION,
        )

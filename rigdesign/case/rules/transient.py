"""Rules of the thermal history: events once each, probes at places that exist."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.case.faults import unknown, written
from rigdesign.case.geometry import housing_geometry
from thermal.housing.surfaces import body_names, exact_areas

if TYPE_CHECKING:
    from rigdesign.case.model import Case


def transient_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with the table ``transient``; housings must be sound."""
    events = case.transient.events
    for event in dict.fromkeys(events):
        if events.count(event) > 1:
            yield Fault("transient.events", written(event), "is listed twice", "name each event once")
    for name, probe in case.transient.probes.items():
        at = f"transient.probes.{name}"
        box = case.gearboxes.get(probe.gearbox)
        if box is None:
            yield unknown(f"{at}.gearbox", probe.gearbox, case.gearboxes, "gearbox")
        elif box.housing is None:
            yield Fault(
                f"{at}.gearbox", written(probe.gearbox), "has no housing and so no temperature field",
                "name a gearbox with a housing",
            )  # fmt: skip
        else:
            geometry = housing_geometry(box)
            places = [*body_names(geometry), *exact_areas(geometry)]
            if probe.place not in places:
                yield unknown(f"{at}.place", probe.place, places, "surface or body")

"""Temperatures and clearances of one housing over the schedule or an event, and the limits they are held against."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.model import Case
from rigdesign.coupling.alignment import Alignment
from rigdesign.transient.clearances import Clearances, Quantity, smallest
from rigdesign.transient.phases import Timeline
from thermal.expansion.alignment import ShaftAxis

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Branch(Timeline):
    """Thermal history of one housing: over the schedule, or over what an event makes of it."""

    temperatures: Mapping[str, FloatArray]
    """Probe -> (n,) [K]."""
    clearances: tuple[Clearances, ...]
    """At every time."""
    alignment: tuple[Alignment, ...]
    """At every time."""
    axes: tuple[Mapping[str, ShaftAxis], ...]
    """Hot axis of every shaft at every time."""
    energy_closure: float
    warnings: tuple[str, ...]

    def ends(self, name: str) -> int:
        """Number of the last time of a phase."""
        number = [phase.name for phase in self.phases].index(name)
        return int(np.flatnonzero(self.phase == number)[-1])


def clearance_limits(case: Case) -> dict[Quantity, float]:
    """Least clearance of every kind the case limits [m]."""
    limits = case.limits.clearances
    films = any(bearing.has_film for box in case.gearboxes.values() for bearing in box.bearings.values())
    stated: dict[Quantity, float | None] = {
        "seal_gap": limits.seal_gap_minimum,
        "axial_play": limits.axial_play_minimum,
        "bearing_clearance": limits.bearing_clearance_minimum if films else None,
        "backlash": limits.backlash_minimum,
        "tip_clearance": limits.tip_clearance_minimum,
    }
    return {quantity: limit for quantity, limit in stated.items() if limit is not None}


def limited(case: Case, found: Clearances) -> Clearances:
    """Those that limits are for: clearances of plain bearings where the rig has any, else of its rolling bearings."""
    films = {
        f"{name}.{part}"
        for name, box in case.gearboxes.items()
        for part, bearing in box.bearings.items()
        if bearing.has_film
    }
    if not films:
        return found
    plain = {place: value for place, value in found["bearing_clearance"].items() if place in films}
    return {**found, "bearing_clearance": plain}


def broken(case: Case, found: Clearances) -> Iterator[tuple[Quantity, str, float]]:
    """Quantity, place and clearance [m] of every limit that does not hold at a moment."""
    held = limited(case, found)
    for quantity, limit in clearance_limits(case).items():
        if not held[quantity]:
            continue
        value, place = smallest(held, quantity)
        if value < limit:
            yield quantity, place, value

"""Limits of the case that clearances and temperatures are held against at every moment."""

from collections.abc import Iterator

from rigdesign.case.model import Case
from rigdesign.transient.clearances import Clearances, Quantity, smallest


def clearance_limits(case: Case) -> dict[Quantity, float]:
    """Least clearance of every kind the case limits [m]."""
    limits = case.limits.clearances
    stated: dict[Quantity, float | None] = {
        "seal_gap": limits.seal_gap_minimum,
        "axial_play": limits.axial_play_minimum,
        "bearing_clearance": limits.bearing_clearance_minimum,
        "backlash": limits.backlash_minimum,
        "tip_clearance": limits.tip_clearance_minimum,
    }
    return {quantity: limit for quantity, limit in stated.items() if limit is not None}


def broken(case: Case, found: Clearances) -> Iterator[tuple[Quantity, str, float]]:
    """Quantity, place and clearance [m] of every limit that does not hold at a moment."""
    for quantity, limit in clearance_limits(case).items():
        value, place = smallest(found, quantity)
        if value < limit:
            yield quantity, place, value

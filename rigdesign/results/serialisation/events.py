"""The thermal history as rows of the result."""

from collections.abc import Mapping

from rigdesign.results.thermal import Extreme, WorstMoment
from rigdesign.results.units import (
    DEGREE_CELSIUS,
    KILOWATT,
    MICROMETRE,
    MILLIMETRE,
    MILLIRADIAN,
    NUMBER,
    DisplayUnit,
)

EXTREME_UNITS: Mapping[str, DisplayUnit] = {
    "seal_gap": MILLIMETRE,
    "axial_play": MILLIMETRE,
    "bearing_clearance": MILLIMETRE,
    "backlash": MILLIMETRE,
    "tip_clearance": MILLIMETRE,
    "housing_temperature": DEGREE_CELSIUS,
    "gear_temperature": DEGREE_CELSIUS,
    "bearing_tilt": MILLIRADIAN,
    "bore_out_of_round": NUMBER,
    "axis_inclination": MICROMETRE,
    "axis_skew": MICROMETRE,
    "coupling_offset": MILLIMETRE,
    "coupling_angle": MILLIRADIAN,
    "heater_power": KILOWATT,
    "cooler_power": KILOWATT,
}
"""Unit of every quantity over time."""


def worst_moment_row(extreme: Extreme) -> WorstMoment:
    """The worst moment of one quantity."""
    unit = EXTREME_UNITS[extreme.quantity]
    return WorstMoment(
        quantity=extreme.quantity,
        value=unit.shown(extreme.value),
        unit=unit.name,
        time_s=extreme.time,
        place=extreme.place,
        branch=extreme.branch,
        phase=extreme.phase,
        steady=None if extreme.steady is None else unit.shown(extreme.steady),
        limit=None if extreme.limit is None else unit.shown(extreme.limit),
        planned=extreme.planned,
    )

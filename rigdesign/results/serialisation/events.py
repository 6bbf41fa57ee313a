"""Events as rows of the result."""

from collections.abc import Mapping
from typing import Any

from rigdesign.results.loads import EventRecord
from rigdesign.results.thermal import Extreme, WorstMoment
from rigdesign.results.units import (
    DEGREE_CELSIUS,
    KILOWATT,
    MICROMETRE,
    MILLIMETRE,
    MILLIRADIAN,
    MPA,
    NUMBER,
    RPM,
    DisplayUnit,
)

UNITS = {"bearing force": "N"}
LEAST_SHARE = 0.05
"""Part of the peak below which what was there before is no measure of it."""


def event_row(found: EventRecord) -> dict[str, Any]:
    """One event; what its kind does not have is None or empty."""
    return {
        "name": found.name,
        "kind": found.kind,
        "what": found.what,
        "speed_rpm": RPM * found.speed,
        "torque_Nm": found.torque,
        "peaks": [
            {
                "place": peak.place,
                "part": peak.part,
                "quantity": peak.quantity,
                "unit": UNITS.get(peak.quantity, "N m"),
                "before": peak.before,
                "peak": peak.peak,
                "factor": peak.peak / abs(peak.before) if abs(peak.before) > LEAST_SHARE * peak.peak else None,
                "time_s": peak.time,
                "shear_stress_MPa": None if peak.shear_stress is None else MPA * peak.shear_stress,
            }
            for peak in found.peaks
        ],
        "passing": [
            {
                "place": peak.place, "part": peak.part, "quantity": peak.quantity, "unit": "N m",
                "peak": peak.peak, "speed_rpm": RPM * peak.speed,
                "shear_stress_MPa": None if peak.shear_stress is None else MPA * peak.shear_stress,
            }
            for peak in found.passing
        ],
        "contact": [
            {"mesh": one.mesh, "open_share": one.open_share, "other_flank_Nm": one.other_flank}
            for one in found.reversals
        ],
        "time_to_trip_s": found.tripped,
        "time_to_standstill_s": found.standstill,
        "dynamic_factor": found.dynamic_factor,
        "resonance": found.resonance,
        "resonance_distance": found.resonance_distance,
        "curves": {
            "time_s": found.time,
            "torque": [
                {
                    "place": curve.place, "quantity": curve.quantity, "least": curve.least,
                    "greatest": curve.greatest,
                }
                for curve in found.curves
            ],
        },
        "notes": list(found.notes),
    }  # fmt: skip


# The thermal history as rows of the result.

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

"""Checks of the thermal course: what is left or needed at the worst moment, and the soak."""

from collections.abc import Iterator

from rigdesign.case.model import Case
from rigdesign.checks.rules import Rule, hold, not_applicable
from rigdesign.results.result import Check
from rigdesign.results.transient import TransientResult, WorstMoment
from rigdesign.transient.warm_up import Soak

TITLES = {
    "seal_gap": "smallest radial gap of a seal over time",
    "axial_play": "smallest axial play of a shaft over time",
    "bearing_clearance": "smallest diametral bearing clearance over time",
    "backlash": "smallest backlash over time",
    "tip_clearance": "smallest tip clearance over time",
    "housing_temperature": "hottest place of the housing over time",
    "bearing_tilt": "largest tilt of a shaft in a bearing bore over time",
    "bore_out_of_round": "bearing bore out of round over time, share of the radial clearance",
    "axis_inclination": "in-plane deviation of the axes of a mesh over time",
    "axis_skew": "out-of-plane deviation of the axes of a mesh over time",
    "coupling_offset": "radial offset between the shafts over time, coupling",
    "coupling_angle": "angle between the shafts over time, coupling",
    "heater_power": "power the heaters of the warm circuits give over time",
    "cooler_power": "power the cooler carries over time",
}
SOURCES = {
    **{key: f"limits.clearances.{key}_minimum; thermal course" for key in list(TITLES)[:5]},
    "housing_temperature": "limits.temperatures.housing_maximum; thermal course",
    **{key: f"limits.alignment.{key}_maximum; thermal course" for key in list(TITLES)[6:10]},
    "coupling_offset": "drivetrain.couplings.{place}.radial_offset_maximum; thermal course",
    "coupling_angle": "drivetrain.couplings.{place}.angle_maximum; thermal course",
    "heater_power": "limits.oil.heater_power_maximum; thermal course, every oil fed at its inlet temperature",
    "cooler_power": "limits.oil.cooler_power_maximum; thermal course, every oil fed at its inlet temperature",
}
LEAST = list(TITLES)[:5]
"""Quantities whose smallest value is the worst."""


def transient_checks(case: Case, record: TransientResult) -> Iterator[Check]:
    """One check for every limited quantity, one for the warm-up of every gearbox."""
    for moment in record.worst:
        if moment.planned and moment.quantity in TITLES:
            yield _worst(case, moment)
    for soak in record.soak:
        yield _soak(case, soak)


def _worst(case: Case, moment: WorstMoment) -> Check:
    own = f".{moment.place}" if moment.quantity.startswith("coupling_") else ""
    rule = Rule(
        id=f"transient.{moment.quantity}{own}", title=TITLES[moment.quantity] + own.replace(".", " "),
        unit=moment.unit, source=SOURCES[moment.quantity].format(place=moment.place), group="transient",
        limit=moment.limit, comparison=">=" if moment.quantity in LEAST else "<=",
    )  # fmt: skip
    if moment.limit is None:
        return not_applicable(rule, "the case states no limit")
    reason = f"{moment.place}, {moment.branch}, phase {moment.phase}, {moment.time_s / 3600.0:.2f} h after the start"
    return hold(rule, moment.value, reason)


def _soak(case: Case, soak: Soak) -> Check:
    """The warm-up the case plans against the one it needs."""
    rule = Rule(
        id=f"transient.soak.{soak.gearbox}", title=f"warm-up needed before full torque, {soak.gearbox} gearbox",
        unit="h", source="transient.warm_up; shortest warm-up with which all clearance limits hold",
        group="transient", limit=case.transient.warm_up / 3600.0,
    )  # fmt: skip
    if soak.soak_time_s is None:
        return not_applicable(rule, soak.reason)
    return hold(rule, soak.soak_time_s / 3600.0, soak.reason)

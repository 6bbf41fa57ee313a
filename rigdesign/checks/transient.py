"""Checks of the thermal course: the clearances that are left at the worst moment, and the soak."""

from collections.abc import Iterator

from rigdesign.case.model import Case
from rigdesign.results import Check
from rigdesign.results_transient import Soak, TransientResult, WorstMoment
from rigdesign.rules import Rule, hold, not_applicable

TITLES = {
    "seal_gap": "smallest radial gap of a seal over time",
    "axial_play": "smallest axial play of a shaft over time",
    "bearing_clearance": "smallest diametral bearing clearance over time",
    "backlash": "smallest backlash over time",
    "tip_clearance": "smallest tip clearance over time",
    "housing_temperature": "hottest place of the housing over time",
}
SOURCES = {
    **{key: f"limits.clearances.{key}_minimum; thermal course" for key in list(TITLES)[:5]},
    "housing_temperature": "limits.temperatures.housing_maximum; thermal course",
}


def transient_checks(case: Case, record: TransientResult) -> Iterator[Check]:
    """One check for every limited quantity, one for the warm-up of every gearbox."""
    for moment in record.worst:
        if moment.planned and moment.quantity in TITLES:
            yield _worst(case, moment)
    for soak in record.soak:
        yield _soak(case, soak)


def _worst(case: Case, moment: WorstMoment) -> Check:
    hot = moment.unit == "degC"
    rule = Rule(
        id=f"transient.{moment.quantity}", title=TITLES[moment.quantity], unit=moment.unit,
        source=SOURCES[moment.quantity], group="transient", limit=moment.limit, comparison="<=" if hot else ">=",
        datum=case.ambient.temperature - 273.15 if hot else 0.0,
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

"""Checks of the schedule: ramp rules, start torque, limits of bought parts."""

import math
from collections.abc import Iterator

from dynamics.response.schedule import RampLimits, ramp_rules
from rigdesign.checks.component_limits import bought_parts
from rigdesign.checks.rules import Rule, exact, hold, not_applicable
from rigdesign.checks.thermal import transition_speeds_rpm
from rigdesign.coupling.time_run import schedule_of
from rigdesign.records.solved_rig import NO_LIMIT, SolvedRig, worst
from rigdesign.results.result import Check

RPM = 30.0 / math.pi
SOURCES = {
    "ramp.standstill_torque": "limits.ramp.standstill_torque",
    "ramp.start_torque": "limits.bearing.start_torque_limit",
    "ramp.run_up_torque": "limits.ramp.run_up_torque_share_maximum",
    "ramp.test_torque": "schedule.test_torque",
}


def checks(solved: SolvedRig) -> list[Check]:
    """Ramp rules of the paper, the transition speed they depend on, then the bought parts."""
    return [
        *_ramp(solved),
        _transition(solved),
        *bought_parts(solved),
    ]


def _ramp(solved: SolvedRig) -> Iterator[Check]:
    """The rules of the paper, each where the case states what it needs."""
    case, limits = solved.case, solved.case.limits
    start, share = limits.bearing.start_torque_limit, limits.ramp.run_up_torque_share_maximum
    floating = limits.ramp.transition_speed
    stated = {
        "ramp.standstill_torque": limits.ramp.standstill_torque is not None,
        "ramp.start_torque": start is not None and floating is not None,
        "ramp.run_up_torque": share is not None and floating is not None,
        "ramp.test_torque": True,
    }
    rig = solved.rig
    rules = ramp_rules(
        schedule_of(rig),
        RampLimits(
            standstill_torque=rig.torque_ratio * (limits.ramp.standstill_torque or 0.0),
            start_torque_limit=rig.torque_ratio * (start or 0.0),
            transition_speed=rig.pinion_speed(floating or 0.0),
            test_speed=rig.pinion_speed(case.schedule.test_speed),
            test_torque=rig.torque_ratio * case.schedule.test_torque,
            run_up_share=share or 0.0,
        ),
    )
    for entry in rules:
        rule = Rule(
            id=entry.id, title=entry.text, unit="N m", source=SOURCES.get(entry.id, "P2, Figure 9"), group="ramp",
            limit=entry.limit if stated[entry.id] else None, comparison=entry.comparison,
        )  # fmt: skip
        if not stated[entry.id]:
            yield not_applicable(rule, NO_LIMIT)
        elif not entry.stage:
            yield not_applicable(rule, "no stage of the schedule runs there")
        else:
            yield exact(hold(rule, entry.value, f"stage {entry.stage} at {entry.time:.2f} s"))


def _transition(solved: SolvedRig) -> Check:
    """The computed transition speed under the start torque against the one the ramp relies on."""
    limit = solved.case.limits.ramp.transition_speed
    rule = Rule(
        id="bearing.transition_speed", title="transition speed of the bearings under the start torque", unit="rpm",
        source="Vogelpohl, against limits.ramp.transition_speed", group="bearings",
        limit=None if limit is None else limit * RPM,
    )  # fmt: skip
    start = solved.case.limits.bearing.start_torque_limit
    speeds = [] if start is None else transition_speeds_rpm(solved, start)
    if limit is None or not speeds:
        return not_applicable(rule, NO_LIMIT)
    value, where = worst(speeds)
    return hold(rule, value, f"{where}, load of the start torque")

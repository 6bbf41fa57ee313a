"""Checks of the schedule: rules of the ramp, and the transition speed on which they depend."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from dynamics.vibration.schedule import RampLimits, ramp_rules
from rigdesign.checks.films import SHAFT_HEAT, THRUST_TILT
from rigdesign.checks.omissions import warming
from rigdesign.checks.registry import REGISTRY, SPEEDS, RuleFamily, Topic, Values
from rigdesign.checks.rules import Comparison, hold, not_applicable
from rigdesign.results.check import NO_LIMIT, Check
from rigdesign.results.units import NEWTON_METRE, REVOLUTION_PER_MINUTE

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

OF_SPEEDS = ("limits.ramp", "limits.bearing.start_torque_limit", *SPEEDS)


def _family(name: str, title: str, limit: str, procedure: str, comparison: Comparison = "<=") -> RuleFamily:
    return RuleFamily(
        key=f"ramp.{name}",
        title=title,
        procedure=f"{procedure}, along the schedule as stated: nothing is simulated (P2, Figure 9).",
        unit=NEWTON_METRE,
        group="ramp",
        source=limit,
        comparison=comparison,
        only_inputs=OF_SPEEDS,
        by_definition=True,
    )


RAMP = {
    family.key: family
    for family in (
        _family(
            "standstill_torque", "least torque while the rig turns, backlash taken up",
            "limits.ramp.standstill_torque", "Least torque from just before the rig starts to turn", ">=",
        ),
        _family(
            "start_torque", "most torque below the transition speed of the bearings",
            "limits.bearing.start_torque_limit", "Most torque below limits.ramp.transition_speed",
        ),
        _family(
            "run_up_torque", "most torque between transition and test speed",
            "limits.ramp.run_up_torque_share_maximum", "Most torque from the transition speed up to the test speed, "
            "against the share of the test torque",
        ),
        _family("test_torque", "most torque at test speed", "schedule.test_torque", "Most torque at test speed"),
    )
}  # fmt: skip
"""By the ids of `dynamics.vibration.schedule.ramp_rules`."""
TRANSITION_SPEED = RuleFamily(
    key="bearing.transition_speed",
    title="transition speed of the bearings under the start torque",
    procedure=(
        "Vogelpohl transition speed of every bearing under the load of the start torque: that of the "
        "film at a held stage times start torque over held torque. The highest counts."
    ),
    unit=REVOLUTION_PER_MINUTE,
    group="bearings",
    source="Vogelpohl, against limits.ramp.transition_speed",
    limit_keys=("limits.ramp.transition_speed",),
    absent=NO_LIMIT,
    leaves_out=(SHAFT_HEAT, THRUST_TILT, warming),
    moved_by=frozenset({"start torque", "ramp limits", "housing"}),
)


def checks(solved: SolvedRig) -> list[Check]:
    """Rules of the ramp, then the transition speed on which they depend."""
    return [*ramp(solved), _transition(solved)]


def ramp(solved: SolvedRig) -> Iterator[Check]:
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
        solved.schedule,
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
        rule = RAMP[entry.id].rule(entry.limit if stated[entry.id] else None)
        if not stated[entry.id]:
            yield not_applicable(rule, NO_LIMIT)
        elif not entry.stage:
            yield not_applicable(rule, "no stage of the schedule runs there")
        else:
            yield hold(rule, entry.value, f"stage {entry.stage} at {entry.time:.2f} s")


def _transition(solved: SolvedRig) -> Check:
    """The computed transition speed under the start torque against the one the ramp depends on."""
    start = solved.case.limits.bearing.start_torque_limit
    rule = TRANSITION_SPEED.rule(solved.case.limits.ramp.transition_speed)
    speeds = [] if start is None else transition_speeds(solved, start)
    return TRANSITION_SPEED.worst(solved, rule, speeds)


def transition_speeds(solved: SolvedRig, torque: float) -> Values:
    """Vogelpohl transition speed [rad/s] of every bearing under the load of a stated torque [N m].

    Taken from the films of each loaded held stage; the speed grows with the load.
    """
    return (
        (
            torque / abs(point.point.torque) * state.transition_speed,
            f"{name} at the viscosity of stage {point.point.stage}, load of the start torque",
        )
        for point in solved.points
        if point.point.torque
        for name, state in point.last.bearings.items()
        if state.transition_speed is not None
    )


REGISTRY.register(Topic(order=50, families=(*RAMP.values(), TRANSITION_SPEED), checks=checks))

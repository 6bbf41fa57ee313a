"""Speeds at which the rig dwells against resonances of shafts and joints, by the rule of those of meshes.

At a held speed those of meshes are a check of their own; a stage that is not held passes them, which is good practice
to avoid and no limit missed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from rigdesign.checks.omissions import long_periods
from rigdesign.checks.registry import LOADS, REGISTRY, RuleFamily, Topic
from rigdesign.results.check import Check
from rigdesign.results.units import NUMBER, RPM
from rigdesign.results.vibration import SHAFT_SHARE

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

OF_SHAFTS = ("shaft torque", "shaft order")
DWELL = RuleFamily(
    key="dynamics.dwell_speed",
    title="distance of dwell speeds from resonances of shafts and joints, of those not held also of meshes",
    procedure=(
        "Periodic response around every speed at which the rig dwells: a peak counts where half the peak-to-peak "
        f"torque of a shaft section, coupling or gear seat exceeds {SHAFT_SHARE:g} of the mean torque of the loop; so "
        "does a shaft or coupling order that meets a lightly damped mode, and at speeds that are not held a dangerous "
        "resonance of a mesh. The value is the distance of the nearest one from a dwell, as a share of its speed, 0 "
        "where the dwell itself is above such a share; where there is none, the range searched."
    ),
    unit=NUMBER,
    group="dynamics",
    source="limits.dynamics.resonance_distance_minimum; peaks of the periodic response",
    comparison=">=",
    needs=LOADS,
    leaves_out=(long_periods,),
    absent="no stage dwells at a speed whose response is computed",
    moved_by=frozenset({"start torque", "resonance limits"}),
)


def checks(solved: SolvedRig) -> list[Check]:
    """The one check of the rig: of the held speeds, or where these hold, of the others as advice."""
    rule = DWELL.rule(solved.case.limits.dynamics.resonance_distance_minimum)
    held = DWELL.worst(solved, rule, _distances(solved, held=True))
    if held.verdict == "fail":
        return [held]
    return [DWELL.worst(solved, replace(rule, advisory=True), _distances(solved))]


def _distances(solved: SolvedRig, *, held: bool = False) -> Iterator[tuple[float, str]]:
    """Of every stage that dwells within the computed speeds, or of the held ones alone."""
    rig = solved.rig
    if solved.loads is None or rig.case.limits.dynamics.resonance_distance_minimum is None:
        return
    held_speeds = {stage.speed_end for stage in rig.case.schedule.held()}
    dwells = sorted(solved.dwell_stages, key=lambda stage: stage.kind != "dwell")
    for stage in dwells:  # of stages at one speed the first is named
        speed, is_held = rig.pinion_speed(stage.speed_end), stage.speed_end in held_speeds
        if speed not in solved.near_dwells or (held and not is_held):
            continue
        dwell = solved.near_dwells[speed]
        near = dwell.nearest_of(one for one in dwell.resonances if not is_held or one.kind in OF_SHAFTS)
        if near.resonance is None:
            yield near.distance, f"stage {stage.name}: none within {100.0 * near.distance:.0f} % of its speed"
        else:
            one = near.resonance
            inside = "" if near.distance else "; the response at the dwell itself is above the share"
            yield (
                near.distance,
                f"stage {stage.name} at {speed * RPM:.0f} rpm: {one.kind} of {one.where} peaks at "
                f"{one.speed * RPM:.0f} rpm{inside}",
            )


REGISTRY.register(Topic(order=11, families=(DWELL,), checks=checks))

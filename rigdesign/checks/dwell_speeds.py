"""Check of the speeds at which the rig dwells against resonances of shafts and joints, as against those of meshes."""

from collections.abc import Iterator

from rigdesign.checks.omissions import long_periods
from rigdesign.checks.registry import LOADS, REGISTRY, RuleFamily, Topic
from rigdesign.records.loop_states import dwell_stages
from rigdesign.records.near_dwell import SHAFT_SHARE
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.units import NUMBER, RPM

DWELL = RuleFamily(
    key="dynamics.dwell_speed",
    title="distance of dwell speeds from resonances of shafts and joints",
    procedure=(
        "Periodic response around every speed at which the rig dwells: a peak counts where half the peak-to-peak "
        f"torque of a shaft section, coupling or gear seat exceeds {SHAFT_SHARE:g} of the mean torque of the loop; so "
        "does a shaft or coupling order that meets a lightly damped mode. The value is the distance of the nearest one "
        "from a dwell, as a share of its speed, 0 where the dwell itself is above such a share; where there is none, "
        "the range searched."
    ),
    unit=NUMBER,
    group="dynamics",
    source="limits.dynamics.resonance_distance_minimum; peaks of the periodic response",
    comparison=">=",
    advisory=True,
    resonant=True,
    needs=LOADS,
    leaves_out=(long_periods,),
    absent="no stage dwells at a speed whose response is computed",
    moved_by=frozenset({"start torque", "resonance limits"}),
)


def checks(solved: SolvedRig) -> list[Check]:
    """The one check of the rig."""
    rule = DWELL.rule(solved.case.limits.dynamics.resonance_distance_minimum)
    return [DWELL.worst(solved, rule, _distances(solved))]


def _distances(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Of every stage that dwells within the computed speeds."""
    rig = solved.rig
    if solved.loads is None or rig.case.limits.dynamics.resonance_distance_minimum is None:
        return
    dwells = sorted(dwell_stages(rig), key=lambda stage: stage.kind != "dwell")
    for stage in dwells:  # of stages at one speed the first is named
        speed = rig.pinion_speed(stage.speed_end)
        if speed not in solved.near_dwells:
            continue
        dwell = solved.near_dwells[speed]
        near = dwell.nearest_of(
            one for one in dwell.resonances if one.kind in ("shaft torque", "shaft order")
        )
        if near.resonance is None:
            yield near.distance, f"stage {stage.name}: none within {100.0 * near.distance:.0f} % of its speed"
        else:
            one = near.resonance
            yield (
                near.distance,
                f"stage {stage.name} at {speed * RPM:.0f} rpm: {one.kind} of {one.where} peaks at "
                f"{one.speed * RPM:.0f} rpm",
            )


REGISTRY.register(Topic(order=11, families=(DWELL,), checks=checks))

"""Checks of lateral vibration: orbits in the films, separation of critical speeds, stability, torsional separation.

Limits are those of API 617, written for compressors; a test rig has no standard of its own.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from dynamics.standards.api617_2014 import AF_CRITICAL
from rigdesign.checks.registry import REGISTRY, Need, RigRule, Topic, Values
from rigdesign.results.check import Check
from rigdesign.results.lateral import SWAYING, LateralVibration, Separation, StageLateral, Torque
from rigdesign.results.units import NUMBER, RPM

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

GROUP = "lateral vibration"
BENDING = Need(
    lambda solved: solved.lateral is not None,
    "the shafts of this run only twist (shaft_model torsional, or losses given): they have no lateral vibration",
)
NO_FILM = "no bearing has an oil film"
NO_MODE = "no lateral mode that oscillates up to the speed of the fastest shaft: all are damped out or above"
NO_TORSION = "no torsional mode up to the highest that is listed"
FAR = 10.0
"""Margin over the required one that stands for a mode that needs none."""


def _lateral(solved: SolvedRig) -> LateralVibration:
    assert solved.lateral is not None
    return solved.lateral


def _orbits(solved: SolvedRig) -> Values:
    for stage in _lateral(solved).of("held"):
        for bearing in stage.bearings:
            share = bearing.clearance_share
            if share is not None:
                yield (
                    share,
                    f"{bearing.bearing}, stage {stage.stage}: {2e6 * bearing.amplitude:.2g} um of "
                    f"{1e6 * (bearing.clearance or 0.0):.3g} um",
                )


def _separations(solved: SolvedRig) -> Values:
    """Margin over the required one of every lateral mode that needs one."""
    for stage in _lateral(solved).of("held"):
        if all(
            one.required == 0.0 or stage.as_rigid_body(stage.modes[one.mode]) for one in stage.separations
        ):
            yield FAR, f"stage {stage.stage}: no lateral mode with AF >= {AF_CRITICAL:g} among those listed"
        for one in stage.separations:
            if one.required > 0.0 and not stage.as_rigid_body(stage.modes[one.mode]):
                yield abs(one.margin) / one.required, f"stage {stage.stage}: {_words(stage, one)}"


def _words(stage: StageLateral, one: Separation) -> str:
    mode = stage.modes[one.mode]
    side = "above" if one.margin > 0.0 else "below"
    needed = f", needs {100.0 * one.required:.0f} %" if one.required else ""
    return (
        f"{mode.name}, {mode.frequency:.0f} Hz, AF {mode.amplification:.3g}: "
        f"{100.0 * abs(one.margin):.0f} % {side} {one.harmonic} x {one.speed * RPM:.0f} rpm{needed}"
    )


def _decrements(torque: Torque, solved: SolvedRig) -> Values:
    for stage in _lateral(solved).of(torque):
        yield from _of_stage(stage)


def _of_stage(stage: StageLateral) -> Values:
    """Lateral modes up to the speed of the fastest shaft, where films and internal damping can drive them, and all that
    grow; rigid bodies that sway in their bearings have to grow to count."""
    rigid = [mode.frequency for mode in stage.modes if stage.as_rigid_body(mode)]
    apart = f"; {len(rigid)} rigid-body modes from {min(rigid):.2g} Hz do not grow" if rigid else ""
    for mode in stage.modes:
        slow = mode.family == "lateral" and mode.frequency <= stage.highest_turn
        if (slow and not stage.as_rigid_body(mode)) or mode.logarithmic_decrement < 0.0:
            yield (
                mode.logarithmic_decrement,
                f"stage {stage.stage}: {mode.name}, {mode.frequency:.1f} Hz, "
                f"{mode.frequency / stage.highest_turn:.2f} of the fastest shaft{apart}",
            )


def _torsional(solved: SolvedRig) -> Values:
    for stage in _lateral(solved).of("held"):
        for one in stage.torsional:
            yield abs(one.margin), f"stage {stage.stage}: {_words(stage, one)}"


_RULE = partial(RigRule, unit=NUMBER, group=GROUP, needs=BENDING)

RULES = (
    _RULE(
        key="lateral.orbit",
        title="motion once a turn in an oil film over its clearance",
        procedure=(
            "Shafts that bend in their bearings as they run at the held stages, under unbalance, bow and flange"
            " run-out: peak-to-peak motion of the journal, those of all shaft lines added, over the warm diametral"
            " clearance. The largest counts."
        ),
        source="limits.dynamics.orbit_share_maximum; API 617",
        limit=lambda limits: limits.dynamics.orbit_share_maximum,
        values=_orbits,
        absent=NO_FILM,
    ),
    _RULE(
        key="lateral.separation",
        title="distance of critical speeds from held speeds over the distance they need",
        procedure=(
            "Damped modes of the closed loop with the bearings as they run at the held stages. A lateral mode with an "
            "amplification factor AF = 1 / (2 damping ratio) of 2.5 or more needs a distance of "
            "17 (1 - 1/(AF - 1.5)) % below the speed of its shaft, 10 % more above it. The least of distance over "
            "needed distance counts; modes that whirl backward are not excited."
        ),
        source="limits.dynamics.lateral_separation_minimum; separation margins of API 617 and API TR 684-1",
        comparison=">=",
        limit=lambda limits: limits.dynamics.lateral_separation_minimum,
        values=_separations,
        absent=NO_MODE,
    ),
    _RULE(
        key="lateral.stability",
        title="least logarithmic decrement at the held stages",
        procedure=(
            "Eigenvalues of the closed loop at the held stages, films linearised at their load, speed and"
            " temperature, damping that turns with the shafts included. Lateral modes up to the speed of the fastest"
            f" shaft count, and every mode that grows. Shafts that sway as rigid bodies below {SWAYING:g} of that"
            " speed, in bearings without load, have a stiffness and so a decrement near zero: they only have to die"
            " away."
        ),
        source="limits.dynamics.logarithmic_decrement_minimum; API 617",
        comparison=">=",
        limit=lambda limits: limits.dynamics.logarithmic_decrement_minimum,
        values=lambda solved: _decrements("held", solved),
        absent=NO_MODE,
    ),
    _RULE(
        key="lateral.stability_without_torque",
        title="least logarithmic decrement where the loop loses its torque at speed",
        procedure=(
            "The same at the speed of the held stages with the flanks apart: the bearings carry the weight alone, their"
            " films are solved again at that load. A lightly loaded journal bearing whirls at half the speed."
        ),
        source="limits.dynamics.logarithmic_decrement_minimum; API 617",
        comparison=">=",
        limit=lambda limits: limits.dynamics.logarithmic_decrement_minimum,
        values=lambda solved: _decrements("lost", solved),
        absent=NO_MODE,
    ),
    _RULE(
        key="lateral.torsional_separation",
        title="distance of torsional modes from once and twice a turn",
        procedure=(
            "Torsional modes of the closed loop at the held stages against once and twice the speed of every shaft, as"
            " a share of that excitation. The least counts."
        ),
        source="limits.dynamics.torsional_separation_minimum; API 617",
        comparison=">=",
        limit=lambda limits: limits.dynamics.torsional_separation_minimum,
        values=_torsional,
        absent=NO_TORSION,
    ),
)


def checks(solved: SolvedRig) -> list[Check]:
    """All of them."""
    return [rule.check(solved) for rule in RULES]


REGISTRY.register(Topic(order=12, families=RULES, checks=checks))

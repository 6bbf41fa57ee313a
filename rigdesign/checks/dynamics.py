"""Checks of the dynamic loads: K_V, resonances, tooth contact and peaks on the ramp, mesh by mesh."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rigdesign.case.limits import DynamicsLimits
from rigdesign.case.model import Case
from rigdesign.checks.omissions import Omissions, long_periods
from rigdesign.checks.places import meshes
from rigdesign.checks.registry import LOADS, REGISTRY, RuleFamily, Topic, Values
from rigdesign.checks.rules import Omission, worst
from rigdesign.results.check import Check
from rigdesign.results.units import NUMBER, RPM
from rigdesign.results.vibration import NEAR

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.loads import MeshLoads, ModeCrossing, StageLoad

GROUP = "dynamics"
NOT_LOADED = "no stage turns under more than the start torque"


@dataclass(frozen=True, kw_only=True)
class MeshRule(RuleFamily):
    """One rule for every mesh, against one limit of the case."""

    places: Callable[[Case], Iterable[str]] = meshes
    limit: Callable[[DynamicsLimits], float | None]
    values: Callable[[SolvedRig, int], Values]
    """Of a solved rig and the number of a mesh."""

    def check(self, solved: SolvedRig, mesh: int) -> Check:
        """The check of one mesh."""
        rule = self.rule(self.limit(solved.case.limits.dynamics), solved.label(mesh))
        return self.worst(solved, replace(rule, role=solved.role(mesh)), self.values(solved, mesh))


def _loads(solved: SolvedRig, mesh: int) -> MeshLoads:
    assert solved.loads is not None
    return solved.loads.meshes[solved.label(mesh)]


def _dynamic_factors(solved: SolvedRig, mesh: int) -> Values:
    return (
        (float(point.last.response.dynamic_factor[mesh]), f"stage {point.point.stage}")
        for point in solved.points
        if point.last.response is not None
    )


def _ramp_peak(solved: SolvedRig, mesh: int) -> Values:
    """Peak of the time run over the mean torque of the governing held stage."""
    response = solved.test.last.response
    assert response is not None
    load = max(loaded_stages(solved, mesh), key=lambda load: load.peak, default=None)
    if load is not None:
        yield (
            load.peak / float(response.mean[mesh]),
            f"{load.peak:.1f} N m in stage {load.stage}; highest K_V there "
            f"{load.dynamic_factor:.2f}, at {load.speed * RPM:.0f} rpm on {load.mean:.0f} N m",
        )


def _resonance_distance(solved: SolvedRig, mesh: int) -> Values:
    """Distance of the nearest dangerous resonance, or of the end of the speeds looked at: the lesser."""
    value, reason = worst(_distances(solved, mesh), smallest=True)
    near = near_crossings(solved, mesh, math.inf)
    if near:
        share, crossing = near[0]
        reason += (
            f"; nearest mode of the closed loop that the mesh excites: mode {crossing.mode} ({crossing.shape}), "
            f"{crossing.frequency:.0f} Hz, order {crossing.harmonic} at {crossing.speed * RPM:.0f} rpm, "
            f"{100.0 * share:.1f} % away"
        )
    yield value, reason


def _distances(solved: SolvedRig, mesh: int) -> Values:
    """Distance of every held speed from every dangerous resonance under its torque, and from the end of the search."""
    rig, label = solved.rig, solved.label(mesh)
    shaft = rig.mesh_gear(mesh, 0).shaft
    for point in solved.points:
        curve, held = solved.searched(point), point.point.speed
        low, high = curve.speeds
        searched = f"{low * RPM:.0f} to {high * RPM:.0f} rpm"
        yield (
            min(held - low, high - held) / held,
            f"none dangerous nearer in {searched}, held {held * RPM:.0f} rpm: at least this far",
        )
        own, first = rig.shaft_speed(shaft, held) * RPM, rig.pinion_speed(held)
        places = {curve.place(label), *(f"{label} {gear}" for gear in ("pinion", "wheel"))}
        here = [
            (abs(peak.speed - first), peak) for peak in solved.dangerous_resonances if peak.where in places
        ]
        for _, peak in sorted(here, key=lambda one: one[0]):  # of equals the first counts
            distance = peak.distance(first, solved.resonance_margin)
            inside = "" if distance else ", where the response itself is above the share"
            rpm = peak.speed * own / first
            yield distance, f"{rpm:.0f} rpm ({peak.mode or peak.kind}), held {own:.0f} rpm{inside}"


def near_crossings(solved: SolvedRig, mesh: int, within: float) -> list[tuple[float, ModeCrossing]]:
    """Crossings of a mesh with modes of the closed loop that it excites, nearest first, with their distances.

    within : largest distance as a share of the held speed
    """
    assert solved.loads is not None
    rig, label = solved.rig, solved.label(mesh)
    shaft = rig.mesh_gear(mesh, 0).shaft
    speeds = [rig.shaft_speed(shaft, point.point.speed) * RPM for point in solved.points]
    found = [
        (min(abs(crossing.speed * RPM - own) / own for own in speeds), crossing)
        for crossing in solved.loads.loop_crossings
        if crossing.kind == "mesh" and crossing.order_of == label
    ]
    return sorted((item for item in found if item[0] <= within), key=lambda item: item[0])


def _lift_off(solved: SolvedRig, mesh: int) -> Values:
    loaded = {load.stage for load in loaded_stages(solved, mesh)}
    if not loaded:
        return
    losses = [loss for loss in _loads(solved, mesh).contact_losses if loss.stage in loaded]
    if not losses:
        yield 0.0, "no gap longer than 5 % of a mesh period in a loaded stage"
    for loss in losses:
        yield loss.share, f"stage {loss.stage}, {loss.start:.2f} s"


def _contact_margin(solved: SolvedRig, mesh: int) -> Values:
    for load in loaded_stages(solved, mesh):
        yield (
            load.least_share,
            f"{load.least:.1f} N m at least in stage {load.stage}, near {load.least_share_speed * RPM:.0f} rpm",
        )


def loaded_stages(solved: SolvedRig, mesh: int) -> list[StageLoad]:
    """Loads of the stages that carry more than the start torque while they turn."""
    light = solved.case.limits.bearing.start_torque_limit or 0.0
    loaded = {
        stage.name
        for stage in solved.case.schedule.resolved()
        if min(abs(stage.torque_start), abs(stage.torque_end)) > light
        and max(stage.speed_start, stage.speed_end) > 0.0
    }
    return [load for load in _loads(solved, mesh).stage_loads if load.stage in loaded]


def _gaps(solved: SolvedRig, check: Check) -> Omissions:
    """Resonances at speeds without a solution, and modes of the closed loop between the speeds of a coarse curve.

    A mode counts if the mesh excites it and an order meets it nearer to a held speed than the limit and what loaded
    teeth may shift it.
    """
    if solved.run is None or solved.loads is None:
        return
    label = check.id.split(".", 2)[2]
    if not solved.resolved:
        step = np.diff(solved.run.curves.response.speeds).max() * RPM
        mesh = next(i for i in range(len(solved.rig.mesh_names)) if solved.label(i) == label)
        near = near_crossings(solved, mesh, (check.limit or 0.0) + NEAR)
        modes = ", ".join(dict.fromkeys(str(crossing.mode) for _, crossing in near))
        if near:
            yield Omission(
                f"narrow resonances of the loop's modes {modes} between speeds {step:.0f} rpm apart"
            )
    holes = len(solved.loads.meshes[label].unsolved)
    if holes:
        yield Omission(f"resonances at speeds without solution ({holes})")


RULES = (
    MeshRule(
        key="dynamics.dynamic_factor",
        title="K_V at the held stages, {place} gearbox",
        procedure=(
            "Periodic response of the braced loop with warm meshes at every held stage: largest over mean "
            "torque of the mesh, at the pinion. The highest of the held stages counts."
        ),
        unit=NUMBER,
        group=GROUP,
        source="limits.dynamics.dynamic_factor_maximum; max/mean, P2 Formula 1",
        needs=LOADS,
        limit=lambda limits: limits.dynamic_factor_maximum,
        values=_dynamic_factors,
        leaves_out=(long_periods,),
        moved_by=frozenset({"start torque"}),
    ),
    MeshRule(
        key="dynamics.ramp_peak",
        title="highest torque of the loaded ramp over the test torque, {place} gearbox",
        procedure=(
            "Time run over the whole schedule: largest torque at the pinion in the stages that turn under "
            "more than the start torque, over the mean torque at the test point."
        ),
        unit=NUMBER,
        group=GROUP,
        source="limits.dynamics.dynamic_factor_maximum times the test torque; time run over the schedule",
        needs=LOADS,
        limit=lambda limits: limits.dynamic_factor_maximum,
        values=_ramp_peak,
        absent=NOT_LOADED,
        moved_by=frozenset({"start torque", "time run"}),
    ),
    MeshRule(
        key="dynamics.resonance_distance",
        title="distance of held speeds from dangerous resonances, {place} gearbox",
        procedure=(
            "Response over speed under every held torque. A peak is a dangerous resonance where it "
            "amplifies the mesh force by more than dangerous_amplification, or where its dynamic part, half "
            "peak-to-peak, or that of the root stress is above dangerous_force_share of the mean. The value is the "
            "distance of the nearest one from a held speed, as a share of that speed, 0 where the response there is "
            "above the share itself; or that of the end of the speeds looked at."
        ),
        unit=NUMBER,
        group=GROUP,
        source="limits.dynamics.resonance_distance_minimum; resonances by strength",
        comparison=">=",
        needs=LOADS,
        limit=lambda limits: limits.resonance_distance_minimum,
        values=_resonance_distance,
        leaves_out=(long_periods, _gaps),
        moved_by=frozenset({"start torque", "resonance limits"}),
    ),
    MeshRule(
        key="dynamics.lift_off",
        title="time without tooth contact in loaded stages, {place} gearbox",
        procedure=(
            "Time run over the whole schedule: share of a loaded stage in which no tooth of the mesh "
            "touches; gaps count from 5 % of a mesh period. The worst stage counts."
        ),
        unit=NUMBER,
        group=GROUP,
        source="limits.dynamics.lift_off_share_maximum; time run over the schedule",
        needs=LOADS,
        limit=lambda limits: limits.lift_off_share_maximum,
        values=_lift_off,
        absent=NOT_LOADED,
        moved_by=frozenset({"start torque", "time run"}),
    ),
    MeshRule(
        key="dynamics.contact_margin",
        title="least torque in loaded stages as a share of the mean, {place} gearbox",
        procedure=(
            "Time run over the whole schedule: least torque at the pinion in a loaded stage over its "
            "mean. The worst stage counts."
        ),
        unit=NUMBER,
        group=GROUP,
        source="limits.dynamics.contact_margin_minimum; time run over the schedule",
        comparison=">=",
        needs=LOADS,
        limit=lambda limits: limits.contact_margin_minimum,
        values=_contact_margin,
        absent=NOT_LOADED,
        moved_by=frozenset({"start torque", "time run"}),
    ),
)


def checks(solved: SolvedRig) -> list[Check]:
    """All of them, mesh by mesh."""
    return [rule.check(solved, mesh) for mesh in range(len(solved.rig.mesh_names)) for rule in RULES]


REGISTRY.register(Topic(order=10, families=RULES, checks=checks))

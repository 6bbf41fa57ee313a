"""The main job on one page: a case in, a verdict with everything behind it out.

Linear algebra runs on one thread: the matrices are small, and threads that wait for each other cost more than
they give and make the last digits of a result depend on the machine's load.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from types import MappingProxyType

from threadpoolctl import threadpool_limits

from dynamics.kernels.time_integration import compiled
from dynamics.vibration.time_integration import compile_time_integration
from dynamics.vibration.time_response import TimeResponse
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.json_text import require_finite
from rigdesign.base.parallel import BackgroundTasks, one_core
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.model import Case
from rigdesign.case.usual import unusual_inputs
from rigdesign.checks import all_checks
from rigdesign.checks.geometry import missed
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.loop import PointResult, governing_point, solve_point
from rigdesign.coupling.loop_over_speed import stage_losses
from rigdesign.coupling.state import OperatingPoint
from rigdesign.coupling.time_run import held_points, run_ramp, schedule_of
from rigdesign.postprocessing.curves import solve_curves
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.dynamics_section import dynamics_section
from rigdesign.postprocessing.events import solve_events
from rigdesign.postprocessing.hand_calculation import hand_checks
from rigdesign.postprocessing.housing import (
    circuit_balances_at,
    compared_temperatures,
    fields_of,
    losses_of,
    oil_of,
)
from rigdesign.postprocessing.nearest_resonance import held_crossings, require_damping
from rigdesign.postprocessing.solved_rig import SolvedRig, housing_fields, solved_rig
from rigdesign.postprocessing.warm_gearbox import rolling_bearings
from rigdesign.results.check import Check, Checks, Finding, overall
from rigdesign.results.quantity import Records
from rigdesign.results.result import CouplingHistory, IterationResidual, RunResult
from rigdesign.results.serialisation.warm_gearbox import expansion_row
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.tooth_influence import Count
from rigdesign.run.mesh_convergence import (
    BackgroundMeshing,
    discretisation,
    law_spreads,
    load_errors,
    looping_rig,
    on_mesh,
)
from rigdesign.run.solver_errors import solver_errors
from rigdesign.run.warnings import not_modelled, warnings_of, without_effect
from thermal.fe.kernels import one_thread

Progress = Callable[[str], None]
FollowUp = Callable[[SolvedRig, RunResult], RunResult]
"""Adds to the result what is found from the solved rig."""


def run_case(
    case: Case,
    fidelity: Fidelity = "standard",
    progress: Progress | None = None,
    *,
    transient: bool = False,
    follow_ups: Mapping[str, FollowUp] = MappingProxyType({}),
    count: Count | None = None,
) -> RunResult:
    """Compute a case and hold it against its limits; parameters and errors are those of `rigdesign.api.run_case`.

    count : called with gears done, gears in all and the last one where influence numbers are computed
    follow_ups : called with the solved rig and the result so far, by the name of their time in the timings
    """
    say = progress or (lambda message: None)
    clock = _Clock()
    with solver_errors(case), threadpool_limits(limits=1):
        solved = solve_case(case, fidelity, say, clock.lap, count)
        result = _assemble(solved, clock)
        if transient:
            from rigdesign.run.transient import with_transient

            result = with_transient(solved, result, say)
            clock.lap("transient")
        for name, follow_up in follow_ups.items():
            result = follow_up(solved, result)
            clock.lap(name)
        require_finite(result)
        return result


def solve_case(
    case: Case,
    fidelity: Fidelity,
    say: Progress = lambda message: None,
    lap: Progress = lambda name: None,
    count: Count | None = None,
) -> SolvedRig:
    """The solved rig before its checks; ``lap`` is called with the name of every part that is done."""
    say("building the rig")
    wanted = build_rig(case, fidelity)
    schedule_of(wanted)
    for text in missed(SolvedRig(rig=wanted, points=())):
        say(text)
    with BackgroundTasks(_compilation(wanted, say)) as compilation:
        if wanted.mesh_stiffness == "influence_numbers":
            wanted.prepare_teeth(say, count)
            lap("influence_numbers")
        rig = looping_rig(wanted)
        for name in rig.models:
            say(f"meshed {name}: {len(rig.models[name].mesh.points)} nodes")
        lap("rig_and_mesh")
        with BackgroundMeshing(wanted, rig) as meshing, one_thread():
            converged = _converged(rig, say)
            lap("coupling")
            rigs = meshing.rigs()
            lap("other_meshes")
        _ = compilation.results()
    wanted = rigs[-1]
    if rig.case.drivetrain is not None:
        require_damping(rig, held_crossings(rig, governing_point(converged)))
    say("response over speed, time run over the schedule")
    with BackgroundTasks(_time_runs(rig, converged)) as time_run, one_thread(), one_core():
        points = converged
        if wanted is not rig:
            say(f"last iteration on the {fidelity} mesh")
            points = [on_mesh(wanted, point, rig) for point in converged]
            lap("last_pass")
        meshes = discretisation(rigs, rig, converged, points)
        lap("discretisation")
        temperatures = [compared_temperatures(wanted, *found) for found in housing_fields(points)]
        spreads = tuple(law_spreads(wanted, points))
        lap("alternatives")
        run = None
        if rig.case.drivetrain is not None:
            curves = solve_curves(rig, governing_point(converged).last)
            lap("curves")
            run = DynamicRun(tuple(converged), curves, lambda: time_run.results()[0])
        solved = replace(
            solved_rig(wanted, points, temperatures, run=run),
            discretisation=meshes.rows,
            mesh_shifts=meshes.shifts,
            law_spreads=spreads,
        )
        if time_run.running:
            solved.vibration.before_time_run()
            lap("over_speed")
        if run is not None:
            _ = run.ramp
            lap("time_run")
    if run is not None and wanted.case.events:
        say("events: " + ", ".join(wanted.case.events))
        solved = replace(solved, events=solve_events(wanted, run))
        lap("events")
    say("discretisation errors of the loads")
    solved = replace(solved, discretisation=(*meshes.rows, *load_errors(solved)))
    lap("load_errors")
    say("assembling the result")
    return solved


def _compilation(rig: Rig, say: Progress) -> list[Callable[[], None]]:
    """Compiling the time integration, which the coupling loop does not need; nothing where it lies on disk."""
    if rig.case.drivetrain is None or compiled():
        return []
    say("compiling the time integration meanwhile: once after an installation, half a minute")
    return [compile_time_integration]


def _time_runs(rig: Rig, converged: Sequence[PointResult]) -> list[Callable[[], TimeResponse]]:
    """The time run, which needs no more of the points than their warm gears; none without a drivetrain."""
    if rig.case.drivetrain is None:
        return []
    test = governing_point(converged)
    assert test.setting is not None
    return [partial(run_ramp, rig, test.last, test.setting, test.last.coupling_state)]


def _converged(rig: Rig, say: Progress) -> list[PointResult]:
    """Every held point, each from the one before."""
    points: list[PointResult] = []
    for point in held_points(rig):
        say(f"coupling loads, losses, temperatures and thermal expansion at stage {point.stage}")
        start = points[-1].last.coupling_state if points else None
        points.append(solve_point(rig, point, start=start))
    return points


def _assemble(solved: SolvedRig, clock: "_Clock") -> RunResult:
    """Checks and records of a solved rig."""
    case, rig, points = solved.case, solved.rig, list(solved.points)
    _ = solved.lateral
    clock.lap("lateral")
    hand = hand_checks(solved)
    checks = all_checks(solved, hand)
    clock.lap("checks")
    losses = losses_by_stage(rig, points)
    result = RunResult(
        case=_case_record(case),
        fidelity=rig.fidelity,
        verdict=overall(checks),
        checks=Checks(checks),
        dynamics=None if solved.run is None or solved.loads is None else dynamics_section(solved),
        losses=Records(row for stage, found in losses.items() for row in losses_of(stage, found)),
        oil=Records(row for p in points for row in oil_of(p)),
        events=Records(solved.events),
        rolling_bearings=Records(rolling_bearings(rig, points)),
        lateral=solved.lateral,
        cooler=Records(solved.cooling),
        rig_heat=Records(balance.heat for balance in solved.balances if case.rig_heat.stated),
        oil_circuits=Records(row for balance in solved.balances for row in circuit_balances_at(balance)),
        thermal=Records(solved.temperatures),
        expansion=[expansion_row(warm) for warm in solved.warm],
        coupling=Records(_history(p) for p in points),
        discretisation=list(solved.discretisation),
        reference_shift=list(solved.mesh_shifts),
        hand_checks=hand,
        inputs=list(case.inputs),
        assumptions=_assumptions(case, checks),
        overrides=Records(case.overrides),
        not_modelled=not_modelled(solved),
        warnings=[*_doubts(case), *warnings_of(solved, losses), *without_effect(case, checks)],
        timings_s=clock.laps,
        fields=[field for p in points for field in fields_of(rig, p)],
    )
    clock.lap("records")
    return result


def _case_record(case: Case) -> dict[str, str]:
    """What the result says of its case; that of a schedule no rig can run says so."""
    record = {"name": case.name, "title": case.title, "path": case.path.name, "hash": case.hash}
    reason = case.schedule.simulation_only
    return record if reason is None else record | {"simulation_only": reason}


def _history(result: PointResult) -> CouplingHistory:
    """Residuals of every iteration of the loop at one held stage."""
    return CouplingHistory(
        stage=result.point.stage,
        residuals=tuple(
            IterationResidual(
                temperature=residual.temperature, expansion=residual.length, torque_relative=residual.torque
            )
            for residual in result.residuals
        ),
    )


def _doubts(case: Case) -> list[Finding]:
    """What speaks against the case itself: values outside of their usual range, a schedule that no rig can run."""
    found = [Finding(id="unusual_input", text=text) for text in unusual_inputs(case).values()]
    if (reason := case.schedule.simulation_only) is not None:
        text = f"the schedule is for simulation only: {reason}; the verdict does not release the rig for it"
        found.append(Finding(id="simulation_only", text=text))
    return found


def losses_by_stage(rig: Rig, points: list[PointResult]) -> dict[str, Sequence[PlacedLoss]]:
    """Losses at the end of every rotating stage: coupled at the held ones, with their warm rig at the others."""
    test = governing_point(points)
    losses: dict[str, Sequence[PlacedLoss]] = {point.point.stage: point.last.losses for point in points}
    others = [
        OperatingPoint(stage=stage.name, speed=stage.speed_end, torque=stage.torque_end)
        for stage in rig.case.schedule.resolved()
        if stage.speed_end > 0.0 and stage.name not in losses
    ]
    solve = partial(stage_losses, rig, test=test, dynamic=True)
    with BackgroundTasks([partial(solve, point) for point in others]) as tasks:
        losses |= {found.point.stage: found.losses for found in tasks.results()}
    return {stage.name: losses[stage.name] for stage in rig.case.schedule.resolved() if stage.name in losses}


def _assumptions(case: Case, checks: list[Check]) -> list[AssumptionRecord]:
    """The case's assumptions with the checks that depend on them."""
    return [
        replace(record, decides=tuple(check.id for check in checks if record.path in check.assumptions))
        for record in case.assumptions
    ]


class _Clock:
    """Seconds of each part of the run."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.laps[name] = round(self.laps.get(name, 0.0) + now - self._last, 3)
        self._last = now

"""The rig with one input at one end of its range: from the converged stated rig, only what the input touches again."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from threadpoolctl import threadpool_limits

from dynamics.response.time_response import TimeResponse
from rigdesign.base.errors import RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.checks import held_checks
from rigdesign.coupling.loads import BracingState
from rigdesign.coupling.loop import PointResult, governing_point, solve_point
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.time_run import held_points, run_ramp
from rigdesign.records.curves import Curves, solve_curves
from rigdesign.records.dynamics import DynamicRun, dynamic_loads, stage_bracing
from rigdesign.records.housing import housing_temperatures
from rigdesign.records.solved_rig import SolvedRig, housing_fields, solved_rig
from rigdesign.results.check import Check
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.units import ZERO
from rigdesign.results.verdict import Verdict
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.reuse import HOUSINGS, same_housings, take_over
from rigdesign.run.main import solve_case
from rigdesign.run.solver_errors import solver_errors
from rigdesign.uncertainty.drive import Array, losses_on_motor, peaks_only, shifted_drive
from rigdesign.uncertainty.plan import PARTS, Part, RangeEnd

FIDELITY: Fidelity = "quick"
"""Size of the models of every end."""
DRIVE = ("drive_torque", "drive_power")
"""Quantities of bought parts that follow the losses of the whole run."""
ACTUATOR = ("actuator_force",)
"""Quantities of bought parts that follow the setting of the bracing, hot."""
LOADS_MOVE = {"gear_temperature": 0.25, "centre_distance": 2e-6, "axial_expansion": 2e-6}
"""Change of a field of `CouplingState` [K, m] beyond which the loads are solved again: on the prototype half a
kelvin moves a check on loads by up to 0.001 of its limit, `ranges_verdicts.LEAST_MOVE`, and 5 um do."""


@dataclass(frozen=True, kw_only=True)
class CheckAtEnd:
    """What a check says at one end, at quick fidelity."""

    value: float | None
    margin: float | None
    utilisation: float | None
    verdict: Verdict


@dataclass(frozen=True, kw_only=True)
class EndResult:
    """What came of one end: checks by id and the highest temperature of all housings, or the error."""

    checks: dict[str, CheckAtEnd]
    max_temperature: float | None
    """[degC]"""
    parts: tuple[Part, ...] = ()
    """What was solved again."""
    error: str | None = None


@dataclass(frozen=True, kw_only=True)
class Reference:
    """The converged stated rig, small enough to be sent to worker processes; they make the rest again from it."""

    case: Case
    states: tuple[CouplingState, ...]
    settings: tuple[BracingState | None, ...]
    curves: Curves | None
    ramp: TimeResponse | None
    motor_losses: Array | None
    """Torque of all losses at the motor over ``ramp`` [N m], (n,)."""
    loads: DynamicLoads | None
    key: str


def solve_stated(case: Case) -> tuple[Reference, EndResult]:
    """Solve the stated rig, and its checks."""
    with solver_errors(case), threadpool_limits(limits=1):
        solved = solve_case(case, FIDELITY)
        outcome = _outcome(solved, ())
        run = solved.run
        ramp = None if run is None else peaks_only(run.ramp)
        losses = None if ramp is None else losses_on_motor(solved.rig, solved.test.last, ramp)
    reference = Reference(
        case=case,
        states=tuple(point.last.coupling_state for point in solved.points),
        settings=tuple(point.setting for point in solved.points),
        curves=None if run is None else run.curves,
        ramp=ramp,
        motor_losses=losses,
        loads=solved.loads,
        key=case.hash,
    )
    return reference, outcome


def solve_end(end: RangeEnd, *, reference: Reference) -> EndResult:
    """Solve one end; an error is an outcome that says what happened.

    The stated rig is made once in every process.
    """
    assert end.case is not None
    try:
        with solver_errors(end.case), threadpool_limits(limits=1):
            stated = _stated(reference)
            solved, parts = _moved(stated, end.case, end.parts, reference.motor_losses)
            return _outcome(solved, parts)
    except RigdesignError as error:
        return EndResult(checks={}, max_temperature=None, error=str(error))
    except Exception as error:
        return EndResult(checks={}, max_temperature=None, error=f"{type(error).__name__}: {error}")


_made: dict[str, SolvedRig] = {}
"""The stated rig of this process by the hash of its case; one at a time."""


def _stated(reference: Reference) -> SolvedRig:
    if reference.key not in _made:
        _made.clear()
        _made[reference.key] = _restored(reference)
    return _made[reference.key]


def _restored(reference: Reference) -> SolvedRig:
    """The stated rig with its fields, from its converged coupling state."""
    rig = build_rig(reference.case, FIDELITY)
    points = [
        solve_point(rig, point, start=coupling_state)
        for point, coupling_state in zip(held_points(rig), reference.states, strict=True)
    ]
    run = None
    if reference.curves is not None and reference.ramp is not None:
        run = DynamicRun(points=tuple(points), curves=reference.curves, ramp=reference.ramp)
    return _solved_rig(rig, points, run, reference.loads)


def _moved(
    stated: SolvedRig, case: Case, parts: tuple[Part, ...], motor_losses: Array | None
) -> tuple[SolvedRig, tuple[Part, ...]]:
    """The rig of ``case`` with the named parts solved again and the others those of the stated rig."""
    rig = _rig_like(stated.rig, case, parts)
    points = list(stated.points)
    if "coupling" in parts:
        points = list(_coupled(rig, stated))
        parts = PARTS if stated.run is not None and _loads_move(points, stated.points) else parts
    run, loads = stated.run, stated.loads
    if run is None:
        return _solved_rig(rig, points, None, None), tuple(part for part in parts if part == "coupling")
    test = governing_point(points)
    ramp, solved = run.ramp, list(parts)
    if "time run" not in parts and "coupling" in parts and _asks_for(case, DRIVE):
        assert motor_losses is not None
        shifted = shifted_drive(rig, test.last, run.ramp, motor_losses)
        solved += ["time run"] if shifted is None else []
        ramp = run.ramp if shifted is None else shifted
    if "time run" in solved:
        assert test.setting is not None
        ramp = run_ramp(rig, test.last, test.setting, test.last.coupling_state)
    curves = solve_curves(rig, test.last) if "curves" in parts else run.curves
    run = DynamicRun(points=tuple(points), curves=curves, ramp=ramp)
    if "curves" in parts or "time run" in parts:
        loads = dynamic_loads(rig, run)
    elif loads is not None and "coupling" in parts and _asks_for(case, ACTUATOR):
        loads = replace(loads, bracing=tuple(stage_bracing(rig, point) for point in points))
    return _solved_rig(rig, points, run, loads), tuple(solved)


def _loads_move(points: Sequence[PointResult], stated: Sequence[PointResult]) -> bool:
    """Whether gears or axes are so much warmer or colder that the loads change."""
    return any(
        abs(value - getattr(before.last.coupling_state, name)[part]) > most
        for point, before in zip(points, stated, strict=True)
        for name, most in LOADS_MOVE.items()
        for part, value in getattr(point.last.coupling_state, name).items()
    )


def _rig_like(stated: Rig, case: Case, parts: tuple[Part, ...]) -> Rig:
    """The rig of ``case``; it takes over what the stated rig has computed and the change does not touch."""
    rig = build_rig(case, stated.fidelity)
    if "coupling" not in parts or same_housings(rig, stated):
        take_over(rig, stated, HOUSINGS)
    return rig


def _coupled(rig: Rig, stated: SolvedRig) -> Iterator[PointResult]:
    """The held points from those of the stated rig; its fields are the first guess where the mesh is the same."""
    same = all(rig.models[name] is stated.rig.models[name] for name in rig.models)
    for point, near in zip(held_points(rig), stated.points, strict=True):
        yield solve_point(rig, point, start=near.last.coupling_state, before=near.last if same else None)


def _asks_for(case: Case, quantities: tuple[str, ...]) -> bool:
    return any(
        part.given is None and part.quantity in quantities for part in case.limits.bought_parts.values()
    )


def _solved_rig(
    rig: Rig, points: Sequence[PointResult], run: DynamicRun | None, loads: DynamicLoads | None
) -> SolvedRig:
    """The records of solved points; nothing is solved to compare."""
    temperatures = [housing_temperatures(rig, *found) for found in housing_fields(points)]
    return solved_rig(rig, points, temperatures, run=run, loads=loads)


def _outcome(solved: SolvedRig, parts: tuple[Part, ...]) -> EndResult:
    return EndResult(
        checks={check.id: _at_end(check) for check in held_checks(solved)},
        max_temperature=max((found.highest - ZERO for found in solved.temperatures), default=None),
        parts=parts,
    )


def _at_end(check: Check) -> CheckAtEnd:
    return CheckAtEnd(
        value=check.value, margin=check.margin, utilisation=check.utilisation, verdict=check.verdict
    )

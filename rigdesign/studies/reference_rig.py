"""The solved rig from which modified ones start: small enough to be sent to worker processes, restored there once."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from threadpoolctl import threadpool_limits

from dynamics.vibration.time_response import TimeResponse
from rigdesign.base.errors import NotConvergedError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.fields import ModelPart
from rigdesign.case.model import Case
from rigdesign.coupling.fixed_point import Anderson
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.curves import Curves
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.solved_rig import LawSpread, SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.loads import EventRecord
from rigdesign.results.result import DiscretisationRow
from rigdesign.results.units import ZERO
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.main import Progress, solve_case
from rigdesign.run.solver_errors import solver_errors
from rigdesign.studies.modified_rig import Reanalysis, modified_rig, with_records
from rigdesign.studies.shifted_run import Array, losses_on_motor, peaks_only


@dataclass(frozen=True, kw_only=True)
class Reference:
    """A converged rig as its coupling states and its dynamic response; `restored` makes the rest again from it."""

    case: Case
    fidelity: Fidelity
    states: tuple[CouplingState, ...]
    curves: Curves | None
    ramp: TimeResponse | None
    motor_losses: Array | None
    """Torque of all losses at the motor over ``ramp`` [N m], (n,)."""
    events: tuple[EventRecord, ...]
    discretisation: tuple[DiscretisationRow, ...]
    law_spreads: tuple[LawSpread, ...]
    key: str


@dataclass(frozen=True, kw_only=True)
class ReanalysisResult:
    """What is kept of a modified rig.

    max_temperature_degC : highest of all housings, None without one
    parts : solved again
    """

    checks: Sequence[Check]
    max_temperature_degC: float | None  # noqa: N815
    parts: tuple[ModelPart, ...]


def solve_reference(
    case: Case, fidelity: Fidelity, say: Progress = lambda message: None
) -> tuple[Reference, SolvedRig]:
    """Solve a case as `rigdesign check` does."""
    with solver_errors(case), threadpool_limits(limits=1):
        solved = solve_case(case, fidelity, say)
        run = solved.run
        ramp = None if run is None else peaks_only(run.ramp)
        losses = None if ramp is None else losses_on_motor(solved.rig, solved.test.last, ramp)
    reference = Reference(
        case=case,
        fidelity=fidelity,
        states=tuple(point.last.coupling_state for point in solved.points),
        curves=None if run is None else run.curves,
        ramp=ramp,
        motor_losses=losses,
        events=tuple(solved.events),
        discretisation=tuple(solved.discretisation),
        law_spreads=tuple(solved.law_spreads),
        key=f"{case.hash} {fidelity}",
    )
    return reference, solved


def reanalysed(
    reference: Reference, again: Reanalysis, evaluate: Callable[[SolvedRig], Sequence[Check]]
) -> ReanalysisResult:
    """A modified case from the reference rig; ``evaluate`` gives the checks of a solved rig.

    Raises
    ------
    RigdesignError
        The modified case has no result.
    """
    with solver_errors(again.case), threadpool_limits(limits=1):
        solved, parts = modified_rig(restored(reference), again, reference.motor_losses)
        return result_of(_with_errors(solved, reference), evaluate, parts)


def result_of(
    solved: SolvedRig, evaluate: Callable[[SolvedRig], Sequence[Check]], parts: tuple[ModelPart, ...] = ()
) -> ReanalysisResult:
    """The checks of a solved rig and its highest temperature."""
    hottest = max((found.max_temperature - ZERO for found in solved.temperatures), default=None)
    return ReanalysisResult(checks=evaluate(solved), max_temperature_degC=hottest, parts=parts)


_made: dict[str, SolvedRig] = {}
"""The reference rig of this process by its key; one at a time."""


def restored(reference: Reference) -> SolvedRig:
    """The reference rig with its fields, from its converged coupling states; made once in every process."""
    if reference.key not in _made:
        _made.clear()
        _made[reference.key] = _restored(reference)
    return _made[reference.key]


def _restored(reference: Reference) -> SolvedRig:
    rig = build_rig(reference.case, reference.fidelity)
    points = [
        _point(rig, point, coupling_state)
        for point, coupling_state in zip(held_points(rig), reference.states, strict=True)
    ]
    run = None
    if reference.curves is not None and reference.ramp is not None:
        run = DynamicRun(tuple(points), reference.curves, reference.ramp)
    solved = with_records(rig, points, run)
    return replace(_with_errors(solved, reference), events=reference.events)


def _with_errors(solved: SolvedRig, reference: Reference) -> SolvedRig:
    """A rig whose checks are as far off as those of the reference."""
    return replace(solved, discretisation=reference.discretisation, law_spreads=reference.law_spreads)


def _point(rig: Rig, point: OperatingPoint, converged: CouplingState) -> PointResult:
    """A held point at its converged coupling state, with the secants of the iterations that lead there."""
    try:
        near = solve_point(rig, point, acceleration=Anderson(initial_state(rig, point)))
    except NotConvergedError:
        return solve_point(rig, point, start=converged)
    found = solve_point(rig, point, start=converged, before=near.last)
    return replace(found, differences=near.differences)

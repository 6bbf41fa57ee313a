"""The coupling loop: iterations at one operating point until nothing moves any more."""

from collections.abc import Sequence
from dataclasses import dataclass

from rigdesign.base.errors import NotConvergedError
from rigdesign.base.finite import require_finite
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.iteration import IterationResult, heat_residual, next_state, run_iteration
from rigdesign.coupling.loads import BracingState, brace_initial
from rigdesign.coupling.state import (
    CouplingState,
    OperatingPoint,
    length_change,
    temperature_change,
    torque_change,
)
from rigdesign.rig.model import Rig

EXPANSION_FROM = 8.0
"""Change of temperature in an iteration [K] below which the next one is fine: it expands the housings afresh."""


@dataclass(frozen=True, kw_only=True)
class Residual:
    """Largest changes of one iteration: temperature [K], length [m], mean torque relative [-]."""

    temperature: float
    length: float
    torque: float


@dataclass(frozen=True, kw_only=True)
class PointResult:
    """The settled state of one operating point."""

    point: OperatingPoint
    last: IterationResult
    setting: BracingState | None
    residuals: tuple[Residual, ...]


def governing_point(points: Sequence[PointResult]) -> PointResult:
    """The held point that speaks for the rig where only one can: most torque, of equals the fastest, then the last.

    Checks do not ask it: they take the worst over all held points.
    """
    return max(reversed(points), key=lambda result: (abs(result.point.torque), result.point.speed))


def solve_point(
    rig: Rig,
    point: OperatingPoint,
    *,
    start: CouplingState | None = None,
    before: IterationResult | None = None,
    freeze: frozenset[str] = frozenset(),
) -> PointResult:
    """Repeat the iteration until temperatures, lengths and torques stay within the tolerances of the case.

    Parameters
    ----------
    start : coupling state of a neighbouring point; the cold rig when left out
    before : last iteration of a neighbouring point on the same meshes: first guess of fields and thermal expansion
    freeze : arrows of the loop that are cut, by field of `CouplingState`: they keep their initial values

    Raises
    ------
    NotConvergedError
        The iterations of the case are used up; the message shows the residuals of the last ones.
    NonFiniteResultError
        A loss, temperature, length or torque of an iteration is NaN or infinite.
    """
    numerics = rig.case.numerics
    cold = initial_state(rig, point)
    setting = None if rig.case.drivetrain is None else brace_initial(rig, point, cold)
    coupling_state = cold if start is None else start.freeze(freeze, cold)
    residuals: list[Residual] = []
    done = before
    for _ in range(numerics.coupling_passes):
        fine = not residuals or residuals[-1].temperature < EXPANSION_FROM
        done = run_iteration(rig, point, coupling_state, setting, done, fine=fine)
        after = next_state(rig, done).freeze(freeze, cold)
        require_finite(after, f"stage {point.stage}")
        heat = 0.0 if {"bearing_heat", "wall_heat"} & freeze else heat_residual(rig, done)
        residuals.append(
            Residual(
                temperature=max(temperature_change(coupling_state, after), heat),
                length=length_change(coupling_state, after),
                torque=torque_change(coupling_state, after),
            )
        )
        coupling_state = after
        if fine and _settled(residuals[-1], rig):
            return PointResult(point=point, last=done, setting=setting, residuals=tuple(residuals))
    history = {
        "stage": point.stage,
        "residuals": [
            {"temperature_K": r.temperature, "growth_um": 1e6 * r.length, "torque_relative": r.torque}
            for r in residuals
        ],
    }
    raise NotConvergedError(_history(point, residuals, rig), history)


def _settled(residual: Residual, rig: Rig) -> bool:
    numerics = rig.case.numerics
    return (
        residual.temperature <= numerics.temperature_tolerance
        and residual.length <= numerics.growth_tolerance
        and residual.torque <= numerics.torque_tolerance
    )


def _history(point: OperatingPoint, residuals: list[Residual], rig: Rig) -> str:
    numerics = rig.case.numerics
    lines = "; ".join(
        f"iteration {len(residuals) - i}: {r.temperature:.3g} K, {1e6 * r.length:.3g} um, {r.torque:.2g} of the torque"
        for i, r in enumerate(reversed(residuals[-4:]))
    )
    return (
        f"coupling at stage {point.stage!r} did not converge in {len(residuals)} iterations (limits "
        f"{numerics.temperature_tolerance:g} K, {1e6 * numerics.growth_tolerance:g} um, "
        f"{numerics.torque_tolerance:g}): {lines}; raise numerics.coupling_passes, or feed more oil if a film or "
        "stream swings"
    )

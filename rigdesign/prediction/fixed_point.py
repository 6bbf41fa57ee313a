"""Settling a point of the coupling loop in few iterations: steps from differences of iterations already made.

The iterations are those of `rigdesign.coupling.loop`; only the way to the point where nothing moves is another. The
next coupling state takes the directions in which earlier iterations moved into account (Anderson acceleration, a
multi-secant quasi-Newton method). Differences of a neighbouring case serve as well, so that a changed case needs two
or three iterations from the settled one.
Source: Walker, Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import NotConvergedError
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.iteration import IterationParts, IterationResult, next_state, run_iteration
from rigdesign.coupling.loads import brace_initial
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.prediction.readings import Settled
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

SCALES = {
    "gear_temperature": 1.0,
    "oil_outlet": 1.0,
    "centre_distance": 1e-6,
    "bearing_clearance": 1e-6,
    "axial_expansion": 1e-6,
    "bearing_heat": 10.0,
    "wall_heat": 10.0,
    "mesh_torque": 1.0,
}
"""Size of each arrow of the loop that counts as one [K, m, W, N m]."""
CLOSE = 1e-3
"""Largest change of an iteration, in those sizes, at which a point has settled: a millikelvin, a nanometre."""
PASSES = 40
"""Iterations at most."""
MEMORY = 12
"""Differences that are kept."""
FLOOR = 1e-9
"""Relative size of a singular value below which a direction is left out."""


@dataclass(frozen=True)
class SettledPoint(Settled):
    """A settled point with what its neighbours may use."""

    steps: FloatArray
    """(n, k) differences of the coupling state that passes started from."""
    answers: FloatArray
    """(n, k) differences of what came of it."""
    left: FloatArray
    """(n,) what the last iteration would still move, heats not relaxed, in sizes of `SCALES`."""
    passes: int


def flat(coupling_state: CouplingState) -> FloatArray:
    """(n,) the coupling state in sizes of `SCALES`."""
    parts = [
        np.fromiter(getattr(coupling_state, entry.name).values(), dtype=np.float64) / SCALES[entry.name]
        for entry in fields(coupling_state)
    ]
    return np.concatenate(parts)


def unflat(values: FloatArray, like: CouplingState) -> CouplingState:
    """The coupling state of (n,) values, with the names of another."""
    found: dict[str, dict[str, float]] = {}
    start = 0
    for entry in fields(like):
        names = getattr(like, entry.name)
        part = values[start : start + len(names)] * SCALES[entry.name]
        found[entry.name] = dict(zip(names, part.tolist()))
        start += len(names)
    return CouplingState(**found)


def ordered(coupling_state: CouplingState, like: CouplingState) -> CouplingState:
    """The coupling state with its names in the order of another."""
    return CouplingState(
        **{
            entry.name: {
                name: getattr(coupling_state, entry.name)[name] for name in getattr(like, entry.name)
            }
            for entry in fields(like)
        }
    )


def raw(rig: Rig, done: IterationResult, parts: IterationParts, like: CouplingState) -> CouplingState:
    """What an iteration hands on, heats not relaxed, names in the order of ``like``."""
    after = next_state(rig, done, parts)
    after = replace(after, bearing_heat=done.bearing_heat, wall_heat=done.wall_heat)
    return ordered(after, like)


def solve_fixed_point(
    rig: Rig,
    point: OperatingPoint,
    parts: IterationParts,
    near: SettledPoint | None = None,
    inverse: NDArray[np.floating] | None = None,
    *,
    close: float = CLOSE,
    start: CouplingState | None = None,
) -> SettledPoint:
    """Iterations until none of them moves anything by more than ``close``.

    near : a settled point nearby, to start from; the cold rig when left out
    start : coupling state to start from where there is no point nearby
    inverse : (n, n) of `PointSensitivities` at that point: then each iteration is followed by a step of Newton's
    method with it

    Raises
    ------
    NotConvergedError
        `PASSES` are used up.
    """
    cold = initial_state(rig, point)
    bracing = None if rig.case.drivetrain is None else brace_initial(rig, point, cold)
    given = start if near is None else near.last.coupling_state
    coupling_state = cold if given is None else ordered(given, cold)
    done = None if near is None else near.last
    steps: list[FloatArray] = []
    answers: list[FloatArray] = []
    if near is not None and inverse is None:
        steps, answers = list(near.steps.T), list(near.answers.T)
    before: tuple[FloatArray, FloatArray] | None = None
    x = flat(coupling_state)
    for count in range(1, PASSES + 1):
        done = run_iteration(rig, point, coupling_state, bracing, done, parts=parts)
        handed = flat(raw(rig, done, parts, cold)) - x
        relaxed = flat(ordered(next_state(rig, done, parts), cold)) - x
        left = relaxed if inverse is None else inverse @ handed
        after = x + left
        if before is not None:
            steps.append(x - before[0])
            answers.append(after - before[1])
            steps, answers = steps[-MEMORY:], answers[-MEMORY:]
        if float(np.abs(left).max()) <= close:
            return SettledPoint(
                point, done, bracing, _columns(steps, len(x)), _columns(answers, len(x)), handed, count
            )
        before = x, after
        x = _next(x, after, steps, answers)
        coupling_state = unflat(x, cold)
    raise NotConvergedError(
        f"coupling at {point.stage!r} did not converge in {PASSES} iterations: the last one still moved the state by "
        f"{float(np.abs(left).max()):.3g} (limit {close:g}; kelvin, micrometres, 10 W); feed more oil if a film or "
        "stream swings"
    )


def _columns(vectors: Sequence[FloatArray], n: int) -> FloatArray:
    return np.array(vectors).T if vectors else np.empty((n, 0))


def _next(
    x: FloatArray, after: FloatArray, steps: Sequence[FloatArray], answers: Sequence[FloatArray]
) -> FloatArray:
    """Where the differences say that nothing would move."""
    if not steps:
        return after
    moved, came = np.array(steps).T, np.array(answers).T
    size = np.linalg.norm(came - moved, axis=0)
    kept = size > 0.0
    change = (came - moved)[:, kept] / size[kept]
    share = np.linalg.lstsq(change, after - x, rcond=FLOOR)[0]
    return np.asarray(after - (came[:, kept] / size[kept]) @ share)

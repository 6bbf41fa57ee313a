"""The linear loop at a few speeds, bearings as they run there under the torque of a held point or a share of it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.mode_names import elastic_loop_modes
from dynamics.rotor.torsional_modes import LoopMode, loop_modes
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.case.schedule import StageValues
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_over_speed import under_share
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.rig.model import Rig

COUNT = 6
"""Speeds over the range, evenly in their logarithm; those at which the rig dwells come on top."""
SLOWEST = 0.04
"""Lowest speed, as a share of the highest: bearings below are those there."""
AROUND = 0.2
"""Speeds that count as around a dwell speed, as a share of it: twice the usual margin."""
SAME = 0.03
"""Share of a dwell speed within which another speed is left out."""


@dataclass(frozen=True)
class LoopState:
    """The loop at a stated speed [rad/s]; state : None where the shafts only twist."""

    speed: float
    system: LinearSystem
    state: RunningState | None


def loop_states(rig: Rig, held: PointResult, top: float, share: float = 1.0) -> tuple[LoopState, ...]:
    """States up to a stated speed [rad/s], rising.

    share : mesh torques that load the bearings, per those of the held point
    Shafts that only twist have one loop for all speeds, its lowest and highest, but for splines with a loss factor.
    """
    at_held = [speed for speed in dwell_speeds(rig) if 0.0 < speed <= top]
    grid = np.geomspace(SLOWEST * top, top, COUNT).tolist()
    if rig.shaft_model == "torsional":
        speeds = {*grid, *at_held} if rig.twisting.follows_speed else {grid[0], *at_held, top}
        return tuple(LoopState(speed, rig.twisting.at(speed), None) for speed in sorted(speeds))
    free = [speed for speed in grid if all(abs(speed - own) > SAME * own for own in at_held)]
    return tuple(state_at(rig, held, speed, share) for speed in sorted({*free, *at_held}))


def dwell_stages(rig: Rig) -> tuple[StageValues, ...]:
    """Stages with a speed at which the rig dwells, that at their end: those that turn at one speed, whatever the torque
    does meanwhile, for a resonance rises within a fraction of a second; and held ones, whose temperatures settle there.
    """
    held = {stage.name for stage in rig.case.schedule.held()}
    return tuple(
        stage
        for stage in rig.case.schedule.resolved()
        if stage.speed_end > 0.0
        and (stage.kind == "dwell" or stage.name in held or stage.speed_start == stage.speed_end)
    )


def dwell_speeds(rig: Rig) -> tuple[float, ...]:
    """Stated speeds of `dwell_stages` and that of the test, each once, those of held stages first [rad/s]."""
    held = (stage.speed_end for stage in rig.case.schedule.held() if stage.speed_end > 0.0)
    others = (stage.speed_end for stage in dwell_stages(rig))
    return tuple(dict.fromkeys([*held, rig.case.schedule.test_speed, *others]))


def state_at(rig: Rig, held: PointResult, speed: float, share: float = 1.0) -> LoopState:
    """The loop at one stated speed [rad/s], gears as warm as at the held point; share : as of `loop_states`."""
    if rig.shaft_model == "torsional":
        return LoopState(speed, rig.twisting.at(speed), None)
    last = held.last
    point = replace(last.point, speed=speed)
    if speed == last.point.speed and share == 1.0:
        state = running_state(rig, point, last.coupling_state, last.bearings)
        return LoopState(speed, last.system or rig.elastic.seen.system(state), state)
    loaded = under_share(last.coupling_state, share)
    state = running_state(rig, point, loaded, solve_bearings(rig, point, loaded))
    return LoopState(speed, rig.elastic.seen.system(state), state)


def nearest(states: Sequence[LoopState], speed: float) -> LoopState:
    """The state whose speed is nearest in its logarithm."""
    return min(states, key=lambda state: abs(np.log(state.speed / speed)))


def is_around(speed: float, dwell: float) -> bool:
    """Whether a speed counts as one of those around a dwell speed."""
    return abs(speed - dwell) <= AROUND * dwell


def chosen(points: Sequence[CurvePoint], most: int, dwells: Sequence[float] = ()) -> list[CurvePoint]:
    """At most so many points of a curve, evenly by their number, with all at which the torque of a mesh peaks; on top
    all around a dwell speed [rad/s] (`is_around`), where shafts peak between the meshes."""
    if len(points) <= most:
        return list(points)
    swing = np.array([point.dynamic_factor_half_peak_to_peak for point in points])
    inner = (swing[1:-1] >= swing[:-2]) & (swing[1:-1] >= swing[2:])
    peaks = set((np.flatnonzero(inner.any(axis=1)) + 1).tolist())
    rest = max(2, most - len(peaks))
    even = set(np.linspace(0, len(points) - 1, rest).round().astype(int).tolist())
    near = {i for i, point in enumerate(points) if any(is_around(point.speed, dwell) for dwell in dwells)}
    return [points[i] for i in sorted(peaks | even | near)]


# Natural modes of the closed loop at a held point or another speed, with its bearings as they run there.


def held_modes(rig: Rig, held: PointResult) -> tuple[LoopMode, ...]:
    """Modes up to the highest that is followed: rigid rotation first, then by frequency."""
    return warm_modes(rig, held.last)


def warm_modes(rig: Rig, last: IterationResult) -> tuple[LoopMode, ...]:
    """As `held_modes`, of the last iteration at a point."""
    twists = rig.shaft_model == "torsional"
    state = None if twists else running_state(rig, last.point, last.coupling_state, last.bearings)
    return _modes(rig, last, state)


def modes_at(rig: Rig, held: PointResult, speed: float) -> tuple[LoopMode, ...]:
    """As `held_modes`, with the bearings as they run at a stated speed [rad/s] under the torque of the held point."""
    return _modes(rig, held.last, state_at(rig, held, speed).state)


def _modes(rig: Rig, last: IterationResult, state: RunningState | None) -> tuple[LoopMode, ...]:
    assert rig.drivetrain is not None
    laws = laws_of(last.models)
    if state is None:
        return loop_modes(rig.drivetrain, laws, DEFAULT_CUTOFF)
    return elastic_loop_modes(rig.elastic.seen, state, laws, DEFAULT_CUTOFF)

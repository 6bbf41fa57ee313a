"""K_V over speed: simulated, and by ISO 6336-1."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from dynamics.rating.iso_rating import RatingOptions, dynamic_factor
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.damped_modes import elastic_loop_modes
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.rotor.torsional_modes import LoopMode, loop_modes
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from dynamics.vibration.response_curve import CurvePoint, ResponseCurve
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response, refined_response
from rigdesign.base.part_name import MeshName
from rigdesign.case.schedule import StageValues
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_over_speed import loop_over_speed, under_share
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import locked_share, periodic_laws, signed_torque
from rigdesign.coupling.time_run import held_points
from rigdesign.results.dynamics import DynamicFactorPoint
from rigdesign.rig.model import Rig

QUICK_SPEEDS = 24
"""Speeds of a curve at quick fidelity, or where every speed is solved over a whole revolution."""
MERGED = 0.02
"""Share of a speed, away from those at which the rig dwells, within which another one serves a resonance as well."""
ROUNDS = 2
"""Halvings of the speed step around a peak."""
SLOWEST = 0.05
"""Share of a held speed below which no resonance is looked for."""
BEYOND = 1.25
"""How far past the least distance of a resonance the curve goes on, as a share of that distance."""
HARMONICS = 4
"""Mesh orders that may excite a mode."""
LEAST_GAIN = 0.1
"""Gain of a mode below which its mesh hardly excites it (`LoopMode.mesh_gain`)."""
HARDNESS = ("case_hardened", "nitrided", "through_hardened")
"""Treatments of flanks from hard to soft: the softer gear of a mesh runs in."""
DEFAULT = RatingOptions()


@dataclass(frozen=True)
class Curves:
    """Response over speed of the warm rig."""

    response: ResponseCurve
    """At the torque of the governing held point, past the highest held speed."""
    others: Mapping[float, ResponseCurve]
    """At every other torque [N m, at the control mesh] at which the schedule holds or changes the speed."""
    torque: float
    """Of ``response`` [N m]."""

    @property
    def named(self) -> Mapping[str, tuple[float, ResponseCurve]]:
        """Every curve with its torque, by its name in the results."""
        found = {self.torque: self.response, **self.others}
        return {f"{abs(torque):g} Nm": (torque, curve) for torque, curve in found.items()}


def solve_curves(rig: Rig, warm: IterationResult) -> Curves:
    """Periodic response over speed at every torque of the schedule, warm gears of ``warm``."""
    curves = {torque: curve_at(rig, warm, torque, limits) for torque, limits in speed_ranges(rig).items()}
    torque = torque_key(signed_torque(rig, warm.point))
    return Curves(response=curves.pop(torque), others=curves, torque=torque)


def speed_ranges(rig: Rig) -> dict[float, tuple[float, float]]:
    """Torque at the control mesh [N m] -> stated speeds [rad/s] between which its response is wanted.

    Held torques: the range of the case, widened until a resonance too near to any held speed lies within it.
    Torques under which the speed changes: what the stage runs through of the range of the case. Stages at the
    start torque are left to the time run: they are short, and flanks may part there without harm.
    """
    numerics = rig.case.numerics
    first, last = numerics.curve_speed_start, numerics.curve_speed_end
    away = BEYOND * (rig.case.limits.dynamics.resonance_distance_minimum or 0.0)
    light = rig.case.limits.bearing.start_torque_limit or 0.0
    held = held_points(rig)
    low = max(1.0 - away, SLOWEST) * min(point.speed for point in held)
    high = (1.0 + away) * max(point.speed for point in held)
    ranges = {torque_key(signed_torque(rig, point)): (min(first, low), max(last, high)) for point in held}
    for stage in rig.case.schedule.resolved():
        torque = torque_key(rig.torque_ratio * stage.torque_end * locked_share(rig))
        low, high = sorted((stage.speed_start, stage.speed_end))
        low, high = max(low, first), min(high, last)
        if stage.kind in ("run_up", "run_down") and abs(stage.torque_end) > light and low < high:
            before = ranges.get(torque, (low, high))
            ranges[torque] = (min(low, before[0]), max(high, before[1]))
    return ranges


def torque_key(torque: float) -> float:
    """Torques that differ by round-off are one."""
    return round(torque, 6)


def grid(rig: Rig, low: float, high: float) -> list[float]:
    """Even speeds of the first pinion [rad/s] as dense as the case asks; few at quick and where a whole revolution is
    solved."""
    numerics = rig.case.numerics
    count = numerics.curve_speeds if dense(rig) else QUICK_SPEEDS
    step = (numerics.curve_speed_end - numerics.curve_speed_start) / (count - 1)
    if step <= 0.0:
        return [rig.pinion_speed(speed) for speed in dict.fromkeys((low, high))]
    pieces = max(1, math.ceil((high - low) / step - 1e-9))
    return [rig.pinion_speed(float(speed)) for speed in np.linspace(low, high, pieces + 1)]


def resolved(rig: Rig) -> bool:
    """Whether the curves show every resonance: at quick few speeds are even, the others are those of the resonances."""
    return rig.case.numerics.response_period == "mesh"


def dense(rig: Rig) -> bool:
    """Whether speeds are as dense as the case asks, and more where a section of the shafts peaks between them."""
    return resolved(rig) and rig.fidelity != "quick"


def resonance_speeds(
    rig: Rig, warm: IterationResult, low: float, high: float
) -> Iterator[tuple[float, float]]:
    """Speeds of the first pinion between two [rad/s] at which orders of a mesh meet the modes that it drives, bearings
    as in ``warm``, and how far from it the amplitude of the mode has fallen by a third [rad/s]."""
    modes = warm_modes(rig, warm)
    for mesh, name in enumerate(rig.mesh_names):
        teeth = own_ratio(rig, mesh) * rig.pairs[name].teeth[0]
        for mode in modes:
            if mode.mesh_gain[mesh] >= LEAST_GAIN:
                for order in range(1, HARMONICS + 1):
                    speed = 2.0 * math.pi * mode.frequency / (order * teeth)
                    if low < speed < high:
                        yield speed, mode.damping_ratio * speed


def response_solver(
    rig: Rig,
    warm: IterationResult,
    torque: float,
    limits: tuple[float, float],
    *,
    stable_only: bool = False,
) -> Callable[[Sequence[float]], ResponseCurve]:
    """Finds the periodic response at speeds of the first pinion [rad/s] at one torque [N m, at the control mesh].

    Bearings run under that torque.

    limits : lowest and highest of these speeds
    stable_only : stable states that repeat in every mesh, by harmonic balance; none at speeds where there are none
    """
    settings = SweepSettings(period=rig.case.numerics.response_period, cutoff=rig.highest_mode)
    if stable_only:
        settings = replace(settings, methods=("harmonic_balance",), branches=False)
    share = torque / signed_torque(rig, warm.point)
    ends = [speed / rig.pinion_speed(1.0) for speed in limits]
    drivetrain = loop_over_speed(rig, warm, (ends[0], ends[1]), lambda _: share)
    return partial(
        periodic_response, drivetrain, periodic_laws(rig, laws_of(warm.models)), load=LoopLoad(torque=torque),
        drag_torques=warm.drags, settings=settings,
    )  # fmt: skip


def curve_at(rig: Rig, warm: IterationResult, torque: float, limits: tuple[float, float]) -> ResponseCurve:
    """Periodic response over speed at one torque [N m, at the control mesh], warm gears of ``warm``.

    limits : lowest and highest stated speed [rad/s]
    """
    speeds = grid(rig, *limits)
    if resolved(rig):
        dwells = [rig.pinion_speed(speed) for speed in dwell_speeds(rig)]
        for speed, width in resonance_speeds(rig, warm, min(speeds), max(speeds)):
            decides = any(is_around(speed, dwell) for dwell in dwells)
            near = 0.0 if decides else width if dense(rig) else MERGED * speed
            if all(abs(speed - other) > near for other in speeds):
                speeds.append(speed)
        speeds.sort()
    solve = response_solver(rig, warm, torque, (min(speeds), max(speeds)))
    if not resolved(rig):
        return solve(speeds)
    return refined_response(solve, speeds, rounds=ROUNDS if dense(rig) else 1)


def rating_options(rig: Rig, name: MeshName) -> RatingOptions:
    """What ISO 6336-1 needs of a mesh in addition to its geometry; profile crowning counts as tip relief C_a."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    relief = min(gear.flank.tip_relief or gear.flank.profile_crowning for gear in gears)
    solid = [rig.materials[gear.material] for gear in gears]
    first, second = (material.flank_strength or DEFAULT.sigma_hlim[0] for material in solid)
    softest = max((material.treatment for material in solid), key=HARDNESS.index)
    return RatingOptions(
        grade=max(gear.quality_grade for gear in gears),
        tip_relief=relief if relief > 0.0 else None,
        sigma_hlim=(first, second),
        run_in=softest,
        application_factor=entry.application_factor,
        low_load_factor=entry.low_load_factor,
    )


def iso_factor(rig: Rig, name: MeshName, torque: float, speed: float) -> DynamicFactor:
    """K_V of one mesh by ISO 6336-1 method B; torque [N m] and speed [rad/s] of its pinion, gears as drawn."""
    box, own = rig.mesh(name)
    return dynamic_factor(
        rig.pairs[name], abs(torque) / box.meshes[own].sharing, speed, rating_options(rig, name)
    )


def own_ratio(rig: Rig, mesh: int) -> float:
    """Speed of the pinion of a mesh per speed of the first pinion."""
    box, own = rig.mesh(rig.mesh_names[mesh])
    return rig.shaft_speed(box.gears[box.meshes[own].pinion].shaft, 1.0) / rig.pinion_speed(1.0)


def factor_points(rig: Rig, mesh: int, curve: ResponseCurve) -> list[DynamicFactorPoint]:
    """The K_V(n) curve of one mesh with that of ISO 6336-1, over the speed of its own pinion."""
    name = rig.mesh_names[mesh]
    ratio = own_ratio(rig, mesh)
    other = {point.speed: float(point.dynamic_factor[mesh]) for point in curve.other_branch}
    points = []
    for point in curve.points:
        speed = point.speed * ratio
        iso = iso_factor(rig, name, float(point.mean[mesh]), speed)
        points.append(
            DynamicFactorPoint(
                speed_rpm=speed * 30.0 / math.pi,
                simulated=float(point.dynamic_factor[mesh]),
                simulated_half_peak_to_peak=float(point.dynamic_factor_half_peak_to_peak[mesh]),
                iso_6336_1_method_b=iso.K_V,
                method=point.method,
                motion=point.motion.kind,
                other_branch=other.get(point.speed),
            )
        )
    return points


# The linear loop at a few speeds, bearings as they run there under the torque of a held point or a share of it.

COUNT = 6
"""Speeds over the range, evenly in their logarithm; those at which the rig dwells come on top."""
SLOWEST_STATE = 0.04
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
    grid = np.geomspace(SLOWEST_STATE * top, top, COUNT).tolist()
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
    laws = laws_of(last.models)
    if state is None:
        return loop_modes(rig.drivetrain, laws, DEFAULT_CUTOFF)
    return elastic_loop_modes(rig.elastic.seen, state, laws, DEFAULT_CUTOFF)

"""K_V over speed: simulated, and by ISO 6336-1."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from dynamics.rating.iso_rating import RatingOptions, dynamic_factor
from dynamics.rotor.static_loop import LoopLoad
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from dynamics.vibration.response_curve import ResponseCurve
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response, refined_response
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop_over_speed import loop_over_speed
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import locked_share, periodic_laws, signed_torque
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.loop_states import dwell_speeds, is_around, warm_modes
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


def rating_options(rig: Rig, name: str) -> RatingOptions:
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


def iso_factor(rig: Rig, name: str, torque: float, speed: float) -> DynamicFactor:
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

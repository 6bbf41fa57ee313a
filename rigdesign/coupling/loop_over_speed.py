"""Matrices of the power circuit over speed: bands in which bearings and gyroscopic moments stay as they are."""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

from dynamics.drivetrain.linear_system import DrivetrainOverSpeed, SpeedBands
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig

WIDTH = 1.25
"""Ratio of the speeds of neighbouring bands: over one, a film changes its stiffness by a tenth."""
SLOWEST = 0.02
"""Share of the highest speed below which the bearings stay as they are there."""
TOP = 0.98
"""Share of the highest speed from which the bearings are those at that speed."""
LIGHTEST = 0.02
"""Share of the held torque below which the bearings stay as they are under it."""


def loop_over_speed(
    rig: Rig, warm: IterationResult, speeds: tuple[float, float], torque_share: Callable[[float], float]
) -> DrivetrainOverSpeed:
    """The drivetrain of a warm rig between two speeds, matrices without the meshes.

    speeds : lowest and highest stated speed [rad/s]
    torque_share : mesh torques that load the bearings at a stated speed, per those of ``warm``
    """
    if rig.shaft_model == "torsional" and not rig.twisting.follows_speed:
        return rig.twisting.at(warm.point.speed)
    edges = _edges(speeds)
    high = edges[-1]
    systems = []
    for first, last in pairwise(edges):
        point = replace(warm.point, speed=high if last == high else math.sqrt(first * last))
        state = under_share(warm.coupling_state, torque_share(point.speed))
        systems.append(loop_system(rig, point, state, solve_bearings(rig, point, state)))
    return SpeedBands(limits=band_limits(rig, speeds), systems=tuple(systems))


def under_share(coupling_state: CouplingState, share: float) -> CouplingState:
    """A coupling state whose mesh torques load the bearings with a share of theirs, `LIGHTEST` at least."""
    share = math.copysign(max(abs(share), LIGHTEST), share)
    return coupling_state.with_torque_share(share)


def band_limits(rig: Rig, speeds: tuple[float, float]) -> tuple[float, ...]:
    """Speeds of the first pinion at which the bands between two stated speeds meet, rising [rad/s]; none where the
    matrices are the same at all of them."""
    if rig.shaft_model == "torsional" and not rig.twisting.follows_speed:
        return ()
    return tuple(rig.pinion_speed(edge) for edge in _edges(speeds)[1:-1])


def _edges(speeds: tuple[float, float]) -> list[float]:
    """Stated speeds at which bands begin and end, rising [rad/s]."""
    high = max(speeds)
    low = max(min(speeds), SLOWEST * high)
    count = max(1, math.ceil(math.log(high / low) / math.log(WIDTH)))
    edges = [low * (high / low) ** (i / count) for i in range(count + 1)]
    edges.insert(-1, TOP * high)  # the speed that is held in the end has a band of its own
    return edges

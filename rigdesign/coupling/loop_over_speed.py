"""Matrices of the power circuit over speed: bands in which bearings and gyroscopic moments stay as they are."""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.linear_system import DrivetrainOverSpeed, SpeedBands
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.located_loss import PlacedLoss, PointLosses, drag_torques
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.losses import mesh_losses, oil_jets, rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import BracingState, LoadedCircuit, respond
from rigdesign.coupling.state import CouplingState, OperatingPoint
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


# Losses at any operating point with the warm rig of a held stage: no coupling.


def stage_losses(rig: Rig, point: OperatingPoint, test: PointResult, *, dynamic: bool) -> PointLosses:
    """Losses at ``point`` with the geometry and temperatures of the held stage ``test``.

    Tooth forces follow the torque; the bearing films get no heat from the bodies. At standstill
    only the jets heat: their pump runs.

    dynamic : friction and mesh damping of the periodic response at this point, as at a held stage; else sliding at
        the mean load alone. Where no response is found it is the mean load as well, and the mesh losses warn of it
    """
    share = point.torque / test.point.torque if test.point.torque else 0.0
    coupling_state = replace(
        test.last.coupling_state.with_torque_share(share),
        bearing_heat=dict.fromkeys(test.last.coupling_state.bearing_heat, 0.0),
    )
    bearings = solve_bearings(rig, point, coupling_state)
    if point.speed == 0.0:
        jets = tuple(oil_jets(rig, point, rig.pairs))
        return PointLosses(point=point, coupling_state=coupling_state, bearings=bearings, losses=jets)
    models = mesh_models(rig, point, coupling_state)
    rotating = rotating_losses(rig, point, coupling_state, models, bearings)
    response = None
    if dynamic and rig.case.drivetrain is not None:
        system = loop_system(rig, point, coupling_state, bearings)
        drags = drag_torques(rotating, rig, point.speed)
        response = _response(
            rig, LoadedCircuit(point, models, drags, BracingState(mode="torque_controlled"), system)
        )
    meshes = mesh_losses(rig, point, models, response, coupling_state)
    if dynamic and rig.case.drivetrain is not None and response is None:
        meshes = [_without_response(placed) for placed in meshes]
    losses = (*rotating, *meshes)
    return PointLosses(point=point, coupling_state=coupling_state, bearings=bearings, losses=losses)


def _response(rig: Rig, circuit: LoadedCircuit) -> CurvePoint | None:
    """Periodic response with the bracing that makes the torque of this point; None where none is found."""
    try:
        return respond(rig, circuit)
    except DynamicsNotConverged:
        return None


def _without_response(placed: PlacedLoss) -> PlacedLoss:
    """The sliding loss of a mesh at its mean load, with a warning that the dynamic forces are not in it."""
    text = "no periodic response is found here: sliding at the mean load, without dynamic tooth forces and mesh damping"
    loss = replace(placed.loss, warnings=(*placed.loss.warnings, text))
    return replace(placed, loss=loss)

"""Losses at any operating point with the warm rig of a held stage: no coupling."""

from dataclasses import replace

from dynamics.errors import DynamicsNotConverged
from dynamics.response.response_curve import CurvePoint
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.braced_loop import BracingState, LoadedCircuit, respond
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.losses import mesh_losses, oil_jets, rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.placed_loss import PlacedLoss, PointLosses, drag_torques
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig


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
    if dynamic and rig.system is not None:
        system = loop_system(rig, point, coupling_state, bearings)
        drags = drag_torques(rotating, rig, point.speed)
        response = _response(
            rig, LoadedCircuit(point, models, drags, BracingState(mode="torque_controlled"), system)
        )
    meshes = mesh_losses(rig, point, models, response, coupling_state)
    if dynamic and rig.system is not None and response is None:
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

"""Losses as torques that brake the shafts."""

from collections.abc import Sequence

from dynamics.drivetrain.graph import Drivetrain
from rigdesign.coupling.placed_loss import PlacedLoss
from rigdesign.rig.model import Rig


def drag_torques(losses: Sequence[PlacedLoss], rig: Rig, speed: float) -> dict[str, float]:
    """Torque with which each bearing, gear windage and seal brakes its shaft [N m], by drivetrain name.

    Oil acceleration and squeezing brake the pinion of their mesh. Tooth friction is not among ``losses``: the
    mesh law holds it. Constant bearing drag is in the damping matrix, and then nothing else brakes, as in P2's
    own simulation. Nothing brakes a rig without a drivetrain.
    """
    torques: dict[str, float] = {}
    if rig.drivetrain is None or rig.case.losses.bearing_drag == "constant":
        return torques
    shafts = drag_shafts(rig.drivetrain)
    for placed in losses:
        name = _drag_name(rig, placed)
        omega = rig.shaft_speed(shafts[name], speed)
        if omega > 0.0:
            torques[name] = torques.get(name, 0.0) + placed.loss.power / omega
    return torques


def drag_shafts(drivetrain: Drivetrain) -> dict[str, str]:
    """Shaft of every place that can brake, by its name in the drivetrain."""
    gears = {gear.name: gear.shaft for gear in drivetrain.gears}
    bearings = {bearing.name: bearing.shaft for bearing in drivetrain.bearings}
    return gears | bearings | {place.name: place.shaft for place in drivetrain.drag_places}


def _drag_name(rig: Rig, placed: PlacedLoss) -> str:
    """Place of the drivetrain on which a loss acts."""
    if placed.loss.kind in ("oil_acceleration", "squeeze"):
        return f"{placed.gearbox}.{rig.case.gearboxes[placed.gearbox].meshes[placed.part].pinion}"
    if placed.loss.kind == "seal":
        return f"{placed.gearbox}.seals.{placed.part}"
    return placed.name

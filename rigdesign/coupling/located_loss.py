"""A power loss with its place in the case and its way into oil and bodies."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from dynamics.losses.loss import RIVAL_LAW, RIVAL_POWER, Loss
from dynamics.rotor.bearing import BearingState
from dynamics.rotor.graph import Drivetrain
from rigdesign.case.losses import LOSS_KINDS, GivenLoss, LossKind
from rigdesign.case.model import Case
from rigdesign.coupling.flank_heat import MeshSplit
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from thermal.conduction.capacity import StoredHeat


@dataclass(frozen=True, kw_only=True)
class PlacedLoss:
    """A loss with its place in the case and its way into oil and bodies."""

    gearbox: str
    part: str
    """Mesh, bearing, seals or gear of that gearbox."""
    loss: Loss
    into_body: float
    """Power that enters solid bodies [W]; the rest goes into the oil at once, but for what is no heat."""
    not_heat: float = 0.0
    """Power of the motor that is heat of no part: work of a mesh damper [W]."""
    pumped: float = 0.0
    """Power that the pump gives at this place, beyond what brakes the shaft [W]: heat into the oil."""
    split: MeshSplit | None = None
    """Of a mesh loss, the way into its two gears."""
    given: bool = False
    end_share: float = 0.0
    """Of a seal loss, the share that arises where the shaft leaves the housing: next to the bearings, in their oil."""

    @property
    def kind(self) -> LossKind:
        """What its kind says of it."""
        return LOSS_KINDS[self.loss.kind]

    @property
    def rival(self) -> tuple[str, float] | None:
        """Law that differs most from the one taken and its power [W], with the loss factor of the case; None where
        there is one law, or the case gives the loss."""
        details = self.loss.details
        if self.given or RIVAL_LAW not in details:
            return None
        return str(details[RIVAL_LAW]), float(details[RIVAL_POWER]) * float(details.get("loss_factor", 1.0))

    @property
    def name(self) -> str:
        """``gearbox.part``."""
        return f"{self.gearbox}.{self.part}"

    @property
    def into_oil(self) -> float:
        """Power that goes into the oil at once [W]."""
        return self.loss.power + self.pumped - self.into_body - self.not_heat

    @property
    def into_bearing_oil(self) -> float:
        """Of ``into_oil``, what goes into the oil of the bearings [W]; the rest goes into that of the gears."""
        return self.into_oil * (1.0 if self.kind.at_bearings else self.end_share)


def heat_into_gear_oil(losses: Iterable[PlacedLoss], gearbox: str, *, bearings_fed: bool) -> float:
    """Power that losses of a gearbox give to the oil of its gears at once [W].

    bearings_fed : heat that arises at the bearings goes into an oil of their own; else into that of the gears too
    """
    return math.fsum(
        placed.into_oil - (placed.into_bearing_oil if bearings_fed else 0.0)
        for placed in losses
        if placed.gearbox == gearbox
    )


# What heats a rig at an operating point, losses that the case prescribes, and the state they follow from.

STORED = "stored"
"""Kind of the rows of bodies that warm up in a heat balance."""


@dataclass(frozen=True, kw_only=True)
class PointLosses:
    """Losses and bearing films at an operating point: all that the boundary conditions of its housings depend on."""

    point: OperatingPoint
    coupling_state: CouplingState
    bearings: Mapping[str, BearingState]
    """By ``gearbox.bearing``."""
    losses: tuple[PlacedLoss, ...]
    stored: Mapping[str, StoredHeat] = field(default_factory=dict)
    """Gearbox -> heat that its bodies take up in a time step; empty for a steady point."""


def given_power(case: Case, point: OperatingPoint, gearbox: str, kind: str, part: str) -> float | None:
    """Power [W] the case gives for one place at this point, or None where it gives none.

    The loss factor of its gearbox multiplies it, and of a bearing its own. A given power holds at the end of its
    stage. At other speeds of that stage (drag over a run-up) the torque behind it stays, and the power follows the
    speed.
    """
    for entry in case.losses.given.values():
        same = (entry.gearbox, entry.kind, entry.part) == (gearbox, kind, part)
        if same and (not entry.stages or point.stage in entry.stages):
            box = case.gearboxes[gearbox]
            own = box.bearings[part].friction_factor if LOSS_KINDS[kind].at_bearings else 1.0
            return own * box.loss_factors.of(kind) * _at_speed(case, entry, point)
    return None


def _at_speed(case: Case, entry: GivenLoss, point: OperatingPoint) -> float:
    speeds = {stage.name: stage.speed_end for stage in case.schedule.resolved()}
    full = speeds.get(point.stage, point.speed)
    return entry.power if full in (0.0, point.speed) else entry.power * point.speed / full


# Losses as torques that brake the shafts.


def drag_torques(losses: Sequence[PlacedLoss], rig: Rig, speed: float) -> dict[str, float]:
    """Torque with which each bearing, gear windage and seal brakes its shaft [N m], by drivetrain name.

    Oil acceleration and squeezing brake the pinion of their mesh. Tooth friction is not among ``losses``: the
    mesh law holds it. Constant bearing drag is in the damping matrix, and then nothing else brakes, as in P2's
    own simulation. Nothing brakes a rig without a drivetrain.
    """
    torques: dict[str, float] = {}
    if rig.case.drivetrain is None or rig.case.losses.bearing_drag == "constant":
        return torques
    shafts = drag_shafts(rig.drivetrain)
    for placed in losses:
        place = placed.kind.braked(rig.case.gearboxes[placed.gearbox], placed.part)
        name = f"{placed.gearbox}.{place}"
        omega = rig.shaft_speed(shafts[name], speed)
        if omega > 0.0:
            torques[name] = torques.get(name, 0.0) + placed.loss.power / omega
    return torques


def drag_shafts(drivetrain: Drivetrain) -> dict[str, str]:
    """Shaft of every place that can brake, by its name in the drivetrain."""
    gears = {gear.name: gear.shaft for gear in drivetrain.gears}
    bearings = {bearing.name: bearing.shaft for bearing in drivetrain.bearings}
    return gears | bearings | {place.name: place.shaft for place in drivetrain.drag_places}

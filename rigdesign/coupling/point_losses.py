"""What heats a rig at an operating point, losses that the case prescribes, and the state they follow from."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from dynamics.bearing.protocol import BearingState
from rigdesign.case.losses import GivenLoss
from rigdesign.case.model import Case
from rigdesign.coupling.placed_loss import PlacedLoss
from rigdesign.coupling.state import CouplingState, OperatingPoint
from thermal.conduction.capacity import StoredHeat

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
            own = box.bearings[part].friction_factor if kind == "bearing" else 1.0
            return own * box.loss_factors.of(kind) * _at_speed(case, entry, point)
    return None


def _at_speed(case: Case, entry: GivenLoss, point: OperatingPoint) -> float:
    speeds = {stage.name: stage.speed_end for stage in case.schedule.resolved()}
    full = speeds.get(point.stage, point.speed)
    return entry.power if full in (0.0, point.speed) else entry.power * point.speed / full

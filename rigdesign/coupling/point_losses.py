"""What heats a rig at an operating point, and the state it follows from."""

from collections.abc import Mapping
from dataclasses import dataclass

from dynamics.bearing.protocol import BearingState
from rigdesign.coupling.placed_loss import PlacedLoss
from rigdesign.coupling.state import CouplingState, OperatingPoint


@dataclass(frozen=True, kw_only=True)
class PointLosses:
    """Losses and bearing films at an operating point: all that the boundary conditions of its housings depend on."""

    point: OperatingPoint
    coupling_state: CouplingState
    bearings: Mapping[str, BearingState]
    """By ``gearbox.bearing``."""
    losses: tuple[PlacedLoss, ...]

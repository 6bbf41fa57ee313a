"""What heats a rig at an operating point, and the state it follows from."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from dynamics.bearing.protocol import BearingState
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

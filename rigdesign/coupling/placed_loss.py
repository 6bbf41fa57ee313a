"""A power loss with its place in the case and its way into oil and bodies."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from dynamics.losses.mesh_loss import RIVAL_LAW, RIVAL_POWER, Loss
from rigdesign.coupling.flank_heat import MeshSplit


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
        return self.into_oil * (1.0 if self.loss.kind == "bearing" else self.end_share)


def heat_into_gear_oil(losses: Iterable[PlacedLoss], gearbox: str, *, bearings_fed: bool) -> float:
    """Power that losses of a gearbox give to the oil of its gears at once [W].

    bearings_fed : heat that arises at the bearings goes into an oil of their own; else into that of the gears too
    """
    return math.fsum(
        placed.into_oil - (placed.into_bearing_oil if bearings_fed else 0.0)
        for placed in losses
        if placed.gearbox == gearbox
    )

"""Root stress of one tooth over a turn of its gear: SI record."""

from dataclasses import dataclass

import numpy as np

from dynamics.contact.tooth_turn import Fillet, ToothTurn
from dynamics.rating.mean_stress import MeanRootStress, mean_stress_factor
from rigdesign.results.stress_source import StressSource


@dataclass(frozen=True)
class FilletStress:
    """Highest and lowest stress of one fillet over a turn, with that at rest [Pa]."""

    highest: float
    lowest: float

    @property
    def ratio(self) -> float:
        """R, lowest over highest stress [-]."""
        return self.lowest / self.highest


@dataclass(frozen=True, kw_only=True)
class ToothHistory:
    """Both root fillets of a tooth at the held stage that speaks for the rig."""

    gear: str
    """``gearbox.gear``"""
    stage: str
    meshes: tuple[str, ...]
    """Labels of the meshes that load it, in which it is rated."""
    turn: ToothTurn
    """Stress of the tooth forces times K_A of their mesh."""
    mean: MeanRootStress
    """Held all the time, on top."""
    sensitivity: float
    """M of ISO 6336-3, Annex B [-]."""
    source: StressSource

    @property
    def fillet(self) -> Fillet:
        """The fillet that is stressed most: ``leading`` or ``trailing`` flank."""
        return "leading" if self.turn.leading.max() >= self.turn.trailing.max() else "trailing"

    def of(self, fillet: Fillet) -> FilletStress:
        """Stress of one fillet."""
        stress = self.turn.leading if fillet == "leading" else self.turn.trailing
        return FilletStress(float(np.max(stress)) + self.mean.total, float(np.min(stress)) + self.mean.total)

    @property
    def highest(self) -> float:
        """Highest stress with that at rest [Pa]."""
        return self.of(self.fillet).highest

    @property
    def lowest(self) -> float:
        """Lowest stress of the same fillet with that at rest [Pa]."""
        return self.of(self.fillet).lowest

    @property
    def stress_ratio(self) -> float:
        """R of this fillet [-]."""
        return self.of(self.fillet).ratio

    @property
    def mean_stress_factor(self) -> float:
        """Y_M of ISO 6336-3 at this stress ratio [-]."""
        return mean_stress_factor(self.stress_ratio, self.sensitivity)

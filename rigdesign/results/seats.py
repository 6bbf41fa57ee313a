"""Press fit and spline of a gear at the largest torque of a stage or event: SI records."""

from dataclasses import dataclass
from typing import Literal

SplineStressKind = Literal["flank pressure", "shear of the teeth", "shear of the shaft", "tension of the hub"]


@dataclass(frozen=True, kw_only=True)
class PressFitCapacity:
    """A gear on its shaft at the largest torque of a stage or event."""

    gear: str
    """``gearbox.gear``"""
    stage: str
    """Held stage whose temperatures count."""
    where: str
    """Stage or event of the torque, in words."""
    interference: float
    """Effective and least, on the diameter, at rest and 20 degC [m]."""
    interference_hot: float
    """[m]"""
    gear_temperature: float
    """[K]"""
    shaft_temperature: float
    """[K]"""
    pressure_at_rest: float
    """[Pa]"""
    pressure: float
    """Hot and at speed [Pa]; 0 where the seat is loose."""
    friction: float
    slip_torque: float
    """[N m]"""
    peak_torque: float
    """[N m]"""

    @property
    def safety(self) -> float | None:
        """Slip torque over peak torque [-]; None without torque."""
        return self.slip_torque / self.peak_torque if self.peak_torque > 0.0 else None


@dataclass(frozen=True, kw_only=True)
class SplineStress:
    """One stress of one spline."""

    gear: str
    """``gearbox.gear``"""
    kind: SplineStressKind
    where: str
    """Stage or event of the torque, in words."""
    torque: float
    """[N m]"""
    stress: float
    """[Pa]"""
    allowable: float
    """As the case states it [Pa]."""

    @property
    def safety(self) -> float | None:
        """Allowable over stress [-]; None without stress."""
        return self.allowable / self.stress if self.stress > 0.0 else None

"""Stresses of the spline of a gear at the largest torque of a stage or event: SI record."""

from dataclasses import dataclass
from typing import Literal

SplineStressKind = Literal["flank pressure", "shear of the teeth", "shear of the shaft", "tension of the hub"]


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

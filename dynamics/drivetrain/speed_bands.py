"""A drivetrain whose matrices depend on its speed: gyroscopic moments, stiffness and damping of the bearings."""

from bisect import bisect_right
from dataclasses import dataclass
from typing import Protocol

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.errors import DynamicsInputError


class DrivetrainOverSpeed(Protocol):
    """Matrices of a drivetrain at any speed; all of them of the same freedoms."""

    def at(self, speed: float) -> LinearSystem:
        """Matrices at a speed of the pinion of the first mesh [rad/s]."""


@dataclass(frozen=True, kw_only=True)
class SpeedBands:
    """Bands of speed with constant matrices each.

    limits : (n - 1,) speeds of the pinion of the first mesh at which the bands meet, rising [rad/s]
    systems : (n,) matrices of each band, of the same freedoms

    Raises DynamicsInputError if numbers or freedoms do not agree.
    """

    limits: tuple[float, ...]
    systems: tuple[LinearSystem, ...]

    def __post_init__(self) -> None:
        if len(self.systems) != len(self.limits) + 1 or sorted(set(self.limits)) != list(self.limits):
            raise DynamicsInputError(
                f"{len(self.systems)} speed bands with limits {self.limits} rad/s: must be one limit less than bands, "
                "rising"
            )
        if any(system.dofs != self.systems[0].dofs for system in self.systems):
            raise DynamicsInputError("speed bands: systems have different freedoms; reduce them on one basis")

    def at(self, speed: float) -> LinearSystem:
        """Matrices of the band in which a speed lies [rad/s]."""
        return self.systems[bisect_right(self.limits, speed)]

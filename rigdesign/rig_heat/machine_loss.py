"""Loss of a machine over speed and torque of its output shaft: constant efficiency, or a measured map."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.number_faults import refuse, require_share
from rigdesign.base.units import show

FloatArray = NDArray[np.float64]
SAME = 1e-9
"""Distance from the edge of a map that still counts as on it, as a share of its largest value."""


class MachineLoss(Protocol):
    """Loss over the operating point of the output shaft."""

    @property
    def source(self) -> str:
        """What it follows from."""

    def power(self, speed: float, torque: float) -> float:
        """Loss [W] at a speed [rad/s] and a torque [Nm] of the output; their signs do not matter."""

    def nearest(self, speed: float, torque: float) -> tuple[float, float]:
        """Operating point nearest to this one at which the loss is known."""


@dataclass(frozen=True, kw_only=True)
class EfficiencyLoss:
    """Loss by a constant efficiency, output over input power: P (1/efficiency - 1).

    It vanishes without load; a machine that idles needs a map.
    """

    efficiency: float

    def __post_init__(self) -> None:
        require_share("efficiency", self.efficiency, "give output over input power", zero=False)

    @property
    def source(self) -> str:
        """What it follows from."""
        return f"efficiency {self.efficiency:.4g}"

    def power(self, speed: float, torque: float) -> float:
        """Loss [W] at a speed [rad/s] and a torque [Nm] of the output."""
        return abs(speed * torque) * (1.0 / self.efficiency - 1.0)

    def nearest(self, speed: float, torque: float) -> tuple[float, float]:
        """The operating point itself."""
        return speed, torque


@dataclass(frozen=True, eq=False, kw_only=True)
class LossMap:
    """Loss measured on a grid, bilinear between its points.

    speeds : (n,) of the output [rad/s], rising; torques : (m,) [Nm], rising; losses : (n, m) [W]

    Raises CaseError for a grid that does not rise, and outside of it: a map is not extrapolated.
    """

    speeds: FloatArray
    torques: FloatArray
    losses: FloatArray

    def __post_init__(self) -> None:
        for key, axis in (("speeds", self.speeds), ("torques", self.torques)):
            if axis.ndim != 1 or len(axis) < 2 or not np.all(np.diff(axis) > 0.0) or axis[0] < 0.0:
                refuse(
                    f"loss_map.{key}",
                    f"{len(axis)} values",
                    "must rise from 0 or more, two at least",
                    "sort them",
                )
        expected = len(self.speeds), len(self.torques)
        if self.losses.shape != expected:
            shape = " x ".join(str(length) for length in self.losses.shape)
            refuse(
                "loss_map.losses", shape, f"must be {expected[0]} x {expected[1]}", "give one for every point"
            )
        if not (np.all(np.isfinite(self.losses)) and np.all(self.losses >= 0.0)):
            refuse("loss_map.losses", "", "must be finite and not negative", "correct the map")

    @classmethod
    def from_columns(cls, speeds: Sequence[float], torques: Sequence[float], losses: Sequence[float]) -> Self:
        """Map from the columns of a table with one row a point, in any order; every point of the grid once."""
        if not len(speeds) == len(torques) == len(losses):
            refuse(
                "loss_map",
                f"{len(speeds)}, {len(torques)}, {len(losses)} rows",
                "must be as many",
                "complete it",
            )
        first, row = np.unique(np.asarray(speeds, dtype=np.float64), return_inverse=True)
        second, column = np.unique(np.asarray(torques, dtype=np.float64), return_inverse=True)
        counts = np.zeros((len(first), len(second)), dtype=np.int64)
        np.add.at(counts, (row, column), 1)
        if not np.all(counts == 1):
            at = tuple(np.argwhere(counts != 1)[0])
            refuse(
                "loss_map",
                f"{show(float(first[at[0]]), 'speed')}, {show(float(second[at[1]]), 'torque')}",
                f"must occur once, occurs {counts[at]} times",
                "give every speed with every torque",
            )
        grid = np.zeros(counts.shape)
        grid[row, column] = losses
        return cls(speeds=first, torques=second, losses=grid)

    @property
    def source(self) -> str:
        """What it follows from."""
        return f"loss map, {len(self.speeds)} speeds by {len(self.torques)} torques"

    def power(self, speed: float, torque: float) -> float:
        """Loss [W] at a speed [rad/s] and a torque [Nm] of the output. Raises CaseError outside the map."""
        row, along = _cell("speed", self.speeds, abs(speed))
        column, across = _cell("torque", self.torques, abs(torque))
        corners = self.losses[row : row + 2, column : column + 2]
        return float(np.array([1.0 - along, along]) @ corners @ np.array([1.0 - across, across]))

    def nearest(self, speed: float, torque: float) -> tuple[float, float]:
        """Operating point of the map nearest to this one."""
        return _within(self.speeds, speed), _within(self.torques, torque)

    def holds_speed(self, speed: float) -> bool:
        """Whether the map reaches a speed [rad/s] of the output."""
        slack = SAME * float(self.speeds[-1])
        return bool(self.speeds[0] - slack <= abs(speed) <= self.speeds[-1] + slack)


def _within(axis: FloatArray, value: float) -> float:
    return min(max(abs(value), float(axis[0])), float(axis[-1]))


def _cell(kind: str, axis: FloatArray, value: float) -> tuple[int, float]:
    """Number of the interval a value lies in, and its share of it; kind : of quantity, speed or torque."""
    low, high = float(axis[0]), float(axis[-1])
    if not low - SAME * high <= value <= high + SAME * high:
        refuse(
            f"loss_map.{kind}s",
            show(value, kind),
            f"must lie within the map, {show(low, kind)} to {show(high, kind)}",
            "extend the map to this operating point; it is not extrapolated",
        )
    value = min(max(value, low), high)
    at = min(int(np.searchsorted(axis, value, side="right")) - 1, len(axis) - 2)
    return at, float((value - axis[at]) / (axis[at + 1] - axis[at]))

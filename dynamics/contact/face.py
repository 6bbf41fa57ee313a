"""Positions over the common face width at which the teeth may touch, and how many of them are enough."""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair

Array = NDArray[np.float64]

LEAST_POSITIONS = 11
"""Positions over a face whose gap or place on the path varies."""
PER_OVERLAP = 12
"""Positions for every base pitch by which a helical face lags from end to end, the overlap ratio."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FaceGrid:
    """Positions over the face and the width that each stands for; lengths [m].

    position : (n,) from mid-face, growing
    width : (n,) of its share of the face, the integral of its hat function
    """

    position: Array
    width: Array

    def __post_init__(self) -> None:
        if self.position.shape != self.width.shape or self.position.ndim != 1 or not len(self.position):
            raise DynamicsInputError(
                f"face grid: position {self.position.shape} and width {self.width.shape} must be of one length, "
                "at least 1"
            )
        if not (np.all(np.diff(self.position) > 0.0) and np.all(self.width > 0.0)):
            raise DynamicsInputError(
                "face grid: positions must grow and widths be positive; sort the positions"
            )

    @classmethod
    def over(cls, face_width: float, n: int) -> "FaceGrid":
        """Return n even positions from end to end of the face, the ends standing for half a step; 1: its middle."""
        if n < 1 or not face_width > 0.0:
            raise DynamicsInputError(f"n = {n} positions over {face_width} m of face: both must be positive")
        if n == 1:
            return cls(position=np.zeros(1), width=np.array([face_width]))
        return cls.at(np.linspace(-0.5 * face_width, 0.5 * face_width, n))

    @classmethod
    def at(cls, position: Array) -> "FaceGrid":
        """Return the grid of at least two given positions (n,), the outer ones on the ends of the face [m]."""
        steps = np.diff(position)
        return cls(position=position, width=0.5 * (np.append(steps, 0.0) + np.insert(steps, 0, 0.0)))

    @property
    def face_width(self) -> float:
        """Width of the face [m]."""
        return float(self.width.sum())


def default_positions(pair: GearPair, *, gap_varies: bool) -> int:
    """Positions over the face after which largest line load and transmission error change by less than 1 %.

    gap_varies : the gap or the compliance changes over the face. One position is exact for a spur gear of which
    neither does; see ``tests/unit/dynamics_package/contact/test_face.py`` for the rule.
    """
    if pair.helix_angle == 0.0 and not gap_varies:
        return 1
    return max(LEAST_POSITIONS, ceil(PER_OVERLAP * abs(pair.overlap_ratio)) + 1)

"""What turns with a shaft and shakes it once a turn: unbalance, a bent shaft, flanges out of true.

Angles [rad] count from +y in the sense of rotation of the shaft, at the instant at which its angle is zero.
"""

import math
from dataclasses import dataclass
from typing import Literal

from dynamics.drivetrain.shaft import DrivetrainError


@dataclass(frozen=True, kw_only=True)
class ShaftUnbalance:
    """Mass times radius [kg m] on a shaft at a position [m] from its left end."""

    shaft: str
    position: float
    moment: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        if not (self.moment >= 0.0 and math.isfinite(self.moment)):
            raise DrivetrainError(
                f"unbalance of shaft {self.shaft!r}: {self.moment} kg m: must be finite and at least 0; turn its angle"
            )


@dataclass(frozen=True, kw_only=True)
class ShaftBow:
    """Shape of the axis of a shaft without load.

    amplitude : largest distance from the line through the supports, or at ``position`` where one is given [m]: a half
        sine between them, straight beyond
    gradient : temperature difference across the diameter times the expansion coefficient [-]: a curvature gradient /
        diameter all along the shaft
    supports : positions of two bearings [m]

    Raises DrivetrainError for supports at one place, or a position at which a half sine has no height.
    """

    shaft: str
    supports: tuple[float, float]
    amplitude: float = 0.0
    position: float | None = None
    angle: float = 0.0
    gradient: float = 0.0
    gradient_angle: float = 0.0

    def __post_init__(self) -> None:
        first, second = self.supports
        if not second > first:
            raise DrivetrainError(
                f"bow of shaft {self.shaft!r}: supports at {first} and {second} m: must ascend; give the positions of "
                "two bearings"
            )
        if self.position is not None and self.amplitude and abs(self.height) < 1e-3:
            raise DrivetrainError(
                f"bow of shaft {self.shaft!r}: position = {self.position} m is at a support, where it has no "
                f"amplitude; give a place between {first} and {second} m or beyond them"
            )

    @property
    def height(self) -> float:
        """Of the shape at ``position``, over its largest."""
        return 1.0 if self.position is None else self.shape(self.position)[0]

    def shape(self, position: float) -> tuple[float, float]:
        """Distance from the line through the supports and slope [1/m] at a position [m], for a largest of 1."""
        first, second = self.supports
        span = second - first
        inside = min(max(position, first), second)
        turn = math.pi * (inside - first) / span
        slope = math.pi / span * math.cos(turn)
        return math.sin(turn) + slope * (position - inside), slope


@dataclass(frozen=True, kw_only=True)
class FlangeRunOut:
    """Flange of the first shaft of a coupling against that of the second, turning with them.

    offset : of its centre from the axis [m]; tilt : of its face from square [rad]
    """

    coupling: str
    offset: float = 0.0
    offset_angle: float = 0.0
    tilt: float = 0.0
    tilt_angle: float = 0.0


RotatingPart = ShaftUnbalance | ShaftBow | FlangeRunOut


@dataclass(frozen=True, kw_only=True)
class AxisMisalignment:
    """Axis of the first shaft of a coupling against that of the second, as they stand: offset [m], slope over x [rad].

    Both (y, z).
    """

    coupling: str
    offset: tuple[float, float] = (0.0, 0.0)
    slope: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class CrossJoint:
    """Coupling that is a cross joint: slope (y, z) over x of the axis of its first shaft against that of the second."""

    coupling: str
    slope: tuple[float, float]


SpeedPower = Literal[0, 2]

"""Which faces of a part a rule picks: planes, cylinders and bounding boxes, in the frame of the part."""

from dataclasses import dataclass

import numpy as np

from thermal.errors import ThermalInputError
from thermal.fe.mesh import FloatArray
from thermal.housing.stations import Point

ON_FACE = 5e-5
"""Distance [m] within which the points of a face meet a rule."""


class FaceRuleError(ThermalInputError):
    """A rule that picks nothing by itself; the message names quantity, value, limit and remedy."""


@dataclass(frozen=True)
class Plane:
    """Faces in a plane through ``point`` [m] across ``normal`` (any length, either sense)."""

    point: Point
    normal: Point

    def __post_init__(self) -> None:
        _direction("normal of a plane", self.normal)

    def holds(self, points: FloatArray) -> bool:
        """Whether all ``points`` (n, 3) [m] lie in it."""
        off = (points - self.point) @ _direction("normal of a plane", self.normal)
        return bool(np.abs(off).max() <= ON_FACE)


@dataclass(frozen=True)
class Cylinder:
    """Faces at ``radius`` [m] from the axis through ``point`` [m] along ``direction``."""

    point: Point
    direction: Point
    radius: float

    def __post_init__(self) -> None:
        _direction("direction of a cylinder", self.direction)
        if not self.radius > 0.0:
            raise FaceRuleError(
                f"radius of a cylinder = {self.radius} m must be greater than 0; give its radius"
            )

    def holds(self, points: FloatArray) -> bool:
        """Whether all ``points`` (n, 3) [m] lie on it."""
        away = points - np.asarray(self.point)
        along = _direction("direction of a cylinder", self.direction)
        distance = np.linalg.norm(away - np.outer(away @ along, along), axis=1)
        return bool(np.abs(distance - self.radius).max() <= ON_FACE)


@dataclass(frozen=True)
class Box:
    """Faces inside a box along the axes, from ``low`` to ``high`` corner [m]."""

    low: Point
    high: Point

    def __post_init__(self) -> None:
        if any(low > high for low, high in zip(self.low, self.high)):
            raise FaceRuleError(
                f"box from {self.low} to {self.high} m ends before it starts; swap the corners"
            )

    def holds(self, points: FloatArray) -> bool:
        """Whether all ``points`` (n, 3) [m] lie inside."""
        inside = (points >= np.asarray(self.low) - ON_FACE) & (points <= np.asarray(self.high) + ON_FACE)
        return bool(inside.all())


@dataclass(frozen=True)
class FaceRule:
    """Faces that meet all of the given shapes, e.g. a plane within a box."""

    shapes: tuple[Plane | Cylinder | Box, ...]

    def holds(self, points: FloatArray) -> bool:
        """Whether all ``points`` (n, 3) [m] of a face meet every shape."""
        return all(shape.holds(points) for shape in self.shapes)


def _direction(key: str, vector: Point) -> FloatArray:
    length = float(np.linalg.norm(vector))
    if not (np.isfinite(length) and length > 0.0):
        raise FaceRuleError(f"{key} = {vector} must be longer than 0; give a direction, e.g. (1, 0, 0)")
    return np.asarray(vector) / length

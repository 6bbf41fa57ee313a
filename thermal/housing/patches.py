"""Patches that named surfaces are made of: where their points lie, and closed-form areas.

A patch is a box, flat in one direction, or a piece of cylinder or ring about a shaft axis, so that a face of the mesh
is recognised by its own nodes.
"""

import math
from dataclasses import dataclass

import numpy as np

from thermal.fe.mesh import FloatArray

Range = tuple[float, float]


@dataclass(frozen=True)
class BoxPatch:
    """All points with x, y and z in these closed ranges."""

    x: Range
    y: Range
    z: Range

    def holds(self, points: FloatArray, tolerance: float) -> bool:
        """Whether all ``points`` (n, 3) lie in the patch."""
        lower = np.array([self.x[0], self.y[0], self.z[0]]) - tolerance
        upper = np.array([self.x[1], self.y[1], self.z[1]]) + tolerance
        return bool(np.all((points >= lower) & (points <= upper)))


@dataclass(frozen=True)
class AxialPatch:
    """All points with x and the distance from an axis along x in these closed ranges."""

    axis: tuple[float, float]
    """y and z of the axis."""
    radius: Range
    x: Range

    def holds(self, points: FloatArray, tolerance: float) -> bool:
        """Whether all ``points`` (n, 3) lie in the patch."""
        radius = np.hypot(points[:, 1] - self.axis[0], points[:, 2] - self.axis[1])
        return bool(
            radius.min() >= self.radius[0] - tolerance
            and radius.max() <= self.radius[1] + tolerance
            and points[:, 0].min() >= self.x[0] - tolerance
            and points[:, 0].max() <= self.x[1] + tolerance
        )


@dataclass(frozen=True)
class FramePatch:
    """All points of a box patch that are not inside a rectangle of x and y."""

    box: BoxPatch
    x: Range
    y: Range

    def holds(self, points: FloatArray, tolerance: float) -> bool:
        """Whether all ``points`` (n, 3) lie in the patch."""
        inside = (points[:, 0] > self.x[0] + tolerance) & (points[:, 0] < self.x[1] - tolerance)
        inside &= (points[:, 1] > self.y[0] + tolerance) & (points[:, 1] < self.y[1] - tolerance)
        return self.box.holds(points, tolerance) and not bool(inside.any())


Patch = BoxPatch | AxialPatch | FramePatch


@dataclass(frozen=True)
class NamedFace:
    """A named surface: where its points lie, and its exact area [m2]."""

    name: str
    patches: tuple[Patch, ...]
    area: float


def box_mantle(x: Range, half: float, z: Range) -> list[Patch]:
    """Left, right and top of a box section."""
    return [
        BoxPatch(x, (-half, -half), z),
        BoxPatch(x, (half, half), z),
        BoxPatch(x, (-half, half), (z[1], z[1])),
    ]


def ring_area(inner: float, outer: float) -> float:
    """Area between two concentric circles [m2]."""
    return math.pi * (outer**2 - inner**2)

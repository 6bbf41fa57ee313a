"""Deviations of a flank on a grid over profile and face width, of one tooth for all or of every tooth."""

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]
Interpolation = Literal["bilinear", "bicubic"]

EDGE = 1e-3
"""Share of the profile or face by which a grid may end short of it: digits of a measuring sheet."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Topography:
    """Metal removed on a grid [m], positive widens the gap. Beyond the grid the value of its edge stays.

    roll_angle : (n_p,) places on the profile, roll length over base radius [rad], increasing; it is that of the same
        point of the gear at any temperature
    face : (n_f,) places from mid-face [m], increasing
    removed : (1, n_p, n_f) alike for all teeth, or (teeth, n_p, n_f) [m]
    interpolation : ``bilinear``, or ``bicubic``: the cubic spline through all points, 4 or more each way

    Raises DynamicsInputError for axes that do not increase, shapes that do not fit, values that are not finite.
    """

    roll_angle: Array
    face: Array
    removed: Array
    interpolation: Interpolation = "bilinear"

    def __post_init__(self) -> None:
        least = 2 if self.interpolation == "bilinear" else 4
        if self.interpolation not in get_args(Interpolation):
            raise DynamicsInputError(
                f"topography: interpolation = {self.interpolation!r} must be {' or '.join(get_args(Interpolation))}"
            )
        for name in ("roll_angle", "face"):
            axis = getattr(self, name)
            if axis.ndim != 1 or len(axis) < least:
                raise DynamicsInputError(
                    f"topography: {name} has shape {axis.shape}, {self.interpolation} needs {least} places or more; "
                    "measure at more places"
                )
            if not (np.all(np.isfinite(axis)) and np.all(np.diff(axis) > 0.0)):
                raise DynamicsInputError(
                    f"topography: {name} must increase from place to place; sort the grid and remove what is twice"
                )
        shape = (len(self.roll_angle), len(self.face))
        if self.removed.ndim != 3 or self.removed.shape[1:] != shape:
            raise DynamicsInputError(
                f"topography: removed has shape {self.removed.shape}, expected (teeth, {shape[0]}, {shape[1]}); "
                "give one value for each place"
            )
        if missing := int(np.sum(~np.isfinite(self.removed))):
            raise DynamicsInputError(
                f"topography: {missing} of {self.removed.size} values are missing or not finite; fill the holes"
            )

    @property
    def teeth(self) -> int:
        """Teeth whose flanks the grid has; 1 where one stands for all."""
        return len(self.removed)

    @cached_property
    def _surfaces(self) -> tuple[RectBivariateSpline, ...]:
        degree = 1 if self.interpolation == "bilinear" else 3
        return tuple(
            RectBivariateSpline(self.roll_angle, self.face, removed, kx=degree, ky=degree)
            for removed in self.removed
        )

    def at(self, roll_angle: Array, face: Array, tooth: NDArray[np.int64] | int) -> Array:
        """Metal removed [m] at roll angle [rad], face position [m] and tooth; the shapes are broadcast."""
        angle, place, teeth = np.broadcast_arrays(
            np.clip(roll_angle, self.roll_angle[0], self.roll_angle[-1]),
            np.clip(face, self.face[0], self.face[-1]),
            np.asarray(tooth) % self.teeth,
        )
        found = np.empty(angle.shape)
        for number in np.unique(teeth):
            here = teeth == number
            found[here] = self._surfaces[number].ev(angle[here], place[here])
        return found

    @cached_property
    def mean(self) -> "Topography":
        """The mean flank of all teeth, for all teeth."""
        if self.teeth == 1:
            return self
        return Topography(
            roll_angle=self.roll_angle,
            face=self.face,
            removed=self.removed.mean(axis=0, keepdims=True),
            interpolation=self.interpolation,
        )

    def require_cover(self, profile: tuple[float, float], face_width: float) -> None:
        """Raise DynamicsInputError unless the grid covers a flank.

        profile : roll angles of form and tip circle [rad]; face_width : [m]
        """
        angles, face = (float(self.roll_angle[0]), float(self.roll_angle[-1])), (self.face[0], self.face[-1])
        allowed = EDGE * (profile[1] - profile[0])
        if angles[0] > profile[0] + allowed or angles[1] < profile[1] - allowed:
            degrees = 180.0 / pi
            raise DynamicsInputError(
                f"topography: roll angle {degrees * angles[0]:.3f} .. {degrees * angles[1]:.3f} deg does not cover the "
                f"flank from form to tip circle, {degrees * profile[0]:.3f} .. {degrees * profile[1]:.3f} deg; measure "
                "the whole profile, or repeat the outermost values there"
            )
        allowed, half = EDGE * face_width, 0.5 * face_width
        if face[0] > -half + allowed or face[1] < half - allowed:
            raise DynamicsInputError(
                f"topography: face position {1e3 * face[0]:.3f} .. {1e3 * face[1]:.3f} mm does not cover the face, "
                f"{-1e3 * half:.3f} .. {1e3 * half:.3f} mm from its middle; measure the whole width, or repeat the "
                "outermost values there"
            )

"""Intended modifications and deviations of the flanks of one gear.

All amounts are metal removed along the transverse line of action [m], the direction in which ISO 1328-1 has profile,
helix and pitch deviations measured (base tangent in the transverse section); positive widens the gap. Along the normal
of a helical flank they are cos(beta_b) times as large, see ``PairGap.normal``.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RectBivariateSpline

from dynamics.errors import DynamicsInputError

# Deviations of a flank on a grid over profile and face width, of one tooth for all or of every tooth.

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
        removed = np.empty(angle.shape)
        for number in np.unique(teeth):
            here = teeth == number
            removed[here] = self._surfaces[number].ev(angle[here], place[here])
        return removed

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


RELIEFS = ("tip_relief", "root_relief", "end_relief")


@dataclass(frozen=True, kw_only=True)
class Microgeometry:
    """Intended modifications and deviations of one gear; all zero is the ideal involute gear.

    Modifications are metal removed [m], positive widens the gap. Face position z runs over the own face width
    from -b/2 to b/2 in the direction of rising helix lag of the front flanks. A relief fades from its amount at the
    edge to zero at its length, with the power ``_exponent`` of the distance: 1 linear, 2 parabolic. What has no word
    on the back flank is the same there, place by place.
    """

    tip_relief: float = 0.0
    """C_a at the tip corner [m]."""
    tip_relief_length: float = 0.0
    """Path length from the tip over which the relief fades to zero [m]."""
    tip_relief_exponent: float = 1.0
    """1 linear, 2 parabolic."""
    root_relief: float = 0.0
    """C_f at the start of the active profile [m]."""
    root_relief_length: float = 0.0
    """Path length from the start of the active profile over which the relief fades to zero [m]."""
    root_relief_exponent: float = 1.0
    """1 linear, 2 parabolic."""
    end_relief: tuple[float, float] = (0.0, 0.0)
    """C_betaI at z = -b/2 and C_betaII at z = b/2 [m]."""
    end_relief_length: float = 0.0
    """Face width from each end over which the relief fades to zero [m]."""
    end_relief_exponent: float = 1.0
    """1 linear, 2 parabolic."""
    profile_crowning: float = 0.0
    """C_alpha at both ends of the active path, parabolic, zero in its middle [m]."""
    lead_crowning: float = 0.0
    """C_beta at both ends of the face, zero in its middle [m]."""
    lead_crowning_form: Literal["parabolic", "circular"] = "parabolic"
    """Parabola or arc of a circle through the same three points; they differ by C_beta (C_beta/b)^2 at most."""
    manufacturing_twist: float = 0.0
    """Share of the natural twist that the lead crowning of a helical gear has [-]: 1 hobbed or ground by a worm at a
    changing centre distance, 0 ground free of twist; see ``FlankField.natural_twist``."""
    profile_slope: float = 0.0
    """f_Halpha over the active profile, positive where the tip stands out: the gap is half of it less at the tip
    and half of it more at the root [m]."""
    helix_slope: float = 0.0
    """Change of the gap over the face width, from -b/2 to b/2 [m]."""
    profile_twist: float = 0.0
    """Gap at the tip at z = b/2; it changes sign at the root and at z = -b/2 (bilinear) [m]. A
    quarter of the twist S_alpha as the tooth loses it: profile slope at z = -b/2 less that at z = b/2."""
    topography: Topography | None = None
    """Measured or prescribed deviations of the front flanks, on top of the rest."""
    back_topography: Topography | None = None
    """The same of the back flanks."""
    pitch_deviations: tuple[float, ...] = ()
    """Place of each tooth along the line of action ahead of its ideal one (cumulative), (z,) [m]; the whole tooth
    stands there, so that its back flank gives way by as much."""
    run_out: float = 0.0
    """Eccentricity f_e of the teeth, about half the run-out F_r [m]."""
    run_out_phase: float = 0.0
    """Rotation of the gear at which the eccentric teeth stand furthest along the line of action of the front flanks
    [rad]; along that of the back flanks they do so half a turn and 2 alpha_wt later (pinion) or earlier (wheel)."""
    profile_slopes: tuple[float, ...] = ()
    """Slope of the profile of each tooth beyond ``profile_slope``, (z,) [m]."""
    tooth_stiffness: tuple[float, ...] = ()
    """Scale of the stiffness of the tooth pairs that each tooth is in, (z,) [-]; 0 for a tooth that is missing."""

    @property
    def even_over_face(self) -> bool:
        """Whether every section of the face has the same flank."""
        across = (self.lead_crowning, self.helix_slope, self.profile_twist, *self.end_relief)
        return not any(across) and self.topography is None and self.back_topography is None


def cumulative_pitch(single_deviations: ArrayLike) -> tuple[float, ...]:
    """Cumulative from single pitch deviations (z,) [m], closed over the turn and with mean zero."""
    single = np.asarray(single_deviations, dtype=float)
    cumulative = np.cumsum(single - single.mean())
    return tuple(float(value) for value in cumulative - cumulative.mean())


def pitch_waves(teeth: int, waves: Iterable[tuple[int, float, float]]) -> tuple[float, ...]:
    """Cumulative pitch of waves over the turn: sum of amplitude cos(order angle - phase) at the angle of each tooth.

    waves : order per turn [-], amplitude along the line of action [m], phase [rad]. Returns (teeth,) [m].
    """
    angle = 2.0 * pi * np.arange(teeth) / teeth
    place = np.zeros(teeth)
    for order, amplitude, phase in waves:
        place += amplitude * np.cos(order * angle - phase)
    return tuple(float(value) for value in place)


def check_microgeometry(gear: Microgeometry, teeth: int) -> None:
    """Raise DynamicsInputError for arrays of another length than ``teeth`` or numbers below their limit."""
    for name in ("pitch_deviations", "profile_slopes", "tooth_stiffness"):
        values = getattr(gear, name)
        if values and len(values) != teeth:
            raise DynamicsInputError(
                f"{name} has {len(values)} values for {teeth} teeth; give one for each tooth or none"
            )
    for name in RELIEFS:
        _check_relief(gear, name)
    for name in ("topography", "back_topography"):
        measured = getattr(gear, name)
        if measured is not None and measured.teeth not in (1, teeth):
            raise DynamicsInputError(
                f"{name} has the flanks of {measured.teeth} teeth for {teeth} teeth; give all of them or one for all"
            )
    if not 0.0 <= gear.manufacturing_twist <= 1.0:
        raise DynamicsInputError(
            f"manufacturing_twist = {gear.manufacturing_twist} must lie in 0 .. 1; "
            "give the share of the natural twist that is left"
        )
    scales = gear.tooth_stiffness
    if scales and not (min(scales) >= 0.0 and max(scales) > 0.0):
        raise DynamicsInputError(
            "tooth_stiffness must not be negative for any tooth and not be zero for all; use 0 for a missing tooth"
        )


def _check_relief(gear: Microgeometry, name: str) -> None:
    amount, length, exponent = (getattr(gear, f"{name}{part}") for part in ("", "_length", "_exponent"))
    if not np.any(amount):
        return
    if not length > 0.0:
        raise DynamicsInputError(
            f"{name}_length = {length} m must be positive with {name} = {amount} m; give the length of the relief"
        )
    if not exponent > 0.0:
        raise DynamicsInputError(
            f"{name}_exponent = {exponent} must be positive; give 1 for a linear and 2 for a parabolic relief"
        )

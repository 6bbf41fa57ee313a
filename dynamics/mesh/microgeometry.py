"""Intended modifications and deviations of the flanks of one gear."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from dynamics.errors import DynamicsInputError


@dataclass(frozen=True, kw_only=True)
class Microgeometry:
    """Intended modifications and deviations of one gear; all zero is the ideal involute gear.

    Modifications are metal removed [m], positive widens the gap. Face position z runs over the own face width
    from -b/2 to b/2 in the direction of rising helix lag.
    """

    tip_relief: float = 0.0
    """C_a at the tip corner [m]."""
    tip_relief_length: float = 0.0
    """Path length from the tip over which the relief fades to zero [m]."""
    tip_relief_exponent: float = 1.0
    """1 linear, 2 parabolic."""
    profile_crowning: float = 0.0
    """C_alpha at both ends of the active path, parabolic, zero in its middle [m]."""
    lead_crowning: float = 0.0
    """C_beta at both ends of the face, parabolic, zero in its middle [m]."""
    profile_slope: float = 0.0
    """f_Halpha over the active profile, positive where the tip stands out: the gap is half of it less at the tip
    and half of it more at the root [m]."""
    helix_slope: float = 0.0
    """Change of the gap over the face width, from -b/2 to b/2 [m]."""
    profile_twist: float = 0.0
    """Gap at the tip at z = b/2; it changes sign at the root and at z = -b/2 (bilinear) [m]."""
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
    if gear.tip_relief and not gear.tip_relief_length > 0.0:
        raise DynamicsInputError(
            f"tip_relief_length = {gear.tip_relief_length} m must be positive with tip_relief = "
            f"{gear.tip_relief} m; give the path length of the relief"
        )
    scales = gear.tooth_stiffness
    if scales and not (min(scales) >= 0.0 and max(scales) > 0.0):
        raise DynamicsInputError(
            "tooth_stiffness must not be negative for any tooth and not be zero for all; use 0 for a missing tooth"
        )

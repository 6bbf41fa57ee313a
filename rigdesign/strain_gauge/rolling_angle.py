"""Rolling angle over time: at constant speed, from a recorded speed, and the turns until the same teeth meet again.

Index pulses, tooth-passing pulses and encoders: ``rigdesign.measurement.reading.tach``, whose ``TurnAngle.at`` is a
`RollingAngle` as those of this module are.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.number_faults import refuse, require_above

Array = NDArray[np.float64]
RollingAngle = Callable[[Array], Array]
"""Angle of the gear [rad] at (n,) points in time [s]; NaN where it is not known."""


def at_constant_speed(speed: float, start: float = 0.0) -> RollingAngle:
    """phi = omega t + start, with omega = 2 pi n / 60 (n in 1/min): P1's conversion of time steps to rolling angles.

    P1 shows its formula in Figure 5 only as a picture; this is the one that its text describes.

    Parameters
    ----------
    speed : [rad/s]
    start : angle at t = 0 [rad]
    """
    require_above("speed", speed, "rad/s", "write the speed of the gear with the gauge")
    return lambda time: start + speed * np.asarray(time, dtype=float)


def from_speed(time: Array, speed: Array, start: float = 0.0) -> RollingAngle:
    """Angle whose derivative is a recorded speed: the integral of a cubic spline through it.

    Parameters
    ----------
    time : (n,) increasing [s]
    speed : (n,) above zero [rad/s]
    start : angle at the first sample [rad]

    Raises
    ------
    MeasurementError
        Fewer than two samples, missing ones, or a speed not above zero.
    """
    from scipy.interpolate import CubicSpline

    problem = ""
    if len(time) < 2:
        problem = f"{len(time)} samples, at least 2 are needed"
    elif not np.all(np.isfinite(speed)):
        problem = f"{np.count_nonzero(~np.isfinite(speed))} samples are missing"
    elif not np.all(speed > 0.0):
        problem = "must be above 0 throughout"
    if problem:
        given = f"{np.nanmin(speed):.6g} rad/s at the least" if np.isfinite(speed).any() else ""
        raise MeasurementError([Fault(
            "speed", given, problem, "leave run-up and stop out, turn the sign of the channel, or use a tach",
        )])  # fmt: skip
    integral = CubicSpline(time, speed, extrapolate=False).antiderivative()
    return lambda at: np.asarray(start + integral(np.asarray(at, dtype=float)))


def turns_until_same_teeth(teeth: int, mating_teeth: int) -> int:
    """Turns of a gear until each of its teeth meets the same mating tooth: z_2 / gcd(z_1, z_2); 1 in P1's 1:1 pair."""
    for key, count in (("teeth", teeth), ("mating_teeth", mating_teeth)):
        if count < 1:
            refuse(key, str(count), "must be at least 1", "write the number of teeth")
    return mating_teeth // math.gcd(teeth, mating_teeth)

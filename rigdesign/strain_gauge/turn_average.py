"""A signal over time as a curve over the rolling angle of one turn: mean over turns, scatter, and by mating tooth."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.units import refuse, require_above, require_at_least

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TurnCurve:
    """Mean of a signal over the rolling angle.

    Parameters
    ----------
    angle : (m,) rolling angle within a turn [rad]
    mean : (m,) mean over the turns
    scatter : (m,) standard deviation of one turn about the mean, NaN of a single turn
    turns : turns averaged; left_out : turns with missing samples
    by_mating_tooth : (c, m) means of the turns with the same mating tooth; row: turns from angle zero modulo c, the
        turns until the same teeth meet again; NaN where no turn is
    """

    angle: Array
    mean: Array
    scatter: Array
    turns: int
    left_out: int
    by_mating_tooth: Array


@dataclass(frozen=True, kw_only=True)
class AngleGrid:
    """Angles at which the curve is wanted.

    points : over a turn, evenly; start : first of them [rad]; same_teeth_after : turns until the same teeth meet
    """

    points: int
    start: float = 0.0
    same_teeth_after: int = 1

    def __post_init__(self) -> None:
        for key, count in (("points", self.points), ("same_teeth_after", self.same_teeth_after)):
            require_at_least(key, count, "", "write a whole number", limit=1.0)


def turn_average(angle: Array, values: Array, grid: AngleGrid) -> TurnCurve:
    """Resample a signal evenly over the angle by a cubic spline and average over whole turns.

    Parameters
    ----------
    angle : (n,) at the samples, increasing [rad]; NaN where not known
    values : (n,) NaN where missing

    Raises
    ------
    MeasurementError
        Less than a turn, more points than samples in the fastest turn, an angle that runs backwards, missing samples
        in every turn.
    """
    from scipy.interpolate import CubicSpline

    known = np.isfinite(angle)
    angle, values = angle[known], values[known]
    if angle.size < 4:
        raise _refused(
            "angle", f"{angle.size} samples", "no turn is known", "record signal and tach together"
        )
    if not np.all(np.diff(angle) > 0.0):
        raise _refused("angle", "", "runs backwards or stands still", "leave run-up and stop out")
    turn = 2.0 * np.pi
    first = np.ceil((angle[0] - grid.start) / turn)
    whole = int(np.floor((angle[-1] - grid.start) / turn - first))
    if whole < 1:
        raise _refused(
            "recording", f"{np.ptp(angle) / turn:.3g} turns", "no whole turn in it", "record longer"
        )
    edges = grid.start + turn * (first + np.arange(whole + 1))
    samples = np.diff(np.searchsorted(angle, edges))
    if grid.points > samples.min():
        raise _refused(
            "points", str(grid.points), f"more than the {samples.min()} samples of the fastest turn",
            "ask for fewer points or sample faster",
        )  # fmt: skip
    finite = np.isfinite(values)
    bad = np.searchsorted(edges, angle[~finite], "right") - 1
    usable = np.ones(whole, dtype=bool)
    usable[bad[(bad >= 0) & (bad < whole)]] = False
    if not usable.any():
        raise _refused("recording", f"{whole} turns", "samples are missing in every one", "look at the cable")
    within = grid.start + turn * np.arange(grid.points) / grid.points
    wanted = within + turn * (first + np.flatnonzero(usable))[:, np.newaxis]
    rows = CubicSpline(angle[finite], values[finite])(wanted)
    return _curve(within, rows, whole, (np.flatnonzero(usable) + int(first)) % grid.same_teeth_after, grid)


def _curve(within: Array, rows: Array, whole: int, mates: NDArray[np.intp], grid: AngleGrid) -> TurnCurve:
    scatter = rows.std(axis=0, ddof=1) if len(rows) > 1 else np.full(len(within), np.nan)
    by_mate = np.full((grid.same_teeth_after, len(within)), np.nan)
    for mate in np.unique(mates):
        by_mate[mate] = rows[mates == mate].mean(axis=0)
    return TurnCurve(within, rows.mean(axis=0), scatter, len(rows), whole - len(rows), by_mate)


def _refused(key: str, given: str, problem: str, remedy: str) -> MeasurementError:
    return MeasurementError([Fault(key, given, problem, remedy)])


# A few numbers of the curve of a root gauge over the rolling angle of its tooth, for recorded and computed ones alike.
#
# Angles count from the centroid of the loaded part of the curve, so that neither the index angle of a recording nor the
# rotation at which a calculation begins is needed; a shift of the whole curve is not seen. All are strains above that
# of the unloaded tooth: a lost zero, thermal output and centrifugal strain are in the strain of the unloaded tooth
# alone.

LOADED = 0.2
"""Share of the highest strain from which the tooth counts as loaded: the part whose centroid is the zero angle."""
TOP = 0.1
"""Angle over which ``maximum`` is the mean of the highest strains, wherever they are [angular pitches]: as smooth as
the curve itself, where the single highest value jumps with samples and noise; some tenths of a per cent below it."""
FLANKS = (0.2, 0.5)
"""Distance from the centroid between which ``entry`` and ``exit`` are means [angular pitches]: the rise to the
maximum and the fall from it, where neighbouring pairs take over."""
AWAY = 2.0
"""Distance from the centroid beyond which neither the tooth nor its neighbours carry [angular pitches]."""
REACH = 1.2
"""Angle to both sides of the highest strain that belongs to the tooth [angular pitches]."""
STEPS = 400
"""Steps of an angular pitch in which the curve is interpolated, and places of a mean over a window."""


def curve_windows(angle: Array, strain: Array, pitch: float) -> Mapping[str, float]:
    """Entry, maximum, exit and unloaded strain of a curve.

    Parameters
    ----------
    angle : (n,) of the gear in the order in which the tooth goes through the mesh, increasing [rad]
    strain : (n,) [-]
    pitch : angle from tooth to tooth [rad]

    Returns
    -------
    ``unloaded``: median away from the tooth's own mesh and those of its neighbours, zero where the curve does not
    cover a pitch of it; ``entry``, ``maximum``, ``exit``: above it [-]. In a fillet that is pressed ``maximum`` is
    the lowest.
    """
    away = np.abs(angle - angle[np.argmax(np.abs(strain - np.median(strain)))]) > AWAY * pitch
    covered = float(np.gradient(angle)[away].sum())
    unloaded = float(np.median(strain[away])) if covered > pitch else 0.0
    above = strain - unloaded
    highest = int(np.argmax(np.abs(above)))
    sign = float(np.sign(above[highest]))
    step = pitch / STEPS
    around = np.arange(angle[highest] - REACH * pitch, angle[highest] + REACH * pitch, step)
    fine = sign * np.interp(around, angle, above)
    middle = _centroid(around, fine)
    low, high = FLANKS[0] * pitch, FLANKS[1] * pitch

    def mean(first: float, last: float) -> float:
        return sign * float(np.interp(np.linspace(first, last, STEPS), around, fine).mean())

    return {
        "entry": mean(middle - high, middle - low),
        "maximum": sign * float(np.sort(fine)[-round(TOP * STEPS) :].mean()),
        "exit": mean(middle + low, middle + high),
        "unloaded": unloaded,
    }


def _centroid(angle: Array, strain: Array) -> float:
    """Of the loaded part around the highest strain [rad]."""
    highest = int(np.argmax(strain))
    loaded = strain > LOADED * strain[highest]
    before = np.flatnonzero(~loaded[:highest])
    after = np.flatnonzero(~loaded[highest:])
    first = int(before[-1]) + 1 if before.size else 0
    last = highest + int(after[0]) if after.size else len(strain)
    total = float(strain[first:last].sum())
    return float((angle * strain)[first:last].sum()) / total if total else float(angle[highest])


# Rolling angle over time: at constant speed, from a recorded speed, and the turns until the same teeth meet again.
#
# Index pulses, tooth-passing pulses and encoders: ``rigdesign.measurement.reading.signals``, whose ``TurnAngle.at`` is
# a
# `RollingAngle` as those of this module are.

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
    return lambda times: np.asarray(start + integral(np.asarray(times, dtype=float)))


def turns_until_same_teeth(teeth: int, mating_teeth: int) -> int:
    """Turns of a gear until each of its teeth meets the same mating tooth: z_2 / gcd(z_1, z_2); 1 in P1's 1:1 pair."""
    for key, count in (("teeth", teeth), ("mating_teeth", mating_teeth)):
        if count < 1:
            refuse(key, str(count), "must be at least 1", "write the number of teeth")
    return mating_teeth // math.gcd(teeth, mating_teeth)

"""A signal over time as a curve over the rolling angle of one turn: mean over turns, scatter, and by mating tooth."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.number_faults import require_at_least

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

"""The angle of the reference gear over time, from pulses or an encoder; lost pulses are found and filled."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.reading.measurement_set import Tach
from rigdesign.measurement.reading.signals import Signal, Signals

Array = NDArray[np.float64]
HYSTERESIS = 0.2
"""Half width of the band about the middle of a pulse, as a share of its height, that noise must not cross."""
NEIGHBOURS = 9
"""Intervals whose median a lost or surplus pulse is found by."""
MOST_LOST = 0.05
"""Share of lost and surplus pulses from which a recording cannot be used."""
ENCODER_STEPS = 64
"""Points per turn at which an encoder's angle is kept."""


class TachError(ValueError):
    """A tach signal that gives no angle; the message says why and what to do."""


@dataclass(frozen=True)
class TurnAngle:
    """Angle of the reference gear at points in time, increasing.

    absolute : whether full turns are counted from where both teeth 0 met; else the angle is known but for whole turns
    lost : pulses that were missing and filled; surplus : pulses that were too many and left out
    """

    time: Array
    angle: Array
    absolute: bool
    lost: int = 0
    surplus: int = 0

    @property
    def turns(self) -> float:
        """Turns between first and last point."""
        return float(self.angle[-1] - self.angle[0]) / (2.0 * math.pi)

    @property
    def speed(self) -> float:
        """Mean speed [rad/s]."""
        return float((self.angle[-1] - self.angle[0]) / (self.time[-1] - self.time[0]))

    def at(self, time: Array) -> Array:
        """Angle at points in time [rad], NaN outside; a monotone cubic through the known ones."""
        from scipy.interpolate import PchipInterpolator

        return np.asarray(PchipInterpolator(self.time, self.angle, extrapolate=False)(time))


def turn_angle(tach: Tach, signals: Signals, start_turn: float | None) -> TurnAngle:
    """Angle of the reference gear.

    Parameters
    ----------
    start_turn : turns since both teeth 0 met at the first angle zero of the recording, where known

    Raises
    ------
    TachError
        A signal is missing or dead, has too few pulses, loses too many, runs backwards.
    """
    signal = _named(signals, tach.signal)
    if tach.kind == "angle":
        return _encoder(tach, signal, start_turn)
    edges = rising_edges(signal)
    counts, kept, lost, surplus = pulse_counts(edges)
    if lost + surplus > MOST_LOST * len(edges):
        raise TachError(
            f"{tach.signal}: {lost} pulses lost and {surplus} too many of {len(edges)}, above {MOST_LOST:.0%}; "
            "look at sensor, gap and trigger level"
        )
    marks = None if tach.index is None else rising_edges(_named(signals, tach.index))
    pulses = _pulses_per_turn(tach, counts, kept, marks)
    found = TurnAngle(kept, 2.0 * math.pi * counts / pulses, start_turn is not None, lost, surplus)
    if pulses > 1:
        found = _indexed(tach, found, marks)
    whole = 0.0 if start_turn is None else 2.0 * math.pi * start_turn
    return TurnAngle(found.time, found.angle + tach.zero + whole, found.absolute, lost, surplus)


def rising_edges(signal: Signal) -> Array:
    """Times at which a pulse signal rises through its middle, between samples by straight lines."""
    finite = np.isfinite(signal.values)
    time, values = signal.time[finite], signal.values[finite]
    if not values.size:
        raise TachError("no sample of the tach is a number; look at its cable")
    low, high = np.quantile(values, (0.005, 0.995))
    if not high > low:
        low, high = float(values.min()), float(values.max())
    if not high > low:
        raise TachError("the tach signal never changes; look at sensor and cable")
    middle, band = 0.5 * (low + high), HYSTERESIS * (high - low)
    state = np.where(values > middle + band, 1, np.where(values < middle - band, -1, 0))
    firm = np.flatnonzero(state)
    rises = firm[1:][(state[firm[1:]] == 1) & (state[firm[:-1]] == -1)]
    crossings = np.flatnonzero((values[:-1] < middle) & (values[1:] >= middle))
    last = crossings[np.searchsorted(crossings, rises - 1, side="right") - 1]
    share = (middle - values[last]) / (values[last + 1] - values[last])
    return np.asarray(time[last] + share * (time[last + 1] - time[last]))


def pulse_counts(edges: Array) -> tuple[Array, Array, int, int]:
    """Number of each pulse counted from the first, times kept, pulses lost, pulses too many.

    An interval of about n times the median of its neighbours stands for n; one below half of it ends with a
    surplus pulse.
    """
    if len(edges) < 4:
        raise TachError(
            f"{len(edges)} tach pulses, at least 4 are needed; record longer or look at the trigger level"
        )
    kept, surplus = list(edges), 0
    short = True
    while short and len(kept) >= 4:
        steps = np.diff(kept)
        usual = _running_median(steps)
        below = np.flatnonzero(steps < 0.5 * usual)
        short = below.size > 0
        if short:
            del kept[int(below[0]) + 1]
            surplus += 1
        if surplus > MOST_LOST * len(edges):
            break
    steps = np.diff(kept)
    strides = np.maximum(np.rint(steps / _running_median(steps)), 1.0)
    counts = np.concatenate([[0.0], np.cumsum(strides)])
    return counts, np.asarray(kept), int(counts[-1]) + 1 - len(kept), surplus


def _running_median(values: Array) -> Array:
    half = NEIGHBOURS // 2
    padded = np.pad(values, half, mode="reflect" if len(values) > half else "edge")
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(padded, NEIGHBOURS), axis=1))


def _pulses_per_turn(tach: Tach, counts: Array, kept: Array, marks: Array | None) -> int:
    """As stated, which the pulses from one index pulse to the next have to confirm, or as these count them."""
    passed = np.empty(0) if marks is None else np.interp(marks, kept, counts, np.nan, np.nan)
    steps = np.diff(passed[np.isfinite(passed)])
    counted = round(float(np.median(steps))) if steps.size else None
    stated = tach.pulses_per_turn
    if stated is not None and counted not in (None, stated):
        raise TachError(
            f"{tach.index} comes every {counted} pulses of {tach.signal}, data.tach.pulses_per_turn says {stated}; "
            "correct the key, or look at both sensors"
        )
    if stated is None and marks is not None and counted is None:
        raise TachError(
            f"{tach.index}: fewer than two index pulses within the tach pulses; state pulses_per_turn"
        )
    return stated or counted or 1


def _indexed(tach: Tach, found: TurnAngle, marks: Array | None) -> TurnAngle:
    """Zero of the angle at the index pulse."""
    if marks is None:
        raise TachError(
            f"{tach.pulses_per_turn} pulses a turn say nothing of where zero is; name data.tach.index, a signal with "
            "one pulse a turn"
        )
    marks = found.at(marks)
    marks = marks[np.isfinite(marks)]
    if not marks.size:
        raise TachError(f"{tach.index}: no index pulse within the tach pulses; look at its cable")
    zero = float(np.angle(np.mean(np.exp(1j * marks))))
    first = marks[0] - zero
    shift = zero + 2.0 * math.pi * round(first / (2.0 * math.pi))
    return TurnAngle(found.time, found.angle - shift, found.absolute)


def _encoder(tach: Tach, signal: Signal, start_turn: float | None) -> TurnAngle:
    scale = {"deg": math.pi / 180.0, "rad": 1.0, "mrad": 1e-3}[tach.unit]
    finite = np.isfinite(signal.values)
    time, angle = signal.time[finite], scale * signal.values[finite]
    if angle.size < 2 or np.ptp(angle) == 0.0:
        raise TachError(f"{tach.signal}: the angle never changes; look at the encoder")
    if tach.wraps:
        angle = np.unwrap(angle)
        angle = angle - 2.0 * math.pi * math.floor(angle[0] / (2.0 * math.pi))
    if angle[-1] <= angle[0]:
        raise TachError(
            f"{tach.signal}: the angle runs backwards; exchange the tracks of the encoder or turn its sign"
        )
    grid = np.arange(angle[0], angle[-1], 2.0 * math.pi / ENCODER_STEPS)
    rising = np.maximum.accumulate(angle)
    first = np.concatenate([[True], np.diff(rising) > 0.0])
    whole = 2.0 * math.pi * start_turn if start_turn is not None and tach.wraps else 0.0
    moment = np.interp(grid, rising[first], time[first])
    inside = np.concatenate([[True], np.diff(moment) > 0.0])
    known = not tach.wraps or start_turn is not None
    return TurnAngle(moment[inside], grid[inside] + tach.zero + whole, known)


def _named(signals: Signals, name: str) -> Signal:
    if name not in signals:
        raise TachError(f"no signal {name} in the recording; it has {', '.join(signals.names)}")
    return signals[name]

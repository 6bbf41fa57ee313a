"""Orders over speed: the angle known, each window of whole turns is projected on every order with a Hann weight.

As in `averaging` the integral is taken over the samples as they stand, so that speed may change within a window; the
weight keeps orders between two lines and the mean out of each other. Windows overlap by half.
Source: Fyfe and Munck (1997), Mech. Syst. Signal Process. 11, 187.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.processing.averaging import SAMPLES_PER_PERIOD
from rigdesign.measurement.reading.signals import Signal
from rigdesign.measurement.reading.tach import TurnAngle

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

OVERLAP = 0.5
"""Share of a window that the next one has, too."""
LEAST_WINDOWS = 5
"""Windows below which a recording is no sweep."""


@dataclass(frozen=True, kw_only=True)
class OrderCurves:
    """Orders of one signal over the windows of a sweep, in the order of time.

    speed : (m,) of the reference gear [rad/s], signed as it turns; rate : (m,) its derivative [rad/s2]
    amplitude : order -> (m,) complex, one-sided, NaN where samples are missing or too few per period
    """

    speed: Array
    rate: Array
    amplitude: dict[float, Complex]

    def at(self, order: float, speed: float) -> complex:
        """Amplitude at a speed [rad/s], between the windows by straight lines; NaN outside."""
        own = self.amplitude[order]
        known = np.flatnonzero(np.isfinite(own.real))
        rising = known[np.argsort(self.speed[known])]
        places = self.speed[rising]
        if not rising.size or not places[0] <= speed <= places[-1]:
            return complex(math.nan, math.nan)
        return complex(np.interp(speed, places, own[rising].real), np.interp(speed, places, own[rising].imag))


def order_curves(signal: Signal, turn: TurnAngle, orders: Sequence[float], turns: int) -> OrderCurves:
    """Orders of a signal over the speed of a sweep.

    Parameters
    ----------
    orders : per turn of the reference gear; turns : of it in one window

    Raises
    ------
    ValueError
        Fewer than `LEAST_WINDOWS` windows.
    """
    angle = turn.at(signal.time)
    inside = np.isfinite(angle)
    time, angle, values = signal.time[inside], angle[inside], signal.values[inside]
    length = 2.0 * math.pi * turns
    covered = float(angle[-1] - angle[0]) if angle.size > 1 else 0.0
    count = int((covered / length - 1.0) / (1.0 - OVERLAP)) + 1
    if count < LEAST_WINDOWS:
        raise ValueError(
            f"{covered / (2.0 * math.pi):.3g} turns, {LEAST_WINDOWS} windows of {turns} turns are needed; record "
            "longer or take fewer turns a window"
        )
    starts = angle[0] + (1.0 - OVERLAP) * length * np.arange(count)
    wanted = np.asarray(orders, dtype=float)
    found = np.full((count, wanted.size), complex(math.nan, math.nan))
    for row, start in enumerate(starts):
        first, last = np.searchsorted(angle, (start, start + length))
        found[row] = _projected(angle[first:last], values[first:last], start, turns, wanted)
    speed, rate = _speeds(time, angle, starts + 0.5 * length, length)
    return OrderCurves(speed=speed, rate=rate, amplitude=dict(zip(wanted.tolist(), found.T)))


def _projected(angle: Array, values: Array, start: float, turns: int, orders: Array) -> Complex:
    """(k,) orders of one window; NaN where they cannot be known."""
    unknown = np.full(orders.size, complex(math.nan, math.nan))
    if angle.size < 3 or not np.all(np.isfinite(values)):
        return unknown
    weight = np.sin(0.5 * (angle - start) / turns) ** 2 * np.gradient(angle)
    waves = np.exp(-1j * np.outer(orders, angle))
    projected = waves @ (weight * values) / weight.sum() * np.where(orders > 0.0, 2.0, 1.0)
    enough = orders * SAMPLES_PER_PERIOD <= angle.size / turns
    return np.where(enough, projected, unknown)


def _speeds(time: Array, angle: Array, middles: Array, length: float) -> tuple[Array, Array]:
    """Speed over the middle half of every window, and how fast it changes."""
    before, here, after = (np.interp(middles + share * length, angle, time) for share in (-0.25, 0.0, 0.25))
    speed = 0.5 * length / (after - before)
    return speed, np.gradient(speed, here)

"""Time-synchronous averaging: complex orders of a signal over whole hunting cycles.

With the angle known, an order is the projection X_k = 2 / Theta * integral of x exp(-i k phi) dphi over whole
cycles, which averages out what does not turn with the gears. The integral is taken over the samples as they
stand (trapezoidal rule in the angle): nothing is resampled, speed may vary.
Sources: McFadden (1987), Mech. Syst. Signal Process. 1, 83; Fyfe and Munck (1997), ibid. 11, 187.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.reading.signals import Signal
from rigdesign.measurement.reading.tach import TurnAngle

SAMPLES_PER_PERIOD = 2.5
"""Least number of samples per period of an order."""
FRACTION = 1e-9
"""An order this near a whole number turns with the reference gear."""


@dataclass(frozen=True)
class MeasuredOrders:
    """Complex orders of one signal in one recording.

    values : by order, one-sided: x = sum Re(X exp(i k phi)); the mean at 0
    cycles : cycles averaged; cycle : turns of one; left_out : cycles with missing samples
    too_fast : orders with too few samples per period; without_phase : fractional orders whose zero is not known
    """

    values: dict[float, complex]
    cycles: int
    cycle: int
    left_out: int
    too_fast: tuple[float, ...] = ()
    without_phase: tuple[float, ...] = ()


def signal_orders(signal: Signal, turn: TurnAngle, orders: Sequence[float], cycle: int) -> MeasuredOrders:
    """MeasuredOrders of a signal, averaged over whole hunting cycles.

    A recording shorter than one cycle is averaged over whole turns and gives whole orders only.

    Parameters
    ----------
    orders : per turn of the reference gear
    cycle : turns of that gear until the same teeth meet everywhere

    Raises
    ------
    ValueError
        Less than one turn, or missing samples in every cycle.
    """
    angle = turn.at(signal.time)
    inside = np.isfinite(angle)
    time, angle, values = signal.time[inside], angle[inside], signal.values[inside]
    if angle.size < 2:
        raise ValueError("the signal does not overlap the tach; record both together")
    turns = (angle[-1] - angle[0]) / (2.0 * math.pi)
    span = cycle if turns >= cycle else 1
    if turns < 1.0:
        raise ValueError(f"{turns:.2g} turns, at least one is needed; record longer")
    rate = (len(time) - 1) / (angle[-1] - angle[0]) * 2.0 * math.pi
    known = [k for k in orders if turn.absolute or abs(k - round(k)) < FRACTION]
    known = [k for k in known if span == cycle or abs(k - round(k)) < FRACTION]
    fast = [k for k in known if k * SAMPLES_PER_PERIOD > rate]
    wanted = np.array([k for k in known if k not in fast], dtype=float)
    sums, used, left_out = np.zeros(len(wanted), dtype=complex), 0, 0
    for start in np.arange(int(turns / span)) * (2.0 * math.pi * span) + angle[0]:
        part = _part(angle, values, start, start + 2.0 * math.pi * span)
        if not np.all(np.isfinite(part[1])):
            left_out += 1
            continue
        sums += _projections(*part, wanted)
        used += 1
    if not used:
        raise ValueError("samples are missing in every cycle; look at the cable or record longer")
    scale = np.where(wanted > 0.0, 2.0, 1.0) / (used * 2.0 * math.pi * span)
    return MeasuredOrders(
        values=dict(zip(wanted.tolist(), (scale * sums).tolist())),
        cycles=used,
        cycle=span,
        left_out=left_out,
        too_fast=tuple(fast),
        without_phase=tuple(k for k in orders if k not in known),
    )


def _part(
    angle: NDArray[np.float64], values: NDArray[np.float64], start: float, end: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Samples from ``start`` to ``end`` with the signal at both ends between its neighbours."""
    first, last = np.searchsorted(angle, start, "right"), np.searchsorted(angle, end, "left")
    ends = np.interp([start, end], angle, values)
    return (
        np.concatenate([[start], angle[first:last], [end]]),
        np.concatenate([ends[:1], values[first:last], ends[1:]]),
    )


def _projections(
    angle: NDArray[np.float64], values: NDArray[np.float64], orders: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Integral of x exp(-i k phi) over the angle for every order."""
    weights = np.empty_like(angle)
    weights[1:-1] = 0.5 * (angle[2:] - angle[:-2])
    weights[0], weights[-1] = 0.5 * (angle[1] - angle[0]), 0.5 * (angle[-1] - angle[-2])
    weighted = weights * values
    return np.array([np.sum(weighted * np.exp(-1j * k * angle)) for k in orders], dtype=complex)

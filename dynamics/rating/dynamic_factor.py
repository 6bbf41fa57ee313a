"""Resonances from the response of a gearbox over speed.

The dynamic torque of a gearbox is what its mesh transmits at the pinion: ``r_b1`` times the front less the
back normal force in the transverse line of action, without friction and derivative torques. That is the
load of the teeth, which ISO 6336 multiplies by K_V; the torque in an adjacent shaft differs by the inertia
between.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class DynamicFactorCurve:
    """Response of all meshes over speed; arrays (n_meshes, n_speeds) unless said otherwise.

    speed : (n_speeds,) of the first pinion [rad/s], increasing
    factor : greatest over mean torque (P2, Formula 1) [-]
    mean_torque, amplitude : mean and half peak-to-peak of the dynamic torque [N m]
    lift_off_share : share of time without contact [-]
    """

    speed: Array
    factor: Array
    mean_torque: Array
    amplitude: Array
    lift_off_share: Array


@dataclass(frozen=True, kw_only=True)
class Resonance:
    """Peak of the dynamic torque of one mesh over speed.

    mesh : index; speed : of the first pinion, by a parabola through the peak [rad/s]
    factor : greatest over mean torque there [-]; amplitude : half peak-to-peak torque [N m]
    force_share : amplitude over mean torque [-]
    amplification : amplitude over the level it rises from [-]
    lift_off_share : share of time without contact [-]
    at_end : the torque still rises at the highest speed of the curve: the peak lies there or above
    """

    mesh: int
    speed: float
    factor: float
    amplitude: float
    force_share: float
    amplification: float
    lift_off_share: float
    at_end: bool = False


def resonances(curve: DynamicFactorCurve, *, least_prominence: float = 0.02) -> tuple[Resonance, ...]:
    """Return the peaks of every mesh that stand out by ``least_prominence`` of the mean torque, by mesh and speed.

    A curve that still rises at its highest speed has a peak there (``at_end``).
    """
    peaks: list[Resonance] = []
    for mesh, amplitude in enumerate(curve.amplitude):
        share = amplitude / np.abs(curve.mean_torque[mesh])
        standing = {peak: height for peak, height in _prominences(share) if height >= least_prominence}
        if (rise := _rise_at_end(share)) >= least_prominence:
            standing[share.size - 1] = rise
        for peak, prominence in standing.items():
            peaks.append(
                Resonance(
                    mesh=mesh,
                    speed=_peak_speed(curve.speed, share, peak),
                    factor=float(curve.factor[mesh, peak]),
                    amplitude=float(amplitude[peak]),
                    force_share=float(share[peak]),
                    amplification=float(share[peak] / max(share[peak] - prominence, 1e-9)),
                    lift_off_share=float(curve.lift_off_share[mesh, peak]),
                    at_end=peak == share.size - 1,
                )
            )
    return tuple(peaks)


def _prominences(values: Array) -> Iterator[tuple[int, float]]:
    """Every peak and its height over the higher one of the lowest values towards the next higher peaks beside it, as
    `scipy.signal.find_peaks`, whose import takes half a second."""
    for peak in (np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] > values[2:])) + 1).tolist():
        higher = np.flatnonzero(values > values[peak])
        first = int(higher[higher < peak].max(initial=-1)) + 1
        last = int(higher[higher > peak].min(initial=values.size))
        base = max(values[first:peak].min(), values[peak + 1 : last].min())
        yield peak, float(values[peak] - base)


def _rise_at_end(values: Array) -> float:
    """Height of the last value over the lowest one since the last that was higher; 0 unless it ends rising."""
    if values.size < 2 or values[-1] <= values[-2]:
        return 0.0
    higher = np.flatnonzero(values > values[-1])
    return float(values[-1] - values[higher[-1] if higher.size else 0 :].min())


def _peak_speed(speeds: Array, factors: Array, peak: int) -> float:
    """Return the apex of the parabola through a peak and its neighbours; the peak if they lie flat or it is last."""
    if peak == speeds.size - 1:
        return float(speeds[peak])
    return parabola_apex(speeds[peak - 1 : peak + 2], factors[peak - 1 : peak + 2])


def parabola_apex(places: Array, values: Array) -> float:
    """Where the parabola through three values (3,) at rising places (3,) has its apex, within them; the middle one if
    they lie on a line."""
    slope_1, slope_2 = np.diff(values) / np.diff(places)
    if slope_1 == slope_2:
        return float(places[1])
    middle_1, middle_2 = 0.5 * (places[1:] + places[:-1])
    apex = middle_1 + (middle_2 - middle_1) * slope_1 / (slope_1 - slope_2)
    return float(np.clip(apex, places[0], places[2]))

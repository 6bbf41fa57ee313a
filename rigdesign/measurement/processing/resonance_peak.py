"""Peak of an amplitude over speed or frequency: place, half-power width, and how well both are known.

Near a resonance of one mode 1/|X|^2 is a parabola, ((x - x0)^2 + h^2) / c^2 with h = damping ratio times x0, whose
least squares are linear. It is fitted to the points above the half power, weighted for a constant error of |X|.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HALF_POWER = math.sqrt(0.5)
"""Share of the peak at which the power is half."""
LEAST_POINTS = 4
"""Points a parabola is fitted to."""
ABOVE = 3.0
"""Least height of a peak over the median of what is searched."""


@dataclass(frozen=True, kw_only=True)
class Peak:
    """A peak in the unit of its axis.

    place : x0; half_width : h of the half power, so that h / x0 is the damping ratio; uncertainty : one sigma of the
    place by the scatter about the parabola, at least the spacing of points over the root of 12 times their number
    """

    place: float
    half_width: float
    uncertainty: float


def resonance_peak(x: Array, amplitude: Array, search: tuple[float, float] | None = None) -> Peak:
    """The highest peak of |X| (n,) over x (n,), both in any order, NaN left out.

    search : least and greatest x

    Raises
    ------
    ValueError
        No peak: too few points, the largest one at an end, not above what is around it, or not round.
    """
    known = np.isfinite(x) & np.isfinite(amplitude)
    if search is not None:
        known &= (x >= search[0]) & (x <= search[1])
    order = np.argsort(x[known], kind="stable")
    x, amplitude = x[known][order], amplitude[known][order]
    if x.size < LEAST_POINTS:
        raise ValueError(
            f"{x.size} points there, {LEAST_POINTS} are needed; record slower or widen the search_range"
        )
    top = int(np.argmax(amplitude))
    if top in (0, x.size - 1):
        raise ValueError(
            "the largest amplitude stands at the end of what is searched; widen or shift the search_range"
        )
    height, around = float(amplitude[top]), float(np.median(amplitude))
    if not height > ABOVE * around:
        raise ValueError(
            f"the largest amplitude is {height / max(around, 1e-300):.2g} times the median, {ABOVE:g} is a peak; look "
            "at another order or signal"
        )
    first, last = _flanks(amplitude, top)
    return _fitted(x[first:last], amplitude[first:last])


def _flanks(amplitude: Array, top: int) -> tuple[int, int]:
    """Points of the peak above the half power, and as many more as a fit needs, from the higher neighbour on."""
    first, last = top, top + 1
    level = HALF_POWER * amplitude[top]
    while first > 0 and amplitude[first - 1] >= level:
        first -= 1
    while last < amplitude.size and amplitude[last] >= level:
        last += 1
    while last - first < LEAST_POINTS:
        left = amplitude[first - 1] if first > 0 else -math.inf
        right = amplitude[last] if last < amplitude.size else -math.inf
        first, last = (first - 1, last) if left >= right else (first, last + 1)
    return first, last


def _fitted(x: Array, amplitude: Array) -> Peak:
    centre, scale = float(np.mean(x)), max(float(np.ptp(x)), 1e-300)
    t, y = (x - centre) / scale, (amplitude.max() / amplitude) ** 2
    weight = y**-1.5
    columns = np.stack([t**2, t, np.ones_like(t)], axis=1) * weight[:, None]
    (a, b, c), residual, rank, _ = np.linalg.lstsq(columns, y * weight, rcond=None)
    if rank < 3 or not a > 0.0 or not c > b**2 / (4.0 * a):
        raise ValueError(
            "the largest amplitudes are no resonance of one mode; narrow the search_range or record slower"
        )
    place = -b / (2.0 * a)
    if not t.min() <= place <= t.max():
        raise ValueError("the parabola has its top beside the largest amplitudes; narrow the search_range")
    variance = float(residual[0]) / (x.size - 3) if residual.size and x.size > 3 else 0.0
    gradient = np.array([b / (2.0 * a**2), -1.0 / (2.0 * a), 0.0])
    scatter = math.sqrt(variance * float(gradient @ np.linalg.inv(columns.T @ columns) @ gradient))
    spacing = 1.0 / (x.size - 1) / math.sqrt(12.0 * x.size)
    return Peak(
        place=centre + scale * place,
        half_width=scale * math.sqrt(c / a - place**2),
        uncertainty=scale * math.hypot(scatter, spacing),
    )

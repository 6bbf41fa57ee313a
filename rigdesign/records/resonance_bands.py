"""Speeds around the peaks of the response: where the dynamic part exceeds a stated share, and nearer than a margin.

The share is ``limits.dynamics.dangerous_force_share``, the margin ``limits.dynamics.resonance_distance_minimum``.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.results.vibration import AvoidedBand, AvoidedResonance, ResonanceKind

Array = NDArray[np.float64]
USUAL_MARGIN = 0.1
"""Margin of a case that states none."""


@dataclass(frozen=True)
class DynamicShare:
    """Dynamic part over the mean of one quantity over rising speeds of the first pinion, (s,) each."""

    kind: ResonanceKind
    where: str
    speed: Array
    share: Array


def resonances(quantity: DynamicShare, limit: float, margin: float) -> Iterator[AvoidedResonance]:
    """One for each interval in which the share exceeds the limit, widened to the margin round its peak."""
    speed, share = quantity.speed, quantity.share
    above = np.concatenate(([False], share > limit, [False]))
    edges = np.flatnonzero(np.diff(above.astype(int)))
    for first, last in zip(edges[::2], edges[1::2]):
        peak = first + int(np.argmax(share[first:last]))
        at = float(speed[peak])
        low = _crossing(speed, share, first - 1, limit) if first else float(speed[0])
        high = _crossing(speed, share, last - 1, limit) if last < speed.size else float(speed[-1])
        found = AvoidedResonance(
            kind=quantity.kind, where=quantity.where, speed=at, share=float(share[peak]), low=low, high=high
        )
        yield found.widened(margin)


def _crossing(speed: Array, share: Array, place: int, limit: float) -> float:
    """Where the share passes the limit between two speeds."""
    a, b = share[place], share[place + 1]
    return float(speed[place] + (limit - a) / (b - a) * (speed[place + 1] - speed[place]))


def bands(found: Iterable[AvoidedResonance]) -> tuple[AvoidedBand, ...]:
    """Resonances that touch or overlap as one band, rising."""
    groups: list[list[AvoidedResonance]] = []
    top = -np.inf
    for one in sorted(found, key=lambda resonance: resonance.low):
        if one.low > top:
            groups.append([])
        groups[-1].append(one)
        top = max(top, one.high)
    return tuple(
        AvoidedBand(
            low=min(one.low for one in group),
            high=max(one.high for one in group),
            resonances=tuple(sorted(group, key=lambda one: one.speed)),
        )
        for group in groups
    )


def safe_windows(avoided: Sequence[AvoidedBand], low: float, high: float) -> tuple[tuple[float, float], ...]:
    """What the bands leave of a range of speeds."""
    found, at = [], low
    for band in avoided:
        if band.low > at:
            found.append((at, min(band.low, high)))
        at = max(at, band.high)
        if at >= high:
            break
    if at < high:
        found.append((at, high))
    return tuple((a, b) for a, b in found if b > a)


def nearest_safe(windows: Sequence[tuple[float, float]], speed: float) -> float | None:
    """Safe speed nearest to one; None where there is none."""
    places = [min(max(speed, low), high) for low, high in windows]
    return min(places, key=lambda place: abs(place - speed), default=None)

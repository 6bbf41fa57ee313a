"""How large an effect is, with an interval that admits what the model may answer wrongly."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import Evidence, release_of

NORMAL_95 = 1.96
"""Standard deviations of an interval that holds 95 % of a normal distribution."""


@dataclass(frozen=True, kw_only=True)
class Size:
    """One coordinate of a named effect.

    at_bound : the interval ends on a physical bound on at least one side: it is open there
    """

    effect: str
    number: int
    coordinate: float
    interval: tuple[float, float]
    at_bound: bool


@dataclass(frozen=True, kw_only=True)
class JointFit:
    """All named effects fitted together, with a flat prior and the constants' priors kept.

    answer : (n,) whitened; sizes : one per coordinate
    """

    sizes: tuple[Size, ...]
    coordinates: tuple[tuple[float, ...], ...]
    answer: Array

    def with_other(self, other: "JointFit") -> "JointFit":
        """With a fit to other numbers behind it."""
        return JointFit(
            sizes=(*self.sizes, *other.sizes),
            coordinates=(*self.coordinates, *other.coordinates),
            answer=np.concatenate([self.answer, other.answer]),
        )


def fit_together(
    space: Whitened,
    found: Sequence[Evidence],
    widths: Mapping[str, float],
    bounds: Sequence[Sequence[tuple[float, float]]],
) -> JointFit:
    """Gauss-Newton on the curves of all named effects, kept within bounds, and their intervals.

    widths : family of an effect -> relative error of the model's answer to it, by which intervals become wider
    bounds : of every coordinate of every effect
    """
    owns = [own for one in found for own in one.hypothesis.own]
    release, residual = release_of(space, owns), space.freed(owns)
    coordinates = [np.array(one.coordinates) for one in found]
    for _ in range(20):
        slopes = [_slope(one, size) for one, size in zip(found, coordinates, strict=True)]
        columns = np.hstack(slopes)
        left = residual - sum(
            (_answer(one, size) for one, size in zip(found, coordinates, strict=True)), np.zeros(len(columns))
        )
        gram = release.product(columns, columns)
        step = np.linalg.lstsq(gram, release.product(columns, left), rcond=None)[0]
        moved = _clipped(np.concatenate(coordinates) + step, bounds)
        change = float(np.abs(moved - np.concatenate(coordinates)).max())
        coordinates = _split(moved, [len(size) for size in coordinates])
        if change < 1e-9 * max(1.0, float(np.abs(moved).max())):
            break
    inverse = np.linalg.pinv(gram, hermitian=True)
    deviations = np.sqrt(np.maximum(np.diagonal(inverse), 0.0))
    sizes = []
    number = 0
    for one, size, limits in zip(found, coordinates, bounds, strict=True):
        kind = one.hypothesis.parts[0].split(":")[0]
        width = widths.get(kind, widths.get("", 0.25))
        below, above = _misanswered(one, size, NORMAL_95 * width)
        for place, value in enumerate(size):
            low, high = limits[place]
            first = float(value - np.hypot(NORMAL_95 * deviations[number], below))
            last = float(value + np.hypot(NORMAL_95 * deviations[number], above))
            sizes.append(
                Size(
                    effect=one.hypothesis.name,
                    number=place,
                    coordinate=float(value),
                    interval=(max(first, low), min(last, high)),
                    at_bound=first <= low or last >= high,
                )
            )
            number += 1
    answer = sum(
        (_answer(one, size) for one, size in zip(found, coordinates, strict=True)),
        np.zeros(len(space.residual)),
    )
    return JointFit(
        sizes=tuple(sizes),
        coordinates=tuple(tuple(float(value) for value in size) for size in coordinates),
        answer=np.asarray(answer),
    )


def _misanswered(one: Evidence, size: Array, share: float) -> tuple[float, float]:
    """How far below and above a coordinate the answer is smaller or larger by a share of itself.

    A proportional answer is off by that share of the size; where the answer saturates a size is known much worse.
    """
    curve = one.hypothesis.curve
    whole = float(np.linalg.norm(size))
    if curve is None or whole == 0.0:
        return share * whole, share * whole
    value = float(size[0])
    end = curve.bounds[1] if value > 0.0 else curve.bounds[0]
    grid = np.linspace(0.0, end, FINE) if abs(end) > 0.0 else np.zeros(FINE)
    here = curve.at(size)[0]
    shares = np.maximum.accumulate(curve.at(grid) @ here / float(here @ here))
    nearer = abs(value - float(np.interp(1.0 - share, shares, grid)))
    farther = (
        abs(float(np.interp(1.0 + share, shares, grid)) - value) if shares[-1] >= 1.0 + share else np.inf
    )
    return (nearer, farther) if value > 0.0 else (farther, nearer)


FINE = 401
"""Points at which a curve is searched for a larger or smaller answer."""


def _slope(one: Evidence, size: Array) -> Array:
    curve = one.hypothesis.curve
    return one.columns if curve is None else curve.sensitivity(float(size[0]))[:, None]


def _answer(one: Evidence, size: Array) -> Array:
    curve = one.hypothesis.curve
    return np.asarray(one.columns @ size) if curve is None else curve.at(size)[0]


def _clipped(values: Array, bounds: Sequence[Sequence[tuple[float, float]]]) -> Array:
    limits = np.array([limit for own in bounds for limit in own])
    return np.clip(values, limits[:, 0], limits[:, 1])


def _split(values: Array, counts: Sequence[int]) -> list[Array]:
    return list(np.split(values, np.cumsum(counts)[:-1]))

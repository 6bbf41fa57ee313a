"""One explanation of a residual: what it claims, and how the numbers answer to its size."""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from rigdesign.diagnosis.statistics.columns import Array


@dataclass(frozen=True, kw_only=True)
class Curve:
    """Answer of the numbers to one size, from runs of the model.

    coordinates : (m,) sorted, zero among them; answers : (m, n) change of the features, whitened
    """

    coordinates: Array
    answers: Array
    bounds: tuple[float, float]

    @classmethod
    def of(
        cls, coordinates: Array, answers: Array, bounds: tuple[float, float] = (-np.inf, np.inf)
    ) -> "Curve":
        """From runs in any order, (m,) and (m, n); it ends where its bounds or its runs end."""
        order = np.argsort(coordinates)
        ends = float(coordinates[order[0]]), float(coordinates[order[-1]])
        return cls(
            coordinates=coordinates[order],
            answers=answers[order],
            bounds=(max(bounds[0], ends[0]), min(bounds[1], ends[1])),
        )

    @property
    def half(self) -> float:
        """The wider side of the bounds."""
        return max(abs(self.bounds[0]), abs(self.bounds[1]))

    def at(self, coordinates: Array) -> Array:
        """(k, n) answers between the runs."""
        return np.asarray(self.shares(coordinates) @ self.answers)

    def sensitivity(self, coordinate: float) -> Array:
        """(n,) derivative by the coordinate."""
        return np.asarray(self.slope_shares(coordinate) @ self.answers)

    def shares(self, coordinates: Array) -> Array:
        """(k, m) share of every run in the answers between them: a spline is linear in what it passes through."""
        return np.asarray(_interpolation(tuple(self.coordinates.tolist()))(coordinates))

    def slope_shares(self, coordinate: float) -> Array:
        """(m,) the same of the derivative."""
        step = 1e-3 * self.half
        low, high = max(coordinate - step, self.bounds[0]), min(coordinate + step, self.bounds[1])
        before, after = self.shares(np.array([low, high]))
        return np.asarray((after - before) / (high - low))


@lru_cache(maxsize=256)
def _interpolation(coordinates: tuple[float, ...]) -> CubicSpline | PPoly:
    """Coordinate (k,) -> (k, m) shares of the runs: a cubic spline, a straight line between two."""
    if len(coordinates) > 2:
        return CubicSpline(coordinates, np.eye(len(coordinates)))
    low, high = coordinates
    slopes = np.array([-1.0, 1.0]) / (high - low)
    return PPoly(np.array([slopes, [1.0, 0.0]])[:, None, :], np.array([low, high]))


@dataclass(frozen=True, kw_only=True)
class Hypothesis:
    """One explanation of the residual.

    Either a curve (one size), or whitened columns (n, k) with equal spread and a half bound each; `residual`
    replaces it for swaps and wrong units.
    """

    name: str
    family: str
    parts: tuple[str, ...]
    """What it claims, effects by the name of their entry; unmodelled and input parts included."""
    curve: Curve | None = None
    columns: Array | None = None
    half: float = 1.0
    own: tuple[str, ...] = ()
    """Effects whose own spread is released."""
    residual: Array | None = field(default=None, repr=False)
    """Whitened residual under the hypothesis, where the data themselves are wrong."""
    unit: float = 1.0
    """Whitened length that a coordinate of one stands for, of columns that are brought to a length of one."""
    limits: tuple[Array, Array] | None = None
    """Least and largest coordinates (k,), where columns have different ones."""

    def at(self, size: Array) -> Array:
        """(n,) whitened answer at a size (k,), of a curve at most at its ends."""
        if self.curve is not None:
            return np.asarray(self.curve.at(np.clip(size, *self.curve.bounds))[0])
        assert self.columns is not None
        return np.asarray(self.columns @ size)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Least and largest coordinates (k,)."""
        if self.limits is not None:
            return self.limits
        if self.curve is not None:
            return np.array([self.curve.bounds[0]]), np.array([self.curve.bounds[1]])
        bound = np.full(0 if self.columns is None else self.columns.shape[1], self.half)
        return -bound, bound

    @property
    def intervals(self) -> list[tuple[float, float]]:
        """The same, of one coordinate after the other."""
        return [(float(low), float(high)) for low, high in zip(*self.bounds, strict=True)]

    @property
    def widest(self) -> float:
        """The wider side of the bounds of its size."""
        return self.half if self.curve is None else self.curve.half

"""Evidence of one hypothesis after the other: how much better each explains the residual than nothing does.

    ln B = ln p(residual | effect) - ln p(residual | healthy),  sizes integrated over a prior from the bounds

The prior of a size is a mixture of normals around neutral with spreads from the bound down to a five-hundredth of
it, so that a small effect is not punished for the width of its bound. The tails of the normals end nowhere, and so an
explanation has at most the evidence of the best size within its bounds. What the covariance lets the same thing
spread by itself is taken out while its effect is tested (`covariance.Release`).

Source: design of the workflow, step 6; the integrals are those of Bayesian model comparison (Kass, Raftery,
J. Am. Stat. Assoc. 90, 1995, 773).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline, PPoly
from scipy.optimize import lsq_linear

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Release, Whitened

# One explanation of a residual: what it claims, and how the numbers answer to its size.


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

    Either a curve (one size), or whitened columns (n, k) with equal spread and a half bound each, else none; `residual`
    replaces it for swaps and wrong units.
    """

    name: str
    family: str
    parts: tuple[str, ...]
    """What it claims, effects by the name of their entry; unmodelled and input parts included."""
    curve: Curve | None = None
    columns: Array = field(default_factory=lambda: np.zeros((0, 0)))
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
        return np.asarray(self.columns @ size)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Least and largest coordinates (k,)."""
        if self.limits is not None:
            return self.limits
        if self.curve is not None:
            return np.array([self.curve.bounds[0]]), np.array([self.curve.bounds[1]])
        bound = np.full(self.columns.shape[1], self.half)
        return -bound, bound

    @property
    def intervals(self) -> list[tuple[float, float]]:
        """The same, of one coordinate after the other."""
        return [(float(low), float(high)) for low, high in zip(*self.bounds, strict=True)]

    @property
    def widest(self) -> float:
        """The wider side of the bounds of its size."""
        return self.half if self.curve is None else self.curve.half


SPREADS = (0.6, 0.2, 0.06, 0.02, 0.006, 0.002)
"""Standard deviations of the mixture, relative to the bound."""

_PAIRS_OF_SPREADS = np.array([(one, other) for one in SPREADS for other in SPREADS])

GRID = 121
"""Points of the quadrature over one size, denser towards neutral."""


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """What a hypothesis is worth.

    log_bayes : against no effect; coordinates : at the best fit; deviations : of the coordinates there (with a flat
    prior); gain : fall of the whitened square against a healthy rig;
    column : (n, k) whitened slope there
    """

    hypothesis: Hypothesis
    log_bayes: float
    coordinates: tuple[float, ...]
    deviations: tuple[float, ...]
    gain: float
    columns: Array = field(repr=False)
    answer: Array = field(repr=False)
    """(n,) whitened answer at the best fit."""
    spreads: Array = field(repr=False, default_factory=lambda: np.zeros((0, 0)))
    """(m, k) standard deviations of the mixture of normals its sizes are integrated over."""
    joined: int = 0
    """Where two explanations are joined: columns of the first."""

    @property
    def members(self) -> tuple[tuple[str, tuple[float, ...]], ...]:
        """Explanations that it joins, each with its coordinates."""
        names = self.hypothesis.name.split(JOIN)
        if len(names) == 1:
            return ((names[0], self.coordinates),)
        return (names[0], self.coordinates[: self.joined]), (names[1], self.coordinates[self.joined :])

    def share_of(self, part: str) -> Array:
        """(n,) what one of its parts adds to the answer."""
        if not self.joined:
            return self.answer
        second = self.columns[:, self.joined :] @ np.array(self.coordinates[self.joined :])
        return np.asarray(second if part == self.hypothesis.parts[-1] else self.answer - second)


def release_of(space: Whitened, effects: Sequence[str]) -> Release:
    """The space without the spreads of these effects."""
    places = sorted({place for effect in effects for place in space.covariance.own(effect)})
    return Release.of(space.columns[:, places])


def evaluate_hypothesis(space: Whitened, hypothesis: Hypothesis) -> Evidence:
    """Evidence of one hypothesis."""
    if hypothesis.residual is not None:
        return _weigh_data(space, hypothesis, hypothesis.residual)
    if hypothesis.curve is not None:
        return _weigh_curve(space, hypothesis, hypothesis.curve)
    return _weigh_columns(space, hypothesis, hypothesis.columns)


def mixture_density(coordinates: Array, half: float) -> Array:
    """(k,) logarithm of the prior density of a size, not cut at its bounds."""
    spreads = np.array(SPREADS) * half
    terms = -0.5 * (coordinates[:, None] / spreads) ** 2 - np.log(spreads * np.sqrt(2.0 * np.pi))
    return np.asarray(_log_sum(terms.T) - np.log(len(SPREADS)))


def graded(bounds: tuple[float, float], count: int = GRID) -> tuple[Array, Array]:
    """Coordinates (k,) between bounds, dense around zero, with their quadrature weights (k,)."""
    half = max(abs(bounds[0]), abs(bounds[1]))
    least = SPREADS[-1] * half / 4.0
    ends = [np.arcsinh(bound / least) for bound in bounds]
    nodes = np.linspace(float(ends[0]), float(ends[1]), count)
    step = (ends[1] - ends[0]) / (count - 1)
    weights = least * np.cosh(nodes) * step
    weights[[0, -1]] *= 0.5
    return least * np.sinh(nodes), weights


def _weigh_data(space: Whitened, hypothesis: Hypothesis, residual: Array) -> Evidence:
    """Data that are wrong as they stand: another residual under the same covariance."""
    gain = space.chi_square - float(residual @ residual)
    nothing = np.zeros((len(space.residual), 0))
    return Evidence(
        hypothesis=hypothesis,
        log_bayes=0.5 * gain,
        coordinates=(),
        deviations=(),
        gain=gain,
        columns=nothing,
        answer=space.residual - residual,
    )


def _weigh_curve(space: Whitened, hypothesis: Hypothesis, curve: Curve) -> Evidence:
    release = release_of(space, hypothesis.own)
    grid, weights = graded(curve.bounds)
    residual = space.freed(hypothesis.own)
    fit = _CurveFit.of(release, curve, residual)
    squares = fit.squares(grid)
    logs = -0.5 * (squares - space.chi_square) - 0.5 * release.log_determinant
    prior = mixture_density(grid, curve.half)
    prior = prior - _log_sum(prior + np.log(weights))
    log_bayes = float(_log_sum(logs + prior + np.log(weights)))
    best = fit.refined(float(grid[int(np.argmin(squares))]))
    stiffness = fit.stiffness(best)
    return Evidence(
        hypothesis=hypothesis,
        log_bayes=log_bayes,
        coordinates=(best,),
        deviations=(stiffness**-0.5 if stiffness > 0.0 else float("inf"),),
        gain=space.chi_square - float(fit.squares(np.array([best]))[0]),
        columns=curve.sensitivity(best)[:, None],
        answer=curve.at(np.array([best]))[0],
        spreads=np.array(SPREADS)[:, None] * curve.half,
    )


@dataclass(frozen=True, kw_only=True)
class _CurveFit:
    """Fit of a curve by the products of its runs alone, (m, m) and (m,): no pass over the numbers a size.

    gram : of the runs; load : of the runs with the residual; square : of the residual
    """

    curve: Curve
    gram: Array
    load: Array
    square: float

    @classmethod
    def of(cls, release: Release, curve: Curve, residual: Array) -> "_CurveFit":
        runs = curve.answers.T
        return cls(
            curve=curve,
            gram=release.product(runs, runs),
            load=release.product(runs, residual),
            square=float(release.product(residual, residual)),
        )

    def squares(self, sizes: Array) -> Array:
        """(k,) whitened squares of what sizes leave."""
        shares = self.curve.shares(sizes)
        return np.asarray(
            self.square - 2.0 * (shares @ self.load) + np.einsum("km,km->k", shares @ self.gram, shares)
        )

    def stiffness(self, size: float) -> float:
        """Square of the slope."""
        slope = self.curve.slope_shares(size)
        return float(slope @ self.gram @ slope)

    def refined(self, start: float) -> float:
        """Best size by Gauss-Newton steps on the curve, kept within its bounds."""
        size = start
        for _ in range(20):
            slope = self.curve.slope_shares(size)
            stiffness = float(slope @ self.gram @ slope)
            if stiffness <= 0.0:
                break
            left = float(slope @ (self.load - self.gram @ self.curve.shares(np.array([size]))[0]))
            after = float(np.clip(size + left / stiffness, *self.curve.bounds))
            if abs(after - size) <= 1e-6 * self.curve.half:
                return after
            size = after
        return size


def _weigh_columns(space: Whitened, hypothesis: Hypothesis, columns: Array) -> Evidence:
    release = release_of(space, hypothesis.own)
    gram = np.atleast_2d(release.product(columns, columns))
    residual = space.freed(hypothesis.own)
    load = np.atleast_1d(release.product(columns, residual))
    spreads = np.outer(np.array(SPREADS) * hypothesis.half, np.ones(len(load)))
    before = float(release.product(residual, residual))
    shift = 0.5 * (space.chi_square - before)
    inverse = inverse_of(gram)
    best = best_within(gram, load, inverse @ load, hypothesis.bounds)
    gain = space.chi_square - before + float(2.0 * best @ load - best @ gram @ best)
    return Evidence(
        hypothesis=hypothesis,
        log_bayes=min(mixed(gram, load, spreads) + shift, 0.5 * gain) - 0.5 * release.log_determinant,
        coordinates=tuple(float(value) for value in best),
        deviations=deviations_of(inverse),
        gain=gain,
        columns=columns,
        answer=columns @ best,
        spreads=spreads,
    )


def mixed(gram: Array, load: Array, spreads: Array) -> float:
    """Mean over (m, k) spreads S of ln B of columns with normal sizes,

    ln B = .5 b'(G + S^-2)^-1 b - .5 ln|I + S G S|.
    """
    system = np.eye(len(load)) + spreads[:, :, None] * gram * spreads[:, None, :]
    half_load = spreads * load
    _, logarithm = np.linalg.slogdet(system)
    solved = np.linalg.solve(system, half_load[:, :, None])[:, :, 0]
    logs = 0.5 * np.einsum("mk,mk->m", half_load, solved) - 0.5 * logarithm
    return float(_log_sum(logs) - np.log(len(logs)))


def _log_sum(logs: Array) -> Array:
    """Logarithm of the sum of exponentials over the first axis."""
    most = logs.max(axis=0)
    return np.asarray(most + np.log(np.exp(logs - most).sum(axis=0)))


ALIKE = 1e-10
"""Share of the mean square below which a direction of columns of equal length is rounding."""


def inverse_of(gram: Array) -> Array:
    """Of a symmetric matrix (k, k), whatever the units of its columns; zero along directions it does not see."""
    lengths = np.sqrt(np.diagonal(gram))
    scale = np.divide(1.0, lengths, out=np.zeros_like(lengths), where=lengths > 0.0)
    values, vectors = np.linalg.eigh(scale[:, None] * gram * scale)
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=values > ALIKE)
    return np.asarray(scale[:, None] * ((vectors * inverse) @ vectors.T) * scale)


ROUNDS = 50
"""Of the search for the sizes that end at a bound; there are four at most."""


def best_within(gram: Array, load: Array, free: Array, bounds: tuple[Array, Array]) -> Array:
    """Sizes (k,) of the least square within their bounds; ``free``: those without any.

    Where one of them ends at its bound the others make up for it.
    """
    if np.all((free >= bounds[0]) & (free <= bounds[1])):
        return free
    values, vectors = np.linalg.eigh(gram)
    seen = values > ALIKE * max(float(values[-1]), 0.0)
    root = np.sqrt(values[seen])
    columns, target = root[:, None] * vectors[:, seen].T, vectors[:, seen].T @ load / root
    low, high = bounds
    high = np.maximum(high, np.nextafter(low, np.inf))  # a size without room stays
    return np.asarray(lsq_linear(columns, target, (low, high), method="bvls", max_iter=ROUNDS).x)


def deviations_of(inverse: Array) -> tuple[float, ...]:
    """Standard deviations of coordinates from their covariance (k, k)."""
    return tuple(float(value) for value in np.sqrt(np.maximum(np.diagonal(inverse), 0.0)))


JOIN = " + "
"""Between the names of two explanations in that of their pair."""


def evaluate_pair(space: Whitened, first: Evidence, second: Evidence) -> Evidence:
    """Two explanations at once, in closed form around the best fit of the first.

    The first is taken at its own best size with the slope there; of the second the slope at its best size. The
    spreads of both are integrated over the same mixtures as alone.
    """
    name = f"{first.hypothesis.name}{JOIN}{second.hypothesis.name}"
    effects = (*first.hypothesis.own, *second.hypothesis.own)
    release = release_of(space, effects)
    base = first.answer - first.columns @ np.array(first.coordinates)
    columns = np.hstack([first.columns, second.columns])
    left = space.freed(effects) - base
    gram = release.product(columns, columns)
    load = release.product(columns, left)
    owner = np.repeat([0, 1], [first.columns.shape[1], second.columns.shape[1]])
    halves = np.array([first.hypothesis.widest, second.hypothesis.widest])
    shift = 0.5 * (space.chi_square - float(release.product(left, left)))
    spreads = (_PAIRS_OF_SPREADS * halves)[:, owner]
    limits = (
        np.concatenate([explanation.hypothesis.bounds[0] for explanation in (first, second)]),
        np.concatenate([explanation.hypothesis.bounds[1] for explanation in (first, second)]),
    )
    inverse = inverse_of(gram)
    best = best_within(gram, load, inverse @ load, limits)
    after = left - columns @ best
    gain = space.chi_square - float(release.product(after, after))
    hypothesis = Hypothesis(
        name=name,
        family="pair",
        parts=(*first.hypothesis.parts, *second.hypothesis.parts),
        columns=columns,
        own=effects,
        limits=limits,
    )
    return Evidence(
        hypothesis=hypothesis,
        log_bayes=min(mixed(gram, load, spreads) + shift, 0.5 * gain) - 0.5 * release.log_determinant,
        coordinates=tuple(float(value) for value in best),
        deviations=deviations_of(inverse),
        gain=gain,
        columns=columns,
        answer=base + columns @ best,
        spreads=spreads,
        joined=first.columns.shape[1],
    )


# On how many operating points an explanation rests: what is left of it without the one that speaks for it most.
#
# A resonance that moved by a per cent changes one point by more than any noise; what a rig has changed shows at
# several.


def support(space: Whitened, points: Sequence[str], explanation: Evidence, part: str) -> tuple[float, str]:
    """Least fall of the whitened square by one part of an explanation when a single operating point is left out.

    points : (n,) operating point of each number, empty at rest; numbers at rest always stay

    Returns the fall and the point without which it is so small, empty where there is none. Of a Gaussian with
    precision P the numbers of a point are left out by x'Py - (Px)_p' P_pp^-1 (Py)_p.
    """
    lower = space.covariance.lower
    precision = _released(space, explanation.hypothesis.own)
    answer = lower @ explanation.share_of(part)
    left = lower @ (space.freed(explanation.hypothesis.own) - explanation.answer) + answer
    seen, change = precision @ (left - 0.5 * answer), precision @ answer
    whole = 2.0 * float(answer @ seen)
    least, where = whole, ""
    for point in sorted(set(points) - {""}):
        rows = np.array([row for row, name in enumerate(points) if name == point])
        block = precision[np.ix_(rows, rows)]
        fall = whole - 2.0 * float(change[rows] @ np.linalg.solve(block, seen[rows]))
        if fall < least:
            least, where = fall, point
    return least, where


def _released(space: Whitened, effects: Sequence[str]) -> Array:
    """(n, n) precision without the spreads of these effects."""
    release = release_of(space, effects)
    if not release.directions.shape[1]:
        return space.precision
    reached = np.linalg.solve(space.covariance.lower.T, release.directions)
    return np.asarray(space.precision + reached @ release.weights @ reached.T)


# How large an effect is, with an interval that admits what the model may answer wrongly.

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
    explanations: Sequence[Evidence],
    widths: Mapping[str, float],
    bounds: Sequence[Sequence[tuple[float, float]]],
) -> JointFit:
    """Gauss-Newton on the curves of all named effects, kept within bounds, and their intervals.

    widths : family of an effect -> relative error of the model's answer to it, by which intervals become wider
    bounds : of every coordinate of every effect
    """
    effects = [effect for explanation in explanations for effect in explanation.hypothesis.own]
    release, residual = release_of(space, effects), space.freed(effects)
    coordinates = [np.array(explanation.coordinates) for explanation in explanations]
    for _ in range(20):
        slopes = [
            _slope(explanation, size) for explanation, size in zip(explanations, coordinates, strict=True)
        ]
        columns = np.hstack(slopes)
        left = residual - sum(
            (_answer(explanation, size) for explanation, size in zip(explanations, coordinates, strict=True)),
            np.zeros(len(columns)),
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
    for explanation, size, limits in zip(explanations, coordinates, bounds, strict=True):
        kind = explanation.hypothesis.parts[0].split(":")[0]
        width = widths.get(kind, widths.get("", 0.25))
        below, above = _misanswered(explanation, size, NORMAL_95 * width)
        for place, value in enumerate(size):
            low, high = limits[place]
            first = float(value - np.hypot(NORMAL_95 * deviations[number], below))
            last = float(value + np.hypot(NORMAL_95 * deviations[number], above))
            sizes.append(
                Size(
                    effect=explanation.hypothesis.name,
                    number=place,
                    coordinate=float(value),
                    interval=(max(first, low), min(last, high)),
                    at_bound=first <= low or last >= high,
                )
            )
            number += 1
    answer = sum(
        (_answer(explanation, size) for explanation, size in zip(explanations, coordinates, strict=True)),
        np.zeros(len(space.residual)),
    )
    return JointFit(
        sizes=tuple(sizes),
        coordinates=tuple(tuple(float(value) for value in size) for size in coordinates),
        answer=np.asarray(answer),
    )


def _misanswered(explanation: Evidence, size: Array, share: float) -> tuple[float, float]:
    """How far below and above a coordinate the answer is smaller or larger by a share of itself.

    A proportional answer is off by that share of the size; where the answer saturates a size is known much worse.
    """
    curve = explanation.hypothesis.curve
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


def _slope(explanation: Evidence, size: Array) -> Array:
    curve = explanation.hypothesis.curve
    return explanation.columns if curve is None else curve.sensitivity(float(size[0]))[:, None]


def _answer(explanation: Evidence, size: Array) -> Array:
    curve = explanation.hypothesis.curve
    return np.asarray(explanation.columns @ size) if curve is None else curve.at(size)[0]


def _clipped(values: Array, bounds: Sequence[Sequence[tuple[float, float]]]) -> Array:
    limits = np.array([limit for pairs in bounds for limit in pairs])
    return np.clip(values, limits[:, 0], limits[:, 1])


def _split(values: Array, counts: Sequence[int]) -> list[Array]:
    return list(np.split(values, np.cumsum(counts)[:-1]))

"""What these sensors and points can see and tell apart, before any name is looked for."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import Hypothesis, release_of

SEEN = 3.3
"""Standard deviations at which a size is distinguished from nothing with 5 % error on both sides (1.645 + 1.645)."""

SEPARATED = 4.3
"""Standard deviations at which it is distinguished from its nearest rival as well."""

ALIAS = 0.95
"""Correlation above which two effects look alike to these sensors."""

REACHES = 0.5
"""Share of the trace of an effect that another one must leave within its bounds to stand for it."""

Verdict = Literal["testable", "visible only", "not testable here"]


@dataclass(frozen=True, kw_only=True)
class Detectability:
    """One effect in the eyes of these sensors; sizes in the coordinate of its parameter.

    detectable : smallest size that is seen; isolable : smallest that can be named; rival : nearest explanation
    """

    effect: str
    detectable: float
    isolable: float
    bound: float
    rival: str
    correlation: float

    @property
    def verdict(self) -> Verdict:
        """Against the physical bound."""
        if self.isolable <= self.bound:
            return "testable"
        return "visible only" if self.detectable <= self.bound else "not testable here"


def slope_of(hypothesis: Hypothesis) -> Array:
    """(n, k) whitened columns of a hypothesis at its smallest size."""
    if hypothesis.curve is not None:
        return hypothesis.curve.sensitivity(0.0)[:, None]
    return hypothesis.columns


def detectabilities(
    space: Whitened, effects: Sequence[Hypothesis], rivals: Sequence[Hypothesis]
) -> tuple[Detectability, ...]:
    """The table of all effects against all rivals, unmodelled causes included.

    Nonlinear effects are evaluated by their sensitivity at the detectable size, found by one repetition.
    """
    seen = [_seen(space, effect) for effect in effects]
    rows = []
    nearest = _nearest(effects, [column for _, column in seen], (*effects, *rivals))
    for effect, (size, _), (rival, correlation) in zip(effects, seen, nearest, strict=True):
        half = effect.widest
        separated = SEPARATED / SEEN * size / max(np.sqrt(max(1.0 - correlation**2, 0.0)), 1e-9)
        rows.append(
            Detectability(
                effect=effect.name,
                detectable=size,
                isolable=float(separated),
                bound=half,
                rival=rival,
                correlation=correlation,
            )
        )
    return tuple(rows)


def _seen(space: Whitened, effect: Hypothesis) -> tuple[float, Array]:
    """Smallest size of an effect that is seen, and its columns (n, k) there."""
    release = release_of(space, effect.own)
    column = slope_of(effect)
    size = _detectable(release.product(column, column))
    if effect.curve is not None and np.isfinite(size):
        reached = float(np.clip(size, *effect.curve.bounds))
        if reached > 0.0:
            column = effect.curve.at(np.array([reached]))[0][:, None] / reached
            size = _detectable(release.product(column, column))
    return size, column


def _detectable(gram: Array) -> float:
    """Size seen in its least visible phase."""
    least = float(np.linalg.eigvalsh(np.atleast_2d(gram))[0])
    return SEEN / least**0.5 if least > 0.0 else float("inf")


def _nearest(
    effects: Sequence[Hypothesis], columns: Sequence[Array], everything: Sequence[Hypothesis]
) -> list[tuple[str, float]]:
    """For the columns of each effect the explanation most like them that claims something else."""
    if not effects:
        return []
    alike = _alike(_bases(columns), _bases([slope_of(hypothesis) for hypothesis in everything]))
    number: dict[tuple[str, ...], int] = {}
    claims = np.array([number.setdefault(hypothesis.parts, len(number)) for hypothesis in everything])
    nearest = []
    for effect, row in zip(effects, alike, strict=True):
        others = np.where(claims == number.get(effect.parts, -1), -1.0, row)
        best = int(np.argmax(others))
        nearest.append((everything[best].name, max(float(others[best]), 0.0)))
    return nearest


def _bases(columns: Sequence[Array]) -> Array:
    """(n, 2 m) orthonormal bases of what each (n, 1 or 2) columns span; zeros for a second that is not there."""
    bases = np.zeros((len(columns[0]) if columns else 0, 2 * len(columns)))
    for place, span in enumerate(columns):
        if span.shape[1] == 1:
            bases[:, 2 * place] = span[:, 0] / max(float(np.linalg.norm(span)), 1e-300)
        else:
            bases[:, 2 * place : 2 * place + 2] = np.linalg.qr(span)[0]
    return bases


def _alike(bases: Array, others: Array) -> Array:
    """(m, k) largest cosine between each of m and each of k bases: of two planes that of the nearest directions."""
    cosines = (bases.T @ others).reshape(bases.shape[1] // 2, 2, others.shape[1] // 2, 2)
    a, b, c, d = (cosines[:, i, :, j] for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)))
    first, second, mixed = a**2 + b**2, c**2 + d**2, a * c + b * d
    squares = 0.5 * (first + second) + np.hypot(0.5 * (first - second), mixed)
    return np.asarray(np.sqrt(np.clip(squares, 0.0, 1.0)))


def aliases(space: Whitened, effects: Sequence[Hypothesis]) -> list[tuple[str, str, float]]:
    """Pairs of effects these sensors cannot tell apart, with their correlation, those most alike first.

    Pairs that are alike to rounding stand in the order of the effects.
    """
    bases = _bases([slope_of(effect) for effect in effects])
    alike = np.triu(_alike(bases, bases), 1)
    pairs = [
        (effects[first].name, effects[second].name, float(alike[first, second]))
        for first, second in np.argwhere(alike > ALIAS)
    ]
    return sorted(pairs, key=lambda pair: -round(pair[2], 9))


# How large a cause would have to be to explain a residual by itself, whatever its bounds say.

MOST = 1e3
"""Size over its bound beyond which a cause does not answer at all to what is to be explained."""
ALIKE = 0.01
"""Share of the square within which two sizes meet the data alike; the smaller one counts."""


@dataclass(frozen=True, kw_only=True)
class RequiredSize:
    """A cause at the size at which it meets the data best.

    coordinates : (k,); share : of the square of the residual that it takes away [-]; reach : its size over its bound
    extrapolated : beyond the runs of the model, continued in proportion
    """

    coordinates: tuple[float, ...]
    share: float
    reach: float
    extrapolated: bool = False


class ResidualMetric:
    """Residual (n,) in the metric of what is no cause: noise, and the systematic errors of sensors and settings.

    covariance : (n, n)
    """

    def __init__(self, residual: Array, covariance: Array) -> None:
        self._factor = cho_factor(covariance, lower=True)
        self._residual = residual
        self._white = cho_solve(self._factor, residual)
        self.square = float(residual @ self._white)
        """Weighted square of the residual; n where nothing is to be explained."""

    def of_columns(self, columns: Array, bound: float) -> RequiredSize | None:
        """Of a cause that answers in proportion, columns (n, k); None where it does not answer."""
        normal = columns.T @ cho_solve(self._factor, columns)
        largest = float(np.max(np.diagonal(normal), initial=0.0))
        if not largest * (MOST * bound) ** 2 > 1.0:
            return None
        right = columns.T @ self._white
        sizes = np.asarray(np.linalg.lstsq(normal, right, rcond=1e-9)[0], dtype=np.float64)
        return self._sized(sizes, float(right @ sizes), bound, extrapolated=False)

    def of_runs(self, coordinates: Array, answers: Array, bound: float) -> RequiredSize | None:
        """Of a cause with runs at coordinates (m,), zero among them, answers (m, n); straight between and beyond.

        The smallest size of those that meet the data best is taken.
        """
        order = np.argsort(coordinates)
        places, runs = coordinates[order], answers[order]
        candidates: list[RequiredSize] = []
        for k in range(len(places) - 1):
            low, high = places[k], places[k + 1]
            slope = (runs[k + 1] - runs[k]) / (high - low)
            metric = float(slope @ cho_solve(self._factor, slope))
            if not metric * (MOST * bound) ** 2 > 1.0:
                continue
            left = self._residual - runs[k]
            size = float(low + slope @ cho_solve(self._factor, left) / metric)
            size = max(size, low) if k > 0 else size
            size = min(size, high) if k < len(places) - 2 else size
            rest = left - slope * (size - low)
            taken = self.square - float(rest @ cho_solve(self._factor, rest))
            beyond = not places[0] <= size <= places[-1]
            candidate = self._sized(np.array([size]), taken, bound, extrapolated=beyond)
            candidates.append(candidate)
        most = max((required.share for required in candidates), default=0.0)
        best = [required for required in candidates if required.share > most - ALIKE]
        return min(best, key=lambda required: required.reach, default=None)

    def _sized(self, sizes: Array, taken: float, bound: float, *, extrapolated: bool) -> RequiredSize:
        return RequiredSize(
            coordinates=tuple(float(size) for size in sizes),
            share=taken / self.square if self.square else 0.0,
            reach=float(np.linalg.norm(sizes)) / bound,
            extrapolated=extrapolated,
        )


def straight(coordinates: Array, answers: Array, size: float) -> Array:
    """(n,) answer of runs at coordinates (m,), answers (m, n), at a size: straight between them and beyond."""
    order = np.argsort(coordinates)
    places, runs = coordinates[order], answers[order]
    segment = int(np.clip(np.searchsorted(places, size) - 1, 0, len(places) - 2))
    share = (size - places[segment]) / (places[segment + 1] - places[segment])
    return np.asarray((1.0 - share) * runs[segment] + share * runs[segment + 1])

"""Inflation of the covariance: how far healthy sets go along single causes beyond what the columns of constants span.

One spread for each likeness of causes; what two models disagree on beyond constants is known by it, and a name has to
be worth more.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from rigdesign.diagnosis.residual.baseline import Drift, differenced
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened

INFLATE_ABOVE = 1.3
"""Mean square of healthy sets along a direction [variances] above which the covariance is inflated there."""

LARGEST = 25.0
"""The same of the single healthy set that goes furthest along it: rigs differ by more than their mean says, in the
teeth above all, and a name is wrong once in any of them."""

WIDEST = 60
"""Times that a likeness is inflated at most, one at a time."""

ENOUGH = 0.01
"""Share by which a square may stay too large."""

UNSEEN = 2.0
"""Whitened length of a direction at its reach below which it can explain too little to be named, and healthy sets say
nothing of it."""


def inflate(problems: Iterable[ResidualProblem], amplitudes: Amplitudes) -> dict[str, float]:
    """Spread [coordinate] that healthy sets show along causes beyond the columns, by `Direction.likeness`.

    z = a'r / |a| in the white space of a healthy rig has a mean square of one where the covariance is right. The
    cause with the largest is inflated until its mean is `INFLATE_ABOVE` and no set above `LARGEST`, then the next: one
    direction two models disagree on shows in many causes and is mended once.
    """
    return _inflated([_Seen.of(residuals, plain(residuals, amplitudes)) for residuals in problems])


def inflate_drift(
    pairs: Iterable[tuple[ResidualProblem, ResidualProblem]], amplitudes: Amplitudes, drift: Drift
) -> Drift:
    """The drift with the spread that healthy pairs show along an effect from set to set; found as in `inflate`."""
    still = replace(drift, inflation={})
    seen = [
        _Seen.of(residuals, differenced(residuals, baseline, amplitudes, still))
        for residuals, baseline in pairs
    ]
    return replace(drift, inflation=_inflated(seen))


def _inflated(seen: Sequence["_Seen"]) -> dict[str, float]:
    found: dict[str, float] = {}
    for _ in range(WIDEST):
        squares: dict[str, list[Array]] = {}
        for one in seen:
            for likeness, own in one.squares().items():
                squares.setdefault(likeness, []).append(own)
        excess = {likeness: _excess(np.concatenate(own)) for likeness, own in squares.items()}
        worst = max(excess, key=lambda likeness: excess[likeness], default="")
        if not worst or excess[worst] <= 1.0 + ENOUGH:
            break
        more = _missing([one.along(worst) for one in seen if worst in one.likeness])
        seen = [one.inflated(worst, more) for one in seen]
        found[worst] = float(np.hypot(found.get(worst, 0.0), more))
    return found


def _excess(squares: Array) -> float:
    """By how much squares (k,) of healthy residuals along directions are too large."""
    return max(float(np.mean(squares)) / INFLATE_ABOVE, float(np.max(squares)) / LARGEST)


def _missing(along: Sequence["_Along"]) -> float:
    """Spread of a likeness at which its squares are no longer too large."""
    lengths = np.sqrt(np.concatenate([np.diagonal(one.gram)[one.visible] for one in along]))

    def excess(logarithm: float) -> float:
        spread = float(np.exp(logarithm))
        return _excess(np.concatenate([one.squares(spread) for one in along])) - 1.0

    low, high = np.log([1e-3 / lengths.max(), 1e3 / lengths.min()])
    return float(np.exp(brentq(excess, float(low), float(high), xtol=1e-4)))


@dataclass(frozen=True, kw_only=True)
class _Along:
    """What one set says along the directions of one likeness: products (k, k), with the residual (k,); which count."""

    gram: Array
    load: Array
    visible: NDArray[np.bool_]

    @cached_property
    def axes(self) -> tuple[Array, Array]:
        """Squared lengths (k,) and directions (k, k) of the principal axes."""
        values, vectors = np.linalg.eigh(self.gram)
        return np.maximum(values, 0.0), vectors

    def squares(self, spread: float) -> Array:
        """Of the residual along those that count, with all of them inflated by a spread."""
        values, vectors = self.axes
        left = 1.0 / (1.0 + spread**2 * values)
        own = vectors[self.visible]
        return np.asarray(
            (own @ (left * (vectors.T @ self.load))) ** 2 / np.maximum(own**2 @ (values * left), 1e-30)
        )


@dataclass(frozen=True, kw_only=True)
class _Seen:
    """What one healthy set says: products of its whitened directions (k, k) and with the residual (k,).

    likeness : (k,) of each direction; visible : (k,) whether it can be seen
    """

    gram: Array
    load: Array
    likeness: NDArray[np.str_]
    visible: NDArray[np.bool_]

    @classmethod
    def of(cls, residuals: ResidualProblem, space: Whitened) -> "_Seen":
        """Of a set in the white space of a healthy rig."""
        found = list(residuals.directions())
        white = space.covariance.whiten(np.hstack([one.values for one in found]))
        counts = [one.values.shape[1] for one in found]
        lengths = np.linalg.norm(white, axis=0)
        return cls(
            gram=white.T @ white,
            load=white.T @ space.residual,
            likeness=np.repeat([one.likeness for one in found], counts),
            visible=lengths * np.repeat([one.reach for one in found], counts) > UNSEEN,
        )

    def squares(self) -> dict[str, Array]:
        """Likeness -> squares of the residual along its directions that are seen."""
        squares = self.load**2 / np.maximum(np.diagonal(self.gram), 1e-30)
        return {
            likeness: squares[own]
            for likeness in dict.fromkeys(self.likeness.tolist())
            if (own := self.visible & (self.likeness == likeness)).any()
        }

    def along(self, likeness: str) -> _Along:
        """The part of one likeness."""
        own = np.flatnonzero(self.likeness == likeness)
        return _Along(gram=self.gram[np.ix_(own, own)], load=self.load[own], visible=self.visible[own])

    def inflated(self, likeness: str, spread: float) -> "_Seen":
        """The same with the covariance wider along a likeness."""
        own = np.flatnonzero(self.likeness == likeness)
        if not len(own):
            return self
        across = spread * self.gram[:, own]
        inner = np.eye(len(own)) + spread * across[own]
        taken = np.linalg.solve(inner, np.column_stack([across.T, spread * self.load[own]]))
        return replace(self, gram=self.gram - across @ taken[:, :-1], load=self.load - across @ taken[:, -1])

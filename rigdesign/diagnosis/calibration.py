"""Amplitudes of a healthy rig's covariance from healthy sets, by marginal likelihood.

The covariance is a sum over kinds of cause, C = N + sum_k a_k^2 S_k; of many healthy sets of one plan and one set of
sensors only the sum of r r' counts. The amplitudes maximise the likelihood of all groups together, held by a wide
prior around their starting values.

Source: type II maximum likelihood, Rasmussen and Williams 2006, ch. 5.4; the gradient is eq. (5.9).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.optimize import brentq, minimize

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.baseline import Change, Drift, differenced
from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.covariance import Whitened
from rigdesign.diagnosis.healthy import own_spread
from rigdesign.diagnosis.subject import Comparison, plain

PRIOR = 1.5
"""Standard deviation of the logarithm of an amplitude around its starting value."""

HANDBOOK = 2.5
"""Factor within which the healthy spreads of constants, the error of their answers and local conductances stay, which
are stated with their sources: what two models disagree on beyond that is no constant of the rig."""

WIDEN_ABOVE = 1.3
"""Mean square of healthy sets along a direction [variances] above which the covariance is widened there."""

LARGEST = 25.0
"""The same of the single healthy set that goes furthest along it: rigs differ by more than their mean says, in the
teeth above all, and a name is wrong once in any of them."""

OWN_KINDS = ("point", "series_mesh_point", "series_shaft_point", "frequency")
"""Amplitudes of what each number is off by itself."""


@dataclass(frozen=True, kw_only=True)
class Group:
    """Healthy sets of one rig with the same sensors and plan.

    noise : (n, n) without any amplitude; parts : amplitude -> (n, n); products : (n, n) sum of r r'; count : of sets
    """

    noise: Array
    parts: Mapping[str, Array]
    products: Array
    count: int

    @classmethod
    def of(cls, sets: Sequence[Comparison], amplitudes: Amplitudes, widening: Mapping[str, float]) -> "Group":
        """Sets with the same features in the same order.

        amplitudes : at which the constants are bent to the data (`subject.plain`): columns are those of the first
            set, residuals each set's own
        """
        first = sets[0]
        spaces = [plain(one, amplitudes, widening) for one in sets]
        parts: dict[str, Array] = {}
        for column in spaces[0].covariance.columns:
            values = column.spread * column.values
            parts[column.kind] = parts.get(column.kind, 0.0) + np.outer(values, values)
        parts["answer"] = first.answer_error
        nothing = Amplitudes(**dict.fromkeys((*OWN_KINDS, "answer"), 0.0))
        for kind in OWN_KINDS:
            alone = nothing.with_values({kind: 1.0})
            own = own_spread(first.library, first.channels, first.mesh_orders, alone)
            if own.any():
                parts[kind] = np.diag(own**2)
        return cls(
            noise=np.mean([one.base_noise(nothing) for one in sets], axis=0),
            parts=parts,
            products=np.sum([np.outer(one.raw, one.raw) for one in spaces], axis=0),
            count=len(sets),
        )


ROUNDS = 2
"""Fits one after the other, each with the constants bent at the amplitudes of the one before."""


def calibrate(
    alike: Sequence[Sequence[Comparison]],
    start: Amplitudes,
    fixed: frozenset[str] = frozenset(),
    larger: Sequence[Comparison] = (),
) -> tuple[Amplitudes, dict[str, float]]:
    """Amplitudes and widening of healthy sets, in lists of the same features.

    The widening takes over what amplitudes had to stretch for, so both are found again beside each other.

    larger : sets with too many numbers for the amplitudes; the widening counts them too
    """
    found, widening = start, dict[str, float]()
    for _ in range(ROUNDS):
        groups = [Group.of(sets, found, widening) for sets in alike]
        found = fit_amplitudes(groups, found, fixed | {"widening"}, start)
        widening = widen((*(one for sets in alike for one in sets), *larger), found)
    return found, widening


def fit_amplitudes(
    groups: Sequence[Group],
    start: Amplitudes,
    fixed: frozenset[str] = frozenset(),
    prior: Amplitudes | None = None,
) -> Amplitudes:
    """The amplitudes that make the healthy sets most likely.

    fixed : amplitudes that stay as they are: sensors and inputs are what the measurement states
    prior : centre of their wide prior; ``start`` when left out
    """
    names = sorted({kind for group in groups for kind in group.parts} - fixed)
    first = start.as_dict() | {"widening": 1.0}
    centre = np.log([(prior or start).as_dict()[name] for name in names])

    def misfit(logs: Array) -> tuple[float, Array]:
        amplitudes = first | dict(zip(names, np.exp(logs), strict=True))
        value = 0.5 * float(np.sum(((logs - centre) / PRIOR) ** 2))
        slope = (logs - centre) / PRIOR**2
        for group in groups:
            one, by_amplitude = _misfit(group, amplitudes, names)
            value += one
            slope = slope + by_amplitude
        return value, slope

    found = minimize(
        misfit,
        np.log([first[name] for name in names]),
        jac=True,
        method="L-BFGS-B",
        bounds=[(c - reach, c + reach) for c, reach in zip(centre, _reaches(names), strict=True)],
        options={"maxiter": 60},
    )
    return start.with_values(dict(zip(names, (float(value) for value in np.exp(found.x)), strict=True)))


def _reaches(names: Sequence[str]) -> list[float]:
    """How far the logarithm of each amplitude may go from its centre."""
    stated = ("constant", "link", "answer")
    return [float(np.log(HANDBOOK)) if name.startswith(stated) else 5.0 for name in names]


def _misfit(group: Group, amplitudes: Mapping[str, float], names: Sequence[str]) -> tuple[float, Array]:
    """-ln likelihood of a group and its derivative by the logarithms of the named amplitudes."""
    matrix = group.noise + sum(amplitudes[kind] ** 2 * part for kind, part in group.parts.items())
    lower = np.linalg.cholesky(matrix)
    inverse = np.linalg.inv(lower)
    precision = inverse.T @ inverse
    weighed = precision @ group.products @ precision
    value = group.count * float(np.log(np.diagonal(lower)).sum()) + 0.5 * float(
        np.sum(precision * group.products)
    )
    slopes = [
        amplitudes[name] ** 2 * float(np.sum((group.count * precision - weighed) * group.parts[name]))
        if name in group.parts
        else 0.0
        for name in names
    ]
    return value, np.array(slopes)


def widen(subjects: Iterable[Comparison], amplitudes: Amplitudes) -> dict[str, float]:
    """Spread [coordinate] that healthy sets show along causes beyond the columns, by `Direction.likeness`.

    z = a'r / |a| in the white space of a healthy rig has a mean square of one where the covariance is right. The
    cause with the largest is widened until its mean is `WIDEN_ABOVE` and no set is above `LARGEST`, then the next: one
    direction two models disagree on shows in many causes and is mended once.
    """
    return _widen([_Seen.of(subject, plain(subject, amplitudes)) for subject in subjects])


def calibrate_drift(
    pairs: Sequence[tuple[Comparison, Comparison]], amplitudes: Amplitudes, start: Drift
) -> Drift:
    """What a healthy rig changes from set to set, from pairs of healthy sets (the second is the baseline).

    The shares maximise the likelihood of all changes; `widen_drift` finds the widening.
    """
    changes = [Change.of(subject, baseline, amplitudes) for subject, baseline in pairs]
    residuals = [change.subject.residual - change.expected for change in changes]

    def misfit(logs: Array) -> float:
        drift = Drift(**dict(zip(SHARES, np.exp(logs).tolist(), strict=True)))
        value = 0.5 * float(np.sum(((logs - centre) / PRIOR) ** 2))
        for change, residual in zip(changes, residuals, strict=True):
            lower = np.linalg.cholesky(change.covariance(drift))
            white = solve_triangular(lower, residual, lower=True, check_finite=False)
            value += float(np.log(np.diagonal(lower)).sum()) + 0.5 * float(white @ white)
        return value

    centre = np.log([getattr(start, name) for name in SHARES])
    best = minimize(misfit, centre, method="Nelder-Mead", options={"xatol": 0.02, "fatol": 0.05})
    return Drift(**dict(zip(SHARES, np.exp(best.x).tolist(), strict=True)))


def widen_drift(
    pairs: Iterable[tuple[Comparison, Comparison]], amplitudes: Amplitudes, drift: Drift
) -> Drift:
    """The drift with the spread that healthy pairs show along an effect from set to set; found as in `widen`."""
    still = replace(drift, widening={})
    seen = [
        _Seen.of(subject, differenced(subject, baseline, amplitudes, still)) for subject, baseline in pairs
    ]
    return replace(drift, widening=_widen(seen))


SHARES = ("shared", "shaft", "mesh", "amplitude")
"""Numbers of a drift that are fitted."""


WIDEST = 60
"""Times that a likeness is widened at most, one at a time."""

UNSEEN = 2.0
"""Whitened length of a direction at its reach below which it can explain too little to be named, and healthy sets say
nothing of it."""


def _widen(seen: Sequence["_Seen"]) -> dict[str, float]:
    found: dict[str, float] = {}
    for _ in range(WIDEST):
        squares: dict[str, list[Array]] = {}
        for one in seen:
            for likeness, own in one.squares().items():
                squares.setdefault(likeness, []).append(own)
        excess = {likeness: _excess(np.concatenate(own)) for likeness, own in squares.items()}
        worst = max(excess, key=lambda likeness: excess[likeness], default="")
        if not worst or excess[worst] <= 1.01:
            break
        more = _missing([one.along(worst) for one in seen if worst in one.likeness])
        seen = [one.widened(worst, more) for one in seen]
        found[worst] = float(np.hypot(found.get(worst, 0.0), more))
    return found


def _excess(squares: Array) -> float:
    """By how much squares (k,) of healthy residuals along directions are too large."""
    return max(float(np.mean(squares)) / WIDEN_ABOVE, float(np.max(squares)) / LARGEST)


def _missing(along: Sequence["_Along"]) -> float:
    """Spread of a likeness at which its squares are no longer too large."""
    lengths = np.sqrt(np.concatenate([np.diagonal(one.gram)[one.judged] for one in along]))

    def excess(logarithm: float) -> float:
        spread = float(np.exp(logarithm))
        return _excess(np.concatenate([one.squares(spread) for one in along])) - 1.0

    low, high = np.log([1e-3 / lengths.max(), 1e3 / lengths.min()])
    return float(np.exp(brentq(excess, float(low), float(high), xtol=5e-3)))


@dataclass(frozen=True, kw_only=True)
class _Along:
    """What one set says along the directions of one likeness: products (k, k), with the residual (k,); which count."""

    gram: Array
    load: Array
    judged: NDArray[np.bool_]

    @cached_property
    def axes(self) -> tuple[Array, Array]:
        """Squared lengths (k,) and directions (k, k) of the principal axes."""
        values, vectors = np.linalg.eigh(self.gram)
        return np.maximum(values, 0.0), vectors

    def squares(self, spread: float) -> Array:
        """Of the residual along those that count, with all of them widened by a spread."""
        values, vectors = self.axes
        left = 1.0 / (1.0 + spread**2 * values)
        own = vectors[self.judged]
        return np.asarray(
            (own @ (left * (vectors.T @ self.load))) ** 2 / np.maximum(own**2 @ (values * left), 1e-30)
        )


@dataclass(frozen=True, kw_only=True)
class _Seen:
    """What one healthy set says: products of its whitened directions (k, k) and with the residual (k,).

    likeness : (k,) of each direction; judged : (k,) whether it is seen
    """

    gram: Array
    load: Array
    likeness: NDArray[np.str_]
    judged: NDArray[np.bool_]

    @classmethod
    def of(cls, subject: Comparison, space: Whitened) -> "_Seen":
        """Of a set in the white space of a healthy rig."""
        found = list(subject.directions())
        white = space.covariance.whiten(np.hstack([one.values for one in found]))
        counts = [one.values.shape[1] for one in found]
        lengths = np.linalg.norm(white, axis=0)
        return cls(
            gram=white.T @ white,
            load=white.T @ space.residual,
            likeness=np.repeat([one.likeness for one in found], counts),
            judged=lengths * np.repeat([one.reach for one in found], counts) > UNSEEN,
        )

    def squares(self) -> dict[str, Array]:
        """Likeness -> squares of the residual along its directions that are seen."""
        squares = self.load**2 / np.maximum(np.diagonal(self.gram), 1e-30)
        return {
            likeness: squares[own]
            for likeness in dict.fromkeys(self.likeness.tolist())
            if (own := self.judged & (self.likeness == likeness)).any()
        }

    def along(self, likeness: str) -> _Along:
        """The part of one likeness."""
        own = np.flatnonzero(self.likeness == likeness)
        return _Along(gram=self.gram[np.ix_(own, own)], load=self.load[own], judged=self.judged[own])

    def widened(self, likeness: str, spread: float) -> "_Seen":
        """The same with the covariance wider along a likeness."""
        own = np.flatnonzero(self.likeness == likeness)
        if not len(own):
            return self
        across = spread * self.gram[:, own]
        inner = np.eye(len(own)) + spread * across[own]
        taken = np.linalg.solve(inner, np.column_stack([across.T, spread * self.load[own]]))
        return replace(self, gram=self.gram - across @ taken[:, :-1], load=self.load - across @ taken[:, -1])

"""Amplitudes of a healthy rig's covariance from healthy sets, by marginal likelihood.

The covariance is a sum over kinds of cause, C = N + sum_k a_k^2 S_k; of many healthy sets of one plan and one set of
sensors only the sum of r r' counts. The amplitudes maximise the likelihood of all groups together, held by a wide
prior around their starting values.

Source: type II maximum likelihood, Rasmussen and Williams 2006, ch. 5.4; the gradient is eq. (5.9).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular
from scipy.optimize import minimize

from rigdesign.diagnosis.residual.baseline import Change, Drift
from rigdesign.diagnosis.residual.covariance_inflation import inflate
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.columns import Array

PRIOR = 1.5
"""Standard deviation of the logarithm of an amplitude around its starting value."""

HANDBOOK = 2.5
"""Factor within which the healthy spreads of constants, the error of their answers and local conductances stay, which
are stated with their sources: what two models disagree on beyond that is no constant of the rig."""

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
    def of(
        cls, sets: Sequence[ResidualProblem], amplitudes: Amplitudes, inflation: Mapping[str, float]
    ) -> "Group":
        """Sets with the same features in the same order.

        amplitudes : at which the constants are bent to the data (`residuals.plain`): columns are those of the first
            set, residuals each set's own
        """
        first = sets[0]
        spaces = [plain(one, amplitudes, inflation) for one in sets]
        parts: dict[str, Array] = {}
        for column in spaces[0].covariance.columns:
            values = column.spread * column.values
            parts[column.kind] = parts.get(column.kind, 0.0) + np.outer(values, values)
        parts["answer"] = first.answer_error
        nothing = Amplitudes(**dict.fromkeys((*OWN_KINDS, "answer"), 0.0))
        for kind in OWN_KINDS:
            alone = nothing.with_values({kind: 1.0})
            own = first.own_spread(alone)
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
    alike: Sequence[Sequence[ResidualProblem]],
    start: Amplitudes,
    fixed: frozenset[str] = frozenset(),
    larger: Sequence[ResidualProblem] = (),
) -> tuple[Amplitudes, dict[str, float]]:
    """Amplitudes and inflation of healthy sets, in lists of the same features.

    The inflation takes over what amplitudes had to stretch for, so both are found again in turn.

    larger : sets with too many numbers for the amplitudes; the inflation counts them too
    """
    found, inflation = start, dict[str, float]()
    for _ in range(ROUNDS):
        groups = [Group.of(sets, found, inflation) for sets in alike]
        found = fit_amplitudes(groups, found, fixed | {"inflation"}, start)
        inflation = inflate((*(one for sets in alike for one in sets), *larger), found)
    return found, inflation


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
    first = start.as_dict() | {"inflation": 1.0}
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
    weighted = precision @ group.products @ precision
    value = group.count * float(np.log(np.diagonal(lower)).sum()) + 0.5 * float(
        np.sum(precision * group.products)
    )
    slopes = [
        amplitudes[name] ** 2 * float(np.sum((group.count * precision - weighted) * group.parts[name]))
        if name in group.parts
        else 0.0
        for name in names
    ]
    return value, np.array(slopes)


def calibrate_drift(
    pairs: Sequence[tuple[ResidualProblem, ResidualProblem]], amplitudes: Amplitudes, start: Drift
) -> Drift:
    """What a healthy rig changes from set to set, from pairs of healthy sets (the second is the baseline).

    The shares maximise the likelihood of all changes; `rigdesign.diagnosis.residual.covariance_inflation` finds the
    inflation.
    """
    changes = [Change.of(residuals, baseline, amplitudes) for residuals, baseline in pairs]
    left = [change.residuals.residual - change.expected for change in changes]

    def misfit(logs: Array) -> float:
        drift = Drift(**dict(zip(SHARES, np.exp(logs).tolist(), strict=True)))
        value = 0.5 * float(np.sum(((logs - centre) / PRIOR) ** 2))
        for change, residual in zip(changes, left, strict=True):
            lower = np.linalg.cholesky(change.covariance(drift))
            white = solve_triangular(lower, residual, lower=True, check_finite=False)
            value += float(np.log(np.diagonal(lower)).sum()) + 0.5 * float(white @ white)
        return value

    centre = np.log([getattr(start, name) for name in SHARES])
    best = minimize(misfit, centre, method="Nelder-Mead", options={"xatol": 0.02, "fatol": 0.05})
    return Drift(**dict(zip(SHARES, np.exp(best.x).tolist(), strict=True)))


SHARES = ("shared", "slope", "shaft", "mesh", "amplitude")
"""Numbers of a drift that are fitted."""

"""What simpler methods name on the same sets: BIC, the best single fit, an F-test with false-discovery control.

All have the residual, the covariance and the answers of the diagnosis, effects and sensor errors alike. None has rivals
without a name, errors of signatures, a prior, or points held out.

Sources: Schwarz, Ann. Stat. 6, 1978, 461; Benjamini and Hochberg, J. R. Stat. Soc. B 57, 1995, 289.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import log

import numpy as np
from scipy.stats import f as fisher
from scipy.stats import false_discovery_control

from rigdesign.diagnosis.decision.search import explanations_of
from rigdesign.diagnosis.run import Result
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.detectability import SEEN
from rigdesign.diagnosis.statistics.evidence import evaluate_hypothesis

MOST = 4
"""Effects that a comparator names at most."""

DISCOVERIES = 0.05
"""Expected share of false ones among what the F-test finds."""


@dataclass(frozen=True)
class Candidate:
    """An effect with its whitened columns (n, k), the slope at its best size."""

    part: str
    columns: Array


def comparators(result: Result) -> dict[str, list[str]]:
    """Comparator -> effects it names on the set of a diagnosis."""
    problem = result.problem
    space = problem.space(result.calibration)
    known = explanations_of(problem.residuals, space, rivals=False)
    singles = [evaluate_hypothesis(space, one) for one in (*known.physical, *known.sensor)]
    candidates = [Candidate(one.hypothesis.parts[0], one.columns) for one in singles if one.columns.size]
    return {name: choose(space.residual, candidates) for name, choose in COMPARATORS.items()}


def best_single_fit(residual: Array, candidates: Sequence[Candidate]) -> list[str]:
    """The effect that explains most, if it is seen."""
    falls = _falls(residual, [], candidates)
    best = int(np.argmax(falls))
    return [candidates[best].part] if falls[best] > SEEN**2 else []


def bic(residual: Array, candidates: Sequence[Candidate]) -> list[str]:
    """Effects added one by one as long as the information criterion falls."""
    penalty = log(len(residual))

    def worth(falls: Array, sizes: Array, left: float) -> Array:
        return np.asarray(falls - penalty * sizes)

    return _forward(residual, candidates, worth)


def f_test(residual: Array, candidates: Sequence[Candidate]) -> list[str]:
    """Effects added one by one as long as one is significant among all of them."""

    def worth(falls: Array, sizes: Array, left: float) -> Array:
        free = len(residual) - sizes
        ratio = (falls / sizes) / (np.maximum(left - falls, 1e-300) / free)
        chances = np.asarray(fisher.sf(ratio, sizes, free))
        return DISCOVERIES - np.asarray(false_discovery_control(chances)) + 1e-9 * falls

    return _forward(residual, candidates, worth)


COMPARATORS: dict[str, Callable[[Array, Sequence[Candidate]], list[str]]] = {
    "best single fit": best_single_fit,
    "BIC": bic,
    "F-test": f_test,
}


def _forward(
    residual: Array, candidates: Sequence[Candidate], worth: Callable[[Array, Array, float], Array]
) -> list[str]:
    """Parts added one by one, the one of the greatest fall among those worth it; ``worth`` has falls, sizes, square."""
    chosen: list[Candidate] = []
    sizes = np.array([one.columns.shape[1] for one in candidates])
    while len(chosen) < MOST:
        falls = _falls(residual, chosen, candidates)
        left = float(residual @ residual) - _explained(residual, chosen)
        worthy = np.where(worth(falls, sizes, left) > 0.0, falls, -np.inf)
        worthy[[one.part in {had.part for had in chosen} for one in candidates]] = -np.inf
        best = int(np.argmax(worthy))
        if not np.isfinite(worthy[best]):
            break
        chosen.append(candidates[best])
    return [one.part for one in chosen]


def _explained(residual: Array, chosen: Sequence[Candidate]) -> float:
    if not chosen:
        return 0.0
    basis = np.linalg.qr(np.hstack([one.columns for one in chosen]))[0]
    return float(np.sum((basis.T @ residual) ** 2))


def _falls(residual: Array, chosen: Sequence[Candidate], candidates: Sequence[Candidate]) -> Array:
    """(m,) fall of the square by each candidate in addition to those chosen."""
    if chosen:
        basis = np.linalg.qr(np.hstack([one.columns for one in chosen]))[0]
        residual = residual - basis @ (basis.T @ residual)
    falls = []
    for one in candidates:
        columns = one.columns
        if chosen:
            columns = columns - basis @ (basis.T @ columns)
        solved = np.linalg.lstsq(columns, residual, rcond=1e-9)[0]
        falls.append(float(residual @ (columns @ solved)))
    return np.array(falls)

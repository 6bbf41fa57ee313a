"""What a sampled study says: the probability that a check holds, and the inputs that cause its spread."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest, sobol_indices

from rigdesign.studies.crossings import holds
from rigdesign.studies.result import PassProbability, SobolIndex, StudyPoint

Array = NDArray[np.float64]
CONFIDENCE = 0.95
RESAMPLES = 500
"""Bootstrap samples of an interval."""
ALL = "all"
"""Stands for every selected check together."""
NO_SPREAD = 1e-9
"""Standard deviation of a distance below which nothing causes it."""


def pass_probability(check: str, held: int, samples: int, failed: int) -> PassProbability:
    """Share of ``held`` in ``samples`` with Wilson's interval.

    Wilson, J. Am. Stat. Assoc. 22 (1927) 209. It takes the samples as independent: those of a Latin hypercube or a
    Sobol sequence are spread more evenly, so that the interval is on the safe side.
    """
    interval = binomtest(held, samples).proportion_ci(CONFIDENCE, method="wilson")
    return PassProbability(
        check=check,
        probability=held / samples,
        low=float(interval.low),
        high=float(interval.high),
        samples=samples,
        failed=failed,
    )


def pass_probabilities(points: Sequence[StudyPoint], checks: Sequence[str]) -> Iterator[PassProbability]:
    """The probability of every check that applies to some computed point."""
    computed = [point for point in points if not point.failed]
    for identity in checks:
        states = [state for point in computed if (state := holds(point.check(identity))) is not None]
        if states:
            yield pass_probability(identity, sum(states), len(states), len(points) - len(computed))


def probability_of_all(points: Sequence[StudyPoint], checks: Sequence[str]) -> PassProbability | None:
    """The probability that no selected check is broken; None without a computed point."""
    computed = [point for point in points if not point.failed]
    if not computed:
        return None
    held = sum(all(holds(point.check(identity)) is not False for identity in checks) for point in computed)
    return pass_probability(ALL, held, len(computed), len(points) - len(computed))


def variance_shares(
    points: Sequence[StudyPoint], checks: Sequence[str], paths: Sequence[str], seed: int
) -> Iterator[SobolIndex]:
    """Sobol indices of the distance of every check that has one in all points and is spread at all.

    points : the design of `saltelli_points` in its order, all of them computed
    seed : of the bootstrap

    Estimators of Saltelli et al. (2010) by `scipy.stats.sobol_indices`; intervals by the percentiles of a bootstrap
    over the rows of the design.
    """
    size = len(points) // (len(paths) + 2)
    named = {identity: _distances(points, identity) for identity in checks}
    spread = {
        identity: values
        for identity, values in named.items()
        if values is not None and np.std(values) > NO_SPREAD
    }
    if not spread:
        return
    pages = np.array(list(spread.values())).reshape(len(spread), len(paths) + 2, size)
    first, total = _indices(pages)
    rng = np.random.default_rng(seed)
    resampled = [_indices(pages[:, :, rng.integers(0, size, size)]) for _ in range(RESAMPLES)]
    tails = [50.0 * (1.0 - CONFIDENCE), 50.0 * (1.0 + CONFIDENCE)]
    low_first, high_first = np.nanpercentile([entry[0] for entry in resampled], tails, axis=0)
    low_total, high_total = np.nanpercentile([entry[1] for entry in resampled], tails, axis=0)
    for row, identity in enumerate(spread):
        for column, path in enumerate(paths):
            yield SobolIndex(
                check=identity,
                path=path,
                first_order=float(first[row, column]),
                first_order_interval=(float(low_first[row, column]), float(high_first[row, column])),
                total=float(total[row, column]),
                total_interval=(float(low_total[row, column]), float(high_total[row, column])),
            )


def _distances(points: Sequence[StudyPoint], identity: str) -> Array | None:
    """Distance of a check in every point; None where one has none."""
    checks = [point.check(identity) for point in points]
    values = [None if check is None else check["distance"] for check in checks]
    return None if any(value is None for value in values) else np.array(values, dtype=float)


def _indices(pages: Array) -> tuple[Array, Array]:
    """First-order and total indices, (checks, inputs), of values (checks, inputs + 2, size)."""
    checks = len(pages)
    if checks == 1:  # a single value of a single input is no array to scipy
        pages = np.repeat(pages, 2, axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):  # a resample without spread has no index
        found = sobol_indices(
            func={"f_A": pages[:, 0], "f_B": pages[:, 1], "f_AB": np.swapaxes(pages[:, 2:], 0, 1)},
            n=pages.shape[2],
        )
    shape = (pages.shape[0], pages.shape[1] - 2)
    first, total = (np.reshape(part, shape) for part in (found.first_order, found.total_order))
    return first[:checks], total[:checks]

"""What a sampled study says: the probability that a check holds, and the inputs that cause its spread."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest, sobol_indices

from rigdesign.studies.grid import InputRange, Variation
from rigdesign.studies.result import Crossing, PassProbability, Record, SobolIndex, StudyPoint, Swing

if TYPE_CHECKING:
    from rigdesign.case import Case

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


# Where a check changes from held to broken between computed points.


@dataclass(frozen=True)
class CheckState:
    """A check at one value of an input: whether it holds, and its margin where it has one, in its unit."""

    value: float
    holds: bool
    margin: float | None


def holds(check: Record | None) -> bool | None:
    """Whether a check holds; None where there is no result or the check does not apply.

    A margin of at least 0 holds, also where contributors that are left out make the verdict open.
    """
    if check is None or check["verdict"] == "not applicable":
        return None
    return None if check["margin"] is None else bool(check["margin"] >= 0.0)


def check_states(identity: str, places: Sequence[tuple[float, StudyPoint]]) -> list[CheckState]:
    """A check over the values of an input, rising; points that say nothing of it are left out."""
    states = []
    for value, point in sorted(places, key=lambda place: place[0]):
        check = point.check(identity)
        if check is not None and (held := holds(check)) is not None:
            states.append(CheckState(value, held, check["margin"]))
    return states


def changes(states: Sequence[CheckState]) -> Iterator[tuple[CheckState, CheckState]]:
    """Neighbours of which one holds and one does not."""
    return ((left, right) for left, right in pairwise(states) if left.holds != right.holds)


def interpolated(left: CheckState, right: CheckState) -> float:
    """The value at which the margin is zero, by a straight line; halfway where a margin is missing.

    The margin follows the value of a check; its distance does not where the limit is a lower one.
    """
    if left.margin is None or right.margin is None:
        return 0.5 * (left.value + right.value)
    share = left.margin / (left.margin - right.margin)
    return left.value + min(max(share, 0.0), 1.0) * (right.value - left.value)


def crossings_over(
    variation: Variation, points: Sequence[StudyPoint], checks: Sequence[str]
) -> Iterator[Crossing]:
    """Crossings of every check along one varied input, for every combination of the others.

    Nothing for an input whose values are not numbers of one unit.
    """
    numbers = variation.numbers()
    if numbers is None:
        return
    value_of = dict(zip(variation.values, numbers[0], strict=True))
    rows: dict[tuple[tuple[str, str], ...], list[tuple[float, StudyPoint]]] = {}
    for point in points:
        others = tuple((path, text) for path, text in point.values.items() if path != variation.path)
        rows.setdefault(others, []).append((value_of[point.values[variation.path]], point))
    for identity in checks:
        for others, places in rows.items():
            for left, right in changes(check_states(identity, places)):
                yield Crossing(
                    check=identity,
                    path=variation.path,
                    value=interpolated(left, right),
                    low=left.value,
                    high=right.value,
                    unit=numbers[1],
                    holds="below" if left.holds else "above",
                    others=dict(others),
                )


# One input at a time at both ends of its range: what each of them does to the checks.

LEAST_SWING = 1e-6
"""Change of a distance below which an input does not move a check."""
NOT_STATED = "as stated"
"""Shown for an input that the case leaves to its default, or that stands for several."""


def stated_values(case: "Case", ranges: Sequence[InputRange]) -> dict[str, str]:
    """What the case writes for every input."""
    written = {row.path: row.value for row in case.inputs}
    return {entry.path: written.get(entry.path, NOT_STATED) for entry in ranges}


def ends(ranges: Sequence[InputRange]) -> Iterator[tuple[InputRange, str]]:
    """Every range with its low end, then with its high one."""
    for entry in ranges:
        yield entry, entry.text(entry.low)
        yield entry, entry.text(entry.high)


def swings(
    ranges: Sequence[InputRange], points: Sequence[StudyPoint], checks: Sequence[str]
) -> Iterator[Swing]:
    """What each input does to each check; pairs that do not move are left out.

    points : the stated case, then the `ends`
    """
    stated, at_ends = points[0], points[1:]
    for number, entry in enumerate(ranges):
        low, high = at_ends[2 * number : 2 * number + 2]
        for identity in checks:
            if _moves(identity, stated, low, high):
                yield Swing(
                    check=identity,
                    path=entry.path,
                    low=low.values[entry.path],
                    high=high.values[entry.path],
                    distance_stated=_distance(stated, identity),
                    distance_low=_distance(low, identity),
                    distance_high=_distance(high, identity),
                )


def _moves(identity: str, stated: StudyPoint, low: StudyPoint, high: StudyPoint) -> bool:
    reference = _distance(stated, identity)
    for point in (low, high):
        found = _distance(point, identity)
        if holds(point.check(identity)) != holds(stated.check(identity)) or (found is None) != (
            reference is None
        ):
            return True
        if found is not None and reference is not None and abs(found - reference) > LEAST_SWING:
            return True
    return False


def _distance(point: StudyPoint, identity: str) -> float | None:
    check = point.check(identity)
    return None if check is None else check["distance"]

"""Operating points kept aside before anything is fitted, chosen by a hash and used once."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.covariance import Covariance

LEAST_POINTS = 6
"""Operating points from which on some are held out."""

SHARE = 0.2
"""Share of the points that is held out."""


def held_out(points: Sequence[str], seed: str) -> tuple[str, ...]:
    """Names of the points kept aside, in the order of the set; none of a small set.

    seed : hash of the measurement: the choice is fixed before anyone looks and cannot be chosen to please
    """
    if len(points) < LEAST_POINTS:
        return ()
    count = max(1, round(SHARE * len(points)))
    drawn = sorted(points, key=lambda name: hashlib.sha256(f"{seed}/{name}".encode()).hexdigest())[:count]
    return tuple(name for name in points if name in set(drawn))


@dataclass(frozen=True, kw_only=True)
class Gap:
    """How far prediction and readings lie apart on points the fit never saw.

    before, after : root mean square of the whitened residual, each number by its marginal covariance, 1 in the mean
        of healthy rigs; raw_before, raw_after : of the residual in the effect's own readings, of the one quantity it
        moves most, in the unit of that quantity [SI]; raw_floor : of their noise
    """

    before: float
    after: float
    raw_before: float
    raw_after: float
    raw_floor: float
    points: tuple[str, ...]


def gap(
    covariance: Covariance,
    residual: Array,
    answer: Array,
    noise: Array,
    quantities: Sequence[str],
    points: tuple[str, ...],
) -> Gap:
    """Gap on the held-out numbers before and after the answer (n,) of the named effects is taken into the model.

    noise : (n,) standard deviation of the readings; quantities : (n,) what they are of
    """
    strong = _own(answer / noise, quantities) if np.any(answer) else np.ones_like(noise, bool)
    before, after = (_whitened(covariance, values) for values in (residual, residual - answer))
    raw = [float(np.sqrt(np.mean(values[strong] ** 2))) for values in (residual, residual - answer, noise)]
    return Gap(
        before=before, after=after, raw_before=raw[0], raw_after=raw[1], raw_floor=raw[2], points=points
    )


OWN = 0.25
"""Answer over that of the reading moved most, both in noise, from which on a reading is the effect's own."""


def _own(seen: Array, quantities: Sequence[str]) -> NDArray[np.bool_]:
    """(n,) readings that an answer, in noise, moves, of the quantity it moves most."""
    size = np.abs(seen)
    most = int(np.argmax(size))
    alike = np.array([quantity == quantities[most] for quantity in quantities])
    return np.asarray(alike & (size > OWN * size[most]))


def _whitened(covariance: Covariance, values: Array) -> float:
    white = covariance.whiten(values)
    return float(np.sqrt(np.mean(white**2)))

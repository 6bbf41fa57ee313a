"""Operating points held out before anything is fitted, chosen by a hash and used once.

What an answer a (n,) of the model does to the residual r (n,) of the held-out numbers is the fall of the whitened
square, with C the covariance of the residual of a healthy rig there:

    fall = r' C^-1 r - (r - a)' C^-1 (r - a) = 2 a' C^-1 r - a' C^-1 a

Before and after share their noise, so the scatter of the fall is not that of either square. With r normal of
covariance C the fall is normal of standard deviation 2 (a' C^-1 a)^(1/2) whatever is the mean of r: its mean is
+a' C^-1 a where the answer is right and -a' C^-1 a where the rig is healthy. Where more is left than a healthy rig
leaves, the scatter is larger by the root mean square of what is left.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Covariance

LEAST_POINTS = 6
"""Operating points from which on some are held out."""

SHARE = 0.2
"""Share of the points that is held out."""


def held_out(points: Sequence[str], seed: str) -> tuple[str, ...]:
    """Names of the points held out, in the order of the set; none of a small set.

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
        of healthy rigs; fall : of the whitened square; scatter : its standard deviation (see the module);
        raw_before, raw_after : of the residual in the effect's own readings, of the one quantity it moves most, in the
        unit of that quantity [SI]; raw_floor : of their noise
    """

    before: float
    after: float
    fall: float
    scatter: float
    raw_before: float
    raw_after: float
    raw_floor: float
    points: tuple[str, ...]

    @property
    def closer(self) -> bool:
        """Whether the gap shrinks by more than its scatter."""
        return self.fall > self.scatter

    @property
    def shrunk(self) -> bool:
        """Whether it does, and that of the effect's own readings does not grow."""
        return self.closer and self.raw_after <= self.raw_before

    @property
    def grown(self) -> bool:
        """Whether the gap is larger with the effects than without."""
        return self.fall < 0.0


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
    white, moved = covariance.whiten(residual), covariance.whiten(answer)
    left = _rms(white - moved)
    raw = [_rms(values[strong]) for values in (residual, residual - answer, noise)]
    return Gap(
        before=_rms(white),
        after=left,
        fall=float(2.0 * moved @ white - moved @ moved),
        scatter=2.0 * float(np.linalg.norm(moved)) * max(1.0, left),
        raw_before=raw[0],
        raw_after=raw[1],
        raw_floor=raw[2],
        points=points,
    )


def gap_in_words(gap: Gap) -> str:
    """``on P03, P08 falls from 4.18 to 1.28``, and whether that is enough."""
    numbers = f"from {gap.before:.3g} to {gap.after:.3g}"
    if gap.grown:
        return f"on {', '.join(gap.points)}, held out, grows {numbers}"
    enough = "" if gap.shrunk else ", no more than its scatter"
    if gap.raw_after > gap.raw_before:
        enough = ", but that of the effect's own readings grows"
    return f"on {', '.join(gap.points)}, held out, falls {numbers}{enough}"


OWN = 0.25
"""Answer over that of the reading moved most, both in noise, from which on a reading is the effect's own."""


def _own(seen: Array, quantities: Sequence[str]) -> NDArray[np.bool_]:
    """(n,) readings that an answer, in noise, moves, of the quantity it moves most."""
    size = np.abs(seen)
    most = int(np.argmax(size))
    alike = np.array([quantity == quantities[most] for quantity in quantities])
    return np.asarray(alike & (size > OWN * size[most]))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))

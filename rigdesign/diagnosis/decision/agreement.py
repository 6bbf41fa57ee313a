"""Whether all channels, and all operating points, ask for the same size of an effect.

What is one-sided, local or grows otherwise over the speed is something else that the effect is fitted to: a leak on one
side is no leak on both. A cause that goes with the effect in the best explanation is in the model meanwhile.
"""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import chi2

from rigdesign.diagnosis.statistics.columns import numbered
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import JOIN, Evidence, release_of

APART = 0.7
"""Least part of what an effect explains alone that another cause in the model leaves to it, to be something else."""

FAINT = 0.5
"""Whitened length of the answer in a group below which the group says nothing of its size."""


@dataclass(frozen=True, kw_only=True)
class Agreement:
    """Sizes of effects by channel and by operating point.

    evidence : of the evaluation that found them, best first; channels, points : (n,) of each number, natural
        frequencies as one channel, since those that lie close share a change; errors : kind of effect -> relative error
        of the model's answer to it, "" for the others
    """

    space: Whitened = field(repr=False)
    evidence: Sequence[Evidence] = field(repr=False)
    channels: Sequence[str] = field(repr=False)
    points: Sequence[str] = field(repr=False)
    errors: Mapping[str, float]

    def objection(
        self, one: Evidence, beside: Sequence[Evidence], least: float, admitted: float = 0.0
    ) -> str:
        """What disagrees on the size of an effect, in words; empty where nothing does.

        beside : causes that are in the model with sizes of their own; least : probability of sizes that differ as
            much, below which they are of different things; admitted : least relative error of the answer in a group
        """
        kind = one.hypothesis.parts[0].split(":")[0].split("/")[0]
        share = max(self.errors.get(kind, self.errors.get("", 0.0)), admitted)
        for what, groups in (
            ("channels", self.channels),
            ("operating points", self.points),
        ):
            if agreement(self.space, one, groups, share, beside) < least:
                return f"its size is not the same for all {what}"
        return ""

    def companion(self, one: Evidence) -> Evidence | None:
        """The cause that goes with an effect in the best explanation that holds it.

        None where that holds the effect alone, or where the cause takes too much of it away.
        """
        name = one.hypothesis.name
        for best in self.evidence:
            names = best.hypothesis.name.split(JOIN)
            if name in names:
                names.remove(name)
                break
        else:
            return None
        companion = next((other for other in self.evidence if [other.hypothesis.name] == names), None)
        if companion is None or best.gain - companion.gain < APART * one.gain:
            return None
        return companion


def agreement(
    space: Whitened,
    one: Evidence,
    groups: Sequence[Hashable],
    share: float,
    beside: Sequence[Evidence] = (),
) -> float:
    """Probability that groups of numbers ask for sizes as different as they do, if all are of one effect.

    Every group has its own factor on the answer at the best fit; all are fitted at once under the covariance of a
    healthy rig, which is inflated where they leave more than such a rig does. Each factor may be off by a share.

    groups : (n,) group of each number; share : relative error of the model's answer in a group
    beside : causes that are in the model with sizes of their own
    """
    own = tuple(name for cause in (one, *beside) for name in cause.hypothesis.own)
    release = release_of(space, own)
    number = numbered(groups)
    answer = space.covariance.lower @ one.answer
    split = np.where(number[:, None] == np.arange(number.max() + 1), answer[:, None], 0.0)
    columns = space.covariance.whiten(split)
    columns = columns[:, np.linalg.norm(columns, axis=0) > FAINT]
    count = columns.shape[1]
    if count < 2:
        return 1.0
    columns = np.hstack([columns, *(cause.columns for cause in beside)])
    residual = space.freed(own)
    gram, load = release.product(columns, columns), release.product(columns, residual)
    inverse = np.linalg.pinv(gram, hermitian=True)
    fit = inverse @ load
    left = float(release.product(residual, residual) - load @ fit) / max(len(residual) - len(fit), 1)
    factors, spread = fit[:count], inverse[:count, :count] * max(left, 1.0) + share**2 * np.eye(count)
    weights = np.linalg.inv(spread)
    mean = float(weights.sum(axis=0) @ factors / weights.sum())
    apart = factors - mean
    return float(chi2.sf(apart @ weights @ apart, count - 1))

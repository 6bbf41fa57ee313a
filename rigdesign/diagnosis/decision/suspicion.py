"""An effect that is probable and not named: what speaks for it, and what has to hold before it is said.

Between a name and silence: one effect of the catalogue, or one of a few that leave the same trace, is part of every
probable explanation, but more is left than a healthy rig leaves, an unmodelled cause goes with it or leaves that trace
as well, or the points held out do not prove it. It is suspected if

- it explains most of what is explained: what it leaves by itself is a small share of what it takes away;
- every channel and every operating point asks for the same size of it. What is one-sided, local or grows otherwise over
  the speed is something else that the effect is fitted to: a leak on one side is no leak on both;
- it shrinks the gap on the points held out, where these show it at all;
- it is large enough to matter, and within its bounds.
"""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import chi2

from rigdesign.diagnosis.decision.claims import Traces, too_little
from rigdesign.diagnosis.decision.decision import UNNAMED, Decision, Thresholds, mass_of_any
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.proof import Proof
from rigdesign.diagnosis.decision.search import Look, bounds_of, fitted
from rigdesign.diagnosis.statistics.columns import Array, numbered
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import SEEN
from rigdesign.diagnosis.statistics.evidence import Evidence, release_of
from rigdesign.diagnosis.statistics.heldout import Gap
from rigdesign.diagnosis.statistics.intervals import JointFit

REMAINDER = 0.3
"""Share of what an effect explains that it may leave in excess of a healthy rig."""

AGREEMENT = 0.01
"""Probability of sizes that differ as much between channels, or between points, below which they are of different
things."""

INCLUSION = 0.95
"""Posterior mass of all explanations that hold an effect, or what leaves its trace, from which on it is suspected."""

CATALOGUE = 0.4
"""Least part of it that the effects of the catalogue hold."""

LARGEST_GROUP = 4
"""Effects that leave one trace at most."""


@dataclass(frozen=True, kw_only=True)
class Suspicion:
    """The most probable effect of the catalogue with those that leave its trace.

    evidence, fit : of the effect alone; answer : (n,) what it adds to all kept numbers
    gap : with it on the points held out
    alike : effects and sensor errors that leave its trace, most alike first; unmodelled : causes that do
    """

    look: Look = field(repr=False)
    evidence: Evidence
    fit: JointFit
    answer: Array = field(repr=False)
    gap: Gap | None
    alike: tuple[str, ...]
    unmodelled: tuple[str, ...]

    @classmethod
    def of(cls, look: Look, proof: Proof, traces: Traces, calibration: Calibration) -> "Suspicion | None":
        """Of a look; None without any explanation from the catalogue."""
        inclusion = look.first.weights.inclusion
        known = {one.parts[0] for one in (*look.explanations.physical, *look.explanations.sensor)}
        alone = [one for one in look.first.evidence if len(one.hypothesis.parts) == 1]
        single = {one.hypothesis.parts[0]: one for one in reversed(alone)}
        names = [name for name in inclusion if name in known and name in single]
        if not names:
            return None
        evidence = single[max(names, key=lambda name: inclusion[name])]
        fit = fitted(look.space, [evidence], calibration)
        explanation, size = evidence.hypothesis.name, fit.coordinates[0]
        if not np.any(size):
            return None
        answer = proof.stored({explanation: size})
        return cls(
            look=look,
            evidence=evidence,
            fit=fit,
            answer=answer,
            gap=proof.gap(answer) if proof.points else None,
            alike=tuple(name for name, _ in traces.like(explanation, size)),
            unmodelled=tuple(name for name, _ in traces.like(explanation, size, UNNAMED)),
        )

    @property
    def group(self) -> tuple[str, ...]:
        """The effect and those that leave its trace, the most probable first."""
        inclusion = self.look.first.weights.inclusion
        own = self.evidence.hypothesis.parts[0]
        return (own, *sorted(self.alike, key=lambda name: -inclusion.get(name, 0.0)))

    def mass(self, *, unmodelled: bool) -> float:
        """Posterior mass of all explanations that hold one of the group, or an unmodelled cause of its trace."""
        members = {*self.group, *(self.unmodelled if unmodelled else ())}
        return mass_of_any(self.look.first.evidence, self.look.first.weights, members)

    @property
    def decision(self) -> Decision:
        """The verdict with its reason."""
        first, *others = self.group
        also = f"; {' and '.join(others)} would leave the same trace" if others else ""
        rest = f"{self.excess:.0%} of what it accounts for" if self.excess > 0.0 else "nothing"
        reason = f"{first} is the most probable effect; it leaves {rest} beyond a healthy rig"
        return Decision(verdict="suspected", named=self.group, reason=reason + also)

    def accounts_for_all(self, thresholds: Thresholds) -> bool:
        """Whether it leaves a healthy rig, to the share that no answer of the model is more exact than."""
        return self.excess <= thresholds.share and self.mass(unmodelled=False) >= thresholds.named

    @property
    def as_named(self) -> Decision:
        """The name it is if it holds."""
        name = self.group[0]
        return Decision(
            verdict="named", named=(name,), reason=f"{name} is part of every probable explanation"
        )

    @property
    def excess(self) -> float:
        """What it leaves of the whitened square beyond a healthy rig, over what it explains."""
        space = self.look.space
        left = space.chi_square - self.evidence.gain - len(space.residual)
        return max(left, 0.0) / max(self.evidence.gain, 1e-300)

    @property
    def at_bound(self) -> bool:
        """Whether the best size is the largest one the catalogue admits."""
        limits = bounds_of(self.evidence)
        return any(
            limit != 0.0 and abs(size.coordinate - limit) <= 1e-6 * abs(limit)
            for size, ends in zip(self.fit.sizes, limits, strict=True)
            for limit in ends
        )


def suspected(look: Look, proof: Proof, traces: Traces, calibration: Calibration) -> Suspicion | None:
    """The effect that every probable explanation of a look holds, if nothing speaks against it."""
    candidate = Suspicion.of(look, proof, traces, calibration)
    return None if candidate is None or objection(candidate, proof, calibration) else candidate


def objection(candidate: Suspicion, proof: Proof, calibration: Calibration) -> str:
    """What speaks against suspecting an effect; empty where nothing does."""
    one, look = candidate.evidence, candidate.look
    name, size = one.hypothesis.name, candidate.fit.coordinates[0]
    if one.gain <= SEEN**2:
        return "it is not seen"
    if len(candidate.group) > LARGEST_GROUP:
        return "too many effects leave its trace"
    if candidate.mass(unmodelled=True) < INCLUSION or candidate.mass(unmodelled=False) < CATALOGUE:
        return "other explanations are as probable"
    if candidate.excess > REMAINDER:
        return f"it leaves {candidate.excess:.0%} of what it explains"
    if text := too_little(look.residuals.effects, name, size):
        return text
    if candidate.at_bound:
        return "its best size is the largest one that is physical"
    kind = one.hypothesis.parts[0].split(":")[0]
    share = calibration.signature_error.get(kind, calibration.signature_error.get("", 0.0))
    features = look.residuals.features
    for what, groups in (
        ("channels", [feature.channel for feature in features]),
        ("operating points", [feature.setting for feature in features]),
    ):
        if agreement(look.space, one, groups, share) < AGREEMENT:
            return f"its size is not the same for all {what}"
    if candidate.gap is not None and not candidate.gap.shrunk and proof.seen(candidate.answer) > SEEN:
        return "it does not shrink the gap on the points held out"
    return ""


def agreement(space: Whitened, one: Evidence, groups: Sequence[Hashable], share: float) -> float:
    """Probability that groups of numbers ask for sizes as different as they do, if all are of one effect.

    Every group has its own factor on the answer at the best fit; all are fitted at once under the covariance of a
    healthy rig, which is inflated where they leave more than such a rig does. Each factor may be off by a share.

    groups : (n,) group of each number; share : relative error of the model's answer in a group
    """
    release = release_of(space, one.hypothesis.own)
    number = numbered(groups)
    answer = space.covariance.lower @ one.answer
    split = np.where(number[:, None] == np.arange(number.max() + 1), answer[:, None], 0.0)
    columns = space.covariance.whiten(split)
    columns = columns[:, np.linalg.norm(columns, axis=0) > FAINT]
    count = columns.shape[1]
    if count < 2:
        return 1.0
    residual = space.freed(one.hypothesis.own)
    gram, load = release.product(columns, columns), release.product(columns, residual)
    inverse = np.linalg.pinv(gram, hermitian=True)
    factors = inverse @ load
    left = float(release.product(residual, residual) - load @ factors) / max(len(residual) - count, 1)
    spread = inverse * max(left, 1.0) + share**2 * np.eye(count)
    weights = np.linalg.inv(spread)
    mean = float(weights.sum(axis=0) @ factors / weights.sum())
    apart = factors - mean
    return float(chi2.sf(apart @ weights @ apart, count - 1))


FAINT = 0.5
"""Whitened length of the answer in a group below which the group says nothing of its size."""

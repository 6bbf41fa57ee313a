"""From evidence to a verdict: a name, a group of aliases, or an honest refusal.

The order of the questions is that of the workflow's step 8. Thresholds are frozen with the calibration
(`rigdesign.diagnosis.decision.defaults`).
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Literal

import numpy as np
from scipy.special import logsumexp

from rigdesign.diagnosis.statistics.evidence import Evidence

Verdict = Literal[
    "named",
    "suspected",
    "alias_group",
    "unknown_located",
    "within_noise",
    "too_small",
    "input_error_suspected",
    "data_insufficient",
]

PRIOR = {
    "none": 0.50, "physical": 0.22, "sensor": 0.08, "local": 0.08, "unmodelled": 0.10, "pair": 0.10, "input": 0.03,
}  # fmt: skip
"""Prior weight of each family of explanations, split evenly among its members.

Heat that one thermometer alone feels is as likely as an error of that thermometer.
"""

UNNAMED = frozenset({"unmodelled", "local"})
"""Families of what is outside the catalogue."""


@dataclass(frozen=True, kw_only=True)
class Thresholds:
    """Numbers the verdict depends on.

    named : inclusion probability of a name; input : mass of input errors; catalogue : logarithm of the Bayes factor
    by which an explanation outside the catalogue may lead the best one within; misfit : standard deviations of the
    whitened square after the best fit above which nothing known fits, unless that is less than a share of the fall;
    group, one_trace : most members of an alias group, of any effects and of those that leave one trace; evidence,
    evidence_loop : logarithm of the Bayes factor against a healthy rig that each name of an explanation needs, in the
    heat and in orders and natural frequencies; support : fall of the whitened square that must be left of a name's
    explanation without the operating point that speaks for it most; share, share_loop : of the largest fall explained
    so far that this must be, as no answer of the model is more exact, in the heat and in orders and natural frequencies
    """

    named: float = 0.95
    input: float = 0.5
    catalogue: float = 5.0
    misfit: float = 5.0
    group: int = 3
    one_trace: int = 8
    evidence: float = 0.0
    evidence_loop: float = 0.0
    support: float = 12.0
    share: float = 0.05
    share_loop: float = 0.25

    def exceeds_healthy(self, one: Evidence, orders: frozenset[str]) -> bool:
        """Whether an explanation has more evidence than healthy rigs have given; ``orders``: causes of orders."""
        parts = frozenset(one.hypothesis.parts)
        floor = self.evidence if orders.isdisjoint(parts) else self.evidence_loop
        return one.log_bayes >= floor * len(parts)


@dataclass(frozen=True, kw_only=True)
class Posterior:
    """Masses of all hypotheses, nothing included.

    masses : by name of the hypothesis; inclusion : by part, over all hypotheses that claim it
    """

    masses: Mapping[str, float]
    inclusion: Mapping[str, float]
    families: Mapping[str, float]
    best: Evidence | None


@dataclass(frozen=True, kw_only=True)
class Decision:
    """The verdict with the parts it depends on.

    named : effects of a name, or the members of an alias group; reason : in one sentence; apart : names that hold
        whichever of the group is present; as_well : members of a further group, which one of is present as well
    elsewhere : what the numbers of the other domain say beyond a healthy rig, in words
    """

    verdict: Verdict
    named: tuple[str, ...]
    reason: str
    apart: tuple[str, ...] = ()
    as_well: tuple[str, ...] = ()
    elsewhere: str = ""


def posterior(
    evidence: Sequence[Evidence], members: Mapping[str, int], priors: Mapping[str, float] = PRIOR
) -> Posterior:
    """Masses from log Bayes factors and prior weights.

    members : how many explanations each family has, those that were not worth evaluating included: its prior weight
        is split evenly among them
    """
    logs = [float(np.log(priors["none"]))]
    logs += [
        one.log_bayes + float(np.log(priors[one.hypothesis.family] / members[one.hypothesis.family]))
        for one in evidence
    ]
    total = float(logsumexp(logs))
    masses = {"none": float(np.exp(logs[0] - total))}
    inclusion: dict[str, float] = {}
    families = {"none": masses["none"]}
    best, highest = None, logs[0]
    for one, log in zip(evidence, logs[1:], strict=True):
        mass = float(np.exp(log - total))
        masses[one.hypothesis.name] = mass
        families[one.hypothesis.family] = families.get(one.hypothesis.family, 0.0) + mass
        for part in dict.fromkeys(one.hypothesis.parts):
            inclusion[part] = inclusion.get(part, 0.0) + mass
        if log > highest:
            best, highest = one, log
    return Posterior(masses=masses, inclusion=inclusion, families=families, best=best)


RARE = 3.0
"""Standard deviations of the whitened square above that of a healthy rig up to which a residual is still called within
it: 6 of 108 healthy pairs and 1 of 108 healthy sets without a baseline leave more in a domain."""


@dataclass(frozen=True, kw_only=True)
class WhitenedSquare:
    """Whitened square of a residual and the number of readings in it."""

    value: float
    count: int

    @property
    def deviation(self) -> float:
        """Of the whitened square of a healthy rig."""
        return float((2.0 * self.count) ** 0.5)

    @property
    def rare(self) -> bool:
        """Whether few healthy rigs leave as much."""
        return self.value - self.count > RARE * self.deviation

    def misfit(self, gain: float, thresholds: Thresholds) -> str:
        """What an explanation leaves that takes ``gain`` away, in words; empty where nothing known leaves less."""
        left = self.value - gain - self.count
        if left <= max(thresholds.misfit * self.deviation, thresholds.share * gain):
            return ""
        return f"{left / self.deviation:.1f} standard deviations above that of a healthy rig"


@dataclass(frozen=True, kw_only=True)
class Candidates:
    """What a decision may name.

    effects : of catalogue and sensors, not the unmodelled causes
    detectable : effect -> whether these sensors could see it within its bounds at all
    orders : causes that show in orders and natural frequencies, unmodelled ones among them
    sensors : those that are errors of sensors and settings
    """

    effects: frozenset[str]
    detectable: Mapping[str, bool]
    orders: frozenset[str] = frozenset()
    sensors: frozenset[str] = frozenset()
    alike: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """Effect -> those that leave its trace in these numbers, itself left out."""
    one_oil: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """Unmodelled loss in an oil -> losses of the catalogue of which that oil takes most."""
    passed_over: frozenset[str] = frozenset()
    """Effects that were refused: part of an explanation they may be, a name they are not."""

    @property
    def open(self) -> frozenset[str]:
        """Effects that may be named."""
        return self.effects - self.passed_over

    def without(self, others: Iterable[str]) -> "Candidates":
        """With some more that are passed over."""
        return replace(self, passed_over=self.passed_over.union(others))


def decide(
    evidence: Sequence[Evidence],
    weights: Posterior,
    square: WhitenedSquare,
    candidates: Candidates,
    thresholds: Thresholds,
) -> Decision:
    """The verdict."""
    if weights.families.get("input", 0.0) > thresholds.input:
        named = _parts_of_family(evidence, weights, "input")
        return Decision(
            verdict="input_error_suspected",
            named=named,
            reason=f"the data agree with the model once {named[0]} is corrected",
        )
    best = weights.best
    if best is None:
        return _silent(weights, square, candidates, thresholds)
    if weights.masses["none"] < 0.5 and not thresholds.exceeds_healthy(best, candidates.orders):
        reason = "an effect may be present; healthy rigs have given as much evidence"
        return Decision(verdict="too_small", named=(), reason=reason)
    if misfit := square.misfit(best.gain, thresholds):
        return Decision(
            verdict="unknown_located", named=(), reason=f"after the best explanation the residual is {misfit}"
        )
    known = [one for one in evidence if _credible(one, evidence, candidates, thresholds)]
    leads = best.log_bayes - max((one.log_bayes for one in known), default=0.0)
    if weights.masses["none"] < 0.5 and leads > thresholds.catalogue:
        if losses := _losses_of_one_oil(evidence, weights, candidates, thresholds):
            return losses
        return Decision(
            verdict="unknown_located",
            named=(),
            reason="a cause outside the catalogue explains the data better than any effect of the catalogue",
        )
    candidates = candidates.without(
        sensor for sensor in candidates.sensors if _alone(sensor, evidence) < BY_ITSELF * best.gain
    )
    named = tuple(
        part
        for part, mass in sorted(weights.inclusion.items(), key=lambda item: -item[1])
        if part in candidates.open and mass >= thresholds.named
    )
    if named:
        return Decision(
            verdict="named", named=named, reason=f"{named[0]} is part of every probable explanation"
        )
    if weights.masses["none"] < 1.0 - thresholds.named:
        group = _smallest_group(evidence, weights, candidates.open, thresholds) or _group_of_one_trace(
            evidence, weights, candidates, thresholds
        )
        if group:
            return Decision(
                verdict="alias_group",
                named=group,
                reason="one of them is present; the data do not identify which",
            )
        if losses := _losses_of_one_oil(evidence, weights, candidates, thresholds):
            return losses
        return Decision(
            verdict="unknown_located",
            named=(),
            reason="no small group of effects of the catalogue accounts for it",
        )
    return _silent(weights, square, candidates, thresholds)


def _credible(
    one: Evidence, evidence: Sequence[Evidence], candidates: Candidates, thresholds: Thresholds
) -> bool:
    """Of the catalogue alone; an error of a sensor by itself or as a small rest, not to mend what something else
    leaves."""
    parts = frozenset(one.hypothesis.parts)
    if not parts <= candidates.effects:
        return False
    others = parts - candidates.sensors
    if len(parts) == 1 or others == parts:
        return True
    alone = max((other.gain for other in evidence if set(other.hypothesis.parts) == others), default=0.0)
    return one.gain - alone < thresholds.share * one.gain


BY_ITSELF = 0.7
"""Least share of what the best explanation takes away that an error of a sensor in it takes away alone, to be named:
two thermometers of one wall that are off together are rather a wall that is."""


def _alone(part: str, evidence: Sequence[Evidence]) -> float:
    """Largest fall of the whitened square by one part alone."""
    return max((one.gain for one in evidence if one.hypothesis.parts == (part,)), default=0.0)


def _smallest_group(
    evidence: Sequence[Evidence], weights: Posterior, effects: frozenset[str], thresholds: Thresholds
) -> tuple[str, ...]:
    """Smallest set of effects of which at least one is present at the required probability, the most probable of its
    size; empty if none is small."""
    parts = [
        part for part, _ in sorted(weights.inclusion.items(), key=lambda item: -item[1]) if part in effects
    ][:PROBABLE]
    for count in range(2, thresholds.group + 1):
        masses = {group: mass_of_any(evidence, weights, group) for group in combinations(parts, count)}
        best = max(masses, key=lambda group: masses[group], default=())
        if best and masses[best] >= thresholds.named:
            return best
    return ()


PROBABLE = 8
"""Effects of the largest inclusion probability among which a group is looked for."""


def _group_of_one_trace(
    evidence: Sequence[Evidence], weights: Posterior, candidates: Candidates, thresholds: Thresholds
) -> tuple[str, ...]:
    """The most probable effect with all that leave its trace, if at least one of them is present at the required
    probability; the most probable first, empty if they are not few."""
    known = {part: mass for part, mass in weights.inclusion.items() if part in candidates.open}
    if not known:
        return ()
    leader = max(known, key=lambda part: known[part])
    group = {leader, *(candidates.alike.get(leader, frozenset()) - candidates.passed_over)}
    if not 1 < len(group) <= thresholds.one_trace or mass_of_any(evidence, weights, group) < thresholds.named:
        return ()
    return tuple(sorted(group, key=lambda part: (-known.get(part, 0.0), part)))


def _losses_of_one_oil(
    evidence: Sequence[Evidence], weights: Posterior, candidates: Candidates, thresholds: Thresholds
) -> Decision | None:
    """The losses that one oil takes, where one of them or a loss there by another law is present.

    A law of speed and torque that no loss of the catalogue follows does not make it another cause: none is known that
    well. None where the best of them accounts for too little of what the law does.
    """
    by_oil: dict[frozenset[str], set[str]] = {}
    for cause, losses in candidates.one_oil.items():
        by_oil.setdefault(losses, set()).add(cause)
    for losses, causes in by_oil.items():
        known = [
            part for part in losses if part in candidates.open and weights.inclusion.get(part, 0.0) > 0.0
        ]
        first = max(known, key=lambda part: weights.inclusion[part], default="")
        best = max((_alone(part, evidence) for part in causes), default=0.0)
        if len(known) < 2 or _alone(first, evidence) < BY_LAW * best:
            continue
        if mass_of_any(evidence, weights, losses | causes) >= thresholds.named:
            group = tuple(sorted(known, key=lambda part: (-weights.inclusion[part], part)))
            reason = f"a loss in one oil; the data do not identify by its law which, {first} is the nearest"
            return Decision(verdict="alias_group", named=group, reason=reason)
    return None


BY_LAW = 0.8
"""Least share of what a loss by any law explains that the nearest loss of the catalogue explains."""


def mass_of_any(evidence: Sequence[Evidence], weights: Posterior, parts: Collection[str]) -> float:
    """Posterior mass of all explanations that hold at least one of some parts."""
    wanted = frozenset(parts)
    return sum(
        weights.masses[one.hypothesis.name] for one in evidence if not wanted.isdisjoint(one.hypothesis.parts)
    )


def _silent(
    weights: Posterior, square: WhitenedSquare, candidates: Candidates, thresholds: Thresholds
) -> Decision:
    """Why nothing is named."""
    if not any(candidates.detectable.values()):
        return Decision(
            verdict="data_insufficient",
            named=(),
            reason="no effect of the catalogue is detectable with these sensors and operating points",
        )
    if (square.value - square.count) / square.deviation > thresholds.misfit:
        return Decision(
            verdict="unknown_located",
            named=(),
            reason="the residual exceeds that of a healthy rig; no explanation fits",
        )
    likely_none = weights.best is None or weights.masses["none"] >= 0.5
    if likely_none and not square.rare:
        return Decision(
            verdict="within_noise", named=(), reason="the residual is within that of a healthy rig"
        )
    return Decision(
        verdict="too_small",
        named=(),
        reason="an effect may be present, too small to be distinguished from its rivals",
    )


def _parts_of_family(evidence: Sequence[Evidence], weights: Posterior, family: str) -> tuple[str, ...]:
    members = [one for one in evidence if one.hypothesis.family == family]
    best = max(members, key=lambda one: weights.masses[one.hypothesis.name])
    return best.hypothesis.parts

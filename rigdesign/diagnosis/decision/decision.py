"""From evidence to a verdict: a name, a group of aliases, or an honest refusal.

The order of the questions is that of the workflow's step 8. Thresholds are frozen with the calibration
(`rigdesign.diagnosis.decision.defaults`).
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import logsumexp

from rigdesign.diagnosis.decision.defaults import Candidates, Decision, Thresholds, WhitenedSquare
from rigdesign.diagnosis.decision.naming import in_words
from rigdesign.diagnosis.residual.hypotheses import ORDER_CAUSE, UNKNOWN
from rigdesign.diagnosis.statistics.evidence import Evidence

# Posterior masses of explanations from their evidence and prior weights.

PRIOR = {
    "none": 0.50, "physical": 0.22, "sensor": 0.08, "local": 0.08, "unmodelled": 0.10, "pair": 0.10, "input": 0.03,
}  # fmt: skip
"""Prior weight of each family of explanations, split evenly among its members.

Heat that one thermometer alone feels is as likely as an error of that thermometer.
"""


@dataclass(frozen=True, kw_only=True)
class Posterior:
    """Masses of all hypotheses, nothing included.

    masses : by name of the hypothesis; inclusion : by part, over all hypotheses that claim it
    """

    masses: Mapping[str, float]
    inclusion: Mapping[str, float]
    families: Mapping[str, float]
    best: Evidence | None


def posterior(
    evidence: Sequence[Evidence], members: Mapping[str, int], priors: Mapping[str, float] = PRIOR
) -> Posterior:
    """Masses from log Bayes factors and prior weights.

    members : how many explanations each family has, those that were not worth evaluating included: its prior weight
        is split evenly among them
    """
    logs = [float(np.log(priors["none"]))]
    logs += [
        explanation.log_bayes
        + float(np.log(priors[explanation.hypothesis.family] / members[explanation.hypothesis.family]))
        for explanation in evidence
    ]
    total = float(logsumexp(logs))
    masses = {"none": float(np.exp(logs[0] - total))}
    inclusion: dict[str, float] = {}
    families = {"none": masses["none"]}
    best, highest = None, logs[0]
    for explanation, log in zip(evidence, logs[1:], strict=True):
        mass = float(np.exp(log - total))
        masses[explanation.hypothesis.name] = mass
        families[explanation.hypothesis.family] = families.get(explanation.hypothesis.family, 0.0) + mass
        for part in dict.fromkeys(explanation.hypothesis.parts):
            inclusion[part] = inclusion.get(part, 0.0) + mass
        if log > highest:
            best, highest = explanation, log
    return Posterior(masses=masses, inclusion=inclusion, families=families, best=best)


def mass_of_any(evidence: Sequence[Evidence], weights: Posterior, parts: Collection[str]) -> float:
    """Posterior mass of all explanations that hold at least one of some parts."""
    wanted = frozenset(parts)
    return sum(
        weights.masses[explanation.hypothesis.name]
        for explanation in evidence
        if not wanted.isdisjoint(explanation.hypothesis.parts)
    )


def gain_of(parts: Collection[str], evidence: Sequence[Evidence]) -> float:
    """Largest fall of the whitened square by some parts with nothing beside them; zero without an explanation."""
    wanted = frozenset(parts)
    return max(
        (explanation.gain for explanation in evidence if wanted == frozenset(explanation.hypothesis.parts)),
        default=0.0,
    )


UNNAMED = frozenset({"unmodelled", "local"})
"""Families of what is outside the catalogue."""


def decide(
    evidence: Sequence[Evidence],
    weights: Posterior,
    square: WhitenedSquare,
    candidates: Candidates,
    thresholds: Thresholds,
) -> Decision:
    """The verdict."""
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
    known = [
        explanation for explanation in evidence if _credible(explanation, evidence, candidates, thresholds)
    ]
    leads = best.log_bayes - max((explanation.log_bayes for explanation in known), default=0.0)
    if weights.masses["none"] < 0.5 and leads > thresholds.catalogue:
        if losses := losses_of_one_oil(evidence, weights, candidates, thresholds):
            return losses
        return _beyond(evidence, known, candidates, thresholds)
    candidates = candidates.without(
        sensor for sensor in candidates.sensors if gain_of({sensor}, evidence) < BY_ITSELF * best.gain
    )
    named = tuple(
        part
        for part, mass in sorted(weights.inclusion.items(), key=lambda item: -item[1])
        if part in candidates.open and mass >= thresholds.named
    )
    if named:
        return _named(named, evidence, candidates, thresholds)
    if weights.masses["none"] < 1.0 - thresholds.named:
        group = smallest_group(evidence, weights, candidates.open, thresholds) or group_of_one_trace(
            evidence, weights, candidates, thresholds
        )
        if group:
            return Decision(
                verdict="alias_group",
                named=group,
                reason="one of them is present; the data do not identify which",
            )
        if losses := losses_of_one_oil(evidence, weights, candidates, thresholds):
            return losses
        return Decision(
            verdict="unknown_located",
            named=(),
            reason="no small group of effects of the catalogue accounts for it",
        )
    return _silent(weights, square, candidates, thresholds)


def _beyond(
    evidence: Sequence[Evidence], known: Sequence[Evidence], candidates: Candidates, thresholds: Thresholds
) -> Decision:
    """The verdict where what explains the data best is no effect of the catalogue alone; said of a cause outside only
    where that explains them better by itself."""
    by_itself = [
        explanation for explanation in evidence if candidates.effects.isdisjoint(explanation.hypothesis.parts)
    ]
    leads = max((explanation.log_bayes for explanation in by_itself), default=0.0)
    outside = (
        leads - max((explanation.log_bayes for explanation in known), default=0.0) > thresholds.catalogue
    )
    if outside:
        reason = "a cause outside the catalogue explains the data better than any effect of the catalogue"
    else:
        best = max(evidence, key=lambda explanation: explanation.log_bayes)
        both = (
            in_words(name.removeprefix(UNKNOWN), *sizes[:1]) if name.startswith(UNKNOWN) else name
            for name, sizes in best.members
        )
        reason = f"{' and '.join(both)} together explain the data better than either alone"
    return Decision(verdict="unknown_located", named=(), reason=reason, outside=outside)


def _named(
    named: tuple[str, ...], evidence: Sequence[Evidence], candidates: Candidates, thresholds: Thresholds
) -> Decision:
    """Names; a single one that changes the power circuit stands with all that it is not distinguished from."""
    only = named[0] if len(named) == 1 and named[0] in candidates.circuit else ""
    group = changes_of_the_circuit(only, evidence, candidates, thresholds) if only else ()
    if len(group) < 2:
        reason = f"{named[0]} is part of every probable explanation"
        return Decision(verdict="named", named=named, reason=reason)
    if len(group) > thresholds.one_trace:
        reason = f"{len(group)} changes of the power circuit explain the data about as well as {only}"
        return Decision(verdict="unknown_located", named=(), reason=reason)
    return Decision(
        verdict="alias_group",
        named=group,
        reason=f"a change of the power circuit; the data do not identify which, {group[0]} is the most probable",
    )


def _credible(
    explanation: Evidence, evidence: Sequence[Evidence], candidates: Candidates, thresholds: Thresholds
) -> bool:
    """Of the catalogue alone; an error of a sensor by itself or with a small share, not to mend what something else
    leaves.

    What the model answers wrongly to a change of the circuit stays as an order of no known source: with a small share
    it does not make the change a cause outside the catalogue.
    """
    parts = frozenset(explanation.hypothesis.parts)
    known = parts & candidates.effects
    unnamed = parts - known
    answered_wrongly = known <= candidates.circuit and all(part.startswith(ORDER_CAUSE) for part in unnamed)
    if not known or (unnamed and not answered_wrongly):
        return False
    others = known - candidates.sensors
    if len(parts) == 1 or others == parts:
        return True
    share = thresholds.share if known == parts else thresholds.share_loop
    return explanation.gain - gain_of(others, evidence) < share * explanation.gain


BY_ITSELF = 0.7
"""Least share of what the best explanation takes away that an error of a sensor in it takes away alone, to be named:
two thermometers of one wall that are off together are rather a wall that is."""


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
        reason="an effect may be present, too small to be distinguished from competing causes",
    )


# Groups of effects of which one is present and the data do not identify which.


def smallest_group(
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


def group_of_one_trace(
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


def changes_of_the_circuit(
    name: str, evidence: Sequence[Evidence], candidates: Candidates, thresholds: Thresholds
) -> tuple[str, ...]:
    """Changes of the power circuit that explain, alone, as much as a named one does, to the share that no answer of the
    model is more exact than; itself first, the others by what they explain."""
    gain = gain_of({name}, evidence)
    if gain <= 0.0:
        return (name,)
    least = (1.0 - thresholds.share_loop) * gain
    gains = {part: gain_of({part}, evidence) for part in (candidates.circuit & candidates.open) - {name}}
    others = sorted((part for part in gains if gains[part] >= least), key=lambda part: (-gains[part], part))
    return (name, *others)


def losses_of_one_oil(
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
        best = max((gain_of({part}, evidence) for part in causes), default=0.0)
        if len(known) < 2 or gain_of({first}, evidence) < BY_LAW * best:
            continue
        if mass_of_any(evidence, weights, losses | causes) >= thresholds.named:
            group = tuple(sorted(known, key=lambda part: (-weights.inclusion[part], part)))
            reason = f"a loss in one oil; the data do not identify by its law which, {first} is the nearest"
            return Decision(verdict="alias_group", named=group, reason=reason)
    return None


BY_LAW = 0.8
"""Least share of what a loss by any law explains that the nearest loss of the catalogue explains."""

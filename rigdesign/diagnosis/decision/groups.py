"""Groups of effects of which one is present and the data do not identify which."""

from collections.abc import Sequence
from itertools import combinations

from rigdesign.diagnosis.decision.posterior import Posterior, gain_of, mass_of_any
from rigdesign.diagnosis.decision.verdict import Candidates, Decision, Thresholds
from rigdesign.diagnosis.statistics.evidence import Evidence


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
    own = gain_of({name}, evidence)
    if own <= 0.0:
        return (name,)
    least = (1.0 - thresholds.share_loop) * own
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

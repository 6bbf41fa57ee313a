"""Posterior masses of explanations from their evidence and prior weights."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from rigdesign.diagnosis.statistics.evidence import Evidence

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


def mass_of_any(evidence: Sequence[Evidence], weights: Posterior, parts: Collection[str]) -> float:
    """Posterior mass of all explanations that hold at least one of some parts."""
    wanted = frozenset(parts)
    return sum(
        weights.masses[one.hypothesis.name] for one in evidence if not wanted.isdisjoint(one.hypothesis.parts)
    )


def gain_of(parts: Collection[str], evidence: Sequence[Evidence]) -> float:
    """Largest fall of the whitened square by some parts with nothing beside them; zero without an explanation."""
    wanted = frozenset(parts)
    return max((one.gain for one in evidence if wanted == frozenset(one.hypothesis.parts)), default=0.0)

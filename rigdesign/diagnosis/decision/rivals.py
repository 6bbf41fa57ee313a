"""What a further measurement has to tell apart, each explanation with its answer at all that could be read."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.posterior import mass_of_any
from rigdesign.diagnosis.decision.required import RequiredCause, required_causes
from rigdesign.diagnosis.decision.unmodelled_words import place_of
from rigdesign.diagnosis.decision.workflow import Diagnosis
from rigdesign.diagnosis.residual.hypotheses import physical, sensor
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.residual.unmodelled_cause import UNKNOWN, unmodelled_causes
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.detectability import ALIAS
from rigdesign.diagnosis.statistics.evidence import Evidence
from rigdesign.diagnosis.statistics.hypothesis import Hypothesis
from rigdesign.diagnosis.statistics.next_measurement import Rival
from rigdesign.diagnosis.statistics.required_size import straight

RIVALS = 3
"""Explanations that are to be separated."""
MOST_BEYOND = 3.0
"""Size over its bound up to which a cause counts as a rival where the data are too few."""


NAMEABLE = frozenset({"physical", "sensor"})


@dataclass(frozen=True, kw_only=True)
class Leading:
    """An explanation that a measurement has to tell from others; it stands for all of its kind at one place."""

    thing: str
    evidence: Evidence

    @property
    def name(self) -> str:
        """Of the explanation."""
        return self.evidence.hypothesis.parts[0]

    def ends(self, found: Diagnosis) -> bool:
        """Whether a diagnosis ends in it: named, or heat located at its place, as a cause in no catalogue is."""
        if self.evidence.hypothesis.family in NAMEABLE:
            return found.decision.verdict == "named" and self.name in found.named
        return found.decision.verdict == "unknown_located" and mass_at(found, self.thing) >= LOCATED


LOCATED = 0.95
"""Posterior mass of a place from which an effect in no catalogue is located there."""


def mass_at(found: Diagnosis, thing: str) -> float:
    """Posterior mass of all explanations with a cause at one place."""
    evaluation = found.deciding
    parts = {part for one in evaluation.evidence for part in one.hypothesis.parts if place_of(part) == thing}
    return mass_of_any(evaluation.evidence, evaluation.weights, parts)


def leading(found: Diagnosis) -> list[Leading]:
    """The likeliest single explanations of different things, the members of a group first.

    Where nothing in the catalogue explains the data, causes without a name count as well, all laws of heat at one place
    as one thing.
    """
    evaluation, group = found.evaluations[0], found.decision.named
    families = NAMEABLE | ({"unmodelled"} if found.decision.verdict == "unknown_located" else set())
    singles = [
        one
        for one in evaluation.evidence
        if one.hypothesis.family in families and len(one.hypothesis.parts) == 1
    ]
    ordered = sorted(singles, key=lambda one: -evaluation.weights.masses[one.hypothesis.name])
    best: dict[str, Leading] = {}
    for one in ordered:
        thing = place_of(one.hypothesis.parts[0])
        best.setdefault(thing, Leading(thing=thing, evidence=one))
    return sorted(best.values(), key=lambda one: one.thing not in group)[:RIVALS]


def rivals(whole: ResidualProblem, found: Diagnosis, explanations: Sequence[Leading]) -> list[Rival]:
    """The explanations at their best fit, at the numbers measured and at those that could be.

    whole : the numbers of the set followed by those that could be read
    """
    catalogue = [one.evidence for one in explanations if one.evidence.hypothesis.family in NAMEABLE]
    answers = _answers(whole, catalogue)
    unnamed = {name: columns for _, name, columns in unmodelled_causes(whole.library, whole.channels)}
    return [
        _rival(one.evidence, answers[one.evidence.hypothesis.name])
        if one.evidence in catalogue
        else _fitted(one.name, unnamed[one.name.removeprefix(UNKNOWN)], found)
        for one in explanations
    ]


def _answers(whole: ResidualProblem, rivals: Sequence[Evidence]) -> dict[str, Hypothesis]:
    """Of the rivals at all numbers, in the units of the features."""
    names = {one.hypothesis.name for one in rivals}
    effects = [one for one in whole.effects if any(f"{name}/".startswith(f"{one.name}/") for name in names)]
    everything = (
        *physical(None, whole.features, effects, whole.library.responses, whole.teeth_a_turn, 0.0),
        *sensor(None, [error for error in whole.errors if error.name in names]),
    )
    return {one.name: one for one in everything if one.name in names}


def _rival(one: Evidence, hypothesis: Hypothesis) -> Rival:
    sizes = np.array(one.coordinates)
    if hypothesis.curve is not None:
        answer, slopes = hypothesis.curve.at(sizes)[0], hypothesis.curve.sensitivity(float(sizes[0]))[:, None]
    else:
        assert hypothesis.columns is not None
        slopes = hypothesis.columns
        answer = slopes @ sizes
    return Rival(name=one.hypothesis.name, answer=answer, slopes=slopes, deviations=np.array(one.deviations))


def needed(whole: ResidualProblem, measured: int) -> list[Rival]:
    """With too few data: causes at the sizes at which each explains the residual, the least out of bounds first.

    The first one of a kind stands for all of it, and for others that leave the same trace in all that could be read.
    """
    causes = [one for one in required_causes(whole.rows(range(measured))) if _in_question(one)]
    found: dict[str, Rival] = {}
    for cause in sorted(causes, key=lambda one: (not one.within, one.size.reach if one.size else 0.0)):
        assert cause.size is not None and isinstance(cause.entry, Effect)
        if cause.entry.kind in found:
            continue
        response = whole.library.responses[cause.entry.name]
        sizes = np.array(cause.size.coordinates)
        if response.nonlinear:
            answer = straight(response.coordinates[:, 0], response.answers, float(sizes[0]))
        else:
            answer = response.sensitivity() @ sizes
        if all(_cosine(answer, one.answer) < ALIAS for one in found.values()):
            found[cause.entry.kind] = _at_one_size(cause.explanation, answer)
    return list(found.values())[:RIVALS]


def _in_question(cause: RequiredCause) -> bool:
    """Whether an effect could be what is looked for: near its bounds, and not the other way round than it can be."""
    if not cause.explains or cause.size is None or not isinstance(cause.entry, Effect):
        return False
    return cause.size.reach <= MOST_BEYOND and not cause.reversed


def _cosine(first: Array, second: Array) -> float:
    return float(abs(first @ second) / (np.linalg.norm(first) * np.linalg.norm(second)))


def nothing(whole: ResidualProblem) -> Rival:
    """That no effect is present: what a single explanation is to be told from."""
    return _at_one_size("none", np.zeros(len(whole.features)))


def _at_one_size(name: str, answer: Array) -> Rival:
    return Rival(name=name, answer=answer, slopes=np.zeros((len(answer), 0)), deviations=np.zeros(0))


def _fitted(name: str, columns: Array, found: Diagnosis) -> Rival:
    """A cause without a name, (n + m, k) columns, at the size that fits the residual (n,) best."""
    measured = found.covariance.whiten(columns[: len(found.residual)])
    basis, upper = np.linalg.qr(measured)
    slopes = columns @ np.linalg.inv(upper)
    sizes = basis.T @ found.covariance.whiten(found.residual)
    return Rival(name=name, answer=slopes @ sizes, slopes=slopes, deviations=np.ones(len(sizes)))

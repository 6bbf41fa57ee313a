"""What a further measurement has to tell apart, each explanation with its answer at all that could be read."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np
from scipy.linalg import solve_triangular

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.decision import UNNAMED
from rigdesign.diagnosis.decision.required import RequiredCause, required_causes
from rigdesign.diagnosis.decision.traces import NAMED
from rigdesign.diagnosis.decision.unmodelled_words import in_words, place_of
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

LOCATED = 0.95
"""Posterior mass that the places of a cause in no catalogue have to hold together."""


@dataclass(frozen=True, kw_only=True)
class Leading:
    """An explanation that a measurement has to distinguish from others.

    things : an effect, an error, or the places of a cause in no catalogue, whatever its law; evidence : of the best one
    size : of the cause in the most probable explanation that holds it
    """

    things: tuple[str, ...]
    evidence: Evidence
    size: float = 0.0

    @property
    def name(self) -> str:
        """Of the best explanation."""
        return self.evidence.hypothesis.parts[0]

    @property
    def unnamed(self) -> bool:
        """Whether no catalogue has it."""
        return self.evidence.hypothesis.family not in NAMED

    @property
    def in_words(self) -> str:
        """Of a cause in no catalogue."""
        return in_words(self.name.removeprefix(UNKNOWN), self.size)

    def ends(self, found: Diagnosis) -> bool:
        """Whether a diagnosis ends in it: named, or located at its places."""
        if not self.unnamed:
            return found.decision.verdict == "named" and self.name in found.named
        return found.decision.verdict == "unknown_located" and mass_at(found, self.things) >= LOCATED


def mass_at(found: Diagnosis, things: Collection[str]) -> float:
    """Posterior mass of all explanations that stand for one of some things."""
    evaluation = found.evaluations[0]
    return sum(
        evaluation.weights.masses[one.hypothesis.name]
        for one in evaluation.evidence
        if _stands_for(one.hypothesis) in things
    )


def _stands_for(hypothesis: Hypothesis) -> str:
    """The place of what no catalogue has, if an explanation holds such a cause, else its first part."""
    unnamed = [part for part in hypothesis.parts if part.startswith(UNKNOWN)]
    return place_of((*unnamed, *hypothesis.parts)[0])


def leading(found: Diagnosis) -> list[Leading]:
    """The likeliest single explanations of different things, the members of a group first.

    Where nothing in the catalogue explains the data: causes in no catalogue as well, as many as hold `LOCATED` of the
    posterior mass together, at most `RIVALS`; all of these where a single effect holds it that the data contradict.
    """
    if found.decision.verdict == "unknown_located":
        credible = _credible(found, LOCATED)
        return credible if len(credible) > 1 or credible_places(found) else _credible(found, inf)
    masses, group = found.evaluations[0].weights.inclusion, found.decision.named
    best = {
        one.hypothesis.parts[0]: Leading(things=one.hypothesis.parts, evidence=one)
        for one in reversed(_singles(found, NAMED))
    }
    ordered = sorted(best.items(), key=lambda item: (item[0] not in group, -masses.get(item[0], 0.0)))
    return [one for _, one in ordered][:RIVALS]


def _singles(found: Diagnosis, families: Collection[str]) -> list[Evidence]:
    return [
        one
        for one in found.evaluations[0].evidence
        if one.hypothesis.family in families and len(one.hypothesis.parts) == 1
    ]


def _credible(found: Diagnosis, least: float) -> list[Leading]:
    """As many of the likeliest as hold a posterior mass together."""
    weights = found.evaluations[0].weights
    singles = sorted(_singles(found, NAMED | UNNAMED), key=lambda one: weights.masses[one.hypothesis.name])
    best = {_stands_for(one.hypothesis): one for one in singles}
    masses = {thing: mass_at(found, [thing]) for thing in best}
    chosen: list[Leading] = []
    held = 0.0
    for thing in sorted(masses, key=lambda one: -masses[one])[:RIVALS]:
        if held >= least:
            break
        chosen.append(Leading(things=(thing,), evidence=best[thing], size=_size(found, thing)))
        held += masses[thing]
    return chosen


def _size(found: Diagnosis, thing: str) -> float:
    """Of what is at a place, in the most probable explanation that holds it."""
    weights = found.evaluations[0].weights
    holding = [one for one in found.evaluations[0].evidence if _stands_for(one.hypothesis) == thing]
    most = max(holding, key=lambda one: weights.masses[one.hypothesis.name])
    return next((sizes[0] for name, sizes in most.members if place_of(name) == thing and sizes), 0.0)


def credible_places(found: Diagnosis) -> list[Leading]:
    """The places of a cause in no catalogue, the likeliest first; none where they do not hold `LOCATED` together."""
    if not found.decision.outside:
        return []
    places = _credible(found, LOCATED)
    held = mass_at(found, [thing for one in places for thing in one.things])
    return places if held >= LOCATED and all(one.unnamed for one in places) else []


@dataclass(frozen=True, kw_only=True)
class Compared:
    """An explanation with what it foresees."""

    leading: Leading
    rival: Rival


def compared(
    whole: ResidualProblem, found: Diagnosis, explanations: Sequence[Leading], matrix: Array
) -> list[Compared]:
    """The explanations at their best fit, at the numbers measured and at those that could be.

    Causes in no catalogue that leave one trace in all that could be read are one: nothing tells them apart.

    whole : the numbers of the set followed by those that could be read; matrix : covariance of a healthy rig in them
    """
    answers = _answers(whole, [one.evidence for one in explanations if not one.unnamed])
    unnamed = {name: columns for _, name, columns in unmodelled_causes(whole.library, whole.channels)}
    factor = np.linalg.cholesky(matrix)
    found_so_far: list[tuple[Compared, Array]] = []
    for one in explanations:
        rival = (
            _fitted(one.name, unnamed[one.name.removeprefix(UNKNOWN)], found)
            if one.unnamed
            else _rival(one.evidence, answers[one.evidence.hypothesis.name])
        )
        trace = np.asarray(solve_triangular(factor, rival.answer, lower=True))
        for place, (other, seen) in enumerate(found_so_far):
            if one.unnamed and other.leading.unnamed and _cosine(trace, seen) >= ALIAS:
                joined = replace(other.leading, things=(*other.leading.things, *one.things))
                found_so_far[place] = replace(other, leading=joined), seen
                break
        else:
            found_so_far.append((Compared(leading=one, rival=rival), trace))
    return [one for one, _ in found_so_far]


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
    """That no effect is present: what a single explanation is to be distinguished from."""
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

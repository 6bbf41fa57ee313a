"""What may be claimed of the effects that a search has found.

A name is given if its size matters, if it shrinks the gap on the points held out by more than the scatter of that
(`rigdesign.diagnosis.statistics.heldout`), and if no other effect leaves the same trace; the case with all names in
it, run in full, has to shrink the gap as well; where it does not run, names are not confirmed. What does not hold is
reported with its reason.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import hypot

import numpy as np
from scipy.linalg import solve_triangular
from scipy.stats import chi2

from rigdesign.base.errors import RigdesignError
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.cross_validation import Proof, Sizes
from rigdesign.diagnosis.decision.defaults import Decision, Thresholds, Verdict, WhitenedSquare
from rigdesign.diagnosis.decision.naming import Names, display_scale
from rigdesign.diagnosis.statistics.columns import Array, numbered
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import ALIAS, REACHES, SEEN
from rigdesign.diagnosis.statistics.evidence import JOIN, Evidence, Hypothesis, JointFit, release_of
from rigdesign.diagnosis.statistics.heldout import LEAST_POINTS, Gap, gap_in_words

# What single effects and sensor errors leave in the numbers, and which of them leave the same.

NAMED = frozenset({"physical", "sensor"})
"""Families of what has a name."""

SIZES = 13
"""Sizes over the bounds of a curve at which its answer is held against a trace."""


@dataclass(frozen=True, kw_only=True)
class Traces:
    """What single effects and sensor errors leave in the numbers they were sought in.

    space : of the first look; explanations : of that look; assembly : (n,) how the rig was put together at the point of
        each number
    contradicted : explanations that the other domain contradicts in that look; with a name in the model it may not
    """

    space: Whitened
    explanations: Sequence[Evidence]
    assembly: Sequence[object]
    contradicted: Sequence[Evidence] = ()

    def like(
        self, explanation: str, size: Sequence[float], families: frozenset[str] = NAMED
    ) -> list[tuple[str, float]]:
        """Causes of some families whose trace correlates with that of a name above `ALIAS`, those most alike first.

        The trace of a name is its whitened answer at its size. It is held against the answers of every other one over
        its bounds, of two parameters against the plane they span, under the covariance of the data. Where the rig was
        put together otherwise at some points, to tell such effects apart, they are alike only if they also are with the
        trace counting as much in each assembly: one may be read far more exactly than the other. What within its bounds
        leaves less than `REACHES` of the trace cannot stand for it; offset and scale of one sensor are one finding.
        """
        named = next(evidence for evidence in self._own if evidence.hypothesis.name == explanation)
        name = named.hypothesis.parts[0]
        trace = _answers(named.hypothesis, np.array([size]))[0]
        correlations: dict[str, float] = {}
        for evidence in self._single(families):
            other = evidence.hypothesis.parts[0]
            if other == name or _of_one_sensor(named, evidence):
                continue
            for plane in _planes(evidence.hypothesis, trace):
                correlation = _cosine(plane, trace)
                if correlation > ALIAS and _cosine(*self._by_assembly(plane, trace)) > ALIAS:
                    correlations[other] = max(correlations.get(other, 0.0), correlation)
        return sorted(correlations.items(), key=lambda pair: -pair[1])

    def of(self, name: str) -> Evidence:
        """The best explanation by a name alone."""
        return next(evidence for evidence in self._own if evidence.hypothesis.parts == (name,))

    @property
    def _own(self) -> list[Evidence]:
        return [*self._single(NAMED), *self.contradicted]

    def _single(self, families: frozenset[str]) -> list[Evidence]:
        return [evidence for evidence in self.explanations if evidence.hypothesis.family in families]

    def _by_assembly(self, plane: Array, trace: Array) -> tuple[Array, Array]:
        """Columns (n, k) and a trace (n,), scaled so that no assembly in which the trace is seen outweighs another."""
        states = list(dict.fromkeys(self.assembly))
        if len(states) == 1:
            return plane, trace
        lower, matrix = self.space.covariance.lower, self.space.covariance.matrix
        both = lower @ np.column_stack([plane, trace])
        for state in states:
            rows = np.array([row for row, assembly in enumerate(self.assembly) if assembly == state])
            factor = np.linalg.cholesky(matrix[np.ix_(rows, rows)])
            white = solve_triangular(factor, both[rows], lower=True, check_finite=False)
            both[rows] = white / max(1.0, float(np.linalg.norm(white[:, -1])) / SEEN)
        return both[:, :-1], both[:, -1]


def _answers(hypothesis: Hypothesis, sizes: Array) -> Array:
    """(m, n) whitened answers at sizes (m, k)."""
    if hypothesis.curve is not None:
        return hypothesis.curve.at(sizes[:, 0])
    return np.asarray(sizes @ hypothesis.columns.T)


def _planes(hypothesis: Hypothesis, trace: Array) -> list[Array]:
    """Columns (n, k) of what may stand for a trace (n,): a curve at sizes over its bounds, a plane as it is."""
    least = REACHES * float(trace @ trace)
    if hypothesis.curve is None:
        reach = hypothesis.half * float(np.linalg.norm(hypothesis.columns.T @ trace))
        return [hypothesis.columns] if reach >= least else []
    sizes = np.linspace(*hypothesis.curve.bounds, SIZES)[:, None]
    return [answer[:, None] for answer in _answers(hypothesis, sizes) if answer @ trace >= least]


def _of_one_sensor(first: Evidence, second: Evidence) -> bool:
    """Whether two explanations are errors of the same sensor or setting."""
    if {first.hypothesis.family, second.hypothesis.family} != {"sensor"}:
        return False
    kinds, places = zip(
        *(evidence.hypothesis.parts[0].partition(":")[::2] for evidence in (first, second)), strict=True
    )
    return len({kind.rpartition("_")[0] for kind in kinds}) == len(set(places)) == 1


def _cosine(plane: Array, trace: Array) -> float:
    """Between a trace (n,) and what columns (n, k) span."""
    return float(np.linalg.norm(np.linalg.qr(plane)[0].T @ trace) / np.linalg.norm(trace))


# Whether all channels, and all operating points, ask for the same size of an effect.
#
# What is one-sided, local or grows otherwise over the speed is something else that the effect is fitted to: a leak on
# one side is no leak on both. A cause that goes with the effect in the best explanation is in the model meanwhile.

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
        self, evidence: Evidence, beside: Sequence[Evidence], least: float, admitted: float = 0.0
    ) -> str:
        """What disagrees on the size of an effect, in words; empty where nothing does.

        beside : causes that are in the model with sizes of their own; least : probability of sizes that differ as
            much, below which they are of different things; admitted : least relative error of the answer in a group
        """
        kind = evidence.hypothesis.parts[0].split(":")[0].split("/")[0]
        share = max(self.errors.get(kind, self.errors.get("", 0.0)), admitted)
        for grouping, groups in (
            ("channels", self.channels),
            ("operating points", self.points),
        ):
            if agreement(self.space, evidence, groups, share, beside) < least:
                return f"its size is not the same for all {grouping}"
        return ""

    def companion(self, evidence: Evidence) -> Evidence | None:
        """The cause that goes with an effect in the best explanation that holds it.

        None where that holds the effect alone, or where the cause takes too much of it away.
        """
        name = evidence.hypothesis.name
        for best in self.evidence:
            names = best.hypothesis.name.split(JOIN)
            if name in names:
                names.remove(name)
                break
        else:
            return None
        companion = next((other for other in self.evidence if [other.hypothesis.name] == names), None)
        if companion is None or best.gain - companion.gain < APART * evidence.gain:
            return None
        return companion


def agreement(
    space: Whitened,
    evidence: Evidence,
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
    effects = tuple(name for cause in (evidence, *beside) for name in cause.hypothesis.own)
    release = release_of(space, effects)
    number = numbered(groups)
    answer = space.covariance.lower @ evidence.answer
    split = np.where(number[:, None] == np.arange(number.max() + 1), answer[:, None], 0.0)
    columns = space.covariance.whiten(split)
    columns = columns[:, np.linalg.norm(columns, axis=0) > FAINT]
    count = columns.shape[1]
    if count < 2:
        return 1.0
    columns = np.hstack([columns, *(cause.columns for cause in beside)])
    residual = space.freed(effects)
    gram, load = release.product(columns, columns), release.product(columns, residual)
    inverse = np.linalg.pinv(gram, hermitian=True)
    fit = inverse @ load
    left = float(release.product(residual, residual) - load @ fit) / max(len(residual) - len(fit), 1)
    factors, spread = fit[:count], inverse[:count, :count] * max(left, 1.0) + share**2 * np.eye(count)
    weights = np.linalg.inv(spread)
    mean = float(weights.sum(axis=0) @ factors / weights.sum())
    apart = factors - mean
    return float(chi2.sf(apart @ weights @ apart, count - 1))


@dataclass(frozen=True, kw_only=True)
class Refusal:
    """A name that the search gave and that is not claimed.

    name : of the entry; explanation : with tooth or order; coordinates : its fitted size; verdict : where it was the
        only name; gap : without and with it on the points held out, None where none were or where its size was enough
        to refuse it
    """

    name: str
    explanation: str
    coordinates: tuple[float, ...]
    verdict: Verdict
    reason: str
    gap: Gap | None

    @property
    def slight(self) -> bool:
        """Whether it is refused for its size alone."""
        return self.verdict == "too_small" and self.gap is None


@dataclass(frozen=True, kw_only=True)
class Claim:
    """What is left of the names, and why the others are gone.

    found : of names, with the leader of a group apart from which they hold; fit : of these together; fits : member of
        such a group -> the fit with it in the place of the leader; answer : (n,) of what was fitted, at all kept
        numbers, zero without any; gap : with it, None without points held out
    """

    decision: Decision
    found: tuple[Evidence, ...]
    fit: JointFit | None
    fits: Mapping[str, JointFit]
    answer: Array
    gap: Gap | None
    refused: tuple[Refusal, ...]
    unconfirmed: str = ""
    """Why the full model confirms no name, so that answer and gap are those of the stored runs."""

    @property
    def insignificant(self) -> bool:
        """Whether all names that the search gave are too small to matter."""
        return bool(self.refused) and all(refusal.slight for refusal in self.refused)

    @property
    def contradicted(self) -> bool:
        """Whether the data or the full model speak against a name that the search gave."""
        return any(refusal.verdict == "unknown_located" for refusal in self.refused)


def claim(
    decision: Decision,
    explanations: Sequence[Evidence],
    traces: Traces,
    proof: Proof,
    fitted: Callable[[Sequence[Evidence]], JointFit],
    thresholds: Thresholds,
    agreement: Agreement,
) -> Claim:
    """Hold the names of a decision against their sizes, the points held out and all other effects.

    explanations : of every name; traces : of all in the first look; fitted : the joint fit of some
    agreement : of channels and operating points on sizes
    """
    refused: list[Refusal] = []
    if decision.verdict == "alias_group":
        leader = traces.of(decision.named[0])
        if text := _disagreement(leader, [], agreement):
            reason = f"{leader.hypothesis.name} fits best, but {text}"
            decision = Decision(verdict="unknown_located", named=(), reason=reason)
    if decision.verdict != "named":
        return _without(decision, proof, refused)
    left = list(explanations)
    while left:
        fit = fitted(left)
        doubt = _weakest(left, fit, proof) or _disputed(left, fit, agreement)
        if doubt is None:
            break
        refused.append(doubt)
        left = [evidence for evidence in left if evidence.hypothesis.name != doubt.explanation]
    if not left:
        return _without(_unclaimed(decision, refused), proof, refused)
    slight = any(refusal.slight for refusal in refused)
    if slight and (misfit := _misfit(traces.space, left, fit, thresholds)):
        refused += [_misfitting(evidence, _sizes(left, fit), misfit) for evidence in left]
        return _without(_unclaimed(decision, refused), proof, refused)
    sizes = _sizes(left, fit)
    group = _group(left, sizes, traces)
    if group is not None and not group.apart:
        return _without(group, proof, refused)
    unconfirmed = ""
    try:
        answer = proof.again(sizes)
    except RigdesignError as error:  # a solver that gives up is no evidence, in either direction
        answer = proof.stored(sizes)
        unconfirmed = f"the case with {' and '.join(sizes)} does not run in full: {error}"
    whole = proof.gap(answer)
    if not whole.shrunk:
        refused += [_unproven(evidence, sizes, whole) for evidence in left]
        return _without(_unclaimed(decision, refused), proof, refused)
    named = tuple(dict.fromkeys(part for evidence in left for part in evidence.hypothesis.parts))
    fits: dict[str, JointFit] = {}
    if group is not None:
        others = [evidence for evidence in left if evidence.hypothesis.parts[0] in group.apart]
        fits = {member: fitted([*others, traces.of(member)]) for member in group.named}
    return Claim(
        decision=group or replace(decision, named=named),
        found=tuple(left),
        fit=fit,
        fits=fits,
        answer=answer,
        gap=whole,
        refused=tuple(refused),
        unconfirmed=unconfirmed,
    )


def withdrawn(claimed: Claim, proof: Proof, reason: str) -> Claim:
    """A claim that is given up."""
    decision = Decision(verdict="unknown_located", named=(), reason=reason)
    return _without(decision, proof, claimed.refused)


def refusals(explanations: Sequence[Evidence], fit: JointFit, reason: str) -> tuple[Refusal, ...]:
    """Of names that other numbers overrule."""
    sizes = _sizes(explanations, fit)
    return tuple(_refusal(evidence, sizes, "unknown_located", reason) for evidence in explanations)


def _without(decision: Decision, proof: Proof, refused: Sequence[Refusal]) -> Claim:
    """No names."""
    nothing = np.zeros(len(proof.residuals.features))
    return Claim(
        decision=decision,
        found=(),
        fit=None,
        fits={},
        answer=nothing,
        gap=proof.gap(nothing) if proof.points else None,
        refused=tuple(refused),
    )


def _sizes(explanations: Sequence[Evidence], fit: JointFit) -> Sizes:
    return {
        evidence.hypothesis.name: size for evidence, size in zip(explanations, fit.coordinates, strict=True)
    }


def _refusal(
    evidence: Evidence, sizes: Sizes, verdict: Verdict, reason: str, gap: Gap | None = None
) -> Refusal:
    name = evidence.hypothesis.name
    return Refusal(
        name=evidence.hypothesis.parts[0],
        explanation=name,
        coordinates=sizes[name],
        verdict=verdict,
        reason=reason,
        gap=gap,
    )


def _unproven(evidence: Evidence, sizes: Sizes, whole: Gap) -> Refusal:
    """Of a name that does not shrink the gap by more than its scatter, or with others does not."""
    reason = f"with {evidence.hypothesis.name} in the model the gap {gap_in_words(whole)}"
    return _refusal(evidence, sizes, "unknown_located" if whole.grown else "too_small", reason, whole)


def _misfit(space: Whitened, left: Sequence[Evidence], fit: JointFit, thresholds: Thresholds) -> str:
    """What the names that are left do not explain without those of a slight size, in words; empty where that is
    little."""
    effects = [effect for evidence in left for effect in evidence.hypothesis.own]
    release, rest = release_of(space, effects), space.freed(effects) - fit.answer
    square = WhitenedSquare(value=space.chi_square, count=len(rest))
    return square.misfit(space.chi_square - float(release.product(rest, rest)), thresholds)


def _misfitting(evidence: Evidence, sizes: Sizes, misfit: str) -> Refusal:
    """Of a name that leaves too much without those that were refused."""
    reason = f"after {evidence.hypothesis.name} alone the residual is {misfit}"
    return _refusal(evidence, sizes, "unknown_located", reason)


def _weakest(explanations: Sequence[Evidence], fit: JointFit, proof: Proof) -> Refusal | None:
    """The first name too small to matter, else that of those not proven which shrinks the gap least; None if all hold.

    Each is proven by itself, with the others in the model: by the stored runs.
    """
    sizes = _sizes(explanations, fit)
    for evidence in explanations:
        if text := too_little(
            proof.residuals.effects, evidence.hypothesis.name, sizes[evidence.hypothesis.name]
        ):
            return _refusal(evidence, sizes, "too_small", text)
    if not proof.points:
        running = len(proof.residuals.library.settings)
        text = f"none of {running} operating points could be held out to verify it; at least {LEAST_POINTS} are needed"
        reason = f"{explanations[0].hypothesis.name} fits best, but {text}"
        return _refusal(explanations[0], sizes, "data_insufficient", reason)
    gaps = []
    for evidence in explanations:
        name = evidence.hypothesis.name
        others = proof.stored({other: size for other, size in sizes.items() if other != name})
        gaps.append(proof.gap(proof.stored({name: sizes[name]}), others))
    least = min(
        range(len(explanations)), key=lambda place: gaps[place].fall / max(gaps[place].scatter, 1e-300)
    )
    if gaps[least].shrunk:
        return None
    return _unproven(explanations[least], sizes, gaps[least])


UNEQUAL = 0.35
"""Error of the answer in one channel, or at one point, over that in the others, which a name may have: a leak warms the
end walls of the virtual rig half as much as the model says, and the oil half as much again."""

DISAGREEMENT = 1e-6
"""Probability of sizes that differ as much between channels, or between points, below which no name is given."""


def _disputed(explanations: Sequence[Evidence], fit: JointFit, agreement: Agreement) -> Refusal | None:
    """The first name that channels or operating points want in different sizes; None if they agree on all."""
    for evidence in explanations:
        if text := _disagreement(
            evidence, [other for other in explanations if other is not evidence], agreement
        ):
            return _refusal(
                evidence,
                _sizes(explanations, fit),
                "unknown_located",
                f"{evidence.hypothesis.name} fits best, but {text}",
            )
    return None


def _disagreement(evidence: Evidence, others: Sequence[Evidence], agreement: Agreement) -> str:
    companion = agreement.companion(evidence)
    names = {other.hypothesis.name for other in others}
    beside = [*others, *([] if companion is None or companion.hypothesis.name in names else [companion])]
    return agreement.objection(evidence, beside, DISAGREEMENT, UNEQUAL)


def too_little(effects: Sequence[Effect], explanation: str, coordinates: Sequence[float]) -> str:
    """Why an effect of this size does not matter; empty where it does."""
    known = Names(effects, ()).entry(explanation)
    if known is None or not isinstance(known[0], Effect) or hypot(*coordinates) >= known[0].matters:
        return ""
    effect = known[0]
    scale, unit = display_scale(effect.parameters[0].unit, effect.parameters[0].factor)
    size, least = (f"{scale * value:.3g} {unit}".rstrip() for value in (hypot(*coordinates), effect.matters))
    return f"{explanation} fits best with {size}; below {least} it is not significant"


def _unclaimed(decision: Decision, refused: Sequence[Refusal]) -> Decision:
    """The verdict where no name is left: that of one that was contradicted, else of the last one."""
    if not refused:
        reason = f"{decision.named[0]} is part of every probable explanation, but of none alone"
        return Decision(verdict="unknown_located", named=(), reason=reason)
    worst = next((refusal for refusal in refused if refusal.verdict == "unknown_located"), refused[-1])
    return Decision(verdict=worst.verdict, named=(), reason=worst.reason)


def _group(explanations: Sequence[Evidence], sizes: Sizes, traces: Traces) -> Decision | None:
    """The verdict where another effect has the signature of a name; None where every name stands alone.

    The group is that of the first such name; the reason names those of further ones.
    """
    rivals = {
        evidence.hypothesis.parts[0]: traces.like(evidence.hypothesis.name, sizes[evidence.hypothesis.name])
        for evidence in explanations
    }
    unclear = [name for name, others in rivals.items() if others]
    if not unclear:
        return None
    reasons = [
        f"{rivals[name][0][0]} has the signature of {name}, correlation {rivals[name][0][1]:.3f}"
        for name in unclear
    ]
    group = (unclear[0], *(other for other, _ in rivals[unclear[0]]))
    return Decision(
        verdict="alias_group",
        named=group,
        reason="; ".join(reasons),
        apart=tuple(name for name in rivals if name not in unclear and name not in group),
    )

"""The workflow of a diagnosis on numbers: from readings and library to a verdict with its proof.

readings -> single outliers out -> points held out -> evidence -> verdict, again for what is left
         -> joint fit with intervals -> what may be claimed -> alternatives
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import Literal

import numpy as np

from rigdesign.base.errors import RigdesignError
from rigdesign.diagnosis.decision.claims import Claim, Refusal, refusals
from rigdesign.diagnosis.decision.cross_validation import Problem, Proof, Rerun, Tier
from rigdesign.diagnosis.decision.decision import mass_of_any, posterior
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration, Decision
from rigdesign.diagnosis.decision.held_out_data import SURE, WORDS, Numbers, Suspicion, suspected
from rigdesign.diagnosis.decision.search import Evaluation, Look, explanations_of, signature_of
from rigdesign.diagnosis.residual.healthy import Contest
from rigdesign.diagnosis.residual.hypotheses import data_error
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, outliers_of
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.detectability import Detectability
from rigdesign.diagnosis.statistics.evidence import Evidence, JointFit, evaluate_hypothesis
from rigdesign.diagnosis.statistics.heldout import Gap, held_out

LEAST_RUNNING_POINTS = 3
"""Operating points below which nothing is named."""


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """An explanation that was evaluated, with its posterior mass."""

    name: str
    parts: tuple[str, ...]
    posterior: float
    gain: float
    coordinates: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    """What the data say.

    strength : proven where the gap shrinks by more than its scatter with the named effects in the model, run in full,
        and the noise is known from repeats; named : names, or members of an alias group; fit : of named effects;
        fits : member of a group -> the fit of it with the names apart from the group; gap : on the points held out;
        refused : names that the search gave and that are not claimed; rejected : outliers with their feature
    """

    decision: Decision
    strength: Literal["proven", "indicative"]
    named: tuple[str, ...]
    found: tuple[Evidence, ...]
    fit: JointFit | None
    fits: Mapping[str, JointFit]
    gap: Gap | None
    refused: tuple[Refusal, ...]
    unconfirmed: str
    """Why the full model confirms no name; empty where it was run."""
    alternatives: tuple[Alternative, ...]
    detectability: tuple[Detectability, ...]
    aliases: tuple[tuple[str, str, float], ...]
    suspicion: Suspicion | None
    """An effect that is probable and not named."""
    rejected: tuple[tuple[int, float], ...]
    held_out_points: tuple[str, ...]
    tier: Tier
    """Numbers that the verdict depends on; of names in both domains those of the first."""
    deciding: Evaluation = field(repr=False)
    """The look that the verdict depends on: the first one, or that at all points at once where the data are wrong."""
    evaluations: tuple[Evaluation, ...] = field(repr=False)
    covariance: Covariance = field(repr=False)
    """Of all numbers that were kept, held-out ones included."""
    proof: Proof = field(repr=False)
    """What names were held against."""
    answer: Array = field(repr=False)
    """(n,) what the named effects add to the prediction, in the units of the features; at points held out by the full
    model."""
    kept: tuple[int, ...] = field(repr=False)
    """Rows of the residuals that were kept."""
    residual: Array = field(repr=False)
    """(n,) what was to be explained at the kept rows: against the model, or given the baseline."""

    @property
    def whitened_square(self) -> float:
        """Of the numbers that were kept, held-out ones included; their count in the mean of healthy rigs."""
        white = self.covariance.whiten(self.residual)
        return float(white @ white)


def diagnose(problem: Problem, calibration: Calibration = DEFAULT, rerun: Rerun | None = None) -> Diagnosis:
    """Find what the model lacks, or say that these data cannot tell.

    rerun : the full model with named effects in it; without one the proof is left at the stored runs, and indicative
    """
    everything = problem.space(calibration)
    outliers = outliers_of(problem.residuals, everything)
    gone = {outlier.place for outlier in outliers}
    kept = [row for row in range(len(problem.residuals.features)) if row not in gone]
    residuals = problem.residuals.rows(kept)
    whole = problem.cut(everything, residuals, kept, calibration) if gone else everything
    points = held_out([setting.name for setting in residuals.library.settings], problem.seed)
    numbers = Numbers(
        problem=problem, residuals=residuals, whole=whole, points=points, calibration=calibration, rerun=rerun
    )
    refused = _refused(residuals)
    looked_at = (residuals, whole) if problem.baseline is None else (problem.residuals, everything)
    wrong = None if refused else _wrong_data(problem, *looked_at, calibration)
    finding = found_in(numbers, refused or (None if wrong is None else wrong.decision))
    claimed, suspicion = finding.claimed, finding.suspicion
    deciding = wrong or finding.look.first
    shrunk = claimed.gap is not None and claimed.gap.shrunk
    confirmed = rerun is not None and not claimed.unconfirmed
    proven = claimed.decision.verdict == "named" and shrunk and confirmed
    return Diagnosis(
        decision=finding.decision,
        strength="proven" if problem.repeated and proven else "indicative",
        named=finding.decision.named,
        found=claimed.found,
        fit=claimed.fit,
        fits=claimed.fits,
        gap=claimed.gap,
        suspicion=suspicion,
        refused=claimed.refused,
        unconfirmed=claimed.unconfirmed,
        alternatives=_alternatives(deciding),
        detectability=numbers.detectability,
        aliases=numbers.aliases,
        rejected=tuple((outlier.place, outlier.deviation) for outlier in outliers),
        held_out_points=points,
        tier=finding.look.tier,
        evaluations=finding.evaluations,
        deciding=deciding,
        covariance=whole.covariance,
        proof=numbers.proof(finding.tier),
        answer=claimed.answer,
        kept=tuple(kept),
        residual=whole.raw,
    )


def _refused(residuals: ResidualProblem) -> Decision | None:
    """Too little to name anything from, whatever the numbers say."""
    points = {feature.setting for feature in residuals.features if feature.setting}
    if len(points) >= LEAST_RUNNING_POINTS:
        return None
    return Decision(
        verdict="data_insufficient",
        named=(),
        reason=f"operating points: {len(points)}, at least {LEAST_RUNNING_POINTS} are needed to separate effects",
    )


def _wrong_data(
    problem: Problem, residuals: ResidualProblem, whole: Whitened, calibration: Calibration
) -> Evaluation | None:
    """A look at all data together, if they fit once something in them is undone; no effect is looked for.

    Held-out points are included, as an exchange with one of them would not show in the others. With a baseline so is
    what stands out: of exchanged readings that are the only ones of their channels nothing else is left. Without one
    it may be the model that is out.
    """
    everything = explanations_of(residuals, whole, rivals=False)
    data = data_error(
        whole.covariance,
        residuals.features,
        residuals.channels,
        residuals.values,
        residuals.values - whole.raw,
        met_before=problem.baseline is not None,
    )
    singles = (*everything.physical, *everything.sensor, *data)
    contest = Contest(whole, signature_of(problem, residuals, calibration))
    evaluated = contest.evaluated([evaluate_hypothesis(whole, hypothesis) for hypothesis in singles])
    evidence = sorted(evaluated, key=lambda explanation: -explanation.log_bayes)
    weights = posterior(evidence, {**everything.members, "input": len(data)})
    thresholds = calibration.thresholds(problem.baseline is not None)
    if weights.families.get("input", 0.0) <= thresholds.input:
        return None
    wrong = [explanation for explanation in evidence if explanation.hypothesis.family == "input"]
    best = max(wrong, key=lambda explanation: weights.masses[explanation.hypothesis.name])
    heat = np.flatnonzero(residuals.of_heat).tolist()
    of_heat = 0.5 * (
        _square(whole, whole.residual, heat) - _square(whole, whole.residual - best.answer, heat)
    )
    if of_heat < thresholds.evidence and best.log_bayes < thresholds.evidence_loop:
        return None  # healthy rigs have given as much evidence
    return Evaluation(
        evidence=tuple(evidence),
        contradicted=(),
        weights=weights,
        decision=Decision(
            verdict="input_error_suspected",
            named=best.hypothesis.parts,
            reason=f"the data agree with the model once {best.hypothesis.parts[0]} is corrected",
        ),
        detectability=(),
        chi_square=whole.chi_square,
        count=len(whole.residual),
    )


def _square(space: Whitened, white: Array, rows: list[int]) -> float:
    """Square of some numbers of a residual, whitened by themselves."""
    block = space.covariance.matrix[np.ix_(rows, rows)]
    values = (space.covariance.lower @ white)[rows]
    return float(values @ np.linalg.solve(block, values))


def _alternatives(evaluation: Evaluation, count: int = 12) -> tuple[Alternative, ...]:
    masses: Mapping[str, float] = evaluation.weights.masses
    ordered = sorted(evaluation.evidence, key=lambda explanation: -masses[explanation.hypothesis.name])
    return tuple(
        Alternative(
            name=explanation.hypothesis.name,
            parts=explanation.hypothesis.parts,
            posterior=masses[explanation.hypothesis.name],
            gain=explanation.gain,
            coordinates=explanation.coordinates,
        )
        for explanation in ordered[:count]
    )


# What may be said of a set: its heat and what oscillates in it are looked at each by itself, then put together.
#
# Heat hardly knows what the rig does at an order, and no temperature tells a tooth. An effect that either domain names
# is named whatever the other one leaves, and two effects of different domains do not compete. Within a domain the
# numbers of a model known well decide; orders of the meshes are asked where those name nothing. They overrule a name in
# one case: where they show a changed power circuit, through which what healthy teeth excite looks like other teeth.

OPEN = frozenset({"unknown_located", "too_small"})
"""Verdicts that an effect may be suspected under."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What numbers say.

    looks : of the domains it is from, that of the reported alternatives first
    """

    looks: tuple[Look, ...]
    claimed: Claim
    suspicion: Suspicion | None = None

    @property
    def look(self) -> Look:
        """The look whose alternatives are reported."""
        return self.looks[0]

    @property
    def tier(self) -> Tier:
        """Numbers that count on the points held out."""
        return self.look.tier if len(self.looks) == 1 else "all"

    @property
    def evaluations(self) -> tuple[Evaluation, ...]:
        """Of all looks, one after the other."""
        return tuple(evaluation for look in self.looks for evaluation in look.evaluations)

    @property
    def decision(self) -> Decision:
        """Of what is claimed, or suspected."""
        return self.claimed.decision if self.suspicion is None else self.suspicion.decision

    @property
    def sure(self) -> bool:
        """Whether it gives names."""
        return self.decision.verdict in SURE


def found_in(numbers: Numbers, given: Decision | None = None) -> Finding:
    """The finding of all numbers; ``given``: a verdict that no search changes."""
    if given is not None:
        look = numbers.look("all")
        return Finding(looks=(look,), claimed=numbers.claim(look, given, ()))
    findings = [_of_domain(numbers, tiers) for tiers in numbers.domains]
    if len(findings) == 1:
        return findings[0]
    sure = [finding for finding in findings if finding.sure]
    if len(sure) == 2:
        return _together(numbers, *sure)
    if sure:
        (other,) = (finding for finding in findings if finding is not sure[0])
        return _beside(sure[0], other)
    return max(findings, key=_severity)


def _severity(finding: Finding) -> int:
    """Of two domains that name nothing the verdict of the graver one holds for both."""
    match finding.decision.verdict:
        case "suspected":
            return 4
        case "unknown_located":
            return 3
        case "too_small":
            return 2
        case "data_insufficient":  # for a name that was found, else to see anything here
            return 2 if finding.claimed.refused else 0
        case _:
            return 1


def _of_domain(numbers: Numbers, tiers: Sequence[Tier]) -> Finding:
    """By the first tier that names something which the next one does not overrule; else what may be suspected.

    A suspect that leaves no more than the model may answer wrongly is held against the points held out like a name.
    """
    looks = []
    overruled: tuple[Refusal, ...] = ()
    for tier, further in zip_longest(tiers, tiers[1:]):
        look = numbers.look(tier)
        claimed = numbers.claim(look, look.first.decision, look.found)
        if claimed.decision.verdict in SURE:
            if further is None or not _overruled(numbers.look(further), claimed.decision.named):
                return Finding(looks=(look,), claimed=_after(overruled, claimed))
            given = numbers.fitted(look, claimed)
            overruled = refusals(given.found, given.fit, BY_CIRCUIT)
        looks.append((look, claimed))
    contradicted = any(claimed.contradicted for _, claimed in looks)
    for look, claimed in () if contradicted else looks:
        if claimed.decision.verdict not in OPEN:
            continue
        suspicion = suspected(look, numbers.proof(look.tier), numbers.traces(look), numbers.calibration)
        if suspicion is None or numbers.contradiction(look, [suspicion.evidence], suspicion.fit):
            continue
        if suspicion.accounts_for_all:
            confirmed = numbers.claim(look, suspicion.as_named, [suspicion.evidence])
            if confirmed.decision.verdict in SURE:
                return Finding(looks=(look,), claimed=_after(overruled, confirmed))
        return Finding(looks=(look,), claimed=_after(overruled, claimed), suspicion=suspicion)
    look, claimed = looks[-1]
    return Finding(looks=(look,), claimed=_after(overruled, claimed))


def _after(overruled: tuple[Refusal, ...], claimed: Claim) -> Claim:
    return replace(claimed, refused=(*overruled, *claimed.refused))


BY_CIRCUIT = "the orders of the meshes show a change of the power circuit instead"


def _overruled(look: Look, named: Sequence[str]) -> bool:
    """Whether the orders of the meshes show a changed circuit, and what is named no longer."""
    circuit = look.criteria.circuit - set(named)
    masses = [mass_of_any(look.first.evidence, look.first.weights, parts) for parts in (circuit, named)]
    return masses[0] >= look.criteria.thresholds.named and masses[1] < NO_LONGER


NO_LONGER = 0.5
"""Posterior mass of names below which the orders of the meshes speak for something else."""


def _beside(sure: Finding, other: Finding) -> Finding:
    """A finding with names, and what the other domain says beyond a healthy rig."""
    if other.decision.verdict not in ("unknown_located", "suspected"):
        return sure
    where = WORDS["heat" if other.tier == "heat" else "rotation"]
    return _with_decision(sure, replace(sure.decision, elsewhere=f"in {where}: {other.decision.reason}"))


def _with_decision(finding: Finding, decision: Decision) -> Finding:
    return replace(finding, claimed=replace(finding.claimed, decision=decision))


def _together(numbers: Numbers, first: Finding, second: Finding) -> Finding:
    """Names of both domains; of two groups the smaller one, as a verdict has one, with the other one as well."""
    grouped = [finding for finding in (first, second) if finding.decision.verdict == "alias_group"]
    leads, other = (second, first) if grouped == [second] else (first, second)
    if len(grouped) == 2:
        leads, other = sorted(grouped, key=lambda finding: len(finding.decision.named))
        return _with_decision(leads, replace(leads.decision, as_well=other.decision.named))
    further = tuple(name for name in other.decision.named if name not in leads.decision.named)
    if not further:
        return leads
    leading, others = (numbers.fitted(finding.look, finding.claimed) for finding in (leads, other))
    known = {explanation.hypothesis.parts[0] for explanation in leading.found}
    others = others.only([explanation.hypothesis.parts[0] not in known for explanation in others.found])
    explanations, fit = (*others.found, *leading.found), others.fit.with_other(leading.fit)
    sizes = {
        explanation.hypothesis.name: size
        for explanation, size in zip(explanations, fit.coordinates, strict=True)
    }
    proof = numbers.proof("all")
    reason = f"{leads.decision.reason}; {other.decision.reason}"
    try:
        answer = proof.again(sizes)
    except RigdesignError:
        return _with_decision(leads, replace(leads.decision, as_well=further))
    decision = replace(leads.decision, reason=reason)
    if grouped:
        decision = replace(decision, apart=(*decision.apart, *further))
    else:
        decision = replace(decision, named=(*decision.named, *further))
    return Finding(
        looks=(*leads.looks, *other.looks),
        claimed=Claim(
            decision=decision,
            found=explanations,
            fit=fit,
            fits={member: others.fit.with_other(of_member) for member, of_member in leading.fits.items()},
            answer=answer,
            gap=proof.gap(answer),
            refused=(*leads.claimed.refused, *other.claimed.refused),
        ),
    )

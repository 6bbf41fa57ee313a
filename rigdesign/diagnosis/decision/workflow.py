"""The workflow of a diagnosis on numbers: from readings and library to a verdict with its proof.

readings -> single outliers out -> points held out -> evidence -> verdict, again for what is left
         -> joint fit with intervals -> what may be claimed -> alternatives
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Literal

from rigdesign.diagnosis.decision.claims import Claim, Refusal, Traces, claim
from rigdesign.diagnosis.decision.decision import Decision, posterior
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration
from rigdesign.diagnosis.decision.evaluate import Evaluation
from rigdesign.diagnosis.decision.problem import Problem, Tier
from rigdesign.diagnosis.decision.proof import Proof, Rerun
from rigdesign.diagnosis.decision.search import Look, explanations_of, fitted, search, signature_of
from rigdesign.diagnosis.decision.suspicion import Suspicion, suspected
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, outliers_of
from rigdesign.diagnosis.residual.signature import Contest
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.detectability import Detectability, aliases
from rigdesign.diagnosis.statistics.evidence import Evidence, evaluate_hypothesis
from rigdesign.diagnosis.statistics.heldout import Gap, held_out
from rigdesign.diagnosis.statistics.intervals import JointFit

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
    alternatives: tuple[Alternative, ...]
    detectability: tuple[Detectability, ...]
    aliases: tuple[tuple[str, str, float], ...]
    suspicion: Suspicion | None
    """An effect that is probable and not named."""
    rejected: tuple[tuple[int, float], ...]
    held_out_points: tuple[str, ...]
    tier: Tier
    """Numbers that the verdict depends on."""
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
    kept_data = _Data(
        problem=problem, residuals=residuals, whole=whole, points=points, calibration=calibration, rerun=rerun
    )
    refused = _refused(residuals)
    looked_at = (residuals, whole) if problem.baseline is None else (problem.residuals, everything)
    wrong = None if refused else _wrong_data(problem, *looked_at, calibration)
    look, claimed, suspicion = _verdict(kept_data, refused or (None if wrong is None else wrong.decision))
    deciding = wrong or look.first
    shrunk = claimed.gap is not None and claimed.gap.shrunk
    proven = claimed.decision.verdict == "named" and shrunk and rerun is not None
    return Diagnosis(
        decision=claimed.decision if suspicion is None else suspicion.decision,
        strength="proven" if problem.repeated and proven else "indicative",
        named=claimed.decision.named if suspicion is None else suspicion.decision.named,
        found=claimed.found,
        fit=claimed.fit,
        fits=claimed.fits,
        gap=claimed.gap,
        suspicion=suspicion,
        refused=claimed.refused,
        alternatives=_alternatives(deciding),
        detectability=look.first.detectability,
        aliases=tuple(aliases(look.space, look.explanations.physical)),
        rejected=tuple((outlier.place, outlier.deviation) for outlier in outliers),
        held_out_points=points,
        tier=look.tier,
        evaluations=look.evaluations,
        deciding=deciding,
        covariance=whole.covariance,
        proof=kept_data.proof(look.tier),
        answer=claimed.answer,
        kept=tuple(kept),
        residual=whole.raw,
    )


@dataclass(frozen=True, kw_only=True)
class _Data:
    """The numbers that were kept, and what is done with all of them or with those that decide.

    residuals, whole : of the kept numbers; points : held out
    """

    problem: Problem
    residuals: ResidualProblem
    whole: Whitened
    points: tuple[str, ...]
    calibration: Calibration
    rerun: Rerun | None
    _proofs: dict[Tier, Proof] = field(default_factory=dict)

    def look(self, tier: Tier) -> Look:
        """The search over the numbers of a tier at the points that are not held out."""
        residuals = self.residuals
        rows = [
            row
            for row, one in enumerate(residuals.features)
            if one.setting not in self.points and not (tier == "deciding" and residuals.of_mesh[row])
        ]
        seen = residuals.rows(rows)
        space = self.problem.cut(self.whole, seen, rows, self.calibration)
        return search(self.problem, seen, space, self.calibration, tier)

    def proof(self, tier: Tier) -> Proof:
        """What names of a tier are held against; made once."""
        if tier not in self._proofs:
            self._proofs[tier] = Proof(
                residuals=self.residuals, whole=self.whole, points=self.points, tier=tier, rerun=self.rerun
            )
        return self._proofs[tier]

    def claim(self, look: Look, decision: Decision, found: Sequence[Evidence]) -> Claim:
        """What of a decision with the explanations it found may be claimed.

        Where all that is named is too small to matter, it is a nuisance: a group that the evaluation with it in the
        model found holds.
        """
        fit = partial(fitted, look.space, calibration=self.calibration)
        thresholds = self.calibration.thresholds(self.problem.baseline is not None)
        traces, proof = self.traces(look), self.proof(look.tier)
        claimed = claim(decision, found, traces, proof, fit, thresholds)
        last = look.evaluations[-1].decision
        if last.verdict == "alias_group" and not claimed.found and claimed.insignificant:
            group = claim(last, (), traces, proof, fit, thresholds)
            return replace(group, refused=claimed.refused)
        return claimed

    def traces(self, look: Look) -> Traces:
        """What single effects leave in the numbers of a look."""
        return Traces(
            space=look.space, explanations=look.first.evidence, assembly=_assemblies(look.residuals)
        )

    @property
    def tiers(self) -> tuple[Tier, ...]:
        """The numbers that decide come first; both are the same where no orders of the meshes are read."""
        of_mesh = self.residuals.of_mesh
        others = [one.setting for row, one in enumerate(self.residuals.features) if not of_mesh[row]]
        return ("deciding", "all") if of_mesh.any() and any(others) else ("all",)


def _verdict(data: _Data, given: Decision | None) -> tuple[Look, Claim, Suspicion | None]:
    """The look that decides with what it claims, or suspects where nothing is claimed.

    The numbers of a model known well decide; orders of the meshes are asked where those name nothing, and cannot veto.
    A suspect that leaves no more than the model may answer wrongly is held against the points held out like a name.

    given : a verdict that no search changes
    """
    looks = []
    for tier in data.tiers if given is None else ("all",):
        look = data.look(tier)
        claimed = data.claim(look, given or look.first.decision, look.found)
        if claimed.decision.verdict in ("named", "alias_group"):
            return look, claimed, None
        looks.append((look, claimed))
    contradicted = any(claimed.contradicted for _, claimed in looks)
    thresholds = data.calibration.thresholds(data.problem.baseline is not None)
    for look, claimed in looks if given is None and not contradicted else ():
        if claimed.decision.verdict not in OPEN:
            continue
        suspicion = suspected(look, data.proof(look.tier), data.traces(look), data.calibration)
        if suspicion is None:
            continue
        if suspicion.accounts_for_all(thresholds):
            sure = data.claim(look, suspicion.as_named, [suspicion.evidence])
            if sure.decision.verdict in ("named", "alias_group"):
                return look, sure, None
        return look, claimed, suspicion
    return *looks[-1], None


OPEN = ("unknown_located", "too_small")
"""Verdicts that an effect may be suspected under."""


def _assemblies(residuals: ResidualProblem) -> list[tuple[tuple[str, int], ...]]:
    """(n,) teeth by which meshes were put on further at the point of each number."""
    found = {one.name: tuple(sorted(one.tooth_offset.items())) for one in residuals.library.settings}
    return [found.get(feature.setting, ()) for feature in residuals.features]


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
    everything = explanations_of(problem, residuals, whole, rivals=False)
    singles = (*everything.physical, *everything.sensor, *everything.data)
    contest = Contest(whole, signature_of(problem, residuals, calibration))
    evaluated = contest.evaluated([evaluate_hypothesis(whole, one) for one in singles])
    evidence = sorted(evaluated, key=lambda one: -one.log_bayes)
    weights = posterior(evidence, everything.members)
    if weights.families.get("input", 0.0) <= calibration.thresholds(problem.baseline is not None).input:
        return None
    best = max(evidence, key=lambda one: weights.masses[one.hypothesis.name])
    return Evaluation(
        evidence=tuple(evidence),
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


def _alternatives(evaluation: Evaluation, count: int = 12) -> tuple[Alternative, ...]:
    masses: Mapping[str, float] = evaluation.weights.masses
    ordered = sorted(evaluation.evidence, key=lambda one: -masses[one.hypothesis.name])
    return tuple(
        Alternative(
            name=one.hypothesis.name,
            parts=one.hypothesis.parts,
            posterior=masses[one.hypothesis.name],
            gain=one.gain,
            coordinates=one.coordinates,
        )
        for one in ordered[:count]
    )

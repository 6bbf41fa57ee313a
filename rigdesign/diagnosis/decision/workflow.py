"""The workflow of a diagnosis on numbers: from readings and library to a verdict with its proof.

readings -> single outliers out -> points held out -> evidence -> verdict, again for what is left
         -> joint fit with intervals -> what may be claimed -> alternatives
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from rigdesign.diagnosis.decision.claims import Refusal, Traces, claim
from rigdesign.diagnosis.decision.decision import Decision, posterior
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration
from rigdesign.diagnosis.decision.evaluate import Criteria, Earlier, Evaluation, Explanations, evaluate
from rigdesign.diagnosis.decision.proof import Proof, Rerun
from rigdesign.diagnosis.residual.baseline import differenced
from rigdesign.diagnosis.residual.data_error import data_error
from rigdesign.diagnosis.residual.healthy import relative_speed
from rigdesign.diagnosis.residual.hypotheses import physical, sensor, without_a_name
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.residual.signature import Contest, Signature
from rigdesign.diagnosis.residual.unmodelled_cause import unmodelled_causes
from rigdesign.diagnosis.statistics.columns import Array, Column
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.detectability import Detectability, aliases
from rigdesign.diagnosis.statistics.evidence import Evidence, evaluate_hypothesis
from rigdesign.diagnosis.statistics.heldout import Gap, held_out
from rigdesign.diagnosis.statistics.intervals import JointFit, fit_together
from rigdesign.diagnosis.statistics.model_error import ModelError
from rigdesign.diagnosis.statistics.outliers import reject

MOST_EFFECTS = 4
"""Effects that are looked for one after the other."""

LEAST_RUNNING_POINTS = 3
"""Operating points below which nothing is named."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A set to be explained, with a healthy one of the same rig if there is one.

    seed : fixes the held-out points, the hash of the measurement
    repeated : the noise is known from repeats
    """

    residuals: ResidualProblem
    baseline: ResidualProblem | None
    seed: str
    repeated: bool


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
    rejected: tuple[tuple[int, float], ...]
    held_out_points: tuple[str, ...]
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


def diagnose(problem: Problem, calibration: Calibration = DEFAULT, rerun: Rerun | None = None) -> Diagnosis:
    """Find what the model lacks, or say that these data cannot tell.

    rerun : the full model with named effects in it; without one the proof is left at the stored runs, and indicative
    """
    everything = _space(problem, problem.residuals, calibration)
    series = [(one.channel, one.order) for one in problem.residuals.features]
    outliers = reject(everything.covariance.matrix, everything.raw, series)
    gone = {outlier.place for outlier in outliers}
    kept = [row for row in range(len(problem.residuals.features)) if row not in gone]
    residuals = problem.residuals.rows(kept)
    whole = _cut(problem, everything, residuals, kept, calibration) if gone else everything
    points = held_out([setting.name for setting in residuals.library.settings], problem.seed)
    open_rows = [row for row, one in enumerate(residuals.features) if one.setting not in points]
    seen = residuals.rows(open_rows)
    space = _cut(problem, whole, seen, open_rows, calibration)
    explanations = _explanations(problem, seen, space)
    evaluations, found = _search(problem, seen, space, explanations, calibration)
    refused = _refused(residuals)
    looked_at = (residuals, whole) if problem.baseline is None else (problem.residuals, everything)
    wrong = None if refused else _wrong_data(problem, *looked_at, calibration)
    deciding = wrong or evaluations[0]
    proof = Proof(residuals=residuals, whole=whole, points=points, rerun=rerun)
    claimed = claim(
        refused or deciding.decision,
        found,
        Traces(
            space=space,
            explanations=evaluations[0].evidence,
            assembly=_assemblies(seen),
        ),
        proof,
        lambda some: _fitted(space, some, calibration),
    )
    shrunk = claimed.gap is not None and claimed.gap.shrunk
    proven = claimed.decision.verdict == "named" and shrunk and rerun is not None
    return Diagnosis(
        decision=claimed.decision,
        strength="proven" if problem.repeated and proven else "indicative",
        named=claimed.decision.named,
        found=claimed.found,
        fit=claimed.fit,
        fits=claimed.fits,
        gap=claimed.gap,
        refused=claimed.refused,
        alternatives=_alternatives(deciding),
        detectability=evaluations[0].detectability,
        aliases=tuple(aliases(space, explanations.physical)),
        rejected=tuple((outlier.place, outlier.deviation) for outlier in outliers),
        held_out_points=points,
        evaluations=tuple(evaluations),
        deciding=deciding,
        covariance=whole.covariance,
        proof=proof,
        answer=claimed.answer,
        kept=tuple(kept),
        residual=whole.raw,
    )


def _space(problem: Problem, residuals: ResidualProblem, calibration: Calibration) -> Whitened:
    if problem.baseline is None:
        return plain(residuals, calibration.amplitudes, calibration.inflation)
    return differenced(
        residuals,
        problem.baseline,
        calibration.amplitudes,
        calibration.drift,
    )


def _cut(
    problem: Problem,
    space: Whitened,
    residuals: ResidualProblem,
    rows: Sequence[int],
    calibration: Calibration,
) -> Whitened:
    """The space of some of its numbers.

    What a baseline foretells of a number does not depend on the others of the set; where constants are bent to the data
    it does.
    """
    return (
        plain(residuals, calibration.amplitudes, calibration.inflation)
        if problem.baseline is None
        else space.rows(rows)
    )


def _assemblies(residuals: ResidualProblem) -> list[tuple[tuple[str, int], ...]]:
    """(n,) teeth by which meshes were put on further at the point of each number."""
    found = {one.name: tuple(sorted(one.tooth_offset.items())) for one in residuals.library.settings}
    return [found.get(feature.setting, ()) for feature in residuals.features]


def _explanations(
    problem: Problem, residuals: ResidualProblem, space: Whitened, *, rivals: bool = True, data: bool = True
) -> Explanations:
    """All explanations; without the unmodelled ``rivals`` where only data and catalogue are evaluated, and without
    errors of the ``data`` where those were evaluated before."""
    covariance = space.covariance
    expected = residuals.values - space.raw
    return Explanations(
        physical=physical(
            covariance,
            residuals.features,
            residuals.effects,
            residuals.library.responses,
            residuals.teeth_a_turn,
        ),
        sensor=sensor(covariance, residuals.errors),
        unmodelled=without_a_name(covariance, unmodelled_causes(residuals.library, residuals.channels))
        if rivals
        else [],
        data=data_error(
            covariance,
            residuals.features,
            residuals.channels,
            residuals.values,
            expected,
            met_before=problem.baseline is not None,
        )
        if data
        else [],
    )


def _search(
    problem: Problem,
    residuals: ResidualProblem,
    space: Whitened,
    explanations: Explanations,
    calibration: Calibration,
) -> tuple[list[Evaluation], tuple[Evidence, ...]]:
    """Evaluate, take what is named into the model, evaluate what is left."""
    signature = _signature(problem, residuals, calibration)
    criteria = Criteria(
        thresholds=calibration.thresholds(problem.baseline is not None),
        points=[feature.setting for feature in residuals.features],
        orders=frozenset(effect.claim for effect in residuals.effects if effect.family.dynamic),
        signature=signature,
    )
    evaluations = [evaluate(space, explanations, criteria)]
    found: list[Evidence] = []
    while evaluations[-1].decision.verdict == "named" and len(found) < MOST_EFFECTS:
        new = _best_of(evaluations[-1])
        if not new:
            break
        found += new
        after = _with_named(space, found, signature)
        claimed = {part for one in found for part in one.hypothesis.parts}
        rest = _explanations(problem, residuals, after, data=False)
        left = Explanations(
            physical=[one for one in rest.physical if claimed.isdisjoint(one.parts)],
            sensor=[one for one in rest.sensor if claimed.isdisjoint(one.parts)],
            unmodelled=rest.unmodelled,
            data=rest.data,
        )
        earlier = Earlier(look=evaluations[0], named=frozenset(claimed))
        explained = max(one.gain for one in found)
        evaluations.append(evaluate(after, left, criteria, explained=explained, earlier=earlier))
    return evaluations, tuple(found)


def _signature(problem: Problem, residuals: ResidualProblem, calibration: Calibration) -> Signature:
    """An order is answered as badly as the model knows it: the frequencies near it, and of a mesh its own size.

    Without a baseline the residual of a healthy rig is as wide as that by itself.
    """
    placed = calibration.amplitudes.frequency * residuals.steepness
    share = np.hypot(placed, np.where(residuals.of_mesh, calibration.amplitudes.series_mesh_point, 0.0))
    own = ModelError.of(residuals.features, share, residuals.of_mesh, residuals.values)
    return Signature.of(
        residuals.features,
        relative_speed(residuals.features, residuals.library.settings),
        calibration.signature_error,
        None if problem.baseline is None else own,
        circuit=frozenset(effect.claim for effect in residuals.effects if effect.family.circuit),
    )


def _best_of(evaluation: Evaluation) -> list[Evidence]:
    """For every named effect its best explanation by itself."""
    found = []
    for name in evaluation.decision.named:
        own = [one for one in evaluation.evidence if one.hypothesis.parts == (name,)]
        if own:
            found.append(own[0])
    return found


def _with_named(space: Whitened, found: Sequence[Evidence], signature: Signature) -> Whitened:
    """The space with the named effects in the model, their sizes left free, and what it may answer wrongly to them."""
    lower = space.covariance.lower
    columns = [
        Column(
            name=f"named {one.hypothesis.name}/{number}",
            kind="named",
            values=lower @ slope,
            spread=_half(one),
        )
        for one in found
        for number, slope in enumerate(one.columns.T)
    ]
    precision = np.diagonal(space.precision)
    for one in found:
        columns += signature.columns(one.hypothesis, lower @ one.answer, precision)
    owns = [own for one in found for own in one.hypothesis.own]
    residual = lower @ (space.freed(owns) - sum((one.answer for one in found), np.zeros(len(space.residual))))
    nonlinear_parts = {
        effect: lower @ part for effect, part in space.nonlinear_parts.items() if effect not in owns
    }
    return Whitened.of(space.covariance.with_extra(columns), residual, nonlinear_parts)


def _half(one: Evidence) -> float:
    curve = one.hypothesis.curve
    return one.hypothesis.half if curve is None else curve.half


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
    everything = _explanations(problem, residuals, whole, rivals=False)
    singles = (*everything.physical, *everything.sensor, *everything.data)
    contest = Contest(whole, _signature(problem, residuals, calibration))
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


def _fitted(space: Whitened, found: Sequence[Evidence], calibration: Calibration) -> JointFit:
    return fit_together(space, found, calibration.signature_error, [_bounds(one) for one in found])


def _bounds(one: Evidence) -> list[tuple[float, float]]:
    curve = one.hypothesis.curve
    if curve is not None:
        return [curve.bounds]
    return [(-one.hypothesis.half, one.hypothesis.half)] * one.columns.shape[1]


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

"""The search over one selection of the numbers: evaluate, take what is named into the model, evaluate what is left."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.evaluate import Criteria, Earlier, Evaluation, Explanations, evaluate
from rigdesign.diagnosis.decision.other_domain import OtherDomain
from rigdesign.diagnosis.decision.problem import Problem, Tier
from rigdesign.diagnosis.residual.healthy import relative_speed
from rigdesign.diagnosis.residual.hypotheses import physical, sensor, without_a_name
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.residual.signature import Signature
from rigdesign.diagnosis.residual.unmodelled_cause import ORDER_CAUSE, UNKNOWN, unmodelled_causes
from rigdesign.diagnosis.statistics.close_modes import CloseModes
from rigdesign.diagnosis.statistics.columns import Column
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import Evidence
from rigdesign.diagnosis.statistics.intervals import JointFit, fit_together
from rigdesign.diagnosis.statistics.model_error import ModelError

MOST_EFFECTS = 4
"""Effects that are looked for one after the other."""


@dataclass(frozen=True, kw_only=True)
class Look:
    """What a search evaluated and found.

    residuals, space : of the numbers it had; criteria : of every evaluation; evaluations : one after the other, the
    first with nothing named yet; found : the best explanation of every name
    """

    tier: Tier
    residuals: ResidualProblem = field(repr=False)
    space: Whitened = field(repr=False)
    explanations: Explanations = field(repr=False)
    criteria: Criteria = field(repr=False)
    evaluations: tuple[Evaluation, ...] = field(repr=False)
    found: tuple[Evidence, ...]

    @property
    def first(self) -> Evaluation:
        """The evaluation in which all causes compete at once."""
        return self.evaluations[0]


def search(
    problem: Problem,
    residuals: ResidualProblem,
    space: Whitened,
    explanations: Explanations,
    calibration: Calibration,
    tier: Tier,
    other: OtherDomain | None = None,
) -> Look:
    """Evaluate, take what is named into the model, evaluate what is left.

    explanations : of the numbers of the tier; other : numbers of the other domain, where they are read
    """
    signature = signature_of(problem, residuals, calibration)
    criteria = Criteria(
        thresholds=calibration.thresholds(problem.baseline is not None),
        points=[feature.setting for feature in residuals.features],
        orders=causes_of_orders(residuals, explanations, tier),
        unnamed=frozenset(effect.claim for effect in residuals.effects if effect.stands_for),
        one_oil=losses_of_oils(residuals, explanations),
        signature=signature,
    )
    evaluations = [evaluate(space, explanations, _beside(criteria, other, explanations))]
    found: list[Evidence] = []
    while evaluations[-1].decision.verdict == "named" and len(found) < MOST_EFFECTS:
        new = _best_of(evaluations[-1])
        if not new:
            break
        found += new
        after = _with_named(space, found, signature)
        claimed = {part for one in found for part in one.hypothesis.parts}
        rest = explanations_of(residuals, after)
        left = Explanations(
            physical=[one for one in rest.physical if claimed.isdisjoint(one.parts)],
            sensor=[one for one in rest.sensor if claimed.isdisjoint(one.parts)],
            unmodelled=rest.unmodelled,
        )
        earlier = Earlier(look=evaluations[0], named=frozenset(claimed))
        explained = max(one.gain for one in found)
        beside = _beside(criteria, other, rest)
        evaluations.append(evaluate(after, left, beside, explained=explained, earlier=earlier))
    return Look(
        tier=tier,
        residuals=residuals,
        space=space,
        explanations=explanations,
        criteria=criteria,
        evaluations=tuple(evaluations),
        found=tuple(found),
    )


def _beside(criteria: Criteria, other: OtherDomain | None, own: Explanations) -> Criteria:
    """The criteria with what the other domain says against explanations."""
    return criteria if other is None else replace(criteria, contradicted=other.seen_from(own).contradicts)


def causes_of_orders(residuals: ResidualProblem, explanations: Explanations, tier: Tier) -> frozenset[str]:
    """Parts of explanations whose evidence is of orders and natural frequencies: in a look at rotation all."""
    effects = {effect.claim for effect in residuals.effects if effect.family.dynamic}
    if tier == "heat":
        return frozenset(effects)
    others = (*explanations.sensor, *explanations.unmodelled)
    of_orders = {
        part for one in others for part in one.parts if tier != "all" or part.startswith(ORDER_CAUSE)
    }
    return frozenset(effects | of_orders)


def losses_of_oils(residuals: ResidualProblem, explanations: Explanations) -> dict[str, frozenset[str]]:
    """Unmodelled loss in an oil, whatever its law -> losses of the catalogue of which that oil takes most."""
    oils = {effect.heats for effect in residuals.effects if effect.heats}
    found: dict[str, frozenset[str]] = {}
    for oil in oils:
        losses = frozenset(effect.claim for effect in residuals.effects if effect.heats == oil)
        start = f"{UNKNOWN}heat at oil:{oil} "
        found |= {one.name: losses for one in explanations.unmodelled if one.name.startswith(start)}
    return found


def explanations_of(residuals: ResidualProblem, space: Whitened, *, rivals: bool = True) -> Explanations:
    """All explanations; without the unmodelled ``rivals`` where only the catalogue is evaluated."""
    covariance = space.covariance
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
    )


def signature_of(problem: Problem, residuals: ResidualProblem, calibration: Calibration) -> Signature:
    """An order is answered as badly as the model knows it: the frequencies near it, and of a mesh its own size.

    Without a baseline the residual of a healthy rig is as wide as that by itself.
    """
    placed = calibration.amplitudes.frequency * residuals.resonances.steepness
    share = np.hypot(placed, np.where(residuals.of_mesh, calibration.amplitudes.series_mesh_point, 0.0))
    own = ModelError.of(residuals.features, share, residuals.of_mesh, residuals.values)
    return Signature.of(
        residuals.features,
        relative_speed(residuals.features, residuals.library.settings),
        calibration.signature_error,
        None if problem.baseline is None else own,
        CloseModes.of(residuals.natural_frequencies, calibration.amplitudes.frequency),
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
            spread=one.hypothesis.widest,
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


def fitted(space: Whitened, found: Sequence[Evidence], calibration: Calibration) -> JointFit:
    """The joint fit of some explanations in a space, with their intervals."""
    return fit_together(
        space, found, calibration.signature_error, [one.hypothesis.intervals for one in found]
    )

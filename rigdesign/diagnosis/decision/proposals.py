"""What to measure next: the rivals of a diagnosis against every further measurement of the rig."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.problem import Problem
from rigdesign.diagnosis.decision.required import RequiredCause, required_causes
from rigdesign.diagnosis.decision.simulation import Simulation
from rigdesign.diagnosis.decision.workflow import Diagnosis
from rigdesign.diagnosis.library.candidates import NOISE, SPARE, Extra, extra_points
from rigdesign.diagnosis.library.costs import Costs
from rigdesign.diagnosis.library.library import Library
from rigdesign.diagnosis.residual.hypotheses import physical, sensor
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.detectability import ALIAS
from rigdesign.diagnosis.statistics.evidence import Evidence, Hypothesis
from rigdesign.diagnosis.statistics.next_measurement import (
    Foreseen,
    Proposal,
    Ranked,
    Rival,
    SmallestSet,
    ranked,
    smallest_set,
)
from rigdesign.diagnosis.statistics.reference_scale import reference_scale
from rigdesign.diagnosis.statistics.required_size import straight
from rigdesign.measurement.places import Places
from rigdesign.prediction.model import Channel, Feature, OperatingCondition

RIVALS = 3
"""Explanations that are to be separated."""
MOST_BEYOND = 3.0
"""Size over its bound up to which a cause counts as a rival where the data are too few."""


@dataclass(frozen=True, kw_only=True)
class Offer:
    """What could be measured next.

    library : with the points and sensors that could be added, those of the set under the names it has
    extras : the points; costs : of points and sensors
    """

    library: Library
    extras: Sequence[Extra]
    costs: Costs


def extras_of(case: Case, settings: Sequence[OperatingCondition]) -> tuple[Extra, ...]:
    """Points in addition to the plan of a set."""
    return extra_points(settings, Places(case).meshes if case.drivetrain is not None else ())


@dataclass(frozen=True, kw_only=True)
class NextMeasurements:
    """What to measure next.

    ranked : single measurements, best first; together : the cheapest set that decides, None where none was found
    verified : explanations for which a simulation of that set ended in their name, of those simulated
    causes : with too few data, those that are distinguished at the sizes that each would need
    """

    ranked: tuple[Ranked, ...] = ()
    together: SmallestSet | None = None
    verified: tuple[tuple[str, bool], ...] = ()
    causes: tuple[str, ...] = ()


NOTHING_NEXT = NextMeasurements()

UNDECIDED = ("suspected", "alias_group", "too_small", "unknown_located", "data_insufficient")
"""Verdicts after which there is something to decide."""


def next_measurements(
    problem: Problem, found: Diagnosis, offered: Callable[[], Offer | None], calibration: Calibration
) -> NextMeasurements:
    """Measurements that tell the leading rivals apart; none where something is named.

    Of a single suspect: those that tell it from a healthy rig. With too few data to name anything: those that tell the
    causes apart at the sizes that each would need, or the leading one from a healthy rig where no two come into
    question. The set is verified by simulating it with each rival as the truth and diagnosing what it would read, not
    with too few data.

    offered : makes the offer, where there is something to distinguish; None if there is none
    """
    if found.decision.verdict not in UNDECIDED:
        return NOTHING_NEXT
    rivals = _rivals(found)
    insufficient = found.decision.verdict == "data_insufficient"
    alone = insufficient or (found.decision.verdict == "suspected" and len(found.decision.named) == 1)
    if len(rivals) < (1 if alone else 2) and not insufficient:
        return NOTHING_NEXT
    offer = offered()
    if offer is None:
        return NOTHING_NEXT
    whole, measured = _with_candidates(problem.residuals.rows(found.kept), offer.library)
    needed = _needed(whole, measured) if insufficient else []
    if len(rivals) < (1 if alone else 2) and len(needed) < 2:
        return NOTHING_NEXT
    if len(needed) > 1:
        compared = needed
    else:
        answers = _answers(whole, rivals)
        compared = [_rival(one, answers[one.hypothesis.name]) for one in rivals]
        if alone:
            compared = [compared[0], _nothing(len(whole.features))]
    mean, matrix = problem.healthy(whole, calibration)
    foreseen = Foreseen.of(matrix, found.residual, compared)
    offers = _offers(whole.features[measured:], whole.channels, offer)
    together = smallest_set(foreseen, offers)
    verified: tuple[tuple[str, bool], ...] = ()
    if together is not None and len(needed) < 2:
        simulation = Simulation(
            problem=problem, whole=whole, measured=measured, mean=mean, foreseen=foreseen, rows=together.rows
        )
        names = [one.hypothesis.parts[0] for one in (rivals[:1] if alone else rivals)]
        verified = simulation.verified(names, calibration)
    return NextMeasurements(
        ranked=ranked(foreseen, offers),
        together=together,
        verified=verified,
        causes=tuple(one.name for one in needed) if len(needed) > 1 else (),
    )


def _rivals(found: Diagnosis) -> list[Evidence]:
    """The likeliest single explanations of different things, the members of a group first."""
    masses, group = found.evaluations[0].weights.inclusion, found.decision.named
    singles = [
        one
        for one in found.evaluations[0].evidence
        if one.hypothesis.family in ("physical", "sensor") and len(one.hypothesis.parts) == 1
    ]
    best = {one.hypothesis.parts[0]: one for one in reversed(singles)}
    ordered = sorted(best.items(), key=lambda item: (item[0] not in group, -masses.get(item[0], 0.0)))
    return [one for _, one in ordered][:RIVALS]


def _with_candidates(residuals: ResidualProblem, library: Library) -> tuple[ResidualProblem, int]:
    """The numbers of the set followed by those that could be read."""
    have = set(residuals.features)
    spare = tuple(feature for feature in library.features if feature not in have and _offered(feature))
    features = (*residuals.features, *spare)
    channels = {channel.name: channel for channel in library.channels}
    noise = np.array([NOISE[channels[feature.channel].quantity] for feature in spare])
    count = len(spare)
    errors = tuple(
        replace(error, values=np.concatenate([error.values, np.zeros(count)])) for error in residuals.errors
    )
    scatter = np.zeros((len(features), len(features)))
    measured = len(residuals.features)
    cut = library.rows(features)
    scatter[:measured, :measured] = residuals.scatter
    return (
        ResidualProblem(
            features=features,
            values=np.concatenate([residuals.values, np.zeros(count)]),
            noise=np.concatenate([residuals.noise, noise]),
            library=cut,
            channels=channels,
            effects=residuals.effects,
            errors=errors,
            scatter=scatter,
            mesh_orders=residuals.mesh_orders,
            teeth_a_turn=residuals.teeth_a_turn,
            level=reference_scale(features, cut.base, channels, cut.settings, residuals.mesh_orders),
        ),
        measured,
    )


def _offered(feature: Feature) -> bool:
    """A new sensor at the points of the set, or all sensors at a new point."""
    return feature.channel.startswith(SPARE) != feature.setting.startswith(SPARE)


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


def _needed(whole: ResidualProblem, measured: int) -> list[Rival]:
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
            nothing = np.zeros((len(answer), 0))
            rival = Rival(name=cause.explanation, answer=answer, slopes=nothing, deviations=np.zeros(0))
            found[cause.entry.kind] = rival
    return list(found.values())[:RIVALS]


def _in_question(cause: RequiredCause) -> bool:
    """Whether an effect could be what is looked for: near its bounds, and not the other way round than it can be."""
    if not cause.explains or cause.size is None or not isinstance(cause.entry, Effect):
        return False
    return cause.size.reach <= MOST_BEYOND and not cause.reversed


def _cosine(first: Array, second: Array) -> float:
    return float(abs(first @ second) / (np.linalg.norm(first) * np.linalg.norm(second)))


def _nothing(count: int) -> Rival:
    """That no effect is present: with too few data the first question is whether the leading explanation is real."""
    return Rival(name="none", answer=np.zeros(count), slopes=np.zeros((count, 0)), deviations=np.zeros(0))


def _offers(features: Sequence[Feature], channels: Mapping[str, Channel], offer: Offer) -> list[Proposal]:
    by_channel: dict[str, list[int]] = {}
    by_point: dict[str, list[int]] = {}
    for row, feature in enumerate(features):
        if feature.channel.startswith(SPARE):
            by_channel.setdefault(feature.channel, []).append(row)
        else:
            by_point.setdefault(feature.setting, []).append(row)
    found = [
        Proposal(
            title=f"a sensor: {name.removeprefix(SPARE)}",
            rows=tuple(rows),
            cost=offer.costs.of(channels[name].quantity),
        )
        for name, rows in by_channel.items()
    ]
    points = {extra.setting.name: extra for extra in offer.extras}
    return found + [
        Proposal(title=points[name].title, rows=tuple(rows), cost=offer.costs.of(points[name].changed))
        for name, rows in by_point.items()
        if name in points
    ]

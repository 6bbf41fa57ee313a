"""What to measure next: the rivals of a diagnosis against every further measurement of the rig."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot, inf

import numpy as np
from scipy.linalg import solve_triangular

from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.claims import NAMED
from rigdesign.diagnosis.decision.cross_validation import Problem
from rigdesign.diagnosis.decision.decision import UNNAMED
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.naming import in_words, place_of
from rigdesign.diagnosis.decision.workflow import Diagnosis, diagnose
from rigdesign.diagnosis.library.candidates import NOISE, SPARE, Costs, Extra, extra_points
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.residual.hypotheses import UNKNOWN, physical, sensor, unmodelled_causes
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.residual.sensors import SensorError
from rigdesign.diagnosis.statistics.columns import Array, reference_scale
from rigdesign.diagnosis.statistics.detectability import ALIAS, RequiredSize, ResidualMetric, straight
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
from rigdesign.measurement.places import Places
from rigdesign.prediction.model import Channel, Feature, OperatingCondition

# What a further measurement has to tell apart, each explanation with its answer at all that could be read.

# How large each cause would have to be to explain a residual by itself, where too few data can name anything.

EXPLAINS = 0.5
"""Share of the square of the residual from which a cause explains it."""


@dataclass(frozen=True, kw_only=True)
class RequiredCause:
    """An effect or an error of a sensor or setting with the size that it needs.

    explanation : its name, of a tooth that may be any that of the first; size : None where it moves none of the numbers
    within : whether its bounds admit the size; computed : whether the model has its answer
    """

    explanation: str
    entry: Effect | SensorError
    size: RequiredSize | None
    within: bool = False
    computed: bool = True

    @property
    def explains(self) -> bool:
        """Whether the residual is met by it."""
        return self.size is not None and self.size.share >= EXPLAINS

    @property
    def reversed(self) -> bool:
        """Whether it would have to go the other way round than it can."""
        if self.size is None or not isinstance(self.entry, Effect) or len(self.size.coordinates) > 1:
            return False
        low, high = self.entry.parameters[0].bounds
        return (self.size.coordinates[0] < 0.0 and low == 0.0) or (
            self.size.coordinates[0] > 0.0 and high == 0.0
        )


def required_causes(residuals: ResidualProblem) -> tuple[RequiredCause, ...]:
    """All effects, then all errors.

    The residual is measured by the noise of the readings and settings, and by the systematic uncertainties of sensors
    and settings, which the causes do not have to explain.
    """
    metric = _metric(residuals)
    return (
        *(_of_effect(metric, residuals.library.responses, effect) for effect in residuals.effects),
        *(_of_error(residuals, error) for error in residuals.errors),
    )


def _metric(residuals: ResidualProblem, without: str = "") -> ResidualMetric:
    """Without the systematic part of one error."""
    covariance = np.diag(residuals.noise**2) + residuals.scatter
    for error in residuals.errors:
        if error.name != without:
            covariance = covariance + error.spread**2 * np.outer(error.values, error.values)
    return ResidualMetric(residuals.residual, covariance)


def _of_effect(metric: ResidualMetric, responses: Mapping[str, Response], effect: Effect) -> RequiredCause:
    explanation = f"{effect.name}/0" if effect.any_tooth else effect.name
    response = responses.get(effect.name)
    if response is None:
        return RequiredCause(explanation=explanation, entry=effect, size=None, computed=False)
    if response.nonlinear:
        size = metric.of_runs(response.coordinates[:, 0], response.answers, effect.reach)
    else:
        size = metric.of_columns(response.sensitivity(), effect.reach)
    within = size is not None and _admits(effect, size.coordinates)
    return RequiredCause(explanation=explanation, entry=effect, size=size, within=within)


def _of_error(residuals: ResidualProblem, error: SensorError) -> RequiredCause:
    size = _metric(residuals, error.name).of_columns(error.values[:, None], error.bound)
    within = size is not None and size.reach <= 1.0
    return RequiredCause(explanation=error.name, entry=error, size=size, within=within)


def _admits(effect: Effect, coordinates: tuple[float, ...]) -> bool:
    """Whether a size lies within the bounds; that of a harmonic by its amplitude."""
    if len(coordinates) > 1:
        return hypot(*coordinates) <= effect.reach
    low, high = effect.parameters[0].bounds
    return low <= coordinates[0] <= high


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

    def ends(self, diagnosis: Diagnosis) -> bool:
        """Whether a diagnosis ends in it: named, or located at its places."""
        if not self.unnamed:
            return diagnosis.decision.verdict == "named" and self.name in diagnosis.named
        return diagnosis.decision.verdict == "unknown_located" and mass_at(diagnosis, self.things) >= LOCATED


def mass_at(diagnosis: Diagnosis, things: Collection[str]) -> float:
    """Posterior mass of all explanations that stand for one of some things."""
    evaluation = diagnosis.evaluations[0]
    return sum(
        evaluation.weights.masses[explanation.hypothesis.name]
        for explanation in evaluation.evidence
        if _stands_for(explanation.hypothesis) in things
    )


def _stands_for(hypothesis: Hypothesis) -> str:
    """The place of what no catalogue has, if an explanation holds such a cause, else its first part."""
    unnamed = [part for part in hypothesis.parts if part.startswith(UNKNOWN)]
    return place_of((*unnamed, *hypothesis.parts)[0])


def leading(diagnosis: Diagnosis) -> list[Leading]:
    """The likeliest single explanations of different things, the members of a group first.

    Where nothing in the catalogue explains the data: causes in no catalogue as well, as many as hold `LOCATED` of the
    posterior mass together, at most `RIVALS`; all of these where a single effect holds it that the data contradict.
    """
    if diagnosis.decision.verdict == "unknown_located":
        credible = _credible(diagnosis, LOCATED)
        return credible if len(credible) > 1 or credible_places(diagnosis) else _credible(diagnosis, inf)
    masses, group = diagnosis.evaluations[0].weights.inclusion, diagnosis.decision.named
    best = {
        explanation.hypothesis.parts[0]: Leading(things=explanation.hypothesis.parts, evidence=explanation)
        for explanation in reversed(_singles(diagnosis, NAMED))
    }
    ordered = sorted(best.items(), key=lambda item: (item[0] not in group, -masses.get(item[0], 0.0)))
    return [lead for _, lead in ordered][:RIVALS]


def _singles(diagnosis: Diagnosis, families: Collection[str]) -> list[Evidence]:
    return [
        explanation
        for explanation in diagnosis.evaluations[0].evidence
        if explanation.hypothesis.family in families and len(explanation.hypothesis.parts) == 1
    ]


def _credible(diagnosis: Diagnosis, least: float) -> list[Leading]:
    """As many of the likeliest as hold a posterior mass together."""
    weights = diagnosis.evaluations[0].weights
    singles = sorted(
        _singles(diagnosis, NAMED | UNNAMED),
        key=lambda explanation: weights.masses[explanation.hypothesis.name],
    )
    best = {_stands_for(explanation.hypothesis): explanation for explanation in singles}
    masses = {cause: mass_at(diagnosis, [cause]) for cause in best}
    chosen: list[Leading] = []
    mass = 0.0
    for cause in sorted(masses, key=lambda cause: -masses[cause])[:RIVALS]:
        if mass >= least:
            break
        chosen.append(Leading(things=(cause,), evidence=best[cause], size=_size(diagnosis, cause)))
        mass += masses[cause]
    return chosen


def _size(diagnosis: Diagnosis, cause: str) -> float:
    """Of what is at a place, in the most probable explanation that holds it."""
    weights = diagnosis.evaluations[0].weights
    holding = [
        explanation
        for explanation in diagnosis.evaluations[0].evidence
        if _stands_for(explanation.hypothesis) == cause
    ]
    most = max(holding, key=lambda explanation: weights.masses[explanation.hypothesis.name])
    return next((sizes[0] for name, sizes in most.members if place_of(name) == cause and sizes), 0.0)


def credible_places(diagnosis: Diagnosis) -> list[Leading]:
    """The places of a cause in no catalogue, the likeliest first; none where they do not hold `LOCATED` together."""
    if not diagnosis.decision.outside:
        return []
    places = _credible(diagnosis, LOCATED)
    mass = mass_at(diagnosis, [cause for place in places for cause in place.things])
    return places if mass >= LOCATED and all(place.unnamed for place in places) else []


@dataclass(frozen=True, kw_only=True)
class Compared:
    """An explanation with what it foresees."""

    leading: Leading
    rival: Rival


def compared(
    whole: ResidualProblem, diagnosis: Diagnosis, explanations: Sequence[Leading], matrix: Array
) -> list[Compared]:
    """The explanations at their best fit, at the numbers measured and at those that could be.

    Causes in no catalogue that leave one trace in all that could be read are one: nothing tells them apart.

    whole : the numbers of the set followed by those that could be read; matrix : covariance of a healthy rig in them
    """
    answers = _answers(
        whole, [explanation.evidence for explanation in explanations if not explanation.unnamed]
    )
    unnamed = {name: columns for _, name, columns in unmodelled_causes(whole.library, whole.channels)}
    factor = np.linalg.cholesky(matrix)
    traced: list[tuple[Compared, Array]] = []
    for explanation in explanations:
        rival = (
            _fitted(explanation.name, unnamed[explanation.name.removeprefix(UNKNOWN)], diagnosis)
            if explanation.unnamed
            else _rival(explanation.evidence, answers[explanation.evidence.hypothesis.name])
        )
        trace = np.asarray(solve_triangular(factor, rival.answer, lower=True))
        for place, (other, seen) in enumerate(traced):
            if explanation.unnamed and other.leading.unnamed and _cosine(trace, seen) >= ALIAS:
                joined = replace(other.leading, things=(*other.leading.things, *explanation.things))
                traced[place] = replace(other, leading=joined), seen
                break
        else:
            traced.append((Compared(leading=explanation, rival=rival), trace))
    return [fit for fit, _ in traced]


def _answers(whole: ResidualProblem, rivals: Sequence[Evidence]) -> dict[str, Hypothesis]:
    """Of the rivals at all numbers, in the units of the features."""
    names = {rival.hypothesis.name for rival in rivals}
    effects = [
        effect for effect in whole.effects if any(f"{name}/".startswith(f"{effect.name}/") for name in names)
    ]
    everything = (
        *physical(None, whole.features, effects, whole.library.responses, whole.teeth_a_turn, 0.0),
        *sensor(None, [error for error in whole.errors if error.name in names]),
    )
    return {hypothesis.name: hypothesis for hypothesis in everything if hypothesis.name in names}


def _rival(explanation: Evidence, hypothesis: Hypothesis) -> Rival:
    sizes = np.array(explanation.coordinates)
    if hypothesis.curve is not None:
        answer, slopes = hypothesis.curve.at(sizes)[0], hypothesis.curve.sensitivity(float(sizes[0]))[:, None]
    else:
        slopes = hypothesis.columns
        answer = slopes @ sizes
    return Rival(
        name=explanation.hypothesis.name,
        answer=answer,
        slopes=slopes,
        deviations=np.array(explanation.deviations),
    )


def needed(whole: ResidualProblem, measured: int) -> list[Rival]:
    """With too few data: causes at the sizes at which each explains the residual, the least out of bounds first.

    The first one of a kind stands for all of it, and for others that leave the same trace in all that could be read.
    """
    causes = [required for required in required_causes(whole.rows(range(measured))) if _in_question(required)]
    rivals: dict[str, Rival] = {}
    for cause in sorted(
        causes, key=lambda required: (not required.within, required.size.reach if required.size else 0.0)
    ):
        assert cause.size is not None and isinstance(cause.entry, Effect)
        if cause.entry.kind in rivals:
            continue
        response = whole.library.responses[cause.entry.name]
        sizes = np.array(cause.size.coordinates)
        if response.nonlinear:
            answer = straight(response.coordinates[:, 0], response.answers, float(sizes[0]))
        else:
            answer = response.sensitivity() @ sizes
        if all(_cosine(answer, rival.answer) < ALIAS for rival in rivals.values()):
            rivals[cause.entry.kind] = _at_one_size(cause.explanation, answer)
    return list(rivals.values())[:RIVALS]


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


def _fitted(name: str, columns: Array, diagnosis: Diagnosis) -> Rival:
    """A cause without a name, (n + m, k) columns, at the size that fits the residual (n,) best."""
    measured = diagnosis.covariance.whiten(columns[: len(diagnosis.residual)])
    basis, upper = np.linalg.qr(measured)
    slopes = columns @ np.linalg.inv(upper)
    sizes = basis.T @ diagnosis.covariance.whiten(diagnosis.residual)
    return Rival(name=name, answer=slopes @ sizes, slopes=slopes, deviations=np.ones(len(sizes)))


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
    problem: Problem, diagnosis: Diagnosis, offered: Callable[[], Offer | None], calibration: Calibration
) -> NextMeasurements:
    """Measurements that tell the leading rivals apart; none where something is named.

    Of a single suspect: those that tell it from a healthy rig. Of a cause without a name: those that tell its place
    from other places and from the catalogue. With too few data to name anything: those that tell the causes apart at
    the sizes that each would need, or the leading one from a healthy rig where no two come into question. The set is
    verified by simulating it with each rival as the truth and diagnosing what it would read, not with too few data.

    offered : makes the offer, where there is something to distinguish; None if there is none
    """
    if diagnosis.decision.verdict not in UNDECIDED:
        return NOTHING_NEXT
    explanations = leading(diagnosis)
    insufficient = diagnosis.decision.verdict == "data_insufficient"
    alone = insufficient or (diagnosis.decision.verdict == "suspected" and len(diagnosis.decision.named) == 1)
    explanations = explanations[:1] if alone else explanations
    least = 1 if alone else 2
    if len(explanations) < least and not insufficient:
        return NOTHING_NEXT
    offer = offered()
    if offer is None:
        return NOTHING_NEXT
    whole, measured = _with_candidates(problem.residuals.rows(diagnosis.kept), offer.library)
    mean, matrix = problem.healthy(whole, calibration)
    causes = needed(whole, measured) if insufficient else []
    if len(causes) > 1:
        rivals, ends = causes, []
    else:
        causes, ends = [], compared(whole, diagnosis, explanations, matrix)
        if len(ends) < least:
            return NOTHING_NEXT
        rivals = [*(end.rival for end in ends), *([nothing(whole)] if alone else [])]
    foreseen = Foreseen.of(matrix, diagnosis.residual, rivals)
    offers = _offers(whole.features[measured:], whole.channels, offer)
    together = smallest_set(foreseen, offers)
    verified: tuple[tuple[str, bool], ...] = ()
    if together is not None and ends:
        simulation = Simulation(
            problem=problem, whole=whole, measured=measured, mean=mean, foreseen=foreseen, rows=together.rows
        )
        verified = simulation.verified([end.leading for end in ends], calibration)
    return NextMeasurements(
        ranked=ranked(foreseen, offers),
        together=together,
        verified=verified,
        causes=tuple(cause.name for cause in causes),
    )


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


def _offers(features: Sequence[Feature], channels: Mapping[str, Channel], offer: Offer) -> list[Proposal]:
    by_channel: dict[str, list[int]] = {}
    by_point: dict[str, list[int]] = {}
    for row, feature in enumerate(features):
        if feature.channel.startswith(SPARE):
            by_channel.setdefault(feature.channel, []).append(row)
        else:
            by_point.setdefault(feature.setting, []).append(row)
    sensors = [
        Proposal(
            title=f"a sensor: {name.removeprefix(SPARE)}",
            rows=tuple(rows),
            cost=offer.costs.of(channels[name].quantity),
        )
        for name, rows in by_channel.items()
    ]
    points = {extra.setting.name: extra for extra in offer.extras}
    return sensors + [
        Proposal(title=points[name].title, rows=tuple(rows), cost=offer.costs.of(points[name].changed))
        for name, rows in by_point.items()
        if name in points
    ]


# Readings that do not exist yet, simulated with an explanation as the truth, and what a diagnosis makes of them.

SEED = 20
"""Of the noise that is drawn."""


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """A set with further measurements, read as each rival foresees.

    whole : numbers of the set, then all that could be read; measured : how many are the set's
    mean : (n + m,) residual of a healthy rig; rows : of the candidates (m,) that are read
    """

    problem: Problem
    whole: ResidualProblem
    measured: int
    mean: Array
    foreseen: Foreseen
    rows: tuple[int, ...]

    def verified(
        self, explanations: Sequence[Leading], calibration: Calibration
    ) -> tuple[tuple[str, bool], ...]:
        """Explanation -> whether the diagnosis of its simulated readings names it, or locates what has no name."""
        return tuple(
            (
                explanation.name,
                explanation.ends(diagnose(replace(self.problem, residuals=self._read(number)), calibration)),
            )
            for number, explanation in enumerate(explanations)
        )

    def _read(self, number: int) -> ResidualProblem:
        """The set with the further readings as one rival foresees them, with their scatter."""
        rows = np.array(self.rows, dtype=np.intp)
        scatter = np.linalg.cholesky(self.foreseen.left[np.ix_(rows, rows)])
        drawn = scatter @ np.random.default_rng(SEED + number).normal(size=len(rows))
        places = [*range(self.measured), *(self.measured + rows)]
        cut = self.whole.rows(places)
        new = (
            (self.whole.library.base + self.mean)[self.measured + rows]
            + self.foreseen.values[number][rows]
            + drawn
        )
        points = {feature.setting for feature in cut.features}
        run = tuple(setting for setting in cut.library.settings if setting.name in points)
        inputs = {key: column for key, column in cut.library.inputs.items() if key[2] in points}
        return replace(
            cut,
            values=np.concatenate([self.whole.values[: self.measured], new]),
            library=replace(cut.library, settings=run, inputs=inputs),
        )

"""What to measure next: the rivals of a diagnosis against every further measurement of the rig."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rigdesign.case.model import Case
from rigdesign.diagnosis.decision.competing_causes import Leading, compared, leading, needed, nothing
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.problem import Problem
from rigdesign.diagnosis.decision.workflow import Diagnosis, diagnose
from rigdesign.diagnosis.library.candidates import NOISE, SPARE, Extra, extra_points
from rigdesign.diagnosis.library.costs import Costs
from rigdesign.diagnosis.library.library import Library
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.next_measurement import (
    Foreseen,
    Proposal,
    Ranked,
    SmallestSet,
    ranked,
    smallest_set,
)
from rigdesign.diagnosis.statistics.reference_scale import reference_scale
from rigdesign.measurement.places import Places
from rigdesign.prediction.model import Channel, Feature, OperatingCondition


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

    Of a single suspect: those that tell it from a healthy rig. Of a cause without a name: those that tell its place
    from other places and from the catalogue. With too few data to name anything: those that tell the causes apart at
    the sizes that each would need, or the leading one from a healthy rig where no two come into question. The set is
    verified by simulating it with each rival as the truth and diagnosing what it would read, not with too few data.

    offered : makes the offer, where there is something to distinguish; None if there is none
    """
    if found.decision.verdict not in UNDECIDED:
        return NOTHING_NEXT
    explanations = leading(found)
    insufficient = found.decision.verdict == "data_insufficient"
    alone = insufficient or (found.decision.verdict == "suspected" and len(found.decision.named) == 1)
    explanations = explanations[:1] if alone else explanations
    least = 1 if alone else 2
    if len(explanations) < least and not insufficient:
        return NOTHING_NEXT
    offer = offered()
    if offer is None:
        return NOTHING_NEXT
    whole, measured = _with_candidates(problem.residuals.rows(found.kept), offer.library)
    mean, matrix = problem.healthy(whole, calibration)
    causes = needed(whole, measured) if insufficient else []
    if len(causes) > 1:
        rivals, ends = causes, []
    else:
        causes, ends = [], compared(whole, found, explanations, matrix)
        if len(ends) < least:
            return NOTHING_NEXT
        rivals = [*(one.rival for one in ends), *([nothing(whole)] if alone else [])]
    foreseen = Foreseen.of(matrix, found.residual, rivals)
    offers = _offers(whole.features[measured:], whole.channels, offer)
    together = smallest_set(foreseen, offers)
    verified: tuple[tuple[str, bool], ...] = ()
    if together is not None and ends:
        simulation = Simulation(
            problem=problem, whole=whole, measured=measured, mean=mean, foreseen=foreseen, rows=together.rows
        )
        verified = simulation.verified([one.leading for one in ends], calibration)
    return NextMeasurements(
        ranked=ranked(foreseen, offers),
        together=together,
        verified=verified,
        causes=tuple(one.name for one in causes),
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
            (one.name, one.ends(diagnose(replace(self.problem, residuals=self._read(number)), calibration)))
            for number, one in enumerate(explanations)
        )

    def _read(self, number: int) -> ResidualProblem:
        """The set with the further readings as one rival foresees them, with their scatter."""
        at = np.array(self.rows, dtype=np.intp)
        scatter = np.linalg.cholesky(self.foreseen.left[np.ix_(at, at)])
        drawn = scatter @ np.random.default_rng(SEED + number).normal(size=len(at))
        places = [*range(self.measured), *(self.measured + at)]
        cut = self.whole.rows(places)
        new = (
            (self.whole.library.base + self.mean)[self.measured + at]
            + self.foreseen.values[number][at]
            + drawn
        )
        points = {feature.setting for feature in cut.features}
        run = tuple(one for one in cut.library.settings if one.name in points)
        inputs = {key: column for key, column in cut.library.inputs.items() if key[2] in points}
        return replace(
            cut,
            values=np.concatenate([self.whole.values[: self.measured], new]),
            library=replace(cut.library, settings=run, inputs=inputs),
        )

"""The residual of a healthy rig between data and model: the columns of the covariance.

Every parameter of the catalogue that is never known exactly is a constant with its healthy spread; every local
conductance of the thermal model is a link of its own, since one wrong film moves many sensors together; losses may
enter elsewhere, laws may have other exponents, sensors and inputs have the systematic errors the measurement states.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve, solve_triangular
from scipy.sparse import csr_array
from scipy.special import logsumexp

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import NEAR_SENSOR, Library
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.columns import Array, Column, ModelError, series_numbers
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import (
    Evidence,
    Hypothesis,
    best_within,
    deviations_of,
    inverse_of,
    mixed,
    release_of,
)
from rigdesign.diagnosis.statistics.resonance import CloseModes
from rigdesign.prediction.model import (
    MODAL_QUANTITIES,
    ORDER_QUANTITIES,
    Channel,
    Feature,
    OperatingCondition,
)


def healthy_columns(
    library: Library,
    effects: Sequence[Effect],
    channels: Mapping[str, Channel],
    mesh_orders: frozenset[float],
    level: Array,
) -> tuple[Column, ...]:
    """All columns of the model itself; those of sensors and inputs come from the measurement.

    level : (n,) of every number (`rigdesign.diagnosis.statistics.columns`)
    """
    speed = relative_speed(library.features, library.settings)
    return (
        *_constants(library, effects),
        *_exponents(library, effects),
        *_links(library, effects, speed),
        *_sources(library),
        *_channels(library.features, level, speed, channels),
        *_series(library.features, level, speed, channels, mesh_orders),
        *mode_columns(library.features, level, channels),
    )


def relative_speed(features: Sequence[Feature], settings: Sequence[OperatingCondition]) -> Array:
    """(n,) logarithm of the speed of each number's point over the geometric mean of the points; zero at rest."""
    return _relative(features, {setting.name: float(np.log(setting.speed)) for setting in settings})


def relative_torque(features: Sequence[Feature], settings: Sequence[OperatingCondition]) -> Array:
    """The same of the torque."""
    return _relative(
        features, {setting.name: float(np.log(max(abs(setting.torque), 1e-3))) for setting in settings}
    )


def _relative(features: Sequence[Feature], logs: Mapping[str, float]) -> Array:
    mean = float(np.mean(list(logs.values()))) if logs else 0.0
    return np.array([logs.get(feature.setting, mean) - mean for feature in features])


def _constants(library: Library, effects: Sequence[Effect]) -> list[Column]:
    wanted = [effect for effect in effects if effect.healthy > 0.0 and effect.name in library.responses]
    return [
        Column(
            name=f"{effect.name}/{number}",
            kind=effect.family.amplitude,
            values=values,
            spread=effect.healthy,
            effect=effect.name,
        )
        for effect in wanted
        for number, values in enumerate(library.responses[effect.name].sensitivity().T)
    ]


def _exponents(library: Library, effects: Sequence[Effect]) -> list[Column]:
    """By the exponents of the loss laws, about the mean point.

    An exponent scales the loss of each point by itself, and a number follows its own point only: the derivative is
    that by the logarithm of the loss times the logarithm of the point's ratio.
    """
    ratio = {
        "speed": relative_speed(library.features, library.settings),
        "torque": relative_torque(library.features, library.settings),
    }
    return [
        Column(
            name=f"{effect.kind.replace('_', ' ')} of {effect.place} over {law}",
            kind="exponent",
            values=library.responses[effect.name].sensitivity()[:, 0] * ratio[law],
            spread=1.0,
        )
        for effect in effects
        if effect.name in library.responses
        for law in effect.exponents
    ]


def _links(library: Library, effects: Sequence[Effect], speed: Array) -> list[Column]:
    """Every local conductance by itself, what those of one film share as the film's own.

    A film that an effect scales and the conductances it is made of are one logarithm: what they share belongs to the
    effect, and with it goes out of the covariance while that effect is tested. Left in, its straight answer would
    cancel the effect's own, and any size could be had for its curvature alone.
    """
    shared: dict[str, Array] = {}
    columns = []
    for effect in effects:
        scaled = [name for name in library.links if effect.scales(name)]
        if not scaled or effect.name not in library.responses:
            continue
        whole = np.sum([library.links[name] for name in scaled], axis=0)
        spread = len(scaled) ** -0.5
        columns.append(
            Column(
                name=f"{effect.name} as a whole", kind="link", values=whole, spread=spread, effect=effect.name
            )
        )
        shared |= dict.fromkeys(scaled, whole / len(scaled))
    for name, values in library.links.items():
        alone = values - shared[name] if name in shared else values
        columns.append(Column(name=name, kind="link", values=alone, spread=1.0))
        columns.append(Column(name=f"{name} by speed", kind="link_speed", values=values * speed, spread=1.0))
    return columns


def _sources(library: Library) -> list[Column]:
    """Misplaced heat in proportion to all losses of the point; the motor pays nothing for it."""
    power = power_of(library)
    return [
        Column(name=name, kind="source", values=values * power, spread=1.0)
        for name, values in library.dry_sources.items()
        if not name.startswith(NEAR_SENSOR)
    ]


def power_of(library: Library) -> Array:
    """(n,) losses at each number's point [W]; zero at rest."""
    return np.array([library.powers.get(feature.setting, 0.0) for feature in library.features])


def _channels(
    features: Sequence[Feature], level: Array, speed: Array, channels: Mapping[str, Channel]
) -> list[Column]:
    """A smooth error of every channel that reads no orders."""
    columns = []
    for name, channel in channels.items():
        if channel.quantity in ORDER_QUANTITIES | MODAL_QUANTITIES:
            continue
        values = np.array([feature.channel == name for feature in features], dtype=np.float64) * level
        if values.any():
            columns.append(Column(name=f"channel {name}", kind="channel", values=values, spread=1.0))
            columns.append(
                Column(
                    name=f"channel {name} by speed", kind="channel_speed", values=values * speed, spread=1.0
                )
            )
    return columns


def _series(
    features: Sequence[Feature],
    level: Array,
    speed: Array,
    channels: Mapping[str, Channel],
    mesh_orders: frozenset[float],
) -> list[Column]:
    """Errors of one order of one channel that are coherent over the points: constant and by speed."""
    columns = []
    for key in dict.fromkeys((f.channel, f.order, f.part) for f in features):
        name, order, part = key
        if channels[name].quantity not in ORDER_QUANTITIES:
            continue
        values = np.array([(f.channel, f.order, f.part) == key for f in features], dtype=np.float64) * level
        kind = series_kind(order, mesh_orders)
        label = f"{name} order {order:g} {part}"
        columns.append(Column(name=label, kind=kind, values=values, spread=1.0))
        columns.append(Column(name=f"{label} by speed", kind=kind, values=values * speed, spread=1.0))
    return columns


def series_kind(order: float, mesh_orders: frozenset[float]) -> str:
    """Amplitude of an order of torque or angle."""
    if order == 0.0:
        return "series_mean"
    return "series_mesh" if order in mesh_orders else "series_shaft"


TREND = 0.5
"""Error of an answer along the speed (per factor e) over that at all points alike."""


def answer_error(library: Library, effects: Sequence[Effect]) -> Array:
    """(n, n) covariance of answers to constants of the heat that are wrong by as much as they are, series by series.

    A healthy rig has its constants off by their spreads, and no model passes that on exactly: what is admitted to an
    explanation (below) a healthy rig has as well.
    """
    answers = [
        effect.healthy * library.responses[effect.name].sensitivity()
        for effect in effects
        if effect.healthy > 0.0 and effect.family.heat and effect.name in library.responses
    ]
    count = len(library.features)
    if not answers:
        return np.zeros((count, count))
    speed = relative_speed(library.features, library.settings)
    series = series_numbers(library.features)
    both = np.hstack(answers)
    along = TREND * speed
    share = (series[:, None] == series) * (1.0 + np.outer(along, along))
    return np.asarray(both @ both.T * share)


def own_spread(
    features: Sequence[Feature],
    channels: Mapping[str, Channel],
    mesh_orders: frozenset[float],
    level: Array,
    amplitudes: Amplitudes,
) -> Array:
    """(n,) standard deviation of what each number is off by itself, noise left out."""
    share = []
    for feature in features:
        quantity = channels[feature.channel].quantity
        if quantity in MODAL_QUANTITIES:
            share.append(amplitudes.frequency)
        elif quantity in ORDER_QUANTITIES and feature.order:
            mesh = feature.order in mesh_orders
            share.append(amplitudes.series_mesh_point if mesh else amplitudes.series_shaft_point)
        else:
            share.append(amplitudes.point)
    return np.array(share) * level


# Modes of the gauges of a gear over its face: common, tilt, curvature, and what is left at each gauge.
#
# Evidence does not depend on whether numbers stand by gauge or by mode, so that gauges may be missing; modes say where
# a residual is, and how large an error of the contact model is in each.

MODES = ("common", "tilt", "curvature")
"""Polynomials over the face, of rising order, orthonormal over the gauges."""
MODEL_ERROR = {"common": 0.07, "tilt": 0.03, "curvature": 0.02}
"""Error of the contact model in a mode and window, alike at all points, over the strain [-]: P1 finds up to 7 % between
gauges and two tooth contact analyses."""
POINT_ERROR = {"common": 0.01, "tilt": 0.005, "curvature": 0.005}
"""The same point by point."""


@dataclass(frozen=True, kw_only=True)
class GaugeRow:
    """The gauges of a gear in one window at one point.

    rows : of their numbers; shapes : mode -> (m,) over the gauges, orthonormal
    """

    gear: str
    window: str
    point: str
    rows: tuple[int, ...]
    shapes: Mapping[str, Array]


def gauge_rows(features: Sequence[Feature], channels: Mapping[str, Channel]) -> Iterator[GaugeRow]:
    """All gauges by gear, window and point."""
    gauges: dict[tuple[str, str, str], list[int]] = {}
    for row, feature in enumerate(features):
        channel = channels[feature.channel]
        if channel.quantity == "root_strain" and feature.part != "unloaded":
            gear = channel.place.rpartition(".")[0]
            gauges.setdefault((gear, feature.part, feature.setting), []).append(row)
    for (gear, window, point), rows in gauges.items():
        face = np.array([channels[features[row].channel].face for row in rows])
        yield GaugeRow(gear=gear, window=window, point=point, rows=tuple(rows), shapes=shapes_over(face))


def shapes_over(face: Array) -> dict[str, Array]:
    """Mode -> (m,) over gauges at face positions (m,) [m]; as many modes as there are different positions."""
    count = min(len(np.unique(face)), len(MODES))
    scaled = (face - face.mean()) / max(float(np.ptp(face)), 1e-9)
    basis, upper = np.linalg.qr(np.vander(scaled, count, increasing=True))
    signs = np.sign(np.diagonal(upper))
    return {mode: basis[:, k] * signs[k] for k, mode in enumerate(MODES[:count])}


def mode_columns(features: Sequence[Feature], level: Array, channels: Mapping[str, Channel]) -> list[Column]:
    """Errors of the contact model by gear, window and mode: alike at all points, and point by point.

    level : (n,) strain of each number [-]
    """
    alike: dict[tuple[str, str, str], Array] = {}
    columns = []
    for row in gauge_rows(features, channels):
        gauges = np.array(row.rows, dtype=np.intp)
        for mode, shape in row.shapes.items():
            here = np.zeros(len(features))
            # a shape of unit mean square over the gauges: the share is of the strain of one gauge
            here[gauges] = shape * np.sqrt(len(gauges)) * float(level[gauges].mean())
            key = (row.gear, row.window, mode)
            alike[key] = alike.get(key, np.zeros(len(features))) + here
            name = f"{mode} of the gauges of {row.gear}, {row.window}"
            columns.append(
                Column(name=f"{name}, {row.point}", kind="sensor", values=here, spread=POINT_ERROR[mode])
            )
    columns += [
        Column(name=f"{mode} of the gauges of {gear}, {window}", kind="sensor", values=values, spread=MODEL_ERROR[mode])
        for (gear, window, mode), values in alike.items()
    ]  # fmt: skip
    return columns


# What a model may answer wrongly to a right cause, admitted to every explanation alike.
#
# A cause in the model never leaves exactly the trace it leaves on the rig. An explanation with the answer a is
# therefore evaluated under C + E E': every series of numbers (one channel, one order) may be off by a share of its own
# answer, the same over all points and along the speed, and orders by themselves
# (`rigdesign.diagnosis.statistics.columns`). Natural frequencies that lie close together may divide a change
# between them in another way (`rigdesign.diagnosis.statistics.resonance`). With no cause there is no answer and no
# such error, so that a small effect is not hidden by it; rivals that differ by less than the model error are separated
# by their priors alone.
#
# C^-1 is known; E is of low rank, so that all products follow from block sums (Woodbury's identity).

EXACT = ("sensor", "input")
"""Families whose trace is known exactly."""

CONTENDERS = 60
"""Explanations, best first, whose own error is admitted; the others are too far behind."""


SLIGHT = 0.1
"""Error of one number by itself that is left out [standard deviations of its residual on a healthy rig]."""

SHARES = (1.0, 0.3, 0.1)
"""Of the error of every number by itself: how far an answer is off is not known, and numbers that follow it closely are
no sign of an answer that is off by all that is admitted."""

MOST_ALONE = 400
"""Numbers whose model error counts, those with the largest."""


@dataclass(frozen=True, kw_only=True)
class Signature:
    """Series of the numbers of a comparison, and how wrong answers may be.

    order : (n,) places of the numbers sorted by series; starts : (s,) where each begins in it
    trend : (n,) logarithm of the relative speed; errors : kind of effect -> relative error, "" for the others
    own : error of every number by itself, if there is one; modes : natural frequencies among the numbers
    circuit : effects that change what goes through the circuit
    """

    order: NDArray[np.intp]
    starts: NDArray[np.intp]
    trend: Array
    errors: Mapping[str, float]
    own: ModelError | None
    modes: CloseModes
    circuit: frozenset[str]

    @classmethod
    def of(
        cls,
        features: Sequence[Feature],
        trend: Array,
        errors: Mapping[str, float],
        own: ModelError | None = None,
        modes: CloseModes | None = None,
        circuit: frozenset[str] = frozenset(),
    ) -> "Signature":
        """Of the numbers of a comparison."""
        series = series_numbers(features)
        order = np.argsort(series, kind="stable")
        starts = np.searchsorted(series[order], np.arange(series.max(initial=-1) + 1))
        none = CloseModes.of(np.zeros(len(features)), 0.0)
        return cls(
            order=order,
            starts=starts,
            trend=trend,
            errors=errors,
            own=own,
            modes=modes or none,
            circuit=circuit,
        )

    def error_of(self, hypothesis: Hypothesis) -> float:
        """Relative error of the answer of an explanation; the largest of its parts."""
        if hypothesis.family in EXACT:
            return 0.0
        kinds = [part.split(":")[0].split("/")[0] for part in hypothesis.parts]
        return max(self.errors.get(kind, self.errors.get("", 0.0)) for kind in kinds)

    def rows(
        self, hypothesis: Hypothesis, answer: Array, precision: Array
    ) -> tuple[csr_array, NDArray[np.bool_]]:
        """(m, n) rows of E' for an answer (n,): series alike at all points, along the speed, numbers by themselves, and
        pairs of natural frequencies.

        precision : (n,) diagonal of the inverse covariance of a healthy rig

        Beside them (m,) whether a row is of a number by itself.
        """
        alike = self.error_of(hypothesis) * answer
        along = TREND * alike * self.trend
        places, alone = self._alone(hypothesis, answer, precision)
        pairs = np.stack([self.modes.first, self.modes.second], axis=1)
        exchanged = np.stack(self.modes.errors(answer), axis=1)
        values = np.concatenate([alike[self.order], along[self.order], alone, exchanged.ravel()])
        count, by_number = len(answer), 2 * len(answer) + np.arange(len(places) + 1)
        by_pair = by_number[-1] + 2 * np.arange(1, len(pairs) + 1)
        ends = np.concatenate([self.starts, count + self.starts, by_number, by_pair])
        across = np.concatenate([self.order, self.order, places, pairs.ravel()])
        alone_rows = np.repeat([False, True, False], [2 * len(self.starts), len(places), len(pairs)])
        return csr_array((values, across, ends), shape=(len(ends) - 1, count)), alone_rows

    def _alone(
        self, hypothesis: Hypothesis, answer: Array, precision: Array
    ) -> tuple[NDArray[np.intp], Array]:
        """Places (k,) of numbers whose model error adds to the residual of a healthy rig, and the errors (k,)."""
        if self.own is None:
            return np.zeros(0, dtype=np.intp), np.zeros(0)
        errors = self.own.at(answer, circuit=not self.circuit.isdisjoint(hypothesis.parts))
        seen = errors * np.sqrt(precision)
        largest = np.argsort(-seen, kind="stable")[:MOST_ALONE]
        places = np.sort(largest[seen[largest] > SLIGHT])
        return places, errors[places]

    def columns(self, hypothesis: Hypothesis, answer: Array, precision: Array) -> list[Column]:
        """The error of an answer (n,) as columns of a covariance; none where it is exact."""
        if self.error_of(hypothesis) == 0.0:
            return []
        rows = self.rows(hypothesis, answer, precision)[0].toarray()
        return [
            Column(name=f"answer to {hypothesis.name}, {number}", kind="signature", values=row, spread=1.0)
            for number, row in enumerate(rows)
            if row.any()
        ]


@dataclass(frozen=True)
class Contest:
    """Explanations of one residual, each under the covariance that belongs to its own answer."""

    space: Whitened
    signature: Signature

    def evaluated(self, evidence: Sequence[Evidence]) -> list[Evidence]:
        """The best of them evaluated again, the others as they were."""
        ordered = sorted(evidence, key=lambda explanation: -explanation.log_bayes)
        return [self.again(explanation) for explanation in ordered[:CONTENDERS]] + ordered[CONTENDERS:]

    def again(self, explanation: Evidence) -> Evidence:
        """One explanation, linear about its best fit, with the error of its answer there."""
        if (
            self.signature.error_of(explanation.hypothesis) == 0.0
            or not explanation.columns.shape[1]
            or not np.any(explanation.answer)
        ):
            return explanation
        base = explanation.answer - explanation.columns @ np.array(explanation.coordinates)
        products = _Products.of(self, explanation, base)
        shares = SHARES if products.alone.any() else SHARES[:1]
        at_shares = [self._at(products, explanation, base, share) for share in shares]
        log_bayes = float(logsumexp([other.log_bayes for other in at_shares])) - float(np.log(len(shares)))
        return replace(max(at_shares, key=lambda other: other.log_bayes), log_bayes=log_bayes)

    def _at(self, products: "_Products", explanation: Evidence, base: Array, share: float) -> Evidence:
        """One explanation with a share of the error of every number by itself."""
        inner, logarithm = products.inside(share)
        count = explanation.columns.shape[1]
        gram, load, square = inner[:count, :count], inner[:count, count], float(inner[count, count])
        fall = self.space.chi_square - square
        inverse = inverse_of(gram)
        best = best_within(gram, load, inverse @ load, explanation.hypothesis.bounds)
        gain = fall + float(2.0 * best @ load - best @ gram @ best)
        return replace(
            explanation,
            log_bayes=min(mixed(gram, load, explanation.spreads) + 0.5 * fall, 0.5 * gain) - 0.5 * logarithm,
            coordinates=tuple(float(value) for value in best),
            deviations=deviations_of(inverse),
            gain=gain,
            answer=base + explanation.columns @ best,
        )


@dataclass(frozen=True, kw_only=True)
class _Products:
    """What products of columns (m, m) under C - U U' + s E s E' are made of, for any share s of the errors by number.

    own, errors, columns : products with themselves: of what is released, of the errors of the answer, of the columns
    reached : of the errors with what is released; through_own, through_errors : of these with the columns
    alone : (k,) whether an error is of a number by itself
    """

    own: Array
    reached: Array
    errors: Array
    through_own: Array
    through_errors: Array
    columns: Array
    alone: NDArray[np.bool_]

    @classmethod
    def of(cls, contest: Contest, explanation: Evidence, base: Array) -> "_Products":
        space, lower = contest.space, contest.space.covariance.lower
        released = release_of(space, explanation.hypothesis.own).directions
        columns = np.column_stack([explanation.columns, space.freed(explanation.hypothesis.own) - base])
        rows, alone = contest.signature.rows(
            explanation.hypothesis, lower @ explanation.answer, np.diagonal(space.precision)
        )
        solved = solve_triangular(
            lower, np.hstack([released, columns]), lower=True, trans="T", check_finite=False
        )
        reached = rows @ solved
        taken = released.shape[1]
        return cls(
            own=released.T @ released,
            reached=reached[:, :taken],
            errors=rows @ (rows @ space.precision).T,
            through_own=released.T @ columns,
            through_errors=reached[:, taken:],
            columns=columns.T @ columns,
            alone=alone,
        )

    def inside(self, share: float) -> tuple[Array, float]:
        """Products of the columns (m, m), and the logarithm of the determinant over that of C."""
        scale = np.where(self.alone, share, 1.0)[:, None]
        across = scale * self.reached
        inside = np.block([[self.own, across.T], [across, scale * self.errors * scale.T]])
        diagonal = np.arange(len(inside))
        inside[diagonal, diagonal] += np.where(diagonal < len(self.own), -1.0, 1.0)
        through = np.vstack([self.through_own, scale * self.through_errors])
        factors = lu_factor(inside, overwrite_a=True, check_finite=False)
        products = self.columns - through.T @ lu_solve(factors, through, check_finite=False)
        return products, float(np.log(np.abs(np.diagonal(factors[0]))).sum())

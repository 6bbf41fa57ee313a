"""What is to be explained: readings less prediction, and the covariance of the residual of a healthy rig.

What is left given a healthy set of the same rig is in `rigdesign.diagnosis.residual.baseline`. What the model answers
wrongly to a right cause is evaluated with each cause (`rigdesign.diagnosis.residual.healthy`).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve

from rigdesign.diagnosis.catalogue.effects import FILM, LOSS, Effect
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.residual.healthy import answer_error, healthy_columns, own_spread
from rigdesign.diagnosis.residual.hypotheses import heats
from rigdesign.diagnosis.residual.sensors import (
    SensorError,
    Stated,
    input_errors,
    sensor_errors,
    setting_scatter,
)
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.columns import Array, Column, Turning, amplitudes_of, reference_scale
from rigdesign.diagnosis.statistics.covariance import Covariance, Outlier, Whitened, reject
from rigdesign.diagnosis.statistics.evidence import Curve
from rigdesign.diagnosis.statistics.resonance import Resonances
from rigdesign.measurement import Data
from rigdesign.prediction.model import ORDER_QUANTITIES, STANDING_QUANTITIES, Channel, Feature

# Directions in which the numbers of a set go with one cause each, of the catalogue or without a name.
#
# Along them calibration asks how far healthy rigs go beyond what the columns of their constants span, and inflates the
# covariance by that.


@dataclass(frozen=True, kw_only=True)
class Direction:
    """Change of the numbers per coordinate of one cause.

    likeness : what it shares with such causes elsewhere and on other rigs; reach : largest coordinate that is believed
    values : (n, k), one column for each parameter
    """

    likeness: str
    reach: float
    values: Array


def directions(library: Library, effects: Sequence[Effect], teeth_a_turn: int) -> Iterator[Direction]:
    """Of all effects the sensors answer to, of every tooth that may be meant; and of heat at any place.

    A nonlinear response has a direction at neutral and one to every run. The coordinate of heat is its share of
    the mean losses of the points.
    """
    turning = Turning.of(library.features)
    for effect in effects:
        response = library.responses.get(effect.name)
        if response is None:
            continue
        rows = _courses(response)
        for tooth in range(max(effect.any_tooth, 1)):
            turned = turning.turned(rows, tooth, teeth_a_turn) if tooth else rows
            yield Direction(likeness=effect.likeness, reach=effect.reach, values=turned.T)
    losses = float(np.mean(list(library.powers.values()))) if library.powers else 0.0
    if losses > 0.0:
        for heat in heats(library):
            yield Direction(likeness=heat.likeness, reach=1.0, values=losses * heat.values[:, None])


def _courses(response: Response) -> Array:
    """(k, n) sensitivities at neutral; of a nonlinear response the secants to its runs as well."""
    slopes = response.sensitivity().T
    if not response.nonlinear:
        return slopes
    places = response.coordinates[:, 0]
    away = places != 0.0
    return np.vstack([slopes, response.answers[away] / places[away, None]])


WITHOUT_HEAT = STANDING_QUANTITIES | {"root_strain"}
"""Quantities that heat hardly moves, besides orders of what oscillates."""


@dataclass(frozen=True, kw_only=True)
class ResidualProblem:
    """One set held against the library of its rig, on the numbers that are usable.

    values, noise : (n,)
    """

    features: tuple[Feature, ...]
    values: Array
    noise: Array
    library: Library
    channels: Mapping[str, Channel]
    effects: tuple[Effect, ...]
    errors: tuple[SensorError, ...]
    scatter: Array
    """(n, n) covariance from the random error of the settings read."""
    mesh_orders: frozenset[float]
    teeth_a_turn: int
    """Of the reference gear."""
    level: Array
    """(n,) over which errors of the model are relative (`rigdesign.diagnosis.statistics.columns`)."""

    @cached_property
    def of_mesh(self) -> NDArray[np.bool_]:
        """(n,) whether a number is of an order of the meshes."""
        return np.array([feature.order in self.mesh_orders for feature in self.features], dtype=bool)

    @cached_property
    def of_heat(self) -> NDArray[np.bool_]:
        """(n,) whether a number is of the heat or a mean torque; not of what oscillates, nor of the rig at rest."""
        quantities = [self.channels[feature.channel].quantity for feature in self.features]
        return np.array(
            [
                quantity not in WITHOUT_HEAT and not (quantity in ORDER_QUANTITIES and feature.order)
                for quantity, feature in zip(quantities, self.features, strict=True)
            ],
            dtype=bool,
        )

    @cached_property
    def natural_frequencies(self) -> Array:
        """(n,) as predicted, zero for numbers that are none."""
        modal = [self.channels[feature.channel].quantity == "natural_frequency" for feature in self.features]
        return np.where(modal, self.library.base, 0.0)

    @cached_property
    def resonances(self) -> Resonances:
        """Natural frequencies that its orders may lie near."""
        quantities = [self.channels[feature.channel].quantity for feature in self.features]
        return Resonances(
            features=self.features,
            settings=self.library.settings,
            modes=self._modes,
            of_angle=np.array([quantity == "angle" for quantity in quantities], dtype=bool),
            teeth=self.teeth_a_turn,
        )

    @cached_property
    def shift(self) -> Array:
        """(n,) change of orders of shafts and sidebands, as read, by the logarithm of the natural frequencies."""
        read = np.where(self.of_mesh, 0.0, amplitudes_of(self.features, self.values))
        return self.resonances.shift(read)

    @property
    def _modes(self) -> Array:
        """Natural frequencies [rad/s], predicted and as measured: resonances of what is predicted and of what is
        read."""
        measured = self.values[(self.natural_frequencies > 0.0) & (self.values > 0.0)]
        return np.concatenate([self.library.modes, 2.0 * np.pi * measured])

    @property
    def residual(self) -> Array:
        """Readings less prediction."""
        return np.asarray(self.values - self.library.base)

    def rows(self, keep: Sequence[int]) -> "ResidualProblem":
        """The comparison cut to some of its numbers, in their order."""
        places = np.array(keep, dtype=np.intp)
        features = tuple(self.features[place] for place in places)
        return ResidualProblem(
            features=features,
            values=self.values[places],
            noise=self.noise[places],
            library=self.library.rows(features),
            channels=self.channels,
            effects=self.effects,
            errors=tuple(replace(error, values=error.values[places]) for error in self.errors),
            scatter=self.scatter[np.ix_(places, places)],
            mesh_orders=self.mesh_orders,
            teeth_a_turn=self.teeth_a_turn,
            level=self.level[places],
        )  # fmt: skip

    def on_the_scale_of(self, other: "ResidualProblem") -> "ResidualProblem":
        """The same with orders over the reference scale that they have in another set of the rig.

        What the model has wrong in both is the same amount; its own reference scale follow speeds that were met
        differently.
        """
        there = {
            (feature.channel, feature.order): level
            for feature, level in zip(other.features, other.level, strict=True)
        }
        level = [
            there.get((feature.channel, feature.order), here) if feature.order else here
            for feature, here in zip(self.features, self.level, strict=True)
        ]
        return replace(self, level=np.array(level))

    def own_spread(self, amplitudes: Amplitudes) -> Array:
        """(n,) standard deviation of what each number is off by itself, noise left out."""
        return own_spread(self.features, self.channels, self.mesh_orders, self.level, amplitudes)

    def base_noise(self, amplitudes: Amplitudes) -> Array:
        """(n, n) covariance of noise, settings read and what each number is off by itself."""
        spread = self.own_spread(amplitudes)
        near = amplitudes.frequency * self.shift
        alone = np.diag(self.noise**2 + spread**2 + near**2 + self.library.error**2 * self._thermal)
        return np.asarray(alone + amplitudes.answer**2 * self.answer_error + self.scatter)

    @cached_property
    def sensor_shifts(self) -> Array:
        """(n, k) shifts of sensors and settings by what is stated of each: offset, scale and repeatability.

        Of a thermocouple the scale is conduction along its leads, which stays with its seat: it shifts by its offset.
        """
        seated = {
            f"sensor_scale:{n}" for n, channel in self.channels.items() if channel.quantity == "temperature"
        }
        shifts = [error.spread * error.values for error in self.errors if error.name not in seated]
        for name in dict.fromkeys(feature.channel for feature in self.features):
            of_channel = np.array(
                [feature.channel == name and not feature.order for feature in self.features], dtype=np.float64
            )
            if of_channel.any():
                shifts.append(of_channel * np.sqrt(np.mean(self.noise[of_channel > 0.0] ** 2)))
        return np.array(shifts).reshape(-1, len(self.features)).T

    @cached_property
    def daily_changes(self) -> Array:
        """(n, k) by the logarithm of every loss and film, which a rig does not repeat from day to day."""
        known = self.library.responses
        moving = [
            known[effect.name].sensitivity()[:, :1]
            for effect in self.effects
            if effect.family in (LOSS, FILM)
            and effect.healthy > 0.0
            and effect.parameters[0].factor
            and effect.name in known
        ]
        return np.hstack(moving) if moving else np.zeros((len(self.features), 0))

    @cached_property
    def answer_error(self) -> Array:
        """(n, n) covariance of what the answers to its constants have wrong, at an amplitude of one."""
        return answer_error(self.library, self.effects)

    def columns(self) -> tuple[Column, ...]:
        """Columns of the model, of sensors and of settings."""
        model = healthy_columns(self.library, self.effects, self.channels, self.mesh_orders, self.level)
        return (*model, *(error.column() for error in self.errors))

    def covariance(self, amplitudes: Amplitudes, inflation: Mapping[str, float] | None = None) -> Covariance:
        """Of a healthy rig; ``inflation``: likeness of cause -> spread [coordinate] that calibration found missing."""
        base = self.base_noise(amplitudes) + self.inflated(inflation or {})
        return Covariance(base=base, columns=self.columns(), amplitudes=amplitudes.as_dict())

    def curves(self) -> dict[str, Curve]:
        """Effect -> its answer over its size, of nonlinear constants of one parameter."""
        curves = {}
        for effect in self.effects:
            response = self.library.responses.get(effect.name)
            if effect.healthy > 0.0 and response is not None and response.nonlinear:
                curves[effect.name] = Curve.of(response.coordinates[:, 0], response.answers)
        return curves

    @property
    def _thermal(self) -> Array:
        quantities = (self.channels[feature.channel].quantity for feature in self.features)
        return np.array(["temperature" in quantity for quantity in quantities], dtype=np.float64)

    def directions(self) -> Iterator[Direction]:
        """In which its numbers go with one cause each."""
        return directions(self.library, self.effects, self.teeth_a_turn)

    def inflated(self, inflation: Mapping[str, float]) -> Array:
        """(n, n) covariance from spreads [coordinate] by likeness of cause."""
        columns = [
            inflation[column.likeness] * column.values
            for column in (self.directions() if inflation else ())
            if column.likeness in inflation
        ]
        both = np.hstack(columns) if columns else np.zeros((len(self.features), 0))
        return np.asarray(both @ both.T)


def compare(
    data: Data,
    library: Library,
    effects: Sequence[Effect],
    stated: Mapping[tuple[str, str], Stated],
    mesh_orders: frozenset[float],
    teeth_a_turn: int,
) -> ResidualProblem:
    """Hold the usable numbers of a set against its library.

    stated : systematic uncertainties of the settings, by (kind, place)
    """
    known = set(library.features)
    usable = [row for row, feature in enumerate(data.features) if data.usable[row] and feature in known]
    features = tuple(data.features[row] for row in usable)
    cut = library.rows(features)
    channels = {name: entry.channel for name, entry in data.channels.items()}
    channel_errors = {
        name: Stated(offset=entry.offset_sd, scale=entry.scale_sd) for name, entry in data.channels.items()
    }
    noise = {setting.name: noise for setting, noise in zip(data.settings, data.setting_noise, strict=True)}
    return ResidualProblem(
        features=features,
        values=data.values[usable],
        noise=data.noise[usable],
        library=cut,
        channels=channels,
        effects=tuple(effects),
        errors=(
            *sensor_errors(cut, channels, channel_errors, data.values[usable]),
            *input_errors(cut, data.settings, stated),
        ),
        scatter=setting_scatter(cut, noise),
        mesh_orders=mesh_orders,
        teeth_a_turn=teeth_a_turn,
        level=reference_scale(features, cut.base, channels, cut.settings, mesh_orders),
    )


def plain(
    residuals: ResidualProblem, amplitudes: Amplitudes, inflation: Mapping[str, float] | None = None
) -> Whitened:
    """The residual of one set against the model.

    Constants are so far off that their answer is nonlinear: each column is the sensitivity at the constant the data
    give, found by a few steps, and what the answer has beyond it is taken out of the residual.
    """
    covariance = residuals.covariance(amplitudes, inflation)
    curves = residuals.curves()
    nonlinear_parts: dict[str, Array] = {}
    sizes = dict.fromkeys(curves, 0.0)
    for _ in range(BENDING_STEPS if curves else 0):
        residual = residuals.residual - sum(nonlinear_parts.values(), np.zeros(len(residuals.features)))
        constants = _constants_at(covariance, residual, curves)
        sizes = {
            effect: size + BENDING_SHARE * (constants[effect] - size)
            for effect, size in sizes.items()
            if effect in constants
        }
        slopes = {effect: curves[effect].sensitivity(size) for effect, size in sizes.items()}
        nonlinear_parts = {
            effect: curves[effect].at(np.array([size]))[0] - size * slopes[effect]
            for effect, size in sizes.items()
        }
        columns = tuple(
            replace(column, values=slopes[column.effect]) if column.effect in slopes else column
            for column in covariance.columns
        )
        covariance = Covariance(base=covariance.base, columns=columns, amplitudes=covariance.amplitudes)
    residual = residuals.residual - sum(nonlinear_parts.values(), np.zeros(len(residuals.features)))
    return Whitened.of(covariance, residual, nonlinear_parts)


def outliers_of(residuals: ResidualProblem, space: Whitened) -> tuple[Outlier, ...]:
    """Single readings that the others of their series contradict."""
    series = [(feature.channel, feature.order) for feature in residuals.features]
    return reject(space.covariance.matrix, space.raw, series)


BENDING_STEPS = 5
"""Steps in which the slopes of the constants follow the data."""
BENDING_SHARE = 0.6
"""Of every step: a full one oscillates between two sensitivities where a response is strongly nonlinear."""


def _constants_at(covariance: Covariance, residual: Array, curves: Mapping[str, Curve]) -> dict[str, float]:
    """Where the data put every constant that has a curve, all its columns together, kept within its bounds."""
    solved = cho_solve((covariance.lower, True), residual)
    sizes: dict[str, float] = {}
    for place, column in enumerate(covariance.columns):
        if column.effect in curves:
            size = covariance.spread(place) ** 2 * float(column.values @ solved)
            sizes[column.effect] = sizes.get(column.effect, 0.0) + size
    return {effect: float(np.clip(size, *curves[effect].bounds)) for effect, size in sizes.items()}

"""The residual of a healthy rig between data and model: the columns of the covariance.

Every parameter of the catalogue that is never known exactly is a constant with its healthy spread; every local
conductance of the thermal model is a link of its own, since one wrong film moves many sensors together; losses may
enter elsewhere, laws may have other exponents, sensors and inputs have the systematic errors the measurement states.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import NEAR_SENSOR, Library
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.columns import Array, Column, series_numbers
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
        own = np.array([feature.channel == name for feature in features], dtype=np.float64) * level
        if own.any():
            columns.append(Column(name=f"channel {name}", kind="channel", values=own, spread=1.0))
            columns.append(
                Column(name=f"channel {name} by speed", kind="channel_speed", values=own * speed, spread=1.0)
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
        own = np.array([(f.channel, f.order, f.part) == key for f in features], dtype=np.float64) * level
        kind = series_kind(order, mesh_orders)
        label = f"{name} order {order:g} {part}"
        columns.append(Column(name=label, kind=kind, values=own, spread=1.0))
        columns.append(Column(name=f"{label} by speed", kind=kind, values=own * speed, spread=1.0))
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
    explanation (`rigdesign.diagnosis.residual.signature`) a healthy rig has as well.
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
    found: dict[tuple[str, str, str], list[int]] = {}
    for row, feature in enumerate(features):
        channel = channels[feature.channel]
        if channel.quantity == "root_strain" and feature.part != "unloaded":
            gear = channel.place.rpartition(".")[0]
            found.setdefault((gear, feature.part, feature.setting), []).append(row)
    for (gear, window, point), rows in found.items():
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
        at = np.array(row.rows, dtype=np.intp)
        for mode, shape in row.shapes.items():
            here = np.zeros(len(features))
            # a shape of unit mean square over the gauges: the share is of the strain of one gauge
            here[at] = shape * np.sqrt(len(at)) * float(level[at].mean())
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

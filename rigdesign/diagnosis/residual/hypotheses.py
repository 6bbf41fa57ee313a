"""All explanations of one residual, in the space where a healthy rig is white noise."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
from scipy.optimize import minimize_scalar

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import NEAR_SENSOR, Library, Response
from rigdesign.diagnosis.residual.healthy import relative_speed, relative_torque
from rigdesign.diagnosis.residual.sensors import LARGEST_ANGLE_ERROR, SensorError, mark_elsewhere
from rigdesign.diagnosis.statistics.columns import Array, Turning, excess
from rigdesign.diagnosis.statistics.covariance import Covariance
from rigdesign.diagnosis.statistics.evidence import Curve, Hypothesis
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel, Feature

# Unmodelled causes: what a named effect has to beat.
#
# Heat at any place of the rig with the laws a loss may follow, paid by the motor or not; heat in the oil on its way in
# or out, where no thermometer but one feels it; a conductance between any neighbours; an order of torque or angle on
# any channel with the laws an excitation may follow. What they explain better than the catalogue is reported as located
# but unknown.

UNKNOWN = "unknown: "
"""How the name of an explanation begins that is in no catalogue."""

ORDER_CAUSE = f"{UNKNOWN}order "
"""How the name of an unmodelled cause of an order begins."""

UnmodelledCause = tuple[Literal["unmodelled", "local"], str, Array]
"""Family, name, (n, k) columns: k = 2 for an order with free phase. Local is what one thermometer alone may feel."""


def unmodelled_causes(library: Library, channels: Mapping[str, Channel]) -> Iterator[UnmodelledCause]:
    """All of them, in a fixed order."""
    for heat in heats(library):
        yield "unmodelled", heat.name, heat.values[:, None]
    yield from _in_the_pipes(library, channels)
    yield from _at_sensors(library, channels)
    for name, values in library.links.items():
        yield "unmodelled", f"conductance {name}", values[:, None]
    yield from _orders(library, channels)


@dataclass(frozen=True, kw_only=True)
class Heat:
    """Heat at a place of the rig, by a law of speed n and torque T.

    values : (n,) change of the numbers per watt at the mean operating point
    """

    family: str
    """``heat`` as the motor pays for it, ``heat unpaid`` where it does not."""
    place: str
    law: str
    values: Array

    @property
    def name(self) -> str:
        """As an explanation."""
        return f"{self.family} at {self.place} {self.law}"

    @property
    def likeness(self) -> str:
        """What it shares with heat at other places of this kind."""
        return f"{self.family} at {self.place.split(':')[0]} {self.law}"


def heats(library: Library) -> Iterator[Heat]:
    """Heat at every place by itself, those at sensors left out."""
    laws = _laws(library)
    for family, sources in (("heat", library.sources), ("heat unpaid", library.dry_sources)):
        for place, values in sources.items():
            if not place.startswith(NEAR_SENSOR):
                for law in HEAT_LAWS:
                    yield Heat(family=family, place=place, law=law, values=values * laws[law])


HEAT_LAWS = ("constant", "~n", "~n2", "~T n")
ORDER_LAWS = ("constant", "~T", "~n2")


def _laws(library: Library) -> dict[str, Array]:
    """(n,) speed n and torque T of every number over their means, in the powers that losses and excitations follow."""
    speed = np.exp(relative_speed(library.features, library.settings))
    torque = np.exp(relative_torque(library.features, library.settings))
    return {
        "constant": np.ones_like(speed), "~n": speed, "~n2": speed**2, "~T": torque, "~T n": torque * speed,
    }  # fmt: skip


def _in_the_pipes(library: Library, channels: Mapping[str, Channel]) -> Iterator[UnmodelledCause]:
    """A heater or a pump between the thermometer of a stream and the gearbox: warmer by less the more oil flows."""
    streams = dict.fromkeys(place for kind, place, _ in library.inputs if kind == "inlet_temperature")
    flows = {
        stream: {setting.name: setting.flow.get(stream, 1.0) for setting in library.settings}
        for stream in streams
    }
    for stream in streams:
        answers = [
            library.inputs["inlet_temperature", stream, point] / flow
            for point, flow in flows[stream].items()
            if ("inlet_temperature", stream, point) in library.inputs
        ]
        yield "local", f"heat in the supply of {stream} constant", np.sum(answers, axis=0)[:, None]
    for name, channel in channels.items():
        if channel.quantity != "oil_outlet_temperature":
            continue
        flow = flows.get(channel.place, {})
        share = [(f.channel == name) / flow.get(f.setting, 1.0) for f in library.features]
        yield "local", f"heat in the drain of {channel.place} constant", np.array(share)[:, None]


def _at_sensors(library: Library, channels: Mapping[str, Channel]) -> Iterator[UnmodelledCause]:
    """Heat from outside at one thermocouple: a neighbour, a lamp; or a draught, as the wall is above ambient."""
    warm = excess(library.features, library.base, channels, library.settings)
    for place, values in library.dry_sources.items():
        if not place.startswith(NEAR_SENSOR):
            continue
        name = place.removeprefix(NEAR_SENSOR)
        above = {f.setting: warm[row] for row, f in enumerate(library.features) if f.channel == name}
        share = np.array([above.get(feature.setting, 0.0) for feature in library.features])
        yield "local", f"heat near {name} constant", values[:, None]
        yield "local", f"heat near {name} ~T above ambient", (values * share)[:, None]


def _orders(library: Library, channels: Mapping[str, Channel]) -> Iterator[UnmodelledCause]:
    """An order of one channel, or of all channels of its kind, free in phase but the same at all points."""
    laws = _laws(library)
    orders = dict.fromkeys(
        (feature.channel, feature.order)
        for feature in library.features
        if channels[feature.channel].quantity in ORDER_QUANTITIES and feature.order
    )
    for name, order in orders:
        parts = [
            np.array(
                [(f.channel, f.order, f.part) == (name, order, part) for f in library.features],
                dtype=np.float64,
            )
            for part in ("real", "imaginary")
        ]
        for law in ORDER_LAWS:
            columns = np.stack([part * laws[law] for part in parts], axis=1)
            yield "unmodelled", f"order {order:g} of {name} {law}", columns


SIGMAS = 12.0
"""Half width of the prior of an unmodelled cause in its own standard deviations: as far as that of an effect that is
seen well; its size has no bound."""

INVISIBLE = 1e-3
"""Whitened length of an effect at its bound below which these sensors do not answer to it at all."""


def physical(
    covariance: Covariance | None,
    features: Sequence[Feature],
    effects: Sequence[Effect],
    responses: Mapping[str, Response],
    teeth_a_turn: int,
    least: float = INVISIBLE,
) -> list[Hypothesis]:
    """Effects of the catalogue that the sensors answer to; of a tooth that may be any, one explanation each.

    covariance : None leaves the answers in the units of the features
    least : whitened length of an effect at its bound below which it is left out
    """
    turning = Turning.of(features)
    known = [(effect, responses[effect.name]) for effect in effects if effect.name in responses]
    copies = [
        (effect, response, f"{effect.name}/{tooth}" if effect.any_tooth else effect.name, tooth)
        for effect, response in known
        for tooth in range(max(effect.any_tooth, 1))
    ]
    runs = []
    for _, response, _, tooth in copies:
        rows = response.answers if response.nonlinear else response.sensitivity().T
        runs.append(turning.turned(rows, tooth, teeth_a_turn) if tooth else rows)
    hypotheses = [
        _curve(effect, response, name, white) if response.nonlinear else _plane(effect, name, white)
        for (effect, response, name, _), white in zip(copies, whitened(covariance, runs), strict=True)
    ]
    return [hypothesis for hypothesis in hypotheses if _reach(hypothesis) > least]


def whitened(covariance: Covariance | None, rows: Sequence[Array]) -> list[Array]:
    """Blocks (m, n) of answers in the space of the covariance; all in one solve, which is what takes the time."""
    if not rows or covariance is None:
        return list(rows)
    white = covariance.whiten(np.concatenate(rows).T).T
    return np.split(white, np.cumsum([len(block) for block in rows])[:-1])


def _curve(effect: Effect, response: Response, name: str, white: Array) -> Hypothesis:
    return Hypothesis(
        name=name,
        family="physical",
        parts=(effect.claim,),
        curve=Curve.of(response.coordinates[:, 0], white, effect.parameters[0].bounds),
        own=(effect.name,),
    )


def _plane(effect: Effect, name: str, white: Array) -> Hypothesis:
    return Hypothesis(
        name=name,
        family="physical",
        parts=(effect.claim,),
        columns=white.T,
        half=effect.reach,
        own=(effect.name,),
    )


def _reach(hypothesis: Hypothesis) -> float:
    """Whitened length of the answer at the bound."""
    if hypothesis.curve is not None:
        return float(np.linalg.norm(hypothesis.curve.answers, axis=1).max())
    return float(np.linalg.norm(hypothesis.columns) * hypothesis.half)


def sensor(covariance: Covariance | None, errors: Sequence[SensorError]) -> list[Hypothesis]:
    """Sensors and settings that may be in error; without a covariance in the units of the features."""
    columns = whitened(covariance, [error.values[None, :] for error in errors])
    return [
        Hypothesis(
            name=error.name,
            family="sensor",
            parts=(error.name,),
            columns=white.T,
            half=error.bound,
            own=(error.name,),
        )
        for error, white in zip(errors, columns, strict=True)
    ]


def without_a_name(covariance: Covariance, causes: Iterable[UnmodelledCause]) -> list[Hypothesis]:
    """Unmodelled causes, of any size; the prior of the size is as wide as that of something seen at `SIGMAS`."""
    causes = list(causes)
    hypotheses = []
    columns = whitened(covariance, [columns.T for _, _, columns in causes])
    for (family, name, _), white in zip(causes, columns, strict=True):
        longest = float(np.linalg.norm(white, axis=1).max())
        if longest <= 1e-9:
            continue
        hypotheses.append(
            Hypothesis(
                name=f"{UNKNOWN}{name}",
                family=family,
                parts=(f"{UNKNOWN}{name}",),
                columns=white.T / longest,
                half=SIGMAS,
                unit=longest,
                limits=(np.full(white.shape[0], -np.inf), np.full(white.shape[0], np.inf)),
            )
        )
    return hypotheses


# Data that are wrong as they stand: exchanged channels or points, another unit or sign, an index pulse offset.
#
# Each explanation undoes one of these and leaves a residual; nothing is fitted but the angle of the index pulse.


def data_error(
    covariance: Covariance,
    features: Sequence[Feature],
    channels: Mapping[str, Channel],
    values: Array,
    expected: Array,
    *,
    met_before: bool,
) -> list[Hypothesis]:
    """Every way in which the readings ``values`` (n,) may be wrong, held against what is ``expected`` (n,).

    met_before : whether a healthy set says what to expect; orders of the model alone give no index angle, as those
        of a mesh come back from tooth to tooth
    """
    changes = (
        *_swapped_channels(features, channels, values),
        *_swapped_points(features, values),
        *_units(features, channels, values, met_before=met_before),
    )
    residuals = whitened(covariance, [(changed - expected)[None, :] for _, changed in changes])
    hypotheses = [
        Hypothesis(name=name, family="input", parts=(name,), residual=residual[0])
        for (name, _), residual in zip(changes, residuals, strict=True)
    ]
    return [*hypotheses, *(_turned_mark(covariance, features, values, expected) if met_before else [])]


COMMON = 0.5
"""Least share of the numbers of two channels that both have, to be exchanged; some may be rejected as outliers."""


def _swapped_channels(
    features: Sequence[Feature], channels: Mapping[str, Channel], values: Array
) -> list[tuple[str, Array]]:
    rows: dict[str, dict[tuple[str, float, str], int]] = {}
    for row, feature in enumerate(features):
        rows.setdefault(feature.channel, {})[feature.setting, feature.order, feature.part] = row
    exchanges = []
    for first, second in combinations(rows, 2):
        common = [key for key in rows[first] if key in rows[second]]
        most = max(len(rows[first]), len(rows[second]))
        if channels[first].quantity != channels[second].quantity or len(common) < COMMON * most:
            continue
        here = np.array([rows[first][key] for key in common])
        there = np.array([rows[second][key] for key in common])
        changed = values.copy()
        changed[here], changed[there] = values[there], values[here]
        exchanges.append((f"swapped_channels:{first},{second}", changed))
    return exchanges


def _swapped_points(features: Sequence[Feature], values: Array) -> list[tuple[str, Array]]:
    rows: dict[str, dict[tuple[str, float, str], int]] = {}
    for row, feature in enumerate(features):
        if feature.setting:
            rows.setdefault(feature.setting, {})[feature.channel, feature.order, feature.part] = row
    exchanges = []
    for first, second in combinations(rows, 2):
        common = [key for key in rows[first] if key in rows[second]]
        if not common:
            continue
        here = np.array([rows[first][key] for key in common])
        there = np.array([rows[second][key] for key in common])
        changed = values.copy()
        changed[here], changed[there] = values[there], values[here]
        exchanges.append((f"swapped_points:{first},{second}", changed))
    return exchanges


_Misreading = tuple[str, float, float]
_TEMPERATURE: tuple[_Misreading, ...] = (
    ("fahrenheit", 1.8, ZERO_CELSIUS - 459.67),
    ("kelvin as celsius", 1.0, ZERO_CELSIUS),
)
"""Misreadings of temperatures."""
_TORQUE: tuple[_Misreading, ...] = (
    ("sign", -1.0, 0.0),
    ("kilonewton metre", 1e-3, 0.0),
    ("newton millimetre", 1e3, 0.0),
    ("kilopond metre", 1.0 / 9.80665, 0.0),
    ("pound-force foot", 1.0 / 1.355818, 0.0),
    ("pound-force inch", 12.0 / 1.355818, 0.0),
)
"""Misreadings of torques."""
_MISREAD: Mapping[str, tuple[_Misreading, ...]] = {
    "temperature": _TEMPERATURE,
    "oil_outlet_temperature": _TEMPERATURE,
    "motor_power": (
        ("sign", -1.0, 0.0),
        ("kilowatt", 1e-3, 0.0),
        ("horsepower", 1.0 / 745.69987, 0.0),
        ("metric horsepower", 1.0 / 735.49875, 0.0),
    ),
    "drive_torque": _TORQUE,
    "torque": _TORQUE,
    "angle": (
        ("sign", -1.0, 0.0),
        ("degrees as milliradians", 0.18 / np.pi, 0.0),
        ("degrees as radians", 180.0 / np.pi, 0.0),
        ("radians as milliradians", 1e-3, 0.0),
        ("milliradians as radians", 1e3, 0.0),
    ),
    "resonance_speed": (("radians per second", np.pi / 30.0, 0.0), ("hertz", 1.0 / 60.0, 0.0)),
    "natural_frequency": (("rpm", 60.0, 0.0), ("radians", 2.0 * np.pi, 0.0)),
}
"""What a reader does wrong: name, factor and shift from the true value to the number that was read as the unit."""


def _units(
    features: Sequence[Feature], channels: Mapping[str, Channel], values: Array, *, met_before: bool
) -> list[tuple[str, Array]]:
    """Of channels whose mean is read; of orders alone where a healthy set says what to expect.

    Foretold badly, they would be taken for a unit that makes them small.
    """
    changes = []
    for name in dict.fromkeys(feature.channel for feature in features if met_before or feature.order == 0.0):
        rows = np.array([row for row, feature in enumerate(features) if feature.channel == name])
        for unit, factor, shift in _MISREAD.get(channels[name].quantity, ()):
            changed = values.copy()
            changed[rows] = (values[rows] - shift) / factor
            changes.append((f"unit:{name} ({unit})", changed))
    return changes


STEP = 0.3
"""Step of the angle of the index pulse times the highest order [rad]."""


def _turned_mark(
    covariance: Covariance, features: Sequence[Feature], values: Array, expected: Array
) -> list[Hypothesis]:
    """The index pulse at another angle of the reference gear: order k of every signal is turned by k times it.

    Beyond the error of the index pulse that an explanation admits by its sensitivity (`sensors`). Once orders are
    taken apart, the residual is a sum of their cosine and sine parts at any angle.
    """
    turning = Turning.of(features)
    orders = np.unique(turning.orders[turning.orders > 0.0])
    if not len(orders):
        return []
    of_order = turning.order_of(len(features)) == orders[:, None]
    parts = np.vstack(
        [values * ~of_order.any(axis=0) - expected, values * of_order, -turning.ahead(values) * of_order]
    )
    [white] = whitened(covariance, [parts])
    products = white @ white.T

    def shares(angles: Array) -> Array:
        """(m, k) share of every part with the index pulse put back by angles (m,)."""
        turned = np.multiply.outer(angles, orders)
        return np.hstack([np.ones((len(angles), 1)), np.cos(turned), np.sin(turned)])

    def squares(angles: Array) -> Array:
        """(m,) of the residual."""
        own_shares = shares(angles)
        return np.asarray(np.einsum("mk,mk->m", own_shares @ products, own_shares))

    step = STEP / float(orders.max())
    angles = np.arange(LARGEST_ANGLE_ERROR, np.pi, step)
    angles = np.concatenate([-angles[::-1], angles])
    best = float(angles[np.argmin(squares(angles))])
    best = float(
        minimize_scalar(
            lambda angle: float(squares(np.array([angle]))[0]),
            bounds=(best - step, best + step),
            method="bounded",
        ).x
    )
    name = mark_elsewhere(best)
    [residual] = shares(np.array([best])) @ white
    return [Hypothesis(name=name, family="input", parts=(name,), residual=residual)]

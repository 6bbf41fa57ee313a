"""All explanations of one residual, in the space where a healthy rig is white noise."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

import numpy as np

from rigdesign.diagnosis.anonymous import Anonymous
from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.covariance import Covariance
from rigdesign.diagnosis.effects import Effect
from rigdesign.diagnosis.evidence import Curve, Hypothesis
from rigdesign.diagnosis.library import Response
from rigdesign.diagnosis.sensors import SensorError
from rigdesign.diagnosis.turning import Turning
from rigdesign.prediction.model import Channel, Feature

SIGMAS = 12.0
"""Bound of an anonymous cause in its own standard deviations: its prior reaches as far as that of an effect that is
seen well."""

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
        rows = response.answers if response.bends else response.slope().T
        runs.append(turning.turned(rows, tooth, teeth_a_turn) if tooth else rows)
    found = [
        _curve(effect, response, name, white) if response.bends else _plane(effect, name, white)
        for (effect, response, name, _), white in zip(copies, _whitened(covariance, runs), strict=True)
    ]
    return [one for one in found if _reach(one) > least]


def _whitened(covariance: Covariance | None, rows: Sequence[Array]) -> list[Array]:
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
    assert hypothesis.columns is not None
    return float(np.linalg.norm(hypothesis.columns) * hypothesis.half)


def sensor(covariance: Covariance | None, errors: Sequence[SensorError]) -> list[Hypothesis]:
    """Sensors and settings that may read wrong; without a covariance in the units of the features."""
    columns = _whitened(covariance, [error.values[None, :] for error in errors])
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


def without_a_name(covariance: Covariance, causes: Iterable[Anonymous]) -> list[Hypothesis]:
    """Anonymous competitors; each may be as large as something that is seen at `SIGMAS`."""
    causes = list(causes)
    found = []
    whitened = _whitened(covariance, [columns.T for _, _, columns in causes])
    for (family, name, _), white in zip(causes, whitened, strict=True):
        longest = float(np.linalg.norm(white, axis=1).max())
        if longest <= 1e-9:
            continue
        found.append(
            Hypothesis(
                name=f"unknown: {name}",
                family=family,
                parts=(f"unknown: {name}",),
                columns=white.T / longest,
                half=SIGMAS,
            )
        )
    return found


def wrong_data(
    covariance: Covariance,
    features: Sequence[Feature],
    channels: Mapping[str, Channel],
    values: Array,
    expected: Array,
) -> list[Hypothesis]:
    """Channels or points that may have been exchanged, and single channels with sign or unit wrong."""
    changes = (
        *_swapped_channels(features, channels, values),
        *_swapped_points(features, values),
        *_units(features, channels, values),
    )
    residuals = _whitened(covariance, [(changed - expected)[None, :] for _, changed in changes])
    return [
        Hypothesis(name=name, family="input", parts=(name,), residual=residual[0])
        for (name, _), residual in zip(changes, residuals, strict=True)
    ]


def _swapped_channels(
    features: Sequence[Feature], channels: Mapping[str, Channel], values: Array
) -> list[tuple[str, Array]]:
    rows: dict[str, dict[tuple[str, float, str], int]] = {}
    for row, feature in enumerate(features):
        rows.setdefault(feature.channel, {})[feature.setting, feature.order, feature.part] = row
    found = []
    for first, second in combinations(rows, 2):
        if channels[first].quantity != channels[second].quantity or rows[first].keys() != rows[second].keys():
            continue
        here = np.array(list(rows[first].values()))
        there = np.array([rows[second][key] for key in rows[first]])
        changed = values.copy()
        changed[here], changed[there] = values[there], values[here]
        found.append((f"swapped_channels:{first},{second}", changed))
    return found


def _swapped_points(features: Sequence[Feature], values: Array) -> list[tuple[str, Array]]:
    rows: dict[str, dict[tuple[str, float, str], int]] = {}
    for row, feature in enumerate(features):
        if feature.setting:
            rows.setdefault(feature.setting, {})[feature.channel, feature.order, feature.part] = row
    found = []
    for first, second in combinations(rows, 2):
        common = [key for key in rows[first] if key in rows[second]]
        if not common:
            continue
        here = np.array([rows[first][key] for key in common])
        there = np.array([rows[second][key] for key in common])
        changed = values.copy()
        changed[here], changed[there] = values[there], values[here]
        found.append((f"swapped_points:{first},{second}", changed))
    return found


_MISREAD = {
    "temperature": (("fahrenheit", 1.8, 273.15 - 459.67), ("kelvin as celsius", 1.0, 273.15)),
    "oil_outlet_temperature": (
        ("fahrenheit", 1.8, 273.15 - 459.67),
        ("kelvin as celsius", 1.0, 273.15),
    ),
    "motor_power": (("sign", -1.0, 0.0), ("kilowatt", 1e-3, 0.0), ("horsepower", 1.0 / 745.7, 0.0)),
    "drive_torque": (("sign", -1.0, 0.0), ("kilonewton metre", 1e-3, 0.0)),
    "torque": (
        ("sign", -1.0, 0.0),
        ("kilonewton metre", 1e-3, 0.0),
        ("pound-force foot", 1.0 / 1.355818, 0.0),
    ),
    "natural_frequency": (("rpm", 60.0, 0.0), ("radians", 2.0 * np.pi, 0.0)),
}
"""What a reader does wrong: name, factor and shift from the true value to the number that was read as the unit."""


def _units(
    features: Sequence[Feature], channels: Mapping[str, Channel], values: Array
) -> list[tuple[str, Array]]:
    found = []
    for name in dict.fromkeys(feature.channel for feature in features):
        rows = np.array([row for row, feature in enumerate(features) if feature.channel == name])
        for what, factor, shift in _MISREAD.get(channels[name].quantity, ()):
            changed = values.copy()
            changed[rows] = (values[rows] - shift) / factor
            found.append((f"unit:{name} ({what})", changed))
    return found

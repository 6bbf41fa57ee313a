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
from rigdesign.diagnosis.turning import turned
from rigdesign.prediction.model import Channel, Feature

SIGMAS = 12.0
"""Bound of an anonymous cause in its own standard deviations: its prior reaches as far as that of an effect that is
seen well."""

INVISIBLE = 1e-3
"""Whitened length of an effect at its bound below which these sensors do not answer to it at all."""


def physical(
    covariance: Covariance,
    features: Sequence[Feature],
    effects: Sequence[Effect],
    responses: Mapping[str, Response],
    teeth_a_turn: int,
    least: float = INVISIBLE,
) -> list[Hypothesis]:
    """Effects of the catalogue that the sensors answer to; of a tooth that may be any, one explanation each.

    least : whitened length of an effect at its bound below which it is left out
    """
    found = []
    for effect in effects:
        response = responses.get(effect.name)
        if response is None:
            continue
        for tooth in range(max(effect.any_tooth, 1)):
            answers = turned(features, response.answers, tooth, teeth_a_turn) if tooth else response.answers
            name = f"{effect.name}/{tooth}" if effect.any_tooth else effect.name
            here = Response(coordinates=response.coordinates, answers=answers)
            make = _curve if _is_curve(response) else _plane
            one = make(covariance, effect, here, name)
            if _reach(one) > least:
                found.append(one)
    return found


def _is_curve(response: Response) -> bool:
    return response.coordinates.shape[1] == 1 and not response.linear


def _curve(covariance: Covariance, effect: Effect, response: Response, name: str) -> Hypothesis:
    order = np.argsort(response.coordinates[:, 0])
    answers = covariance.whiten(response.answers[order].T).T
    coordinates = response.coordinates[order, 0]
    low, high = effect.parameters[0].bounds
    bounds = (max(low, float(coordinates[0])), min(high, float(coordinates[-1])))
    return Hypothesis(
        name=name,
        family="physical",
        parts=(effect.claim,),
        curve=Curve(coordinates=coordinates, answers=answers, bounds=bounds),
        own=(effect.name,),
    )


def _plane(covariance: Covariance, effect: Effect, response: Response, name: str) -> Hypothesis:
    return Hypothesis(
        name=name,
        family="physical",
        parts=(effect.claim,),
        columns=covariance.whiten(response.slope()),
        half=max(abs(bound) for parameter in effect.parameters for bound in parameter.bounds),
        own=(effect.name,),
    )


def _reach(hypothesis: Hypothesis) -> float:
    """Whitened length of the answer at the bound."""
    if hypothesis.curve is not None:
        return float(np.linalg.norm(hypothesis.curve.answers, axis=1).max())
    assert hypothesis.columns is not None
    return float(np.linalg.norm(hypothesis.columns) * hypothesis.half)


def sensor(covariance: Covariance, errors: Sequence[SensorError]) -> list[Hypothesis]:
    """Sensors and settings that may read wrong."""
    return [
        Hypothesis(
            name=error.name,
            family="sensor",
            parts=(error.name,),
            columns=covariance.whiten(error.values[:, None]),
            half=error.bound,
            own=(error.name,),
        )
        for error in errors
    ]


def without_a_name(covariance: Covariance, causes: Iterable[Anonymous]) -> list[Hypothesis]:
    """Anonymous competitors; each may be as large as something that is seen at `SIGMAS`."""
    found = []
    for name, columns in causes:
        white = covariance.whiten(columns)
        lengths = np.linalg.norm(white, axis=0)
        if lengths.max() <= 1e-9:
            continue
        found.append(
            Hypothesis(
                name=f"unknown: {name}",
                family="anonymous",
                parts=(f"unknown: {name}",),
                columns=white / lengths.max(),
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
    found = []
    for name, changed in (
        *_swapped_channels(features, channels, values),
        *_swapped_points(features, values),
        *_units(features, channels, values),
    ):
        residual = covariance.whiten(changed - expected)
        found.append(Hypothesis(name=name, family="input", parts=(name,), residual=residual))
    return found


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

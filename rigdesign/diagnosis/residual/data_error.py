"""Data that are wrong as they stand: exchanged channels or points, another unit or sign, an index pulse offset.

Each explanation undoes one of these and leaves a residual; nothing is fitted but the angle of the index pulse.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
from scipy.optimize import minimize_scalar

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.diagnosis.residual.hypotheses import whitened
from rigdesign.diagnosis.residual.sensors import LARGEST_ANGLE_ERROR, mark_elsewhere
from rigdesign.diagnosis.statistics.columns import Array, Turning
from rigdesign.diagnosis.statistics.covariance import Covariance
from rigdesign.diagnosis.statistics.hypothesis import Hypothesis
from rigdesign.prediction.model import Channel, Feature


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
    found = [
        Hypothesis(name=name, family="input", parts=(name,), residual=residual[0])
        for (name, _), residual in zip(changes, residuals, strict=True)
    ]
    return [*found, *(_turned_mark(covariance, features, values, expected) if met_before else [])]


COMMON = 0.5
"""Least share of the numbers of two channels that both have, to be exchanged; some may be rejected as outliers."""


def _swapped_channels(
    features: Sequence[Feature], channels: Mapping[str, Channel], values: Array
) -> list[tuple[str, Array]]:
    rows: dict[str, dict[tuple[str, float, str], int]] = {}
    for row, feature in enumerate(features):
        rows.setdefault(feature.channel, {})[feature.setting, feature.order, feature.part] = row
    found = []
    for first, second in combinations(rows, 2):
        common = [key for key in rows[first] if key in rows[second]]
        most = max(len(rows[first]), len(rows[second]))
        if channels[first].quantity != channels[second].quantity or len(common) < COMMON * most:
            continue
        here = np.array([rows[first][key] for key in common])
        there = np.array([rows[second][key] for key in common])
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
    found = []
    for name in dict.fromkeys(feature.channel for feature in features if met_before or feature.order == 0.0):
        rows = np.array([row for row, feature in enumerate(features) if feature.channel == name])
        for what, factor, shift in _MISREAD.get(channels[name].quantity, ()):
            changed = values.copy()
            changed[rows] = (values[rows] - shift) / factor
            found.append((f"unit:{name} ({what})", changed))
    return found


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
    own = turning.order_of(len(features)) == orders[:, None]
    parts = np.vstack([values * ~own.any(axis=0) - expected, values * own, -turning.ahead(values) * own])
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

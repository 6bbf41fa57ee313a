"""Errors of sensors and settings: entries of the catalogue that leave the case alone.

Each is a column in closed form and a healthy spread, the systematic uncertainty that the measurement states. As an
effect it may be many times that.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.library.library import Library, value_of
from rigdesign.diagnosis.statistics.columns import Array, Column, Turning, excess
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel, OperatingCondition
from rigdesign.strain_gauge.gauge import REFERENCE_TEMPERATURE

TIMES = 12.0
"""Bound of a sensor error over its stated systematic uncertainty."""


@dataclass(frozen=True, kw_only=True)
class Stated:
    """Systematic uncertainties of one channel or setting, as the measurement states them [SI, one sigma]."""

    offset: float = 0.0
    scale: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SensorError:
    """One sensor or setting that may be in error.

    values : (n,) change of what is read per unit of the error; unit : of the error; spread : healthy
    """

    name: str
    title: str
    kind: str
    """``sensor`` or ``input``: names the amplitude."""
    values: Array
    unit: str
    spread: float
    times: float = TIMES
    """Bound over the spread."""

    @property
    def bound(self) -> float:
        """Largest error that is believed."""
        return self.times * self.spread

    def column(self) -> Column:
        """Its healthy part."""
        return Column(
            name=self.name, kind=self.kind, values=self.values, spread=self.spread, effect=self.name
        )


UNITS = {
    "temperature": "K",
    "warming_rate": "K/s",
    "oil_outlet_temperature": "K",
    "motor_power": "W",
    "drive_torque": "N m",
    "torque": "N m",
    "angle": "rad",
    "natural_frequency": "Hz",
    "backlash": "m",
    "seal_gap": "m",
    "acceleration": "m/s2",
    "shaft_displacement": "m",
    "resonance_speed": "rad/s",
    "root_strain": "m/m",
}

THERMAL_OUTPUT = 1e-6
"""Apparent strain of a gauge per kelvin that nobody corrected [1/K], one sigma: as data sheets leave it on steel."""

CENTRIFUGAL = 5e-6
"""Strain of a root by rotation at the fastest point of a set [-], one sigma: rho v^2 / E at 12 m/s."""


def sensor_errors(
    library: Library, channels: Mapping[str, Channel], stated: Mapping[str, Stated], values: Array
) -> tuple[SensorError, ...]:
    """Offset and scale of every channel whose measurement states them; the zero of a torque cell is on the mean.

    values : (n,) as read: what a sensor has wrong in orders, which no model foretells well, follows what it reads
    """
    above = excess(library.features, library.base, channels, library.settings)
    read = np.where([feature.order != 0.0 for feature in library.features], values, library.base)
    errors = []
    for name, channel in channels.items():
        of_channel = np.array([feature.channel == name for feature in library.features], dtype=np.float64)
        uncertainty = stated.get(name, Stated())
        if not of_channel.any():
            continue
        orders = channel.quantity in ORDER_QUANTITIES
        if channel.quantity == "root_strain":
            errors += _of_gauge(library, name, uncertainty)
            continue
        if uncertainty.offset > 0.0:
            mean = np.array([feature.order == 0.0 for feature in library.features], dtype=np.float64)
            errors.append(
                SensorError(
                    name=f"torque_zero:{name}" if orders else f"sensor_offset:{name}",
                    title=f"offset of {name}",
                    kind="sensor",
                    values=of_channel * mean if orders else of_channel,
                    unit=UNITS[channel.quantity],
                    spread=uncertainty.offset,
                )
            )
        if uncertainty.scale > 0.0:
            errors.append(
                SensorError(
                    name=f"sensor_scale:{name}",
                    title=f"scale error of {name}",
                    kind="sensor",
                    values=of_channel * (read if channel.quantity != "temperature" else above),
                    unit="",
                    spread=uncertainty.scale,
                )
            )
    return (
        *errors,
        *_angle_zero(library, read),
        *_lags(library, channels, read),
        *_centrifugal(library, channels),
    )


def _of_gauge(library: Library, name: str, stated: Stated) -> list[SensorError]:
    """Gauge factor on all numbers of a gauge; zero and thermal output on the strain of the unloaded tooth alone."""
    of_channel = np.array([feature.channel == name for feature in library.features], dtype=np.float64)
    unloaded = of_channel * _unloaded(library)
    errors = []
    if stated.scale > 0.0:
        errors.append(
            SensorError(
                name=f"gauge_factor:{name}", title=f"gauge factor of {name}", kind="sensor",
                values=of_channel * library.base, unit="", spread=stated.scale,
            )
        )  # fmt: skip
    if stated.offset > 0.0 and unloaded.any():
        errors.append(
            SensorError(
                name=f"gauge_zero:{name}", title=f"zero of {name}", kind="sensor", values=unloaded,
                unit="m/m", spread=stated.offset,
            )
        )  # fmt: skip
    warm = unloaded * np.array([_warmer(library, feature.setting) for feature in library.features])
    if warm.any():
        errors.append(
            SensorError(
                name=f"gauge_thermal_output:{name}", title=f"thermal output of {name}", kind="sensor",
                values=warm, unit="1/K", spread=THERMAL_OUTPUT,
            )
        )  # fmt: skip
    return errors


def _unloaded(library: Library) -> Array:
    """(n,) one where a number is the strain of a gauge under no load."""
    return np.array([feature.part == "unloaded" for feature in library.features], dtype=np.float64)


def _warmer(library: Library, point: str) -> float:
    """Inlets of the oils at a point over 20 degC [K], which the gears follow; 0 where nothing is stated."""
    setting = next((setting for setting in library.settings if setting.name == point), None)
    inlets = () if setting is None else tuple(setting.inlet_temperature.values())
    return float(np.mean(inlets)) - REFERENCE_TEMPERATURE if inlets else 0.0


def _centrifugal(library: Library, channels: Mapping[str, Channel]) -> list[SensorError]:
    """Strain by rotation of all gauges of a gear, over that at the fastest point."""
    speeds = {setting.name: setting.speed for setting in library.settings}
    fastest = max(speeds.values(), default=1.0)
    squares = np.array([(speeds.get(feature.setting, 0.0) / fastest) ** 2 for feature in library.features])
    places = [channels[feature.channel].place for feature in library.features]
    quantities = [channels[feature.channel].quantity for feature in library.features]
    errors = []
    for gear in dict.fromkeys(
        place.rpartition(".")[0] for place, q in zip(places, quantities) if q == "root_strain"
    ):
        on_gear = [
            q == "root_strain" and place.startswith(f"{gear}.") for place, q in zip(places, quantities)
        ]
        values = np.array(on_gear, dtype=np.float64) * squares * _unloaded(library)
        if values.any():
            errors.append(
                SensorError(
                    name=f"gauge_centrifugal:{gear}", title=f"centrifugal strain of the gauges of {gear}",
                    kind="sensor", values=values, unit="m/m", spread=CENTRIFUGAL,
                )
            )  # fmt: skip
    return errors


ANGLE_ZERO = 2e-3
"""Healthy error of the angle of the index pulse [rad], one sigma."""

LARGEST_ANGLE_ERROR = 20.0 * ANGLE_ZERO
"""Up to which orders answer to it by their sensitivity [rad]; beyond it the index pulse is offset (`wrong_data`)."""


def mark_elsewhere(angle: float) -> str:
    """Name of the explanation that the index pulse is offset by an angle [rad] beyond that."""
    return f"angle_zero ({angle:+.4f} rad)"


def index_pulse_offset(explanation: str) -> str:
    """The angle in such a name, as ``+0.2000 rad``; empty for other names."""
    kind, _, angle = explanation.partition(" (")
    return angle.removesuffix(")") if kind == "angle_zero" else ""


def _angle_zero(library: Library, read: Array) -> list[SensorError]:
    """All orders turned by one angle of the reference gear: X_k by i k X_k per radian."""
    turning = Turning.of(library.features)
    values = turning.order_of(len(library.features)) * turning.ahead(read)
    if not values.any():
        return []
    return [
        SensorError(
            name="angle_zero",
            title="index pulse offset",
            kind="sensor",
            values=values,
            unit="rad",
            spread=ANGLE_ZERO,
            times=LARGEST_ANGLE_ERROR / ANGLE_ZERO,
        )
    ]


LAG = 2e-6
"""Healthy time constant of a torque cell beyond what its measurement states [s], one sigma."""

LARGEST_LAG = 5e-4
"""Of a carrier amplifier with a low-pass of some 300 Hz that nobody stated [s]."""


def _lags(library: Library, channels: Mapping[str, Channel], read: Array) -> list[SensorError]:
    """Orders of every torque cell through a first-order lag T, per second of it.

    What is read is X = S/(1 + i w T) of the torque S, so that X - S = -i w T X whatever the lag.
    """
    turning = Turning.of(library.features)
    speeds = {setting.name: setting.speed for setting in library.settings}
    speed = np.array([speeds.get(feature.setting, 0.0) for feature in library.features])
    behind = -turning.order_of(len(read)) * speed * turning.ahead(read)
    errors = []
    for name, channel in channels.items():
        of_channel = np.array([feature.channel == name for feature in library.features], dtype=np.float64)
        if channel.quantity != "torque" or not (of_channel * behind).any():
            continue
        errors.append(
            SensorError(
                name=f"torque_lag:{name}",
                title=f"lag of the torque cell {name}",
                kind="sensor",
                values=of_channel * behind,
                unit="s",
                spread=LAG,
                times=LARGEST_LAG / LAG,
            )
        )
    return errors


def input_errors(
    library: Library, settings: Sequence[OperatingCondition], stated: Mapping[tuple[str, str], Stated]
) -> tuple[SensorError, ...]:
    """Systematic errors of the settings: what was run is not what was read, so the rig answers to something else.

    stated : (kind, place) of a setting -> its systematic uncertainties
    """
    errors = []
    for (kind, place), uncertainty in stated.items():
        keys = [key for key in library.inputs if key[:2] == (kind, place)]
        if not keys:
            continue
        by_name = {setting.name: setting for setting in settings}
        offset = np.sum([library.inputs[key] for key in keys], axis=0)
        scale = np.sum([library.inputs[key] * value_of(by_name[key[2]], kind, place) for key in keys], axis=0)
        label = f"{kind} of {place}".removesuffix(" of ")
        if uncertainty.offset > 0.0:
            errors.append(
                SensorError(
                    name=_input_name(kind, place, "offset"),
                    title=f"offset of {label}",
                    kind="input",
                    values=offset,
                    unit="K" if "temperature" in kind else "SI",
                    spread=uncertainty.offset,
                )
            )
        if uncertainty.scale > 0.0:
            errors.append(
                SensorError(
                    name=_input_name(kind, place, "scale"),
                    title=f"scale error of {label}",
                    kind="input",
                    values=scale,
                    unit="",
                    spread=uncertainty.scale,
                )
            )
    return tuple(errors)


def _input_name(kind: str, place: str, error: str) -> str:
    """Names as the catalogue has them."""
    if kind == "flow":
        return f"flow_{error}:{place}"
    if kind == "inlet_temperature":
        return f"inlet_{error}:{place}"
    return "ambient" if kind == "ambient_temperature" else f"{kind}_{error}"


def setting_scatter(library: Library, noise: Mapping[str, Mapping[tuple[str, str], float]]) -> Array:
    """(n, n) covariance of the features from the random error of the settings read.

    noise : setting -> (kind, place) -> standard deviation of what was read [SI]
    """
    columns = [
        noise.get(setting, {}).get((kind, place), 0.0) * derivative
        for (kind, place, setting), derivative in library.inputs.items()
    ]
    spread = np.array(columns).reshape(-1, len(library.features))
    return np.asarray(spread.T @ spread)

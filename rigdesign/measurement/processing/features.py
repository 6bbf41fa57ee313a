"""From readings to the numbers a prediction is held against: means over repeats, their noise, what is usable."""

import cmath
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import hypot

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import MeasurementError
from rigdesign.measurement.data import Data
from rigdesign.measurement.quality.checks import LEAST, data_findings, rates
from rigdesign.measurement.quality.consistency import consistency_findings
from rigdesign.measurement.reading.measurement_set import (
    DataFinding,
    MeasuredChannel,
    MeasuredPoint,
    MeasurementSet,
    Transfer,
)
from rigdesign.prediction.model import Feature, OperatingCondition, features_of
from rigdesign.strain_gauge.low_pass import LowPass

THERMAL = frozenset(("temperature", "warming_rate", "oil_outlet_temperature", "seal_gap"))
"""Quantities that mean nothing before temperatures are steady."""
LEAST_GAIN = 0.1
"""What a sensor must let through of an order to be corrected for."""


def gain(transfer: Transfer, angular_frequency: float) -> complex:
    """Complex gain of a Butterworth low-pass and a delay at ``angular_frequency`` [rad/s].

    With signals as Re(X exp(i omega t)).
    """
    low_pass = LowPass("butterworth", transfer.poles, transfer.frequency)
    delay = cmath.exp(-1j * angular_frequency * transfer.delay)
    return delay * complex(low_pass.gain(angular_frequency / (2.0 * math.pi)))


def features(measurement: MeasurementSet) -> Data:
    """Means over repeats with their noise, after the data checks.

    Raises
    ------
    MeasurementError
        No reading is left to use; says why each channel fell out.
    """
    dropped, checks = data_findings(measurement)
    settings = measurement.settings
    channels = {name: entry for name, entry in measurement.channels.items() if name not in dropped}
    names = features_of(settings, (entry.channel for entry in channels.values()))
    clean, outliers = without_outliers(
        {feature: measurement.readings.get(feature, np.empty(0)) for feature in names}, channels
    )
    noise = pooled_noise(clean, channels)
    values = np.array([_mean(clean[feature]) for feature in names], dtype=float)
    repeats = np.array([np.count_nonzero(np.isfinite(clean[feature])) for feature in names], dtype=np.int64)
    with np.errstate(divide="ignore"):
        spread = np.array([noise[feature] for feature in names], dtype=float) / np.sqrt(repeats)
    usable = np.isfinite(values) & (spread > 0.0) & np.isfinite(spread)
    findings = [*measurement.findings, *checks, *outliers]
    findings += _not_steady(measurement, names, usable)
    findings += _through_sensors(settings, channels, names, values, spread, usable)
    of_rates = {name for name, entry in channels.items() if entry.channel.quantity == "warming_rate"}
    counted = usable & np.array([feature.channel not in of_rates for feature in names], dtype=bool)
    findings += _few_readings(settings, names, repeats, counted)
    if not usable.any():
        reasons = "; ".join(finding.text for finding in findings if finding.weight == "dropped")
        raise MeasurementError(
            f"no usable reading is left: {reasons or 'every cell is empty'}", str(measurement.folder)
        )
    values[~usable], spread[~usable] = np.nan, np.inf
    data = Data(
        features=names,
        values=values,
        noise=spread,
        usable=usable,
        repeats=repeats,
        settings=settings,
        setting_noise=tuple(_setting_noise(measurement, point) for point in measurement.points),
        assembly=_assemblies(measurement.points),
        channels=channels,
        findings=tuple(findings),
        strength="proven" if _repeated(names, repeats, counted) else "indicative",
    )
    kept = replace(measurement, readings={**measurement.readings, **clean})
    return replace(data, findings=(*findings, *consistency_findings(kept, data)))


def _mean(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else math.nan


def _not_steady(
    measurement: MeasurementSet, names: Sequence[Feature], usable: NDArray[np.bool_]
) -> Iterable[DataFinding]:
    """Take temperatures out at points that were not steady."""
    restless = {point.name for point in measurement.points if not point.steady}
    thermal = {name for name, entry in measurement.channels.items() if entry.channel.quantity in THERMAL}
    hit = [
        i
        for i, feature in enumerate(names)
        if usable[i] and feature.setting in restless and feature.channel in thermal
    ]
    usable[hit] = False
    if hit:
        points = tuple(dict.fromkeys(names[i].setting for i in hit))
        yield DataFinding(
            id="not_steady", weight="dropped", points=points,
            text=f"{', '.join(points)}: said not to be steady; temperatures there are not used",
        )  # fmt: skip


def _through_sensors(
    settings: Sequence[OperatingCondition],
    channels: Mapping[str, MeasuredChannel],
    names: Sequence[Feature],
    values: NDArray[np.float64],
    noise: NDArray[np.float64],
    usable: NDArray[np.bool_],
) -> Iterable[DataFinding]:
    """Undo what sensor and logger do to orders; orders they hold back are taken out."""
    speeds = {setting.name: setting.speed for setting in settings}
    place = {feature: i for i, feature in enumerate(names)}
    lost: dict[str, list[Feature]] = {}
    for feature, i in place.items():
        transfer = channels[feature.channel].transfer
        if transfer is None or feature.part != "real":
            continue
        j = place[Feature(feature.channel, feature.setting, feature.order, "imaginary")]
        factor = gain(transfer, feature.order * speeds[feature.setting])
        if abs(factor) < LEAST_GAIN:
            usable[[i, j]] = False
            lost.setdefault(feature.channel, []).append(feature)
            continue
        true = complex(values[i], values[j]) / factor
        values[i], values[j] = true.real, true.imag
        noise[[i, j]] /= abs(factor)
    for name, gone in lost.items():
        lowest = min(gone, key=lambda feature: feature.order * speeds[feature.setting])
        yield DataFinding(
            id="held_back", weight="dropped", channels=(name,),
            text=f"{name}: {len(gone)} orders pass its sensor with less than {LEAST_GAIN:g} of their size, from "
            f"order {lowest.order:g} at {lowest.setting} on; they are not used",
        )  # fmt: skip


def _few_readings(
    settings: Sequence[OperatingCondition],
    names: Sequence[Feature],
    repeats: NDArray[np.int64],
    usable: NDArray[np.bool_],
) -> Iterable[DataFinding]:
    if len(settings) == 1:
        yield DataFinding(
            id="one_point", weight="note", points=(settings[0].name,),
            text="one operating point only: most effects cannot be separated; measure at other speeds, torques "
            "and oil temperatures",
        )  # fmt: skip
    if not _repeated(names, repeats, usable):
        yield DataFinding(
            id="no_repeats", weight="note",
            text="fewer than half the numbers have a second reading: the declared noise is used, verdicts are "
            "indicative; repeat every point",
        )  # fmt: skip


def _repeated(names: Sequence[Feature], repeats: NDArray[np.int64], usable: NDArray[np.bool_]) -> bool:
    """Whether at least half the usable numbers of running points depend on two readings or more."""
    running = usable & np.array([feature.setting != "" for feature in names], dtype=bool)
    chosen = running if running.any() else usable
    return bool(chosen.any() and np.mean(repeats[chosen] >= 2) >= 0.5)


def _setting_noise(measurement: MeasurementSet, point: MeasuredPoint) -> dict[tuple[str, str], float]:
    noise = {}
    for column, sensor in measurement.setting_sensors.items():
        count = np.count_nonzero(np.isfinite(point.readings[column]))
        if count:
            noise[sensor.quantity, sensor.place] = sensor.noise / math.sqrt(count)
    return noise


def _assemblies(points: Sequence[MeasuredPoint]) -> tuple[int, ...]:
    count, assemblies = 0, []
    for point in points:
        count += point.reassembled
        assemblies.append(count)
    return tuple(assemblies)


# Noise from repeats: pooled over the operating points of a series, and the declared uncertainty.

Readings = Mapping[Feature, NDArray[np.float64]]

DECLARED_WEIGHT = 4.0
"""Degrees of freedom the declared uncertainty counts for in addition to repeats."""
OUTLIER = 8.0
"""Distance from the median of its repeats, in standard deviations, from which a reading is thrown out."""
LEAST_PAIRS = 3
"""Operating points with two repeats from which their scatter is known, even if one of them is wrong."""
MAD_TO_SD = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


def pooled_noise(readings: Readings, channels: Mapping[str, MeasuredChannel]) -> dict[Feature, float]:
    """Standard deviation of one reading by feature; of readings without outliers (`without_outliers`).

    A series is a channel, of orders one order with both its parts. Its variance is that of the repeats about
    their means, pooled over all operating points, with the declared one as ``DECLARED_WEIGHT`` further
    degrees of freedom (a conjugate prior); a declared zero counts for nothing.
    """
    squares: dict[tuple[str, float], float] = {}
    freedom: dict[tuple[str, float], float] = {}
    for feature, values in readings.items():
        finite = values[np.isfinite(values)]
        series = (feature.channel, feature.order)
        if finite.size > 1:
            squares[series] = squares.get(series, 0.0) + float(np.sum((finite - finite.mean()) ** 2))
            freedom[series] = freedom.get(series, 0.0) + finite.size - 1
    return {
        feature: _pooled(
            channels[feature.channel].noise,
            squares.get((feature.channel, feature.order), 0.0),
            freedom.get((feature.channel, feature.order), 0.0),
        )
        for feature in readings
    }


def without_outliers(
    readings: Readings, channels: Mapping[str, MeasuredChannel]
) -> tuple[dict[Feature, NDArray[np.float64]], list[DataFinding]]:
    """The readings without those far off their repeats.

    Of three or more repeats the one that is far off goes. Of two that are far apart either may be wrong: neither is
    used. Two repeats at fewer than ``LEAST_PAIRS`` operating points do not tell how far repeats lie apart; they stay,
    suspected.
    """
    scatters = _scatters(readings)
    clean, findings = {}, []
    for feature, values in readings.items():
        clean[feature] = values
        channel = channels[feature.channel]
        finite = np.isfinite(values)
        count = np.count_nonzero(finite)
        if count < 2:
            continue
        scatter, known = scatters[feature.channel, feature.order]
        scale = max(scatter if known else 0.0, channel.noise)
        far = np.zeros(len(values), dtype=bool)
        far[finite] = _deviations(values[finite]) > OUTLIER * scale
        if not (scale > 0.0 and far.any()):
            continue
        order = f", order {feature.order:g}" if feature.part != "value" else ""
        where = f"{feature.channel} at {feature.setting or 'static tests'}{order}"
        points = (feature.setting,) if feature.setting else ()
        numbers = ", ".join(str(i + 1) for i in np.flatnonzero(far))
        if known:
            clean[feature] = np.where(far, np.nan, values)
            problem = f"repeat {numbers} lies more than {OUTLIER:g} standard deviations off the others and is not used"
            if count == 2:
                problem = (
                    f"repeats {numbers} lie more than {OUTLIER:g} standard deviations apart; neither is used"
                )
            findings.append(
                DataFinding(id="repeat_outlier", weight="dropped", channels=(feature.channel,), points=points,
                        text=f"{where}: {problem}; measure again")
            )  # fmt: skip
        else:
            findings.append(
                DataFinding(id="repeats_apart", weight="suspect", channels=(feature.channel,), points=points,
                        text=f"{where}: repeats {numbers} lie more than {OUTLIER:g} declared standard deviations "
                        "apart; measure a third time")
            )  # fmt: skip
    return clean, findings


def _deviations(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) distance of repeats from their median, as large as if the true value were known instead."""
    return np.asarray(np.abs(values - np.median(values)) * np.sqrt(len(values) / (len(values) - 1)))


def _scatters(readings: Readings) -> dict[tuple[str, float], tuple[float, bool]]:
    """Series -> standard deviation of one reading by the median over all its repeats, and whether that is known.

    Known where points with three repeats are among them, or enough with two: then half of them may be wrong.
    """
    deviations: dict[tuple[str, float], list[NDArray[np.float64]]] = {}
    for feature, values in readings.items():
        finite = values[np.isfinite(values)]
        if finite.size > 1:
            deviations.setdefault((feature.channel, feature.order), []).append(_deviations(finite))
    return {
        series: (
            MAD_TO_SD * float(np.median(np.concatenate(series_deviations))),
            len(series_deviations) >= LEAST_PAIRS or any(len(repeats) > 2 for repeats in series_deviations),
        )
        for series, series_deviations in deviations.items()
    }


def _pooled(declared: float, squares: float, freedom: float) -> float:
    weight = DECLARED_WEIGHT if declared > 0.0 else 0.0
    whole = weight + freedom
    return float(np.sqrt((weight * declared**2 + squares) / whole)) if whole else 0.0


# Rates of change of temperatures, from the times of the repeats, as channels of their own.
#
# A rig that was not steady shows twice: its temperatures are off, and they still change. The rate tells it from a film
# or a loss, which leave steady temperatures.

NAME = "rate of {}"
"""Of the channel, by the name of the thermocouple."""


def with_rates(measurement: MeasurementSet) -> MeasurementSet:
    """The set with a channel for the rate of every thermocouple whose repeats have different times [K/s].

    The rate of a point is the slope of its repeats; its uncertainty is that of the least certain point, and what a
    steady rig drifts by.
    """
    slopes_by_channel: dict[str, dict[str, float]] = {}
    spreads: dict[str, float] = {}
    for point in measurement.points:
        for rate in rates(measurement, point):
            slopes_by_channel.setdefault(rate.channel, {})[point.name] = rate.value
            spreads[rate.channel] = max(spreads.get(rate.channel, 0.0), hypot(rate.sd, LEAST))
    if not slopes_by_channel:
        return measurement
    channels = dict(measurement.channels)
    readings = dict(measurement.readings)
    for name, slopes in slopes_by_channel.items():
        channel = MeasuredChannel(
            channel=replace(channels[name].channel, name=NAME.format(name), quantity="warming_rate"),
            unit="K/h",
            noise=spreads[name],
        )
        channels[channel.name] = channel
        readings |= {Feature(channel.name, point): np.array([slope]) for point, slope in slopes.items()}
    return replace(measurement, channels=channels, readings=readings)

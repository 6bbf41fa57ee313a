"""Where simulation and data disagree: residuals, their groups, and a sentence for each."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.json_text import to_plain
from rigdesign.base.units import KINDS
from rigdesign.base.version import __version__
from rigdesign.case import Case
from rigdesign.measurement.comparison.locate import VARIABLES, Bands, Located, locate
from rigdesign.measurement.data import Data
from rigdesign.measurement.loader import load_measurement
from rigdesign.measurement.processing.baseline import (
    Foretold,
    HealthySet,
    at_all,
    foretold,
    setting_spread,
    shared_channels,
)
from rigdesign.measurement.processing.features import features
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.measurement.reading.measurement_set import DataFinding, MeasurementSet
from rigdesign.prediction.model import Channel, Feature, OperatingCondition, Prediction, measured_against
from rigdesign.prediction.predict import Thermal, predict

# Input errors that only the simulation shows: channels exchanged, readings in another unit.

Array = NDArray[np.float64]
RATIO = 1.3
"""How near measured over simulated has to come to the ratio of two units."""
UNLIKE = 3.0
"""Least ratio of two units that can be distinguished from a difference of model and rig."""


def unit_findings(data: Data, simulated: Array) -> Iterator[DataFinding]:
    """Channels whose readings are larger or smaller than simulated by the ratio of two units."""
    for name, entry in data.channels.items():
        kind = CHANNELS[entry.channel.quantity].kind
        if kind == "temperature":
            continue
        rows = [
            i
            for i, f in enumerate(data.features)
            if f.channel == name and data.usable[i] and simulated[i] != 0.0
        ]
        firm = [i for i in rows if abs(data.values[i]) > 3.0 * data.noise[i]]
        if not firm:
            continue
        ratio = float(np.median(np.abs(data.values[firm] / simulated[firm])))
        stated_worth = units.worth(kind, entry.unit)[0]
        for unit in KINDS[kind].units:
            factor = stated_worth / units.worth(kind, unit)[0]
            if max(factor, 1.0 / factor) > UNLIKE and 1.0 / RATIO < ratio / factor < RATIO:
                yield DataFinding(
                    id="unit", weight="suspect", channels=(name,),
                    text=f"{name}: reads {ratio:.3g} times what is simulated; its numbers would fit {unit} instead of "
                    f"{entry.unit}; look at its unit",
                )  # fmt: skip
                break


def thousands_findings(data: Data, simulated: Array) -> Iterator[DataFinding]:
    """Channels of which a few readings are 1000 times less or more than simulated: thousands read as decimals."""
    told = {name for finding in data.findings if finding.id == "thousands" for name in finding.channels}
    rows: dict[str, list[int]] = {}
    for i, feature in enumerate(data.features):
        if data.usable[i] and feature.order == 0.0 and simulated[i] != 0.0:
            rows.setdefault(feature.channel, []).append(i)
    for name in rows.keys() - told:
        entry, of_channel = data.channels[name], np.array(rows[name])
        kind = CHANNELS[entry.channel.quantity].kind
        ratio = np.abs(data.values[of_channel] / simulated[of_channel])
        for factor in (1e-3, 1e3):
            hit = of_channel[(ratio < RATIO * factor) & (ratio * RATIO > factor)]
            if kind == "temperature" or not 0 < 2 * hit.size <= of_channel.size:
                continue
            read, right = (
                units.show(float(x[hit[0]]), kind, entry.unit, 4) for x in (data.values, simulated)
            )
            points = tuple(data.features[i].setting for i in hit)
            yield DataFinding(
                id="thousands", weight="suspect", channels=(name,), points=points,
                text=f"{name} at {', '.join(points)}: reads {read}, simulated is {right}, a factor of 1000; look at "
                "the decimal sign there",
            )  # fmt: skip


FAR = 3.0
"""How far off, in standard deviations, both channels have to be as they stand."""
GAIN = 0.25
"""What may be left of the squared residual when the two are exchanged."""


def swap_findings(data: Data, simulated: Array, spread: Array) -> Iterator[DataFinding]:
    """Suspected swaps of channels of one quantity, best first; each channel is named once."""
    series: dict[str, dict[tuple[str, float, str], int]] = {}
    for i, feature in enumerate(data.features):
        if data.usable[i]:
            key = (feature.setting, feature.order, feature.part)
            series.setdefault(feature.channel, {})[key] = i
    swaps = []
    for first, second in combinations(series, 2):
        if data.channels[first].channel.quantity != data.channels[second].channel.quantity:
            continue
        keys = [key for key in series[first] if key in series[second]]
        if len(keys) < 2:
            continue
        a, b = ([series[name][key] for key in keys] for name in (first, second))
        sigma = np.sqrt(0.5 * (spread[a] ** 2 + spread[b] ** 2))
        as_is = [float(np.mean(((data.values[i] - simulated[i]) / sigma) ** 2)) for i in (a, b)]
        crossed = [
            float(np.mean(((data.values[i] - simulated[j]) / sigma) ** 2)) for i, j in ((a, b), (b, a))
        ]
        if min(as_is) > FAR**2 and all(c < GAIN * s for c, s in zip(crossed, as_is)):
            swaps.append((sum(crossed) / sum(as_is), first, second))
    named: set[str] = set()
    for left, first, second in sorted(swaps):
        if named & {first, second}:
            continue
        named |= {first, second}
        yield DataFinding(
            id="swapped_channels", weight="suspect", channels=(first, second),
            text=f"{first} and {second}: exchanged, they leave {left:.1%} of their squared residual; look at their "
            "cables and names",
        )  # fmt: skip


BY_CHANCE = 1e-3
"""Probability below which a residual is more than the declared uncertainty makes."""
SHOWN = 3
"""Groups named in the headline."""


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Measured and simulated.

    simulated, expected, residual, spread : (n_features,) SI in the order of ``data.features``, NaN where nothing
        is measured; expected = simulated and, where a healthy set has the number, its residual there;
        residual = measured - expected; spread = 1 sigma of noise, settings, sensor and the model's stated error,
        of which a healthy set leaves the noise and settings of both
    healthy, foretold : the baseline of the set and what it says; None without one
    located : groups by the size of their whitened residual
    findings : of the data, and what the simulation adds
    """

    measurement: MeasurementSet
    data: Data
    simulated: Array
    expected: Array
    residual: Array
    spread: Array
    located: tuple[Located, ...]
    sentences: tuple[str, ...]
    findings: tuple[DataFinding, ...]
    healthy: HealthySet | None = None
    foretold: Foretold | None = None

    @property
    def reference(self) -> str:
        """What the readings are held against, in a sentence."""
        return SIMULATION if self.healthy is None else "the simulation and the healthy set"

    @property
    def whitened(self) -> Array:
        """Residual over its standard deviation; NaN where nothing is measured."""
        return np.asarray(self.residual / self.spread)

    @property
    def rms(self) -> float:
        """Root mean square of the whitened residual."""
        return float(np.sqrt(np.nanmean(self.whitened**2)))


def compare(
    measurement: MeasurementSet, data: Data, prediction: Prediction, healthy: HealthySet | None = None
) -> Comparison:
    """Hold measured against simulated numbers; given a healthy set, against what both say.

    ``prediction`` has the features of ``data`` in the same order; ValueError otherwise.
    """
    if prediction.features != data.features:
        raise ValueError(
            "prediction and data have other features; predict with the settings and channels of the data"
        )
    known = None if healthy is None else foretold(data, healthy)
    expected = prediction.values
    variance = _variance(measurement, data, prediction)
    if known is not None:
        expected = expected + np.where(known.known, known.residual, 0.0)
        variance = np.where(known.known, _variance_given(data, prediction, known), variance)
    residual = np.where(data.usable, data.values - expected, np.nan)
    spread = np.where(data.usable, np.sqrt(variance), np.nan)
    bands = Bands(measurement)
    groups = [bands.of(feature) for feature in data.features]
    ambient = measurement.case.ambient.temperature
    located = locate(data.features, residual, spread, groups, data.settings, ambient)
    comparison = Comparison(
        measurement=measurement,
        data=data,
        simulated=prediction.values,
        expected=expected,
        residual=residual,
        spread=spread,
        located=located,
        sentences=(),
        findings=(
            *data.findings,
            *(_of_baseline(data, healthy, known) if healthy is not None and known is not None else ()),
            *unit_findings(data, prediction.values),
            *thousands_findings(data, prediction.values),
            *swap_findings(data, expected, spread),
        ),
        healthy=healthy,
        foretold=known,
    )
    said = (sentence(item, measurement, comparison.reference) for item in located if significant(item))
    return replace(comparison, sentences=tuple(said))


def _of_baseline(data: Data, healthy: HealthySet, known: Foretold) -> Iterator[DataFinding]:
    """What the healthy set says of itself, and how much of this one it does not have."""
    for finding in healthy.data.findings:
        yield replace(finding, text=f"healthy set: {finding.text}")
    lacking = int(np.count_nonzero(data.usable & ~known.known))
    if lacking:
        gone = tuple(setting.name for setting in data.settings if setting.name not in known.points)
        why = f" (operating points not met again: {', '.join(gone)})" if gone else ""
        yield DataFinding(
            id="not_in_baseline", weight="note", points=gone,
            text=f"{lacking} of {int(data.usable.sum())} numbers have no counterpart in the healthy set{why}; they are "
            "held against the simulation alone",
        )  # fmt: skip


def significant(item: Located) -> bool:
    """Whether a group is off by more than the declared uncertainty makes by chance."""
    return item.excess < BY_CHANCE


def headline(comparison: Comparison) -> str:
    """The verdict in a sentence."""
    count = int(np.count_nonzero(comparison.data.usable))
    given = "" if comparison.healthy is None else f"Given the healthy set {_title(comparison.healthy)}: "
    if not comparison.sentences:
        compared = "Simulation and data" if not given else "simulation, healthy set and data"
        return (
            f"{given}{compared} agree within the declared uncertainty at all {count} numbers "
            f"(whitened residual {comparison.rms:.2g}, expected 1)."
        )
    more = len(comparison.sentences) - SHOWN
    tail = f" {more} more groups differ." if more > 0 else ""
    return given + " ".join(comparison.sentences[:SHOWN]) + tail


def _title(healthy: HealthySet) -> str:
    return f"“{healthy.measurement.title}”"


SIMULATION = "the simulation"


def sentence(item: Located, measurement: MeasurementSet, reference: str = SIMULATION) -> str:
    """One group as a sentence: where, which way off ``reference``, how much, at which points, along with what."""
    size = f"by up to {_largest_by_quantity(item, measurement)}"
    if "orders" in item.group:
        way = f"off {size}"
    elif item.positive > 0.9:
        way = f"above {reference} {size}"
    elif item.positive < 0.1:
        way = f"below {reference} {size}"
    else:
        way = f"off {reference} both ways {size}"
    text = f"{item.group[0].upper()}{item.group[1:]}: {way}"
    if set(item.points) - {""}:
        count = len(item.points)
        text += (
            ", all operating points"
            if count == item.all_points > 1
            else f", {count} of {item.all_points} operating points"
        )
    if item.variable:
        text += f"; the difference {VARIABLES[item.variable]} ({100.0 * item.share:.0f} % of it)"
    return text + "."


def _largest_by_quantity(item: Located, measurement: MeasurementSet) -> str:
    """Size of the largest difference of every quantity of a group, in the unit of its first channel."""
    largest: dict[str, tuple[float, str]] = {}
    for name, value in item.largest.items():
        channel = measurement.channels[name]
        quantity = channel.channel.quantity
        before, unit = largest.get(quantity, (0.0, channel.unit))
        largest[quantity] = max(before, abs(value)), unit
    sizes = (display_residual(value, quantity, unit) for quantity, (value, unit) in largest.items())
    return " and ".join(f"{value:.3g} {unit}" for value, unit in sizes)


def display_residual(value: float, quantity: str, unit: str) -> tuple[float, str]:
    """A difference [SI] in the unit of its channel; of temperatures in kelvin."""
    measured = CHANNELS[quantity]
    if measured.kind == "temperature":
        return value, "K"
    return value / units.worth(measured.kind, unit)[0], unit


def _variance(measurement: MeasurementSet, data: Data, prediction: Prediction) -> Array:
    """Of measured minus simulated: noise, scatter of the settings, offset, scale, stated error of the model."""
    ambient = {
        setting.name: setting.ambient_temperature or measurement.case.ambient.temperature
        for setting in data.settings
    }
    inputs = setting_spread(data, prediction.values)
    variance = np.empty(len(data.features))
    for i, feature in enumerate(data.features):
        entry = data.channels[feature.channel]
        thermal = CHANNELS[entry.channel.quantity].kind == "temperature"
        level = data.values[i] - ambient.get(feature.setting, 0.0) if thermal else data.values[i]
        offset = entry.offset_sd if feature.part == "value" else 0.0
        error = prediction.error if thermal else 0.0
        variance[i] = (
            data.noise[i] ** 2 + inputs[i] ** 2 + offset**2 + (entry.scale_sd * level) ** 2 + error**2
        )
    return variance


def _variance_given(data: Data, prediction: Prediction, known: Foretold) -> Array:
    """Of the difference of two residuals: noise and scatter of the settings of both sets.

    Offset and stated error are in both and cancel, the scale but for the difference of the readings.
    """
    inputs = setting_spread(data, prediction.values)
    scale = np.array([data.channels[feature.channel].scale_sd for feature in data.features])
    steps = scale * (data.values - known.reading)
    return np.asarray(data.noise**2 + inputs**2 + known.variance + steps**2)


def comparison_document(comparison: Comparison, *, model: str, fidelity: str) -> dict[str, Any]:
    """compare.json: what was compared, the sentence, the groups, every number, and the findings."""
    measurement, data = comparison.measurement, comparison.data
    case = measurement.case
    healthy = None if comparison.healthy is None else comparison.healthy.measurement
    return {
        "schema_version": 1,
        "tool_version": __version__,
        "case": {"name": case.name, "path": str(case.path), "hash": case.hash},
        "measurement": {
            "title": measurement.title,
            "path": str(measurement.folder),
            "hash": measurement.hash,
            "points": len(data.settings),
            "channels": list(data.channels),
            "strength": data.strength,
        },
        "baseline": None
        if healthy is None
        else {
            "title": healthy.title,
            "path": str(healthy.folder),
            "hash": healthy.hash,
            "points": {here: before for here, before in comparison.foretold.points.items() if here}
            if comparison.foretold is not None
            else {},
        },
        "model": {"thermal": model, "fidelity": fidelity},
        "headline": headline(comparison),
        "whitened_rms": to_plain(comparison.rms),
        "numbers": int(np.count_nonzero(data.usable)),
        "located": [_located_row(item, comparison) for item in comparison.located],
        "settings": [_setting_row(setting) for setting in data.settings],
        "residuals": _residual_rows(comparison),
        "findings": to_plain(comparison.findings),
    }


def _located_row(item: Located, comparison: Comparison) -> dict[str, Any]:
    return {
        "group": item.group,
        "significant": significant(item),
        "sentence": sentence(item, comparison.measurement, comparison.reference),
        "whitened_rms": to_plain(item.rms),
        "by_chance": to_plain(item.excess),
        "leading_variable": item.variable or None,
        "explained_share": to_plain(item.share),
        "channels": list(item.channels),
        "points_off": list(item.points),
    }


def _setting_row(setting: OperatingCondition) -> dict[str, Any]:
    return {
        "point": setting.name,
        "speed_rpm": to_plain(units.display(setting.speed, "speed")),
        "torque_Nm": to_plain(setting.torque),
        "inlet_temperature_degC": {
            k: to_plain(units.display(v, "temperature")) for k, v in setting.inlet_temperature.items()
        },
        "flow_l_min": {k: to_plain(units.display(v, "flow")) for k, v in setting.flow.items()},
        "ambient_temperature_degC": None
        if setting.ambient_temperature is None
        else to_plain(units.display(setting.ambient_temperature, "temperature")),
    }


def _residual_rows(comparison: Comparison) -> list[dict[str, Any]]:
    rows = []
    data = comparison.data
    for i, feature in enumerate(data.features):
        if not data.usable[i]:
            continue
        entry = data.channels[feature.channel]
        quantity, unit = entry.channel.quantity, entry.unit
        numbers = (data.values[i], comparison.simulated[i], comparison.expected[i])
        measured, simulated, expected = (
            units.display(float(x), CHANNELS[quantity].kind, unit) for x in numbers
        )
        residual, residual_unit = display_residual(float(comparison.residual[i]), quantity, unit)
        spread, _ = display_residual(float(comparison.spread[i]), quantity, unit)
        rows.append(
            {
                "channel": feature.channel, "point": feature.setting or None, "order": feature.order,
                "part": feature.part, "measured": to_plain(measured), "simulated": to_plain(simulated),
                "expected": to_plain(expected), "unit": unit,
                "residual": to_plain(residual), "spread": to_plain(spread), "residual_unit": residual_unit,
                "whitened": to_plain(float(comparison.whitened[i])), "repeats": int(data.repeats[i]),
            }
        )  # fmt: skip
    return rows


def series_of(features: Sequence[Feature]) -> dict[str, list[int]]:
    """Features by what one row of a map shows: a channel, of orders one order."""
    rows: dict[str, list[int]] = {}
    for i, feature in enumerate(features):
        label = feature.channel if feature.order == 0.0 else f"{feature.channel}, order {feature.order:g}"
        rows.setdefault(label, []).append(i)
    return rows


# A comparison from files: measurement set, healthy set if it names one, simulation of both.

Progress = Callable[[str], None]


def compare_measurement(
    case: Case,
    folder: Path,
    *,
    model: Thermal = "full",
    fidelity: Fidelity = "quick",
    say: Progress = lambda message: None,
) -> Comparison:
    """Hold a measurement set, and the healthy set it declares, against the simulation.

    Raises
    ------
    MeasurementError
        Data of which nothing can be used, in either set.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    measurement = load_measurement(folder, case)
    baseline = None if measurement.baseline is None else load_measurement(measurement.baseline, case)
    data = features(measurement)
    healthy = None if baseline is None else features(baseline)

    def simulated(of: Data, channels: Sequence[Channel], title: str) -> Prediction:
        say(f"predicting {len(of.settings)} operating points of {title}")
        return predict(
            case, of.settings, channels, model=model, fidelity=fidelity, circuit=measured_against(channels)
        )

    prediction = simulated(data, [entry.channel for entry in data.channels.values()], "the set")
    if baseline is None or healthy is None:
        return compare(measurement, data, prediction)
    shared = simulated(healthy, shared_channels(data, healthy), "the healthy set")
    known = HealthySet(measurement=baseline, data=healthy, prediction=at_all(healthy, shared))
    return compare(measurement, data, prediction, known)

"""Data checks: what readings say about themselves before any model is evaluated."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.part_name import BearingName
from rigdesign.measurement.quantities import Measured, impossible, impossible_text, to_si
from rigdesign.measurement.reading.measurement_set import DataFinding, MeasuredPoint, MeasurementSet
from rigdesign.measurement.reading.signals import Signal, TurnAngle
from rigdesign.prediction.model import STANDING_QUANTITIES, Feature

LEAST_POINTS = 3
"""Operating points from which a reading that never moves is a dead sensor."""


def data_findings(measurement: MeasurementSet) -> tuple[frozenset[str], tuple[DataFinding, ...]]:
    """Channels that cannot be used, and everything the checks have to say."""
    findings = [
        *_dead(measurement),
        *_without_uncertainty(measurement),
        *_without_support(measurement),
        *still_warming(measurement),
    ]
    dropped = {name for finding in findings if finding.weight == "dropped" for name in finding.channels}
    return frozenset(dropped), tuple(findings)


def _dead(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """A sensor whose reading is the same number over different operating points."""
    for name, entry in measurement.channels.items():
        if entry.channel.quantity in STANDING_QUANTITIES:
            continue
        readings = measurement.by_channel[name]
        levels = np.concatenate(
            [values[np.isfinite(values)] for values in readings.values()] or [np.empty(0)]
        )
        moving = bool(levels.size and np.ptp(levels) > 0.0)
        points = {feature.setting for feature, values in readings.items() if np.isfinite(values).any()}
        if not points:
            yield DataFinding(
                id="dead_channel", weight="dropped", channels=(name,),
                text=f"{name}: has no reading at any operating point and is left out",
            )  # fmt: skip
        elif len(points) >= LEAST_POINTS and not moving:
            yield DataFinding(
                id="dead_channel", weight="dropped", channels=(name,),
                text=f"{name}: reads the same number at all {len(points)} operating points and is left out; look at "
                "sensor and cable",
            )  # fmt: skip


def _without_uncertainty(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """A declared uncertainty of zero: repeats stand in, without them the channel has no weight."""
    for name, entry in measurement.channels.items():
        if entry.noise > 0.0:
            continue
        scatter = any(
            np.count_nonzero(np.isfinite(values)) > 1 and np.nanstd(values) > 0.0
            for values in measurement.by_channel[name].values()
        )  # fmt: skip
        if scatter:
            text = f"{name}: the declared uncertainty is zero; the scatter of its repeats is taken"
            yield DataFinding(id="zero_uncertainty", weight="note", channels=(name,), text=text)
        else:
            text = (
                f"{name}: the declared uncertainty is zero and no repeats say otherwise, so it has no weight and "
                "is left out; state the uncertainty of one reading"
            )
            yield DataFinding(id="zero_uncertainty", weight="dropped", channels=(name,), text=text)


def _without_support(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """An accelerometer on a housing that stands still in the model: compared is the shaft in the bearing."""
    for name, entry in measurement.channels.items():
        if entry.channel.quantity != "acceleration":
            continue
        box, bearing = BearingName.read(entry.channel.place).both
        gearbox = measurement.case.gearboxes[box]
        seated = gearbox.housing is not None and gearbox.housing.bearing_seats == "elastic"
        if gearbox.bearings[bearing].support_stiffness is None and not seated:
            yield DataFinding(
                id="acceleration_of_shaft", weight="note", channels=(name,),
                text=f"{name}: the case has no support under {entry.channel.place}, so that the acceleration of "
                f"the shaft in it is predicted; state the support_stiffness of gearboxes.{box}.bearings.{bearing}",
            )  # fmt: skip


# Repeats of a point that drift with time: the rig still warms up, or cools down.
#
# The rate of each thermocouple is the slope of its repeats over their times, by least squares; all of a point together
# decide whether it drifts. Thermal equilibrium: no part changes by more than 2 K per hour (IEC 60034-1, 3.25).

HOUR = 3600.0
EQUILIBRIUM = 2.0 / HOUR
"""Largest rate of a steady machine [K/s]."""
LEAST = 0.2 / HOUR
"""Rate that is worth a word [K/s]."""
SURE = 5.0
"""Standard deviations of the rates of all thermocouples together from which a point drifts."""


@dataclass(frozen=True)
class Rate:
    """How fast a thermocouple changes over the repeats of a point [K/s], with its standard deviation."""

    channel: str
    value: float
    sd: float


def rates(measurement: MeasurementSet, point: MeasuredPoint) -> list[Rate]:
    """Of every thermocouple with two repeats at different times; none where the table has no times."""
    rates_of_point = []
    for name, entry in measurement.channels.items():
        values = measurement.readings.get(Feature(name, point.name))
        if entry.channel.quantity != "temperature" or values is None or point.times is None:
            continue
        known = np.isfinite(values) & np.isfinite(point.times)
        fitted = _slope(point.times[known], values[known]) if np.count_nonzero(known) > 1 else None
        if fitted is not None and entry.noise > 0.0:
            slope, spread = fitted
            rates_of_point.append(Rate(name, slope, entry.noise / spread))
    return rates_of_point


def still_warming(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """Points whose temperatures drift from repeat to repeat."""
    for point in measurement.points:
        drifts = rates(measurement, point)
        if not drifts or not point.steady:
            continue
        together = sum(rate.value / rate.sd for rate in drifts) / np.sqrt(len(drifts))
        fastest = max(drifts, key=lambda rate: abs(rate.value))
        if abs(together) < SURE or abs(fastest.value) < LEAST:
            continue
        still = "still rise" if together > 0.0 else "still fall"
        yield DataFinding(
            id="still_warming",
            weight="suspect" if abs(fastest.value) > EQUILIBRIUM else "note",
            channels=tuple(rate.channel for rate in drifts if abs(rate.value) > SURE * rate.sd),
            points=(point.name,),
            text=f"{point.name}: temperatures {still} from repeat to repeat, by {HOUR * abs(fastest.value):.2g} K/h at "
            f"{fastest.channel} (± {HOUR * fastest.sd:.1g}); wait and measure again, or write steady = false under "
            f"[points.{point.name}]",
        )


def _slope(times: NDArray[np.float64], values: NDArray[np.float64]) -> tuple[float, float] | None:
    """Slope over time, and the root of the sum of squares of the times; None where they do not differ."""
    away = times - times.mean()
    square = float(away @ away)
    return (float(away @ values) / square, square**0.5) if square > 0.0 else None


# What a raw signal says about its own sensor: dead, clipped, missing stretches, lines where none should be.

LEAST_CLIPPED = 1e-3
"""Share of samples at the very largest or smallest value from which a signal may be clipped."""
CLIPPED_STEP = 6.0
"""How many times more samples stand there than one step of the converter below."""
MOST_MISSING = 0.5
"""Share of missing samples from which a signal is not used."""
SPIKE = 100.0
"""Distance from the median of its signal, in standard deviations, that no torque or temperature has."""
MOST_SPIKES = 1e-3
"""Share of samples above which they belong to the signal."""
QUARTILES = 1.349
"""Distance of the quartiles of a normal distribution in its standard deviations."""
SEARCH = np.linspace(-0.05, 0.05, 201)
"""Relative distance from the mesh order in which a line is looked for."""
LINE_OFF = 0.004
LINE_ABOVE = 5.0
SEARCH_TURNS = 40


def without_wrong_samples(
    signal: Signal, measured: Measured, unit: str
) -> tuple[Signal, list[tuple[str, Literal["note"], str]]]:
    """The signal with samples missing that its quantity cannot have or that stand alone, and what is said of them.

    unit : of the signal; finite samples that are few and farther than ``SPIKE`` from all others stand alone
    """
    values = signal.values
    wrong = impossible(to_si(values, measured.kind, unit), measured)
    said: list[tuple[str, Literal["note"], str]] = []
    if wrong.any():
        text = f"{_first(signal, wrong, unit)}: {impossible_text(measured, unit, int(wrong.sum()))}"
        said.append(("impossible_reading", "note", text))
    alone = _spikes(np.where(wrong, np.nan, values))
    if alone.any():
        more = f", as do {int(alone.sum()) - 1} more" if alone.sum() > 1 else ""
        text = f"{_first(signal, alone, unit)}: lies more than {SPIKE:g} standard deviations off the others{more}"
        said.append(("spike", "note", f"{text}; not used"))
    return replace(signal, values=np.where(wrong | alone, np.nan, values)), said


def _first(signal: Signal, wrong: NDArray[np.bool_], unit: str) -> str:
    place = int(np.flatnonzero(wrong)[0])
    return f"sample {place + 1} (at {signal.time[place]:.6g} s) = {signal.values[place]:g} {unit}"


def _spikes(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) samples far off all others by the middle half of them; none where they are more than a few."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return np.zeros(len(values), dtype=bool)
    low, middle, high = np.quantile(finite, (0.25, 0.5, 0.75))
    far = np.abs(values - middle) > SPIKE * (high - low) / QUARTILES
    few = high > low and np.count_nonzero(far) <= MOST_SPIKES * finite.size
    return np.asarray(far if few else np.zeros(len(values), dtype=bool))


def usable_signal(signal: Signal) -> bool:
    """Whether a signal is alive, whole enough and not clipped."""
    return not any(weight == "dropped" for _, weight, _ in signal_findings(signal))


def signal_findings(signal: Signal) -> Iterator[tuple[str, Literal["dropped", "note"], str]]:
    """Id, weight and sentence of everything wrong with a signal."""
    values = signal.values[np.isfinite(signal.values)]
    missing = 1.0 - values.size / signal.values.size
    if missing > MOST_MISSING:
        yield "missing_samples", "dropped", f"{missing:.0%} of its samples are missing; it is not used"
        return
    if missing > 0.0:
        yield "missing_samples", "note", f"{missing:.2%} of its samples are missing"
    if np.ptp(values) == 0.0:
        yield (
            "dead_channel",
            "dropped",
            f"reads {values[0]:g} throughout and is not used; look at sensor and cable",
        )
    elif clipped(signal):
        yield (
            "clipped", "dropped",
            f"is clipped between {values.min():.5g} and {values.max():.5g} and is not used; lower the gain",
        )  # fmt: skip


def clipped(signal: Signal) -> bool:
    """Whether samples pile up at the largest or smallest value, in runs, as no converter step explains."""
    finite = signal.values[np.isfinite(signal.values)]
    levels, counts = np.unique(finite, return_counts=True)
    if len(levels) < 4:
        return False
    for end, inner in ((-1, -2), (0, 1)):
        many = counts[end] > LEAST_CLIPPED * finite.size and counts[end] > CLIPPED_STEP * counts[inner]
        at_end = finite == levels[end]
        runs = at_end[2:] & at_end[1:-1] & at_end[:-2]
        if many and runs.any():
            return True
    return False


def lines_off_the_mesh(
    signal: Signal, turn: TurnAngle, mesh_orders: Mapping[str, Fraction]
) -> Iterator[tuple[str, float]]:
    """Meshes near whose order, within 5 %, there is a line far above the order itself.

    Tooth numbers, pulses per turn or speed are wrong then. Sidebands of few teeth lie further away.
    """
    angle = turn.at(signal.time)
    inside = np.isfinite(angle) & np.isfinite(signal.values)
    inside &= angle <= np.nanmin(angle) + 2.0 * math.pi * SEARCH_TURNS
    angle, values = angle[inside], signal.values[inside]
    if angle.size < 2 or np.ptp(angle) < 2.0 * math.pi * SEARCH_TURNS * 0.9:
        return
    window = np.hanning(angle.size) * np.gradient(angle)
    weighted = window * (values - values.mean())
    rate = angle.size / np.ptp(angle) * 2.0 * math.pi
    for order, mesh in {float(order): mesh for mesh, order in mesh_orders.items()}.items():
        if order * 1.05 * 2.5 > rate or order * SEARCH[-1] * SEARCH_TURNS < 4.0:
            continue
        near = SEARCH[np.abs(SEARCH) * order < 0.8]
        sizes = np.array([abs(np.sum(weighted * np.exp(-1j * order * (1 + x) * angle))) for x in near])
        best = int(np.argmax(sizes))
        mesh_line = sizes[np.abs(near) * order * SEARCH_TURNS < 3.0].max(initial=0.0)
        if abs(near[best]) > LINE_OFF and sizes[best] > LINE_ABOVE * mesh_line:
            yield mesh, order * (1.0 + float(near[best]))

"""Repeats of a point that drift with time: the rig still warms up, or cools down.

The rate of each thermocouple is the slope of its repeats over their times, by least squares; all of a point together
decide whether it drifts. Thermal equilibrium: no part changes by more than 2 K per hour (IEC 60034-1, 3.25).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.reading.measurement_set import DataFinding, MeasuredPoint, MeasurementSet
from rigdesign.prediction.model import Feature

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
    found = []
    for name, entry in measurement.channels.items():
        values = measurement.readings.get(Feature(name, point.name))
        if entry.channel.quantity != "temperature" or values is None or point.times is None:
            continue
        known = np.isfinite(values) & np.isfinite(point.times)
        fitted = _slope(point.times[known], values[known]) if np.count_nonzero(known) > 1 else None
        if fitted is not None and entry.noise > 0.0:
            slope, spread = fitted
            found.append(Rate(name, slope, entry.noise / spread))
    return found


def still_warming(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """Points whose temperatures drift from repeat to repeat."""
    for point in measurement.points:
        own = rates(measurement, point)
        if not own or not point.steady:
            continue
        together = sum(rate.value / rate.sd for rate in own) / np.sqrt(len(own))
        fastest = max(own, key=lambda rate: abs(rate.value))
        if abs(together) < SURE or abs(fastest.value) < LEAST:
            continue
        still = "still rise" if together > 0.0 else "still fall"
        yield DataFinding(
            id="still_warming",
            weight="suspect" if abs(fastest.value) > EQUILIBRIUM else "note",
            channels=tuple(rate.channel for rate in own if abs(rate.value) > SURE * rate.sd),
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

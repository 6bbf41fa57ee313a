"""Rates of change of temperatures, from the times of the repeats, as channels of their own.

A rig that was not steady shows twice: its temperatures are off, and they still change. The rate tells it from a film or
a loss, which leave steady temperatures.
"""

from dataclasses import replace
from math import hypot

import numpy as np

from rigdesign.measurement.quality.still_warming import LEAST, rates
from rigdesign.measurement.reading.measurement_set import MeasuredChannel, MeasurementSet
from rigdesign.prediction.model import Feature

NAME = "rate of {}"
"""Of the channel, by the name of the thermocouple."""


def with_rates(measurement: MeasurementSet) -> MeasurementSet:
    """The set with a channel for the rate of every thermocouple whose repeats have different times [K/s].

    The rate of a point is the slope of its repeats; its uncertainty is that of the least certain point, and what a
    steady rig drifts by.
    """
    found: dict[str, dict[str, float]] = {}
    spreads: dict[str, float] = {}
    for point in measurement.points:
        for rate in rates(measurement, point):
            found.setdefault(rate.channel, {})[point.name] = rate.value
            spreads[rate.channel] = max(spreads.get(rate.channel, 0.0), hypot(rate.sd, LEAST))
    if not found:
        return measurement
    channels = dict(measurement.channels)
    readings = dict(measurement.readings)
    for name, slopes in found.items():
        channel = MeasuredChannel(
            channel=replace(channels[name].channel, name=NAME.format(name), quantity="warming_rate"),
            unit="K/h",
            noise=spreads[name],
        )
        channels[channel.name] = channel
        readings |= {Feature(channel.name, point): np.array([slope]) for point, slope in slopes.items()}
    return replace(measurement, channels=channels, readings=readings)

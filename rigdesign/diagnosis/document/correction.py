"""What a diagnosis corrects in the measurement: exchanged channels, units, and sensors that read off.

What measurement.toml has a key for becomes a JSON Patch on it; the rest is a correction in words and numbers, to be
made in the table or at the rig. No file of the user is written to.
"""

import math
from dataclasses import dataclass
from typing import Any

from rigdesign.diagnosis.decision.naming import Sized, formatted
from rigdesign.diagnosis.residual.sensors import SensorError, index_pulse_offset
from rigdesign.measurement import MeasuredChannel, MeasurementSet
from rigdesign.measurement.reading.directions import direction_text

MISREAD_UNITS = {
    ("degC", "fahrenheit"): "degF",
    ("degC", "kelvin as celsius"): "K",
    ("W", "kilowatt"): "kW",
    ("N m", "kilonewton metre"): "kN m",
    ("Nm", "kilonewton metre"): "kN m",
    ("N m", "newton millimetre"): "N mm",
    ("Nm", "newton millimetre"): "N mm",
}
"""Unit as stated and what was found -> unit to state."""


@dataclass(frozen=True, kw_only=True)
class Correction:
    """One thing to put right in the data.

    operations : JSON Patch on measurement.toml, empty where no key says it; size : of a sensor that reads off
    """

    name: str
    text: str
    operations: tuple[dict[str, Any], ...] = ()
    size: Sized | None = None


def of_sensor(sized: Sized) -> Correction:
    """Of a sensor or setting that reads off."""
    assert isinstance(sized.entry, SensorError)
    value = sized.shown[0]
    channel = sized.name.partition(":")[2] or sized.name
    text = f"{sized.entry.title}: {formatted(value)}; "
    if sized.name == "angle_zero":
        text += _turned(f"{value.value:.4g} rad")
        return Correction(name=sized.name, text=text, size=sized)
    if sized.name.startswith("torque_lag"):
        corner = 1.0 / (2.0 * math.pi * value.value)
        text += (
            f'state transfer = {{ kind = "low_pass", frequency = "{corner:.4g} Hz" }} for {channel}, or have cell and '
            "amplifier tested for their bandwidth"
        )
        return Correction(name=sized.name, text=text, size=sized)
    if sized.entry.kind == "input":
        text += "the rig ran at another value than was read; correct the column of this setting"
    elif sized.name.startswith("sensor_scale"):
        text += f"divide the readings of {channel} by 1 + {value.value:.4g}, of a thermocouple its excess over ambient"
    else:
        text += f"subtract {value.value:.4g} {value.unit} from every reading of {channel}"
    return Correction(name=sized.name, text=f"{text}, or have the sensor calibrated", size=sized)


def of_data(name: str, measurement: MeasurementSet) -> Correction:
    """Of data that are wrong as they stand, by the name of the explanation."""
    kind, _, rest = name.partition(":")
    first, _, second = rest.partition(",")
    if kind == "swapped_channels":
        here, there = measurement.channels[first], measurement.channels[second]
        return Correction(
            name=name,
            text=f"exchange the places of channels {first} and {second}, and look at the wiring",
            operations=(*_placed(here, there), *_placed(there, here)),
        )
    if kind == "swapped_points":
        return Correction(
            name=name,
            text=f"exchange the readings of operating points {first} and {second} in the table, settings kept, once "
            "the log of the test says so",
        )
    if angle := index_pulse_offset(name):
        return Correction(name=name, text=_turned(angle))
    channel, _, found = rest.partition(" (")
    found = found.removesuffix(")")
    entry = measurement.channels.get(channel)
    unit = None if entry is None else MISREAD_UNITS.get((entry.unit, found))
    if unit is not None:
        return Correction(
            name=name,
            text=f"state {unit} as the unit of {channel}, in the units row of the table too",
            operations=({"op": "replace", "path": f"/channels/{_token(channel)}/unit", "value": unit},),
        )
    return Correction(
        name=name,
        text=f"the readings of {channel} look as if of another unit or sign ({found}); convert its column",
    )


def _turned(angle: str) -> str:
    return f"add {angle} to the angle of the reference gear (zero under data.tach of recordings)"


def _placed(channel: MeasuredChannel, other: MeasuredChannel) -> list[dict[str, Any]]:
    """Put a channel where another one is."""
    at = f"/channels/{_token(channel.name)}"
    operations: list[dict[str, Any]] = [{"op": "add", "path": f"{at}/place", "value": other.channel.place}]
    if other.channel.at is not None:
        place = [f"{value:.10g} m" for value in other.channel.at]
        operations.append({"op": "add", "path": f"{at}/at", "value": place})
    elif channel.channel.at is not None:
        operations.append({"op": "remove", "path": f"{at}/at"})
    if other.channel.direction is not None:
        spelled = direction_text(other.channel.direction)
        operations.append({"op": "add", "path": f"{at}/direction", "value": spelled})
    if other.channel.position is not None:
        position = f"{other.channel.position:.10g} m"
        operations.append({"op": "add", "path": f"{at}/position", "value": position})
    elif channel.channel.position is not None:
        operations.append({"op": "remove", "path": f"{at}/position"})
    return operations


def _token(name: str) -> str:
    return name.replace("~", "~0").replace("/", "~1")

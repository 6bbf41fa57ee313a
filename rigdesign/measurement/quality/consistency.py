"""Data checks on means: points that contradict each other, sizes that fit another unit, heat that does not add up."""

import math
from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from rigdesign.base import units
from rigdesign.base.part_name import OilStreamName
from rigdesign.base.units import KINDS, ZERO_CELSIUS
from rigdesign.case import Case
from rigdesign.case.geometry import housing_geometry
from rigdesign.measurement.quantities import CHANNELS, SETTINGS, to_si
from rigdesign.measurement.reading.measurement_set import DataFinding, MeasurementSet
from rigdesign.prediction.model import OperatingCondition
from rigdesign.properties.oil import MIL_PRF_23699, OILS
from thermal.housing.housing_surfaces import exact_areas

if TYPE_CHECKING:
    from rigdesign.measurement.data import Data

SAME = 3.0
"""Standard deviations within which two settings are the same."""
SAME_SHARE = 0.003
"""Relative difference within which they are the same, too."""
CONTRADICTION = 5.0
"""Root mean square of the differences of two points of one setting, in standard deviations, that is suspect."""
STEADY = 0.01
"""Part of a reading (of a temperature in degrees Celsius) that settings alike to ``SAME`` may still move."""
SCATTER = 3.0
"""Repeats that scatter this many times more than declared are worth a word."""
ROOM_FILM = 15.0
"""Film and radiation to still room air, at most [W/(m2 K)]."""
METER = 0.1
"""Error of flow, power and oil data together that is no contradiction."""
COLDER, HOTTER = 40.0, 200.0
"""Temperatures of a rig lie within this of the room and of its hottest oil [K]."""
FAST, STRONG, FLOWING = 2.0, 5.0, 20.0
"""Most a speed, torque or flow may exceed that of the case before its unit is doubted."""


def consistency_findings(measurement: MeasurementSet, data: "Data") -> tuple[DataFinding, ...]:
    """Everything the checks have to say of a set without the readings that were dropped; nothing more is left out."""
    return (
        *_temperatures(measurement.case, data),
        *_settings(measurement, data),
        *_contradictions(data),
        *_same_readings(measurement),
        *_scatter(measurement),
        *_drive(measurement.case, data),
        *_heat(measurement.case, data),
    )


def _temperatures(case: Case, data: "Data") -> Iterator[DataFinding]:
    """Temperatures no rig has, which another unit would explain."""
    rooms = [setting.ambient_temperature or case.ambient.temperature for setting in data.settings]
    hottest = max(
        [value for setting in data.settings for value in setting.inlet_temperature.values()]
        + [temperature for box in case.gearboxes.values() for temperature in box.stated_oil_temperatures]
    )
    low, high = min(rooms) - COLDER, hottest + HOTTER
    by_channel: dict[str, list[float]] = {}
    for feature, value, usable in zip(data.features, data.values, data.usable):
        if usable:
            by_channel.setdefault(feature.channel, []).append(float(value))
    for name, entry in data.channels.items():
        if CHANNELS[entry.channel.quantity].kind != "temperature":
            continue
        values = by_channel.get(name)
        if not values or low <= (middle := float(np.median(values))) <= high:
            continue
        shown = units.display(middle, "temperature", entry.unit)
        other = [unit for unit in KINDS["temperature"].units
                 if unit != entry.unit and low <= to_si(shown, "temperature", unit) <= high]  # fmt: skip
        hint = f"in {other[0]} it would fit; " if other else ""
        yield DataFinding(
            id="unit", weight="suspect", channels=(name,),
            text=f"{name}: reads about {shown:.4g} {entry.unit}, outside {units.show(low, 'temperature', digits=3)} to "
            f"{units.show(high, 'temperature', digits=3)}; {hint}look at its unit",
        )  # fmt: skip


def _settings(measurement: MeasurementSet, data: "Data") -> Iterator[DataFinding]:
    """Speeds, torques and flows far beyond the case, which another unit would explain."""
    case = measurement.case
    for column, sensor in measurement.setting_sensors.items():
        if sensor.quantity == "speed":
            usual, most = case.schedule.test_speed, FAST
        elif sensor.quantity == "torque":
            usual, most = case.schedule.test_torque, STRONG
        elif sensor.quantity == "flow":
            stream = OilStreamName.read(sensor.place)
            usual = case.gearboxes[stream.gearbox].feeds[stream.part][0].flow
            most = FLOWING
        else:
            continue
        readings = np.concatenate([point.readings[column] for point in measurement.points])
        middle = float(np.nanmedian(readings)) if np.isfinite(readings).any() else math.nan
        small = sensor.quantity == "flow" and 0.0 < middle < usual / most
        if not (middle > most * usual or small):
            continue
        kind = SETTINGS[sensor.quantity].kind
        shown = units.display(middle, kind, sensor.unit)
        fits = [unit for unit in KINDS[kind].units
                if usual / 3.0 < to_si(shown, kind, unit) < most * usual and unit != sensor.unit]  # fmt: skip
        hint = f"in {fits[0]} it would fit; " if fits else ""
        yield DataFinding(
            id="unit", weight="suspect", channels=(column,),
            text=f"{column}: about {shown:.4g} {sensor.unit}, the case has {units.show(usual, kind, digits=4)}; {hint}"
            "look at its unit",
        )  # fmt: skip


def _contradictions(data: "Data") -> Iterator[DataFinding]:
    """Points run alike that read otherwise; across a reassembly that is how well assembly repeats."""
    by_point: dict[str, dict[tuple[str, float, str], int]] = {}
    for i, feature in enumerate(data.features):
        if data.usable[i] and feature.setting:
            by_point.setdefault(feature.setting, {})[feature.channel, feature.order, feature.part] = i
    for (i, first), (j, second) in combinations(enumerate(data.settings), 2):
        if not _alike(first, second, data.setting_noise[i]):
            continue
        mine, other = by_point.get(first.name, {}), by_point.get(second.name, {})
        keys = [key for key in mine if key in other]
        if not keys:
            continue
        a, b = [mine[key] for key in keys], [other[key] for key in keys]
        level = np.array([_size(data, i) for i in a])
        allowed = np.sqrt(data.noise[a] ** 2 + data.noise[b] ** 2 + (STEADY * level) ** 2)
        apart = (data.values[a] - data.values[b]) / allowed
        rms = float(np.sqrt(np.mean(apart**2)))
        if rms < CONTRADICTION:
            continue
        worst = keys[int(np.argmax(np.abs(apart)))][0]
        again = data.assembly[i] != data.assembly[j]
        yield DataFinding(
            id="reassembly" if again else "contradicting_points", weight="note" if again else "suspect",
            points=(first.name, second.name), channels=(worst,),
            text=f"{first.name} and {second.name} were run alike but read {rms:.2g} standard deviations apart, "
            f"most of all {worst}; " + ("the rig was put together anew between them" if again else
                            "look at their settings, at drift and at swapped rows"),
        )  # fmt: skip


def _size(data: "Data", row: int) -> float:
    feature = data.features[row]
    value = float(data.values[row])
    if CHANNELS[data.channels[feature.channel].channel.quantity].kind == "temperature":
        return value - ZERO_CELSIUS
    return value


def _alike(
    first: OperatingCondition, second: OperatingCondition, noise: Mapping[tuple[str, str], float]
) -> bool:
    def near(a: float, b: float, key: tuple[str, str]) -> bool:
        return abs(a - b) <= max(
            SAME * math.sqrt(2.0) * noise.get(key, 0.0), SAME_SHARE * max(abs(a), abs(b))
        )

    if not (
        near(first.speed, second.speed, ("speed", "")) and near(first.torque, second.torque, ("torque", ""))
    ):
        return False
    if dict(first.tooth_offset) != dict(second.tooth_offset):
        return False
    return all(
        place in theirs and near(value, theirs[place], (quantity, place))
        for quantity, mine, theirs in (
            ("inlet_temperature", first.inlet_temperature, second.inlet_temperature),
            ("flow", first.flow, second.flow),
        )
        for place, value in mine.items()
    )


def _same_readings(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """Two channels with the same numbers: one signal exported twice."""
    first_with: dict[bytes, str] = {}
    for name, readings in measurement.by_channel.items():
        values = np.concatenate([*readings.values(), np.empty(0)])
        finite = values[np.isfinite(values)]
        if finite.size < 3 or np.ptp(finite) == 0.0:
            continue
        first = first_with.setdefault(np.where(np.isfinite(values), values, np.nan).tobytes(), name)
        if first != name:
            yield DataFinding(
                id="same_readings", weight="suspect", channels=(first, name),
                text=f"{first} and {name}: every reading is the same; one signal was exported twice",
            )  # fmt: skip


def _scatter(measurement: MeasurementSet) -> Iterator[DataFinding]:
    """Repeats that scatter far more than declared."""
    for name, entry in measurement.channels.items():
        squares = freedom = 0.0
        for values in measurement.by_channel[name].values():
            finite = values[np.isfinite(values)]
            if finite.size > 1:
                squares += float(np.sum((finite - np.median(finite)) ** 2))
                freedom += finite.size - 1
        if freedom >= 3 and entry.noise > 0.0 and math.sqrt(squares / freedom) > SCATTER * entry.noise:
            times = math.sqrt(squares / freedom) / entry.noise
            yield DataFinding(
                id="scatter", weight="note", channels=(name,),
                text=f"{name}: repeats scatter {times:.2g} times more than declared; the noise is pooled from both",
            )  # fmt: skip


def _drive(case: Case, data: "Data") -> Iterator[DataFinding]:
    """Motor power against drive torque times speed, where both are measured and the motor turns as the gear counts."""
    names = {entry.channel.quantity: name for name, entry in data.channels.items()}
    if not {"motor_power", "drive_torque"} <= set(names):
        return
    means = _means(data)
    ratios = [
        means[names["motor_power"], s.name] / (means[names["drive_torque"], s.name] * s.speed)
        for s in data.settings
        if (names["motor_power"], s.name) in means
        and means.get((names["drive_torque"], s.name), 0.0) * s.speed != 0.0
    ]
    if ratios and np.ptp(ratios) > METER * abs(float(np.median(ratios))):
        yield DataFinding(
            id="drive_power", weight="suspect", channels=(names["motor_power"], names["drive_torque"]),
            text=f"motor power over drive torque times speed runs from {min(ratios):.3g} to {max(ratios):.3g} over the "
            "operating points and should be one number; look at both zeros",
        )  # fmt: skip


def _heat(case: Case, data: "Data") -> Iterator[DataFinding]:
    """Heat the oil carries away against motor power, where every stream's outlet is measured."""
    outlets = {entry.channel.place: name for name, entry in data.channels.items()
               if entry.channel.quantity == "oil_outlet_temperature"}  # fmt: skip
    power = next((n for n, entry in data.channels.items() if entry.channel.quantity == "motor_power"), None)
    streams = [f"{box}.{oil}" for box in case.gearboxes for oil in ("gear_oil", "bearing_oil")]
    if power is None or any(stream not in outlets for stream in streams):
        return
    means = _means(data)
    wrong: list[tuple[str, float, float]] = []
    for setting in data.settings:
        wanted = [(power, setting.name), *((outlets[stream], setting.name) for stream in streams)]
        if any(key not in means for key in wanted):
            continue
        carried = sum(
            _enthalpy(case, setting, stream, means[outlets[stream], setting.name]) for stream in streams
        )
        given = means[power, setting.name]
        if not (1.0 - METER) * given - _to_room(case, setting) <= carried <= (1.0 + METER) * given:
            wrong.append((setting.name, given, carried))
    if wrong:
        name, given, carried = max(wrong, key=lambda row: abs(row[2] / row[1] - 1.0))
        yield DataFinding(
            id="energy_balance", weight="suspect", points=tuple(row[0] for row in wrong),
            channels=(power, *outlets.values()),
            text=f"{len(wrong)} of {len(data.settings)} operating points do not balance: at {name} the oil carries "
            f"{carried:.4g} W away, the motor gives {given:.4g} W, and the room cannot take the difference; look at "
            "power, flows (per mesh, per bearing), oil temperatures and their units",
        )  # fmt: skip


def _means(data: "Data") -> dict[tuple[str, str], float]:
    return {
        (feature.channel, feature.setting): float(value)
        for feature, value, usable in zip(data.features, data.values, data.usable)
        if usable and feature.order == 0.0
    }


def _enthalpy(case: Case, setting: OperatingCondition, stream: str, outlet: float) -> float:
    """Heat one stream takes up [W]; of an oil of the case's own with properties of a common one."""
    name = OilStreamName.read(stream)
    entry, count = case.gearboxes[name.gearbox].feeds[name.part]
    oil = OILS.get(entry.oil, MIL_PRF_23699)
    inlet = setting.inlet_temperature.get(stream, entry.inlet_temperature)
    flow = count * setting.flow.get(stream, entry.flow)
    return oil.density(inlet) * flow * oil.heat_capacity(0.5 * (inlet + outlet)) * (outlet - inlet)


def _to_room(case: Case, setting: OperatingCondition) -> float:
    """Most heat the housings can give to the room [W]; boundless where no housing is known."""
    areas = [
        sum(area for name, area in exact_areas(housing_geometry(box)).items() if name.startswith(("outer_", "field_")))
        for box in case.gearboxes.values() if box.housing is not None
    ]  # fmt: skip
    if not areas:
        return math.inf
    hottest = max(
        setting.inlet_temperature.get(
            f"{name}.gear_oil", box.gear_oil_temperature or case.ambient.temperature
        )
        for name, box in case.gearboxes.items()
    )
    above = hottest - (setting.ambient_temperature or case.ambient.temperature)
    return ROOM_FILM * max(areas) * len(case.gearboxes) * max(above, 0.0)

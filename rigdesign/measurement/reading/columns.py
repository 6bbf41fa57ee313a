"""What measurement.toml says of columns and points, held against the rig: places, units, uncertainties."""

import math
from collections.abc import Iterator, Mapping

from rigdesign.base import units
from rigdesign.base.errors import Fault
from rigdesign.base.units import KINDS
from rigdesign.case.faults import unknown, written
from rigdesign.measurement.places import MOTOR, Places
from rigdesign.measurement.quantities import (
    CHANNELS,
    LEAST_UNCERTAINTY,
    SETTINGS,
    Measured,
    accepted_unit,
    unit_problem,
)
from rigdesign.measurement.reading.measurement_set import (
    ChannelTable,
    MeasuredChannel,
    MeasurementFile,
    SettingColumn,
    SettingSensor,
)
from rigdesign.prediction.model import (
    LATERAL_QUANTITIES,
    MODAL_QUANTITIES,
    ORDER_QUANTITIES,
    ROOT_WINDOWS,
    WITHOUT_MEAN,
    Channel,
)

PLACED_SETTINGS = frozenset(("inlet_temperature", "flow"))
NEEDED = ("speed", "torque")
"""Settings without which an operating point is not known."""


def column_faults(document: MeasurementFile, places: Places) -> list[Fault]:
    """Everything wrong with settings, channels and points."""
    faults = [
        Fault(
            "settings", "", f"no column for {quantity}",
            f'add [settings.{quantity}] with quantity = "{quantity}", unit and uncertainty',
        )
        for quantity in NEEDED
        if quantity not in {entry.quantity for entry in document.settings.values()}
    ]  # fmt: skip
    faults += [fault for name, entry in document.settings.items() for fault in _setting(name, entry, places)]
    faults += _said_twice(document)
    faults += [fault for name, entry in document.channels.items() for fault in _channel(name, entry, places)]
    faults += [
        Fault(f"channels.{name}", "", "is the name of a setting, too", "give each column its own name")
        for name in document.channels if name in document.settings
    ]  # fmt: skip
    for point, entry in document.points.items():
        faults += [
            unknown(f"points.{point}.tooth_offset", mesh, places.meshes, "mesh")
            for mesh in entry.tooth_offset if mesh not in places.meshes
        ]  # fmt: skip
    return faults


def channels_of(document: MeasurementFile, places: Places) -> dict[str, MeasuredChannel]:
    """The sensors in SI; the document must be free of faults."""
    channels = {}
    for name, entry in document.channels.items():
        measured = CHANNELS[entry.quantity]
        orders = _orders(entry, places)
        channels[name] = MeasuredChannel(
            channel=Channel(
                name=name,
                quantity=entry.quantity,
                place="" if entry.place == MOTOR else entry.place,
                at=entry.at,
                orders=orders,
                direction=None if entry.direction is None else direction_of(entry.direction),
                position=entry.position,
                torque=entry.torque,
                windows=entry.windows or ROOT_WINDOWS,
                face=places.face_position(entry.place) if entry.quantity == "root_strain" else 0.0,
            ),
            unit=_spelled(entry.unit, measured),
            noise=units.parse(entry.uncertainty, measured.spread),
            offset_sd=_sd(entry.offset_uncertainty, measured),
            scale_sd=entry.scale_uncertainty,
            calibrated=entry.calibrated,
            transfer=entry.transfer,
            signal=entry.signal or name,
            search_range=_search_range(entry, measured),
        )
    return channels


def sensors_of(document: MeasurementFile) -> dict[str, SettingSensor]:
    """The setting columns in SI; the document must be free of faults."""
    return {
        name: SettingSensor(
            name=name,
            quantity=entry.quantity,
            place=entry.place,
            unit=_spelled(entry.unit, SETTINGS[entry.quantity]),
            noise=units.parse(entry.uncertainty, SETTINGS[entry.quantity].spread),
            offset_sd=SETTINGS[entry.quantity].offset
            if entry.offset_uncertainty is None
            else units.parse(entry.offset_uncertainty, SETTINGS[entry.quantity].spread),
            scale_sd=SETTINGS[entry.quantity].scale
            if entry.scale_uncertainty is None
            else entry.scale_uncertainty,
        )
        for name, entry in document.settings.items()
    }


def _search_range(entry: ChannelTable, measured: Measured) -> tuple[float, float] | None:
    if entry.search_range is None:
        return None
    low, high = (units.parse(text, measured.kind) for text in entry.search_range)
    return low, high


def _orders(entry: ChannelTable, places: Places) -> tuple[float, ...]:
    if entry.quantity == "resonance_speed":
        return tuple(places.snapped(order) for order in entry.orders or ())
    if entry.quantity not in ORDER_QUANTITIES:
        return ()
    chosen = places.orders
    if entry.orders is not None:
        chosen = tuple(sorted({places.snapped(order) for order in entry.orders}))
    return tuple(order for order in chosen if order > 0.0) if entry.quantity in WITHOUT_MEAN else chosen


def _spelled(unit: str, measured: Measured) -> str:
    spelled = accepted_unit(unit, measured.kind)
    assert spelled is not None
    return spelled


def _sd(text: str | None, measured: Measured) -> float:
    return 0.0 if text is None else units.parse(text, measured.spread)


def _setting(name: str, entry: SettingColumn, places: Places) -> Iterator[Fault]:
    table = f"settings.{name}"
    spreads = {"uncertainty": entry.uncertainty}
    if entry.offset_uncertainty is not None:
        spreads["offset_uncertainty"] = entry.offset_uncertainty
    yield from _unit_and_spread(table, entry.unit, spreads, SETTINGS[entry.quantity])
    if entry.quantity in PLACED_SETTINGS:
        if entry.place not in places.streams:
            yield unknown(f"{table}.place", entry.place, places.streams, "oil stream")
    elif entry.place:
        yield Fault(
            f"{table}.place", written(entry.place), f"{entry.quantity} has no place", "remove the key"
        )


def _said_twice(document: MeasurementFile) -> Iterator[Fault]:
    seen: dict[tuple[str, str], str] = {}
    for name, entry in document.settings.items():
        other = seen.setdefault((entry.quantity, entry.place), name)
        if other != name:
            quantity = f"{entry.quantity} {entry.place}".strip()
            yield Fault(
                f"settings.{name}", "", f"{other} says {quantity} already",
                "keep one of them; a second sensor may become a note of its own",
            )  # fmt: skip


def _channel(name: str, entry: ChannelTable, places: Places) -> Iterator[Fault]:
    table = f"channels.{name}"
    spreads = {"uncertainty": entry.uncertainty, "offset_uncertainty": entry.offset_uncertainty}
    given = {key: text for key, text in spreads.items() if text is not None}
    yield from _unit_and_spread(table, entry.unit, given, CHANNELS[entry.quantity])
    yield from _place(f"{table}.place", entry, places)
    yield from direction_faults(table, entry, places)
    yield from modal_faults(table, entry)
    if entry.quantity not in ORDER_QUANTITIES | {"resonance_speed"} and entry.orders is not None:
        yield Fault(
            f"{table}.orders", "", f"{entry.quantity} is read as one number, not by orders", "remove the key"
        )
    if entry.orders is not None and not entry.orders:
        yield Fault(f"{table}.orders", "[]", "no order is named", "name some or leave the key out")
    yield from _windows(table, entry)
    if entry.quantity in WITHOUT_MEAN and entry.orders == (0.0,):
        said = entry.quantity.replace("_", " ")
        yield Fault(f"{table}.orders", "[0]", f"the mean of {an(said)} says nothing", "name orders above 0")


def _windows(table: str, entry: ChannelTable) -> Iterator[Fault]:
    """Keys that root gauges alone have, or have not."""
    gauge = entry.quantity == "root_strain"
    if entry.windows is not None and not gauge:
        yield Fault(f"{table}.windows", "", f"{entry.quantity} has no windows", "remove the key")
    if entry.windows is not None and len(set(entry.windows)) < max(1, len(entry.windows)):
        yield Fault(
            f"{table}.windows", ", ".join(entry.windows), "must be different ones, one at least",
            f"choose of {', '.join(ROOT_WINDOWS)}, or leave the key out",
        )  # fmt: skip
    if gauge and entry.transfer is not None:
        yield Fault(
            f"{table}.transfer", "", "a curve cannot be corrected for it",
            f"write response_time of the gauge {entry.place} in the case: the prediction then has the low-pass",
        )  # fmt: skip


def _place(key: str, entry: ChannelTable, places: Places) -> Iterator[Fault]:
    known = places.of(entry.quantity)
    role = f"place of a channel of {entry.quantity.replace('_', ' ')}"
    if entry.at is not None and entry.quantity not in ("temperature", "seal_gap"):
        yield Fault(
            f"{key.removesuffix('.place')}.at", "", f"{entry.quantity} has no coordinates", "remove the key"
        )
    if entry.quantity == "temperature" and entry.at is not None:
        if entry.place not in places.housings:
            yield unknown(key, entry.place, places.housings, "gearbox with a housing")
        return
    if entry.quantity == "temperature" and entry.place in places.housings:
        yield Fault(
            key, written(entry.place), "a gearbox alone is no place of a temperature",
            f'add coordinates, at = ["0.1 m", "0 m", "0.2 m"], or a surface such as "{known[0]}"',
        )  # fmt: skip
        return
    if entry.quantity in MODAL_QUANTITIES and known:
        if not places.is_mode(entry.place):
            yield Fault(
                key, written(entry.place), "neither the number of a torsional natural frequency nor the name of a mode",
                f'write "1", "2", … or a name such as "lateral {places.of("angle")[0]} 1"',
            )  # fmt: skip
        return
    if known == (MOTOR,) and entry.place in ("", MOTOR):
        return
    if entry.quantity == "temperature" and places.from_file(entry.place.partition(".")[0]):
        return
    if entry.place not in known:
        yield unknown(key, entry.place, known, role)


def _unit_and_spread(
    table: str, unit: str, spreads: Mapping[str, str], measured: Measured
) -> Iterator[Fault]:
    if accepted_unit(unit, measured.kind) is None:
        choices = ", ".join(KINDS[measured.kind].units)
        yield Fault(
            f"{table}.unit", written(unit), unit_problem(unit, measured.kind), f"write one of {choices}"
        )
    for key, text in spreads.items():
        try:
            value = units.parse(text, measured.spread)
        except units.QuantityError as error:
            yield Fault(f"{table}.{key}", written(text), error.problem, error.remedy)
            continue
        span = measured.limits[1] - measured.limits[0]
        problem = ""
        if value < 0.0:
            problem = "is below zero"
        elif value > span:
            problem = f"is more than the quantity can be, {units.show(span, measured.spread, digits=3)}"
        elif 0.0 < value < LEAST_UNCERTAINTY * span:
            problem = "is smaller than that of any instrument"
        if problem:
            yield Fault(f"{table}.{key}", written(text), problem, f'write e.g. "{measured.uncertainty}"')


# Keys of channels that only some quantities have: direction and position, order and torque, a range to search.


def an(words: str) -> str:
    """The words with their article."""
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"


def direction_faults(table: str, entry: ChannelTable, places: Places) -> Iterator[Fault]:
    """Direction of lateral channels, position of those on a shaft."""
    said = entry.quantity.replace("_", " ")
    lateral = entry.quantity in LATERAL_QUANTITIES
    if lateral and entry.direction is None:
        yield Fault(f"{table}.direction", "", f"{an(said)} has a direction", REMEDY)
    elif entry.direction is not None and not lateral:
        yield Fault(
            f"{table}.direction", written(entry.direction), f"{said} has no direction", "remove the key"
        )
    elif entry.direction is not None:
        try:
            direction_of(entry.direction)
        except units.QuantityError as error:
            yield Fault(f"{table}.direction", written(entry.direction), error.problem, REMEDY)
    on_shaft = entry.quantity == "shaft_displacement" and entry.place in places.shafts
    if on_shaft and entry.position is None:
        yield Fault(
            f"{table}.position", "", "a probe on a shaft stands at a distance from its start",
            'write position = "50 mm", or name the bearing it sits in as its place',
        )  # fmt: skip
    elif on_shaft and entry.position is not None and entry.position > places.length(entry.place):
        yield Fault(
            f"{table}.position", units.show(entry.position, "length"), f"is beyond the end of {entry.place}",
            f"write at most {units.show(places.length(entry.place), 'length')}",
        )  # fmt: skip
    elif entry.position is not None and not on_shaft:
        yield Fault(
            f"{table}.position", units.show(entry.position, "length"), "is of a shaft displacement on a shaft",
            "remove the key, or name a shaft as its place",
        )  # fmt: skip


def modal_faults(table: str, entry: ChannelTable) -> Iterator[Fault]:
    """Order and torque of a resonance speed, and the range in which a mode is looked for."""
    said = entry.quantity.replace("_", " ")
    if entry.quantity == "resonance_speed":
        if entry.orders is None or len(entry.orders) != 1 or not entry.orders[0] > 0.0:
            given = "" if entry.orders is None else str(list(entry.orders))
            yield Fault(
                f"{table}.orders", given, "a resonance speed is where one order meets a mode",
                "write the order that was tracked, above 0, e.g. orders = [28]",
            )  # fmt: skip
        if entry.torque is None:
            yield Fault(
                f"{table}.torque", "", "teeth are as stiff as the torque of the sweep presses them together",
                'write the bracing torque of its sweeps, e.g. torque = "180 N m"',
            )  # fmt: skip
    elif entry.torque is not None:
        yield Fault(f"{table}.torque", units.show(entry.torque, "torque"), f"{said} has no torque of its own",
                    "remove the key; operating points state theirs")  # fmt: skip
    if entry.search_range is None:
        return
    if entry.quantity not in MODAL_QUANTITIES:
        yield Fault(f"{table}.search_range", "", f"{said} is not looked for", "remove the key")
        return
    try:
        low, high = (units.parse(text, CHANNELS[entry.quantity].kind) for text in entry.search_range)
    except units.QuantityError as error:
        yield Fault(
            f"{table}.search_range", written(", ".join(entry.search_range)), error.problem, error.remedy
        )
        return
    if not 0.0 <= low < high:
        yield Fault(
            f"{table}.search_range", written(", ".join(entry.search_range)), "does not ascend",
            "write the least reading, then the greatest",
        )  # fmt: skip


# Directions of accelerometers and proximity probes: an axis of the case, or an angle across the shafts.

Direction = tuple[float, float, float]
"""Unit vector (x, y, z): x along the shafts, y across, z up."""

AXES: dict[str, Direction] = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
    "-x": (-1.0, 0.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "-z": (0.0, 0.0, -1.0),
}
REMEDY = 'write "y", "z", "x", one of them with a minus, or an angle from y towards z such as "45 deg"'


def direction_of(text: str) -> Direction:
    """The direction that a text spells; `rigdesign.base.units.QuantityError` where it spells none."""
    known = AXES.get(text.strip())
    if known is not None:
        return known
    angle = units.parse(text, "angle")
    return 0.0, math.cos(angle), math.sin(angle)


def direction_text(direction: Direction) -> str:
    """The text that spells a direction."""
    for name, axis in AXES.items():
        if axis == direction:
            return name
    return f"{math.degrees(math.atan2(direction[2], direction[1])):.10g} deg"

"""The start of a measurement set: measurement.toml with the channels a case offers, and an empty data.csv."""

import math
from pathlib import Path

from rigdesign.base import units
from rigdesign.base.errors import OutputError
from rigdesign.base.output_folder import staged
from rigdesign.case import Case
from rigdesign.measurement.loader import FILE
from rigdesign.measurement.places import Places
from rigdesign.measurement.quantities import CHANNELS, SETTINGS, Measured

TABLE = "data.csv"
SPREADS = {
    "temperature": ('offset_uncertainty = "0.5 K"', "scale_uncertainty = 0.01"),
    "oil_outlet_temperature": ('offset_uncertainty = "0.3 K"',),
    "motor_power": ("scale_uncertainty = 0.01",),
    "drive_torque": ('offset_uncertainty = "0.02 N m"', "scale_uncertainty = 0.005"),
    "torque": ('offset_uncertainty = "0.2 N m"', "scale_uncertainty = 0.005"),
}
"""Systematic uncertainties that are usual for a quantity."""
HEAD = """\
# Measurement set of the rig "{name}": {title}.
#
# Remove what you did not measure, correct names, units and uncertainties, fill in {table}: the first row names
# the columns, the second holds their units, then one row per operating point and repeat. An empty cell is a
# missing reading. Uncertainties are one standard deviation. Repeat every point at least twice.

schema_version = 1
title = "describe rig, state and date"
case = "{name}"
# baseline = "../set_0"                  # healthy set of the same rig: finds changes several times smaller

[data]
table = "{table}"
delimiter = ","                          # ";" with decimal = "," for files of a German spreadsheet
decimal = "."
# orders = "orders.csv"                  # complex orders: point,repeat,channel,order,real,imaginary
# tach = {{ kind = "pulses", signal = "Tach" }}    # of recordings: one pulse a turn of {gear}
# time_unit = "ms"                       # of recordings whose files have no unit of time; seconds when left out
# costs = {{ temperature = 150, torque = 6000, operating_point = 400 }}   # of one more, to choose the next measurement
# [[data.recordings]]                    # raw time data of a point: .tdms, .h5, .mf4 or .csv
# point = "P01"
# repeat = 1
# file = "P01_1.tdms"
# [[data.sweeps]]                        # run-up or run-down under one torque: resonance speeds, orders at speeds
# file = "run_up.tdms"
# direction = "up"
# torque = "{torque}"
# speeds = ["1000 rpm", "2000 rpm"]      # each an operating point of its own; none when left out
# [[data.impacts]]                       # hammer blows on the rig at rest: natural frequencies
# file = "blows.tdms"
# force = "Hammer"
"""
MOVING = """\
# Vibration: the shafts of the model bend as soon as one of these is there. Directions: "y" across, "z" up, or an angle.
# [channels.a_1]
# quantity = "acceleration"
# place = "{bearing}"
# direction = "z"
# unit = "m/s2"                          # or g
# uncertainty = "0.02 m/s2"
# [channels.s_1]
# quantity = "shaft_displacement"        # in a bearing against its seat; or place = "{shaft}" with a position
# place = "{bearing}"
# direction = "45 deg"
# unit = "um"
# uncertainty = "0.1 um"
# Resonances: read from sweeps and blows by their signal, or as numbers in a row whose point is standstill.
# [channels.n_1]
# quantity = "resonance_speed"
# place = "1"                            # torsional mode by number
# orders = [{order}]                       # the order that meets it
# torque = "{torque}"                    # of the sweeps
# signal = "M_1"
# search_range = ["500 rpm", "3000 rpm"]
# unit = "rpm"
# uncertainty = "10 rpm"
# [channels.f_1]
# quantity = "natural_frequency"
# place = "1"
# signal = "Accelerometer"
# search_range = ["200 Hz", "600 Hz"]
# unit = "Hz"
# uncertainty = "0.5 Hz"
"""
POINTS = """\
# What is special about a point; those without an entry were steady and not put together anew.
# [points.P02]
# steady = false
# reassembled = true
# tooth_offset = {{ "{mesh}" = 1 }}       # the wheel put on by one tooth further
"""


def write_template(case: Case, out: Path) -> tuple[Path, ...]:
    """Write measurement.toml and data.csv to ``out``.

    Raises
    ------
    OutputError
        The folder cannot be written, or holds one of the files already.
    """
    paths = (out / FILE, out / TABLE)
    for path in paths:
        if path.exists():
            raise OutputError(f"{path} is there already; remove it or give another folder with --out")
    with staged(out) as scratch:
        for name, text in zip((FILE, TABLE), template_texts(case)):
            (scratch / name).write_text(text, encoding="utf-8", newline="\n")
    return paths


def template_texts(case: Case) -> tuple[str, str]:
    """measurement.toml and data.csv for a case."""
    places = Places(case)
    settings, channels = _setting_columns(places), _channel_columns(places)
    torque = units.show(case.schedule.test_torque, "torque")
    head = HEAD.format(
        name=case.name, title=case.title, table=TABLE, gear=places.counting_gear, torque=torque
    )
    blocks = [head, POINTS.format(mesh=places.meshes[0])]
    blocks.append(
        f"# Speed and torque count at {places.counting_gear}; flows as in the case: per mesh, per bearing.\n"
    )
    for name, (quantity, place) in settings.items():
        blocks.append(_table(f"settings.{name}", quantity, place, SETTINGS[quantity], ()))
    blocks.append(_offer(places))
    for name, (quantity, place) in channels.items():
        measured = CHANNELS[quantity]
        extra = SPREADS.get(quantity, ())
        if quantity in ("torque", "angle"):
            shown = ", ".join(f"{order:g}" for order in places.orders[:6])
            extra = (
                *extra,
                f"# orders = [{shown}, …]   # per turn of {places.counting_gear}; by tooth numbers when left out",
            )
        blocks.append(_table(f"channels.{name}", quantity, place, measured, extra))
    if places.bearings:
        first = next(iter(places.mesh_orders.values()))
        blocks.append(
            MOVING.format(
                bearing=places.bearings[0], shaft=places.shafts[0], order=f"{float(first):g}", torque=torque
            )
        )
    return "\n".join(blocks), _data(case, settings, channels)


def _table(path: str, quantity: str, place: str, measured: Measured, extra: tuple[str, ...]) -> str:
    """Table of a setting or channel at ``path``; ``extra``: lines after the usual ones."""
    lines = [f"[{path}]", f'quantity = "{quantity}"']
    lines += [f'place = "{place}"'] if place else []
    usual = (f'unit = "{measured.unit}"', f'uncertainty = "{measured.uncertainty}"')
    return "\n".join([*lines, *usual, *extra, ""])


def _setting_columns(places: Places) -> dict[str, tuple[str, str]]:
    columns = {"speed": ("speed", ""), "torque": ("torque", "")}
    for stream in places.streams:
        columns[f"T_in_{_flat(stream)}"] = ("inlet_temperature", stream)
    for stream in places.streams:
        columns[f"Q_{_flat(stream)}"] = ("flow", stream)
    return columns | {"T_room": ("ambient_temperature", "")}


def _channel_columns(places: Places) -> dict[str, tuple[str, str]]:
    columns: dict[str, tuple[str, str]] = {}
    for surface in places.surfaces:
        part = surface.partition(".")[2]
        if part.startswith(("outer_", "bearing_bore_", "gear_")) and "side" not in part and "rim" not in part:
            columns[f"T_{_flat(surface)}"] = ("temperature", surface)
    for stream in places.streams:
        columns[f"T_out_{_flat(stream)}"] = ("oil_outlet_temperature", stream)
    prefixes = {"motor_power": "P_motor", "drive_torque": "M_motor"}
    columns |= {name: (quantity, "") for quantity, name in prefixes.items() if places.of(quantity)}
    columns |= {f"M_{place}": ("torque", place) for place in places.of("torque")}
    columns |= {f"phi_{place}": ("angle", place) for place in places.of("angle")[:1]}
    columns |= {f"f_{place}": ("natural_frequency", place) for place in places.of("natural_frequency")}
    columns |= {f"backlash_{_flat(place)}": ("backlash", place) for place in places.of("backlash")}
    return columns | {f"gap_{_flat(place)}": ("seal_gap", place) for place in places.of("seal_gap")[:1]}


def _offer(places: Places) -> str:
    lines = ["# Channels. Places this rig offers, besides those below:"]
    for quantity in ("temperature", "angle", "seal_gap", "acceleration"):
        offered = places.of(quantity)
        if offered:
            lines.append(f"#   {quantity}:")
            lines += [f"#     {line}" for line in _wrapped(offered)]
    if places.housings:
        box = places.housings[0]
        lines.append(
            f'#   temperature at a point of a housing: place = "{box}", at = ["0.12 m", "0 m", "0.28 m"]'
        )
    return "\n".join([*lines, ""])


def _wrapped(names: tuple[str, ...]) -> list[str]:
    from textwrap import wrap

    return wrap(", ".join(names), 105, break_long_words=False, break_on_hyphens=False)


def _data(case: Case, settings: dict[str, tuple[str, str]], channels: dict[str, tuple[str, str]]) -> str:
    """Names, units, and one row with the test point of the case; readings are empty."""
    values = {
        "speed": units.display(case.schedule.test_speed, "speed"),
        "torque": case.schedule.test_torque,
    }
    units_row = [SETTINGS[q].unit for q, _ in settings.values()] + [
        CHANNELS[q].unit for q, _ in channels.values()
    ]
    first = [
        f"{values[q]:g}" if q in values and math.isfinite(values[q]) else "" for q, _ in settings.values()
    ]
    rows = [
        ["point", "repeat", *settings, *channels],
        ["", "", *units_row],
        ["P01", "1", *first, *[""] * len(channels)],
    ]
    return "\n".join(",".join(row) for row in rows) + "\n"


def _flat(place: str) -> str:
    return place.replace(".", "_")

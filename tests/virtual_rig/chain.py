"""Measurement chain: what sensors, loggers and a drifting rig make of the truth, and the files of a set.

Kept over a set (and the healthy set of the same rig): offsets, scales, fin errors, flow-meter and power scale, torque
zero, angle of the tach. New at every repeat: noise, drift, jitter of the tach, quantisation.
"""

import copy
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.virtual_rig.generate_plans import SETTING_NOISE, SETTING_OFFSET, STREAMS, Sensor, TruePoint
from tests.virtual_rig.generate_truth import Reading

TACH_JITTER = 2e-4
"""Angle of the tach from average to average, 1 sigma [rad]."""
TACH_ZERO = 1.5e-3
"""Healthy error of the angle zero, 1 sigma [rad]."""
UNITS = {
    "temperature": ("degC", 1.0, -273.15, 0.01), "oil_outlet_temperature": ("degC", 1.0, -273.15, 0.01),
    "motor_power": ("W", 1.0, 0.0, 0.5), "drive_torque": ("N m", 1.0, 0.0, 1e-3), "torque": ("N m", 1.0, 0.0, 1e-3),
    "angle": ("mrad", 1e3, 0.0, 1e-4), "natural_frequency": ("Hz", 1.0, 0.0, 0.5), "backlash": ("um", 1e6, 0.0, 1.0),
    "speed": ("rpm", 30.0 / math.pi, 0.0, 0.1), "inlet_temperature": ("degC", 1.0, -273.15, 0.01),
    "flow": ("l/min", 6e4, 0.0, 0.001), "ambient_temperature": ("degC", 1.0, -273.15, 0.1),
}  # fmt: skip
"""Unit in the files, factor, addend, step of the logger in that unit."""


@dataclass
class Chain:
    """The errors of one measuring system. Drawn once a rig; input errors are put in afterwards."""

    offset: dict[str, float]
    scale: dict[str, float]
    inlet: dict[str, float]
    flow: dict[str, float]
    room: float
    lock: float
    angle: float
    unit: dict[str, tuple[float, float]] = field(default_factory=dict)
    """Channel written as value times factor plus addend although its unit says otherwise."""
    swapped_channels: list[tuple[str, str]] = field(default_factory=list)
    swapped_points: list[tuple[str, str]] = field(default_factory=list)
    lag: dict[str, float] = field(default_factory=dict)
    """Out of catalogue: time constant of a cell nobody stated [s]."""
    wobble: dict[str, complex] = field(default_factory=dict)
    """Out of catalogue: encoder off centre, angle at order 1 of its shaft [rad]."""
    rattle: float = 0.0
    """Out of catalogue: share by which broadband noise of torque and angle grows at low torque."""


def draw_chain(
    sensors: Sequence[Sensor],
    rng: np.random.Generator,
    inlets: Sequence[str] = STREAMS,
    flows: Sequence[str] = STREAMS,
) -> Chain:
    """A healthy measuring system; inlets, flows : oil streams whose temperature and flow are read."""
    return Chain(
        offset={s.name: s.offset * rng.standard_normal() for s in sensors},
        scale={s.name: s.scale * rng.standard_normal() for s in sensors},
        inlet={stream: SETTING_OFFSET["inlet_temperature"] * rng.standard_normal() for stream in inlets},
        flow={stream: SETTING_OFFSET["flow"] * rng.standard_normal() for stream in flows},
        room=SETTING_OFFSET["ambient_temperature"] * rng.standard_normal(),
        lock=SETTING_OFFSET["torque"] * rng.standard_normal(),
        angle=TACH_ZERO * rng.standard_normal(),
    )


DRIFT = 0.3
"""Of what a sensor or setting has wrong the part that is another one on another day."""
SEAT = 0.15
"""Of a thermocouple that was taken out and put back [K], 1 sigma."""


def another_day(
    chain: Chain, sensors: Sequence[Sensor], rng: np.random.Generator, times: float = 1.0
) -> Chain:
    """The measuring system at a later set of the rig; times : on all of its drift."""
    found = copy.deepcopy(chain)
    for s in sensors:
        thermocouple = s.quantity == "temperature"
        shift = math.hypot(DRIFT * s.offset, SEAT if thermocouple else 0.0)
        found.offset[s.name] += times * shift * rng.standard_normal()
        found.scale[s.name] += times * (0.0 if thermocouple else DRIFT * s.scale) * rng.standard_normal()
    for settings, quantity in ((found.inlet, "inlet_temperature"), (found.flow, "flow")):
        for stream in settings:
            settings[stream] += times * DRIFT * SETTING_OFFSET[quantity] * rng.standard_normal()
    found.room += times * DRIFT * SETTING_OFFSET["ambient_temperature"] * rng.standard_normal()
    found.lock += times * DRIFT * SETTING_OFFSET["torque"] * rng.standard_normal()
    return found


def put_on(chain: Chain, sensors: Sequence[Sensor], rng: np.random.Generator) -> None:
    """Sensors that are added to a measuring system, with errors of their own."""
    for sensor in sensors:
        chain.offset[sensor.name] = sensor.offset * rng.standard_normal()
        chain.scale[sensor.name] = sensor.scale * rng.standard_normal()


def put_in(chain: Chain, effects: Sequence[Mapping[str, Any]]) -> None:
    """Hidden errors of sensors and inputs, by their names in the catalogue; others pass through."""
    for effect in effects:
        kind, _, place = effect["effect"].partition(":")
        size = effect.get("size", 0.0)
        match kind:
            case "sensor_offset" | "torque_zero":
                chain.offset[place] += size
            case "sensor_scale":
                chain.scale[place] += size
            case "flow_scale":
                chain.flow[place] += size
            case "inlet_offset":
                chain.inlet[place] += size
            case "angle_zero":
                chain.angle += size
            case "unit":
                chain.unit[place] = (effect["factor"], effect["addend"])
            case "swapped_channels":
                chain.swapped_channels.append(tuple(place.split(",")))
            case "swapped_points":
                chain.swapped_points.append(tuple(place.split(",")))
            case "x_cell_lag":
                chain.lag[place] = size
            case "x_encoder_wobble":
                chain.wobble[place] = size * complex(math.cos(effect["phase"]), math.sin(effect["phase"]))
            case "x_rattle":
                chain.rattle += size


def systematic(
    chain: Chain,
    sensors: Sequence[Sensor],
    rows: Sequence[Reading],
    points: Sequence[TruePoint],
    truth: np.ndarray,
) -> np.ndarray:
    """Readings without noise: truth with offsets, scales, fins, the tach's zero and hidden channel errors [SI]."""
    by_name = {s.name: s for s in sensors}
    by_point = {p.name: p for p in points}
    values = truth.copy()
    for i, row in enumerate(rows):
        sensor = by_name[row.channel]
        scale, offset = chain.scale[sensor.name], chain.offset[sensor.name]
        if sensor.quantity == "temperature":
            values[i] += offset - scale * (values[i] - by_point[row.point].room)
        elif not row.order:
            values[i] = values[i] * (1.0 + scale) + offset
        elif row.part == "real":
            whole = complex(values[i], values[i + 1]) * (1.0 + scale)
            whole *= np.exp(-1j * row.order * chain.angle)
            if sensor.name in chain.lag:
                whole /= 1.0 + 1j * row.order * by_point[row.point].speed * chain.lag[sensor.name]
            if row.order == 1.0:
                whole += chain.wobble.get(sensor.name, 0.0)
            values[i], values[i + 1] = whole.real, whole.imag
    return values


def repeats(
    chain: Chain,
    sensors: Sequence[Sensor],
    rows: Sequence[Reading],
    points: Sequence[TruePoint],
    truth: np.ndarray,
    counts: Mapping[str, int],
    rng: np.random.Generator,
) -> dict[tuple[str, int], dict[Reading, float]]:
    """Readings [SI] by point (empty at standstill) and repeat."""
    by_name = {s.name: s for s in sensors}
    by_point = {p.name: p for p in points}
    clean = systematic(chain, sensors, rows, points, truth)
    found: dict[tuple[str, int], dict[Reading, float]] = {}
    for point, count in counts.items():
        members = [i for i, row in enumerate(rows) if row.point == point]
        drift = rng.standard_normal() if point else 0.0
        for repeat in range(1, count + 1):
            late = drift * (repeat - 0.5 * (count + 1))
            jitter = TACH_JITTER * rng.standard_normal()
            numbers: dict[Reading, float] = {}
            for i in members:
                row = rows[i]
                sensor = by_name[row.channel]
                noise = sensor.noise
                if sensor.orders and point:
                    noise *= 1.0 + chain.rattle * 50.0 / by_point[point].torque
                value = clean[i]
                if row.order:
                    other = i + 1 if row.part == "real" else i - 1
                    turned = row.order * jitter * (clean[other] if row.part == "real" else -clean[other])
                    value = clean[i] * math.exp(-0.5 * (row.order * TACH_JITTER) ** 2) + turned
                elif sensor.quantity in ("temperature", "oil_outlet_temperature"):
                    value += 0.05 * late
                value += noise * rng.standard_normal()
                numbers[row] = _stepped(value, sensor.quantity)
            found[point, repeat] = numbers
    return found


def _stepped(value: float, quantity: str) -> float:
    _, factor, addend, step = UNITS[quantity]
    return (round((value * factor + addend) / step) * step - addend) / factor


# ---------------------------------------------------------------------------- files


def write_set(
    folder: Path,
    case: str,
    chain: Chain,
    sensors: Sequence[Sensor],
    points: Sequence[TruePoint],
    readings: Mapping[tuple[str, int], Mapping[Reading, float]],
    rng: np.random.Generator,
    *,
    title: str,
    baseline: str | None = None,
) -> None:
    """measurement.toml, data.csv and orders.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    settings = _settings(sensors, points)
    rename = {a: b for pair in chain.swapped_channels for a, b in (pair, pair[::-1])}
    moved = {a: b for pair in chain.swapped_points for a, b in (pair, pair[::-1])}
    (folder / "measurement.toml").write_text(
        _document(case, title, baseline, sensors, settings, points), encoding="utf-8"
    )
    scalars = [s for s in sensors if not s.orders]
    lines = [",".join(["point", "repeat", *settings, *(s.name for s in scalars)])]
    lines.append(
        ",".join(
            ["", "", *(UNITS[q][0] for q, _ in settings.values()), *(UNITS[s.quantity][0] for s in scalars)]
        )
    )
    orders = ["point,repeat,channel,order,real,imaginary"]
    by_point = {p.name: p for p in points}
    for (point, repeat), own in readings.items():
        shown = readings.get((moved[point], repeat), own) if point in moved else own
        cells = [point or "standstill", str(repeat)]
        for quantity, stream in settings.values():
            cells.append(
                "" if not point else _number(_read(chain, by_point[point], quantity, stream, rng), quantity)
            )
        numbers = {(row.channel, row.order, row.part): value for row, value in shown.items()}
        for sensor in scalars:
            value = numbers.get((rename.get(sensor.name, sensor.name), 0.0, "value"))
            cells.append(
                "" if value is None else _number(value, sensor.quantity, chain.unit.get(sensor.name))
            )
        lines.append(",".join(cells))
        for sensor in sensors:
            source = rename.get(sensor.name, sensor.name)
            factor = chain.unit.get(sensor.name)
            for order in sensor.orders if point else ():
                if order == 0.0:
                    pair = numbers[source, 0.0, "value"], 0.0
                else:
                    pair = numbers[source, order, "real"], numbers[source, order, "imaginary"]
                text = ",".join(_number(value, sensor.quantity, factor) for value in pair)
                orders.append(f"{point},{repeat},{sensor.name},{order:g},{text}")
    (folder / "data.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    if len(orders) > 1:
        (folder / "orders.csv").write_text("\n".join(orders) + "\n", encoding="utf-8")


def _settings(sensors: Sequence[Sensor], points: Sequence[TruePoint]) -> dict[str, tuple[str, str]]:
    found = {"n": ("speed", ""), "T_brace": ("torque", "")}
    for stream in points[0].inlet:
        found[f"T_{stream.replace('.', '_')}_in"] = ("inlet_temperature", stream)
        if stream in points[0].flow:
            found[f"Q_{stream.replace('.', '_')}"] = ("flow", stream)
    found["T_room"] = ("ambient_temperature", "")
    return found


def _read(chain: Chain, point: TruePoint, quantity: str, stream: str, rng: np.random.Generator) -> float:
    """One reading of a setting [SI]; the bracing torque is the one asked for, the true one differs."""
    noise = SETTING_NOISE[quantity] * rng.standard_normal()
    match quantity:
        case "speed":
            return point.speed + noise
        case "torque":
            return point.torque * (1.0 + chain.lock) + noise
        case "inlet_temperature":
            return point.inlet[stream] + chain.inlet[stream] + noise
        case "flow":
            return point.flow[stream] * (1.0 + chain.flow[stream] + noise)
    return point.room + chain.room + noise


def _number(value: float, quantity: str, wrong: tuple[float, float] | None = None) -> str:
    unit = UNITS.get(quantity, ("N m", 1.0, 0.0, 1e-3))
    shown = value * unit[1] + unit[2]
    if wrong is not None:
        shown = shown * wrong[0] + wrong[1]
    return f"{shown:.7g}"


def _document(
    case: str,
    title: str,
    baseline: str | None,
    sensors: Sequence[Sensor],
    settings: Mapping[str, tuple[str, str]],
    points: Sequence[TruePoint],
) -> str:
    lines = ["schema_version = 1", f"title = {json.dumps(title)}", f"case = {json.dumps(case)}"]
    if baseline is not None:
        lines.append(f"baseline = {json.dumps(baseline)}")
    lines += ["", "[data]", 'table = "data.csv"']
    if any(s.orders for s in sensors):
        lines.append('orders = "orders.csv"')
    typical = {
        "speed": "2 rpm",
        "torque": "0.3 N m",
        "inlet_temperature": "0.15 K",
        "ambient_temperature": "0.3 K",
    }
    for name, (quantity, place) in settings.items():
        flow = max((p.flow.get(place, 0.0) for p in points), default=0.0)
        spread = typical.get(quantity) or f"{SETTING_NOISE['flow'] * flow * 6e4:.2g} l/min"
        lines += ["", f"[settings.{name}]", f'quantity = "{quantity}"']
        lines += [f'place = "{place}"'] if place else []
        lines += [f'unit = "{UNITS[quantity][0]}"', f'uncertainty = "{spread}"']
    for sensor in sensors:
        unit, factor, _, step = UNITS[sensor.quantity]
        shown = "K" if unit == "degC" else unit
        noise = math.hypot(sensor.noise * factor, 0.29 * step)
        lines += [
            "",
            f"[channels.{sensor.name}]",
            f'quantity = "{sensor.quantity}"',
            f'place = "{sensor.place}"',
        ]
        if sensor.at is not None:
            lines.append("at = [" + ", ".join(f'"{x:g} m"' for x in sensor.at) + "]")
        lines += [f'unit = "{unit}"', f'uncertainty = "{noise:.3g} {shown}"']
        if sensor.offset:
            lines.append(f'offset_uncertainty = "{sensor.offset * factor:.3g} {shown}"')
        if sensor.scale:
            lines.append(f"scale_uncertainty = {sensor.scale:g}")
        if sensor.orders:
            lines.append("orders = [" + ", ".join(f"{order:g}" for order in sensor.orders) + "]")
    for point in points:
        if point.tooth_offset:
            shown = ", ".join(f'"{mesh}" = {teeth}' for mesh, teeth in point.tooth_offset.items())
            lines += ["", f"[points.{point.name}]", "reassembled = true", f"tooth_offset = {{ {shown} }}"]
    return "\n".join(lines) + "\n"

"""Operating points and sensors of the rigs: fixed plans, three sets of sensors each."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

Sensors = Literal["rich", "usual", "sparse"]
RIGS = ("uhcf_prototype", "loop_1to1", "loop_hunting", "fzg")
"""The seed of a set has the place of its rig: new ones come last."""
PLANS = (9, 12, 15)
LITRE = 1e-3 / 60.0


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One operating point: speed [rpm], torque [N m], oil inlets [degC], factors of the flows, room [degC].

    Of a rig with sumps ``gear_oil`` is the temperature both are held at; it has no other oil.
    """

    speed: float
    torque: float
    gear_oil: float
    bearing_oil: float = 0.0
    gear_flow: float = 1.0
    bearing_flow: float = 1.0
    room: float = 22.0


@dataclass(frozen=True, kw_only=True)
class Sensor:
    """A channel with its true spreads (SI, 1 sigma); quantities and places as in measurement.toml."""

    name: str
    quantity: str
    place: str = ""
    at: tuple[float, float, float] | None = None
    noise: float
    offset: float = 0.0
    scale: float = 0.0
    orders: tuple[float, ...] = ()


@dataclass(frozen=True, kw_only=True)
class TruePoint:
    """A point as it really ran, SI."""

    name: str
    speed: float
    torque: float
    inlet: Mapping[str, float]
    flow: Mapping[str, float]
    room: float
    tooth_offset: Mapping[str, int] = field(default_factory=dict)


def plan_points(rig: str, count: int) -> list[Plan]:
    """Plan of 9, 12 or 15 points; the shorter ones are the first of the longer."""
    return _PLANS[rig][:count]


_PLANS = {
    "uhcf_prototype": [
        Plan(speed=12000, torque=180, gear_oil=140, bearing_oil=40),
        Plan(speed=4000, torque=60, gear_oil=140, bearing_oil=40),
        Plan(speed=12000, torque=60, gear_oil=110, bearing_oil=40, room=24),
        Plan(speed=4000, torque=180, gear_oil=110, bearing_oil=50),
        Plan(speed=8000, torque=120, gear_oil=90, bearing_oil=40, room=20),
        Plan(speed=8000, torque=180, gear_oil=140, bearing_oil=50, gear_flow=0.7),
        Plan(speed=12000, torque=120, gear_oil=90, bearing_oil=50, gear_flow=1.4, room=24),
        Plan(speed=8000, torque=60, gear_oil=120, bearing_oil=60, bearing_flow=1.4),
        Plan(speed=4000, torque=120, gear_oil=90, bearing_oil=40, bearing_flow=0.75, room=19),
        Plan(speed=12000, torque=180, gear_oil=110, bearing_oil=50, bearing_flow=1.4),
        Plan(speed=6000, torque=180, gear_oil=90, bearing_oil=60, room=25),
        Plan(speed=10000, torque=60, gear_oil=140, bearing_oil=40, gear_flow=1.4),
        Plan(speed=2000, torque=180, gear_oil=120, bearing_oil=40),
        Plan(speed=10000, torque=150, gear_oil=100, bearing_oil=60, gear_flow=0.7, room=20),
        Plan(speed=6000, torque=90, gear_oil=140, bearing_oil=60, bearing_flow=0.75),
    ],
    "loop_1to1": [
        Plan(speed=1000, torque=100, gear_oil=60, bearing_oil=60),
        Plan(speed=3600, torque=350, gear_oil=60, bearing_oil=60),
        Plan(speed=1000, torque=350, gear_oil=80, bearing_oil=60),
        Plan(speed=3600, torque=100, gear_oil=80, bearing_oil=70),
        Plan(speed=2200, torque=220, gear_oil=45, bearing_oil=45, room=20),
        Plan(speed=2900, torque=350, gear_oil=45, bearing_oil=60, gear_flow=0.6),
        Plan(speed=1600, torque=100, gear_oil=60, bearing_oil=80, bearing_flow=1.5, room=25),
        Plan(speed=2900, torque=160, gear_oil=80, bearing_oil=80, gear_flow=1.5),
        Plan(speed=1600, torque=280, gear_oil=70, bearing_oil=45, bearing_flow=0.7),
        Plan(speed=700, torque=220, gear_oil=60, bearing_oil=60),
        Plan(speed=3900, torque=220, gear_oil=70, bearing_oil=80, room=24),
        Plan(speed=2200, torque=70, gear_oil=80, bearing_oil=60, gear_flow=0.6),
        Plan(speed=2200, torque=380, gear_oil=60, bearing_oil=70, gear_flow=1.5),
        Plan(speed=3300, torque=280, gear_oil=45, bearing_oil=45),
        Plan(speed=1200, torque=160, gear_oil=45, bearing_oil=80, bearing_flow=1.5),
    ],
    "loop_hunting": [
        Plan(speed=1000, torque=80, gear_oil=70, bearing_oil=70),
        Plan(speed=3600, torque=270, gear_oil=70, bearing_oil=70),
        Plan(speed=1000, torque=270, gear_oil=85, bearing_oil=70),
        Plan(speed=3600, torque=80, gear_oil=85, bearing_oil=80),
        Plan(speed=2200, torque=170, gear_oil=50, bearing_oil=50, room=20),
        Plan(speed=2900, torque=270, gear_oil=50, bearing_oil=70, gear_flow=0.7),
        Plan(speed=1600, torque=80, gear_oil=70, bearing_oil=85, bearing_flow=1.5, room=25),
        Plan(speed=2900, torque=120, gear_oil=85, bearing_oil=85, gear_flow=1.5),
        Plan(speed=1600, torque=220, gear_oil=75, bearing_oil=50, bearing_flow=0.7),
        Plan(speed=800, torque=170, gear_oil=70, bearing_oil=70),
        Plan(speed=3900, torque=170, gear_oil=75, bearing_oil=85, room=24),
        Plan(speed=2200, torque=60, gear_oil=85, bearing_oil=70, gear_flow=0.7),
        Plan(speed=2200, torque=290, gear_oil=70, bearing_oil=80, gear_flow=1.5),
        Plan(speed=3300, torque=220, gear_oil=50, bearing_oil=50),
        Plan(speed=1200, torque=120, gear_oil=50, bearing_oil=85, bearing_flow=1.5),
    ],
    "fzg": [  # load stages 4 to 12 of DIN ISO 14635-1, sumps held
        Plan(speed=2250, torque=372.6, gear_oil=90),
        Plan(speed=1000, torque=94.1, gear_oil=90),
        Plan(speed=2250, torque=94.1, gear_oil=60, room=24),
        Plan(speed=1000, torque=372.6, gear_oil=60),
        Plan(speed=1500, torque=239.3, gear_oil=90, room=20),
        Plan(speed=3000, torque=183.4, gear_oil=90),
        Plan(speed=2250, torque=239.3, gear_oil=110, room=24),
        Plan(speed=3000, torque=302.0, gear_oil=75),
        Plan(speed=700, torque=183.4, gear_oil=90, room=19),
        Plan(speed=1500, torque=135.3, gear_oil=60),
        Plan(speed=2600, torque=372.6, gear_oil=100, room=25),
        Plan(speed=1200, torque=302.0, gear_oil=75),
        Plan(speed=2250, torque=60.8, gear_oil=90),
        Plan(speed=1750, torque=372.6, gear_oil=80, room=20),
        Plan(speed=3000, torque=94.1, gear_oil=110),
    ],
}
STREAMS = ("test.gear_oil", "test.bearing_oil", "reference.gear_oil", "reference.bearing_oil")
SUMPS = ("test.gear_oil", "slave.gear_oil")
"""Oils of the FZG rig: a temperature each, no flow."""


def streams(rig: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Oils of a rig whose temperature is read, and those whose flow is."""
    return (SUMPS, ()) if rig == "fzg" else (STREAMS, STREAMS)


_PLACES: Mapping[str, tuple[float, float, float]] = {
    "TC01": (0.133, 0.0, 0.280), "TC02": (0.133, 0.160, 0.190), "TC03": (0.133, -0.160, 0.190),
    "TC04": (0.057, 0.160, 0.140), "TC05": (0.222, -0.160, 0.140), "TC06": (0.0, 0.0, 0.230),
    "TC07": (0.2822, 0.0, 0.230), "TC08": (0.0, -0.050, 0.195), "TC09": (0.2822, 0.050, 0.195),
    "TC10": (0.133, 0.160, 0.060), "TC11": (0.141, 0.260, 0.0), "TC12": (0.057, 0.0, 0.280),
    "TC13": (0.222, 0.0, 0.280), "TC14": (0.133, -0.160, 0.060), "TC15": (0.2822, -0.050, 0.085),
    "TC16": (0.141, -0.420, 0.0),
}  # fmt: skip
"""Thermocouples of the prototype [m]: top, side walls warm and cold, end walls, clamping field."""
_FZG_PLACES: Mapping[str, tuple[float, float, float]] = {
    "TC01": (0.073, 0.0, 0.220), "TC02": (0.073, 0.140, 0.150), "TC03": (0.0, 0.0, 0.190),
    "TC04": (0.073, -0.140, 0.150), "TC05": (0.146, 0.0, 0.190), "TC06": (0.073, 0.140, 0.050),
    "TC07": (0.0, -0.110, 0.040), "TC08": (0.073, 0.240, 0.0),
}  # fmt: skip
"""Of the test gearbox of the FZG rig: top, side walls over and in the sump, end walls, clamping field."""


def sensors(rig: str, level: Sensors) -> list[Sensor]:
    """Channels of a rig."""
    if rig == "fzg":
        return _fzg(level)
    return _prototype(level) if rig == "uhcf_prototype" else _loop(rig, level)


def _prototype(level: Sensors) -> list[Sensor]:
    count = {"rich": 16, "usual": 11, "sparse": 5}[level]
    found = [
        Sensor(name=name, quantity="temperature", place="test", at=at, noise=0.1, offset=0.4, scale=0.015)
        for name, at in list(_PLACES.items())[:count]
    ]
    if level != "sparse":
        found.append(_inside("T_gear", "test.gear_test_pinion"))
    if level == "rich":
        found.append(_inside("T_gear_wheel", "test.gear_test_wheel"))
        found += [
            _inside("T_bearing_front", "test.bearing_bore_test_pinion_front"),
            _inside("T_bearing_rear", "test.bearing_bore_test_wheel_rear"),
        ]
    streams = {"rich": STREAMS, "usual": STREAMS[:3], "sparse": STREAMS[:2]}[level]
    return [*found, *_outlets(streams), _power(25.0)]


def _fzg(level: Sensors) -> list[Sensor]:
    """Those of a loop without its outlets, and thermocouples as on the prototype."""
    count = {"rich": 8, "usual": 5, "sparse": 2}[level]
    found = [sensor for sensor in _loop("fzg", level) if sensor.quantity != "oil_outlet_temperature"]
    found += [
        Sensor(name=name, quantity="temperature", place="test", at=at, noise=0.1, offset=0.4, scale=0.015)
        for name, at in list(_FZG_PLACES.items())[:count]
    ]
    if level != "sparse":
        found.append(_inside("T_gear", "test.gear_test_pinion"))
    if level == "rich":
        found.append(_inside("T_gear_wheel", "test.gear_test_wheel"))
        found.append(_inside("T_bearing_front", "test.bearing_bore_test_pinion_front"))
        found.append(_inside("T_bearing_rear", "test.bearing_bore_test_wheel_rear"))
    return found


def _loop(rig: str, level: Sensors) -> list[Sensor]:
    orders = loop_orders(rig, level)
    first, second = ("wheel_side", "pinion_side") if rig == "loop_1to1" else ("pinion_side", "wheel_side")
    found = [
        Sensor(name="M_1", quantity="torque", place=first, noise=0.02, offset=0.3, scale=0.003, orders=orders)
    ]
    if level == "rich":
        found.append(
            Sensor(
                name="M_2",
                quantity="torque",
                place=second,
                noise=0.03,
                offset=0.4,
                scale=0.003,
                orders=orders,
            )
        )
    other = "slave" if rig == "fzg" else "reference"
    angles = {"rich": ("test_pinion", f"{other}_wheel"), "usual": ("test_pinion",), "sparse": ()}[level]
    found += [
        Sensor(name=f"phi_{i + 1}", quantity="angle", place=shaft, noise=2e-6, orders=orders[1:])
        for i, shaft in enumerate(angles)
    ]
    count = {"rich": 3, "usual": 2, "sparse": 0}[level]
    found += [
        Sensor(name=f"f_{i + 1}", quantity="natural_frequency", place=str(i + 1), noise=1.5)
        for i in range(count)
    ]
    if level == "rich":
        found += [
            Sensor(name=f"play_{box}", quantity="backlash", place=f"{box}.main", noise=4e-6)
            for box in ("test", other)
        ]
    streams = {"rich": STREAMS, "usual": STREAMS[:3], "sparse": STREAMS[:1]}[level]
    return [*found, *_outlets(streams), _power(8.0)]


def loop_orders(rig: str, level: Sensors) -> tuple[float, ...]:
    """Orders per turn of the test pinion: mean, shafts, mesh with sidebands; fewer with sparse sensors."""
    teeth, wheel = {"loop_1to1": (28, 1.0), "fzg": (16, 2.0 / 3.0)}.get(rig, (16, 0.64))
    shafts = {1.0, 2.0, wheel, 2.0 * wheel} | (
        set() if level == "sparse" else {3.0, 4.0, 3.0 * wheel, 4.0 * wheel}
    )
    bands = {0.0} if level == "sparse" else {-1.0, 0.0, 1.0, -wheel, wheel}
    high = {h * teeth + band for h in (1, 2) for band in bands}
    extra = {0.5 * teeth} if level == "rich" else set()
    whole = sorted({0.0} | shafts | high | extra)
    # thirds stay as they are: the truth looks orders up
    return tuple(whole) if rig == "fzg" else tuple(round(order, 6) for order in whole)


def thermometer(place: str) -> Sensor:
    """One inside a gearbox, in addition to those that a rig has: ``test.bearing_bore_test_pinion_rear``."""
    return _inside(f"T_{place.partition('.')[2]}", place)


def _inside(name: str, place: str) -> Sensor:
    return Sensor(name=name, quantity="temperature", place=place, noise=0.3, offset=0.8, scale=0.01)


def _outlets(streams: Sequence[str]) -> list[Sensor]:
    return [
        Sensor(
            name=f"T_{stream.replace('.', '_')}_out",
            quantity="oil_outlet_temperature",
            place=stream,
            noise=0.05,
            offset=0.3,
        )
        for stream in streams
    ]


def _power(noise: float) -> Sensor:
    return Sensor(
        name="P_motor", quantity="motor_power", place="motor", noise=noise, offset=noise, scale=0.01
    )


SETTING_NOISE: Mapping[str, float] = {
    "speed": 2.0 * math.pi / 60.0, "torque": 0.3, "inlet_temperature": 0.15, "flow": 0.004, "ambient_temperature": 0.3,
}  # fmt: skip
"""Of one reading, SI; of a flow relative."""
SETTING_OFFSET = {"inlet_temperature": 0.3, "flow": 0.01, "ambient_temperature": 0.5, "torque": 0.005}
"""Constant over a set: [K], flow and bracing torque relative."""

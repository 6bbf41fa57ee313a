"""One rig with its constants and hidden effects: what all its sensors would read without any error of their own."""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tests.builders.paths import CASES
from tests.virtual_rig import heat_constants, loop_changes, sump_constants
from tests.virtual_rig.case_reader import read_case
from tests.virtual_rig.fzg_drawing import dips, drawn
from tests.virtual_rig.generate_plans import STREAMS, SUMPS, Sensor, TruePoint
from tests.virtual_rig.heat_effects import is_heat
from tests.virtual_rig.heat_truth import HeatTruth, boxes_of
from tests.virtual_rig.loop import COLD, MATERIAL_GROWTH, LoopTruth, Point
from tests.virtual_rig.loop_changes import CHANGES, LoopConstants
from tests.virtual_rig.sump_losses import SumpLosses

IRON_GROWTH = 10.5e-6
"""Of a housing of grey iron [1/K]."""


class Reading(NamedTuple):
    """One number: channel at a point, of orders its real or imaginary part. Point is empty at standstill."""

    channel: str
    point: str
    order: float = 0.0
    part: str = "value"


class Constants(NamedTuple):
    """Everything one built rig has of its own."""

    heat: Mapping[str, float]
    loop: LoopConstants | None
    places: Mapping[str, tuple[float, float, float]]
    """Where thermocouples really sit [m], where that is not the drawing."""


@lru_cache(maxsize=4)
def case_of(rig: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Tree of a case and its boxes, built once."""
    tree = drawn(read_case(CASES / rig / "case.toml"))
    return tree, boxes_of(tree)


def has_loop(rig: str) -> bool:
    """Whether a rig is marched in time."""
    return rig.startswith("loop_") or rig == "fzg"


def has_sumps(rig: str) -> bool:
    """Whether its gears run in sumps, without streams of oil."""
    return dips(case_of(rig)[0])


def heat_table(rig: str) -> Mapping[str, heat_constants.Constant]:
    """Constants of the heat part of a rig."""
    return sump_constants.CONSTANTS if has_sumps(rig) else heat_constants.CONSTANTS


def nominal_constants(rig: str) -> Constants:
    """The middle of the population, without tooth errors."""
    heat = {name: constant.value for name, constant in heat_table(rig).items()}
    return Constants(heat, LoopConstants() if has_loop(rig) else None, {})


def draw_rig(
    rig: str, rng: np.random.Generator, places: Sequence[Sensor], *, shift: bool = False
) -> Constants:
    """A rig as built."""
    tree, boxes = case_of(rig)
    heat = {name: heat_constants.drawn(one, rng, shift) for name, one in heat_table(rig).items()}
    loop = None
    if has_loop(rig):
        loop = loop_changes.draw_constants(rng, tree, LoopTruth(tree).meshes, shift=shift)
    moved = {}
    if boxes:
        from tests.virtual_rig.heat_places import scattered

        box = next(iter(boxes.values()))
        moved = {s.name: scattered(box, s.at, rng) for s in places if s.at is not None}
    return Constants(heat, loop, moved)


FRICTION_DRIFT: Mapping[str, float] = {
    "friction": 0.02, "film_fill": 0.01, "mist_density": 0.01, "squeeze": 0.01, "seal_drag": 0.03,
    "bearing_free": 0.03, "bearing_load": 0.01, "churning": 0.02, "lip_drag": 0.03,
}  # fmt: skip
"""Relative change of friction from one day to another, 1 sigma: flanks and seals run in, oil ages, bearings settle."""
FILM_DRIFT = 0.02
"""The same of every film between oil and metal."""


def another_day(constants: Constants, rng: np.random.Generator, times: float = 1.0) -> Constants:
    """The rig at a later set; times : on all of its drift."""
    heat = dict(constants.heat)
    for name in heat:
        of_film = name.startswith("film_") and name != "film_weight"
        spread = FRICTION_DRIFT.get(name, FILM_DRIFT if of_film else 0.0)
        heat[name] *= math.exp(times * spread * rng.standard_normal()) if spread else 1.0
    return constants._replace(heat=heat)


def readings(sensors: Sequence[Sensor], points: Sequence[TruePoint]) -> list[Reading]:
    """Numbers of a set in their order: points, sensors, orders; standstill at the end."""
    standing = ("natural_frequency", "backlash")
    found = []
    for point in points:
        for sensor in sensors:
            if sensor.quantity in standing:
                continue
            if not sensor.orders:
                found.append(Reading(sensor.name, point.name))
            for order in sensor.orders:
                parts = ("real", "imaginary") if order else ("value",)
                found += [Reading(sensor.name, point.name, order, part) for part in parts]
    return found + [Reading(sensor.name, "") for sensor in sensors if sensor.quantity in standing]


class RigTruth:
    """A rig of a case: heat for all of them, motion in time for the loops."""

    def __init__(self, rig: str, constants: Constants, effects: Sequence[Mapping[str, Any]] = ()) -> None:
        self.rig, self.constants = rig, constants
        self.tree, boxes = case_of(rig)
        hot = {e["effect"]: e["size"] for e in effects if is_heat(e["effect"])}
        self.loop, damping = None, {}
        if constants.loop is not None:
            moving = [e for e in effects if e["effect"].partition(":")[0] in CHANGES]
            self.loop = LoopTruth(self.tree, constants.loop, moving)
            own = self.loop.constants.scale
            damping = {name: value for name, value in own.items() if name.startswith("mesh_damping:")}
        self.heat = HeatTruth(self.tree, {**constants.heat, **damping}, hot, boxes=boxes)
        self._start: dict[str, Any] = {}

    def values(self, points: Sequence[TruePoint], sensors: Sequence[Sensor], *, heat: bool = True, loop: bool = True
               ) -> np.ndarray:  # fmt: skip
        """Numbers of ``readings`` [SI]; with ``heat`` or ``loop`` False those parts stay zero (to save time)."""
        found: dict[tuple[str, str], Any] = {}
        places = {s.name: self.constants.places.get(s.name, s.at) for s in sensors if s.at is not None}
        orders = sorted({o for s in sensors for o in s.orders})
        for point in points:
            warm = self.heat.solve(_heat_point(point), places, self._start.get(point.name))
            self._start[point.name] = warm["state"]
            if heat:
                self._read_heat(point, sensors, warm, found)
            if loop and self.loop is not None and orders:
                self._read_loop(point, sensors, warm, orders, found)
        if loop and self.loop is not None:
            self._read_standing(sensors, found)
        rows = readings(sensors, points)
        values = np.zeros(len(rows))
        for i, row in enumerate(rows):
            value = found.get((row.channel, row.point), 0.0)
            if isinstance(value, Mapping):
                value = value.get(row.order, 0.0)
            values[i] = value.imag if row.part == "imaginary" else np.real(value)
        return values

    def _read_heat(
        self, point: TruePoint, sensors: Sequence[Sensor], warm: Mapping[str, Any], found: dict
    ) -> None:
        for sensor in sensors:
            key = sensor.name, point.name
            if sensor.quantity == "temperature":
                found[key] = (
                    warm["thermocouples"][sensor.name] if sensor.at else warm["temperatures"][sensor.place]
                )
            elif sensor.quantity == "oil_outlet_temperature":
                found[key] = warm["oil_outlets"][sensor.place]
            elif sensor.quantity == "motor_power":
                found[key] = warm["motor_power"]
            elif sensor.quantity == "drive_torque":
                found[key] = warm["drive_torque"]

    def _read_loop(
        self,
        point: TruePoint,
        sensors: Sequence[Sensor],
        warm: Mapping[str, Any],
        orders: Sequence[float],
        found: dict,
    ) -> None:
        assert self.loop is not None
        answer = self.loop.solve(loop_point(self.loop, self.heat, point, warm), orders)
        for sensor in sensors:
            if sensor.quantity == "torque":
                found[sensor.name, point.name] = answer.torques[sensor.place]
            elif sensor.quantity == "angle":
                found[sensor.name, point.name] = answer.angles[sensor.place]

    def _read_standing(self, sensors: Sequence[Sensor], found: dict) -> None:
        assert self.loop is not None
        for sensor in sensors:
            if sensor.quantity == "natural_frequency":
                found[sensor.name, ""] = self.loop.natural_frequencies(int(sensor.place))[-1]
            elif sensor.quantity == "backlash":
                # the first loops have theirs along the path, in all their sets; a rig is measured at its pitch circle
                play = self.loop.circumferential_play if has_sumps(self.rig) else self.loop.backlash
                found[sensor.name, ""] = play(sensor.place)


def loop_point(loop: LoopTruth, heat: HeatTruth, point: TruePoint, warm: Mapping[str, Any]) -> Point:
    """Point of the loop with friction and drags of the heat part: its losses, spread over shafts and meshes.

    warm : answer of the heat part; where it knows gears and housing, they close the flanks as they expand
    """
    tree, ratio = heat.tree, heat.model.ratio
    base = ratio[heat.model.reference_shaft]
    drags: dict[str, float] = {}
    friction: dict[str, float] = {}
    gear_on = {
        entry["shaft"]: (f"{box}.{gear}", point.speed * ratio[entry["shaft"]] / base)
        for box, part in tree["gearboxes"].items()
        for gear, entry in part["gears"].items()
    }
    for name, power in warm["losses"].items():
        box, _, rest = name.partition(".")
        kind, _, part = rest.partition(":")
        entry = tree["gearboxes"][box]
        if kind == "mesh":
            friction[f"{box}.{part}"] = float(power)
            continue
        if kind == "bearing":
            shafts = [entry["bearings"][part]["shaft"]]
        elif kind in ("windage", "churning"):
            shafts = [entry["gears"][part]["shaft"]]
        elif kind == "seal":
            shafts = [part]
        else:
            shafts = [gear["shaft"] for gear in entry["gears"].values()]
        for shaft in shafts:
            gear, speed = gear_on[shaft]
            drags[gear] = drags.get(gear, 0.0) + float(power) / len(shafts) / speed
    powers = loop.sliding_power(point.speed, point.torque)
    return Point(
        speed=point.speed,
        torque=point.torque,
        oil=point.inlet["test.gear_oil"],
        friction={mesh: power / powers[mesh] for mesh, power in friction.items()},
        drags=drags,
        tooth_offset=point.tooth_offset,
        growth=_growth(loop, heat, warm) if dips(tree) else {},
    )


def _growth(loop: LoopTruth, heat: HeatTruth, warm: Mapping[str, Any]) -> dict[str, float]:
    """By mesh: radii of the gears that grow more than the distance of their axes, along the path [m]."""
    model = heat.model
    assert isinstance(model, SumpLosses)
    found = {}
    for mesh in loop.meshes:
        gears, housing = model.bulk_temperatures(mesh.name.split(".")[0], warm)
        distance = sum(mesh.working_radii)
        wider = MATERIAL_GROWTH * (gears - COLD) - IRON_GROWTH * (housing - COLD)
        found[mesh.name] = wider * distance * math.sin(mesh.working_angle)
    return found


def _heat_point(point: TruePoint) -> dict[str, Any]:
    return {
        "speed": point.speed, "torque": point.torque, "inlet_temperature": dict(point.inlet), "flow": dict(point.flow),
        "ambient_temperature": point.room,
    }  # fmt: skip


def true_points(rig: str, plans: Sequence[Any], rng: np.random.Generator | None = None) -> list[TruePoint]:
    """Points of a plan as really run: scattered by one per cent and one kelvin, exact without ``rng``."""
    tree, _ = case_of(rig)

    def about(value: float, relative: float = 0.0, absolute: float = 0.0) -> float:
        if rng is None:
            return value
        return value * (1.0 + relative * rng.uniform(-1.0, 1.0)) + absolute * rng.uniform(-1.0, 1.0)

    found = []
    for index, plan in enumerate(plans):
        inlet, flow = {}, {}
        for stream in () if has_sumps(rig) else STREAMS:
            box, kind = stream.split(".")
            entry = tree["gearboxes"][box]["oil" if kind == "gear_oil" else "bearing_oil"]
            factor = plan.gear_flow if kind == "gear_oil" else plan.bearing_flow
            flow[stream] = about(entry["flow"] * factor, 0.02)
            own = plan.gear_oil if kind == "gear_oil" else plan.bearing_oil
            if box == "reference" and not has_loop(rig):
                own = entry["inlet_temperature"] - 273.15
            inlet[stream] = about(own + 273.15, absolute=1.0)
        for sump in SUMPS if has_sumps(rig) else ():
            inlet[sump] = about(plan.gear_oil + 273.15, absolute=1.0)
        found.append(
            TruePoint(
                name=f"P{index + 1:02d}",
                speed=about(plan.speed * math.pi / 30.0, 0.01),
                torque=about(plan.torque, 0.01),
                inlet=inlet,
                flow=flow,
                room=about(plan.room + 273.15, absolute=1.5),
            )
        )
    return found

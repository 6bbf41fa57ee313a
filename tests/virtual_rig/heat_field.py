"""Heat of one gearbox with housing at one point: coefficients, streams and sources from temperatures, then solved."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.heat_coefficients import FilmModel
from tests.virtual_rig.heat_network import OUTSIDE, Loads, Solved, solve
from tests.virtual_rig.losses_rig import Gearbox, LossModel

TOLERANCE = 1e-6
MOST_PASSES = 60
DEPTH = 4
"""Passes that are mixed."""
START_STEPS = 8
"""Implicit steps from ambient to the time of an unsteady point, each 1.8 times the one before."""


class NoSteadyStateError(RuntimeError):
    """The passes do not settle."""


@dataclass(frozen=True, kw_only=True)
class FieldState:
    """Solved gearbox."""

    temperature: np.ndarray
    surface: np.ndarray
    losses: dict[str, float]
    outlets: dict[str, float]
    imbalance: float
    passes: int
    film_heat: np.ndarray


class FieldModel:
    """One gearbox with its field, constants and effects."""

    def __init__(self, box: Box, model: LossModel) -> None:
        self.box, self.model, self.c = box, model, model.c
        self.films = FilmModel(box, model)
        net = box.net
        self.wall_area = {
            name: float(net.fa[box.films[name]].sum())
            for name in ("partition_warm_front", "partition_warm_rear", "chamber_wall", "chamber_top")
        }

    def size(self, key: str) -> float:
        """Size of an effect on this gearbox."""
        return self.model.size(key, self.box.name)

    def solve(self, run: Gearbox, room: float, start: np.ndarray | None = None) -> FieldState:
        """Steady state, or the state after the time an unsteady point has run."""
        rate = self.size("not_steady")
        if rate > 0.0:
            return self._unsteady(run, room, 3600.0 / rate)
        guess = start if start is not None else self._guess(run, room)
        surface = guess[self.box.net.fi]
        past: list[tuple[np.ndarray, np.ndarray]] = []
        for number in range(MOST_PASSES):
            loads, losses = self._loads(run, room, guess, surface)
            solved = solve(self.box.net, loads, guess)
            step = solved.temperature - guess
            change = float(np.max(np.abs(step)))
            if change < TOLERANCE:
                return self._state(run, solved, loads, losses, number + 1)
            past = [*past[-DEPTH:], (solved.temperature, step)]
            guess = _mixed(past)
            surface = solved.surface + (guess - solved.temperature)[self.box.net.fi]
        raise NoSteadyStateError(f"{self.box.name}: still {change:.3g} K after {MOST_PASSES} passes")

    def _unsteady(self, run: Gearbox, room: float, time: float) -> FieldState:
        steps = 1.8 ** np.arange(START_STEPS)
        steps *= time / steps.sum()
        guess = np.full(self.box.net.size, room)
        for step in steps:
            previous, surface = guess, guess[self.box.net.fi]
            for _ in range(4):
                loads, losses = self._loads(run, room, guess, surface)
                solved = solve(self.box.net, loads, guess, previous, step)
                guess, surface = solved.temperature, solved.surface
        return self._state(run, solved, loads, losses, START_STEPS)

    def _guess(self, run: Gearbox, room: float) -> np.ndarray:
        middle = 0.5 * (run.gear_inlet + room)
        guess = np.full(self.box.net.size, middle)
        for name, cell in self.box.oil.items():
            warm = name in ("jet", "mist", "top", "sump")
            guess[cell] = run.gear_inlet if warm else run.bearing_inlet + 15.0
        for row in self.box.rows.values():
            guess[row] = run.gear_inlet
        return guess

    # ---------------------------------------------------------------- one pass

    def _loads(
        self, run: Gearbox, room: float, t: np.ndarray, surface: np.ndarray
    ) -> tuple[Loads, dict[str, float]]:
        net = self.box.net
        source, entry = np.zeros(net.size), np.zeros(net.size)
        losses = self._sources(run, t, source)
        streams = self._streams(run, entry)
        film, outside, offset = self.films.all(run, room, t, surface)
        contact = np.zeros(len(net.ri))
        for name, index in net.contact_of.items():
            contact[index] = self._joint(name, run) / net.contact_area[index]
        loads = Loads(
            film=film, outside=outside, offset=offset, contact=contact, slope=self.c["k_slope"], source=source,
            streams=streams, entry=entry,
        )  # fmt: skip
        return loads, losses

    def _joint(self, name: str, run: Gearbox) -> float:
        """Resistance of a joint [m2 K/W]."""
        c = self.c
        match name:
            case "shell":
                return 1.0 / c["shell_contact"] + self.size("shell_contact")
            case "foot":
                return 1.0 / c["foot_contact"] + self.size("foot_contact")
            case "seat":
                return 1.0 / c["seat_contact"]
        return 1.0 / (c["film_seal_gap"] * run.relative_speed**0.3)

    def _sources(self, run: Gearbox, t: np.ndarray, source: np.ndarray) -> dict[str, float]:
        """Losses placed on cells; returns what the motor pays by name."""
        box, model, c, split = self.box, self.model, self.c, run.entry["heat_split"]
        paid: dict[str, float] = {}
        for name in run.entry["bearings"]:
            cell = box.oil[f"film_{name}"]
            paid[f"bearing:{name}"] = model.bearing(run, name, t[cell])
            source[cell] += paid[f"bearing:{name}"]
        jet, mist = box.oil["jet"], box.oil["mist"]
        for mesh in run.meshes:
            rims = box.rim[mesh.pinion], box.rim[mesh.wheel]
            oil = 0.5 * t[jet] + 0.25 * (t[rims[0]] + t[rims[1]])
            loss = model.mesh(run, mesh, oil)
            squeeze = model.squeeze(run, loss)
            paid[f"mesh:{mesh.name}"], paid[f"squeeze:{mesh.name}"] = loss, squeeze
            paid[f"vibration:{mesh.name}"] = vibration = model.vibration(run, mesh)
            into = split.get("mesh_into_gears", 0.5) * c["into_gears"] * (1.0 + self.size("loss_split"))
            into = min(max(into, 0.0), 1.0)
            first = split.get("mesh_pinion_share", 0.5) * c["pinion_share"]
            source[rims[0]] += loss * into * first
            source[rims[1]] += loss * into * (1.0 - first)
            source[jet] += loss * (1.0 - into) + squeeze + vibration
            for gear, power in zip((mesh.pinion, mesh.wheel), model.windage(run, mesh), strict=True):
                paid[f"windage:{gear}"] = power
                share = split.get("windage_into_gears", 0.1)
                source[box.rim[gear]] += share * power
                source[mist] += (1.0 - share) * power
        momentum = model.jet(run)
        paid["jet"] = momentum
        source[jet] += 0.5 * momentum
        for row in box.rows.values():
            source[row[0]] += 0.125 * momentum
        for shaft in box.shafts:
            inner, outer = model.seals(run, shaft)
            paid[f"seal:{shaft}"] = inner + outer
            body, house = split.get("seal_into_shaft", 0.25), split.get("seal_into_housing", 0.25)
            spread(source, box.seal_cells[shaft], inner * body)
            bores = [n for side in ("front", "rear") for n in box.bore[f"partition_{side}", shaft]]
            spread(source, bores, inner * house)
            source[mist] += inner * (1.0 - body - house)
            for side in ("front", "rear"):
                source[box.oil[f"end_{side}"]] += 0.5 * outer
        source[box.oil["sump"]] += self.size("pump_heat")
        self._hidden_sources(run, source, paid)
        return paid

    def _hidden_sources(self, run: Gearbox, source: np.ndarray, paid: dict[str, float]) -> None:
        """Heat that no loss of a healthy rig makes."""
        box, net = self.box, self.box.net
        pinion = run.meshes[0].pinion
        shaft = run.entry["gears"][pinion]["shaft"]
        source[box.ends[shaft]] += self.size("coupling_heat") * run.relative_speed**0.5
        fretting = self.size("spline_fretting") * run.relative_speed * run.relative_torque
        source[box.bodies[f"gear_{shaft}"][0]] += fretting
        if fretting:
            paid["fretting"] = fretting
        top = net.group_of["out_top"]
        np.add.at(source, net.fi[top], self.size("lamp_on_top") * self.films.emissivity["out"] * net.fa[top])
        bottom = net.group_of.get("field_bottom", np.array([], dtype=int))
        np.add.at(source, net.fi[bottom], self.size("floor_heating") * net.fa[bottom])

    def _streams(self, run: Gearbox, entry: np.ndarray) -> list[tuple[int, int, float]]:
        box, c, oil = self.box, self.c, self.box.oil
        streams: list[tuple[int, int, float]] = []
        capacity = run.gear_capacity * (1.0 - self.size("bypass"))
        entry[oil["jet"]] += capacity * run.gear_inlet + self.size("heated_inlet")
        straight, mist = c["straight_to_sump"], c["mist_share"]
        streams += [(oil["jet"], oil["sump"], straight * capacity), (oil["jet"], oil["mist"], mist * capacity),
                    (oil["mist"], oil["sump"], mist * capacity)]  # fmt: skip
        spray = (1.0 - straight - mist) * capacity
        area = self.wall_area
        both = area["partition_warm_front"] + area["partition_warm_rear"]
        total = both + area["chamber_wall"] + area["chamber_top"]
        shares = {
            "partition_front": both / total * c["spray_front"],
            "partition_rear": both / total * (1.0 - c["spray_front"]),
            "left": area["chamber_wall"] / total / 2.0,
            "right": area["chamber_wall"] / total / 2.0,
        }
        top = area["chamber_top"] / total * spray
        streams.append((oil["jet"], oil["top"], top))
        for wall, row in box.rows.items():
            flow = shares[wall] * spray
            streams.append((oil["jet"], row[0], flow))
            if wall in ("left", "right"):
                streams.append((oil["top"], row[0], top / 2.0))
                flow += top / 2.0
            streams += [(a, b, flow) for a, b in zip(row, [*row[1:], oil["sump"]], strict=True)]
        leak, lost = (
            self.size("leak_warm_cold") * run.gear_capacity,
            self.size("leak_one_side") * run.gear_capacity,
        )
        streams.append((oil["sump"], OUTSIDE, capacity - leak - lost))
        feed = self.model.feed_shares(run)
        bearings = run.entry["bearings"]
        whole = run.bearing_capacity * len(bearings)
        for side in ("front", "rear"):
            flow = 0.0
            for name, bearing in bearings.items():
                if bearing["side"] == side:
                    part = feed[name] * whole
                    entry[oil[f"film_{name}"]] += part * run.bearing_inlet
                    streams.append((oil[f"film_{name}"], oil[f"end_{side}"], part))
                    flow += part
            streams.append((oil[f"end_{side}"], oil[f"splash_{side}"], flow))
            extra = 0.5 * leak + (lost if side == "front" else 0.0)
            streams.append((oil["sump"], oil[f"splash_{side}"], extra))
            streams.append((oil[f"splash_{side}"], oil[f"drain_{side}"], flow + extra))
            streams.append((oil[f"drain_{side}"], OUTSIDE, flow + extra))
        return streams

    # ---------------------------------------------------------------- results

    def _state(
        self, run: Gearbox, solved: Solved, loads: Loads, losses: dict[str, float], passes: int
    ) -> FieldState:
        oil, t = self.box.oil, solved.temperature
        exits = {a: c for a, b, c in loads.streams if b == OUTSIDE}
        bypass = self.size("bypass") * run.gear_capacity
        gear = (exits[oil["sump"]] * t[oil["sump"]] + bypass * run.gear_inlet) / (exits[oil["sump"]] + bypass)
        drains = {side: exits[oil[f"drain_{side}"]] for side in ("front", "rear")}
        drains["front"] -= self.size("leak_one_side") * run.gear_capacity
        cold = sum(flow * t[oil[f"drain_{side}"]] for side, flow in drains.items()) / sum(drains.values())
        return FieldState(
            temperature=t, surface=solved.surface, losses=losses, imbalance=solved.imbalance, passes=passes,
            outlets={"gear_oil": float(gear), "bearing_oil": float(cold)}, film_heat=solved.film_heat,
        )  # fmt: skip


def _mixed(past: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Anderson's mixture of the last passes: the combination whose steps cancel best."""
    latest, step = past[-1]
    if len(past) < 3:
        return latest
    steps = np.array([step - older for _, older in past[:-1]]).T
    weights = np.linalg.lstsq(steps, step, rcond=1e-10)[0]
    if np.abs(weights).sum() > 2.0:
        return latest
    return latest - np.array([latest - older for older, _ in past[:-1]]).T @ weights


def spread(source: np.ndarray, cells: Any, power: float) -> None:
    """A power over cells alike."""
    source[list(cells)] += power / len(cells)

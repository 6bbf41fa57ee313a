"""Heat of one gearbox with housing at one point: coefficients, streams and sources from temperatures, then solved."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.virtual_rig import heat_films as films
from tests.virtual_rig.heat_box import Box
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
        house = box.house
        self.emissivity = {"out": 0.6, "field": 0.94, "shaft": 0.5}
        for entry in house.get("boundary", {}).values():
            if entry.get("law") == "radiation":
                first = entry["surfaces"][0]
                key = (
                    "field" if first.startswith("field") else "shaft" if first.startswith("shaft") else "out"
                )
                self.emissivity[key] = entry["emissivity"]
        net = box.net
        self.bearing_of = {}
        for group in ("bearing", "journal"):
            cells = {box.oil[f"film_{name}"]: name for name in box.box["bearings"]}
            self.bearing_of[group] = [cells[net.fj[i]] for i in net.group_of[group]]
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
        film, outside, offset = self._films(run, room, t, surface)
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
            into = split.get("mesh_into_gears", 0.5) * c["into_gears"] * (1.0 + self.size("loss_split"))
            into = min(max(into, 0.0), 1.0)
            first = split.get("mesh_pinion_share", 0.5) * c["pinion_share"]
            source[rims[0]] += loss * into * first
            source[rims[1]] += loss * into * (1.0 - first)
            source[jet] += loss * (1.0 - into) + squeeze
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
            _spread(source, box.seal_cells[shaft], inner * body)
            bores = [n for side in ("front", "rear") for n in box.bore[f"partition_{side}", shaft]]
            _spread(source, bores, inner * house)
            source[mist] += inner * (1.0 - body - house)
            for side in ("front", "rear"):
                source[box.oil[f"end_{side}"]] += 0.5 * outer
        self._hidden_sources(run, source, paid)
        return paid

    def _hidden_sources(self, run: Gearbox, source: np.ndarray, paid: dict[str, float]) -> None:
        box, net = self.box, self.box.net
        pinion = run.meshes[0].pinion
        shaft = run.entry["gears"][pinion]["shaft"]
        source[box.oil["sump"]] += self.size("pump_heat")
        source[box.ends[shaft]] += self.size("coupling_heat") * run.relative_speed**0.5
        fretting = self.size("spline_fretting") * run.relative_speed * run.relative_torque
        source[box.bodies[f"gear_{shaft}"][0]] += fretting
        if fretting:
            paid["fretting"] = fretting
        top = net.group_of["out_top"]
        np.add.at(source, net.fi[top], self.size("lamp_on_top") * self.emissivity["out"] * net.fa[top])
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

    # ---------------------------------------------------------------- films

    def _films(self, run: Gearbox, room: float, t: np.ndarray, surface: np.ndarray) -> tuple[np.ndarray, ...]:
        net = self.box.net
        film = np.zeros(len(net.fi))
        air = room + self.size("ambient")
        outside = air + self.c["room_layers"] * net.fh
        offset = np.zeros(len(net.fi))
        for group, index in net.group_of.items():
            if group.startswith(("out_", "field_")):
                self._room(group, index, run, surface, film, outside)
            else:
                film[index] = self._inside(group, index, run, t)
        layers = (self.c["layers"] + self.size("stratified_chamber")) * net.fh
        for group in ("chamber", "sump"):
            offset[net.group_of[group]] = layers[net.group_of[group]]
        for group in ("shaft_out", "shaft_end"):
            index = net.group_of.get(group, np.array([], dtype=int))
            outside[index] = air
            emissivity = self.emissivity["shaft"] * self.c["emissivity_shaft"]
            film[index] += films.radiation(emissivity, surface[index], outside[index])
        outside[net.group_of["barrier"]] = air
        return film, outside, offset

    def _inside(self, group: str, index: np.ndarray, run: Gearbox, t: np.ndarray) -> Any:
        c, s = self.c, run.relative_speed
        density = self.model.mist(run)
        if group in ("chamber", "sump", "rim", "seal_bore"):
            key = "rim" if group == "rim" else "chamber"
            oil, usual = run.gear_oil, self.box.box["oil"]["inlet_temperature"]
            base = c[
                {
                    "chamber": "film_chamber",
                    "sump": "film_sump",
                    "rim": "film_rim",
                    "seal_bore": "film_seal_bore",
                }[group]
            ]
            effect = {
                "chamber": "film:chamber_oil",
                "sump": "film:chamber_sump",
                "rim": "film:gear_rims",
            }.get(group)
            value = base * s ** c[f"exponent_{key}"] * run.relative_flow ** c["exponent_flow"]
            value *= (oil.nu(run.gear_inlet) / oil.nu(usual)) ** -c["exponent_viscosity"] * (1.0 - oil.air)
            if group == "rim":
                value *= (1.0 - self.size("blocked_jet")) ** 0.9 * (1.0 - self.size("bypass")) ** c[
                    "exponent_flow"
                ]
            return value * (1.0 + (self.size(effect) if effect else 0.0))
        if group in ("cold", "cold_end", "cold_floor", "end_seal"):
            base = c[
                {"cold": "film_cold", "cold_end": "film_cold_end", "cold_floor": "film_cold_floor"}.get(
                    group, "film_cold"
                )
            ]
            flow = run.bearing_flow / self.box.box["bearing_oil"]["flow"]
            value = base * s ** c["exponent_cold"] * flow ** c["exponent_flow"] * (1.0 - run.bearing_oil.air)
            return value * (1.0 + (self.size("film:cold_oil") if group != "end_seal" else 0.0))
        if group in ("bearing", "journal"):
            return np.array([self._bearing_film(run, name, t) for name in self.bearing_of[group]])
        if group.startswith("gear_side_"):
            gear = group.removeprefix("gear_side_")
            entry = run.entry["gears"][gear]
            mesh = run.meshes[0]
            radius = mesh.path.tip_radii[0 if gear == mesh.pinion else 1]
            value = c["film_disc"] * films.disc(run.speed[entry["shaft"]], radius, density)
            return value * (1.0 + self.size("film:gear_sides"))
        if group in ("gallery", "barrier"):
            return self.size("feed_gallery" if group == "gallery" else "barrier_air")
        return self._shaft(group, index, run, density)

    def _bearing_film(self, run: Gearbox, name: str, t: np.ndarray) -> float:
        entry = run.entry["bearings"][name]
        clearance = 0.5 * entry["diametral_clearance"] * self.c.get(f"clearance_{self.box.name}", 1.0)
        k = run.bearing_oil.k(t[self.box.oil[f"film_{name}"]])
        return float(self.c["nusselt_bearing"] * k / clearance * (1.0 + self.size("bearing_film")))

    def _shaft(self, group: str, index: np.ndarray, run: Gearbox, density: float) -> np.ndarray:
        values = np.empty(len(index))
        for shaft in self.box.shafts:
            entry, speed = self.box.house["shafts"][shaft], run.speed[shaft]
            cells = set(self.box.bodies[f"shaft_{shaft}"])
            mine = np.array([self.box.net.fi[i] in cells for i in index], dtype=bool)
            match group:
                case "shaft_warm":
                    value = self.c["film_drum"] * films.drum(speed, entry["seal_diameter"], density)
                case "shaft_cold":
                    value = self.c["film_shaft_cold"] * films.drum(speed, entry["seal_diameter"], 1.5)
                case "shaft_out":
                    value = self.c["film_overhang"] * films.drum(speed, entry["outside_diameter"], 1.05)
                case _:
                    value = self.c["film_overhang"] * films.disc(speed, 0.5 * entry["outside_diameter"], 1.05)
            if group in ("shaft_out", "shaft_end"):
                value *= 1.0 + self.size("ambient_film")
            values[mine] = value
        return values

    def _room(self, group: str, index: np.ndarray, run: Gearbox, surface: np.ndarray, film: np.ndarray,
              outside: np.ndarray) -> None:  # fmt: skip
        c, box, s, room = self.c, self.box, surface[index], outside[index]
        if group == "field_bottom":
            return
        speed = c["draught"] * run.relative_speed ** c["draught_speed"]
        house = group.startswith("out_")
        if group == "out_top":
            length = box.length * box.width / (2.0 * (box.length + box.width))
            free = c["free_top"] * films.upward(s, room, length)
        elif group == "field_top":
            field = box.house["field"]
            length = field["length"] * field["width"] / (2.0 * (field["length"] + field["width"]))
            free = c["free_field"] * films.upward(s, room, length)
        else:
            height = box.height if house else box.house["field"]["thickness"]
            free = c["free_wall" if house else "free_field"] * films.vertical(s, room, height)
        forced = films.draught(
            speed if house else 0.4 * speed, box.height if house else 0.5, float(np.mean(room))
        )
        convection = films.mixed(free, forced) * (1.0 + self.size("ambient_film"))
        if house:
            emissivity = self.emissivity["out"] * c["emissivity_housing"] * (1.0 + self.size("emissivity"))
        else:
            emissivity = self.emissivity["field"] * c["emissivity_field"]
        self._beside(group, index, run, convection, min(emissivity, 1.0), s, room, film, outside)

    def _beside(self, group: str, index: np.ndarray, run: Gearbox, convection: np.ndarray, emissivity: float,
                s: np.ndarray, room: np.ndarray, film: np.ndarray, outside: np.ndarray) -> None:  # fmt: skip
        """Radiation, and what stands, blows, runs or lies on one outer face only."""
        net = self.box.net
        around = room.copy()
        if group == "out_left":
            around = around + self.size("hot_neighbour")
        if group == "out_right":
            convection = convection + self.size("draught_one_side")
        radiant = films.radiation(emissivity, s, around)
        total, drive = convection + radiant, convection * room + radiant * around
        extra, sink = 0.0, room
        if group == "out_end_rear":
            extra, sink = self.size("oil_on_end_wall"), np.full_like(room, run.bearing_inlet)
        elif group == "out_end_front" and self.size("frame_bolted"):
            low = net.fh[index] < 0.0
            extra = self.size("frame_bolted") * low / net.fa[index][low].sum()
        total, drive = total + extra, drive + extra * sink
        outside[index] = drive / total
        if group == "out_top":
            total = 1.0 / (1.0 / total + self.size("insulating_deposit"))
        film[index] = total

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


def _spread(source: np.ndarray, cells: Any, power: float) -> None:
    source[list(cells)] += power / len(cells)

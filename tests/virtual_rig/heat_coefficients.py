"""Coefficient of every film of a box at one pass, and the temperatures outside."""

from typing import Any

import numpy as np

from tests.virtual_rig import heat_films as films
from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.losses_rig import Gearbox, LossModel


class FilmModel:
    """Films of one box under its constants and effects."""

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

    def size(self, key: str) -> float:
        """Size of an effect on this gearbox."""
        return self.model.size(key, self.box.name)

    def all(self, run: Gearbox, room: float, t: np.ndarray, surface: np.ndarray) -> tuple[np.ndarray, ...]:
        """Coefficient [W/(m2 K)], temperature outside [K] and offset of the fluid [K] of every film."""
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
        for group in ("bearing", "journal"):  # the film is colder than the oil that leaves it
            index = net.group_of[group]
            offset[index] = (self.c["film_weight"] - 1.0) * (t[net.fj[index]] - run.bearing_inlet)
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

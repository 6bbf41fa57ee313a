"""Heat of a gearbox with housing over a sump at one point: films, sources and the oil that passes the bearings."""

import math
from typing import Any

import numpy as np

from tests.virtual_rig import heat_films as films
from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.heat_coefficients import FilmModel
from tests.virtual_rig.heat_field import FieldModel, FieldState, spread
from tests.virtual_rig.heat_network import OUTSIDE, Loads, Solved
from tests.virtual_rig.losses_rig import Gearbox
from tests.virtual_rig.sump_losses import SumpLosses

BARE_PLATE = 0.3
"""Emissivity of a machined clamping field."""
LEVICH = 0.62
"""Nu = 0.62 Pr^(1/3) Re^(1/2) on R and omega R: laminar boundary layer of a disc at a large Prandtl number (V. G.
Levich, Physicochemical Hydrodynamics, 1962; Pr over 100, omega R^2/nu below 2e5)."""


class SumpFilms(FilmModel):
    """Films of a box over a sump."""

    def __init__(self, box: Box, model: SumpLosses) -> None:
        super().__init__(box, model)
        self.emissivity["field"] = BARE_PLATE

    def all(self, run: Gearbox, room: float, t: np.ndarray, surface: np.ndarray) -> tuple[np.ndarray, ...]:
        """Coefficient [W/(m2 K)], temperature outside [K] and offset of the fluid [K] of every film."""
        net = self.box.net
        film, offset = np.zeros(len(net.fi)), np.zeros(len(net.fi))
        air = room + self.size("ambient")
        outside = air + self.c["room_layers"] * net.fh
        layers = (self.c["layers"] + self.size("stratified_chamber")) * net.fh
        for group, index in net.group_of.items():
            if group.startswith(("out_", "field_")):
                self._room(group, index, run, surface, film, outside)
            elif group in ("shaft_out", "shaft_end"):
                outside[index] = air
                emissivity = self.emissivity["shaft"] * self.c["emissivity_shaft"]
                film[index] = self._shaft(group, index, run, 1.05)
                film[index] += films.radiation(emissivity, surface[index], outside[index])
            else:
                film[index] = self._of_oil(group, index, run)
                outside[index] = run.gear_inlet + (layers[index] if group == "splash" else 0.0)
        return film, outside, offset

    def _of_oil(self, group: str, index: np.ndarray, run: Gearbox) -> Any:
        c, s, oil = self.c, run.relative_speed, run.gear_oil
        usual = self.box.box["oil"]["sump_temperature"]
        thin = (oil.nu(run.gear_inlet) / oil.nu(usual)) ** -c["exponent_viscosity"] * (1.0 - oil.air)
        if group in ("bath", "splash"):
            lower = -min(self._level(), 0.0) / run.entry["housing"]["shaft_height"]
            value = c[f"film_{group}"] * s ** c[f"exponent_{group}"] * thin * (1.0 - 0.5 * lower)
            return value * (1.0 + self.size("film:oil"))
        if group == "rim":
            return c["film_rim"] * s ** c["exponent_rim"] * thin
        if group.startswith("gear_side_"):
            return self._side(group.removeprefix("gear_side_"), run)
        if group == "shaft_warm":
            mist = films.drum(
                run.speed[self.model.reference_shaft],
                self.box.box["bearings"]["pinion_front"]["diameter"],
                1.0,
            )
            return c["film_drum"] * mist * (1.0 + self.size("film:shafts"))
        if group == "end_seal":
            return c["film_seal_end"] * (1.0 + self.size("film:shafts"))
        entry = next(iter(run.entry["bearings"].values()))
        ring = ("outer_raceway", "outside") if group == "bearing" else ("inner_raceway", "diameter")
        share = (
            entry[ring[0]] / entry[ring[1]]
        )  # the film acts on the raceway, the cell has the area of the seat
        key = "raceway_outer" if group == "bearing" else "raceway_inner"
        return c[key] * share * (1.0 + self.size("bearing_film"))

    def _level(self) -> float:
        """Oil over the axes [m]."""
        return float(self.box.box["oil"]["level"] + self.c["level"] + self.size("oil_level"))

    def _side(self, gear: str, run: Gearbox) -> float:
        """Side of a gear: the boundary layer of a disc in oil over the share of the turn that it is in the oil."""
        entry, mesh, oil = run.entry["gears"][gear], run.meshes[0], run.gear_oil
        radius = mesh.path.pitch_radius * (1.0 if gear == mesh.pinion else mesh.path.ratio)
        speed, nu, k = run.speed[entry["shaft"]], oil.nu(run.gear_inlet), oil.k(run.gear_inlet)
        prandtl = nu * oil.rho(run.gear_inlet) * oil.cp(run.gear_inlet) / k
        wetted = math.acos(min(max(-self._level() / radius, -1.0), 1.0)) / math.pi
        value = LEVICH * k * prandtl ** (1.0 / 3.0) * math.sqrt(speed / nu)
        return float(self.c["side_share"] * wetted * value * (1.0 + self.size("film:sides")))


class SumpField(FieldModel):
    """One gearbox over its sump, with its field, constants and effects."""

    model: SumpLosses

    def __init__(self, box: Box, model: SumpLosses) -> None:
        self.box, self.model, self.c = box, model, model.c
        self.films = SumpFilms(box, model)

    def _joint(self, name: str, run: Gearbox) -> float:
        if name != "flank":
            return super()._joint(name, run)
        return 1.0 / (
            self.c["flank_contact"] * run.relative_speed**0.5 * max(run.relative_torque, 0.01) ** 0.25
        )

    def _guess(self, run: Gearbox, room: float) -> np.ndarray:
        guess = np.full(self.box.net.size, 0.8 * run.gear_inlet + 0.2 * room)
        for name in run.entry["bearings"]:
            guess[self.box.oil[f"film_{name}"]] = run.gear_inlet + 10.0
        return guess

    def _sources(self, run: Gearbox, t: np.ndarray, source: np.ndarray) -> dict[str, float]:
        """Losses placed on cells, what the sump takes left out; returns what the motor pays by name."""
        box, model, split = self.box, self.model, run.entry["heat_split"]
        paid: dict[str, float] = {}
        for name in run.entry["bearings"]:
            cell = box.oil[f"film_{name}"]
            paid[f"bearing:{name}"] = model.bearing(run, name, t[cell])
            source[cell] += paid[f"bearing:{name}"]
        for mesh in run.meshes:
            rims = box.rim[mesh.pinion], box.rim[mesh.wheel]
            loss = model.mesh(run, mesh, 0.5 * run.gear_inlet + 0.25 * (t[rims[0]] + t[rims[1]]))
            paid[f"mesh:{mesh.name}"] = loss
            paid[f"vibration:{mesh.name}"] = model.vibration(run, mesh)
            first = 0.5 * self.c["pinion_share"]
            source[rims[0]] += loss * self.c["into_gears"] * first
            source[rims[1]] += loss * self.c["into_gears"] * (1.0 - first)
            paid |= {f"churning:{gear}": power for gear, power in model.churning(run, mesh)}
        for shaft in box.shafts:
            paid[f"seal:{shaft}"] = power = model.lips(run, shaft)
            source[box.ends[shaft]] += power * split["seal_into_shaft"]
            spread(source, box.bore["end_rear", shaft], power * split["seal_into_housing"])
        self._hidden_sources(run, source, paid)
        return paid

    def _streams(self, run: Gearbox, entry: np.ndarray) -> list[tuple[int, int, float]]:
        """Oil of the sump that passes each bearing."""
        oil = run.gear_oil
        flow = self.c["bearing_flow"] * run.relative_speed
        capacity = flow * oil.rho(run.gear_inlet) * oil.cp(run.gear_inlet)
        streams = []
        for name in run.entry["bearings"]:
            cell = self.box.oil[f"film_{name}"]
            entry[cell] += capacity * run.gear_inlet
            streams.append((cell, OUTSIDE, capacity))
        return streams

    def _state(
        self, run: Gearbox, solved: Solved, loads: Loads, losses: dict[str, float], passes: int
    ) -> FieldState:
        return FieldState(
            temperature=solved.temperature, surface=solved.surface, losses=losses, imbalance=solved.imbalance,
            passes=passes, outlets={"gear_oil": run.gear_inlet}, film_heat=solved.film_heat,
        )  # fmt: skip

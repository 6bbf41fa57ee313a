"""Losses of all gearboxes of a rig at given temperatures: what each part takes from the motor, and speeds and loads."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tests.virtual_rig.case_reader import value_at
from tests.virtual_rig.heat_effects import effect_of
from tests.virtual_rig.losses_mesh import Friction, Path, mesh_power, path_of_contact
from tests.virtual_rig.losses_parts import (
    bearing_power,
    gap_seal_power,
    jet_power,
    windage_power,
)
from tests.virtual_rig.losses_vibration import vibrating_mesh, vibration_power
from tests.virtual_rig.oil_data import OilData, oil_of

TOOTH_DEPTH = 2.25e-3
"""Depth of the teeth that the rim drag counts for [m]; spaces twice as deep pump twice as much mist."""
WEIGHT = 20.0
"""Load of a journal bearing without torque [N]."""


@dataclass(frozen=True, kw_only=True)
class Mesh:
    """One mesh as it runs."""

    name: str
    path: Path
    pinion: str
    wheel: str
    speed: float
    """Of its pinion [rad/s]."""
    torque: float
    """On its pinion [N m]."""
    roughness: float


@dataclass(frozen=True, kw_only=True)
class Gearbox:
    """One gearbox at one operating point: oils as they are, flows, inlets, speeds and loads."""

    name: str
    entry: Mapping[str, Any]
    gear_oil: OilData
    bearing_oil: OilData
    gear_flow: float
    """All meshes [m3/s]."""
    bearing_flow: float
    """One bearing [m3/s]."""
    gear_inlet: float
    bearing_inlet: float
    speed: Mapping[str, float]
    """By shaft [rad/s]."""
    load: Mapping[str, float]
    """By bearing [N]."""
    meshes: tuple[Mesh, ...]
    relative_speed: float
    """Speed over the test speed of the case."""
    relative_torque: float
    relative_flow: float

    @property
    def gear_capacity(self) -> float:
        """Heat capacity flow of the gear oil [W/K]."""
        return self.gear_oil.rho(self.gear_inlet) * self.gear_flow * self.gear_oil.cp(self.gear_inlet + 5.0)

    @property
    def bearing_capacity(self) -> float:
        """Heat capacity flow of the oil of one bearing, mean feed [W/K]."""
        oil, inlet = self.bearing_oil, self.bearing_inlet
        return oil.rho(inlet) * self.bearing_flow * oil.cp(inlet + 10.0)


class LossModel:
    """Speeds, loads and losses of a rig from its case, constants and effects."""

    def __init__(
        self, tree: Mapping[str, Any], constants: Mapping[str, float], effects: Mapping[str, float]
    ) -> None:
        self.tree, self.c = tree, constants
        self.effects: dict[tuple[str, str], float] = {}
        for name, size in effects.items():
            _, key, gearbox = effect_of(name)
            self.effects[key, gearbox] = self.effects.get((key, gearbox), 0.0) + size
        self.ratio = _speeds(tree)
        counted = str(value_at(tree, "drivetrain.torque_at", "test.pinion"))
        box, gear = counted.split(".")
        self.reference_shaft = tree["gearboxes"][box]["gears"][gear]["shaft"]
        self.test_speed = float(value_at(tree, "schedule.test_speed"))
        self.test_torque = float(value_at(tree, "schedule.test_torque"))
        self.paths = {
            (name, mesh): path_of_contact(box, entry)
            for name, box in tree["gearboxes"].items()
            for mesh, entry in box["meshes"].items()
        }
        self.vibrating = {(name, mesh): vibrating_mesh(tree, name, mesh) for name, mesh in self.paths}

    def size(self, key: str, gearbox: str) -> float:
        """Size of an effect on a gearbox; zero where it is not."""
        return self.effects.get((key, gearbox), 0.0)

    def gearbox(self, name: str, point: Mapping[str, Any]) -> Gearbox:
        """One gearbox at a point (speed [rad/s], torque [N m], flow, inlet_temperature by ``gearbox.stream``)."""
        entry = self.tree["gearboxes"][name]
        base = self.ratio[self.reference_shaft]
        speed = {s: float(point["speed"]) * r / base for s, r in self.ratio.items()}
        flows, inlets = point.get("flow", {}), point.get("inlet_temperature", {})
        oils = {}
        for stream in ("oil", "bearing_oil"):
            c = self.c
            oils[stream] = oil_of(self.tree, entry[stream]["oil"]).changed(
                viscosity=c["oil_viscosity"] * (1.0 + self.size("oil_viscosity", name)), index=c["oil_index"],
                density=c["oil_density"], conductivity=c["oil_conductivity"], air=self.size("aeration", name),
                heat_capacity=c["oil_heat_capacity"] * (1.0 + self.size("oil_heat_capacity", name)),
            )  # fmt: skip
        meshes = tuple(self._mesh(name, mesh, float(point["torque"]), speed) for mesh in entry["meshes"])
        gear_flow = flows.get(f"{name}.gear_oil", entry["oil"]["flow"])
        return Gearbox(
            name=name, entry=entry, gear_oil=oils["oil"], bearing_oil=oils["bearing_oil"],
            gear_flow=gear_flow * len(meshes),
            bearing_flow=flows.get(f"{name}.bearing_oil", entry["bearing_oil"]["flow"]),
            gear_inlet=inlets.get(f"{name}.gear_oil", entry["oil"]["inlet_temperature"]),
            bearing_inlet=inlets.get(f"{name}.bearing_oil", entry["bearing_oil"]["inlet_temperature"]),
            speed=speed, load=self._loads(entry, meshes), meshes=meshes,
            relative_speed=max(float(point["speed"]) / self.test_speed, 0.01),
            relative_torque=float(point["torque"]) / self.test_torque,
            relative_flow=gear_flow / entry["oil"]["flow"],
        )  # fmt: skip

    def feed_shares(self, box: Gearbox) -> dict[str, float]:
        """Share of the oil of all bearings that each gets."""
        raw = {
            name: (self.c["feed_front"] if entry["side"] == "front" else 1.0)
            * (self.c["feed_pinion"] if "pinion" in entry["shaft"] else 1.0)
            for name, entry in box.entry["bearings"].items()
        }
        return {name: value / sum(raw.values()) for name, value in raw.items()}

    def bearing(self, box: Gearbox, name: str, film: float) -> float:
        """Drag of a bearing [W]; ``film``: temperature at which its oil leaves [K]."""
        entry, c = box.entry["bearings"][name], self.c
        mean = box.bearing_inlet + c["film_weight"] * (film - box.bearing_inlet)
        clearance = 0.5 * entry["diametral_clearance"] * c.get(f"clearance_{box.name}", 1.0)
        power = bearing_power(
            box.bearing_oil.eta(mean), box.speed[entry["shaft"]], entry["diameter"], entry["width"], clearance,
            box.load[name], c["film_fill"],
        )  # fmt: skip
        power *= 1.0 + self.size("bearing_loss", box.name)
        if "wheel" in entry["shaft"] and entry["side"] == "rear":
            power += self.size("one_bearing", box.name) * box.relative_speed**2
        return power

    def mesh(self, box: Gearbox, mesh: Mesh, oil: float) -> float:
        """Sliding loss of a mesh [W] with the film between the teeth at ``oil`` [K]."""
        c = self.c
        friction = Friction(
            factor=c["friction"] * (1.0 + self.size("mesh_loss", box.name)), load=c["friction_load"],
            speed=c["friction_speed"], viscosity=c["friction_viscosity"],
        )  # fmt: skip
        lubricant = value_at(self.tree, "losses.friction.lubricant_factor", box.gear_oil.lubricant_factor)
        eta = box.gear_oil.eta(oil)
        return mesh_power(mesh.path, mesh.torque, mesh.speed, eta, mesh.roughness, lubricant, friction)

    def vibration(self, box: Gearbox, mesh: Mesh) -> float:
        """Loss in the damping between the flanks of a mesh [W]; a loop may have a damping of its own for each."""
        own = self.c.get(f"mesh_damping:{box.name}.{mesh.name}", self.c["mesh_damping"])
        damping = box.entry["meshes"][mesh.name]["damping"] * own
        radius = mesh.path.base_radius
        vibrating = self.vibrating[box.name, mesh.name]
        return vibration_power(vibrating, abs(mesh.torque) / radius, abs(mesh.speed) * radius, damping)

    def squeeze(self, box: Gearbox, mesh_loss: float) -> float:
        """Squeezing [W]: a share of the healthy mesh loss, and what the effect adds."""
        share = value_at(self.tree, "losses.squeeze_share", 0.0) * self.c["squeeze"]
        healthy = mesh_loss / (1.0 + self.size("mesh_loss", box.name))
        return healthy * (share + 0.05 * self.size("squeeze_loss", box.name))

    def jet(self, box: Gearbox) -> float:
        """Momentum of the jets [W]."""
        oil = box.entry["oil"]
        bypass = 1.0 - self.size("bypass", box.name)
        open_share = 1.0 - self.size("blocked_jet", box.name)
        mesh = box.meshes[0]
        power = jet_power(
            box.gear_flow * bypass, box.gear_oil.rho(box.gear_inlet), mesh.speed * mesh.path.pitch_radius,
            oil.get("jet_velocity", 0.0) * box.relative_flow / open_share, oil.get("jet_direction", "radial"),
        )  # fmt: skip
        return power * self.c["jet_carried"] * (1.0 + self.size("jet_loss", box.name))

    def mist(self, box: Gearbox) -> float:
        """Density of the mist in the chamber [kg/m3]."""
        density = value_at(self.tree, "losses.chamber_density", 1.2) * self.c["mist_density"]
        return float(density * box.relative_speed ** self.c["mist_exponent"])

    def windage(self, box: Gearbox, mesh: Mesh) -> tuple[float, float]:
        """Pinion and wheel in mist [W]."""
        powers = []
        for index, gear in enumerate((mesh.pinion, mesh.wheel)):
            entry = box.entry["gears"][gear]
            speed = box.speed[entry["shaft"]]
            tip = mesh.path.tip_radii[index]
            drag = self.c["rim_drag"] * mesh.path.depths[index] / TOOTH_DEPTH
            powers.append(windage_power(speed, tip, entry["face_width"], self.mist(box), drag))
        factor = 1.0 + self.size("windage_loss", box.name)
        return powers[0] * factor, powers[1] * factor

    def seals(self, box: Gearbox, shaft: str) -> tuple[float, float]:
        """Partition seals and end seals of a shaft [W]."""
        house = box.entry.get("housing")
        seal = next((s for s in box.entry.get("seals", {}).values() if s["shaft"] == shaft), None)
        if seal is None:
            return 0.0, 0.0
        speed, gap, density = box.speed[shaft], seal["radial_gap"], self.mist(box)
        bearing = next(b for b in box.entry["bearings"].values() if b["shaft"] == shaft)
        diameter, length, ends, end_length = bearing["diameter"], 0.015, 0, 0.0
        if house is not None:
            diameter, length = house["shafts"][shaft]["seal_diameter"], house["partition_thickness"]
            ends = sum(
                house["shafts"][shaft].get(f"overhang_{side}", 0.0) > 0.0 for side in ("front", "rear")
            )
            end_length = house.get("end_seal_width", 0.006)
        factor = self.c["seal_drag"]
        inner = 2.0 * factor * gap_seal_power(speed, diameter, length, gap, density)
        outer = ends * factor * gap_seal_power(speed, bearing["diameter"], end_length, gap, density)
        rubbing = self.size("seal_loss", box.name) * box.relative_speed / len(box.entry["seals"])
        return inner + rubbing, outer

    def _mesh(self, name: str, mesh: str, torque: float, speed: Mapping[str, float]) -> Mesh:
        box = self.tree["gearboxes"][name]
        entry = box["meshes"][mesh]
        gears = box["gears"]
        shaft = gears[entry["pinion"]]["shaft"]
        # a closed loop: power through every shaft is the same but for the losses
        factor = self.ratio[self.reference_shaft] / self.ratio[shaft]
        return Mesh(
            name=mesh, path=self.paths[name, mesh], pinion=entry["pinion"], wheel=entry["wheel"], speed=speed[shaft],
            torque=torque * factor, roughness=gears[entry["pinion"]].get("flank_roughness", 0.5e-6),
        )  # fmt: skip

    def _loads(self, entry: Mapping[str, Any], meshes: tuple[Mesh, ...]) -> dict[str, float]:
        loads = dict.fromkeys(entry["bearings"], WEIGHT)
        for mesh in meshes:
            force = abs(mesh.torque) / mesh.path.base_radius
            for gear in (mesh.pinion, mesh.wheel):
                shaft, at = entry["gears"][gear]["shaft"], entry["gears"][gear].get("position")
                pair = [(n, b) for n, b in entry["bearings"].items() if b["shaft"] == shaft]
                (front, a), (rear, b) = sorted(pair, key=lambda item: item[1]["side"])
                share = (b["position"] - at) / (b["position"] - a["position"]) if at is not None else 0.5
                loads[front] = math.hypot(loads[front], share * force)
                loads[rear] = math.hypot(loads[rear], (1.0 - share) * force)
        return loads


def _speeds(tree: Mapping[str, Any]) -> dict[str, float]:
    """Speed of every shaft over that of the first, through meshes and couplings."""
    ways: list[tuple[str, str, float]] = []
    for box in tree["gearboxes"].values():
        for mesh in box["meshes"].values():
            one, two = box["gears"][mesh["pinion"]], box["gears"][mesh["wheel"]]
            ways.append((one["shaft"], two["shaft"], one["teeth"] / two["teeth"]))
    couplings = value_at(tree, "drivetrain.couplings", {}).values()
    ways.extend((*coupling["shafts"], 1.0) for coupling in couplings)
    ratio = {ways[0][0]: 1.0}
    for _ in range(len(ways)):
        for one, two, factor in ways:
            if one in ratio:
                ratio.setdefault(two, ratio[one] * factor)
            elif two in ratio:
                ratio.setdefault(one, ratio[two] / factor)
    return ratio

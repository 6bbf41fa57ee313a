"""Losses of a rig whose gears dip into sumps, at a point; names as in `losses_rig`."""

from collections.abc import Iterator, Mapping
from typing import Any

from tests.virtual_rig.fzg_drawing import LIPS
from tests.virtual_rig.losses_rig import Gearbox, LossModel, Mesh
from tests.virtual_rig.losses_sump import Dipped, churning_power, lip_seal_power, roller_bearing_torque
from tests.virtual_rig.oil_data import oil_of

WARMER_FILM, WARMER_BEARING = 15.0, 8.0
"""Oil between the teeth and in the bearings of a gearbox that is not solved, over its sump at test torque [K]."""


class SumpLosses(LossModel):
    """Speeds, loads and losses of a rig with sumps."""

    def gearbox(self, name: str, point: Mapping[str, Any]) -> Gearbox:
        """One gearbox at a point; both its oils are that of the sump, which does not flow."""
        entry, c = self.tree["gearboxes"][name], self.c
        base = self.ratio[self.reference_shaft]
        speed = {shaft: float(point["speed"]) * r / base for shaft, r in self.ratio.items()}
        sump = point.get("inlet_temperature", {}).get(f"{name}.gear_oil", entry["oil"]["sump_temperature"])
        oil = oil_of(self.tree, entry["oil"]["oil"]).changed(
            viscosity=c["oil_viscosity"] * (1.0 + self.size("oil_viscosity", name)), index=c["oil_index"],
            density=c["oil_density"], conductivity=c["oil_conductivity"], air=self.size("aeration", name),
            heat_capacity=c["oil_heat_capacity"],
        )  # fmt: skip
        meshes = tuple(self._mesh(name, mesh, float(point["torque"]), speed) for mesh in entry["meshes"])
        return Gearbox(
            name=name, entry=entry, gear_oil=oil, bearing_oil=oil, gear_flow=0.0, bearing_flow=0.0, gear_inlet=sump,
            bearing_inlet=sump, speed=speed, load=self._loads(entry, meshes), meshes=meshes,
            relative_speed=max(float(point["speed"]) / self.test_speed, 0.01),
            relative_torque=float(point["torque"]) / self.test_torque, relative_flow=1.0,
        )  # fmt: skip

    def bearing(self, box: Gearbox, name: str, film: float) -> float:
        """Friction of a roller bearing [W] with its oil at ``film`` [K]."""
        entry, c = box.entry["bearings"][name], self.c
        speed = box.speed[entry["shaft"]]
        torque = roller_bearing_torque(
            box.load[name], speed, box.bearing_oil.nu(film) * (1.0 + box.bearing_oil.air),
            0.5 * (entry["diameter"] + entry["outside"]), c["bearing_free"], c["bearing_load"],
        )  # fmt: skip
        power = torque * speed * (1.0 + self.size("bearing_loss", box.name))
        if name == "wheel_rear":
            power += self.size("one_bearing", box.name) * box.relative_speed**2
        return power

    def churning(self, box: Gearbox, mesh: Mesh) -> Iterator[tuple[str, float]]:
        """Gears of a mesh with what the sump takes from each [W]."""
        oil, sump = box.gear_oil, box.gear_inlet
        level = box.entry["oil"]["level"] + self.c["level"] + self.size("oil_level", box.name)
        factor = self.c["churning"] * box.relative_speed ** self.c["churning_pair"]
        factor *= 1.0 + self.size("churning_loss", box.name)
        for index, gear in enumerate((mesh.pinion, mesh.wheel)):
            entry = box.entry["gears"][gear]
            radius = mesh.path.pitch_radius * (1.0, mesh.path.ratio)[index]
            dipped = Dipped(radius=radius, width=entry["face_width"], level=level)
            power = churning_power(dipped, box.speed[entry["shaft"]], oil.rho(sump), oil.nu(sump))
            yield gear, factor * power

    def lips(self, box: Gearbox, shaft: str) -> float:
        """Lip seals of a shaft [W]."""
        diameter = next(b for b in box.entry["bearings"].values() if b["shaft"] == shaft)["diameter"]
        one = lip_seal_power(diameter, box.speed[shaft], box.gear_inlet, box.gear_oil.nu_40)
        rubbing = self.size("seal_loss", box.name) * box.relative_speed / len(box.entry["gears"])
        return LIPS[shaft] * one * self.c["lip_drag"] + rubbing

    def bulk_temperatures(self, box: str, warm: Mapping[str, Any]) -> tuple[float, float]:
        """Gears and housing of a gearbox [K]; of one that is not solved from the one that is.

        warm : answer of the heat part. Gears that are not solved stand over their sump as the losses of their teeth
        over the width do; the housing follows its sump.
        """
        solved = next(name for name, entry in self.tree["gearboxes"].items() if "housing" in entry)
        own = warm["temperatures"]
        shafts = [entry["shaft"] for entry in self.tree["gearboxes"][solved]["gears"].values()]
        gears = sum(own[f"{solved}.gear_{shaft}"] for shaft in shafts) / len(shafts)
        housing = own[f"{solved}.housing"]
        if box == solved:
            return gears, housing
        here, there = (warm["oil_outlets"][f"{name}.gear_oil"] for name in (solved, box))
        heat = [
            warm["losses"][f"{name}.mesh:main"] / self.paths[name, "main"].width for name in (solved, box)
        ]
        return there + (gears - here) * heat[1] / heat[0], there + (housing - here)

    def sump(self, run: Gearbox) -> dict[str, float]:
        """Losses of a gearbox that is not solved."""
        warm = run.gear_inlet + WARMER_BEARING * run.relative_torque
        found = {f"bearing:{name}": self.bearing(run, name, warm) for name in run.entry["bearings"]}
        for mesh in run.meshes:
            film = run.gear_inlet + WARMER_FILM * run.relative_torque
            found[f"mesh:{mesh.name}"] = self.mesh(run, mesh, film)
            found[f"vibration:{mesh.name}"] = self.vibration(run, mesh)
            found |= {f"churning:{gear}": power for gear, power in self.churning(run, mesh)}
        shafts = dict.fromkeys(b["shaft"] for b in run.entry["bearings"].values())
        return found | {f"seal:{shaft}": self.lips(run, shaft) for shaft in shafts}

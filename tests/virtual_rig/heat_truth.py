"""The heat of a rig as it truly is: temperatures anywhere, oil outlets, motor power, for any constants and effects.

tree = read_case("cases/uhcf_prototype/case.toml")
truth = HeatTruth(tree, draw_constants(rng), {"film:test.chamber_oil": 0.4})
answer = truth.solve({"speed": 1256.6, "torque": 180.0}, {"TC01": (0.12, 0.0, 0.28)})
"""

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from tests.virtual_rig.case_reader import read_case, value_at
from tests.virtual_rig.fzg_drawing import dips, drawn
from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.heat_constants import nominal
from tests.virtual_rig.heat_field import FieldModel, FieldState
from tests.virtual_rig.heat_places import body_temperatures, temperature_at
from tests.virtual_rig.losses_rig import Gearbox, LossModel
from tests.virtual_rig.sump_box import SumpBox
from tests.virtual_rig.sump_field import SumpField
from tests.virtual_rig.sump_losses import SumpLosses

Point = Mapping[str, Any]
"""speed [rad/s] and torque [N m] where the case counts them; inlet_temperature [K] and flow [m3/s] by
``gearbox.stream``; ambient_temperature [K]. All but speed and torque may be left out: as in the case."""


class HeatTruth:
    """One rig, its constants and hidden effects fixed; the boxes may be shared between rigs of one case."""

    def __init__(self, tree: Mapping[str, Any], constants: Mapping[str, float] | None = None,
                 effects: Mapping[str, float] | None = None, *, boxes: Mapping[str, Box] | None = None,
                 refine: int = 1) -> None:  # fmt: skip
        self.tree = tree
        self.constants = dict(nominal() if constants is None else constants)
        self.effects = dict(effects or {})
        self.model = (SumpLosses if dips(tree) else LossModel)(tree, self.constants, self.effects)
        self.boxes = dict(boxes if boxes is not None else boxes_of(tree, refine))
        self.fields = {name: _field(self._own(box), self.model) for name, box in self.boxes.items()}

    def solve(self, point: Point, places: Mapping[str, tuple[float, float, float]] | None = None,
              start: Mapping[str, np.ndarray] | None = None) -> dict[str, Any]:  # fmt: skip
        """Answer of the rig at a point.

        places : thermocouples by name, coordinates [m] on outer faces of the first gearbox with housing
        start : ``state`` of an answer nearby, to save passes

        Returns ``thermocouples``, ``temperatures`` (bodies and surfaces, ``test.gear_test_pinion``),
        ``oil_outlets`` [K], ``motor_power`` [W], ``drive_torque`` [N m], ``losses`` [W] by
        ``gearbox.kind:part``, ``imbalance`` by gearbox, ``state`` for the next ``start``, ``passes``.
        """
        room = point.get("ambient_temperature") or value_at(self.tree, "ambient.temperature", 293.15)
        answer: dict[str, Any] = {
            "thermocouples": {}, "temperatures": {}, "oil_outlets": {}, "losses": {}, "imbalance": {},
            "state": {}, "passes": {},
        }  # fmt: skip
        for name in self.tree["gearboxes"]:
            run = self.model.gearbox(name, point)
            if name in self.fields:
                state = self.fields[name].solve(run, room, (start or {}).get(name))
                self._read(name, state, places or {}, answer)
                losses, outlets = state.losses, state.outlets
            elif isinstance(self.model, SumpLosses):
                losses, outlets = self.model.sump(run), {"gear_oil": run.gear_inlet}
            else:
                losses, outlets = self._lumped(run, room)
            answer["losses"] |= {f"{name}.{kind}": power for kind, power in losses.items()}
            answer["oil_outlets"] |= {f"{name}.{stream}": value for stream, value in outlets.items()}
        answer["motor_power"] = sum(answer["losses"].values())
        answer["drive_torque"] = answer["motor_power"] / self._motor_speed(point)
        return answer

    def _read(self, name: str, state: FieldState, places: Mapping[str, tuple[float, float, float]],
              answer: dict[str, Any]) -> None:  # fmt: skip
        box = self.boxes[name]
        bodies = body_temperatures(box, state.temperature, state.surface)
        answer["temperatures"] |= {f"{name}.{place}": value for place, value in bodies.items()}
        if not answer["thermocouples"]:
            answer["thermocouples"] = {
                key: temperature_at(box, state.surface, at) for key, at in places.items()
            }
        answer["imbalance"][name] = state.imbalance
        answer["state"][name] = state.temperature
        answer["passes"][name] = state.passes

    def _lumped(self, run: Gearbox, room: float) -> tuple[dict[str, float], dict[str, float]]:
        """Losses and outlets of a gearbox without a field; its walls lose a little to the room."""
        model, size = self.model, lambda key: self.model.size(key, run.name)
        losses: dict[str, float] = {}
        feed, bearings = model.feed_shares(run), run.entry["bearings"]
        whole = run.bearing_capacity * len(bearings)
        walls = self.constants.get(f"wall_loss_{run.name}", 0.0)
        outflow = 0.0
        for name in bearings:
            capacity, film = feed[name] * whole, run.bearing_inlet + 10.0
            for _ in range(200):
                power = model.bearing(run, name, film)
                better = run.bearing_inlet + power / capacity
                if abs(better - film) < 1e-9:
                    break
                film = better
            losses[f"bearing:{name}"] = power
            outflow += capacity * film
        oil, warm = run.gear_inlet, 0.0
        for mesh in run.meshes:
            loss = model.mesh(run, mesh, run.gear_inlet + 15.0 * run.relative_torque)
            losses[f"mesh:{mesh.name}"], losses[f"squeeze:{mesh.name}"] = loss, model.squeeze(run, loss)
            losses[f"vibration:{mesh.name}"] = model.vibration(run, mesh)
            for gear, power in zip((mesh.pinion, mesh.wheel), model.windage(run, mesh), strict=True):
                losses[f"windage:{gear}"] = power
        losses["jet"] = model.jet(run)
        outer = 0.0
        for shaft in dict.fromkeys(b["shaft"] for b in bearings.values()):
            inner, end = model.seals(run, shaft)
            losses[f"seal:{shaft}"] = inner + end
            outer += end
        warm = sum(power for kind, power in losses.items() if not kind.startswith("bearing")) - outer
        gear_capacity = run.gear_capacity
        heat = warm + size("pump_heat") + size("heated_inlet")
        gear = oil + (heat - walls * (oil - room)) / gear_capacity
        cold = (outflow + outer - walls * (run.bearing_inlet - room)) / whole
        leak = size("leak_warm_cold") * gear_capacity
        cold = (whole * cold + leak * gear) / (whole + leak)
        return losses, {"gear_oil": gear, "bearing_oil": cold}

    def _motor_speed(self, point: Point) -> float:
        shaft = value_at(self.tree, "drivetrain.motor.shaft", self.model.reference_shaft)
        ratio = self.model.ratio
        return max(abs(float(point["speed"])) * ratio[shaft] / ratio[self.model.reference_shaft], 1e-9)

    def _own(self, box: Box) -> Box:
        """The box with the conductivities of this rig; everything else is shared."""
        own = object.__new__(type(box))
        own.__dict__.update(box.__dict__)
        net = object.__new__(type(box.net))
        net.__dict__.update(box.net.__dict__)
        net.k_cell = box.net.k_cell.copy()
        for body, cells in box.bodies.items():
            key = "k_housing" if body == "housing" else "k_field" if body == "field" else "k_shafts"
            net.k_cell[cells] *= self.constants[key]
        own.net = net
        return own


def _field(box: Box, model: LossModel) -> FieldModel:
    return SumpField(box, model) if isinstance(model, SumpLosses) else FieldModel(box, model)


def boxes_of(tree: Mapping[str, Any], refine: int = 1) -> dict[str, Box]:
    """Cells of every gearbox with housing; share them between the rigs of a case."""
    kind = SumpBox if dips(tree) else Box
    return {name: kind(tree, name, refine) for name, box in tree["gearboxes"].items() if "housing" in box}


@lru_cache(maxsize=8)
def rig(path: str | Path) -> tuple[dict[str, Any], dict[str, Box]]:
    """Tree and boxes of a case file, built once."""
    tree = drawn(read_case(path))
    return tree, boxes_of(tree)

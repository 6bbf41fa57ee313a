"""Shipped loops with deviations, braced without heat, for the tests of orders: shafts that twist, bend, are locked."""

from dataclasses import dataclass, replace
from functools import cache
from math import pi
from typing import Literal

import numpy as np

from dynamics.rotor.bearing_state import isotropic_bearing
from dynamics.rotor.freedoms import FAMILIES
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.reduction import reduce_rig
from rigdesign import load_case
from rigdesign.case import Case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.mesh_models import MeshModel, mesh_models
from rigdesign.coupling.preloaded_loop import BracingState, LoadedCircuit, brace_initial
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.full import modelled_rig
from rigdesign.prediction.model import Channel, PredictionModel
from rigdesign.rig.model import Rig


@cache
def shipped(name: str) -> Case:
    return load_case(f"cases/{name}")


def changed(name: str, **values: object) -> Case:
    """The case with values by path; dots of a path stand as double underscores."""
    case = shipped(name)
    for path, value in values.items():
        case = case.with_value(path.replace("__", "."), value)
    return case


@dataclass(frozen=True)
class BracedCase:
    rig: Rig
    point: OperatingPoint
    models: tuple[MeshModel, ...]
    setting: BracingState
    system: LinearSystem

    @property
    def arguments(self):
        return self.rig, LoadedCircuit(self.point, self.models, self.drags, self.setting, self.system)

    @property
    def drags(self) -> dict[str, float]:
        first, *_, last = self.rig.case.gearboxes
        return {f"{first}.pinion": 0.4, f"{last}.wheel": 0.6}


def settled(
    case: Case, rpm: float, torque: float, shafts: Literal["torsional", "elastic", "locked"] = "torsional"
) -> BracedCase:
    """locked : shafts in six degrees of freedom, held in all but their turns."""
    model = PredictionModel(shafts="torsional" if shafts == "torsional" else "elastic")
    rig = modelled_rig(case, "quick", model)
    if shafts == "locked":
        lock(rig)
    point = OperatingPoint(stage="test", speed=rpm * pi / 30.0, torque=torque)
    cold = initial_state(rig, point)
    models = mesh_models(rig, point, cold)
    system = loop_system(rig, point, cold, solve_bearings(rig, point, cold))
    return BracedCase(rig, point, models, brace_initial(rig, point, cold, models, system), system)


def lock(rig: Rig) -> None:
    """Hold a rig in everything but its turns: of its modes those that turn alone are left, all of them."""
    model = rig.elastic.model
    reference = {bearing.name: isotropic_bearing(1e8) for bearing in rig.elastic.rig.drivetrain.bearings}
    whole = reduce_rig(model, reference)
    sideways = np.flatnonzero(np.array(model.freedoms.family) != FAMILIES.index("torsion"))
    own = np.flatnonzero(~np.any(whole.basis[sideways], axis=0))
    block = np.ix_(own, own)
    held = replace(
        whole,
        basis=whole.basis[:, own],
        squared=whole.squared[own],
        damping=whole.damping[block],
        gyroscopic=whole.gyroscopic[block],
        circulation=whole.circulation[block],
        drag=whole.drag[block],
        ports={name: port[:, own] for name, port in whole.ports.items()},
        components=whole.components[own],
        attached=whole.attached[own],
    )
    rig.elastic.__dict__["reduced"] = held


def channels(*orders: float) -> tuple[Channel, ...]:
    return (
        Channel(name="wheel side", quantity="torque", place="wheel_side", orders=orders),
        Channel(name="pinion side", quantity="torque", place="pinion_side", orders=orders),
        Channel(name="turn", quantity="angle", place="test_wheel", orders=orders),
    )

"""Shipped loops with deviations, braced without heat, for the tests of orders."""

from dataclasses import dataclass
from functools import cache
from math import pi

from rigdesign import load_case
from rigdesign.case import Case
from rigdesign.coupling.braced_loop import BracingState, LoadedCircuit, brace_initial
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.mesh_models import MeshModel, mesh_models
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.model import Channel
from rigdesign.rig.model import Rig, build_rig

DRAGS = {"test.pinion": 0.4, "reference.wheel": 0.6}


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

    @property
    def arguments(self):
        return self.rig, LoadedCircuit(self.point, self.models, DRAGS, self.setting, self.rig.system)


def settled(case: Case, rpm: float, torque: float) -> BracedCase:
    rig = build_rig(case, "quick")
    point = OperatingPoint(stage="test", speed=rpm * pi / 30.0, torque=torque)
    cold = initial_state(rig, point)
    return BracedCase(rig, point, mesh_models(rig, point, cold), brace_initial(rig, point, cold))


def channels(*orders: float) -> tuple[Channel, ...]:
    return (
        Channel(name="wheel side", quantity="torque", place="wheel_side", orders=orders),
        Channel(name="pinion side", quantity="torque", place="pinion_side", orders=orders),
        Channel(name="turn", quantity="angle", place="test_wheel", orders=orders),
    )

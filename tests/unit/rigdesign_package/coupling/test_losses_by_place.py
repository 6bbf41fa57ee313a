"""Losses by place against areas measured on the housing mesh, pitch lines drawn by hand and air from the tables."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.losses import chamber_mist, rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES
from thermal.fe.mesh import NamedMesh


@cache
def rig(name: str, *changes: tuple[str, object]) -> Rig:
    case = load_case(CASES / name)
    for path, value in changes:
        case = case.with_value(path, value)
    return build_rig(case, "quick")


def losses(built: Rig, speed: float, torque: float = 180.0) -> list[PlacedLoss]:
    """What turns at ``speed`` [rad/s] in the cold rig, bearings left out."""
    point = OperatingPoint(stage="x", speed=speed, torque=torque)
    coupling_state = initial_state(built, point)
    return rotating_losses(built, point, coupling_state, mesh_models(built, point, coupling_state), {})


def area(mesh: NamedMesh, surface: str) -> float:
    """Area of a surface by its corner triangles [m2]: a little less than that of the round one."""
    a, b, c = (mesh.points[mesh.surfaces[surface][:, i]] for i in range(3))
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def test_every_seal_of_the_drawing_drags_as_a_sheared_film_on_its_own_area() -> None:
    """Turning slowly, air in a gap s is sheared by v / s: eta v / s on every seal area of the mesh, times v.

    Four seals on the shaft that passes through both end walls, three on the one that ends behind a cover. Air of
    140 degC: 23.7e-6 Pa s (VDI Heat Atlas).
    """
    built, speed = rig("uhcf_prototype"), 3.0
    model = built.models["test"]
    found = {
        placed.part: placed.loss
        for placed in losses(built, speed)
        if placed.gearbox == "test" and placed.loss.kind == "seal"
    }
    for part, seals in built.case.gearboxes["test"].seals.items():
        stations = [station for station in model.seals if station.shaft == seals.shaft]
        assert len(stations) == {"pinion": 4, "wheel": 3}[part]
        omega = built.shaft_speed(seals.shaft, speed)
        drag = math.fsum(
            23.7e-6 * (0.5 * s.shaft_diameter * omega) ** 2 / s.radial_gap * area(model.mesh, s.shaft_surface)
            for s in stations
        )
        assert found[part].power == pytest.approx(drag, rel=0.05)


def test_jets_meet_both_gears_at_the_pitch_line() -> None:
    """16/25 teeth at 94 mm: pitch circles of 36.68 and 57.32 mm; radial oil leaves with twice its motion's energy."""
    built = rig("loop_hunting", ("gearboxes.test.oil.jet_direction", "radial"))
    box, speed = built.case.gearboxes["test"], 400.0
    jets = [
        p.loss
        for p in losses(built, speed, 300.0)
        if p.loss.kind == "oil_acceleration" and p.gearbox == "test"
    ]
    pinion = built.shaft_speed(box.gears["pinion"].shaft, speed) * 0.094 * 16.0 / 41.0
    wheel = built.shaft_speed(box.gears["wheel"].shaft, speed) * 0.094 * 25.0 / 41.0
    assert abs(pinion) == pytest.approx(abs(wheel), rel=1e-12)
    oil = built.oils[box.oil.oil]
    mass = oil.density(box.oil.inlet_temperature) * box.oil.flow
    assert [jet.power for jet in jets] == pytest.approx([2.0 * 0.5 * mass * pinion**2], rel=1e-3)


def test_mist_is_as_warm_as_its_oil_is_on_the_average() -> None:
    """Oil in at 140 and out at 60 degC: air of 100 degC, 21.9e-6 Pa s (VDI Heat Atlas)."""
    built = rig("uhcf_prototype")
    assert built.case.gearboxes["test"].oil.inlet_temperature == pytest.approx(413.15)
    coupling_state = initial_state(built, OperatingPoint(stage="x", speed=0.0, torque=180.0))
    coupling_state = replace(
        coupling_state, oil_outlet={**coupling_state.oil_outlet, "test.gear_oil": 333.15}
    )
    mist = chamber_mist(built, "test", coupling_state)
    assert mist.viscosity == pytest.approx(21.9e-6, rel=0.01)
    assert mist.density == 5.0  # what the case says of the oil in it

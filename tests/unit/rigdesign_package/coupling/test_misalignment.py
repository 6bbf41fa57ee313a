"""Couplings out of line load the bearings of both shafts as statics of the bent rig say."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.coupling.alignment import coupled_ends, coupling_places
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.misalignment import reactions, standing_load, warm_misalignment
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.elastic_rig import REFERENCE_STIFFNESS
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES
from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.expansion import expand

COUPLING = "drivetrain.couplings.wheel_side"
STIFF = {f"{COUPLING}.radial_stiffness": "2e7 N/m", f"{COUPLING}.angular_stiffness": "5e3 N m/rad"}
OUT = {
    f"{COUPLING}.cold_offset_vertical": "0.1 mm",
    f"{COUPLING}.cold_offset_lateral": "-0.05 mm",
    f"{COUPLING}.cold_angle_lateral": "0.6 mrad",
    f"{COUPLING}.cold_angle_vertical": "-0.4 mrad",
}
FIELDS = ("coupling_offset", "coupling_angle")


@cache
def rig(*keys: str) -> Rig:
    """The prototype at analytic teeth with a coupling that resists."""
    values = {"drivetrain.mesh_stiffness": "iso_6336_scaled"} | STIFF | {key: OUT[key] for key in keys}
    return build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "standard")


def cold(of: Rig) -> CouplingState:
    """Initial state, without torque."""
    (point, *_) = held_points(of)
    state = initial_state(of, point)
    return replace(state, mesh_torque=dict.fromkeys(state.mesh_torque, 0.0))


def forces(of: Rig, state: CouplingState | None = None) -> dict[str, np.ndarray]:
    """Force of the shaft on every bearing (2,) under its weight alone."""
    loads = bearing_loads(of, state or cold(of))
    return {name: np.array(load.force) for name, load in loads.items()}


def test_bearings_carry_what_the_coupling_presses() -> None:
    """By the lever rule from the forces at the coupling, against the springs of the bearings of the reduced rig."""
    straight, bent = rig(), rig(*OUT)
    reduced = bent.elastic.reduced
    moved = np.zeros(reduced.size)
    moved[reduced.n_rigid :] = (
        standing_load(bent, cold(bent))[reduced.n_rigid :] / reduced.squared[reduced.n_rigid :]
    )
    before, after = forces(straight), forces(bent)
    pressed = np.abs(reactions(bent, cold(bent))["wheel_side"][:2]).max()
    assert pressed > 100.0
    for name, port in reduced.ports.items():
        assert after[name] - before[name] == pytest.approx(
            REFERENCE_STIFFNESS * port[:2] @ moved, abs=2e-3 * pressed
        ), name


def test_shafts_give_way_to_a_stiff_coupling() -> None:
    """The coupling presses less than its stiffness times the offset, and not at all where axes are in line."""
    bent = rig(f"{COUPLING}.cold_offset_vertical")
    force = abs(reactions(bent, cold(bent))["wheel_side"][1])
    assert 0.2 * 2e7 * 0.1e-3 < force < 2e7 * 0.1e-3
    assert not np.any(standing_load(rig(), cold(rig())))


def test_warm_housings_load_a_coupling_as_if_it_had_been_set_up_so() -> None:
    """Offset and angle by thermal expansion add to those of the cold set-up, whichever of them makes the whole."""
    straight, bent = rig(), rig(*OUT)
    warm = replace(
        cold(straight),
        coupling_offset={"wheel_side.lateral": -0.05e-3, "wheel_side.vertical": 0.1e-3},
        coupling_angle={"wheel_side.lateral": 0.6e-3, "wheel_side.vertical": -0.4e-3},
    )
    for name, force in forces(bent).items():
        assert forces(straight, warm)[name] == pytest.approx(force, rel=1e-9, abs=1e-6), name
    undone = {field: {key: -value for key, value in getattr(warm, field).items()} for field in FIELDS}
    for name, force in forces(straight).items():
        assert forces(bent, replace(cold(bent), **undone))[name] == pytest.approx(force, rel=1e-9, abs=1e-6)


def test_a_heated_housing_lifts_its_shafts_out_of_line() -> None:
    """Of one temperature it lifts every axis by its height over the foot times the strain; its partner stays put."""
    own = rig()
    setup, model = own.expansion["test"], own.models["test"]
    reference, rise = own.case.ambient.reference_temperature, 60.0
    shape = expand(setup, np.full(len(model.mesh.points), reference + rise), reference)
    found = warm_misalignment(own, {"test": shape})
    assert set(found.offset) == set(cold(own).coupling_offset)
    assert set(found.angle) == set(cold(own).coupling_angle)
    points = model.mesh.points
    bore = points[model.mesh.surfaces["bearing_bore_test_pinion_front"].ravel(), 2]
    height = 0.5 * float(bore.min() + bore.max()) - float(points[:, 2].min())  # over the foot
    strain = own.materials["structural_steel"].expansion_coefficient * rise
    for coupling in ("pinion_side", "wheel_side"):
        lift = found.offset[f"{coupling}.vertical"]
        assert lift == pytest.approx(height * strain, rel=2e-3), coupling
        assert abs(found.angle[f"{coupling}.vertical"]) < 1e-6 * lift / np.ptp(points[:, 0])
    assert not any(warm_misalignment(own, {}).offset.values())


def test_a_gearbox_that_stands_the_other_way_round_moves_its_shafts_as_turned_about_z() -> None:
    """x and y of its housing change their sign in the rig, z does not: so do the lateral shift and the vertical slope;
    the record of the alignment has the same."""
    ends = {f"drivetrain.couplings.{name}.ends": ["end", "end"] for name in ("pinion_side", "wheel_side")}
    values = {"drivetrain.torque_at": "reference.pinion"} | STIFF | ends
    own = build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "standard")
    (place,) = (one for one in coupling_places(own) if one.name == "wheel_side")
    turned = place.first if place.first.gearbox else place.second
    assert own.axes[turned.shaft].direction == -1.0
    axis = ShaftAxis(name=turned.shaft, at=turned.x - 0.1, offset=(1e-4, 2e-4), slope=(1e-3, 3e-3))
    axes = {turned.shaft: axis, "test_pinion": replace(axis, name="test_pinion")}
    shape: Any = SimpleNamespace(axes=axes)
    found = warm_misalignment(own, {"test": shape})
    side = 1.0 if turned is place.first else -1.0
    assert side * found.offset["wheel_side.lateral"] == pytest.approx(-2e-4)
    assert side * found.offset["wheel_side.vertical"] == pytest.approx(5e-4)
    assert side * found.angle["wheel_side.lateral"] == pytest.approx(1e-3)
    assert side * found.angle["wheel_side.vertical"] == pytest.approx(-3e-3)
    record = coupled_ends(replace(place, offset=(0.0, 0.0)), {"test": axes})
    assert record.offset == (found.offset["wheel_side.lateral"], found.offset["wheel_side.vertical"])
    assert record.angle == (found.angle["wheel_side.lateral"], found.angle["wheel_side.vertical"])


def test_loads_of_another_state_are_found_anew() -> None:
    of = rig()
    state = cold(of)
    twisted = replace(state, mesh_torque=dict.fromkeys(state.mesh_torque, 100.0))
    still, first = bearing_loads(of, state), bearing_loads(of, twisted)
    assert bearing_loads(of, state) == still
    assert bearing_loads(of, twisted) == first
    assert all(first[name].radial > still[name].radial for name in still)

"""Couplings out of line load the bearings of both shafts as statics of the bent rig say."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.misalignment import reactions, standing_load
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.elastic_rig import REFERENCE_STIFFNESS
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

COUPLING = "drivetrain.couplings.wheel_side"
STIFF = {f"{COUPLING}.radial_stiffness": "2e7 N/m", f"{COUPLING}.angular_stiffness": "5e3 N m/rad"}
OUT = {
    f"{COUPLING}.cold_offset_vertical": "0.1 mm",
    f"{COUPLING}.cold_offset_lateral": "-0.05 mm",
    f"{COUPLING}.cold_angle_lateral": "0.6 mrad",
    f"{COUPLING}.cold_angle_vertical": "-0.4 mrad",
}


@cache
def rig(*keys: str) -> Rig:
    """The prototype at analytic teeth with a coupling that resists."""
    values = {"drivetrain.mesh_stiffness": "iso_6336_scaled"} | STIFF | {key: OUT[key] for key in keys}
    return build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "standard")


def forces(of: Rig) -> dict[str, np.ndarray]:
    """Force of the shaft on every bearing (2,) under its weight alone."""
    (point, *_) = held_points(of)
    state = initial_state(of, point)
    loads = bearing_loads(of, replace(state, mesh_torque=dict.fromkeys(state.mesh_torque, 0.0)))
    return {name: np.array(load.force) for name, load in loads.items()}


def test_bearings_carry_what_the_coupling_presses() -> None:
    """By the lever rule from the forces at the coupling, against the springs of the bearings of the reduced rig."""
    straight, bent = rig(), rig(*OUT)
    reduced = bent.elastic.reduced
    moved = np.zeros(reduced.size)
    moved[reduced.n_rigid :] = standing_load(bent)[reduced.n_rigid :] / reduced.squared[reduced.n_rigid :]
    before, after = forces(straight), forces(bent)
    pressed = np.abs(reactions(bent)["wheel_side"][:2]).max()
    assert pressed > 100.0
    for name, port in reduced.ports.items():
        assert after[name] - before[name] == pytest.approx(
            REFERENCE_STIFFNESS * port[:2] @ moved, abs=2e-3 * pressed
        ), name


def test_shafts_give_way_to_a_stiff_coupling() -> None:
    """The coupling presses less than its stiffness times the offset, and not at all where axes are in line."""
    bent = rig(f"{COUPLING}.cold_offset_vertical")
    force = abs(reactions(bent)["wheel_side"][1])
    assert 0.2 * 2e7 * 0.1e-3 < force < 2e7 * 0.1e-3
    assert not np.any(standing_load(rig()))

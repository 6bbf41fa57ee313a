"""Where gears stand under load, against the statics of all freedoms and a straight line through the journals."""

import numpy as np
import pytest

from dynamics.rotor.bearing_state import RunningState, isotropic_bearing
from rigdesign import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import bearing_coefficients, mesh_placements
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from tests.builders.static_deflection import static_deflection


def test_gears_stand_on_shafts_that_bend_between_journals_where_these_float() -> None:
    """Shafts on two films are statically determinate: bending on rigid bearings and the straight line through the
    static positions of the journals add up to the placement, whatever the stiffness of the films; to 1 % of 10 um."""
    rig = build_rig(load_case(CASES / "uhcf_prototype"), "standard")
    point = held_points(rig)[0]
    state = initial_state(rig, point)
    bearings = solve_bearings(rig, point, state)
    coefficients = bearing_coefficients(rig, state, bearings)
    model = rig.elastic.model
    load = model.weight()
    for mesh in rig.elastic.rig.drivetrain.meshes:
        pinion, wheel = rig.elastic.port_rows[mesh.name]
        load -= state.mesh_torque[mesh.name] * (pinion - mesh.base_radii[1] / mesh.base_radii[0] * wheel)
    stiff = {name: isotropic_bearing(1e13) for name in coefficients}
    bent = static_deflection(model, RunningState(speed=0.0, bearings=stiff), load).deflection
    for name, placement in mesh_placements(rig, point, state, bearings).items():
        at = []
        for full in rig.mesh_gears(name):
            rows = model.rows(full)
            turned = np.array([rows[1] @ bent, rows[2] @ bent, rows[5] @ bent, -rows[4] @ bent])
            assert rig.drivetrain is not None
            gear = rig.drivetrain.gear(full)
            axis = rig.axes[gear.shaft]
            own = [b for b in rig.drivetrain.bearings if b.shaft == gear.shaft]
            x = [axis.place(b.position) for b in own]
            first, second = (coefficients[b.name].position for b in own)
            slope = (second - first) / (x[1] - x[0])
            turned[:2] += first + slope * (axis.place(gear.position) - x[0])
            turned[2:] += slope
            at.append(turned)
        moved = at[1] - at[0]
        centres = rig.line_of_action(name).centres
        across = np.array([-centres[1], centres[0]])
        assert placement.apart == pytest.approx(centres @ moved[:2], abs=1e-7)
        assert placement.inclination == pytest.approx(centres @ moved[2:], abs=1e-6)
        assert placement.skew == pytest.approx(across @ moved[2:], abs=1e-6)
        assert abs(placement.apart) + abs(placement.approach) > 2e-6

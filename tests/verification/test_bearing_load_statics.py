"""Bearing loads by the lever rule against the reactions of the elastic rig's full matrices, and in balance."""

import numpy as np
import pytest

from dynamics.rotor.bearing_state import RunningState, isotropic_bearing
from rigdesign import load_case
from rigdesign.case import Case
from rigdesign.coupling.bearing_loads import bearing_loads, shaft_loads
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES
from tests.builders.static_deflection import static_deflection


def helical(hand: str, rotation: str) -> Case:
    """The strain gauge rig, its single-helical test gears with their hand stated.

    No coupling of it has lateral stiffness: every shaft is statically determinate.
    """
    case = load_case(CASES / "strain_gauge_rig").with_value("gearboxes.test.gears.pinion.helix_hand", hand)
    return case.with_value("gearboxes.*.rotation", rotation)


def loaded(case: Case) -> tuple[Rig, CouplingState]:
    rig = build_rig(case, "standard")
    return rig, initial_state(rig, held_points(rig)[0])


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("rotation", ["clockwise", "anticlockwise"])
def test_reactions_of_the_elastic_rig_are_the_loads_by_the_lever_rule(hand: str, rotation: str) -> None:
    """Both bearings of every shaft, tilting moment with its sign; to 1e-6 of the largest load."""
    rig, state = loaded(helical(hand, rotation))
    model, load = rig.elastic.model, rig.elastic.model.weight()
    for mesh in rig.elastic.rig.drivetrain.meshes:
        pinion, wheel = rig.elastic.port_rows[mesh.name]
        load -= state.mesh_torque[mesh.name] * (pinion - mesh.base_radii[1] / mesh.base_radii[0] * wheel)
    running = RunningState(
        speed=0.0,
        bearings={b.name: isotropic_bearing(1e9) for b in rig.elastic.rig.drivetrain.bearings},
    )
    bent = static_deflection(model, running, load).deflection
    loads = bearing_loads(rig, state)
    largest = max(one.radial for one in loads.values())
    for name, found in loads.items():
        reaction = 1e9 * model.ports[name][:2] @ bent
        assert found.force == pytest.approx(tuple(reaction), abs=1e-6 * largest)
        assert found.radial == pytest.approx(float(np.hypot(*reaction)), abs=1e-6 * largest)


def test_forces_and_moments_on_every_shaft_balance() -> None:
    rig, state = loaded(helical("left", "clockwise"))
    loads = bearing_loads(rig, state)
    for name, box in rig.case.gearboxes.items():
        for shaft in {gear.shaft for gear in box.gears.values()}:
            axis = rig.axes[shaft]
            force, moment = np.zeros(3), np.zeros(3)
            for one in shaft_loads(rig, name, shaft, state):
                assert one.position is not None
                acting = np.array([one.axial, *one.force])
                force += acting
                moment += np.cross([axis.place(one.position), *one.arm], acting)
            scale = float(np.linalg.norm(moment))
            for part, bearing in box.bearings.items():
                if bearing.shaft == shaft:
                    assert bearing.position is not None
                    held = -np.array([0.0, *loads[f"{name}.{part}"].force])
                    force += held
                    moment += np.cross([axis.place(bearing.position), 0.0, 0.0], held)
            assert force[1:] == pytest.approx([0.0, 0.0], abs=1e-9 * scale)
            assert moment[1:] == pytest.approx([0.0, 0.0], abs=1e-9 * scale)


def test_an_open_hand_is_rated_for_either() -> None:
    """Without a stated hand every bearing carries the larger of what both hands make."""
    case = load_case(CASES / "strain_gauge_rig")
    rig, state = loaded(case)
    either = [bearing_loads(*loaded(helical(hand, "clockwise"))) for hand in ("right", "left")]
    found = bearing_loads(rig, state)
    for name, load in found.items():
        assert load.radial == pytest.approx(max(one[name].radial for one in either), rel=1e-9)
        assert load.force == pytest.approx(either[0][name].force, rel=1e-9)
    one, other = (np.array([loads[name].radial for name in loads]) for loads in either)
    assert float(np.abs(one - other).max()) > 100.0

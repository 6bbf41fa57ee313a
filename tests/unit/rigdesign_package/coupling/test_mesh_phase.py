"""How the teeth of several meshes stand against each other, and what the tables of a mesh reach."""

from pathlib import Path

import numpy as np
import pytest

from dynamics.tooth.mesh_laws import reach_beyond
from rigdesign import load_case
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import mesh_models, mesh_phase
from rigdesign.coupling.preloaded_loop import LoadedCircuit, brace_initial, respond
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import build_rig
from tests.builders.idler_case import idler_case
from tests.builders.paths import CASES
from tests.builders.rig import prototype_laws

PROTOTYPE = CASES / "uhcf_prototype"


def test_an_idler_of_odd_teeth_meets_its_second_wheel_half_a_pitch_later(tmp_path: Path) -> None:
    rig = build_rig(load_case(idler_case(tmp_path, housing=True)), "quick")
    shift = mesh_phase(rig, MeshName("test", "right")) - mesh_phase(rig, MeshName("test", "left"))
    assert shift / rig.pairs["test.left"].base_pitch % 1.0 == pytest.approx(0.5, abs=1e-9)
    # nobody says where the axes of the other gearbox stand
    assert (
        mesh_phase(rig, MeshName("reference", "right"))
        == mesh_phase(rig, MeshName("reference", "left"))
        == 0.0
    )


def test_the_stated_phase_moves_k_v_at_a_resonance_and_not_the_torque() -> None:
    """Half a pitch in the reference gearbox at 2380 rpm, where both gearboxes take part."""
    factors = []
    for phase in (0.0, 0.5, 1.0):
        case = load_case(PROTOTYPE).with_value("gearboxes.reference.meshes.main.phase", phase)
        rig = build_rig(case, "quick")
        point = held_points(rig)[0]
        point = type(point)(stage=point.stage, speed=2380.0 * np.pi / 30.0, torque=point.torque)
        cold = initial_state(rig, point)
        models = mesh_models(rig, point, cold)
        factors.append(
            respond(
                rig, LoadedCircuit(point, models, {}, brace_initial(rig, point, cold), rig.system)
            ).dynamic_factor[1]
        )
    assert factors[2] == pytest.approx(factors[0], rel=1e-4)
    # fifty times what a whole pitch may move it
    assert abs(factors[1] - factors[0]) > 50.0 * 1e-4 * factors[0]


def test_approach_beyond_the_tables_is_told() -> None:
    law = prototype_laws()[0]
    limit = float(min(law.gap[:, 0].min(), law.gap[:, -1].min()))
    within = np.array([0.99 * limit, -law.backlash - 0.99 * limit])
    assert reach_beyond(law, within) == ""
    for beyond in (1.5 * limit, -law.backlash - 1.5 * limit):
        text = reach_beyond(law, np.array([0.0, beyond]))
        assert f"limit {1e6 * limit:.0f} um" in text
        assert "lower the torque" in text

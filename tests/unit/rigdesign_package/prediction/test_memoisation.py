"""Meshes met before: known by all that enters them, the tooth model of the rig included."""

from dataclasses import replace

import numpy as np

from rigdesign.base.part_name import MeshName
from rigdesign.case.loader import load_case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.memoisation import Memoisation, shape_key
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.tooth_influence import ToothInfluence
from tests.builders.twisting import twisting_rig

MESH = MeshName("test", "main")
POINT = OperatingPoint(stage="test", speed=150.0, torque=302.0)
CASE = load_case("cases/fzg")
QUICK = twisting_rig(CASE)
STATE = initial_state(QUICK, POINT)


def key(rig: Rig) -> tuple[object, ...]:
    return shape_key(rig, MESH, POINT, STATE)


def test_rigs_of_one_case_with_other_tooth_models_have_meshes_of_their_own() -> None:
    standard = replace(build_rig(CASE, "standard"), coarsening=QUICK.coarsening, pairs=QUICK.pairs)
    assert (QUICK.mesh_stiffness, standard.mesh_stiffness) == ("iso_6336_scaled", "influence_numbers")
    assert key(QUICK) != key(standard)
    assert key(QUICK) == key(twisting_rig(CASE))
    near = tuple(QUICK.tooth_influence.for_widths_near([QUICK.pairs[MESH]]).near)
    assert key(standard) != key(replace(standard, tooth_influence=ToothInfluence(near=near)))


def test_a_known_mesh_is_not_handed_to_a_rig_with_another_tooth_model() -> None:
    known, soft = Memoisation(), replace(QUICK, mesh_stiffness="weber_banaschek_0.8")
    first, second = (known.models(rig, POINT, STATE)[0].law for rig in (QUICK, soft))
    assert not np.array_equal(first.stiffness, second.stiffness)
    assert known.models(QUICK, POINT, STATE)[0].law.stiffness is first.stiffness


def test_axes_as_made_are_part_of_the_key() -> None:
    tilted = twisting_rig(CASE.with_value("gearboxes.test.meshes.main.axis_inclination", "20 um"))
    assert key(tilted) != key(QUICK)

"""Axes as made in the mesh law: the gap over the slices is that of the flanks that carry."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from dynamics.gear.flank import PARALLEL
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.pair_gap import PairGap
from rigdesign.base.part_name import MeshName
from rigdesign.case.loader import load_case
from rigdesign.coupling.alignment import axes_in_mesh
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import MeshModel, mesh_model
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from tests.builders.twisting import twisting_rig
from tests.unit.rigdesign_package.coupling.test_tooth_springs import AnalyticTeeth

CASE, MESH = load_case("cases/fzg").with_value("numerics.slices_spur", 6), MeshName("test", "main")
AT = "gearboxes.test"
POINT = OperatingPoint(stage="test", speed=150.0, torque=302.0)


def rig_with(**values: str) -> Rig:
    return twisting_rig(
        CASE.with_values({f"{AT}.{key.replace('__', '.')}": value for key, value in values.items()})
    )


@cache
def cold_state() -> CouplingState:
    return initial_state(rig_with(), POINT)


def model(rig: Rig, torque: float = 302.0) -> MeshModel:
    state = cold_state()
    return mesh_model(rig, MESH, POINT, replace(state, mesh_torque={**state.mesh_torque, MESH: torque}))


def face_of(law: MeshLaw, width: float) -> np.ndarray:
    slices = len(law.gap)
    return ((np.arange(slices) + 0.5) / slices - 0.5) * width


@pytest.mark.parametrize(
    "values",
    [
        {"meshes__main__axis_inclination": "30 um"},
        {"meshes__main__axis_skew": "30 um"},
        {"meshes__main__axis_skew": "30 um", "rotation": "anticlockwise"},
    ],
)
@pytest.mark.parametrize(("torque", "flank"), [(302.0, "front"), (-302.0, "back")])
def test_axes_open_the_flanks_that_carry_over_the_slices(
    values: dict[str, str], torque: float, flank: str
) -> None:
    rig = rig_with(**values)
    found, parallel = model(rig, torque), model(rig_with(), torque)
    law, pair = found.law, found.pair
    axes = axes_in_mesh(rig, MESH, cold_state())
    path = law.path_start + law.path_step * np.arange(law.gap.shape[1])
    face = face_of(law, pair.face_width)[:, None]
    gaps = [PairGap.of_pair(pair, axes=own).of_axes(path, face, flank) for own in (axes, PARALLEL)]  # type: ignore[arg-type]
    np.testing.assert_allclose(law.gap - parallel.law.gap, gaps[0] - gaps[1], atol=1e-15)

    # 30 um over the face, in the line of action, less half a slice at each end
    angle = pair.working_pressure_angle
    inclined = "meshes__main__axis_inclination" in values
    clockwise = values.get("rotation") != "anticlockwise"
    whole = 30e-6 * (np.sin(angle) if inclined else np.cos(angle))
    sign = 1.0 if inclined or clockwise == (flank == "front") else -1.0
    rise = (law.gap - parallel.law.gap)[-1, 0] - (law.gap - parallel.law.gap)[0, 0]
    assert rise == pytest.approx(sign * whole * (1.0 - 1.0 / len(law.gap)), rel=1e-9)


def test_axes_open_the_teeth_of_influence_numbers_alike() -> None:
    """In the middle of the path, where no tip corner touches away from the line of action."""
    gaps = []
    for values in ({}, {"meshes__main__axis_inclination": "30 um"}):
        rig = replace(rig_with(**values), mesh_stiffness="influence_numbers", tooth_influence=AnalyticTeeth())
        found = model(rig)
        pitch_point = round(-found.law.path_start / found.law.path_step)
        gaps.append(found.law.gap[:, pitch_point])
    whole = 30e-6 * np.sin(found.pair.working_pressure_angle)
    opened = gaps[1] - gaps[0]
    np.testing.assert_allclose(np.diff(opened), whole / len(opened), rtol=0.02)


def test_misaligned_spur_gears_get_slices_of_their_own() -> None:
    box = CASE.gearboxes["test"]
    flat: dict[str, object] = {f"{AT}.gears.{gear}.flank": {} for gear in box.gears} | {
        "numerics.slices_spur": None
    }
    tilt = {f"{AT}.meshes.main.axis_inclination": "30 um"}
    counts = [len(model(twisting_rig(CASE.with_values(values))).law.gap) for values in (flat, flat | tilt)]
    assert axes_in_mesh(rig_with(), MESH, cold_state()) == PARALLEL
    assert counts[0] == 1
    assert counts[1] > 1

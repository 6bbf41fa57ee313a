"""Root stress from the forces of a mesh law against that of the loaded contact, and its symmetries."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.influence_numbers import InfluenceNumbers, SectionDivision
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.mesh_force import ToothForces
from dynamics.tooth.points import FaceGrid
from dynamics.tooth.root_field import PairForces, root_course, root_field
from rigdesign.rig.tooth_influence import gear_model
from tests.builders.elastic_pairs import equal_helical_pair, numbers_of

SLICES = 12
COARSE = SectionDivision(profile=4, thickness=2, fillet=8, depth=1, grading=0.4, neighbours=(2, 1, 4))


@cache
def numbers(pair: GearPair, gear: int) -> InfluenceNumbers:
    found = numbers_of(replace(gear_model(pair, gear), n_face=5, division=COARSE))
    return found.reversed_face() if gear == 0 else found


@cache
def cycle(pair: GearPair) -> MeshCycle:
    """Loaded contact at the middles of slices."""
    middles = ((np.arange(SLICES) + 0.5) / SLICES - 0.5) * pair.face_width
    grid = FaceGrid(position=middles, width=np.full(SLICES, pair.face_width / SLICES))
    gears = tuple(InterpolatedCompliance.of(numbers(pair, gear), pair.base_helix_angle) for gear in (0, 1))
    mesh = LoadedMesh(pair=pair, gears=gears, grid=grid, n_positions=32)  # type: ignore[arg-type]
    return mesh.cycle(100e3 * pair.face_width)


def law_of(pair: GearPair, found: MeshCycle) -> Any:
    """What the root field reads of a mesh law: places and slices."""
    path = np.linspace(found.points.path.min(), found.points.path.max(), 1201)
    return SimpleNamespace(
        stiffness=np.zeros((SLICES, path.size)),
        path_start=path[0],
        path_step=path[1] - path[0],
        slice_shift=found.points.grid.position * np.tan(pair.base_helix_angle),
        base_pitch=pair.base_pitch,
    )


def forces_of(found: MeshCycle) -> PairForces:
    points = found.points
    path = points.position[:, None] - points.pair.base_pitch * points.pairs
    return PairForces(path, points.weight * found.force)


@pytest.mark.parametrize("gear", [0, 1])
@pytest.mark.parametrize("side", [1, -1])
def test_forces_of_the_loaded_contact_give_its_root_stress(gear: Any, side: Any) -> None:
    """Within the interpolation of the tables over the path; two ways of adding up the neighbours."""
    pair = equal_helical_pair()
    found, own = cycle(pair), numbers(pair, gear)
    compliance = InterpolatedCompliance.of(own, pair.base_helix_angle)
    expected = root_course(found, own, compliance, gear, side)
    field = root_field(law_of(pair, found), pair, own, compliance, gear, side)
    course = field.course(forces_of(found))
    scale = float(np.abs(expected.stress).max())
    stress = course.stress[np.isin(course.path.round(12), expected.path.round(12))]
    np.testing.assert_allclose(stress, expected.stress, atol=5e-3 * scale)
    # away from the flank, where the stress is not that of the contact
    root = own.fillet.tangent >= np.radians(15.0)
    np.testing.assert_allclose(stress[:, root], expected.stress[:, root], atol=1e-3 * scale)


def test_neighbours_press_the_fillet_before_the_tooth_comes_in() -> None:
    """The fillet of a tooth feels the force on its neighbour while its own flank is free."""
    pair = equal_helical_pair()
    found, own = cycle(pair), numbers(pair, 0)
    compliance = InterpolatedCompliance.of(own, pair.base_helix_angle)
    course = root_field(law_of(pair, found), pair, own, compliance, 0).course(forces_of(found))
    forces = forces_of(found)
    loaded = forces.path[forces.force.any(axis=2)]
    before = course.path < loaded.min() - 1e-9
    assert np.any(np.abs(course.stress[before]) > 0.01 * course.highest)
    assert course.highest_at[0] > np.flatnonzero(before)[-1]


def test_back_flank_is_the_front_flank_of_the_gear_turned_end_for_end() -> None:
    pair = equal_helical_pair()
    found, own = cycle(pair), numbers(pair, 0)
    compliance = InterpolatedCompliance.of(own, pair.base_helix_angle)
    field = root_field(law_of(pair, found), pair, own, compliance, 0)
    front = forces_of(found)
    zero = np.zeros_like(front.force)
    both = ToothForces(
        pair=np.zeros_like(front.path, dtype=np.int64),
        path=front.path,
        back_path=front.path[:, ::-1],
        front=zero,
        back=front.force[:, ::-1, ::-1],
    )
    np.testing.assert_array_equal(
        field.course(PairForces.of(both, front=False)).stress, field.course(front).stress
    )


def test_a_point_for_every_face_position_is_part_of_the_whole() -> None:
    pair = equal_helical_pair()
    found, own = cycle(pair), numbers(pair, 0)
    compliance = InterpolatedCompliance.of(own, pair.base_helix_angle)
    field = root_field(law_of(pair, found), pair, own, compliance, 0)
    whole = field.course(forces_of(found)).stress
    points = whole.max(axis=0).argmax(axis=0)
    some = field.at(points).course(forces_of(found)).stress
    np.testing.assert_allclose(some[:, 0], whole[:, points, np.arange(whole.shape[2])])
    assert some.max() == whole.max()

"""Interpolated influence numbers and the analytic slices: symmetry, exactness, neighbours, messages."""

from dataclasses import replace
from math import cos

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.tooth.mesh_laws import tooth_compliance
from dynamics.tooth.points import FaceGrid
from dynamics.tooth.slice_compliance import SliceCompliance
from tests.builders.influence import hat_means, hat_weights
from tests.builders.loaded_mesh import equal_gears, influence_of
from tests.builders.p2_gears import helical_pair

PAIR = equal_gears()


def points(table, n=40, seed=1):
    rng = np.random.default_rng(seed)
    roll = rng.uniform(table.profile[0], table.profile[-1], n)
    face = rng.uniform(table.face[0], table.face[-1], n)
    return roll, face, rng.integers(-2, 3, n)


@pytest.mark.parametrize("n_face", [3, 4, 8])
def test_means_under_the_hats_are_the_influence_numbers(n_face):
    table = influence_of(PAIR, 0, n_profile=5, n_face=n_face)
    if n_face == 3:  # as they are, at the positions
        roll, face = (one.ravel() for one in np.meshgrid(table.profile, table.face, indexing="ij"))
        zero = np.zeros(roll.size, dtype=np.int64)
        found = table.matrix(roll, face, zero)
    else:
        found = hat_means(table, offset=0)
    assert found == pytest.approx(table.deflection[0], rel=1e-9, abs=1e-20)
    if n_face == 4:
        assert hat_means(table, offset=1) == pytest.approx(table.deflection[1], rel=1e-9, abs=1e-20)
        assert hat_means(table, offset=-1) == pytest.approx(table.deflection[-1], rel=1e-9, abs=1e-20)


def test_a_smooth_kernel_is_met_to_high_order_in_the_face():
    """Numbers of exp(-(z - z')^2 / w^2) as means under hats: halving their distance leaves an eighth of the error or
    less, the hats themselves a quarter."""
    errors = []
    for n_face in (9, 17):
        table = influence_of(PAIR, 0, n_profile=4, n_face=n_face)
        width = 0.4 * float(np.ptp(table.face))
        hats, places = hat_weights(table.face)
        kernel = np.exp(-(((places[:, None] - places) / width) ** 2))
        means = 1e-9 * hats @ kernel @ hats.T
        own = replace(table, deflection={0: np.kron(np.ones((4, 4)), means)})
        face = np.linspace(table.face[0], table.face[-1], 41)
        matrix = own.matrix(np.full(41, table.profile[2]), face, np.zeros(41, dtype=np.int64))
        errors.append(np.abs(1e9 * matrix - np.exp(-(((face[:, None] - face) / width) ** 2))).max())
    assert errors[0] < 5e-3
    assert errors[1] < errors[0] / 8.0


def test_matrix_is_symmetric_and_positive():
    table = influence_of(PAIR, 0)
    matrix = table.matrix(*points(table))
    assert matrix == pytest.approx(matrix.T, abs=1e-12 * matrix.max())
    one_tooth = points(table)
    matrix = table.matrix(one_tooth[0], one_tooth[1], np.zeros(40, dtype=np.int64))
    assert np.linalg.eigvalsh(matrix).min() > -1e-12 * matrix.max()


def test_cubic_over_the_profile_is_exact_for_cubic_influence_numbers():
    table = influence_of(PAIR, 0, n_profile=6, n_face=3)
    q = (table.profile - table.profile[3]) / 1e-3
    shape = np.kron((1.0 + 0.2 * q + 0.05 * q**2 - 0.01 * q**3), np.ones(3))
    cubic = replace(table, deflection={0: 1e-9 * np.outer(shape, shape)})
    roll = np.linspace(table.profile[0], table.profile[-1], 17)
    at = (roll - table.profile[3]) / 1e-3
    value = 1.0 + 0.2 * at + 0.05 * at**2 - 0.01 * at**3
    matrix = cubic.matrix(roll, np.zeros(17), np.zeros(17, dtype=np.int64))
    assert matrix == pytest.approx(1e-9 * np.outer(value, value), rel=1e-10)


def test_teeth_further_away_feel_the_body_only():
    table = replace(influence_of(PAIR, 0), beyond=2e-12)
    roll, zero = np.full(3, table.profile[3]), np.zeros(3)
    matrix = table.matrix(roll, zero, np.array([0, 1, 2]))
    assert matrix[0, 2] == matrix[2, 0] == 2e-12
    assert matrix[0, 1] == pytest.approx(matrix[1, 2])


def test_roll_lengths_beyond_the_flank_are_held_at_its_ends():
    table = influence_of(PAIR, 0)
    zero = np.zeros(2, dtype=np.int64)
    outside = np.array([table.profile[0] - 1e-3, table.profile[-1] + 1e-3])
    ends = table.profile[[0, -1]]
    assert table.matrix(outside, np.zeros(2), zero) == pytest.approx(table.matrix(ends, np.zeros(2), zero))
    assert table.depth(outside) == pytest.approx(table.depth(ends))


def test_influence_numbers_that_break_reciprocity_are_refused():
    table = influence_of(PAIR, 0)
    with pytest.raises(DynamicsInputError, match="reciprocity"):
        replace(table, deflection={**table.deflection, -1: table.deflection[1]})
    with pytest.raises(DynamicsInputError, match="reciprocity"):
        replace(table, deflection={0: table.deflection[0], 1: table.deflection[1]})
    with pytest.raises(DynamicsInputError, match="shape"):
        replace(table, deflection={0: table.deflection[0][:4, :4]})
    with pytest.raises(DynamicsInputError, match="four positions"):
        replace(table, axis_depth=table.axis_depth[:3])


@pytest.mark.parametrize("coupling", [0.0, 1e-3, 6e-3])
@pytest.mark.parametrize("pair", [PAIR, helical_pair()], ids=["spur", "helical"])
def test_even_load_bends_every_slice_as_the_plane_tooth(pair, coupling):
    grid = FaceGrid.over(pair.face_width, 9)
    slices = SliceCompliance(pair=pair, index=0, grid=grid, coupling_length=coupling)
    roll = pair.rolling_radii[0]
    matrix = slices.matrix(np.full(9, roll), grid.position, np.zeros(9, dtype=np.int64))
    slant = cos(pair.base_helix_angle)
    tooth, body, _ = tooth_compliance(pair, 0, np.array([roll / slant]))
    deflection = matrix @ (grid.width / slant)
    assert deflection == pytest.approx(np.full(9, (tooth + body)[0]), rel=1e-3)
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_coupled_slices_feel_a_narrow_load_over_the_coupling_length():
    grid = FaceGrid.over(40e-3, 401)
    pair = equal_gears(width=40e-3)
    slices = SliceCompliance(pair=pair, index=0, grid=grid, coupling_length=3e-3)
    roll = np.full(401, pair.rolling_radii[0])
    column = slices.matrix(roll, grid.position, np.zeros(401, dtype=np.int64))[:, 200]
    assert column[230] / column[200] == pytest.approx(np.exp(-1.0), rel=1e-3)
    # a load on the end of the tooth bends it twice as much as one in its middle
    ends = slices.matrix(roll, grid.position, np.zeros(401, dtype=np.int64))
    assert ends[0, 0] / column[200] == pytest.approx(2.0, rel=1e-3)


def test_point_off_the_grid_and_negative_coupling_are_refused():
    grid = FaceGrid.over(PAIR.face_width, 5)
    slices = SliceCompliance(pair=PAIR, index=0, grid=grid)
    with pytest.raises(DynamicsInputError, match="face grid"):
        slices.matrix(np.array([0.02]), np.array([1e-3]), np.zeros(1, dtype=np.int64))
    with pytest.raises(DynamicsInputError, match="coupling_length"):
        SliceCompliance(pair=PAIR, index=0, grid=grid, coupling_length=-1.0)

"""Positions over the face: weights, messages, and how many are enough."""

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.gear.microgeometry import Microgeometry
from dynamics.tooth.points import FaceGrid, default_positions
from tests.builders.loaded_mesh import equal_gears, gap_of, sliced_mesh
from tests.builders.p2_gears import helical_pair


def test_widths_are_the_integrals_of_the_hats():
    grid = FaceGrid.over(20e-3, 11)
    assert grid.width[[0, 5, 10]] == pytest.approx([1e-3, 2e-3, 1e-3])
    assert grid.face_width == pytest.approx(20e-3)
    uneven = FaceGrid.at(np.array([-5.0, -4.0, 0.0, 5.0]))
    assert uneven.width == pytest.approx([0.5, 2.5, 4.5, 2.5])
    assert FaceGrid.over(7e-3, 1).width == pytest.approx([7e-3])


def test_grids_that_cannot_be_are_refused():
    for n, width in ((0, 1.0), (3, 0.0)):
        with pytest.raises(DynamicsInputError):
            FaceGrid.over(width, n)
    with pytest.raises(DynamicsInputError, match="grow"):
        FaceGrid.at(np.array([0.0, 1.0, 0.5]))
    with pytest.raises(DynamicsInputError, match="one length"):
        FaceGrid(position=np.zeros(2), width=np.ones(3))


def figures(pair, n, gap, force):
    cycle = sliced_mesh(pair, n, coupling=1.5, gap=gap).cycle(force)
    middle = cycle.points.place.corner == 0
    return np.array([cycle.approach.mean(), cycle.face_load_factor, (cycle.line_load * middle).max()])


@pytest.mark.parametrize(
    ("pair", "force"), [(equal_gears(), 4.8e3), (helical_pair(), 3.9e3)], ids=["spur", "helical"]
)
def test_number_of_positions_is_converged_to_one_per_cent(pair, force):
    micro = (Microgeometry(profile_crowning=5e-6, lead_crowning=5e-6, helix_slope=6e-6),) * 2
    gap = gap_of(pair, micro)
    n = default_positions(pair, gap_varies=True)
    assert figures(pair, n, gap, force) == pytest.approx(figures(pair, 3 * n - 2, gap, force), rel=1e-2)


def test_one_position_is_exact_for_a_spur_gear_that_is_alike_over_its_face():
    pair = equal_gears()
    assert default_positions(pair, gap_varies=False) == 1
    one, many = (sliced_mesh(pair, n).cycle(4.8e3) for n in (1, 11))
    assert one.approach == pytest.approx(many.approach, rel=1e-12)
    assert default_positions(helical_pair(), gap_varies=False) > 40

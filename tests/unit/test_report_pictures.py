"""Cuts and views of a mesh, against areas and values that are known."""

import numpy as np
import pytest

from rigdesign.report.mesh_views import SUB_TETRAHEDRA, cut_mesh, shaft_axis_height, view_outside
from tests.report_example import gearbox_field, voxel_mesh


@pytest.fixture(scope="module")
def block():
    """A block of 4 x 3 x 2 cubes of 0.1 m, the upper layer another body."""
    body = np.zeros((4, 3, 2), dtype=int)
    body[:, :, 1] = 1
    return voxel_mesh(body, ["lower", "shaft_upper"], 0.1)


def triangle_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def test_sub_tetrahedra_fill_the_cell(block):
    corners = block.points[block.cells][:, SUB_TETRAHEDRA]
    volumes = np.abs(np.linalg.det(corners[:, :, 1:] - corners[:, :, :1])) / 6
    assert volumes.sum() == pytest.approx(0.4 * 0.3 * 0.2)
    assert volumes.max() == pytest.approx(volumes.min())


@pytest.mark.parametrize(
    ("axis", "position", "area"),
    [
        (2, 0.033, 0.12),
        (2, 0.1, 0.12),
        (0, 0.21, 0.06),
        (1, 0.3, 0.08),
        (2, 0.05, 0.12),
        (0, 0.5, 0.0),
        (0, -0.1, 0.0),
    ],
)
def test_cut_has_the_area_of_the_section(block, axis, position, area):
    cut = cut_mesh(block, axis, position)
    assert triangle_areas(cut.points, cut.triangles).sum() == pytest.approx(area)
    np.testing.assert_allclose(cut.points[:, axis], position, atol=1e-12)


def test_cut_interpolates_a_linear_field_exactly(block):
    cut = cut_mesh(block, 2, 0.033)
    values = block.points @ [3.0, -2.0, 5.0] + 7.0
    np.testing.assert_allclose(cut.interpolate(values), cut.points @ [3.0, -2.0, 5.0] + 7.0)


def test_outlines_go_round_every_body(block):
    cut = cut_mesh(block, 0, 0.21)
    ends = cut.points[cut.outlines()]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    seam = np.isclose(ends[:, 0, 2], 0.1) & np.isclose(ends[:, 1, 2], 0.1)
    around = 2 * (0.3 + 0.2)
    assert lengths[~seam].sum() == pytest.approx(around)
    assert lengths[seam].sum() >= 0.3 - 1e-12
    assert set(cut.bodies) == {0, 1}


def test_view_shows_the_silhouette_from_the_front(block):
    """Seen along y the block is a rectangle of 0.4 m x 0.2 m; hidden sides are left out."""
    view = view_outside(block, azimuth_deg=-90.0, elevation_deg=0.0)
    a, b, c = (view.corners[:, k] for k in range(3))
    areas = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert areas.sum() == pytest.approx(0.08)
    np.testing.assert_allclose(block.points[view.nodes, 1], 0.0, atol=1e-12)
    assert np.ptp(view.brightness) == pytest.approx(0.0)


def test_near_facets_are_drawn_last():
    mesh = gearbox_field().mesh
    view = view_outside(mesh, azimuth_deg=0.0, elevation_deg=0.0)
    x = mesh.points[view.nodes, 0].mean(axis=1)
    assert np.all(np.diff(x) >= -1e-12)
    assert 0.0 < view.brightness.min() <= view.brightness.max() <= 1.0


def test_cut_height_is_the_shaft_axis(block):
    assert shaft_axis_height(block) == pytest.approx(0.15)
    plain = voxel_mesh(np.zeros((2, 2, 2), dtype=int), ["housing"], 0.1)
    assert shaft_axis_height(plain) == pytest.approx(0.1)

"""Cuts and views of a mesh, against areas and values that are known."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from rigdesign.report.fields import write_field
from rigdesign.report.figures import field as mesh_views
from rigdesign.report.figures.drawing import drawing_style
from rigdesign.report.figures.field import (
    DRAWN,
    SUB_TETRAHEDRA,
    MeshViews,
    cut_mesh,
    field_pictures,
    magnification,
    shaft_axis_height,
    surface_triangles,
    view_outside,
)
from rigdesign.results.thermal import TemperatureField
from tests.builders.report import gearbox_field, voxel_mesh
from thermal.fe.mesh import NamedMesh, Numbering, box_mesh, inverse


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


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20", "hexahedron27"])
def test_every_kind_of_cell_is_cut_and_seen(cell):
    """A box of 0.4 x 0.3 x 0.2 m: area of its section, and of its front seen along y."""
    mesh = box_mesh((0.4, 0.3, 0.2), (3, 2, 2), cell=cell, name="housing")
    cut = cut_mesh(mesh, 2, 0.07)
    assert triangle_areas(cut.points, cut.triangles).sum() == pytest.approx(0.12)
    values = mesh.points @ [3.0, -2.0, 5.0]
    np.testing.assert_allclose(cut.interpolate(values), cut.points @ [3.0, -2.0, 5.0])
    view = view_outside(mesh, azimuth_deg=-90.0, elevation_deg=0.0)
    a, b, c = (view.corners[:, k] for k in range(3))
    areas = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert areas.sum() == pytest.approx(0.08)


def test_many_facets_are_drawn_by_their_corners(block, monkeypatch):
    every = surface_triangles(block)
    monkeypatch.setattr(mesh_views, "FINE", 1)
    coarse = surface_triangles(block)
    assert len(every) == 4 * len(coarse)
    areas = [triangle_areas(block.points, triangles).sum() for triangles in (every, coarse)]
    assert areas[0] == pytest.approx(areas[1])


def test_the_view_looks_at_the_gearbox_not_at_the_field():
    field = gearbox_field()
    focus = view_outside(field.mesh).focus
    whole = view_outside(field.mesh).corners.reshape(-1, 2)
    assert np.all(np.ptp(focus, axis=0) < np.ptp(whole, axis=0))
    assert np.all(focus[0] >= whole.min(axis=0) - 1e-12)


def test_displacement_is_drawn_with_the_factor_that_is_printed():
    field = gearbox_field()
    views = MeshViews(field.mesh)
    factor = magnification(field, views)
    largest = factor * np.linalg.norm(field.displacement, axis=1).max()
    assert 0.4 * DRAWN * views.size < largest <= DRAWN * views.size
    assert f"{factor:g}"[0] in "125"
    moved = view_outside(field.mesh, points=field.mesh.points + factor * field.displacement)
    assert np.abs(moved.focus - views.outside.focus).max() > 0.2 * largest
    with drawing_style():
        picture = list(field_pictures(field, views))[-1]
    assert picture.title == "Displacement"
    assert f"{factor:g} times" in picture.caption
    assert f"× {factor:g}" in picture.figure.axes[0].get_title(loc="left")


def test_pictures_without_flux_or_displacement_are_left_out():
    field = gearbox_field()
    bare = replace(field, heat_flux=None, displacement=np.zeros_like(field.displacement))
    with drawing_style():
        assert [p.title for p in field_pictures(bare, MeshViews(field.mesh))] == ["Temperature"]
        titles = [p.title for p in field_pictures(field, MeshViews(field.mesh))]
    assert titles == ["Temperature", "Heat flux", "Displacement"]


def test_fields_of_hexahedra_are_written_as_such(tmp_path):
    import meshio

    mesh = box_mesh((0.4, 0.3, 0.2), (2, 1, 1), cell="hexahedron20", name="housing")
    flux = np.tile([1.0, 2.0, 3.0], (len(mesh.points), 1))
    field = TemperatureField(
        "test", "dwell", mesh, np.full(len(mesh.points), 300.0), np.zeros_like(mesh.points), flux
    )
    entry = write_field(field, tmp_path / "field.vtu")
    assert entry["point_data"] == ["temperature_degC", "displacement_m", "heat_flux_W_m2"]
    read = meshio.read(tmp_path / "field.vtu")
    assert read.cells[0].type == "hexahedron20"
    np.testing.assert_allclose(read.point_data["heat_flux_W_m2"], flux)


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20", "hexahedron27"])
def test_bodies_and_surfaces_are_blocks_by_name(cell, tmp_path):
    """Bodies fill the mesh, surfaces its outside; a name with signs stays as it is in the list of blocks."""
    import meshio

    mesh = box_mesh((0.4, 0.3, 0.2), (2, 2, 1), cell=cell, name="housing")
    half = len(mesh.cells) // 2
    mesh = replace(
        mesh,
        bodies={"housing": np.arange(half), 'shaft <A> & "B"/1': np.arange(half, len(mesh.cells))},
    )
    field = TemperatureField("test", "run up", mesh, 300.0 + mesh.points[:, 0], 1e-4 * mesh.points)
    entry = write_field(field, tmp_path / "test_run_up.vtu")
    assert entry["blocks"] == "fields/test_run_up.vtm"
    assert entry["bodies"] == list(mesh.bodies)
    assert entry["surfaces"] == list(mesh.surfaces)
    root = ElementTree.parse(tmp_path / "test_run_up.vtm").getroot()
    assert root.get("type") == "vtkMultiBlockDataSet"
    groups = {
        group.get("name"): {block.get("name"): block for block in group} for group in root.iter("Block")
    }
    assert {name: list(blocks) for name, blocks in groups.items()} == {
        "bodies": list(mesh.bodies), "surfaces": list(mesh.surfaces),
    }  # fmt: skip
    for name, block in {**groups["bodies"], **groups["surfaces"]}.items():
        read = meshio.read(tmp_path / block.get("file"))
        wanted = mesh.cells[mesh.bodies[name]] if name in mesh.bodies else mesh.surfaces[name]
        np.testing.assert_allclose(read.points[read.cells[0].data], mesh.points[wanted], atol=1e-7)
        np.testing.assert_allclose(read.point_data["temperature_degC"], 26.85 + read.points[:, 0], atol=1e-4)
    files = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.vtu")}
    assert files == {
        "test_run_up.vtu", *(b.get("file") for blocks in groups.values() for b in blocks.values()),
    }  # fmt: skip


def test_fields_of_a_renumbered_mesh_keep_the_order_it_was_given_in(tmp_path):
    import meshio

    mesh = box_mesh((0.4, 0.3, 0.2), (3, 2, 1), name="housing")
    half = len(mesh.cells) // 2
    mesh = replace(mesh, bodies={"housing": np.arange(half), "field": np.arange(half, len(mesh.cells))})
    order = np.random.default_rng(1)
    numbering = Numbering(order.permutation(len(mesh.points)), order.permutation(len(mesh.cells)))
    renumbered = NamedMesh(
        mesh.points[numbering.nodes],
        inverse(numbering.nodes)[mesh.cells[numbering.cells]],
        {name: inverse(numbering.cells)[cells] for name, cells in mesh.bodies.items()},
        {name: inverse(numbering.nodes)[nodes] for name, nodes in mesh.surfaces.items()},
        numbering,
    )
    found = []
    for number, shape in enumerate((mesh, renumbered)):
        field = TemperatureField("test", "dwell", shape, 300.0 + shape.points[:, 0], 1e-3 * shape.points)
        write_field(field, tmp_path / f"{number}.vtu")
        found.append(meshio.read(tmp_path / f"{number}.vtu"))
    given, again = found
    np.testing.assert_array_equal(again.points, given.points)
    np.testing.assert_array_equal(again.cells[0].data, given.cells[0].data)
    np.testing.assert_array_equal(again.cell_data["body"][0], given.cell_data["body"][0])
    for name, values in given.point_data.items():
        np.testing.assert_array_equal(again.point_data[name], values)

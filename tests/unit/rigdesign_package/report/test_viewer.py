"""Geometry and data of the turnable picture, against volumes, areas and values that are known."""

import gzip
import hashlib
import json
import re
from base64 import b64decode
from dataclasses import replace

import numpy as np
import pytest

from rigdesign.report.viewer import scene as simplify
from rigdesign.report.viewer import solid
from rigdesign.report.viewer.cutaway import clipped
from rigdesign.report.viewer.library import FOLDER, drawing_library, viewer_text
from rigdesign.report.viewer.scene import MOST, hottest, simplified, viewer_scene
from rigdesign.report.viewer.solid import UNNAMED, shaded_vertices, solid_picture, solid_pictures
from tests.builders.report import gearbox_field, voxel_mesh
from thermal.fe.mesh import box_mesh

CELLS = ("tetra10", "hexahedron20", "hexahedron27")


def volume(points, tetrahedra):
    corners = points[tetrahedra]
    return np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6


def enclosed(points, triangles):
    """Volume inside a closed skin, normals outwards, by the divergence theorem."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("limit", [100, 100_000])
def test_tetrahedra_and_skin_enclose_the_volume_of_every_body(cell, limit, monkeypatch):
    """With many bodies split along their mid-side nodes, and with none."""
    monkeypatch.setattr(solid, "MOST_TRIANGLES", limit)
    mesh = box_mesh((0.4, 0.3, 0.2), (3, 2, 2), cell=cell, name="housing")
    half = len(mesh.cells) // 2
    mesh = replace(mesh, bodies={"left": np.arange(half), "right": np.arange(half, len(mesh.cells))})
    picture = solid_picture(mesh)
    points = mesh.points[picture.nodes]
    assert volume(points, picture.tetrahedra) == pytest.approx(0.4 * 0.3 * 0.2)
    for body in range(2):
        inside = volume(points, picture.tetrahedra[picture.tetrahedron_body == body])
        assert enclosed(points, picture.triangles[picture.triangle_body == body]) == pytest.approx(inside)
    named = picture.triangle_surface < len(mesh.surfaces)
    area = np.linalg.norm(
        np.cross(*(points[picture.triangles[:, k]] - points[picture.triangles[:, 0]] for k in (1, 2))), axis=1
    )
    assert 0.5 * area[named].sum() == pytest.approx(2 * (0.4 * 0.3 + 0.3 * 0.2 + 0.4 * 0.2))
    assert picture.surfaces[-1] == UNNAMED
    assert (~named).any()


def test_the_smallest_bodies_are_round_first(monkeypatch):
    mesh = gearbox_field().mesh
    assert len(solid_picture(mesh).tetrahedra) == len(mesh.cells) + 7 * len(mesh.cells)
    shafts = [len(mesh.bodies[name]) for name in ("shaft_pinion", "shaft_wheel")]
    monkeypatch.setattr(solid, "MOST_TETRAHEDRA", len(mesh.cells) + 7 * sum(shafts))
    picture = solid_picture(mesh)
    counts = np.bincount(picture.tetrahedron_body)
    assert counts.tolist() == [
        (8 if name.startswith("shaft") else 1) * len(cells) for name, cells in mesh.bodies.items()
    ]


def test_edges_of_a_block_stay_sharp_and_its_faces_smooth():
    mesh = voxel_mesh(np.zeros((3, 3, 3), dtype=int), ["block"], 0.1)
    picture = solid_picture(mesh)
    points = mesh.points[picture.nodes]
    nodes, triangles = shaded_vertices(picture, points)
    assert nodes[triangles].tolist() == picture.triangles.tolist()
    on_faces = np.isclose(points, 0.0).sum(axis=1) + np.isclose(points, 0.3).sum(axis=1)
    np.testing.assert_array_equal(np.bincount(nodes, minlength=len(points)), on_faces)


def test_a_fine_mesh_is_thinned_out_and_keeps_bodies_and_volume(monkeypatch):
    mesh = gearbox_field(0.025).mesh
    picture = solid_picture(mesh)
    points = mesh.points[picture.nodes]
    assert simplified(picture, points) is picture
    monkeypatch.setattr(simplify, "MOST_TRIANGLES", len(picture.triangles) // 3)
    fewer = simplified(picture, points)
    thin = mesh.points[fewer.nodes]
    assert 0.3 * simplify.MOST_TRIANGLES < len(fewer.triangles) <= simplify.MOST_TRIANGLES
    assert set(fewer.tetrahedron_body) == set(fewer.triangle_body) == {0, 1, 2, 3}
    assert len(fewer.triangle_body) == len(fewer.triangle_surface) == len(fewer.triangles)
    assert volume(thin, fewer.tetrahedra) == pytest.approx(volume(points, picture.tetrahedra), rel=0.25)
    np.testing.assert_allclose(np.ptp(thin, axis=0), np.ptp(points, axis=0), atol=0.03)


def decoded(scene, at):
    block = gzip.decompress(b64decode(scene["block"]))
    kind = np.uint16 if at["bytes"] == 2 else np.uint32
    whole = np.frombuffer(block, dtype=kind, count=at["count"], offset=at["start"])
    return at["low"] + at["step"] * whole if "low" in at else whole.astype(np.int64)


def test_the_page_gets_the_field_to_a_hundredth_of_a_kelvin():
    field = gearbox_field()
    scene = json.loads(json.dumps(viewer_scene([field], solid_pictures([field.mesh]))))
    picture = solid_picture(field.mesh)
    mesh, shown = scene["meshes"][0], scene["fields"][0]
    points = np.column_stack([decoded(scene, at) for at in mesh["points"]])
    np.testing.assert_allclose(points, 1e3 * field.mesh.points[picture.nodes], atol=0.01)
    values = field.temperature[picture.nodes] - 273.15
    np.testing.assert_allclose(decoded(scene, shown["temperature"]), values, atol=0.02)
    moved = np.column_stack([decoded(scene, at) for at in shown["displacement"]])
    np.testing.assert_allclose(moved, 1e6 * field.displacement[picture.nodes], atol=0.1)
    assert volume(1e-3 * points, decoded(scene, mesh["tetrahedra"]).reshape(-1, 4)) == pytest.approx(
        volume(field.mesh.points[picture.nodes], picture.tetrahedra), rel=1e-3
    )
    skin = decoded(scene, mesh["vertices"])[decoded(scene, mesh["triangles"])].reshape(-1, 3)
    np.testing.assert_array_equal(skin, picture.triangles)
    assert mesh["bodies"] == ["housing", "clamping field", "shaft pinion", "shaft wheel"]
    assert mesh["hidden"] == [1]
    assert mesh["simplified"] is False
    assert scene["ranges"]["temperature"] == [
        pytest.approx(field.temperature.min() - 273.15), pytest.approx(field.temperature.max() - 273.15),
    ]  # fmt: skip
    assert {entry["bytes"] for entry in (mesh["triangles"], mesh["tetrahedra"])} == {2}
    assert int(decoded(scene, mesh["tetrahedra"]).max()) <= MOST


def test_stages_share_their_mesh_and_the_hottest_comes_first():
    field = gearbox_field()
    warmer = replace(field, stage="run_up", temperature=field.temperature + 5.0)
    other = replace(
        field, gearbox="reference", mesh=replace(field.mesh), displacement=0.0 * field.displacement
    )
    fields = [field, warmer, other]
    scene = viewer_scene(fields, solid_pictures(item.mesh for item in fields))
    assert hottest([field, warmer, other]) == scene["first"] == 1
    assert [entry["mesh"] for entry in scene["fields"]] == [0, 0, 1]
    assert len(scene["meshes"]) == 2
    assert scene["fields"][2]["factor"] == 0.0 < scene["fields"][0]["factor"]


def test_triangles_are_cut_at_the_plane():
    """Two triangles of an upright square of 1 m, cut at 0.3 m: 0.3 m2 is left, and a linear value stays linear."""
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 0, 1]], [[0, 0, 0], [1, 0, 1], [0, 0, 1]]], dtype=float)
    corners, values = clipped(square, square @ [2.0, 0.0, 5.0], 0.3)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    assert area.sum() == pytest.approx(0.3)
    assert corners[..., 2].max() == pytest.approx(0.3)
    np.testing.assert_allclose(values, corners @ [2.0, 0.0, 5.0])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (normals[:, 1] < 0.0).all()


def test_the_drawing_library_is_the_published_one_with_its_licence():
    code = gzip.decompress(b64decode(drawing_library()))
    note = (FOLDER / "bundle" / "README.md").read_text(encoding="utf-8")
    assert hashlib.sha256(code).hexdigest() == re.findall(r"`([0-9a-f]{64})`", note)[0]
    version = re.findall(r"version ([\d.]+),", note)[0]
    assert f"plotly.js (gl3d - minified) v{version}".encode() in code[:100]
    assert "MIT License" in (FOLDER / "bundle" / "LICENSE").read_text(encoding="utf-8")


def test_script_and_style_leave_the_page_in_one_piece():
    for name in ("viewer.js", "viewer.css"):
        assert not re.search(r"</(script|style)", viewer_text(name))
    assert "eval" not in viewer_text("viewer.js")

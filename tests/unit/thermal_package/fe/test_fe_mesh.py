"""Named meshes: builders, conversion, and everything `FiniteElements` refuses."""

from dataclasses import replace

import numpy as np
import pytest
import skfem
from numpy.testing import assert_allclose, assert_array_equal

from tests.builders.scikit_fem_mesh import from_scikit_fem, second_order
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import (
    MeshError,
    NamedMesh,
    box_mesh,
    disjoint_union,
    named_mesh,
)
from thermal.fe.reference_elements import TETRAHEDRON_10

AREAS = {"x_min": 6.0, "x_max": 6.0, "y_min": 3.0, "y_max": 3.0, "z_min": 2.0, "z_max": 2.0}


def bent(mesh: NamedMesh) -> NamedMesh:
    """The mesh with curved cells: x moves with the square of z."""
    points = mesh.points.copy()
    points[:, 0] += 0.1 * points[:, 2] ** 2
    return replace(mesh, points=points)


def test_box_has_exact_volume_areas_and_outward_normals() -> None:
    elements = FiniteElements(box_mesh((1.0, 2.0, 3.0), (2, 3, 2), origin=(5.0, 0.0, -1.0)))
    assert elements.volume("box") == pytest.approx(6.0, rel=1e-13)
    for name, area in AREAS.items():
        surface = elements.surfaces[name]
        assert surface.area == pytest.approx(area, rel=1e-13)
        outward = (-1.0 if name.endswith("min") else 1.0) * np.eye(3)["xyz".index(name[0])]
        assert_allclose(surface.normals, np.broadcast_to(outward, surface.normals.shape), atol=1e-14)
    assert elements.mesh.points.min(axis=0).tolist() == [5.0, 0.0, -1.0]


@pytest.mark.parametrize(("size", "divisions"), [((1.0, 0.0, 1.0), (1, 1, 1)), ((1.0, 1.0, 1.0), (1, 0, 1))])
def test_box_refuses_what_is_not_positive(size: tuple, divisions: tuple) -> None:
    with pytest.raises(MeshError, match="must be positive"):
        box_mesh(size, divisions)


def test_curved_cells_have_the_volume_of_the_bent_box() -> None:
    # shearing by 0.1 z^2 keeps the volume; the face z_max moves without changing its area
    elements = FiniteElements(bent(box_mesh((1.0, 1.0, 1.0), (2, 2, 2))))
    assert elements.volume("box") == pytest.approx(1.0, rel=1e-13)
    assert elements.surfaces["z_max"].area == pytest.approx(1.0, rel=1e-13)
    slope = np.linspace(0.0, 1.0, 100_001)
    length = np.trapezoid(np.sqrt(1.0 + (0.2 * slope) ** 2), slope)
    assert elements.surfaces["x_max"].area == pytest.approx(length, rel=1e-7)


def test_means_and_loads_over_a_body() -> None:
    elements = FiniteElements(bent(box_mesh((1.0, 1.0, 1.0), (2, 2, 2))))
    assert elements.body_mean(elements.mesh.points[:, 2], "box") == pytest.approx(0.5, rel=1e-13)
    assert elements.body_load("box").sum() == pytest.approx(1.0, rel=1e-13)
    assert elements.surfaces["z_max"].mean(elements.mesh.points[:, 0]) == pytest.approx(0.6, rel=1e-13)
    assert elements.surfaces["z_max"].shares.sum() == pytest.approx(1.0, rel=1e-13)


def test_gmsh_cells_need_their_last_two_nodes_swapped() -> None:
    mesh = bent(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)))
    gmsh_cells = mesh.cells[:, np.argsort(TETRAHEDRON_10.gmsh_order)]
    corners = {name: nodes[:, [1, 0, 2]] for name, nodes in mesh.surfaces.items()}
    again = named_mesh(mesh.points, gmsh_cells[:, TETRAHEDRON_10.gmsh_order], mesh.bodies, corners)
    assert_array_equal(again.cells, mesh.cells)
    assert FiniteElements(again).volume("box") == pytest.approx(1.0, rel=1e-13)
    with pytest.raises(
        MeshError, match=r"inverted cells: 6 in body 'box' of 6; so many .* order of nodes.*NamedMesh"
    ):
        FiniteElements(named_mesh(mesh.points, gmsh_cells, mesh.bodies, corners))


def test_second_order_from_linear_keeps_corners_and_finds_facets_in_any_orientation() -> None:
    box = box_mesh((1.0, 1.0, 1.0), (2, 1, 1))
    corners = np.unique(box.cells[:, :4])
    number = np.full(len(box.points), -1)
    number[corners] = np.arange(len(corners))
    surfaces = {name: number[nodes[:, [2, 1, 0]]] for name, nodes in box.surfaces.items()}
    mesh = second_order(box.points[corners], number[box.cells[:, :4]], box.bodies, surfaces)
    assert_array_equal(mesh.points[: len(corners)], box.points[corners])
    assert len(mesh.points) == len(box.points)
    assert_allclose(FiniteElements(mesh).surfaces["x_max"].normals[0, 0], [1.0, 0.0, 0.0], atol=1e-15)


def test_facet_of_no_cell_is_an_error() -> None:
    mesh = box_mesh((1.0, 1.0, 1.0), (1, 1, 1))
    lost = {"plane": mesh.cells[:1, [4, 5, 6]]}
    with pytest.raises(MeshError, match=r"surface 'plane': 1 of 1 facets are no side"):
        named_mesh(mesh.points, mesh.cells, mesh.bodies, lost)


@pytest.mark.parametrize("order", [1, 2])
def test_scikit_fem_meshes_keep_names_volume_and_curvature(order: int) -> None:
    mesh = skfem.MeshTet.init_tensor(*[np.linspace(0.0, 1.0, 3)] * 3)
    if order == 2:
        mesh = skfem.MeshTet2.from_mesh(mesh)
        mesh.doflocs[0] += 0.1 * mesh.doflocs[2] ** 2
    mesh = mesh.with_subdomains({"low": lambda x: x[2] < 0.5})
    mesh = mesh.with_boundaries({"floor": lambda x: x[2] == 0.0})
    named = FiniteElements(from_scikit_fem(mesh))
    assert set(named.mesh.surfaces) == {"floor", "rest"}
    assert named.volume("low") == pytest.approx(0.5, rel=1e-13)
    assert named.volume("rest") == pytest.approx(0.5, rel=1e-13)
    assert named.surfaces["floor"].area == pytest.approx(1.0, rel=1e-13)


def test_disjoint_union_keeps_pieces_apart_and_refuses_equal_names() -> None:
    a = box_mesh((1.0, 1.0, 1.0), (1, 1, 1), name="a")
    b = box_mesh((1.0, 1.0, 1.0), (1, 1, 1), origin=(2.0, 0.0, 0.0), name="b")
    with pytest.raises(MeshError, match=r"x_max, x_min.*more than one mesh"):
        disjoint_union(a, b)
    b = replace(b, surfaces={f"b_{name}": nodes for name, nodes in b.surfaces.items()})
    elements = FiniteElements(disjoint_union(a, b))
    assert elements.components.max() == 1
    assert elements.volume("b") == pytest.approx(1.0, rel=1e-13)
    assert elements.surfaces["b_x_min"].mean(elements.mesh.points[:, 0]) == pytest.approx(2.0, rel=1e-13)


def test_interface_between_bodies_may_be_named() -> None:
    mesh = box_mesh((2.0, 1.0, 1.0), (2, 1, 1))
    left = mesh.points[mesh.cells[:, :4], 0].max(axis=1) <= 1.0
    bodies = {"left": np.flatnonzero(left).astype(np.int32), "right": np.flatnonzero(~left).astype(np.int32)}
    facets = mesh.cells[left][:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]].reshape(-1, 3)
    joint = facets[np.all(mesh.points[facets, 0] == 1.0, axis=1)]
    corners = {**mesh.surfaces, "joint": joint}
    elements = FiniteElements(named_mesh(mesh.points, mesh.cells, bodies, corners))
    assert elements.interfaces == {"joint"}
    assert elements.surfaces["joint"].area == pytest.approx(1.0, rel=1e-13)


def spoiled(kind: str) -> NamedMesh:
    mesh = box_mesh((1.0, 1.0, 1.0), (1, 1, 1))
    surfaces = dict(mesh.surfaces)
    match kind:
        case "open boundary":
            del surfaces["y_min"]
        case "facet twice":
            surfaces["again"] = surfaces["y_min"][:1]
        case "inward facet":
            surfaces["y_min"] = surfaces["y_min"][:, [0, 2, 1, 5, 4, 3]]
        case "cell without body":
            return replace(mesh, bodies={"box": mesh.bodies["box"][:-1]})
        case "cell in two bodies":
            return replace(mesh, bodies={"box": mesh.bodies["box"], "copy": mesh.bodies["box"][:1]})
        case "loose node":
            return replace(mesh, points=np.vstack([mesh.points, [9.0, 9.0, 9.0]]))
        case "bad node number":
            cells = mesh.cells.copy()
            cells[0, 0] = 999
            return replace(mesh, cells=cells)
        case "not finite":
            points = mesh.points.copy()
            points[0, 0] = np.nan
            return replace(mesh, points=points)
        case "fourth coordinate":
            return replace(mesh, points=np.pad(mesh.points, ((0, 0), (0, 1))))
        case "linear cells":
            return replace(mesh, cells=mesh.cells[:, :4])
        case "empty surface":
            surfaces["none"] = surfaces["y_min"][:0]
    return replace(mesh, surfaces=surfaces)


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ("open boundary", "2 boundary facets belong to no surface, one at"),
        ("facet twice", "1 facets belong to two surfaces"),
        ("inward facet", "surface 'y_min': 2 of 2 facets"),
        ("cell without body", "1 cells are in no body and 0 in several"),
        ("cell in two bodies", "0 cells are in no body and 1 in several"),
        ("loose node", "1 nodes belong to no cell"),
        ("bad node number", "cells: node number outside of 0 to 26"),
        ("not finite", "finite coordinates"),
        ("fourth coordinate", r"points of shape \(27, 4\): need \(n_nodes, 3\)"),
        ("linear cells", r"cells of shape \(6, 4\)"),
        ("empty surface", "surface 'none' of shape"),
    ],
)
def test_bad_meshes_are_refused(kind: str, message: str) -> None:
    with pytest.raises(MeshError, match=message):
        FiniteElements(spoiled(kind))

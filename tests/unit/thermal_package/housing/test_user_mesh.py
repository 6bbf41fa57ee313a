"""A user's mesh file: read as it was written, refused with names and places, solved like the parametric box."""

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.builders.housing import PROTOTYPE
from tests.builders.msh_file import write_msh
from tests.builders.two_blocks import renamed
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, MeshError, NamedMesh, box_mesh, disjoint_union
from thermal.housing.gearbox import build_gearbox
from thermal.housing.mesh_file import read_mesh
from thermal.housing.stations import fit_cylinder, fitted_model

BOX = box_mesh((0.4, 0.3, 0.2), (2, 2, 2), name="housing")


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20", "hexahedron27"])
def test_a_mesh_is_read_as_it_was_written(cell: CellName, tmp_path: Path) -> None:
    mesh = box_mesh((0.4, 0.3, 0.2), (2, 1, 2), cell=cell, name="housing")
    found = read_mesh(write_msh(mesh, tmp_path / "box.msh"))
    assert found.numbering is not None
    read = found.numbering.given_cells(found.points[found.cells])
    assert_array_equal(read, mesh.points[mesh.cells])
    assert found.bodies.keys() == mesh.bodies.keys()
    ours, theirs = FiniteElements(mesh), FiniteElements(found)
    assert ours.volume("housing") == pytest.approx(theirs.volume("housing"))
    areas = {name: face.area for name, face in theirs.surfaces.items()}
    assert areas == pytest.approx({name: face.area for name, face in ours.surfaces.items()})


def test_nodes_and_cells_that_are_neighbours_get_near_numbers(tmp_path: Path) -> None:
    mesh = box_mesh((0.4, 0.4, 0.4), (8, 8, 8), name="housing")
    chance = np.random.default_rng(1)
    moved = chance.permutation(len(mesh.points)).astype(np.int32)
    points = np.empty_like(mesh.points)
    points[moved] = mesh.points
    mixed = replace(
        mesh, points=points, cells=moved[mesh.cells[chance.permutation(len(mesh.cells))]],
        surfaces={name: moved[nodes] for name, nodes in mesh.surfaces.items()},
    )  # fmt: skip
    found = read_mesh(write_msh(mixed, tmp_path / "mixed.msh"))
    assert np.median(np.ptp(mixed.cells, axis=1)) > 0.5 * len(points)
    assert np.median(np.ptp(found.cells, axis=1)) < 0.1 * len(points)
    first = found.cells.min(axis=1)
    assert (np.diff(first) >= 0).all()
    assert sorted(map(tuple, found.points)) == sorted(map(tuple, points))


def refused(file: Path, *words: str) -> None:
    with pytest.raises(MeshError) as error:
        read_mesh(file)
    for word in (file.name, *words):
        assert word in str(error.value)


def test_surfaces_without_a_name_are_listed_with_their_places(tmp_path: Path) -> None:
    file = write_msh(BOX, tmp_path / "open.msh", left_out=["x_min", "x_max"])
    refused(file, "16 boundary facets have no name: 8 about (0, 0.15, 0.1) m, 8 about (0.4, 0.15, 0.1) m")


def test_surfaces_named_twice_are_listed(tmp_path: Path) -> None:
    file = write_msh(BOX, tmp_path / "twice.msh", doubled={"z_max": "lid"})
    refused(file, "8 facets lie twice", "lid, z_max", "name every face once")


def test_a_file_cut_short_says_where(tmp_path: Path) -> None:
    text = write_msh(BOX, tmp_path / "whole.msh").read_text()
    cut = tmp_path / "cut.msh"
    for share, section in ((0.2, "$Nodes"), (0.7, "$Elements")):
        cut.write_text(text[: int(share * len(text))])
        refused(cut, f"section {section} has no end", "cut short")
    cut.write_text("solid box\n")
    refused(cut, "no section $MeshFormat")
    cut.write_text(text.replace("$PhysicalNames", "$Names").replace("$EndPhysicalNames", "$EndNames"))
    refused(cut, "name volumes and surfaces as physical groups")
    refused(tmp_path / "absent.msh", "No such file")


def test_elements_of_first_order_are_refused(tmp_path: Path) -> None:
    text = write_msh(BOX, tmp_path / "box.msh").read_text().splitlines()
    start = text.index("$Elements")
    short = [
        " ".join(("4" if row.split()[1] == "11" else "2") if k == 1 else word for k, word in
                 enumerate(row.split()[: 5 + (4 if row.split()[1] == "11" else 3)]))
        for row in text[start + 2 : -1]
    ]  # fmt: skip
    file = tmp_path / "linear.msh"
    file.write_text("\n".join([*text[: start + 2], *short, "$EndElements", ""]))
    refused(file, "Tetrahedron 4", "second order")


def test_millimetres_and_bodies_in_pieces_are_refused(tmp_path: Path) -> None:
    large = replace(BOX, points=1e3 * BOX.points)
    refused(write_msh(large, tmp_path / "mm.msh"), "400 m long", "write it in metres")
    far = replace(renamed(BOX, "far"), points=BOX.points + 1.0, bodies={"far": BOX.bodies["housing"]})
    both = disjoint_union(BOX, far)
    apart = NamedMesh(
        both.points, both.cells, {"housing": np.arange(len(both.cells), dtype=np.int32)}, both.surfaces
    )
    refused(write_msh(apart, tmp_path / "apart.msh"), "body 'housing' in 2 pieces of 48, 48 cells")


def test_reading_takes_memory_for_the_mesh_not_for_pairs_of_cells(tmp_path: Path) -> None:
    # a cell shares nodes with about 70 others; nodes, cells, sides of a cell take about 1.2 kB
    mesh = box_mesh((0.4, 0.3, 0.2), (10, 10, 10), name="housing")
    file = write_msh(mesh, tmp_path / "box.msh")
    tracemalloc.start()
    found = read_mesh(file)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(found.cells) == len(mesh.cells)
    assert peak < 1500.0 * len(mesh.cells)


def test_an_inverted_element_is_refused_by_the_name_of_its_body(tmp_path: Path) -> None:
    points = BOX.points.copy()
    middle = BOX.cells[0, 4]
    points[middle] += 0.9 * (points[BOX.cells[0, 3]] - points[middle])
    mesh = read_mesh(write_msh(replace(BOX, points=points), tmp_path / "bent.msh"))
    with pytest.raises(MeshError, match=r"inverted cells: .* in body 'housing'"):
        FiniteElements(mesh)


def test_circles_are_fitted_to_arcs_too() -> None:
    angle = np.linspace(0.3, 2.0, 9)
    arc = np.column_stack([np.linspace(0.1, 0.14, 9), 0.2 + 0.05 * np.cos(angle), 0.3 + 0.05 * np.sin(angle)])
    found = fit_cylinder(arc)
    assert_allclose(found.centre, (0.12, 0.2, 0.3), atol=1e-12)
    assert (found.radius, found.length) == pytest.approx((0.05, 0.04))
    assert found.roundness < 1e-12


def test_stations_are_those_of_the_box_the_mesh_was_made_of(tmp_path: Path) -> None:
    """The box is drawn 0.1 m beside where the case has it: stations follow the mesh."""
    box = build_gearbox(PROTOTYPE, "quick")
    moved = replace(box.mesh, points=box.mesh.points + np.array([0.1, 0.02, 0.0]))
    model = fitted_model(read_mesh(write_msh(moved, tmp_path / "gearbox.msh")), PROTOTYPE)
    assert model.no_expansion == ""
    for ours, theirs in zip(box.bearings, model.bearings, strict=True):
        assert ours.name == theirs.name and ours.locating == theirs.locating
        assert_allclose(np.subtract(theirs.centre, ours.centre), (0.1, 0.02, 0.0), atol=2e-6)
        assert theirs.diameter == pytest.approx(ours.diameter, rel=1e-4)
    assert [seal.name for seal in model.seals] == [seal.name for seal in box.seals]
    assert [(s.start, s.end) for s in model.shafts] == [
        pytest.approx((s.start + 0.1, s.end + 0.1)) for s in box.shafts
    ]


def test_what_clearances_need_is_named() -> None:
    assert "body shaft_pinion" in fitted_model(BOX, PROTOTYPE).no_expansion
    hexes = box_mesh((0.4, 0.3, 0.2), (1, 1, 1), cell="hexahedron20", name="housing")
    assert "ten-node tetrahedra" in fitted_model(hexes, PROTOTYPE).no_expansion

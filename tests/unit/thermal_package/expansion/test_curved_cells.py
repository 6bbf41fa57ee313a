"""Thin cells beside coarse arcs: the linear space under the multigrid knows their true stiffness."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import sparse

from thermal.expansion.elastic import ElasticSetup, three_two_one
from thermal.fe import curved
from thermal.fe.curved import bent_cells, linear_stiffness
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, NamedMesh, box_mesh

STEEL = (210e9, 0.3, 12e-6)
KINDS: tuple[CellName, ...] = ("tetra10", "hexahedron20")


def ring(thin: float, around: int, cell: CellName = "tetra10") -> NamedMesh:
    """Half a ring about x: a layer as thick as ``thin`` [m] at the bore, a thick one behind it."""
    mesh = box_mesh((0.05, 1.0, 1.0), (2, around, 2), cell=cell, name="ring")
    x, turn, depth = mesh.points.T
    radius = np.interp(depth, (0.0, 0.5, 1.0), (0.038, 0.038 + thin, 0.078))
    points = np.column_stack([x, -radius * np.cos(np.pi * turn), radius * np.sin(np.pi * turn)])
    return replace(mesh, points=points)


def iterations(elements: FiniteElements) -> int:
    """Of conjugate gradients for the growth under an uneven field."""
    points = elements.mesh.points
    fixed = np.zeros((len(points), 3), dtype=bool)
    for node, directions in three_two_one(points, elements.corners):
        fixed[node, list(directions)] = True
    setup = ElasticSetup(elements, {"ring": STEEL}, fixed)
    return setup.solve(300.0 + 100.0 * np.sin(30.0 * points[:, 1]), 300.0, 1e-7).iterations


def test_a_thin_layer_on_a_coarse_bore_costs_no_more_iterations_than_a_fine_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    coarse, fine = FiniteElements(ring(0.3e-3, 4)), FiniteElements(ring(0.3e-3, 24))
    assert len(bent_cells(coarse)) > 0
    ours = iterations(coarse)
    assert ours <= 1.5 * iterations(fine)
    monkeypatch.setattr(curved, "BENT", np.inf)
    assert iterations(coarse) > 2 * ours


@pytest.mark.parametrize("cell", KINDS)
def test_where_all_cells_are_bent_the_linear_stiffness_is_variational(
    cell: CellName, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(curved, "BENT", -1.0)
    elements = FiniteElements(ring(0.01, 4, cell))
    young, poisson = np.full(len(elements.mesh.cells), 210e9), np.full(len(elements.mesh.cells), 0.3)
    whole = elements.fine.block_matrix(elements.fine.elasticity(young, poisson))
    way = sparse.kron(elements.prolongation, np.eye(3), format="csr")
    wanted = (way.T @ sparse.csr_array(whole) @ way).toarray()
    found = linear_stiffness(elements, young, poisson).toarray()
    assert_allclose(found, wanted, atol=1e-12 * np.abs(wanted).max())


@pytest.mark.parametrize("cell", KINDS)
def test_straight_cells_are_not_bent(cell: CellName) -> None:
    elements = FiniteElements(box_mesh((1.0, 1.0, 1e-3), (2, 2, 2), cell=cell))
    assert len(bent_cells(elements)) == 0
    young, poisson = np.full(len(elements.mesh.cells), 210e9), np.full(len(elements.mesh.cells), 0.3)
    plain = elements.coarse.block_matrix(elements.coarse.elasticity(young, poisson))
    assert abs(linear_stiffness(elements, young, poisson) - plain).max() == 0.0


@pytest.mark.parametrize("cell", KINDS)
def test_bent_cells_are_those_of_the_thin_layer(cell: CellName) -> None:
    elements = FiniteElements(ring(0.6e-3, 4, cell))
    corners = elements.mesh.points[elements.mesh.cells[:, : elements.shape.n_corners]]
    thin = np.hypot(corners[:, :, 1], corners[:, :, 2]).max(axis=1) < 0.039
    assert set(bent_cells(elements)) == set(np.flatnonzero(thin))

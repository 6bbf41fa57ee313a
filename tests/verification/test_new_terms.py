"""How a new term is added: a weak form, assembled by scikit-fem in our numbering, solved by our multigrid.

Manufactured solutions on a curved mesh; with the term in place the error falls with order 3.
"""

from dataclasses import replace

import numpy as np
import pytest
from skfem import BilinearForm
from skfem.helpers import dot, grad, mul

from thermal import forms
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, NamedMesh, box_mesh
from thermal.fe.solver import HeldMatrix, TwoLevelMultigrid, conjugate_gradient, constrain

CONDUCTIVITY = np.array([[4.0, 1.0, 0.0], [1.0, 3.0, 0.5], [0.0, 0.5, 2.0]])
"""Of a laminate [W/(m K)]."""


@BilinearForm
def anisotropic_conduction(u, v, w):
    return dot(mul(w.conductivity, grad(u)), grad(v))


def exact(x: np.ndarray) -> np.ndarray:
    return np.exp(0.5 * x[0]) * np.sin(2.0 * x[1] + 1.0) * np.cos(x[2])


def second_derivatives(x: np.ndarray) -> np.ndarray:
    """(3, 3, ...) of the exact field."""
    parts = [
        np.exp(0.5 * x[0])
        * np.array([np.ones_like(x[0]), np.full_like(x[0], 0.5), np.full_like(x[0], 0.25)]),
        np.array([np.sin(2 * x[1] + 1), 2 * np.cos(2 * x[1] + 1), -4 * np.sin(2 * x[1] + 1)]),
        np.array([np.cos(x[2]), -np.sin(x[2]), -np.cos(x[2])]),
    ]
    axes = np.eye(3, dtype=int)

    def of(orders: np.ndarray) -> np.ndarray:
        return np.prod([part[order] for part, order in zip(parts, orders, strict=True)], axis=0)

    return np.array([[of(i + j) for j in axes] for i in axes])


def curved(cell: CellName, n: int) -> NamedMesh:
    mesh = box_mesh((1.0, 1.0, 1.0), (n, n, n), cell=cell)
    x, y, z = mesh.points.T
    return replace(mesh, points=np.column_stack([x + 0.1 * np.sin(2.0 * z), y + 0.1 * x * z, z]))


def error(elements: FiniteElements, field: np.ndarray) -> float:
    """L2 error."""
    basis = elements.bases.cells()
    wrong = basis.interpolate(field) - exact(np.asarray(basis.global_coordinates()))
    return float(np.sqrt(np.sum(wrong**2 * basis.dx)))


def held_outside(elements: FiniteElements) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of the boundary and the exact field there."""
    held = np.zeros(len(elements.mesh.points), dtype=bool)
    for surface in elements.surfaces.values():
        held[surface.nodes] = True
    return held, np.where(held, exact(elements.mesh.points.T), 0.0)


def anisotropic(cell: CellName, n: int) -> float:
    elements = FiniteElements(curved(cell, n))
    basis = elements.bases.cells()
    matrix = anisotropic_conduction.assemble(basis, conductivity=CONDUCTIVITY[:, :, None, None])
    second = second_derivatives(np.asarray(basis.global_coordinates()))
    load = forms.volume_source.assemble(basis, source=-np.einsum("ij,ij...", CONDUCTIVITY, second))

    held, given = held_outside(elements)
    right = np.where(held, 0.0, load - matrix @ given)
    isotropic = elements.coarse.matrix(elements.coarse.conduction(np.full(len(elements.mesh.cells), 3.0)))
    inner, corners = constrain(matrix, held), held[elements.corners]
    multigrid = TwoLevelMultigrid(
        HeldMatrix(inner, held), HeldMatrix(constrain(isotropic, corners), corners), elements.prolongation
    )
    solution = conjugate_gradient(inner, right, multigrid)
    return error(elements, given + solution.values)


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron27"])
def test_anisotropic_conduction_with_a_volume_source(cell: CellName) -> None:
    assert np.log2(anisotropic(cell, 3) / anisotropic(cell, 6)) == pytest.approx(3.0, abs=0.3)

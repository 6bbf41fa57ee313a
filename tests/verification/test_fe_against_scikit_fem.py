"""The compiled assembly equals scikit-fem's quadratic tetrahedra entry by entry, straight and curved."""

from dataclasses import replace

import numpy as np
import pytest
import skfem
from scipy.spatial import cKDTree
from skfem.helpers import dot, eye, grad, sym_grad, trace
from skfem.models.elasticity import lame_parameters

from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import box_mesh
from thermal.fe.reference import TETRAHEDRON_14, TRIANGLE_7, Rule

YOUNG, POISSON = 210.0, 0.3


def rule(of: Rule) -> tuple[np.ndarray, np.ndarray]:
    return of.points.T, of.weights


@pytest.fixture(scope="module", params=["straight", "curved"])
def pair(request: pytest.FixtureRequest) -> tuple[FiniteElements, skfem.MeshTet2, np.ndarray]:
    """Elements, the same mesh in scikit-fem, and the number there of each of our nodes."""
    mesh = box_mesh((1.0, 1.2, 0.8), (2, 2, 2))
    if request.param == "curved":
        x, y, z = mesh.points.T
        mesh = replace(mesh, points=np.column_stack([x + 0.1 * z**2, y * (1.0 + 0.2 * x), z + 0.05 * x * y]))
    number = {}
    corners = np.unique(mesh.cells[:, :4])
    number = np.full(len(mesh.points), -1)
    number[corners] = np.arange(len(corners))
    linear = skfem.MeshTet(mesh.points[corners].T, number[mesh.cells[:, :4]].T)
    other = skfem.MeshTet2.from_mesh(linear)
    for local in range(10):
        other.doflocs[:, other.dofs.element_dofs[local]] = mesh.points[mesh.cells[:, local]].T
    _, same = cKDTree(other.doflocs.T).query(mesh.points)
    return FiniteElements(mesh), other, same


def entries(matrix, order: np.ndarray) -> np.ndarray:
    """Dense matrix in the order of our unknowns."""
    return matrix.toarray()[np.ix_(order, order)]


def vector_order(basis: skfem.Basis, points: np.ndarray) -> np.ndarray:
    """Number in ``basis`` of each of our unknowns 3 node + direction."""
    near = cKDTree(basis.doflocs.T).query_ball_point(points, 1e-9)
    return np.concatenate([sorted(three) for three in near])


def close(a: np.ndarray, b: np.ndarray) -> None:
    assert np.abs(a - b).max() <= 1e-12 * np.abs(b).max()


def test_conduction(pair) -> None:
    elements, mesh, order = pair
    basis = skfem.Basis(mesh, skfem.ElementTetP2(), quadrature=rule(TETRAHEDRON_14))
    theirs = skfem.BilinearForm(lambda u, v, w: 45.0 * dot(grad(u), grad(v))).assemble(basis)
    values = elements.conduction(np.full(len(elements.mesh.cells), 45.0), elements.fine)
    close(elements.fine.matrix(values).toarray(), entries(theirs, order))


def test_linear_level_is_the_galerkin_product(pair) -> None:
    elements, _, _ = pair
    k = np.linspace(1.0, 2.0, len(elements.mesh.cells))
    fine, coarse = (level.matrix(elements.conduction(k, level)) for level in (elements.fine, elements.coarse))
    close(coarse.toarray(), (elements.prolongation.T @ fine @ elements.prolongation).toarray())
    young = elements.elasticity(k, 0.3 * k / k, elements.coarse)
    assert young.shape == (len(elements.coarse.indices), 3, 3)


def test_film_matrix_and_load(pair) -> None:
    elements, mesh, order = pair
    face = elements.surfaces["x_max"]
    mesh = mesh.with_boundaries({"face": _facets_like(mesh, elements, "x_max")})
    basis = skfem.FacetBasis(mesh, skfem.ElementTetP2(), facets="face", quadrature=rule(TRIANGLE_7))
    theirs = skfem.BilinearForm(lambda u, v, w: (2.0 + w.x[1]) * u * v).assemble(basis)
    height = face.at_points(elements.mesh.points)[:, :, 1]
    values = np.zeros(len(elements.fine.indices))
    face.add_mass(values, 2.0 + height)
    # the 7 points of scikit-fem turn with its facet numbering; the rule is symmetric, so sums agree
    close(elements.fine.matrix(values).toarray(), entries(theirs, order))
    load = skfem.LinearForm(lambda v, w: w.x[2] * v).assemble(basis)
    close(face.load(face.at_points(elements.mesh.points)[:, :, 2]), load[order])


def _facets_like(mesh: skfem.MeshTet2, elements: FiniteElements, surface: str) -> np.ndarray:
    corners = elements.mesh.points[elements.mesh.surfaces[surface][:, :3]].mean(axis=1)
    centres = mesh.p[:, mesh.facets].mean(axis=1).T
    return np.sort(cKDTree(centres).query(corners)[1])


def test_elasticity_and_expansion_load(pair) -> None:
    elements, mesh, order = pair
    n = len(elements.mesh.cells)
    quadrature = rule(TETRAHEDRON_14)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()), quadrature=quadrature)
    lam, mu = lame_parameters(YOUNG, POISSON)

    @skfem.BilinearForm
    def stiffness(u, v, w):
        strain = sym_grad(u)
        stress = lam * eye(trace(strain), 3) + 2.0 * mu * strain
        return sum(stress[i, j] * sym_grad(v)[i, j] for i in range(3) for j in range(3))

    unknowns = vector_order(basis, elements.mesh.points)
    blocks = elements.elasticity(np.full(n, YOUNG), np.full(n, POISSON), elements.fine)
    close(elements.fine.block_matrix(blocks).toarray(), entries(stiffness.assemble(basis), unknowns))

    excess = np.sin(3.0 * elements.mesh.points @ [1.0, 2.0, 3.0])
    scalar = skfem.Basis(mesh, skfem.ElementTetP2(), quadrature=quadrature)
    field = np.empty(len(excess))
    field[order] = excess
    form = skfem.LinearForm(lambda v, w: 7.0 * w["t"] * trace(grad(v)))
    theirs = form.assemble(basis, t=scalar.interpolate(field))
    close(elements.expansion_load(np.full(n, 7.0), excess).ravel(), theirs[unknowns])

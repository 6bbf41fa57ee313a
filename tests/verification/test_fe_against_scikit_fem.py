"""The compiled assembly equals scikit-fem's entry by entry: every cell, straight and curved."""

from dataclasses import replace

import numpy as np
import pytest
import skfem
from scipy.spatial import cKDTree
from skfem.helpers import dot, eye, grad, sym_grad, trace
from skfem.models.elasticity import lame_parameters

from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import box_mesh
from thermal.fe.reference import QuadratureRule, rules_of

YOUNG, POISSON = 210.0, 0.3
ELEMENTS = {
    "tetra10": skfem.ElementTetP2, "hexahedron20": skfem.ElementHexS2, "hexahedron27": skfem.ElementHex2,
}  # fmt: skip


def rule(of: QuadratureRule, brick: bool) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights on scikit-fem's reference cell, which for bricks is the unit cube."""
    if brick:
        return 0.5 * (of.points.T + 1.0), of.weights / 2.0 ** of.points.shape[1]
    return of.points.T, of.weights


class Pair:
    """Elements, the same mesh in scikit-fem, and the number there of each of our nodes."""

    def __init__(self, cell: str, curved: bool) -> None:
        self.curved = curved
        mesh = box_mesh((1.0, 1.2, 0.8), (2, 2, 2), cell=cell)
        if curved:
            x, y, z = mesh.points.T
            bent = np.column_stack([x + 0.1 * z**2, y * (1.0 + 0.2 * x), z + 0.05 * x * y])
            mesh = replace(mesh, points=bent)
        self.elements = FiniteElements(mesh)
        self.brick = mesh.shape.n_corners == 8
        self.rules = rules_of(mesh.shape)
        corners = self.elements.corners
        numbers = np.searchsorted(corners, mesh.cells[:, : mesh.shape.n_corners])
        linear = self._linear(mesh.points[corners], numbers)
        if curved:
            linear = (skfem.MeshHex2 if self.brick else skfem.MeshTet2).from_mesh(linear)
            self._curve(linear, mesh)
        self.mesh = linear
        self.element = ELEMENTS[cell]()
        self.order = self._numbers(skfem.Basis(self.mesh, self.element, intorder=2))

    def _linear(self, points: np.ndarray, cells: np.ndarray) -> skfem.Mesh:
        if not self.brick:
            return skfem.MeshTet(points.T, cells.T)
        ours, theirs = self.elements.shape.corners, 2.0 * np.array(skfem.MeshHex.elem.doflocs) - 1.0
        order = [int(np.argmin(np.linalg.norm(ours - place, axis=1))) for place in theirs]
        return skfem.MeshHex(points.T, cells[:, order].T)

    def _curve(self, mesh: skfem.Mesh, named) -> None:
        """Give the nodes of a second-order scikit-fem mesh the places of ours."""
        theirs = np.array(mesh.elem.doflocs) * (2.0 if self.brick else 1.0) - (1.0 if self.brick else 0.0)
        shapes = self.elements.shape.values(theirs)
        for cell, nodes in enumerate(named.cells):
            mesh.doflocs[:, mesh.dofs.element_dofs[:, cell]] = (shapes @ named.points[nodes]).T

    def _numbers(self, basis: skfem.Basis) -> np.ndarray:
        places = basis.doflocs.T
        distance, same = cKDTree(places).query(self.elements.mesh.points)
        assert distance.max() < 1e-12
        return same

    def basis(self, of: QuadratureRule, element: skfem.Element | None = None) -> skfem.Basis:
        return skfem.Basis(self.mesh, element or self.element, quadrature=rule(of, self.brick))


@pytest.fixture(
    scope="module",
    params=[(c, k) for c in ELEMENTS for k in (False, True) if (c, k) != ("hexahedron20", True)],
    ids=lambda p: f"{p[0]}-{'curved' if p[1] else 'straight'}",
)
def pair(request: pytest.FixtureRequest) -> Pair:
    # scikit-fem has no curved mesh of 20-node bricks
    return Pair(*request.param)


def entries(matrix, order: np.ndarray) -> np.ndarray:
    """Dense matrix in the order of our unknowns."""
    return matrix.toarray()[np.ix_(order, order)]


def close(a: np.ndarray, b: np.ndarray) -> None:
    assert np.abs(a - b).max() <= 1e-12 * np.abs(b).max()


def test_conduction(pair: Pair) -> None:
    elements = pair.elements
    basis = pair.basis(pair.rules.stiffness)
    theirs = skfem.BilinearForm(lambda u, v, w: (45.0 + w.x[0]) * dot(grad(u), grad(v))).assemble(basis)
    at = 45.0 + elements.fine.at_points(elements.mesh.points[:, 0])
    close(elements.fine.matrix(elements.fine.conduction(at)).toarray(), entries(theirs, pair.order))


def test_fluxes_at_points_give_the_same_as_the_matrix(pair: Pair) -> None:
    elements, fine = pair.elements, pair.elements.fine
    field = np.sin(elements.mesh.points @ [1.0, 2.0, 3.0])
    k = np.linspace(1.0, 2.0, len(elements.mesh.cells))
    flux = k[:, None, None] * fine.gradient(field)
    close(fine.flux_load(flux), fine.matrix(elements.conduction(k, fine)) @ field)
    slopes = np.einsum("eqbi,eb->eqi", fine.gradients(), field[elements.mesh.cells])
    close(slopes, fine.gradient(field))


def test_film_matrix_and_load(pair: Pair) -> None:
    elements = pair.elements
    face = elements.surfaces["x_max"]
    centres = pair.mesh.p[:, pair.mesh.facets].mean(axis=1).T
    corners = elements.mesh.points[face.facets[:, : face.shape.n_corners]].mean(axis=1)
    mesh = pair.mesh.with_boundaries({"face": np.sort(cKDTree(centres).query(corners)[1])})
    quadrature = rule(pair.rules.side, pair.brick)
    basis = skfem.FacetBasis(mesh, pair.element, facets="face", quadrature=quadrature)
    theirs = skfem.BilinearForm(lambda u, v, w: (2.0 + w.x[1]) * u * v).assemble(basis)
    height = face.at_points(elements.mesh.points)[:, :, 1]
    values = np.zeros(len(elements.fine.indices))
    face.add_mass(values, 2.0 + height)
    # the points of scikit-fem turn with its facet numbering; the rule is symmetric, so sums agree
    close(elements.fine.matrix(values).toarray(), entries(theirs, pair.order))
    load = skfem.LinearForm(lambda v, w: w.x[2] * v).assemble(basis)
    close(face.load(face.at_points(elements.mesh.points)[:, :, 2]), load[pair.order])


def test_elasticity_and_expansion_load(pair: Pair) -> None:
    elements = pair.elements
    n = len(elements.mesh.cells)
    lam, mu = lame_parameters(YOUNG, POISSON)

    @skfem.BilinearForm
    def stiffness(u, v, w):
        strain = sym_grad(u)
        stress = lam * eye(trace(strain), 3) + 2.0 * mu * strain
        return sum(stress[i, j] * sym_grad(v)[i, j] for i in range(3) for j in range(3))

    basis = pair.basis(pair.rules.stiffness, skfem.ElementVector(pair.element))
    near = cKDTree(basis.doflocs.T).query_ball_point(elements.mesh.points, 1e-9)
    unknowns = np.concatenate([sorted(three) for three in near])
    blocks = elements.elasticity(np.full(n, YOUNG), np.full(n, POISSON), elements.fine)
    close(elements.fine.block_matrix(blocks).toarray(), entries(stiffness.assemble(basis), unknowns))

    excess = np.sin(elements.mesh.points @ [1.0, 2.0, 3.0])
    scalar = pair.basis(pair.rules.stiffness)
    field = np.empty(len(excess))
    field[pair.order] = excess
    form = skfem.LinearForm(lambda v, w: 7.0 * w["t"] * trace(grad(v)))
    loads = pair.basis(pair.rules.stiffness, skfem.ElementVector(pair.element))
    theirs = form.assemble(loads, t=scalar.interpolate(field))
    close(elements.expansion_load(np.full(n, 7.0), excess).ravel(), theirs[unknowns])


def test_linear_fields_pass_between_the_levels_unchanged(pair: Pair) -> None:
    elements = pair.elements
    k = np.linspace(1.0, 2.0, len(elements.mesh.cells))
    fine, coarse = (level.matrix(elements.conduction(k, level)) for level in (elements.fine, elements.coarse))
    product = (elements.prolongation.T @ fine @ elements.prolongation).toarray()
    slope = elements.mesh.points[elements.corners] @ [1.0, -2.0, 3.0]
    assert elements.prolongation @ slope == pytest.approx(elements.mesh.points @ [1.0, -2.0, 3.0], abs=1e-13)
    assert elements.prolongation @ np.ones(len(slope)) == pytest.approx(1.0, abs=1e-14)
    if not pair.curved:
        close(coarse.toarray(), product)

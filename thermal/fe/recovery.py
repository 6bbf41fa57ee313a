"""Recovered gradients and the energy-norm error they reveal.

On the patch of cells round every corner a quadratic polynomial is fitted to the gradient at the points of the
stiffness rule; its values at the nodes, averaged over the patches a node lies in, make a continuous gradient
that is more accurate than the computed one. Patches end at the border of a body, where gradients may jump.
Source: Zienkiewicz, Zhu, Int. J. Numer. Methods Eng. 33 (1992) 1331 and 1365.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.elements import FiniteElements

TERMS = 10
"""Monomials of the polynomial of a patch, up to the second degree, the constant first."""

RIDGE = 1e-12
"""Share of the mean diagonal added to a patch's matrix, so that patches of few cells can be solved."""

DETERMINED = 1e-6
"""Smallest eigenvalue of a patch's matrix, relative to its mean diagonal, from which the patch is trusted."""

POOR = 1e-9
"""Weight of the other patches, which only count where there are none to be trusted."""


@dataclass(frozen=True)
class EnergyError:
    """Estimated error of a field in the energy norm, root of the integral of k (grad e)^2 [sqrt(W K)]."""

    by_cell: FloatArray
    """(n_cells,) contributions; their squares add up."""
    energy: float
    """Energy norm of the computed field."""

    @property
    def total(self) -> float:
        """Of the whole mesh."""
        return float(np.sqrt(np.sum(self.by_cell**2)))

    @property
    def relative(self) -> float:
        """Share of the energy norm of field and error together [-]; 0 for a field without gradients."""
        whole = float(np.hypot(self.energy, self.total))
        return self.total / whole if whole > 0.0 else 0.0


def energy_error(elements: FiniteElements, field: FloatArray, conductivity: FloatArray) -> EnergyError:
    """Error of a nodal ``field`` (n_nodes,) with ``conductivity`` (n_cells,) [W/(m K)]."""
    by_cell, energy = np.zeros(len(elements.mesh.cells)), 0.0
    for body in elements.mesh.bodies.values():
        cells = np.unique(body).astype(np.int32)
        computed = elements.fine.gradient(field, cells)
        nodes, recovered = recovered_gradient(elements, computed, cells)
        number = np.full(len(elements.mesh.points), -1, dtype=np.int32)
        number[nodes] = np.arange(len(nodes), dtype=np.int32)
        smooth = np.einsum("qb,ebi->eqi", elements.fine.values, recovered[number[elements.mesh.cells[cells]]])
        weights = conductivity[cells, None] * elements.fine.volumes[cells]
        by_cell[cells] = np.sqrt(np.einsum("eq,eqi->e", weights, (smooth - computed) ** 2))
        energy += float(np.einsum("eq,eqi->", weights, computed**2))
    return EnergyError(by_cell, float(np.sqrt(energy)))


def recovered_gradient(
    elements: FiniteElements, computed: FloatArray, cells: IndexArray
) -> tuple[IndexArray, FloatArray]:
    """Nodes (n,) of some cells of one body and their recovered gradient (n, 3).

    computed : (k, n_q, 3) gradient at the points of the stiffness rule of the k ``cells``
    """
    mesh, shape = elements.mesh, elements.shape
    at_points = elements.fine.at_points(mesh.points, cells)
    local: IndexArray = mesh.cells[cells]
    corners, owners = np.unique(local[:, : shape.n_corners], return_inverse=True)
    patch: IndexArray = owners.reshape(len(cells), -1).astype(np.int32)
    corners = corners.astype(np.int32)
    size = np.zeros(len(corners))
    for column in range(shape.n_corners):
        reach = np.abs(at_points - mesh.points[local[:, column]][:, None]).max(axis=(1, 2))
        np.maximum.at(size, patch[:, column], reach)
    matrix = np.zeros((len(corners), TERMS**2))
    right = np.zeros((len(corners), 3 * TERMS))
    for column in range(shape.n_corners):
        numbers = patch[:, column]
        terms = _terms(at_points - mesh.points[local[:, column]][:, None], size[numbers][:, None])
        into = sparse.csr_array(
            (np.ones(len(cells)), (numbers, np.arange(len(cells)))), shape=(len(corners), len(cells))
        )
        turned = terms.transpose(0, 2, 1)
        matrix += np.asarray(into @ (turned @ terms).reshape(len(cells), -1))
        right += np.asarray(into @ (turned @ computed).reshape(len(cells), -1))
    whole = matrix.reshape(-1, TERMS, TERMS)
    mean = np.einsum("kaa->k", whole) / TERMS
    poor = np.linalg.eigvalsh(whole)[:, 0] < DETERMINED * mean
    whole[:, 1:, 1:] += RIDGE * mean[:, None, None] * np.eye(TERMS - 1)
    polynomial = np.asarray(np.linalg.solve(whole, right.reshape(-1, TERMS, 3)), dtype=np.float64)
    patches = _Patches(corners, size, polynomial, np.where(poor, POOR, 1.0))
    return _averaged(elements, local, patch, patches)


@dataclass(frozen=True)
class _Patches:
    """Corner (n,), reach [m], polynomial (n, 10, 3) and weight of every patch."""

    corners: IndexArray
    size: FloatArray
    polynomial: FloatArray
    weight: FloatArray

    def at(self, mine: IndexArray, off: FloatArray) -> FloatArray:
        """(k, 3) gradient of the patches ``mine`` (k,) at ``off`` (k, 3) from their corners."""
        return np.asarray((_terms(off, self.size[mine])[:, None] @ self.polynomial[mine])[:, 0])


def _averaged(
    elements: FiniteElements, local: IndexArray, patch: IndexArray, patches: _Patches
) -> tuple[IndexArray, FloatArray]:
    """Nodes and the mean of the polynomials there: of the patches of the corners a node lies between.

    A corner takes its own. A node that has poor patches only takes those of all corners of its cells.
    """
    points, shape = elements.mesh.points, elements.shape
    nodes = np.unique(local)
    values, weights = np.zeros((len(nodes), 3)), np.zeros(len(nodes))
    corners = np.searchsorted(nodes, patches.corners)
    values[corners] = patches.weight[:, None] * patches.polynomial[:, 0]
    weights[corners] = patches.weight
    poor = (patches.weight < 1.0)[patch]
    everyone = tuple(range(shape.n_corners))
    chosen = [
        (node, parents, np.arange(len(local))) for node, parents in enumerate(shape.parents, len(everyone))
    ]
    between = [*((node,) for node in everyone), *shape.parents]
    chosen += [
        (node, everyone, np.flatnonzero(poor[:, list(parents)].all(axis=1)))
        for node, parents in enumerate(between)
    ]
    for node, parents, cells in chosen:
        place = np.searchsorted(nodes, local[cells, node])
        for parent in parents:
            numbers = patch[cells, parent]
            weight = patches.weight[numbers]
            gradient = patches.at(numbers, points[local[cells, node]] - points[patches.corners[numbers]])
            for direction in range(3):
                values[:, direction] += np.bincount(place, weight * gradient[:, direction], len(nodes))
            weights += np.bincount(place, weight, len(nodes))
    return nodes.astype(np.int32), values / weights[:, None]


def _terms(off: FloatArray, size: FloatArray) -> FloatArray:
    """(..., 10) monomials of ``off`` (..., 3) relative to ``size`` (...)."""
    x, y, z = np.moveaxis(off / size[..., None], -1, 0)
    terms = np.empty((*x.shape, TERMS))
    for place, term in enumerate((1.0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z)):
        terms[..., place] = term
    return terms

"""The linear stiffness of a curved mesh: straight cells where they serve, the curved ones themselves elsewhere.

Between the corners of a strongly curved cell (a thin ring beside a coarse arc) the straight-sided cell is flat,
turned inside out or much too large. Its stiffness then has little to do with that of the mesh and multigrid
stalls. For such cells alone the linear stiffness is P^T K P with the prolongation P, which is exact.
Source: Briggs, Henson, McCormick, A Multigrid Tutorial, 2nd ed., ch. 10 (variational coarse operator).
"""

import numpy as np
from scipy import sparse

from thermal.fe.elements import FiniteElements
from thermal.fe.levels import Level
from thermal.fe.reference import rules_of
from thermal.fe.shapes import FloatArray, IndexArray

STRETCH = 0.3
"""A cell is strongly curved where its map differs from that of its straight-sided cell by this share."""


def curved_cells(elements: FiniteElements) -> IndexArray:
    """Cells (k,) whose corners alone do not tell their shape.

    The largest entry of J J_0^-1 - I over the points of the stiffness rule exceeds STRETCH; J and J_0 are the
    derivatives of physical by reference coordinates of the cell and of the straight-sided one, in its middle.
    """
    corners = elements.mesh.points[elements.mesh.cells[:, : elements.shape.n_corners]]
    rule = rules_of(elements.shape).stiffness
    slopes = elements.shape.corner_gradients(rule.points)
    straight = np.einsum("qbj,ebi->eqij", slopes, corners, optimize=True)
    change = np.einsum("eqij,eqjk->eqik", straight, elements.fine.inverse, optimize=True) - np.eye(3)
    return np.flatnonzero(np.abs(change).max(axis=(1, 2, 3)) > STRETCH).astype(np.int32)


def linear_stiffness(elements: FiniteElements, young: FloatArray, poisson: FloatArray) -> sparse.bsr_array:
    """Elastic matrix (3 n_corners, 3 n_corners) [N/m] of the linear space, in blocks of 3.

    young [Pa], poisson [-] : (n_cells,)
    """
    curved = curved_cells(elements)
    straight = young.copy()
    straight[curved] = 0.0
    matrix = elements.coarse.block_matrix(elements.coarse.elasticity(straight, poisson))
    if not len(curved):
        return matrix
    nodes, packed = np.unique(elements.mesh.cells[curved], return_inverse=True)
    rule = rules_of(elements.shape).stiffness
    level = Level.of(
        np.ascontiguousarray(elements.mesh.points[nodes]),
        packed.reshape(len(curved), -1).astype(np.int32),
        elements.shape.values(rule.points),
        elements.shape.gradients(rule.points),
        rule,
    )
    stiffness = level.block_matrix(level.elasticity(young[curved], poisson[curved]))
    way = sparse.kron(sparse.csr_array(elements.prolongation)[nodes], np.eye(3), format="csr")
    own = sparse.bsr_array(way.T @ sparse.csr_array(stiffness) @ way, blocksize=(3, 3))
    whole = sparse.bsr_array(matrix + own)
    whole.sort_indices()
    return whole

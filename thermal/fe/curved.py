"""The linear stiffness of a curved mesh: straight cells where they serve, the curved ones themselves elsewhere.

Where a thin cell lies next to a coarse arc, its mid-side nodes are farther off their chords than the cell is
thick. The prolongation then strains it by what the slopes of its neighbours differ, which the stiffness of
the straight-sided cell does not know, and multigrid stalls. For such cells alone the linear stiffness is
P^T K P with the prolongation P, which is exact.
Source: Briggs, Henson, McCormick, A Multigrid Tutorial, 2nd ed., ch. 10 (variational coarse operator).
"""

import numpy as np
from scipy import sparse

from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.elements import FiniteElements, Level

BENT = 0.5
"""Distance of a node from the middle of its corners, relative to the thickness of its cell, above which the
straight-sided cell does not stand for the curved one."""


def bent_cells(elements: FiniteElements) -> IndexArray:
    """Cells (k,) whose inner nodes are farther than BENT times their thickness from the straight-sided cell.

    The thickness is the smallest distance between two sides on which a reference coordinate is constant, in
    tetrahedra from a corner to its side, at the points of the stiffness rule.
    """
    points, cells, shape = elements.mesh.points, elements.mesh.cells, elements.shape
    off = np.zeros(len(cells))
    for node, corners in enumerate(shape.parents, start=shape.n_corners):
        middle = points[cells[:, list(corners)]].mean(axis=1)
        np.maximum(off, np.linalg.norm(points[cells[:, node]] - middle, axis=1), out=off)
    inverse = elements.fine.inverse
    slope = np.linalg.norm(inverse, axis=3).max(axis=(1, 2))
    if shape.n_corners == 4:
        slope = np.maximum(slope, np.linalg.norm(inverse.sum(axis=2), axis=2).max(axis=1))
    return np.flatnonzero(off * slope > BENT).astype(np.int32)


def linear_stiffness(elements: FiniteElements, young: FloatArray, poisson: FloatArray) -> sparse.bsr_array:
    """Elastic matrix (3 n_corners, 3 n_corners) [N/m] of the linear space, in blocks of 3.

    young [Pa], poisson [-] : (n_cells,)
    """
    bent = bent_cells(elements)
    straight = young.copy()
    straight[bent] = 0.0
    matrix = elements.coarse.block_matrix(elements.coarse.elasticity(straight, poisson))
    if not len(bent):
        return matrix
    nodes, packed = np.unique(elements.mesh.cells[bent], return_inverse=True)
    level = Level.of(
        np.ascontiguousarray(elements.mesh.points[nodes]),
        packed.reshape(len(bent), -1).astype(np.int32),
        elements.shape,
    )
    stiffness = level.block_matrix(level.elasticity(young[bent], poisson[bent]))
    way = sparse.kron(sparse.csr_array(elements.prolongation)[nodes], np.eye(3), format="csr")
    curved = sparse.bsr_array(way.T @ sparse.csr_array(stiffness) @ way, blocksize=(3, 3))
    whole = sparse.bsr_array(matrix + curved)
    whole.sort_indices()
    return whole

"""Compiled assembly of matrices row by row, for any cell, from tables of its shape functions.

Cells are taken in blocks: their element matrices first, one cell beside the other, then every row of the
matrix gathers its share. Rows and cells are independent of each other and every sum has one order, so the
result does not depend on the number of threads (NUMBA_NUM_THREADS). Everything here takes numbers and arrays;
names and checks live in thermal.fe.elements.

Index names: row = node, e = cell, a b = local nodes, q = quadrature point, i j k = directions.
"""

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int32]
Offsets = NDArray[np.uint16]

BLOCK = 4_000_000
"""Numbers in the element matrices of one block of cells."""

ROWS = 8192
"""Rows of the matrix that one thread takes at a time."""


@njit(cache=True)
def cells_of_nodes(cells: Integers, n_nodes: int) -> tuple[Integers, Integers]:
    """Start (n_nodes + 1,) and list (cells.size,) of entries ``cell * n_local + local`` around every node."""
    n_cells, n_local = cells.shape
    start = np.zeros(n_nodes + 1, dtype=np.int32)
    for e in range(n_cells):
        for a in range(n_local):
            start[cells[e, a] + 1] += 1
    for row in range(n_nodes):
        start[row + 1] += start[row]
    fill = start[:-1].copy()
    around = np.empty(start[-1], dtype=np.int32)
    for e in range(n_cells):
        for a in range(n_local):
            node = cells[e, a]
            around[fill[node]] = e * n_local + a
            fill[node] += 1
    return start, around


@njit(cache=True, parallel=True)
def pattern(cells: Integers, start: Integers, around: Integers) -> tuple[Integers, Integers, Offsets]:
    """``indptr`` and sorted ``indices`` of the matrix that couples all nodes of a cell.

    The third array (n_cells, n_local, n_local) is the place of each pair of local nodes in the row of the
    first of them.
    """
    n_nodes = len(start) - 1
    n_local = cells.shape[1]
    n_chunks = (n_nodes + ROWS - 1) // ROWS
    counts = np.zeros(n_nodes + 1, dtype=np.int32)
    for chunk in prange(n_chunks):
        seen = np.full(n_nodes, -1, dtype=np.int32)
        for row in range(chunk * ROWS, min(n_nodes, (chunk + 1) * ROWS)):
            for at in range(start[row], start[row + 1]):
                e = around[at] // n_local
                for b in range(n_local):
                    column = cells[e, b]
                    if seen[column] != row:
                        seen[column] = row
                        counts[row + 1] += 1
    indptr = np.cumsum(counts).astype(np.int32)
    indices = np.empty(indptr[-1], dtype=np.int32)
    offsets = np.empty((len(cells), n_local, n_local), dtype=np.uint16)
    for chunk in prange(n_chunks):
        place = np.full(n_nodes, -1, dtype=np.int32)
        for row in range(chunk * ROWS, min(n_nodes, (chunk + 1) * ROWS)):
            first, end = indptr[row], indptr[row]
            for at in range(start[row], start[row + 1]):
                e = around[at] // n_local
                for b in range(n_local):
                    column = cells[e, b]
                    if place[column] < first:
                        place[column] = end
                        indices[end] = column
                        end += 1
            indices[first:end].sort()
            for at in range(first, end):
                place[indices[at]] = at
            for at in range(start[row], start[row + 1]):
                e = around[at] // n_local
                a = around[at] - e * n_local
                for b in range(n_local):
                    offsets[e, a, b] = place[cells[e, b]] - first
    return indptr, indices, offsets


@njit(cache=True)
def _jacobian(points: Floats, nodes: Integers, slopes: Floats, inverse: Floats) -> float:
    """Fill the 3x3 ``inverse`` of dx/dxi at one point and return the determinant; slopes : (n_local, 3)."""
    jac = np.zeros((3, 3))
    for a in range(len(slopes)):
        for i in range(3):
            for j in range(3):
                jac[i, j] += points[nodes[a], i] * slopes[a, j]
    c00 = jac[1, 1] * jac[2, 2] - jac[1, 2] * jac[2, 1]
    c01 = jac[1, 2] * jac[2, 0] - jac[1, 0] * jac[2, 2]
    c02 = jac[1, 0] * jac[2, 1] - jac[1, 1] * jac[2, 0]
    det = float(jac[0, 0] * c00 + jac[0, 1] * c01 + jac[0, 2] * c02)
    if det == 0.0:
        return det
    inverse[0, 0] = c00 / det
    inverse[1, 0] = c01 / det
    inverse[2, 0] = c02 / det
    inverse[0, 1] = (jac[0, 2] * jac[2, 1] - jac[0, 1] * jac[2, 2]) / det
    inverse[1, 1] = (jac[0, 0] * jac[2, 2] - jac[0, 2] * jac[2, 0]) / det
    inverse[2, 1] = (jac[0, 1] * jac[2, 0] - jac[0, 0] * jac[2, 1]) / det
    inverse[0, 2] = (jac[0, 1] * jac[1, 2] - jac[0, 2] * jac[1, 1]) / det
    inverse[1, 2] = (jac[0, 2] * jac[1, 0] - jac[0, 0] * jac[1, 2]) / det
    inverse[2, 2] = (jac[0, 0] * jac[1, 1] - jac[0, 1] * jac[1, 0]) / det
    return det


@njit(cache=True, parallel=True)
def cell_geometry(points: Floats, cells: Integers, slopes: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Inverse Jacobians dxi/dx (n_cells, n_q, 3, 3) [1/m] and volume weights (n_cells, n_q) [m3].

    slopes : (n_q, n_local, 3) reference gradients; weights : (n_q,) of the rule
    """
    n_q = len(weights)
    inverse = np.zeros((len(cells), n_q, 3, 3))
    volumes = np.empty((len(cells), n_q))
    for e in prange(len(cells)):
        for q in range(n_q):
            volumes[e, q] = weights[q] * _jacobian(points, cells[e], slopes[q], inverse[e, q])
    return inverse, volumes


@njit(cache=True, parallel=True)
def cell_volumes(points: Floats, cells: Integers, slopes: Floats, weights: Floats) -> Floats:
    """Volume weights (n_cells, n_q) [m3]; arguments as in `cell_geometry`."""
    volumes = np.empty((len(cells), len(weights)))
    for e in prange(len(cells)):
        inverse = np.empty((3, 3))
        for q in range(len(weights)):
            volumes[e, q] = weights[q] * _jacobian(points, cells[e], slopes[q], inverse)
    return volumes


@njit(cache=True)
def _gradients(inverse: Floats, slopes: Floats, out: Floats) -> None:
    """Fill ``out`` (3, n_local) [1/m] from reference gradients ``slopes`` (3, n_local)."""
    for i in range(3):
        c0, c1, c2 = inverse[0, i], inverse[1, i], inverse[2, i]
        for b in range(slopes.shape[1]):
            out[i, b] = c0 * slopes[0, b] + c1 * slopes[1, b] + c2 * slopes[2, b]


@njit(cache=True, parallel=True)
def conduction_rows(
    indptr: Integers,
    start: Integers,
    around: Integers,
    offsets: Offsets,
    slopes: Floats,
    inverse: Floats,
    volumes: Floats,
    conductivity: Floats,
) -> Floats:
    """Values (nnz,) [W/K] of the integral of k grad N_a . grad N_b.

    slopes : (n_q, 3, n_local) reference gradients; inverse, volumes : see `cell_geometry`
    conductivity : (n_cells, n_q) [W/(m K)]
    """
    n_nodes = len(start) - 1
    n_q, _, n_local = slopes.shape
    n_cells = len(offsets)
    data = np.zeros(indptr[-1])
    block = max(1, min(n_cells, BLOCK // (n_local * n_local)))
    part = np.empty((block, n_local, n_local))
    fill = start[:-1].copy()
    for first in range(0, n_cells, block):
        last = min(n_cells, first + block)
        for e in prange(first, last):
            gradients = np.empty((3, n_local))
            matrix = part[e - first]
            matrix[:] = 0.0
            for q in range(n_q):
                _gradients(inverse[e, q], slopes[q], gradients)
                factor = conductivity[e, q] * volumes[e, q]
                for a in range(n_local):
                    g0 = factor * gradients[0, a]
                    g1 = factor * gradients[1, a]
                    g2 = factor * gradients[2, a]
                    for b in range(n_local):
                        matrix[a, b] += g0 * gradients[0, b] + g1 * gradients[1, b] + g2 * gradients[2, b]
        for row in prange(n_nodes):
            at = fill[row]
            while at < start[row + 1] and around[at] < last * n_local:
                e = around[at] // n_local
                a = around[at] - e * n_local
                for b in range(n_local):
                    data[indptr[row] + offsets[e, a, b]] += part[e - first, a, b]
                at += 1
            fill[row] = at
    return data


@njit(cache=True, parallel=True)
def elasticity_rows(
    indptr: Integers,
    start: Integers,
    around: Integers,
    offsets: Offsets,
    slopes: Floats,
    inverse: Floats,
    volumes: Floats,
    lame: Floats,
) -> Floats:
    """Blocks (nnz, 3, 3) [N/m] of isotropic linear elasticity; lame : (n_cells, 2) lambda and mu [Pa].

    The other arguments are those of `conduction_rows`. A cell keeps int grad_i N_a grad_j N_b for b <= a.
    """
    n_nodes = len(start) - 1
    n_q, _, n_local = slopes.shape
    n_cells = len(offsets)
    data = np.zeros((indptr[-1], 3, 3))
    block = max(1, min(n_cells, BLOCK // (9 * n_local * n_local)))
    part = np.empty((block, n_local, 3, 3, n_local))
    fill = start[:-1].copy()
    for first in range(0, n_cells, block):
        last = min(n_cells, first + block)
        for e in prange(first, last):
            gradients = np.empty((3, n_local))
            products = part[e - first]
            products[:] = 0.0
            for q in range(n_q):
                _gradients(inverse[e, q], slopes[q], gradients)
                for a in range(n_local):
                    for i in range(3):
                        factor = volumes[e, q] * gradients[i, a]
                        for j in range(3):
                            for b in range(a + 1):
                                products[a, i, j, b] += factor * gradients[j, b]
        for row in prange(n_nodes):
            at = fill[row]
            while at < start[row + 1] and around[at] < last * n_local:
                e = around[at] // n_local
                a = around[at] - e * n_local
                lam, mu = lame[e, 0], lame[e, 1]
                products = part[e - first]
                for b in range(n_local):
                    block_ab = data[indptr[row] + offsets[e, a, b]]
                    if b <= a:
                        trace = products[a, 0, 0, b] + products[a, 1, 1, b] + products[a, 2, 2, b]
                        for i in range(3):
                            block_ab[i, i] += mu * trace
                            for j in range(3):
                                block_ab[i, j] += lam * products[a, i, j, b] + mu * products[a, j, i, b]
                    else:
                        trace = products[b, 0, 0, a] + products[b, 1, 1, a] + products[b, 2, 2, a]
                        for i in range(3):
                            block_ab[i, i] += mu * trace
                            for j in range(3):
                                block_ab[i, j] += lam * products[b, j, i, a] + mu * products[b, i, j, a]
                at += 1
            fill[row] = at
    return data


@njit(cache=True)
def expansion_load(
    cells: Integers,
    values: Floats,
    slopes: Floats,
    inverse: Floats,
    volumes: Floats,
    factor: Floats,
    excess: Floats,
) -> Floats:
    """Load (n_nodes, 3) [N] of free expansion: the integral of factor * excess * grad N_a.

    values : (n_q, n_local), slopes : (n_q, 3, n_local) of the rule; inverse, volumes : see `cell_geometry`
    factor : (n_cells,) alpha E / (1 - 2 nu) [Pa/K]; excess : (n_nodes,) temperature above the cold one [K]
    """
    load = np.zeros((len(excess), 3))
    n_local = cells.shape[1]
    gradients = np.empty((3, n_local))
    for e in range(len(cells)):
        for q in range(len(values)):
            heat = 0.0
            for a in range(n_local):
                heat += values[q, a] * excess[cells[e, a]]
            scale = factor[e] * heat * volumes[e, q]
            _gradients(inverse[e, q], slopes[q], gradients)
            for a in range(n_local):
                for i in range(3):
                    load[cells[e, a], i] += scale * gradients[i, a]
    return load


@njit(cache=True)
def facet_geometry(
    points: Floats, facets: Integers, slopes: Floats, weights: Floats
) -> tuple[Floats, Floats]:
    """Area weights (n_f, n_q) [m2], unit normals (n_f, n_q, 3) of (n_f, n) facets; slopes : (n_q, n, 2)."""
    areas = np.empty((len(facets), len(weights)))
    normals = np.empty((len(facets), len(weights), 3))
    tangent = np.empty((2, 3))
    for f in range(len(facets)):
        for q in range(len(weights)):
            tangent[:] = 0.0
            for a in range(facets.shape[1]):
                for i in range(3):
                    tangent[0, i] += points[facets[f, a], i] * slopes[q, a, 0]
                    tangent[1, i] += points[facets[f, a], i] * slopes[q, a, 1]
            n0 = tangent[0, 1] * tangent[1, 2] - tangent[0, 2] * tangent[1, 1]
            n1 = tangent[0, 2] * tangent[1, 0] - tangent[0, 0] * tangent[1, 2]
            n2 = tangent[0, 0] * tangent[1, 1] - tangent[0, 1] * tangent[1, 0]
            length = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
            areas[f, q] = length * weights[q]
            normals[f, q, 0] = n0 / length
            normals[f, q, 1] = n1 / length
            normals[f, q, 2] = n2 / length
    return areas, normals


@njit(cache=True)
def facet_slots(facets: Integers, indptr: Integers, indices: Integers) -> Integers:
    """Positions (n_f, n, n) in the matrix values of all node pairs of (n_f, n) facets."""
    n_local = facets.shape[1]
    slots = np.empty((len(facets), n_local, n_local), dtype=np.int32)
    for f in range(len(facets)):
        for a in range(n_local):
            row = facets[f, a]
            columns = indices[indptr[row] : indptr[row + 1]]
            for b in range(n_local):
                slots[f, a, b] = indptr[row] + np.searchsorted(columns, facets[f, b])
    return slots


@njit(cache=True)
def add_facet_mass(data: Floats, slots: Integers, values: Floats, weights: Floats) -> None:
    """Add the integral of c N_a N_b to the matrix values; weights : (n_f, n_q) coefficient x area [W/K]."""
    n_local = slots.shape[1]
    for f in range(len(slots)):
        for q in range(weights.shape[1]):
            for a in range(n_local):
                factor = weights[f, q] * values[q, a]
                for b in range(n_local):
                    data[slots[f, a, b]] += factor * values[q, b]

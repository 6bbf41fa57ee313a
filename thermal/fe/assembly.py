"""Compiled assembly of matrices row by row, for 10-node tetrahedra and their linear sub-space.

Each row of the matrix gathers from the cells around its node, so rows are independent of each other and the
sum has one order. Everything here takes numbers and arrays; names and checks live in thermal.fe.elements.

Index names: row = node, e = cell, a b = local nodes, q = quadrature point, i j = directions.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int32]


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


@njit(cache=True)
def pattern(cells: Integers, start: Integers, around: Integers) -> tuple[Integers, Integers]:
    """``indptr`` and sorted ``indices`` of the matrix that couples all nodes of a cell."""
    n_nodes = len(start) - 1
    n_local = cells.shape[1]
    seen = np.full(n_nodes, -1, dtype=np.int32)
    indptr = np.zeros(n_nodes + 1, dtype=np.int32)
    for row in range(n_nodes):
        count = 0
        for at in range(start[row], start[row + 1]):
            e = around[at] // n_local
            for b in range(n_local):
                column = cells[e, b]
                if seen[column] != row:
                    seen[column] = row
                    count += 1
        indptr[row + 1] = indptr[row] + count
    indices = np.empty(indptr[-1], dtype=np.int32)
    seen[:] = -1
    for row in range(n_nodes):
        end = indptr[row]
        for at in range(start[row], start[row + 1]):
            e = around[at] // n_local
            for b in range(n_local):
                column = cells[e, b]
                if seen[column] != row:
                    seen[column] = row
                    indices[end] = column
                    end += 1
        indices[indptr[row] : end] = np.sort(indices[indptr[row] : end])
    return indptr, indices


@njit(cache=True)
def _jacobian(points: Floats, nodes: Integers, slopes: Floats, inverse: Floats) -> float:
    """Fill the 3x3 ``inverse`` of dx/dxi at one point and return the determinant; slopes : (10, 3)."""
    jac = np.zeros((3, 3))
    for a in range(10):
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


@njit(cache=True)
def quadrature_geometry(
    points: Floats, cells: Integers, first: Integers, rule_start: Integers, slopes: Floats, weights: Floats
) -> tuple[Floats, Floats]:
    """Gradients (n_q, 10, 3) [1/m] and volume weights (n_q,) [m3] at the quadrature points of all cells.

    first : (n_cells + 1,) first quadrature point of each cell
    rule_start : (n_cells,) row of ``slopes`` (n, 10, 3) and ``weights`` (n,) where the cell's rule starts
    """
    gradients = np.empty((first[-1], 10, 3))
    volumes = np.empty(first[-1])
    inverse = np.zeros((3, 3))
    for e in range(len(cells)):
        for q in range(first[e], first[e + 1]):
            at = rule_start[e] + q - first[e]
            det = _jacobian(points, cells[e], slopes[at], inverse)
            volumes[q] = det * weights[at]
            for a in range(10):
                for i in range(3):
                    gradients[q, a, i] = (
                        slopes[at, a, 0] * inverse[0, i]
                        + slopes[at, a, 1] * inverse[1, i]
                        + slopes[at, a, 2] * inverse[2, i]
                    )
    return gradients, volumes


@njit(cache=True)
def conduction_rows(
    indptr: Integers,
    indices: Integers,
    start: Integers,
    around: Integers,
    cells: Integers,
    first: Integers,
    gradients: Floats,
    volumes: Floats,
    conductivity: Floats,
) -> Floats:
    """Values (nnz,) [W/K] of the integral of k grad N_a . grad N_b; conductivity : (n_cells,) [W/(m K)]."""
    n_nodes = len(start) - 1
    n_local = cells.shape[1]
    data = np.zeros(len(indices))
    slot = np.zeros(n_nodes, dtype=np.int32)
    for row in range(n_nodes):
        for at in range(indptr[row], indptr[row + 1]):
            slot[indices[at]] = at
        for at in range(start[row], start[row + 1]):
            e = around[at] // n_local
            a = around[at] - e * n_local
            for q in range(first[e], first[e + 1]):
                factor = conductivity[e] * volumes[q]
                g0 = factor * gradients[q, a, 0]
                g1 = factor * gradients[q, a, 1]
                g2 = factor * gradients[q, a, 2]
                for b in range(n_local):
                    data[slot[cells[e, b]]] += (
                        g0 * gradients[q, b, 0] + g1 * gradients[q, b, 1] + g2 * gradients[q, b, 2]
                    )
    return data


@njit(cache=True)
def elasticity_rows(
    indptr: Integers,
    indices: Integers,
    start: Integers,
    around: Integers,
    cells: Integers,
    first: Integers,
    gradients: Floats,
    volumes: Floats,
    lame: Floats,
) -> Floats:
    """Blocks (nnz, 3, 3) [N/m] of isotropic linear elasticity; lame : (n_cells, 2) lambda and mu [Pa]."""
    n_nodes = len(start) - 1
    n_local = cells.shape[1]
    data = np.zeros((len(indices), 3, 3))
    slot = np.zeros(n_nodes, dtype=np.int32)
    product = np.empty((n_local, 3, 3))
    for row in range(n_nodes):
        for at in range(indptr[row], indptr[row + 1]):
            slot[indices[at]] = at
        for at in range(start[row], start[row + 1]):
            e = around[at] // n_local
            a = around[at] - e * n_local
            product[:] = 0.0
            for q in range(first[e], first[e + 1]):
                for b in range(n_local):
                    for i in range(3):
                        factor = volumes[q] * gradients[q, a, i]
                        for j in range(3):
                            product[b, i, j] += factor * gradients[q, b, j]
            lam, mu = lame[e, 0], lame[e, 1]
            for b in range(n_local):
                block = data[slot[cells[e, b]]]
                trace = mu * (product[b, 0, 0] + product[b, 1, 1] + product[b, 2, 2])
                for i in range(3):
                    block[i, i] += trace
                    for j in range(3):
                        block[i, j] += lam * product[b, i, j] + mu * product[b, j, i]
    return data


@njit(cache=True)
def expansion_load(
    points: Floats,
    cells: Integers,
    values: Floats,
    slopes: Floats,
    weights: Floats,
    factor: Floats,
    excess: Floats,
) -> Floats:
    """Load (n_nodes, 3) [N] of free expansion: the integral of factor * excess * grad N_a.

    values : (n_q, 10), slopes : (n_q, 10, 3), weights : (n_q,) of one rule for all cells
    factor : (n_cells,) alpha E / (1 - 2 nu) [Pa/K]; excess : (n_nodes,) temperature above the cold one [K]
    """
    load = np.zeros(points.shape)
    inverse = np.zeros((3, 3))
    for e in range(len(cells)):
        for q in range(len(weights)):
            det = _jacobian(points, cells[e], slopes[q], inverse)
            heat = 0.0
            for a in range(10):
                heat += values[q, a] * excess[cells[e, a]]
            scale = factor[e] * heat * det * weights[q]
            for a in range(10):
                for i in range(3):
                    load[cells[e, a], i] += scale * (
                        slopes[q, a, 0] * inverse[0, i]
                        + slopes[q, a, 1] * inverse[1, i]
                        + slopes[q, a, 2] * inverse[2, i]
                    )
    return load


@njit(cache=True)
def facet_geometry(
    points: Floats, facets: Integers, slopes: Floats, weights: Floats
) -> tuple[Floats, Floats]:
    """Area weights (n_f, n_q) [m2], unit normals (n_f, n_q, 3) of (n_f, 6) facets; slopes : (n_q, 6, 2)."""
    areas = np.empty((len(facets), len(weights)))
    normals = np.empty((len(facets), len(weights), 3))
    tangent = np.empty((2, 3))
    for f in range(len(facets)):
        for q in range(len(weights)):
            tangent[:] = 0.0
            for a in range(6):
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

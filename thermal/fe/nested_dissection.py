"""Elimination order of a sparse symmetric matrix whose unknowns stand at points: nested dissection.

A set of nodes is cut in two by a plane across one of its axes; the fewest nodes that touch every entry across the cut
(the minimum vertex cover of that bipartite graph, Koenig's theorem) separate the halves and are eliminated after them.
Source: George, SIAM J. Numer. Anal. 10, 1973, 345; Pothen and Fan, ACM Trans. Math. Softw. 16, 1990, 303.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import maximum_bipartite_matching

from thermal.fe.arrays import FloatArray

BoolArray = NDArray[np.bool_]
Indices = NDArray[np.int64]

LEAF = 80
"""Nodes of a set that is not cut any more."""
CUTS = (0.26, 0.38, 0.5, 0.62, 0.74)
"""Shares of the nodes on one side at which cuts are tried."""
SMALL = 600
"""Nodes of a set that is cut in the middle only: what a better cut would save is little."""
LEAST_SHARE = 0.2
"""Of the nodes on the smaller side of a cut; planes of nodes make sides other than asked."""


@dataclass(frozen=True)
class Separator:
    """Nodes that are eliminated together, after those of all ``parts``: places of earlier separators in the order."""

    nodes: Indices
    parts: tuple[int, ...]


def nested_dissection(graph: sparse.csr_array, points: FloatArray) -> list[Separator]:
    """Separators in the order of their elimination; the last one cuts the whole.

    graph : (n, n) with an entry where two nodes share one; points : (n, 3) of the nodes
    """
    order: list[Separator] = []
    pattern = (np.ones(graph.nnz, np.int32), graph.indices, graph.indptr)
    _dissect(order, np.arange(len(points)), sparse.csr_array(pattern, shape=graph.shape), points)
    return order


def _dissect(order: list[Separator], nodes: Indices, graph: sparse.csr_array, points: FloatArray) -> int:
    """Append the separators of a set of nodes and give the place of the one that cuts it.

    graph : between the nodes; points : of all nodes
    """
    cut = None if len(nodes) <= LEAF else _best_cut(graph, points[nodes])
    parts, own = list[int](), nodes
    if cut is not None:
        separator, low = cut
        own = nodes[separator]
        for side in (low & ~separator, ~low & ~separator):
            if side.any():
                parts.append(_dissect(order, nodes[side], graph[side][:, side], points))
    order.append(Separator(own, tuple(parts)))
    return len(order) - 1


def _best_cut(graph: sparse.csr_array, points: FloatArray) -> tuple[BoolArray, BoolArray] | None:
    """Which nodes separate and which lie below the cut, for the fewest in proportion to the sides they part."""
    least, cut = np.inf, None
    for low in _halves(points):
        across = graph[low][:, ~low]
        rows, columns = np.flatnonzero(np.diff(across.indptr)), np.unique(across.indices)
        chosen_rows, chosen_columns = _vertex_cover(across[rows][:, columns])
        count = np.count_nonzero(chosen_rows) + np.count_nonzero(chosen_columns)
        below = np.count_nonzero(low)
        cost = count / np.sqrt(below * (len(points) - below))
        if cost < least:
            separator = np.zeros(len(points), bool)
            separator[np.flatnonzero(low)[rows[chosen_rows]]] = True
            separator[np.flatnonzero(~low)[columns[chosen_columns]]] = True
            least, cut = cost, (separator, low)
    return cut


def _halves(points: FloatArray) -> Iterator[BoolArray]:
    """Which points lie below the planes that are tried."""
    for heights in points.T:
        along = np.sort(heights)
        for share in CUTS if len(points) > SMALL else (0.5,):
            low = heights < along[int(share * len(along))]
            if LEAST_SHARE <= np.mean(low) <= 1.0 - LEAST_SHARE:
                yield low


def _vertex_cover(across: sparse.csr_array) -> tuple[BoolArray, BoolArray]:
    """Smallest set of rows and columns that hold every entry of a bipartite graph."""
    column_of = maximum_bipartite_matching(sparse.csr_matrix(across), perm_type="column")
    matched = np.flatnonzero(column_of >= 0)
    row_of = np.full(across.shape[1], -1)
    row_of[column_of[matched]] = matched
    backwards = sparse.csr_array(across.T)
    # what paths of entries and matches in turn reach from the unmatched rows
    rows, columns = column_of < 0, np.zeros(across.shape[1], bool)
    fresh = rows.copy()
    while fresh.any():
        met = (backwards @ fresh.astype(np.int32) > 0) & ~columns
        columns |= met
        fresh = np.zeros(len(rows), bool)
        fresh[row_of[met]] = True  # each is matched, or the matching could grow
        fresh &= ~rows
        rows |= fresh
    return ~rows, columns

"""Compiled work on sparse matrices: their pattern, their products, the grouping of nodes for the multigrid.

Products take any float type; places of entries are unsigned, because numba tests a signed one for each entry.
Rows are independent, so results do not depend on the number of threads; small products stay on one, because
waking the others costs more than it saves.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numba import get_num_threads, njit, prange, set_num_threads
from numpy.typing import NDArray

Numbers = NDArray[np.floating]
Integers = NDArray[np.int32]
Offsets = NDArray[np.uint16]
Places = NDArray[np.uint32]

THREADED = 65_536
"""Rows from which on the work is spread over NUMBA_NUM_THREADS threads."""

CHUNK = 8192
"""Rows that one thread takes at a time."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Products and assembly on one thread, for times when the other cores have work of their own.

    Threads that have to wait for a core hold up each other; the results are the same bits with any number.
    """
    before = get_num_threads()
    set_num_threads(1)
    try:
        yield
    finally:
        set_num_threads(before)


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
def _count_columns(cells: Integers, start: Integers, around: Integers, counts: Integers) -> None:
    """Fill counts (n_nodes + 1,) with the number of columns of every row, one place later."""
    n_nodes, n_local = len(start) - 1, cells.shape[1]
    seen = np.full(n_nodes, -1, dtype=np.int32)
    for row in range(n_nodes):
        for slot in range(start[row], start[row + 1]):
            e = around[slot] // n_local
            for b in range(n_local):
                column = cells[e, b]
                if seen[column] != row:
                    seen[column] = row
                    counts[row + 1] += 1


@njit(cache=True)
def _list_columns(
    cells: Integers, start: Integers, around: Integers, indptr: Integers, indices: Integers
) -> None:
    """Fill the columns of all rows, sorted.

    A column lists the rows in ascending order, and rows and columns of the pattern are the same.
    """
    n_nodes, n_local = len(start) - 1, cells.shape[1]
    seen = np.full(n_nodes, -1, dtype=np.int32)
    fill = indptr[:-1].copy()
    for row in range(n_nodes):
        for slot in range(start[row], start[row + 1]):
            e = around[slot] // n_local
            for b in range(n_local):
                column = cells[e, b]
                if seen[column] != row:
                    seen[column] = row
                    indices[fill[column]] = row
                    fill[column] += 1


@njit(cache=True)
def _place_pairs(
    cells: Integers, start: Integers, around: Integers, indptr: Integers, indices: Integers, offsets: Offsets
) -> None:
    """Fill the places of the pairs of local nodes in their rows."""
    n_nodes, n_local = len(start) - 1, cells.shape[1]
    place = np.empty(n_nodes, dtype=np.int32)
    for row in range(n_nodes):
        begin = indptr[row]
        for entry in range(begin, indptr[row + 1]):
            place[indices[entry]] = entry - begin
        for slot in range(start[row], start[row + 1]):
            e = around[slot] // n_local
            a = around[slot] - e * n_local
            for b in range(n_local):
                offsets[e, a, b] = place[cells[e, b]]


@njit(cache=True)
def pattern(cells: Integers, start: Integers, around: Integers) -> tuple[Integers, Integers, Offsets]:
    """``indptr`` and sorted ``indices`` of the matrix that couples all nodes of a cell.

    The third array (n_cells, n_local, n_local) is the place of each pair of local nodes in the row of the
    first of them.
    """
    n_nodes, n_local = len(start) - 1, cells.shape[1]
    counts = np.zeros(n_nodes + 1, dtype=np.int32)
    _count_columns(cells, start, around, counts)
    indptr = np.cumsum(counts).astype(np.int32)
    indices = np.empty(indptr[-1], dtype=np.int32)
    offsets = np.empty((len(cells), n_local, n_local), dtype=np.uint16)
    _list_columns(cells, start, around, indptr, indices)
    _place_pairs(cells, start, around, indptr, indices, offsets)
    return indptr, indices, offsets


@njit(cache=True, fastmath={"contract", "reassoc"})
def scalar_rows(
    first: int, last: int, indptr: Places, indices: Places, data: Numbers, x: Numbers, y: Numbers
) -> None:
    """Rows of y = A x for scalar entries; data : (nnz,)."""
    for row in range(first, last):
        total = y.dtype.type(0)
        for entry in range(indptr[row], indptr[row + 1]):
            total += data[entry] * x[indices[entry]]
        y[row] = total


@njit(cache=True, fastmath={"contract", "reassoc"})
def block_rows(
    first: int, last: int, indptr: Places, indices: Places, data: Numbers, x: Numbers, y: Numbers
) -> None:
    """Rows of y = A x for 3x3 blocks; data : (nnz, 3, 3), x, y : (n, 3)."""
    for row in range(first, last):
        y0, y1, y2 = y.dtype.type(0), y.dtype.type(0), y.dtype.type(0)
        for entry in range(indptr[row], indptr[row + 1]):
            block = data[entry]
            column = indices[entry]
            x0, x1, x2 = x[column, 0], x[column, 1], x[column, 2]
            y0 += block[0, 0] * x0 + block[0, 1] * x1 + block[0, 2] * x2
            y1 += block[1, 0] * x0 + block[1, 1] * x1 + block[1, 2] * x2
            y2 += block[2, 0] * x0 + block[2, 1] * x1 + block[2, 2] * x2
        y[row, 0], y[row, 1], y[row, 2] = y0, y1, y2


@njit(cache=True, parallel=True)
def scalar_threads(indptr: Places, indices: Places, data: Numbers, x: Numbers, y: Numbers) -> None:
    """`scalar_rows` for all rows, in parallel."""
    n = len(indptr) - 1
    for chunk in prange((n + CHUNK - 1) // CHUNK):
        scalar_rows(chunk * CHUNK, min(n, (chunk + 1) * CHUNK), indptr, indices, data, x, y)


@njit(cache=True, parallel=True)
def block_threads(indptr: Places, indices: Places, data: Numbers, x: Numbers, y: Numbers) -> None:
    """`block_rows` for all rows, in parallel."""
    n = len(indptr) - 1
    for chunk in prange((n + CHUNK - 1) // CHUNK):
        block_rows(chunk * CHUNK, min(n, (chunk + 1) * CHUNK), indptr, indices, data, x, y)


def scalar_product(indptr: Places, indices: Places, data: Numbers, x: Numbers, y: Numbers) -> None:
    """y = A x for scalar entries; data : (nnz,)."""
    if len(y) < THREADED:
        scalar_rows(0, len(y), indptr, indices, data, x, y)
    else:
        scalar_threads(indptr, indices, data, x, y)


def block_product(indptr: Places, indices: Places, data: Numbers, x: Numbers, y: Numbers) -> None:
    """y = A x for 3x3 blocks; data : (nnz, 3, 3), x, y : (n, 3)."""
    if len(y) < THREADED:
        block_rows(0, len(y), indptr, indices, data, x, y)
    else:
        block_threads(indptr, indices, data, x, y)


@njit(cache=True, fastmath={"contract", "reassoc"})
def diagonal_product(data: Numbers, x: Numbers, y: Numbers) -> None:
    """y = D x for 3x3 blocks on the diagonal; data : (n, 3, 3), x, y : (n, 3)."""
    for row in range(len(x)):
        block = data[row]
        x0, x1, x2 = x[row, 0], x[row, 1], x[row, 2]
        for i in range(3):
            y[row, i] = block[i, 0] * x0 + block[i, 1] * x1 + block[i, 2] * x2


@njit(cache=True)
def diagonal_blocks(indptr: Integers, indices: Integers, data: Numbers) -> Numbers:
    """(n, 3, 3) blocks on the diagonal; data : (nnz, 3, 3)."""
    blocks = np.zeros((len(indptr) - 1, 3, 3), dtype=data.dtype)
    for row in range(len(indptr) - 1):
        for entry in range(indptr[row], indptr[row + 1]):
            if indices[entry] == row:
                for i in range(3):
                    for j in range(3):
                        blocks[row, i, j] = data[entry, i, j]
    return blocks


@njit(cache=True)
def hold(indptr: Integers, indices: Integers, data: Numbers, fixed: NDArray[np.bool_]) -> None:
    """Set rows and columns of fixed unknowns to zero but for the diagonal; data : (nnz, b, b), fixed : (n, b)."""
    b = fixed.shape[1]
    for row in range(len(indptr) - 1):
        for entry in range(indptr[row], indptr[row + 1]):
            column = indices[entry]
            for i in range(b):
                for j in range(b):
                    if (fixed[row, i] or fixed[column, j]) and not (row == column and i == j):
                        data[entry, i, j] = 0.0


@njit(cache=True)
def row_sizes(indptr: Integers, data: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) sum of the sizes of the entries of every row; data : (nnz,)."""
    sizes = np.zeros(len(indptr) - 1)
    for row in range(len(sizes)):
        for entry in range(indptr[row], indptr[row + 1]):
            sizes[row] += abs(data[entry])
    return sizes


@njit(cache=True)
def aggregates(indptr: Integers, indices: Integers, strong: NDArray[np.bool_]) -> Integers:
    """(n,) number of the aggregate of every node, -1 for a node that nothing couples strongly.

    strong : (nnz,) which entries couple. First every node whose strong neighbours are all free makes an
    aggregate with them, then the rest join a neighbour's, then what is left makes its own.
    Source: Vanek, Mandel, Brezina, Computing 56 (1996) 179, algorithm 5.1.
    """
    n = len(indptr) - 1
    group = np.full(n, -1, dtype=np.int32)
    count = 0
    for row in range(n):
        free, neighbours = group[row] < 0, 0
        for entry in range(indptr[row], indptr[row + 1]):
            if strong[entry] and indices[entry] != row:
                neighbours += 1
                free = free and group[indices[entry]] < 0
        if free and neighbours > 0:
            group[row] = count
            for entry in range(indptr[row], indptr[row + 1]):
                if strong[entry]:
                    group[indices[entry]] = count
            count += 1
    first_pass = group.copy()
    for row in range(n):
        if group[row] < 0:
            for entry in range(indptr[row], indptr[row + 1]):
                if strong[entry] and first_pass[indices[entry]] >= 0:
                    group[row] = first_pass[indices[entry]]
                    break
    for row in range(n):
        if group[row] < 0:
            neighbours = 0
            for entry in range(indptr[row], indptr[row + 1]):
                if strong[entry] and indices[entry] != row:
                    neighbours += 1
                    if group[indices[entry]] < 0:
                        group[indices[entry]] = count
            if neighbours > 0:
                group[row] = count
                count += 1
    return group


@njit(cache=True)
def tied_pairs(
    indptr: Integers, indices: Integers, data: Numbers, limit: float
) -> tuple[Integers, Integers, Numbers]:
    """First and second node (k,) of every entry larger than ``limit`` of the root of their diagonals' product.

    data : (nnz, b, b) blocks of a symmetric matrix, sized by the root of their squares' sum; the third array
    (k,) is the size relative to the root of the product
    """
    n, b = len(indptr) - 1, data.shape[1]
    diagonal = np.zeros(n)
    for row in range(n):
        for entry in range(indptr[row], indptr[row + 1]):
            if indices[entry] == row:
                for i in range(b):
                    for j in range(b):
                        diagonal[row] += data[entry, i, j] ** 2
    first, second, strength = [], [], []
    for row in range(n):
        for entry in range(indptr[row], indptr[row + 1]):
            column = indices[entry]
            if column > row:
                size = 0.0
                for i in range(b):
                    for j in range(b):
                        size += data[entry, i, j] ** 2
                scale = np.sqrt(diagonal[row] * diagonal[column])
                if size > limit * limit * scale:
                    first.append(row)
                    second.append(column)
                    strength.append(np.sqrt(size / scale))
    return np.array(first, dtype=np.int32), np.array(second, dtype=np.int32), np.array(strength)


@njit(cache=True)
def joined(n: int, first: Integers, second: Integers, most: int) -> Integers:
    """(n,) number of the group of every node, -1 for a node alone: pairs joined in turn, up to ``most`` nodes."""
    parent = np.arange(n, dtype=np.int32)
    size = np.ones(n, dtype=np.int32)
    for k in range(len(first)):
        a, b = first[k], second[k]
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        while parent[b] != b:
            parent[b] = parent[parent[b]]
            b = parent[b]
        if a != b and size[a] + size[b] <= most:
            low, high = min(a, b), max(a, b)
            parent[high] = low
            size[low] += size[high]
    label = np.full(n, -1, dtype=np.int32)
    for node in range(n):
        root = node
        while parent[root] != root:
            root = parent[root]
        if size[root] > 1:
            label[node] = root
    return label


@njit(cache=True)
def group_blocks(
    indptr: Integers, indices: Integers, data: NDArray[np.float64], members: Integers
) -> NDArray[np.float64]:
    """Dense blocks (k, s b, s b) of k groups of s nodes; data : (nnz, b, b), members : (k, s)."""
    count, size = members.shape
    b = data.shape[1]
    blocks = np.zeros((count, size * b, size * b))
    for group in range(count):
        for member in range(size):
            row = members[group, member]
            for entry in range(indptr[row], indptr[row + 1]):
                for other in range(size):
                    if members[group, other] == indices[entry]:
                        for i in range(b):
                            for j in range(b):
                                blocks[group, member * b + i, other * b + j] = data[entry, i, j]
    return blocks

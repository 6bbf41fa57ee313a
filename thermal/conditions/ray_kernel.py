"""Compiled: the first triangle that each ray meets, found cell by cell along the ray in a regular grid.

Sources: Amanatides, Woo, A fast voxel traversal algorithm, Eurographics 1987 (the way through the grid); Möller,
Trumbore, J. Graphics Tools 2 (1997) 21 (ray and triangle).
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

PER_CELL = 2.0
"""Triangles for each cell of the grid, about."""
MOST_CELLS = 128
"""Cells of the grid along one axis at most."""


def grid_of(corners: Floats) -> tuple[Floats, Floats, Integers]:
    """Low corner (3,), size of a cell (3,) and number of cells (3,) of a grid around triangles (n, 3, 3)."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    margin = 1e-6 * float((high - low).max())
    low, high = low - margin, high + margin
    length = (float(np.prod(high - low)) * PER_CELL / len(corners)) ** (1.0 / 3.0)
    counts = np.clip(np.ceil((high - low) / length), 1, MOST_CELLS).astype(np.int64)
    return low, (high - low) / counts, counts


@njit(cache=True)
def sorted_in(corners: Floats, low: Floats, size: Floats, counts: Integers) -> tuple[Integers, Integers]:
    """Start (n_cells + 1,) and list of the triangles (n, 3, 3) whose bounding box reaches each cell of a grid."""
    n = len(corners)
    first = np.empty((n, 3), dtype=np.int64)
    last = np.empty((n, 3), dtype=np.int64)
    start = np.zeros(counts[0] * counts[1] * counts[2] + 1, dtype=np.int64)
    for t in range(n):
        for axis in range(3):
            least = min(corners[t, 0, axis], corners[t, 1, axis], corners[t, 2, axis])
            most = max(corners[t, 0, axis], corners[t, 1, axis], corners[t, 2, axis])
            first[t, axis] = max(int((least - low[axis]) / size[axis] - 1e-9), 0)
            last[t, axis] = min(int((most - low[axis]) / size[axis] + 1e-9), counts[axis] - 1)
        for i in range(first[t, 0], last[t, 0] + 1):
            for j in range(first[t, 1], last[t, 1] + 1):
                for k in range(first[t, 2], last[t, 2] + 1):
                    start[(i * counts[1] + j) * counts[2] + k + 1] += 1
    for cell in range(len(start) - 1):
        start[cell + 1] += start[cell]
    fill = start[:-1].copy()
    listed = np.empty(start[-1], dtype=np.int64)
    for t in range(n):
        for i in range(first[t, 0], last[t, 0] + 1):
            for j in range(first[t, 1], last[t, 1] + 1):
                for k in range(first[t, 2], last[t, 2] + 1):
                    cell = (i * counts[1] + j) * counts[2] + k
                    listed[fill[cell]] = t
                    fill[cell] += 1
    return start, listed


@njit(cache=True)
def first_hits(
    origins: Floats,
    directions: Floats,
    corners: Floats,
    grid: tuple[Floats, Floats, Integers],
    cells: tuple[Integers, Integers],
) -> Integers:
    """(n,) number of the first triangle that each ray meets from its front; -1 for a ray that leaves the grid.

    Faces that touch see each other: a triangle where the ray starts counts if it turns its front to it.

    origins, directions : (n, 3), directions of length one; corners : (m, 3, 3), counter-clockwise seen from the front
    grid : from `grid_of`; cells : from `sorted_in`
    """
    low, size, counts = grid
    start, listed = cells
    hits = np.full(len(origins), -1, dtype=np.int64)
    step = np.empty(3, dtype=np.int64)
    index = np.empty(3, dtype=np.int64)
    reach = np.empty(3)
    rise = np.empty(3)
    touching = -1e-9 * (size[0] * counts[0] + size[1] * counts[1] + size[2] * counts[2])
    for r in range(len(origins)):
        ox, oy, oz = origins[r]
        dx, dy, dz = directions[r]
        for axis in range(3):
            place, along = origins[r, axis] - low[axis], directions[r, axis]
            index[axis] = min(max(int(place / size[axis]), 0), counts[axis] - 1)
            if along > 0.0:
                step[axis], rise[axis] = 1, size[axis] / along
                reach[axis] = ((index[axis] + 1) * size[axis] - place) / along
            elif along < 0.0:
                step[axis], rise[axis] = -1, -size[axis] / along
                reach[axis] = (index[axis] * size[axis] - place) / along
            else:
                step[axis], rise[axis], reach[axis] = 0, np.inf, np.inf
        nearest = np.inf
        while True:
            cell = (index[0] * counts[1] + index[1]) * counts[2] + index[2]
            for place_in_list in range(start[cell], start[cell + 1]):
                t = listed[place_in_list]
                ax, ay, az = corners[t, 0]
                ux, uy, uz = corners[t, 1, 0] - ax, corners[t, 1, 1] - ay, corners[t, 1, 2] - az
                vx, vy, vz = corners[t, 2, 0] - ax, corners[t, 2, 1] - ay, corners[t, 2, 2] - az
                px, py, pz = dy * vz - dz * vy, dz * vx - dx * vz, dx * vy - dy * vx
                det = ux * px + uy * py + uz * pz
                if det <= 0.0:
                    continue
                sx, sy, sz = ox - ax, oy - ay, oz - az
                u = sx * px + sy * py + sz * pz
                if u < 0.0 or u > det:
                    continue
                qx, qy, qz = sy * uz - sz * uy, sz * ux - sx * uz, sx * uy - sy * ux
                v = dx * qx + dy * qy + dz * qz
                if v < 0.0 or u + v > det:
                    continue
                distance = (vx * qx + vy * qy + vz * qz) / det
                if touching < distance < nearest:
                    nearest, hits[r] = distance, t
            axis = 0 if reach[0] <= reach[1] and reach[0] <= reach[2] else (1 if reach[1] <= reach[2] else 2)
            if nearest <= reach[axis] or not np.isfinite(reach[axis]):
                break
            index[axis] += step[axis]
            if index[axis] < 0 or index[axis] >= counts[axis]:
                break
            reach[axis] += rise[axis]
    return hits

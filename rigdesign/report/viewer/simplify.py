"""A coarser picture of a fine mesh: nodes of one small cube become one.

Vertex clustering, J. Rossignac and P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes",
Modeling in Computer Graphics, Springer 1993, here with the tetrahedra behind the skin as well.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.viewer.solid import MOST_TETRAHEDRA, MOST_TRIANGLES, Indices, SolidPicture
from thermal.fe.mesh import FloatArray

FEWEST, FINEST = 4, 512
"""Cubes along the longest side of the mesh, between which the finest picture that is small enough is sought."""


def simplified(picture: SolidPicture, points: FloatArray) -> SolidPicture:
    """The picture itself if it is small enough, else the finest clustering that is.

    points : (n, 3) of ``picture.nodes``. Bodies share no cluster that they do not share a node of, and skin and inside
    are kept apart, so that every body keeps its outline.
    """
    if _small(picture):
        return picture
    groups = _node_groups(picture)
    found, low, high = _clustered(picture, points, groups, FEWEST), FEWEST, FINEST
    while high - low > 1:
        middle = (low + high) // 2
        finer = _clustered(picture, points, groups, middle)
        if _small(finer):
            found, low = finer, middle
        else:
            high = middle
    return found


def _small(picture: SolidPicture) -> bool:
    return len(picture.triangles) <= MOST_TRIANGLES and len(picture.tetrahedra) <= MOST_TETRAHEDRA


def _node_groups(picture: SolidPicture) -> Indices:
    """(n,) number of the set of bodies a node belongs to, and whether it lies in a skin."""
    belongs = np.zeros((len(picture.nodes), len(picture.bodies) + 1), dtype=bool)
    belongs[picture.tetrahedra, picture.tetrahedron_body[:, None]] = True
    belongs[picture.triangles, -1] = True
    return np.unique(belongs, axis=0, return_inverse=True)[1].reshape(-1)


def _clustered(picture: SolidPicture, points: FloatArray, groups: Indices, count: int) -> SolidPicture:
    """Nodes of one group in one of ``count`` cubes along the longest side become the one nearest to their middle."""
    size = float(np.ptp(points, axis=0).max()) / count
    cubes = np.floor((points - points.min(axis=0)) / size).astype(np.int64)
    keys = ((groups * (count + 1) + cubes[:, 0]) * (count + 1) + cubes[:, 1]) * (count + 1) + cubes[:, 2]
    _, cluster, counts = np.unique(keys, return_inverse=True, return_counts=True)
    middles = np.column_stack([np.bincount(cluster, points[:, k]) for k in range(3)]) / counts[:, None]
    away = np.linalg.norm(points - middles[cluster], axis=1)
    order = np.lexsort((away, cluster))
    chosen = order[np.unique(cluster[order], return_index=True)[1]]
    kept = chosen[cluster]
    cells = _with_area(kept[picture.tetrahedra])
    skin = _with_area(kept[picture.triangles])
    cells &= _once(np.column_stack([np.sort(kept[picture.tetrahedra], axis=1), picture.tetrahedron_body]))
    skin &= _once(np.column_stack([np.sort(kept[picture.triangles], axis=1), picture.triangle_body]))
    used, local = np.unique(
        np.concatenate([kept[picture.tetrahedra[cells]].ravel(), kept[picture.triangles[skin]].ravel()]),
        return_inverse=True,
    )
    split = 4 * int(cells.sum())
    return replace(
        picture,
        nodes=picture.nodes[used],
        tetrahedra=local[:split].reshape(-1, 4),
        tetrahedron_body=picture.tetrahedron_body[cells],
        triangles=local[split:].reshape(-1, 3),
        triangle_body=picture.triangle_body[skin],
        triangle_surface=picture.triangle_surface[skin],
    )


def _with_area(corners: Indices) -> NDArray[np.bool_]:
    """(k,) True where no two corners fell together."""
    ordered = np.sort(corners, axis=1)
    return np.asarray((ordered[:, 1:] != ordered[:, :-1]).all(axis=1))


def _once(rows: Indices) -> NDArray[np.bool_]:
    """(k,) True at the first of equal rows."""
    order = np.lexsort(rows.T[::-1])
    first = np.ones(len(rows), dtype=bool)
    first[order[1:]] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    return first

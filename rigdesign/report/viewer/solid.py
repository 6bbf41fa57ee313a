"""What the turnable picture shows of a mesh: bodies of flat tetrahedra and their skins, by name."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.field import HEX_TETRAHEDRA, SUB_TETRAHEDRA, SUB_TRIANGLES
from thermal.fe.mesh import FloatArray, IndexArray, NamedMesh, facet_keys

Indices = NDArray[np.int64]

MOST_TRIANGLES, MOST_TETRAHEDRA = 20_000, 60_000
"""Of a picture: what a phone turns without delay and a page of 3 MB has room for."""
CREASE = np.cos(np.radians(35.0))
"""Cosine of the angle between two triangles from which the edge between them stays sharp under light."""
UNNAMED = "between two bodies"
"""Surface of a skin triangle that no named surface covers."""


@dataclass(frozen=True)
class SolidPicture:
    """Bodies of flat tetrahedra and their skins.

    nodes : (n,) mesh nodes in use, ascending; all other indices count these
    tetrahedra : (t, 4) and ``tetrahedron_body`` (t,) number in ``bodies``
    triangles : (k, 3) the skin of every body, ``triangle_body`` (k,), ``triangle_surface`` (k,) number in ``surfaces``
    bodies, surfaces : names
    """

    nodes: Indices
    tetrahedra: Indices
    tetrahedron_body: Indices
    triangles: Indices
    triangle_body: Indices
    triangle_surface: Indices
    bodies: tuple[str, ...]
    surfaces: tuple[str, ...]


def solid_picture(mesh: NamedMesh) -> SolidPicture:
    """Split the cells into flat tetrahedra and find the skin of every body with its surface names.

    Bodies are split along their mid-side nodes, the smallest first, as long as the picture stays small enough: shafts
    and gears are round then. The others, and all hexahedra, are drawn by their corners.
    """
    body = np.zeros(len(mesh.cells), dtype=np.int64)
    for number, members in enumerate(mesh.bodies.values()):
        body[members] = number
    rows = _skin_rows(mesh, body)
    sides = mesh.facets.nodes_at(rows).astype(np.int64)
    side_body = body[mesh.facets.cells[rows]]
    surface = _surface_of(mesh, sides[:, : mesh.shape.side.n_corners])
    fine = _fine_bodies(mesh, np.bincount(side_body, minlength=len(mesh.bodies)))
    cells = _split(mesh.cells, np.isin(body, fine), *_cell_parts(mesh))
    skin = _split(sides, np.isin(side_body, fine), *_side_parts(mesh))
    nodes, local = np.unique(cells.corners, return_inverse=True)
    return SolidPicture(
        nodes=nodes.astype(np.int64),
        tetrahedra=local.reshape(-1, 4),
        tetrahedron_body=body[cells.origin],
        triangles=np.searchsorted(nodes, skin.corners),
        triangle_body=side_body[skin.origin],
        triangle_surface=surface[skin.origin],
        bodies=tuple(mesh.bodies),
        surfaces=(*mesh.surfaces, UNNAMED),
    )


def solid_pictures(meshes: Iterable[NamedMesh]) -> dict[int, SolidPicture]:
    """Picture of every mesh by its identity; a mesh that several fields share is split once."""
    return {number: solid_picture(mesh) for number, mesh in {id(mesh): mesh for mesh in meshes}.items()}


def _fine_bodies(mesh: NamedMesh, sides: Indices) -> list[int]:
    """Numbers of the bodies to split along their mid-side nodes; sides : (n_bodies,) skin sides of each."""
    if mesh.shape.side.n_corners != 3:
        return []
    tetrahedra, triangles, fine = len(mesh.cells), int(sides.sum()), []
    counts = [len(cells) for cells in mesh.bodies.values()]
    for number in sorted(range(len(counts)), key=lambda number: counts[number]):
        tetrahedra += 7 * counts[number]
        triangles += 3 * int(sides[number])
        if tetrahedra > MOST_TETRAHEDRA or triangles > MOST_TRIANGLES:
            break
        fine.append(number)
    return fine


def _cell_parts(mesh: NamedMesh) -> tuple[Indices, Indices]:
    """Flat tetrahedra of a cell, coarse and fine, by its local nodes."""
    if mesh.shape.side.n_corners == 3:
        return np.array([(0, 1, 2, 3)]), SUB_TETRAHEDRA
    return HEX_TETRAHEDRA, HEX_TETRAHEDRA


def _side_parts(mesh: NamedMesh) -> tuple[Indices, Indices]:
    """Flat triangles of a side, coarse and fine, by its local nodes."""
    if mesh.shape.side.n_corners == 3:
        return np.array([(0, 1, 2)]), SUB_TRIANGLES
    halves = np.array([(0, 1, 2), (0, 2, 3)])
    return halves, halves


@dataclass(frozen=True)
class _Parts:
    """Corners (k, 3 or 4) of parts by mesh nodes, and the cell or side (k,) each is part of."""

    corners: Indices
    origin: Indices


def _split(nodes: IndexArray | Indices, fine: NDArray[np.bool_], coarse: Indices, finer: Indices) -> _Parts:
    """Parts of cells or sides (n, n_local): ``finer`` where ``fine`` (n,) holds, else ``coarse``."""
    found = [
        (nodes[rows][:, parts].reshape(-1, parts.shape[1]).astype(np.int64), np.repeat(rows, len(parts)))
        for rows, parts in ((np.flatnonzero(~fine), coarse), (np.flatnonzero(fine), finer))
    ]
    return _Parts(np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found]))


def _skin_rows(mesh: NamedMesh, body: Indices) -> Indices:
    """Rows of the facet table behind which the same body does not go on."""
    table = mesh.facets
    goes_on = (table.keys[1:] == table.keys[:-1]) & (body[table.cells[1:]] == body[table.cells[:-1]])
    return np.flatnonzero(~(np.append(goes_on, False) | np.append(False, goes_on)))


def _surface_of(mesh: NamedMesh, sides: Indices) -> Indices:
    """Number of the named surface of every skin side, by the corners they share; the last number: none."""
    corners = mesh.shape.side.n_corners
    unnamed = len(mesh.surfaces)
    if not unnamed:
        return np.zeros(len(sides), dtype=np.int64)
    named = np.concatenate([facets[:, :corners] for facets in mesh.surfaces.values()])
    owner = np.repeat(np.arange(unnamed), [len(facets) for facets in mesh.surfaces.values()])
    keys = facet_keys(named, len(mesh.points))
    order = np.argsort(keys, kind="stable")
    wanted = facet_keys(sides.astype(np.int32), len(mesh.points))
    at = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    found = keys[order][at] == wanted
    return np.where(found, owner[order][at], unnamed)


def shaded_vertices(picture: SolidPicture, points: FloatArray) -> tuple[Indices, Indices]:
    """Vertices for smooth light: a node once for each smooth region and named surface that meet there.

    points : (n, 3) of ``picture.nodes``
    Returns the node of every vertex (v,) and the skin as (k, 3) vertices.
    """
    region = _smooth_regions(picture, points)
    n_regions, n_surfaces = int(region.max(initial=0)) + 1, len(picture.surfaces)
    keys = (picture.triangles * n_regions + region[:, None]) * n_surfaces + picture.triangle_surface[:, None]
    found, vertices = np.unique(keys, return_inverse=True)
    return found // (n_regions * n_surfaces), vertices.reshape(-1, 3)


def _smooth_regions(picture: SolidPicture, points: FloatArray) -> Indices:
    """(k,) number of the smooth region of every skin triangle: neighbours of one body without a crease between."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    triangles, count = picture.triangles, len(picture.triangles)
    normals = triangle_normals(points[triangles])
    sides = np.sort(np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
    keys = (sides[:, 0] * len(points) + sides[:, 1]) * len(picture.bodies) + np.tile(picture.triangle_body, 3)
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    first, second = order[same] % count, order[same + 1] % count
    smooth = np.einsum("ij,ij->i", normals[first], normals[second]) > CREASE
    first, second = first[smooth], second[smooth]
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def triangle_normals(corners: FloatArray) -> FloatArray:
    """Unit normals (k, 3) of triangles (k, 3, 3); zero where a triangle has no area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    return np.asarray(normals / np.where(lengths > 0.0, lengths, 1.0)[:, None])

"""Geometry of pictures: what is seen of a mesh from outside and in a plane cut. No drawing."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thermal.fe.mesh import FloatArray, NamedMesh

Indices = NDArray[np.int64]

SUB_TETRAHEDRA = np.array(
    [
        (0, 4, 6, 7),
        (1, 5, 4, 8),
        (2, 6, 5, 9),
        (3, 7, 8, 9),
        (4, 9, 5, 6),
        (4, 9, 6, 7),
        (4, 9, 7, 8),
        (4, 9, 8, 5),
    ]
)
"""Eight linear tetrahedra that fill a 10-node one (VTK order), the inner octahedron split along 01-23."""

HEX_TETRAHEDRA = np.array(
    [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
)
"""Six tetrahedra round a diagonal that fill a hexahedron, from its corners alone."""

EDGE_ON = 1e-9
"""Cosine to the viewer below which a facet is only a line."""

SUB_TRIANGLES = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])
"""Four linear triangles that fill a 6-node one (corners first, mid-sides 01 12 20)."""

SUB_QUADRILATERAL = np.array([(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)])
"""Six linear triangles that fill a quadrilateral of 8 or 9 nodes (corners first, then mid-sides)."""

FINE = 40_000
"""Facets from which their corners alone are drawn: smaller than what a picture resolves."""


@dataclass(frozen=True)
class PlaneCut:
    """Triangles of a plane through a mesh; every point lies on an edge between two nodes.

    points : (m, 3) coordinates [m]
    triangles : (k, 3) indices into ``points``
    bodies : (k,) number of the body, in the order of ``mesh.bodies``
    nodes : (m, 2) mesh nodes at the ends of the edge
    weights : (m,) position on the edge, 0 at the first node
    """

    points: FloatArray
    triangles: Indices
    bodies: Indices
    nodes: Indices
    weights: FloatArray

    def interpolate(self, values: FloatArray) -> FloatArray:
        """Nodal values, shape (n_nodes,), at the points of the cut, shape (m,)."""
        start, end = values[self.nodes[:, 0]], values[self.nodes[:, 1]]
        return np.asarray(start + self.weights * (end - start))

    def outlines(self, shown: NDArray[np.bool_] | slice = slice(None)) -> Indices:
        """(e, 2) point pairs of the edges where a body ends; shown : (k,) which triangles count, all if left out."""
        triangles, bodies = self.triangles[shown], self.bodies[shown]
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        size = len(self.points)
        pairs = np.sort(sides, axis=1) @ np.array([size, 1]) + size**2 * np.tile(bodies, 3)
        found, counts = np.unique(pairs, return_counts=True)
        first, second = np.divmod(found[counts == 1] % size**2, size)
        return np.column_stack([first, second])


def cut_mesh(mesh: NamedMesh, axis: int, position: float) -> PlaneCut:
    """Cut a mesh by the plane where coordinate ``axis`` (0, 1, 2) equals ``position`` [m].

    A node in the plane counts as beyond it, so no cell is met twice.
    """
    distance = mesh.points[:, axis] - position
    beyond = distance >= 0
    sides = beyond[mesh.cells]
    met = np.flatnonzero(sides.any(axis=1) & ~sides.all(axis=1))
    body_of_cell = np.zeros(len(mesh.cells), dtype=np.int64)
    for number, cells in enumerate(mesh.bodies.values()):
        body_of_cell[cells] = number
    parts = SUB_TETRAHEDRA if mesh.cells.shape[1] == 10 else HEX_TETRAHEDRA
    tetrahedra = mesh.cells[met][:, parts].reshape(-1, 4).astype(np.int64)
    bodies = np.repeat(body_of_cell[met], len(parts))
    edges, owners = _crossed_edges(tetrahedra, bodies, beyond)
    ends = np.sort(edges.reshape(-1, 2), axis=1)
    pairs, inverse = np.unique(ends @ np.array([len(mesh.points), 1]), return_inverse=True)
    nodes = np.column_stack(np.divmod(pairs, len(mesh.points)))
    first, second = distance[nodes[:, 0]], distance[nodes[:, 1]]
    weights = first / (first - second)
    points = mesh.points[nodes[:, 0]] + weights[:, None] * (
        mesh.points[nodes[:, 1]] - mesh.points[nodes[:, 0]]
    )
    return PlaneCut(points, inverse.reshape(-1, 3), owners, nodes, weights)


def _crossed_edges(
    tetrahedra: Indices, bodies: Indices, beyond: NDArray[np.bool_]
) -> tuple[Indices, Indices]:
    """(k, 3, 2) node pairs of the triangle corners in the plane, and the body of each triangle."""
    order = np.argsort(~beyond[tetrahedra], axis=1, kind="stable")
    nodes = np.take_along_axis(tetrahedra, order, axis=1)
    count = beyond[tetrahedra].sum(axis=1)
    triangles, owners = [], []
    for beyond_count, patterns in {
        1: [[(0, 1), (0, 2), (0, 3)]],
        2: [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]],
        3: [[(3, 0), (3, 1), (3, 2)]],
    }.items():
        chosen = np.flatnonzero(count == beyond_count)
        for pattern in patterns:
            triangles.append(nodes[chosen][:, np.array(pattern)])
            owners.append(bodies[chosen])
    return np.concatenate(triangles), np.concatenate(owners)


@dataclass(frozen=True)
class OutsideView:
    """Facets that face the viewer, farthest first, in the picture plane.

    corners : (k, 3, 2) picture coordinates [m]
    nodes : (k, 3) mesh nodes of the corners
    brightness : (k,) 0 to 1 from the angle to the light
    focus : (2, 2) lowest and highest picture coordinates of everything but the field [m]
    """

    corners: FloatArray
    nodes: Indices
    brightness: FloatArray
    focus: FloatArray


def view_outside(
    mesh: NamedMesh,
    azimuth_deg: float = -60.0,
    elevation_deg: float = 28.0,
    points: FloatArray | None = None,
) -> OutsideView:
    """Parallel projection of the named surfaces, x along the shafts, z up.

    azimuth_deg, elevation_deg : direction from which the viewer looks, azimuth from the x axis about z
    points : (n_nodes, 3) places of the nodes [m], those of the mesh when left out
    """
    places = mesh.points if points is None else points
    right, up, towards = camera(np.radians(azimuth_deg), np.radians(elevation_deg))
    facets = surface_triangles(mesh)
    corners = places[facets]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals /= np.where(lengths > 0, lengths, 1.0)[:, None]
    facing = np.flatnonzero(normals @ towards > EDGE_ON)
    facing = facing[np.argsort(corners[facing].mean(axis=1) @ towards, kind="stable")]
    light = towards + 0.6 * up - 0.4 * right
    brightness = 0.7 + 0.3 * np.clip(normals[facing] @ (light / np.linalg.norm(light)), 0.0, 1.0)
    plane = np.column_stack([right, up])
    standing = _standing_nodes(mesh)
    seen = places[standing] @ plane
    focus = np.array([seen.min(axis=0), seen.max(axis=0)])
    return OutsideView(corners[facing] @ plane, facets[facing], brightness, focus)


def surface_triangles(mesh: NamedMesh) -> Indices:
    """(k, 3) nodes of linear triangles that cover all named surfaces."""
    facets = np.concatenate(list(mesh.surfaces.values()))
    if facets.shape[1] == 6:
        parts = SUB_TRIANGLES if len(facets) < FINE else np.array([(0, 1, 2)])
    else:
        parts = SUB_QUADRILATERAL if len(facets) < FINE else np.array([(0, 1, 2), (0, 2, 3)])
    return np.asarray(facets[:, parts].reshape(-1, 3), dtype=np.int64)


def _standing_nodes(mesh: NamedMesh) -> Indices:
    """Nodes of all bodies but the field under them; of all where there is nothing else."""
    bodies = list(mesh.bodies.values())
    held = np.zeros(len(mesh.points), dtype=bool)
    held[mesh.cells[np.concatenate([bodies[number] for number in standing_bodies(mesh)])]] = True
    return np.flatnonzero(held).astype(np.int64)


def standing_bodies(mesh: NamedMesh) -> Indices:
    """Numbers of all bodies but the clamping field, which is several times as large as what stands on it."""
    names = list(mesh.bodies)
    standing = [number for number, name in enumerate(names) if "field" not in name and len(mesh.bodies[name])]
    return np.array(standing or range(len(names)), dtype=np.int64)


def camera(azimuth: float, elevation: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Unit vectors to the right, up, and towards the viewer."""
    towards = np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return right, np.cross(towards, right), towards


def shaft_axis_height(mesh: NamedMesh) -> float:
    """Height z [m] of a horizontal cut that shows the most: through the shafts, else through the middle."""
    shafts = [cells for name, cells in mesh.bodies.items() if "shaft" in name.lower() and len(cells)]
    heights = mesh.points[mesh.cells[np.concatenate(shafts)], 2] if shafts else mesh.points[:, 2]
    return float(heights.min() + heights.max()) / 2

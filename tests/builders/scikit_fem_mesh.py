"""Meshes of second order from linear cells, and from those of scikit-fem."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.mesh import CellName, NamedMesh, named_mesh
from thermal.fe.reference_elements import CELLS, CellElement


def second_order(
    points: FloatArray,
    linear_cells: IndexArray,
    bodies: Mapping[str, IndexArray],
    surface_corners: Mapping[str, IndexArray],
) -> NamedMesh:
    """Raise a mesh of 4-node tetrahedra or 8-node hexahedra to second order with straight edges.

    points : (n, 3) [m]; linear_cells : (n_cells, 4 or 8) in any orientation; bodies and surface_corners as in
    named_mesh. The corner nodes keep their numbers, mid-side nodes follow. Hexahedra get 20 nodes.
    """
    shape = _named("tetra10" if linear_cells.shape[1] == 4 else "hexahedron20")
    linear_cells = _turned(points, linear_cells, shape)
    edges = np.sort(linear_cells[:, np.array(shape.edges)].reshape(-1, 2), axis=1)
    unique, which = np.unique(edges, axis=0, return_inverse=True)
    mids = 0.5 * (points[unique[:, 0]] + points[unique[:, 1]])
    cells = np.hstack([linear_cells, len(points) + which.reshape(-1, len(shape.edges))]).astype(np.int32)
    return named_mesh(np.vstack([points, mids]), cells, bodies, surface_corners)


def from_scikit_fem(mesh: Any) -> NamedMesh:
    """Convert a scikit-fem mesh of tetrahedra or hexahedra with its subdomains and boundaries.

    ``MeshTet1`` and ``MeshHex1`` are raised to second order with straight edges, ``MeshTet2`` and ``MeshHex2``
    (27 nodes) taken as they are. Cells outside of every subdomain form the body ``rest``, boundary facets
    outside of every named boundary the surface ``rest``.
    """
    bodies = {name: np.asarray(ix, dtype=np.int32) for name, ix in (mesh.subdomains or {}).items()}
    named = np.concatenate([*bodies.values(), np.empty(0, dtype=np.int32)])
    if len(rest := np.setdiff1d(np.arange(mesh.t.shape[1]), named)):
        bodies["rest"] = rest.astype(np.int32)
    facets = {name: np.asarray(ix) for name, ix in (mesh.boundaries or {}).items()}
    if len(rest := np.setdiff1d(mesh.boundary_facets(), np.concatenate([*facets.values(), []]))):
        facets["rest"] = rest
    corners = {name: mesh.facets[:, ix].T for name, ix in facets.items()}
    names: dict[int, CellName] = {4: "tetra10", 8: "hexahedron20", 10: "tetra10", 27: "hexahedron27"}
    n_local = len(mesh.elem.doflocs)
    shape = _named(names[n_local])
    cells = mesh.dofs.element_dofs[list(shape.order[:n_local])].T
    if n_local == shape.n_corners:
        return second_order(mesh.doflocs.T, cells, bodies, corners)
    return named_mesh(mesh.doflocs.T, _turned(mesh.doflocs.T, cells, shape), bodies, corners)


def _named(cell: CellName) -> CellElement:
    return next(shape for shape in CELLS.values() if shape.name == cell)


def _turned(points: FloatArray, cells: IndexArray, shape: CellElement) -> IndexArray:
    """Cells with the nodes of left-handed ones mirrored; cells : (n, n_corners or n_nodes)."""
    apexes = (1, 2, 3) if shape.n_corners == 4 else (1, 3, 4)
    edges = points[cells[:, apexes]] - points[cells[:, :1]]
    left_handed = np.linalg.det(edges) < 0.0
    return np.where(left_handed[:, None], cells[:, list(shape.mirror[: cells.shape[1]])], cells)

"""What a mesh must satisfy before anything is computed on it."""

import numpy as np

from thermal.fe.mesh import FloatArray, IndexArray, MeshError, NamedMesh, facet_keys

NODE_ORDER = 0.5
"""Share of inverted cells from which on the order of their nodes is at fault."""
MAX_NODES = 2_000_000
"""Facets are recognised by one 64-bit number made of three node numbers."""


def check_topology(mesh: NamedMesh) -> frozenset[str]:
    """Check numbering, bodies and surfaces of ``mesh``; return the surfaces that lie between two cells.

    Raises MeshError naming body or surface, the fault and what to do, if
    - an array has the wrong shape, a node number is out of range or a coordinate is no finite number,
    - a cell belongs to no body or to two, or a node to no cell,
    - a facet of a surface is no side of a cell or looks into its cell,
    - a facet on the boundary belongs to no surface or to two.
    """
    _check_arrays(mesh)
    _check_bodies(mesh)
    return _check_surfaces(mesh)


def check_volumes(mesh: NamedMesh, smallest: FloatArray) -> None:
    """Check that no cell is inverted.

    smallest : (n_cells,) smallest volume weight of each cell [m3]
    Raises MeshError with the number of inverted cells by body.
    """
    bad = smallest <= 0.0
    if not bad.any():
        return
    counts = {name: int(np.count_nonzero(bad[cells])) for name, cells in mesh.bodies.items()}
    where = ", ".join(f"{count} in body {name!r}" for name, count in counts.items() if count)
    remedy = "refine the mesh at curved faces, or optimise its high-order nodes"
    if bad.mean() > NODE_ORDER:
        remedy = (
            "so many stand for another order of nodes: write a .msh in gmsh's order, in which the last two nodes of a "
            "ten-node tetrahedron are exchanged against VTK's, or put them into NamedMesh order"
        )
    raise MeshError(f"inverted cells: {where} of {len(bad)}; {remedy}")


def _check_arrays(mesh: NamedMesh) -> None:
    if mesh.points.ndim != 2 or mesh.points.shape[1] != 3 or not np.isfinite(mesh.points).all():
        raise MeshError(f"points of shape {mesh.points.shape}: need (n_nodes, 3) finite coordinates [m]")
    if not len(mesh.cells):
        raise MeshError("the mesh has no cells; mesh at least one body")
    columns = mesh.shape.side.n_nodes
    if len(mesh.points) > MAX_NODES:
        raise MeshError(f"{len(mesh.points)} nodes are above the limit of {MAX_NODES}; use larger cells")
    for name, nodes in {"cells": mesh.cells, **mesh.surfaces}.items():
        if nodes.size and (nodes.min() < 0 or nodes.max() >= len(mesh.points)):
            raise MeshError(f"{name}: node number outside of 0 to {len(mesh.points) - 1}")
    for name, nodes in mesh.surfaces.items():
        if nodes.ndim != 2 or nodes.shape[1] != columns or not len(nodes):
            raise MeshError(
                f"surface {name!r} of shape {nodes.shape}: need (k, {columns}) nodes, k at least 1"
            )


def _check_bodies(mesh: NamedMesh) -> None:
    owners = np.zeros(len(mesh.cells), dtype=np.int64)
    for name, cells in mesh.bodies.items():
        if not len(cells) or cells.min() < 0 or cells.max() >= len(mesh.cells):
            raise MeshError(f"body {name!r}: empty, or a cell number outside of 0 to {len(mesh.cells) - 1}")
        np.add.at(owners, cells, 1)
    if (owners != 1).any():
        raise MeshError(
            f"{np.count_nonzero(owners == 0)} cells are in no body and {np.count_nonzero(owners > 1)} in "
            "several; give every cell exactly one"
        )
    loose = np.count_nonzero(np.bincount(mesh.cells.ravel(), minlength=len(mesh.points)) == 0)
    if loose:
        raise MeshError(f"{loose} nodes belong to no cell; remove them and renumber")


def _check_surfaces(mesh: NamedMesh) -> frozenset[str]:
    table = mesh.facets
    n_corners = mesh.shape.side.n_corners
    on_boundary = table.on_boundary
    covered = np.zeros(len(table.keys), dtype=np.int64)
    interfaces = set()
    for name, nodes in mesh.surfaces.items():
        at, _ = table.find(facet_keys(nodes[:, :n_corners], len(mesh.points)))
        outward = _same_side(nodes, table.nodes_at(at), n_corners)
        inner = ~on_boundary[at]
        second = np.minimum(at + 1, len(table.keys) - 1)
        outward |= inner & _same_side(nodes, table.nodes_at(second), n_corners)
        if not outward.all():
            raise MeshError(
                f"surface {name!r}: {np.count_nonzero(~outward)} of {len(nodes)} facets are no side of a cell"
                " or look into their cell; build surfaces with thermal.fe.mesh.named_mesh"
            )
        if inner.any() and not inner.all():
            raise MeshError(f"surface {name!r} lies partly on the boundary, partly inside; split it in two")
        if inner.any():
            interfaces.add(name)
        np.add.at(covered, at, 1)
    if (covered > 1).any():
        raise MeshError(f"{np.count_nonzero(covered > 1)} facets belong to two surfaces; assign each once")
    open_facets = table.nodes_at(np.flatnonzero(on_boundary & (covered == 0)))
    if len(open_facets):
        centre = mesh.points[open_facets[0, :n_corners]].mean(axis=0)
        raise MeshError(
            f"{len(open_facets)} boundary facets belong to no surface, one at x, y, z = "
            f"{centre[0]:.6g}, {centre[1]:.6g}, {centre[2]:.6g} m; name them"
        )
    return frozenset(interfaces)


def _same_side(
    nodes: IndexArray, reference: IndexArray, n_corners: int
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether facets have the same nodes as the reference, corners and mid-sides up to a cyclic shift."""
    same = np.zeros(len(nodes), dtype=np.bool_)
    for shift in range(n_corners):
        turn = [(k + shift) % n_corners for k in range(n_corners)]
        order = [*turn, *(n_corners + k for k in turn), *range(2 * n_corners, nodes.shape[1])]
        same |= np.all(nodes == reference[:, order], axis=1)
    return same

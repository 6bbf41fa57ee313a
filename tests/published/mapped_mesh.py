"""Meshes of the benchmarks: the unit box with its nodes moved, its sides named anew."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from thermal.fe.mesh import CellName, FloatArray, NamedMesh, box_mesh

Map = Callable[[FloatArray, FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]


def mapped(divisions: tuple[int, int, int], place: Map, cell: CellName = "hexahedron20") -> NamedMesh:
    """The unit box with every node moved to ``place(x, y, z)``, each (n_nodes,)."""
    mesh = box_mesh((1.0, 1.0, 1.0), divisions, cell=cell)
    return replace(mesh, points=np.column_stack(place(*mesh.points.T)))


def piecewise(at: FloatArray, divisions: Sequence[int], stations: FloatArray) -> FloatArray:
    """Stations (n + 1,) at 0, d1, d1 + d2, ... of all n divisions, linear between; ``at`` from 0 to 1."""
    ends = np.append(0.0, np.cumsum(divisions)) / sum(divisions)
    return np.interp(at, ends, stations)


def split(
    mesh: NamedMesh, surface: str, parts: Mapping[str, Callable[[FloatArray], NDArray[np.bool_]]]
) -> NamedMesh:
    """Divide a surface by the centres (n, 3) of its facets; what no part takes keeps its name."""
    facets = mesh.surfaces[surface]
    centres = mesh.points[facets].mean(axis=1)
    surfaces = {name: nodes for name, nodes in mesh.surfaces.items() if name != surface}
    left = np.ones(len(facets), dtype=bool)
    for name, inside in parts.items():
        mine = inside(centres) & left
        surfaces[name] = facets[mine]
        left &= ~mine
    if left.any():
        surfaces[surface] = facets[left]
    return replace(mesh, surfaces=surfaces)

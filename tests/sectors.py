"""Meshes of the NAFEMS benchmarks: a box whose nodes are moved, its sides named anew."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from thermal.fe.mesh import CellName, NamedMesh, box_mesh

Map = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def mapped(divisions: tuple[int, int, int], place: Map, cell: CellName = "hexahedron20") -> NamedMesh:
    """The unit box with every node moved to ``place(x, y, z)``."""
    mesh = box_mesh((1.0, 1.0, 1.0), divisions, cell=cell)
    return replace(mesh, points=np.column_stack(place(*mesh.points.T)))


def piecewise(at: np.ndarray, divisions: tuple[int, ...], stations: np.ndarray) -> np.ndarray:
    """Stations (n + 1, ...) at 0, d1, d1 + d2, ... of all divisions, linear between; ``at`` from 0 to 1."""
    ends = np.append(0.0, np.cumsum(divisions)) / sum(divisions)
    return np.interp(at, ends, stations)


def split(
    mesh: NamedMesh, surface: str, parts: Mapping[str, Callable[[np.ndarray], np.ndarray]]
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

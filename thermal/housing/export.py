"""A named mesh as a gmsh file (format 2.2, text), which `thermal.housing.mesh_file.read_mesh` gives back as it was.

Physical volumes are the bodies, physical surfaces the surfaces; coordinates have all digits. Format: gmsh reference
manual, "MSH file format version 2".
"""

from collections.abc import Iterator
from itertools import count
from pathlib import Path

import numpy as np

from thermal.fe.mesh import NamedMesh

CELLS = {10: 11, 20: 17, 27: 12}
FACETS = {6: 9, 8: 16, 9: 10}
"""gmsh's number of an element by its number of nodes."""


def write_mesh(mesh: NamedMesh, path: Path) -> None:
    """Write a mesh of ten-node tetrahedra, or of hexahedra of 20 or 27 nodes, in metres.

    Raises OSError where the file cannot be written.
    """
    order = np.argsort(mesh.shape.gmsh_order)
    groups = [(3, name, CELLS, mesh.cells[cells][:, order]) for name, cells in mesh.bodies.items()]
    groups += [(2, name, FACETS, nodes) for name, nodes in mesh.surfaces.items()]
    numbers = count(1)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        names = [f'{dimension} {tag} "{name}"' for tag, (dimension, name, *_) in enumerate(groups, 1)]
        file.writelines(_section("MeshFormat", ["2.2 0 8"]))
        file.writelines(_section("PhysicalNames", [str(len(names)), *names]))
        nodes = [f"{number} {x!r} {y!r} {z!r}" for number, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
        file.writelines(_section("Nodes", [str(len(nodes)), *nodes]))
        elements = [
            f"{next(numbers)} {kinds[rows.shape[1]]} 2 {tag} {tag} {' '.join(map(str, row))}"
            for tag, (_, _, kinds, rows) in enumerate(groups, 1)
            for row in (rows + 1).tolist()
        ]
        file.writelines(_section("Elements", [str(len(elements)), *elements]))


def _section(name: str, lines: list[str]) -> Iterator[str]:
    yield f"${name}\n"
    for line in lines:
        yield line + "\n"
    yield f"$End{name}\n"

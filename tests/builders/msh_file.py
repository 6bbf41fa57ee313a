"""Meshes written as gmsh files, as a user's mesher would."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from thermal.fe.mesh import NamedMesh

KINDS = {10: 11, 20: 17, 27: 12}
FACETS = {6: 9, 8: 16, 9: 10}
"""gmsh's number of cells and facets by their number of nodes."""


def write_msh(
    mesh: NamedMesh,
    file: Path,
    *,
    left_out: Sequence[str] = (),
    renamed: Mapping[str, str] | None = None,
    doubled: Mapping[str, str] | None = None,
) -> Path:
    """Write format 2.2; surfaces ``left_out`` or ``renamed``, and some written a second time under another name."""
    names = dict(renamed or {})
    volumes = [(names.get(name, name), mesh.cells[cells]) for name, cells in mesh.bodies.items()]
    order = np.argsort(mesh.shape.gmsh_order)
    surfaces = [
        (names.get(name, name), nodes) for name, nodes in mesh.surfaces.items() if name not in left_out
    ]
    surfaces += [(other, mesh.surfaces[name]) for name, other in (doubled or {}).items()]
    groups = [(3, name, KINDS[nodes.shape[1]], nodes[:, order]) for name, nodes in volumes]
    groups += [(2, name, FACETS[nodes.shape[1]], nodes) for name, nodes in surfaces]
    tags = {(dim, name): k for k, (dim, name) in enumerate(dict.fromkeys((g[0], g[1]) for g in groups), 1)}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(tags))]
    lines += [f'{dim} {tag} "{name}"' for (dim, name), tag in tags.items()]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(mesh.points))]
    lines += [f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    lines += ["$EndNodes", "$Elements", str(sum(len(g[3]) for g in groups))]
    number = 0
    for entity, (dim, name, kind, nodes) in enumerate(groups, 1):
        for row in (nodes + 1).tolist():
            number += 1
            lines.append(f"{number} {kind} 2 {tags[dim, name]} {entity} {' '.join(map(str, row))}")
    lines += ["$EndElements", ""]
    file.write_text("\n".join(lines))
    return file

"""A user's mesh of a gearbox: gmsh's .msh with physical groups as bodies and surfaces.

Read by gmsh itself, so every version of the format and text and binary files serve. Physical volumes become
bodies, physical surfaces surfaces; everything that has no name or two is listed at once.
"""

from collections.abc import Iterator, Mapping
from itertools import count
from pathlib import Path
from types import ModuleType

import numpy as np
from scipy import sparse

from thermal.fe.gmsh_session import gmsh_session
from thermal.fe.mesh import (
    FloatArray,
    IndexArray,
    MeshError,
    NamedMesh,
    along_curve,
    facet_keys,
    inverse,
    whole_surfaces,
)
from thermal.fe.reference_elements import HEXAHEDRON_20, HEXAHEDRON_27, TETRAHEDRON_10, CellElement

KINDS: dict[int, CellElement] = {11: TETRAHEDRON_10, 17: HEXAHEDRON_20, 12: HEXAHEDRON_27}
"""gmsh's number of a volume element -> the element that is computed with."""

LARGEST = 30.0
"""Size [m] above which a gearbox was drawn in millimetres."""

MOST_LISTED = 6
"""Places that a message lists one by one."""


def read_mesh(path: Path) -> NamedMesh:
    """Read a mesh in metres of ten-node tetrahedra, or of hexahedra of 20 or 27 nodes.

    Raises MeshError naming file, places and remedy for a file that is missing, cut short or no mesh, for cells of
    another or of several kinds, volumes and surfaces without a name or with two, boundary facets in no surface,
    bodies that fall into pieces, and for coordinates that cannot be metres; what gmsh lacks comes as the loader's
    ImportError or OSError.
    """
    _check_whole(path)
    with gmsh_session() as gmsh:
        try:
            gmsh.open(str(path))
        except Exception as error:  # gmsh raises bare Exception
            raise MeshError(f"{path.name}: gmsh cannot read it: {error}; write the mesh again") from error
        return collected_mesh(gmsh, path.name)


def _check_whole(path: Path) -> None:
    """Every section that is opened is closed; gmsh takes what it finds of a file that was cut short."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise MeshError(f"{path}: {error.strerror}; correct the path of the mesh") from error
    for name in ("MeshFormat", "PhysicalNames", "Nodes", "Elements"):
        if not _has_line(content, f"${name}"):
            needed = (
                "name volumes and surfaces as physical groups"
                if name == "PhysicalNames"
                else "write it again"
            )
            raise MeshError(f"{path.name}: no section ${name}; {needed} and save as .msh")
        if not _has_line(content, f"$End{name}"):
            raise MeshError(f"{path.name}: section ${name} has no end, the file is cut short; write it again")


def _has_line(content: bytes, words: str) -> bool:
    """Whether a line consists of ``words``; ten times as fast as a pattern that looks at every line."""
    wanted = words.encode()
    start = content.find(wanted)
    while start >= 0:
        line = content[start - 1 : start] in (b"", b"\n", b"\r")
        rest = content[start + len(wanted) : start + len(wanted) + 1]
        if line and (not rest or rest.isspace()):
            return True
        start = content.find(wanted, start + 1)
    return False


def collected_mesh(gmsh: ModuleType, name: str) -> NamedMesh:
    """The mesh of the current gmsh model, its physical groups as bodies and surfaces; ``name`` of its file.

    Raises MeshError as `read_mesh`.
    """
    shape, kind = _cell_kind(gmsh, name)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int32)
    index[tags.view(np.int64)] = np.arange(len(tags), dtype=np.int32)
    points = np.ascontiguousarray(coordinates.reshape(-1, 3))
    volumes = _named_entities(gmsh, name, 3)
    blocks: list[IndexArray] = []
    bodies: dict[str, IndexArray] = {}
    start = 0
    for body, entities in volumes.items():
        elements = [gmsh.model.mesh.getElementsByType(kind, entity)[1] for entity in entities]
        block = index[np.concatenate(elements).view(np.int64).reshape(-1, shape.n_nodes)]
        blocks.append(block[:, list(shape.gmsh_order)])
        bodies[body] = np.arange(start, start + len(block), dtype=np.int32)
        start += len(block)
    cells = np.concatenate(blocks)
    in_cells = np.zeros(len(points), dtype=np.bool_)
    in_cells[cells] = True
    packed_index = np.where(in_cells, np.cumsum(in_cells) - 1, -1).astype(np.int32)
    cells, points = packed_index[cells], points[in_cells]
    reach = float(np.ptp(points, axis=0).max())
    if reach > LARGEST:
        raise MeshError(f"{name}: the mesh is {reach:.4g} m long, above {LARGEST:g} m; write it in metres")
    if not np.isfinite(reach):
        raise MeshError(f"{name}: a node has a coordinate that is no finite number; write the mesh again")
    numbering = along_curve(points, cells, bodies)
    renumbered = inverse(numbering.nodes)
    cells, points = renumbered[cells[numbering.cells]], points[numbering.nodes]
    packed_index = np.where(in_cells, renumbered[packed_index], -1)
    surfaces = {
        surface: np.concatenate([_facets(gmsh, entity, packed_index[index]) for entity in entities])
        for surface, entities in _named_entities(gmsh, name, 2).items()
    }
    _check_pieces(name, cells[:, : shape.n_corners], bodies, len(points))
    mesh = NamedMesh(points, cells, bodies, {}, numbering)
    _check_boundary(name, mesh, surfaces)
    mesh.surfaces.update(whole_surfaces(mesh, surfaces))
    return mesh


def _cell_kind(gmsh: ModuleType, name: str) -> tuple[CellElement, int]:
    """The one kind of volume element of the file."""
    kinds = [int(kind) for kind in gmsh.model.mesh.getElementTypes(3)]
    if len(kinds) == 1 and kinds[0] in KINDS:
        return KINDS[kinds[0]], kinds[0]
    names = [gmsh.model.mesh.getElementProperties(kind)[0] for kind in kinds]
    raise MeshError(
        f"{name}: volume elements are {' and '.join(names) or 'missing'}; mesh all volumes with one kind of second "
        "order: 10-node tetrahedra, or hexahedra of 20 or 27 nodes (gmsh: Mesh.ElementOrder = 2)"
    )


def _named_entities(gmsh: ModuleType, name: str, dimension: int) -> dict[str, list[int]]:
    """Physical name -> entities of volumes (3) or surfaces (2), each of which may have one name only."""
    kind = {3: "volume", 2: "surface"}[dimension]
    names: dict[int, list[str]] = {}
    unnamed = []
    for _, group in gmsh.model.getPhysicalGroups(dimension):
        label = gmsh.model.getPhysicalName(dimension, group)
        if not label:
            unnamed.append(f"physical {kind} {group}")
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
            names.setdefault(int(entity), []).append(label or str(group))
    if dimension == 3:
        all_volumes = {tag for _, tag in gmsh.model.getEntities(3)}
        unnamed += [f"volume {tag}" for tag in sorted(all_volumes - set(names))]
    doubled = [f"{kind} {tag} ({', '.join(labels)})" for tag, labels in names.items() if len(labels) > 1]
    if unnamed or doubled or not names:
        faults = [f"without a name: {_listed(unnamed)}"] if unnamed else []
        faults += [f"with two names: {_listed(doubled)}"] if doubled else []
        raise MeshError(
            f"{name}: {'; '.join(faults) or f'no physical {kind}s'}; put every {kind} into one physical group "
            "with a name"
        )
    sorted_names = sorted({labels[0] for labels in names.values()})
    return {label: [tag for tag, labels in names.items() if labels[0] == label] for label in sorted_names}


def _facets(gmsh: ModuleType, entity: int, index: IndexArray) -> IndexArray:
    """Corner nodes of the facets of one surface, in packed numbers; triangles and quadrilaterals."""
    corners = []
    kinds, _, nodes = gmsh.model.mesh.getElements(2, entity)
    for kind, node_tags in zip(kinds, nodes):
        _, _, _, count, _, primary = gmsh.model.mesh.getElementProperties(int(kind))
        corners.append(index[node_tags.astype(np.int64).reshape(-1, count)[:, :primary]])
    return np.concatenate(corners) if corners else np.empty((0, 3), dtype=np.int32)


def _check_pieces(name: str, cells: IndexArray, bodies: Mapping[str, IndexArray], n_nodes: int) -> None:
    """No body may fall into pieces that share no nodes: coincident nodes that were not merged.

    cells : (n_cells, n_corners)
    """
    broken = []
    for body, of_body in bodies.items():
        sizes = np.sort(np.bincount(_pieces(cells[of_body], n_nodes)))[::-1]
        if len(sizes) > 1:
            broken.append(
                f"body {body!r} in {len(sizes)} pieces of {_listed([str(size) for size in sizes])} cells"
            )
    if broken:
        raise MeshError(
            f"{name}: {'; '.join(broken)}, which share no nodes; merge coincident nodes (gmsh: Coherence Mesh) or "
            "give each piece a name of its own"
        )


def _pieces(corners: IndexArray, n_nodes: int) -> IndexArray:
    """(n,) number of the connected piece of every cell or facet, from its ``corners`` (n, n_corners).

    A graph of the nodes in which every cell joins its first corner to the others has a few entries a cell; the
    product of cells with cells that share a node has fifty.
    """
    first = np.repeat(corners[:, 0], corners.shape[1] - 1)
    links = (np.ones(len(first), dtype=np.bool_), (first, corners[:, 1:].ravel()))
    _, label = sparse.csgraph.connected_components(
        sparse.coo_array(links, shape=(n_nodes, n_nodes)), directed=False
    )
    _, piece = np.unique(label[corners[:, 0]], return_inverse=True)
    return np.asarray(piece, dtype=np.int32)


def _check_boundary(name: str, mesh: NamedMesh, surfaces: Mapping[str, IndexArray]) -> None:
    """Every boundary facet has one name; those that lack one are listed by connected patch.

    surfaces : name -> (k, >= n_corners) nodes, corners first
    """
    points, table, side = mesh.points, mesh.facets, mesh.shape.side.n_corners
    named = {label: facet_keys(facets[:, :side], len(points)) for label, facets in surfaces.items()}
    rows = {label: table.find(keys) for label, keys in named.items()}
    for label, (index, known) in rows.items():
        if lost := len(index) - np.count_nonzero(known):
            raise MeshError(
                f"{name}: surface {label!r}: {lost} of {len(index)} facets are no side of any cell; mesh surfaces and "
                "volumes together, all of second order"
            )
    everything = np.concatenate(list(named.values()))
    keys, count = np.unique(everything, return_counts=True)
    twice = keys[count > 1]
    if len(twice):
        doubled = [label for label, label_keys in named.items() if np.isin(label_keys, twice).any()]
        raise MeshError(
            f"{name}: {len(twice)} facets lie twice in the surfaces {', '.join(doubled)}; name every face once"
        )
    bare = table.on_boundary
    for index, _ in rows.values():
        bare[index] = False
    if bare.any():
        facets = table.nodes_at(np.flatnonzero(bare))[:, :side]
        raise MeshError(
            f"{name}: {len(facets)} boundary facets have no name: {_listed(_patches(points, facets))}; put their faces "
            "into a physical surface with a name"
        )


def _patches(points: FloatArray, facets: IndexArray) -> list[str]:
    """Connected patches of facets with number and place, largest first."""
    label = _pieces(facets, len(points))
    patches = []
    for patch in np.argsort(-np.bincount(label), kind="stable"):
        members = facets[label == patch]
        x, y, z = points[np.unique(members)].mean(axis=0)
        patches.append(f"{len(members)} about ({x:.4g}, {y:.4g}, {z:.4g}) m")
    return patches


def _listed(items: list[str]) -> str:
    more = len(items) - MOST_LISTED
    return ", ".join(items[:MOST_LISTED]) + (f" and {more} more" if more > 0 else "")


# A named mesh as a gmsh file (format 2.2, text), which `thermal.housing.mesh_file.read_mesh` gives back as it was.
#
# Physical volumes are the bodies, physical surfaces the surfaces; coordinates have all digits. Format: gmsh reference
# manual, "MSH file format version 2".

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

"""Fields for ParaView and the like: all cells of a gearbox in one .vtu, and by name as blocks of a .vtm."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.output_folder import file_stem
from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.results.thermal import TemperatureField
from thermal.fe.mesh import FloatArray, IndexArray, NamedMesh

FACET_NAMES = {6: "triangle6", 8: "quad8", 9: "quad9"}
"""Number of nodes of a side of a cell -> its name in meshio."""


def write_field(field: TemperatureField, path: Path) -> dict[str, Any]:
    """Write temperature [degC], displacement [m], heat flux [W/m2] and body number on the second-order cells.

    ``path`` (.vtu) has all cells; nodes and cells of a mesh file keep the order in which gmsh reads them. The .vtm of
    the same stem has every body and every named surface as a block of that name, in single precision, in files of a
    folder of that stem.

    Returns
    -------
    dict
        The entry of results.json: gearbox, stage, point data names, name of every body by its number in the cell data
        ``body``, names of the surfaces, and the .vtm as ``blocks``.
    """
    import meshio  # noqa: TID251 - the report is the second place that may write mesh files

    mesh = field.mesh
    bodies = list(mesh.bodies)
    body = np.zeros(len(mesh.cells), dtype=np.int32)
    for number, name in enumerate(bodies):
        body[mesh.bodies[name]] = number
    data = point_data = _point_data(field)
    points, cells = mesh.points, mesh.cells
    if mesh.numbering is not None:
        given = mesh.numbering
        points, cells, body = (
            given.given_nodes(points),
            given.nodes[given.given_cells(cells)],
            given.given_cells(body),
        )
        point_data = {name: given.given_nodes(values) for name, values in data.items()}
    document = meshio.Mesh(
        points, [(mesh.shape.name, cells)], point_data=point_data, cell_data={"body": [body]}
    )
    document.write(path, file_format="vtu")
    blocks = path.with_suffix(".vtm")
    _write_blocks(field, data, blocks)
    return {
        "gearbox": field.gearbox,
        "stage": field.stage,
        "point_data": list(point_data),
        "bodies": bodies,
        "surfaces": list(mesh.surfaces),
        "blocks": f"fields/{blocks.name}",
    }


def read_fields(entries: Sequence[Mapping[str, Any]], folder: Path) -> list[TemperatureField]:
    """The fields that results.json lists and whose files stand below ``folder``; damaged ones are left out."""
    from meshio import ReadError  # noqa: TID251 - as above

    found = []
    for entry in entries:
        with suppress(OSError, KeyError, IndexError, ValueError, ReadError):
            found.append(_read_field(entry, folder))
    return found


def _read_field(entry: Mapping[str, Any], folder: Path) -> TemperatureField:
    """A field as `write_field` wrote it; its mesh is numbered as the file.

    Facets of a block are found by the single-precision data of their nodes.
    """
    path = folder / entry["file"]
    whole = _read(path)
    body = whole.cell_data["body"][0]
    nodes = {row.tobytes(): number for number, row in enumerate(_single(whole))}
    surfaces = {}
    for number, name in enumerate(entry["surfaces"], start=1):
        block = _read(path.with_suffix("") / "surfaces" / f"{number:02d}_{file_stem(name)}.vtu")
        own = np.array([nodes[row.tobytes()] for row in _single(block)], dtype=np.int32)
        surfaces[name] = own[block.cells[0].data]
    bodies = {
        name: np.flatnonzero(body == number).astype(np.int32) for number, name in enumerate(entry["bodies"])
    }
    mesh = NamedMesh(whole.points, whole.cells[0].data.astype(np.int32), bodies, surfaces)
    data = whole.point_data
    return TemperatureField(
        gearbox=entry["gearbox"],
        stage=entry["stage"],
        mesh=mesh,
        temperature=data["temperature_degC"] + ZERO_CELSIUS,
        displacement=data["displacement_m"],
        heat_flux=data.get("heat_flux_W_m2"),
    )


def _read(path: Path) -> Any:
    import meshio  # noqa: TID251 - as above

    return meshio.read(path, file_format="vtu")


def _single(mesh: Any) -> NDArray[np.float32]:
    """Coordinates and data of the nodes, one row each, in single precision."""
    columns = [mesh.points, *mesh.point_data.values()]
    return np.column_stack([np.asarray(column, dtype=np.float32) for column in columns])


def _point_data(field: TemperatureField) -> dict[str, FloatArray]:
    """Name with unit -> values at the nodes of the mesh."""
    found = {
        "temperature_degC": field.temperature - ZERO_CELSIUS,
        "displacement_m": field.displacement,
    }
    return found if field.heat_flux is None else {**found, "heat_flux_W_m2": field.heat_flux}


def _write_blocks(field: TemperatureField, data: Mapping[str, FloatArray], path: Path) -> None:
    """A .vtm (VTK XML multi-block) with the groups ``bodies`` and ``surfaces``, their files in a folder next to it."""
    mesh = field.mesh
    groups: dict[str, dict[str, tuple[str, IndexArray]]] = {
        "bodies": {name: (mesh.shape.name, mesh.cells[cells]) for name, cells in mesh.bodies.items()},
        "surfaces": {name: (FACET_NAMES[facets.shape[1]], facets) for name, facets in mesh.surfaces.items()},
    }
    lines = ['<?xml version="1.0"?>', '<VTKFile type="vtkMultiBlockDataSet" version="1.0">']
    lines.append("<vtkMultiBlockDataSet>")
    for number, (group, blocks) in enumerate(groups.items()):
        folder = path.with_suffix("") / group
        folder.mkdir(parents=True)
        lines.append(f'<Block index="{number}" name="{group}">')
        for place, (name, block) in enumerate(blocks.items()):
            file = folder / f"{place + 1:02d}_{file_stem(name)}.vtu"
            _write_block(file, block, mesh.points, data)
            at = quoteattr(file.relative_to(path.parent).as_posix())
            lines.append(f'<DataSet index="{place}" name={quoteattr(name)} file={at}/>')
        lines.append("</Block>")
    lines += ["</vtkMultiBlockDataSet>", "</VTKFile>", ""]
    path.write_text("\n".join(lines), encoding="utf-8", newline="\n")


def _write_block(
    path: Path, block: tuple[str, IndexArray], points: FloatArray, data: Mapping[str, FloatArray]
) -> None:
    """Cells of one kind with the nodes they use."""
    import meshio  # noqa: TID251 - as above

    kind, cells = block
    nodes, local = np.unique(cells, return_inverse=True)
    shown = {name: values[nodes].astype(np.float32) for name, values in data.items()}
    document = meshio.Mesh(
        points[nodes].astype(np.float32),
        [(kind, local.reshape(cells.shape).astype(np.int32))],
        point_data=shown,
    )
    document.write(path, file_format="vtu")

"""Fields as .vtu, for ParaView and the like."""

from pathlib import Path
from typing import Any

import numpy as np

from rigdesign.base.quantity_kinds import ZERO_CELSIUS
from rigdesign.results.thermal import TemperatureField


def write_field(field: TemperatureField, path: Path) -> dict[str, Any]:
    """Write temperature [degC], displacement [m], heat flux [W/m2] and body number on the second-order cells.

    Nodes and cells of a mesh file keep the order in which gmsh reads them.

    Returns
    -------
    dict
        The entry of results.json: gearbox, stage, point and cell data names, body name by number.
    """
    import meshio  # noqa: TID251 - the report is the second place that may write mesh files

    mesh = field.mesh
    bodies = list(mesh.bodies)
    body = np.zeros(len(mesh.cells), dtype=np.int32)
    for number, name in enumerate(bodies):
        body[mesh.bodies[name]] = number
    point_data = {
        "temperature_degC": field.temperature - ZERO_CELSIUS,
        "displacement_m": field.displacement,
    }
    if field.heat_flux is not None:
        point_data["heat_flux_W_m2"] = field.heat_flux
    points, cells = mesh.points, mesh.cells
    if mesh.numbering is not None:
        given = mesh.numbering
        points, cells, body = (
            given.given_nodes(points),
            given.nodes[given.given_cells(cells)],
            given.given_cells(body),
        )
        point_data = {name: given.given_nodes(values) for name, values in point_data.items()}
    document = meshio.Mesh(
        points, [(mesh.shape.name, cells)], point_data=point_data, cell_data={"body": [body]}
    )
    document.write(path, file_format="vtu")
    return {
        "gearbox": field.gearbox,
        "stage": field.stage,
        "point_data": list(point_data),
        "bodies": bodies,
    }

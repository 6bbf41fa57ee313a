"""Fields as .vtu, for ParaView and the like."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from rigdesign.results import TemperatureField

ZERO_CELSIUS = 273.15


def file_stem(*names: str) -> str:
    """A file name made of the names a user gave: anything but letters, digits, dot, dash is an underscore."""
    return "_".join(re.sub(r"[^A-Za-z0-9.-]+", "_", name).strip("._") or "unnamed" for name in names)


def write_field(field: TemperatureField, path: Path) -> dict[str, Any]:
    """Write temperature [degC], displacement [m] and body number on the 10-node tetrahedra.

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
    document = meshio.Mesh(
        mesh.points,
        [("tetra10", mesh.cells)],
        point_data={
            "temperature_degC": field.temperature - ZERO_CELSIUS,
            "displacement_m": field.displacement,
        },
        cell_data={"body": [body]},
    )
    document.write(path, file_format="vtu")
    return {
        "gearbox": field.gearbox,
        "stage": field.stage,
        "point_data": ["temperature_degC", "displacement_m"],
        "bodies": bodies,
    }

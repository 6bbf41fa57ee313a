"""Boxes bent into sectors of hollow cylinders: meshes with closed forms for the tests."""

from dataclasses import replace

import numpy as np

from tests.builders.two_blocks import renamed
from thermal.fe.mesh import CellName, NamedMesh, box_mesh


def cylinder_sector(
    radii: tuple[float, float],
    divisions: tuple[int, int, int],
    name: str,
    angle: float = 0.5 * np.pi,
    length: float = 0.1,
    cell: CellName = "tetra10",
) -> NamedMesh:
    """A sector about the z axis; surfaces ``<name>_inner``, ``_outer``, ``_start``, ``_end``, ``_z_min``, ``_z_max``.

    divisions : in radius, angle and length
    """
    box = box_mesh((radii[1] - radii[0], angle, length), divisions, (radii[0], 0.0, 0.0), name, cell)
    r, phi, z = box.points.T
    points = np.column_stack([r * np.cos(phi), r * np.sin(phi), z])
    called = {"x_min": "inner", "x_max": "outer", "y_min": "start", "y_max": "end"}
    surfaces = {called.get(surface, surface): nodes for surface, nodes in box.surfaces.items()}
    return renamed(replace(box, points=points, surfaces=surfaces), name)

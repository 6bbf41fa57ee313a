"""What a gear mesh sees of its two gears in six degrees of freedom, as rows on the freedoms of the elastic rig.

The forces of a mesh act on the same rows by which its motion is seen, so that its power is theirs and its forces on
both gears balance. Directions: `dynamics.elastic_rig.mesh_rows`. The turns count from the centre line, which the gears
turn as they move: gears that move as one, turned about any axis, show no motion in any row. Friction across the normal
n = +-cos(alpha) t + sin(alpha) e acts where both flanks slide,

    omega_1 rho_1 - omega_2 rho_2 - cos(alpha) e . (v_1 - v_2),

with the turns from the centre line, the path rho_1 + rho_2 = a sin(alpha) being that of its ends. Derived here.
"""

import math

import numpy as np
from numpy.typing import NDArray

from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.mesh_rows import MeshDirections, approach_row, mesh_directions

Array = NDArray[np.float64]

ROWS = (
    "front approach", "front tilt", "pinion turn", "wheel turn", "slide", "back approach", "back tilt",
)  # fmt: skip
"""Rows of `wrench_rows`, in this order."""


def wrench_rows(model: ElasticModel, mesh: str) -> Array:
    """Rows (7, n_full) of a mesh, as named in `ROWS`.

    Approach of the flanks along the transverse line of action, turns included [m]; tilt: what the approach grows by per
    face position z, which counts from the end that comes into mesh last, on spur gears along x [rad]; turns of the
    gears from the centre line in their running directions [rad]; slide of the pinion flank over the wheel's as they
    move along the centre line [m].

    Raises DrivetrainError if there is no such mesh.
    """
    connection, directions = model.rig.mesh(mesh), mesh_directions(model.rig, mesh)
    pinion, wheel = model.rows(connection.pinion), model.rows(connection.wheel)
    moved = _moved(model, mesh, directions)
    line = -(directions.passing @ moved) / sum(directions.radii)
    along, tilted = _face_direction(model, mesh), pinion[3:6] - wheel[3:6]
    tilted[0] = 0.0
    front, back = (
        along * np.cross([1.0, 0.0, 0.0], push) @ tilted for push in (directions.front, directions.back)
    )
    rows = {
        "front approach": approach_row(model, mesh, "front"),
        "front tilt": front,
        "pinion turn": pinion[3] - line,
        "wheel turn": wheel[3] + line,
        "slide": -math.cos(directions.pressure_angle) * (directions.centre_line @ moved),
        "back approach": approach_row(model, mesh, "back"),
        "back tilt": back,
    }
    return np.array([rows[name] for name in ROWS])


def _moved(model: ElasticModel, mesh: str, directions: MeshDirections) -> Array:
    """Motion (3, n_full) of the pinion against the wheel in the middle of the mesh, turns left out [m]."""
    connection = model.rig.mesh(mesh)
    names = (connection.pinion, connection.wheel)
    centres = [model.freedoms.place(name).x for name in names]
    found = np.zeros((3, model.size))
    for sign, name, radius, centre in zip((1.0, -1.0), names, directions.radii, centres):
        rows = model.rows(name)
        arm = sign * radius * directions.centre_line
        arm[0] = 0.5 * sum(centres) - centre
        turned = np.stack([np.zeros(model.size), rows[4], rows[5]])
        found += sign * (rows[:3] + np.cross(turned.T, arm).T)
    return found


def _face_direction(model: ElasticModel, mesh: str) -> float:
    """Face position z per x from the middle of the mesh, 1 or -1: z grows to the end that comes into mesh last."""
    connection = model.rig.mesh(mesh)
    if connection.base_helix_angle == 0.0:
        return 1.0
    sense = model.rig.placement(model.rig.drivetrain.gear(connection.pinion).shaft).sense
    return -math.copysign(1.0, connection.base_helix_angle) * sense

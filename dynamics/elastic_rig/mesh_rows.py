"""Gear meshes in six degrees of freedom: directions of their flanks and rows of the approach.

e points from the pinion to the wheel; t = sense x_axis x e is where the teeth of the pinion pass the mesh. The front
flanks of the pinion drive the wheel along n = cos(alpha) t + sin(alpha) e, the back flanks along -cos(alpha) t +
sin(alpha) e, alpha the working transverse pressure angle. A helical flank presses along x as well: a right-hand pinion
that turns about +x presses the wheel with its front flanks towards -x. Approach along the transverse line of action:

    x = r_b1 turn_1 - r_b2 turn_2 + d . (u_1 + theta_1 x r_1 - u_2 - theta_2 x r_2),    d = (-hand tan(beta_b), n)

with r_i from the centre of the gear to the contact, and theta_i the tilt about y and z.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.layout import ElasticRig

Array = NDArray[np.float64]
Face = Literal["front", "back"]


@dataclass(frozen=True, kw_only=True)
class MeshDirections:
    """Unit vectors (3,) in (x, y, z): centre line from pinion to wheel, passing direction of the pinion's teeth.

    pressure_angle : working, transverse [rad]; front, back : d of the flanks, its part across x a unit vector
    radii : pitch radii of pinion and wheel at the centre distance [m]
    """

    centre_line: Array
    passing: Array
    pressure_angle: float
    front: Array
    back: Array
    radii: tuple[float, float]


def mesh_directions(rig: ElasticRig, mesh: str, half: Literal[1, -1] = 1) -> MeshDirections:
    """Directions of a mesh.

    half : -1 for the half of a double-helical mesh towards the rear, of the hand opposite to the one stated.

    Raises DrivetrainError if there is no such mesh.
    """
    connection = rig.mesh(mesh)
    pinion, wheel = (
        rig.placement(rig.drivetrain.gear(name).shaft) for name in (connection.pinion, connection.wheel)
    )
    across = np.array([0.0, wheel.y - pinion.y, wheel.z - pinion.z])
    distance = float(np.linalg.norm(across))
    line = across / distance
    passing = pinion.sense * np.cross([1.0, 0.0, 0.0], line)
    angle = math.acos(sum(connection.base_radii) / distance)
    thrust = np.array([-half * pinion.sense * math.tan(connection.base_helix_angle), 0.0, 0.0])
    drive, apart = math.cos(angle) * passing, math.sin(angle) * line
    share = connection.teeth[0] / sum(connection.teeth)
    return MeshDirections(
        centre_line=line,
        passing=passing,
        pressure_angle=angle,
        front=drive + apart + thrust,
        back=-drive + apart - thrust,
        radii=(share * distance, (1.0 - share) * distance),
    )


def mesh_ports(
    model: ElasticModel,
    mesh: str,
    face: Face = "front",
    position: float = 0.0,
    half: Literal[1, -1] = 1,
) -> Array:
    """Turns (2, n) of pinion and wheel as their mesh sees them: r_b1 p_1 - r_b2 p_2 is the approach on the front.

    face : of the pinion; on the back the approach of the flanks is -(r_b1 p_1 - r_b2 p_2)
    position : of the contact along x from the middle between the gear centres [m]; across x it is the pitch point
    """
    connection = model.rig.mesh(mesh)
    directions = mesh_directions(model.rig, mesh, half)
    push, side = (directions.front, 1.0) if face == "front" else (directions.back, -1.0)
    names = (connection.pinion, connection.wheel)
    centres = [model.freedoms.place(name).x for name in names]
    contact = 0.5 * sum(centres) + position
    ports = []
    for i, sign in enumerate((1.0, -1.0)):
        rows = model.rows(names[i])
        arm = sign * directions.radii[i] * directions.centre_line
        arm[0] = contact - centres[i]
        tilt = np.cross(arm, push)
        motion = push @ rows[:3] + tilt[1] * rows[4] + tilt[2] * rows[5]
        ports.append(rows[3] + side * motion / connection.base_radii[i])
    return np.array(ports)


def approach_row(
    model: ElasticModel,
    mesh: str,
    face: Face = "front",
    position: float = 0.0,
    half: Literal[1, -1] = 1,
) -> Array:
    """(n,) approach of the flanks along the transverse line of action [m]; see `mesh_ports`."""
    first, second = model.rig.mesh(mesh).base_radii
    ports = mesh_ports(model, mesh, face, position, half)
    side = 1.0 if face == "front" else -1.0
    return np.asarray(side * (first * ports[0] - second * ports[1]))

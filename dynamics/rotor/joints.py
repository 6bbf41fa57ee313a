"""Joints of the rig: springs and dampers between two places, in up to six directions, each with its rows.

A joint of finite length acts at the middle between its ends, so that a rigid motion of both parts stretches nothing.
Couplings and gear seats turn with their shaft, and so do their lateral dampers.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.freedoms import Freedoms, Place
from dynamics.rotor.parts import Coupling, End, GearBody, JointStiffness, MeshConnection, Motor
from dynamics.rotor.rotor_model import SEAT_DIRECTIONS, AxialLocation, AxialMeshSpring, ElasticRig
from dynamics.rotor.shaft import DrivetrainError

Array = NDArray[np.float64]
JointKind = Literal["coupling", "spline", "motor", "axial location", "axial mesh spring", "housing"]
_ROW = {"u_x": 0, "u_y": 1, "u_z": 2, "turn": 3, "theta_y": 4, "theta_z": 5}


@dataclass(frozen=True, kw_only=True)
class ElasticJoint:
    """Force -(k w + c w') on the relative motion w = rows q.

    directions : of its k rows; rows : (k, n) motion of the first place against the second; stiffness, damping : (k, k)
    [N/m], [N m/rad] and likewise; turning : its dampers turn with the shaft
    """

    name: str
    kind: JointKind
    directions: tuple[str, ...]
    rows: Array
    stiffness: Array
    damping: Array
    turning: bool = False

    def row(self, direction: str) -> Array:
        """(n,) relative motion in one direction; raises DrivetrainError if the joint is free in it."""
        if direction not in self.directions:
            raise DrivetrainError(
                f"{self.kind} {self.name!r} resists {', '.join(self.directions)}, not {direction}; give it a stiffness"
            )
        return np.asarray(self.rows[self.directions.index(direction)])

    def load(self, direction: str) -> Array:
        """(n,) load per unit of a built-in offset in one direction (twist of a bracing, misaligned axes) [N/m, N]."""
        self.row(direction)
        load: Array = self.stiffness[self.directions.index(direction)] @ self.rows
        return load


def all_joints(rig: ElasticRig, freedoms: Freedoms) -> tuple[ElasticJoint, ...]:
    """Every joint of a rig; those without stiffness and damping in a direction have no row for it."""
    return tuple(_joints(rig, freedoms))


def _joints(rig: ElasticRig, freedoms: Freedoms) -> Iterator[ElasticJoint]:
    drivetrain = rig.drivetrain
    for gear in drivetrain.gears:
        yield _spline(gear, freedoms)
    for coupling in drivetrain.couplings:
        yield _coupling(coupling, rig, freedoms)
    if drivetrain.motor.stiffness is not None:
        yield _motor(drivetrain.motor, freedoms)
    for location in rig.axial_locations:
        yield _location(location, freedoms)
    for spring in rig.axial_mesh_springs:
        yield _mesh_spring(spring, rig, freedoms)
    for support in rig.supports:
        index = np.concatenate([freedoms.seats[bearing] for bearing in support.bearings])
        damping = np.zeros_like(support.stiffness) if support.damping is None else support.damping
        yield ElasticJoint(
            name=support.name,
            kind="housing",
            directions=tuple(
                f"{bearing} {direction}"
                for bearing in support.bearings
                for direction in SEAT_DIRECTIONS[: support.directions]
            ),
            rows=np.eye(freedoms.size)[index],
            stiffness=np.asarray(0.5 * (support.stiffness + support.stiffness.T)),
            damping=damping,
        )


def _spline(gear: GearBody, freedoms: Freedoms) -> ElasticJoint:
    centre = freedoms.place(gear.name)
    station = freedoms.on_shaft(gear.shaft, gear.position)
    seat = gear.seat
    if seat is not None and not (seat.lateral > 0.0 and seat.angular > 0.0):
        raise DrivetrainError(
            f"gear body {gear.name!r}: its seat resists lateral motion with {seat.lateral} N/m and tilting with "
            f"{seat.angular} N m/rad: must be above 0; give both, or no seat for a gear that is rigid with the shaft"
        )
    return _between(
        (centre, station.moved(centre.x - station.x)),
        freedoms.size,
        (gear.name, "spline"),
        (gear.stiffness, gear.damping, seat or JointStiffness()),
    )


def _coupling(coupling: Coupling, rig: ElasticRig, freedoms: Freedoms) -> ElasticJoint:
    a, b = (_end(name, end, rig, freedoms) for name, end in zip(coupling.shafts, coupling.ends))
    middle = 0.5 * (a.x + b.x)
    return _between(
        (a.moved(middle - a.x), b.moved(middle - b.x)),
        freedoms.size,
        (coupling.name, "coupling"),
        (coupling.stiffness, coupling.damping, coupling.flexibility),
    )


def _end(shaft: str, end: End, rig: ElasticRig, freedoms: Freedoms) -> Place:
    return freedoms.on_shaft(shaft, 0.0 if end == "left" else rig.drivetrain.shaft(shaft).length)


def _motor(motor: Motor, freedoms: Freedoms) -> ElasticJoint:
    assert motor.stiffness is not None
    places = freedoms.place("motor"), freedoms.on_shaft(motor.shaft, motor.position)
    return _between(
        places, freedoms.size, ("motor", "motor"), (motor.stiffness, motor.damping, JointStiffness())
    )


def _between(
    places: tuple[Place, Place],
    size: int,
    label: tuple[str, JointKind],
    values: tuple[float, float, JointStiffness],
) -> ElasticJoint:
    """Joint that turns with the shaft, from its torsional stiffness and damping and what it resists besides."""
    torsion, torsional_damping, rest = values
    stiffness = np.array([rest.axial, rest.lateral, rest.lateral, torsion, rest.angular, rest.angular])
    lateral, angular = rest.lateral_damping, rest.angular_damping
    damping = np.array([rest.axial_damping, lateral, lateral, torsional_damping, angular, angular])
    keep = np.flatnonzero((stiffness > 0.0) | (damping > 0.0))
    return ElasticJoint(
        name=label[0],
        kind=label[1],
        directions=tuple(direction for direction, i in _ROW.items() if i in keep),
        rows=(places[0].rows(size) - places[1].rows(size))[keep],
        stiffness=np.diag(stiffness[keep]),
        damping=np.diag(damping[keep]),
        turning=True,
    )


def _location(location: AxialLocation, freedoms: Freedoms) -> ElasticJoint:
    row = port_rows(location.bearing, freedoms)[SEAT_DIRECTIONS.index("u_x")]
    return _axial(location.bearing, "axial location", row, (location.stiffness, location.damping))


def _mesh_spring(spring: AxialMeshSpring, rig: ElasticRig, freedoms: Freedoms) -> ElasticJoint:
    row = axial_motion(rig.mesh(spring.mesh), rig, freedoms)
    return _axial(spring.mesh, "axial mesh spring", row, (spring.stiffness, spring.damping))


def _axial(name: str, kind: JointKind, row: Array, values: Sequence[float]) -> ElasticJoint:
    return ElasticJoint(
        name=name,
        kind=kind,
        directions=("u_x",),
        rows=row[None, :],
        stiffness=np.array([[values[0]]]),
        damping=np.array([[values[1]]]),
    )


def port_rows(bearing: str, freedoms: Freedoms) -> Array:
    """(5, n) motion of a journal against its seat in the order of `SEAT_DIRECTIONS`."""
    rows = freedoms.place(bearing).rows(freedoms.size)[[_ROW[name] for name in SEAT_DIRECTIONS]]
    if bearing in freedoms.seats:
        seat = freedoms.seats[bearing]
        rows[np.arange(seat.size), seat] -= 1.0
    return rows


def axial_motion(mesh: MeshConnection, rig: ElasticRig, freedoms: Freedoms) -> Array:
    """(n,) motion along x of the pinion against the wheel at their pitch point: u_x + theta_y z - theta_z y."""
    a, b = freedoms.place(mesh.pinion), freedoms.place(mesh.wheel)
    one, two = rig.placement(a.shaft), rig.placement(b.shaft)
    across = np.array([two.y - one.y, two.z - one.z])
    share = mesh.teeth[0] / sum(mesh.teeth)
    motion = np.zeros(freedoms.size)
    for place, sign, radius in ((a, 1.0, share * across), (b, -1.0, -(1.0 - share) * across)):
        rows = place.rows(freedoms.size)
        motion += sign * (rows[0] + radius[1] * rows[4] - radius[0] * rows[5])
    return motion

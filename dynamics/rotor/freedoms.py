"""Numbering of the freedoms: nodes of the shafts, bodies with freedoms of their own, seats of the housing.

A *place* is where something of a shaft moves: rows (6, n) in the order of `DIRECTIONS` give its motion from all
freedoms. The rotation about x is ``turn``, positive in the running direction of its shaft.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.beam import DIRECTIONS
from dynamics.rotor.parts import (
    BearingPlace,
    Coupling,
    DragPlace,
    End,
    GearBody,
    JointStiffness,
    MeshConnection,
    Motor,
)
from dynamics.rotor.rotor_model import (
    SEAT_DIRECTIONS,
    AxialLocation,
    AxialMeshSpring,
    ElasticRig,
    ProbeStation,
    ShaftUnbalance,
)
from dynamics.rotor.shaft import DrivetrainError, discretise

Array = NDArray[np.float64]


Index = NDArray[np.int64]
OnShaft = GearBody | BearingPlace | DragPlace | ProbeStation

FAMILIES = ("torsion", "axial", "lateral", "housing")
_FAMILY_OF = {"turn": 0, "u_x": 1, "u_y": 2, "u_z": 2, "theta_y": 2, "theta_z": 2}


@dataclass(frozen=True)
class Place:
    """A point rigid with six freedoms: ``base`` of the first of them, ``turn`` if that is elsewhere, x [m].

    arm : of the point beyond the node, along +x [m]
    """

    shaft: str
    base: int
    turn: int
    x: float
    arm: float = 0.0

    @property
    def freedoms(self) -> Index:
        """(6,) freedoms it moves with."""
        index = np.arange(self.base, self.base + 6)
        index[3] = self.turn
        return index

    @property
    def transform(self) -> Array:
        """(6, 6) motion of the point from its freedoms: u = u_node + theta x arm."""
        matrix = np.eye(6)
        matrix[1, 5], matrix[2, 4] = self.arm, -self.arm
        return matrix

    def moved(self, arm: float) -> "Place":
        """The same body at a point further along +x [m]."""
        return Place(self.shaft, self.base, self.turn, self.x + arm, self.arm + arm)

    def rows(self, size: int) -> Array:
        """(6, size) motion of the point."""
        rows = np.zeros((6, size))
        rows[:, self.freedoms] = self.transform
        return rows


@dataclass(frozen=True)
class ShaftNodes:
    """Nodes of a shaft: positions on it and x [m], both (n,); ``first`` freedom."""

    positions: Array
    x: Array
    first: int

    def base(self, position: float) -> int:
        """First freedom of the node at a position that has one."""
        return self.first + 6 * int(np.argmin(np.abs(self.positions - position)))


@dataclass
class Freedoms:
    """All freedoms of a rig.

    names : of each; shaft_of : index of its shaft, -1 for a seat of the housing; family : index into `FAMILIES`
    nodes : of every shaft; places : of gears, bearings, drag places, stations, ``motor`` and ``shaft/disc``
    seats : freedoms of the seat of a bearing, in the order of `SEAT_DIRECTIONS`
    """

    names: list[str] = field(default_factory=list)
    shaft_of: list[int] = field(default_factory=list)
    family: list[int] = field(default_factory=list)
    nodes: dict[str, ShaftNodes] = field(default_factory=dict)
    places: dict[str, Place] = field(default_factory=dict)
    seats: dict[str, Index] = field(default_factory=dict)
    _shafts: list[str] = field(default_factory=list)

    @property
    def size(self) -> int:
        """Number of freedoms."""
        return len(self.names)

    def place(self, name: str) -> Place:
        """Place by its name; raises DrivetrainError if there is none."""
        if name not in self.places:
            raise DrivetrainError(
                f"place {name!r} does not exist: it must be a gear, bearing, drag place, station, 'motor' or "
                "'shaft/disc'; correct the name or add a station"
            )
        return self.places[name]

    def on_shaft(self, shaft: str, position: float) -> Place:
        """Place of a shaft at a position [m] that has a node."""
        nodes = self.nodes[shaft]
        base = nodes.base(position)
        return Place(shaft, base, base + 3, float(nodes.x[(base - nodes.first) // 6]))

    def _add(self, body: str, shaft: str, directions: tuple[str, ...] = DIRECTIONS) -> int:
        first = self.size
        self.names.extend(f"{body} {direction}" for direction in directions)
        self.shaft_of.extend([self._shafts.index(shaft)] * len(directions))
        self.family.extend(_FAMILY_OF[direction] for direction in directions)
        return first


def number_freedoms(rig: ElasticRig) -> Freedoms:
    """Freedoms of a rig: shafts in the order given, gears, a motor rotor on a joint of its own, seats."""
    drivetrain = rig.drivetrain
    freedoms = Freedoms(_shafts=[shaft.name for shaft in drivetrain.shafts])
    for shaft in drivetrain.shafts:
        positions = discretise(shaft, _stations(rig, shaft.name)).positions
        first = freedoms.size
        for position in positions:
            freedoms._add(f"{shaft.name}/{position * 1e3:.2f} mm", shaft.name)
        x = np.array([rig.x(shaft.name, float(position)) for position in positions])
        freedoms.nodes[shaft.name] = ShaftNodes(positions, x, first)
        for disc in shaft.discs:
            freedoms.places[f"{shaft.name}/{disc.name}"] = freedoms.on_shaft(shaft.name, disc.position)
    parts: tuple[OnShaft, ...] = (*drivetrain.bearings, *drivetrain.drag_places, *rig.stations)
    for part in parts:
        freedoms.places[part.name] = freedoms.on_shaft(part.shaft, part.position)
    for gear in drivetrain.gears:
        freedoms.places[gear.name] = _add_gear(freedoms, rig, gear)
    _add_motor(freedoms, rig)
    for support in rig.supports:
        for bearing in support.bearings:
            first, directions = freedoms.size, SEAT_DIRECTIONS[: support.directions]
            freedoms.names.extend(f"{bearing} seat {direction}" for direction in directions)
            freedoms.shaft_of.extend([-1] * len(directions))
            freedoms.family.extend([3] * len(directions))
            freedoms.seats[bearing] = np.arange(first, first + len(directions))
    return freedoms


def _add_gear(freedoms: Freedoms, rig: ElasticRig, gear: GearBody) -> Place:
    """Centre of a gear: with a turn of its own behind the spline, and all six behind an elastic seat."""
    station = freedoms.on_shaft(gear.shaft, gear.position)
    arm = rig.placement(gear.shaft).direction * gear.offset
    body = f"{gear.shaft}/{gear.name}"
    if gear.seat is None:
        turn = freedoms._add(body, gear.shaft, ("turn",))
        return Place(gear.shaft, station.base, turn, station.x + arm, arm)
    base = freedoms._add(body, gear.shaft)
    return Place(gear.shaft, base, base + 3, station.x + arm)


def _add_motor(freedoms: Freedoms, rig: ElasticRig) -> None:
    motor = rig.drivetrain.motor
    station = freedoms.on_shaft(motor.shaft, motor.position)
    if motor.stiffness is not None:
        turn = freedoms._add(f"{motor.shaft}/motor", motor.shaft, ("turn",))
        station = Place(motor.shaft, station.base, turn, station.x)
    freedoms.places["motor"] = station


def _stations(rig: ElasticRig, shaft: str) -> tuple[float, ...]:
    drivetrain = rig.drivetrain
    parts: tuple[OnShaft, ...] = (
        *drivetrain.gears,
        *drivetrain.bearings,
        *drivetrain.drag_places,
        *rig.stations,
    )
    inside = [part.position for part in parts if part.shaft == shaft]
    inside += [p.position for p in rig.rotating if isinstance(p, ShaftUnbalance) and p.shaft == shaft]
    return (*inside, *([drivetrain.motor.position] if drivetrain.motor.shaft == shaft else []))


# Joints of the rig: springs and dampers between two places, in up to six directions, each with its rows.
#
# A joint of finite length acts at the middle between its ends, so that a rigid motion of both parts stretches nothing.
# Couplings and gear seats turn with their shaft, and so do their lateral dampers.

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
        yield _motor(drivetrain.motor, drivetrain.motor.stiffness, freedoms)
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


def _motor(motor: Motor, stiffness: float, freedoms: Freedoms) -> ElasticJoint:
    places = freedoms.place("motor"), freedoms.on_shaft(motor.shaft, motor.position)
    return _between(places, freedoms.size, ("motor", "motor"), (stiffness, motor.damping, JointStiffness()))


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
    pinion, wheel = rig.placement(a.shaft), rig.placement(b.shaft)
    across = np.array([wheel.y - pinion.y, wheel.z - pinion.z])
    share = mesh.teeth[0] / sum(mesh.teeth)
    motion = np.zeros(freedoms.size)
    for place, sign, radius in ((a, 1.0, share * across), (b, -1.0, -(1.0 - share) * across)):
        rows = place.rows(freedoms.size)
        motion += sign * (rows[0] + radius[1] * rows[4] - radius[0] * rows[5])
    return motion

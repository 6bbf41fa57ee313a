"""Numbering of the freedoms: nodes of the shafts, bodies with freedoms of their own, seats of the housing.

A *place* is where something of a shaft moves: rows (6, n) in the order of `DIRECTIONS` give its motion from all
freedoms. The rotation about x is ``turn``, positive in the running direction of its shaft.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.beam import DIRECTIONS
from dynamics.rotor.parts import BearingPlace, DragPlace, GearBody
from dynamics.rotor.rotor_model import SEAT_DIRECTIONS, ElasticRig, ProbeStation, ShaftUnbalance
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

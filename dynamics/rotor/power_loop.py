"""Can the power loops of a drivetrain close, and how fast does each shaft line turn?

Lines are nodes, meshes are edges of a graph. Round any loop the product of the speed ratios must be one, the
directions of rotation must alternate (external gears), and the parallel axes must be able to stand at the
given centre distances.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import Protocol

from dynamics.rotor.parts import GearBody, MeshConnection, Motor
from dynamics.rotor.shaft import DrivetrainError

RADIUS_TOLERANCE = 1e-6
"""Allowed relative difference between the ratio of base radii and that of tooth numbers [-]."""
DISTANCE_TOLERANCE = 1e-6
"""Allowed difference of the centre distances of meshes between the same two lines [m]."""

Edge = tuple[int, int, MeshConnection]


class PowerCircuit(Protocol):
    """What of a drivetrain decides whether its loops close."""

    @property
    def meshes(self) -> tuple[MeshConnection, ...]:
        """Every mesh."""

    @property
    def motor(self) -> Motor:
        """The motor, on whose shaft the walk begins."""

    def lines(self) -> dict[str, int]:
        """Line of every shaft: those that couplings join turn as one."""

    def gear(self, name: str) -> GearBody:
        """A gear by name."""


def speed_ratios(circuit: PowerCircuit) -> dict[str, float]:
    """Speed of every shaft relative to the motor's shaft, each positive in its own running direction.

    Raises DrivetrainError if a line is not driven at all.
    """
    lines = circuit.lines()
    ratios = _spread(circuit)[0]
    start = lines[circuit.motor.shaft]
    return {name: float(ratios[line] / ratios[start]) for name, line in lines.items()}


def check_loops(circuit: PowerCircuit) -> None:
    """Raise DrivetrainError, naming mesh, value, limit and remedy, when a loop cannot close."""
    for mesh in circuit.meshes:
        _check_mesh(mesh)
    ratios, directions = _spread(circuit)
    distances: dict[frozenset[int], tuple[str, float]] = {}
    for a, b, mesh in _edges(circuit):
        here = ratios[b] / ratios[a]
        asked = Fraction(mesh.teeth[0], mesh.teeth[1])
        if here != asked:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: loop cannot turn: teeth {mesh.teeth[0]}/{mesh.teeth[1]} give the wheel "
                f"{float(asked):.9g} of the pinion's speed, the rest of the loop {float(here):.9g}, "
                "so the product of the ratios round the loop is "
                f"{float(asked / here):.9g} and not 1; change tooth numbers so that it is 1"
            )
        if directions[a] == directions[b]:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: the loop locks: it holds an odd number of external meshes, so pinion "
                "and wheel would turn the same way; add or remove an idler"
            )
        known = distances.setdefault(frozenset((a, b)), (mesh.name, mesh.centre_distance))
        if abs(known[1] - mesh.centre_distance) > DISTANCE_TOLERANCE:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: centre distance = {mesh.centre_distance:.6g} m: {known[0]!r} holds "
                f"the same two lines at {known[1]:.6g} m, the shafts cannot be parallel; make the two equal"
            )
    _check_polygons(circuit, {pair: distance for pair, (_, distance) in distances.items()})


def _check_mesh(mesh: MeshConnection) -> None:
    r_1, r_2 = mesh.base_radii
    z_1, z_2 = mesh.teeth
    if min(r_1, r_2) <= 0.0 or min(z_1, z_2) < 1:
        raise DrivetrainError(
            f"mesh {mesh.name!r}: base radii {mesh.base_radii} m and teeth {mesh.teeth}: must be above 0; "
            "correct them"
        )
    if mesh.pinion == mesh.wheel:
        raise DrivetrainError(
            f"mesh {mesh.name!r}: pinion and wheel are both {mesh.pinion!r}; name two gears"
        )
    if abs(r_2 * z_1 / (r_1 * z_2) - 1.0) > RADIUS_TOLERANCE:
        raise DrivetrainError(
            f"mesh {mesh.name!r}: ratio of base radii = {r_2 / r_1:.9g}: must equal the ratio of teeth "
            f"{z_2}/{z_1} = {z_2 / z_1:.9g}; correct radii or teeth"
        )
    if not mesh.centre_distance > r_1 + r_2:
        raise DrivetrainError(
            f"mesh {mesh.name!r}: centre distance = {mesh.centre_distance:.6g} m: must exceed the sum of the "
            f"base radii {r_1 + r_2:.6g} m; correct centre distance or gears"
        )


def _edges(circuit: PowerCircuit) -> Iterator[Edge]:
    lines = circuit.lines()
    for mesh in circuit.meshes:
        a, b = (lines[circuit.gear(name).shaft] for name in (mesh.pinion, mesh.wheel))
        if a == b:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: pinion and wheel sit on the same shaft line and cannot turn; "
                "put them on different lines or open a coupling"
            )
        yield a, b, mesh


def _spread(circuit: PowerCircuit) -> tuple[dict[int, Fraction], dict[int, int]]:
    """Relative speed and direction of every line, walking through the meshes from the motor."""
    edges = list(_edges(circuit))
    lines = circuit.lines()
    start = lines[circuit.motor.shaft]
    ratios, directions = {start: Fraction(1)}, {start: 1}
    waiting = [start]
    while waiting:
        line = waiting.pop(0)
        for a, b, mesh in edges:
            other, factor = (b, Fraction(mesh.teeth[0], mesh.teeth[1])) if line == a else (a, None)
            if line == b:
                factor = Fraction(mesh.teeth[1], mesh.teeth[0])
            if factor is None or other in ratios:
                continue
            ratios[other], directions[other] = ratios[line] * factor, -directions[line]
            waiting.append(other)
    loose = [name for name, line in lines.items() if line not in ratios]
    if loose:
        raise DrivetrainError(
            f"shaft {loose[0]!r} is not connected to the motor's shaft {circuit.motor.shaft!r} by "
            "couplings or meshes; add the missing joint or leave the shaft out"
        )
    return ratios, directions


def _check_polygons(circuit: PowerCircuit, distances: dict[frozenset[int], float]) -> None:
    """Each direct distance may not exceed the shortest way round: else the axes cannot stand there."""
    names = {line: shaft for shaft, line in reversed(circuit.lines().items())}
    for pair, direct in distances.items():
        start, goal = sorted(pair)
        around = _shortest_way(start, goal, {p: d for p, d in distances.items() if p != pair})
        if direct > around + DISTANCE_TOLERANCE:
            raise DrivetrainError(
                f"centre distance between {names[start]!r} and {names[goal]!r} = {direct:.6g} m: the way "
                f"round the loop is only {around:.6g} m long, it cannot close; shorten this or lengthen the others"
            )


def _shortest_way(start: int, goal: int, distances: dict[frozenset[int], float]) -> float:
    reach = {start: 0.0}
    for _ in range(len(distances) + 1):
        for pair, distance in distances.items():
            a, b = sorted(pair)
            for here, there in ((a, b), (b, a)):
                if here in reach:
                    reach[there] = min(reach.get(there, float("inf")), reach[here] + distance)
    return reach.get(goal, float("inf"))

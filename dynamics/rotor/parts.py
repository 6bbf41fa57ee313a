"""Parts of a drivetrain: gear bodies, couplings, bearings, meshes, motor."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.shaft import DrivetrainError, tilting_inertia

# Loads that alternate with the rotation of a shaft: ripple of a motor, couplings out of line, unbalance, bow, run-out.
#
# One that turns with its shaft across the axis, a force or a moment, is two of them on one freedom each: its cosine and
# its sine (`rotating_load`).

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

WHOLE = 1e-6
"""How far an order may be from a whole number of waves per period."""


@dataclass(frozen=True, kw_only=True)
class LoadOrder:
    """amplitude speed^speed_power cos(order angle - phase): order per turn of its shaft, phase [rad].

    amplitude : [N m] or what the unit of its load row asks for; of speed_power 2 times [s2/rad2], as that of an
        unbalance, with the speed of the shaft [rad/s]

    The angle is that of the uniform rotation, zero where the pinion of the first mesh passes zero.

    Raises DynamicsInputError for an order that is not above 0.
    """

    order: float
    amplitude: float
    phase: float = 0.0
    speed_power: Literal[0, 2] = 0

    def __post_init__(self) -> None:
        if not self.order > 0.0:
            raise DynamicsInputError(
                f"order = {self.order} of a periodic load must be above 0; a mean load is none"
            )

    def at_speed(self, speed: float) -> float:
        """Amplitude at a speed of its shaft [rad/s]."""
        return self.amplitude * speed**self.speed_power


@dataclass(frozen=True, kw_only=True)
class PeriodicLoad:
    """All orders that act through one row of load.

    load : (n,) load on each freedom per unit; dof : freedom whose angle and speed count
    """

    name: str
    load: Array
    dof: int
    parts: tuple[LoadOrder, ...]

    def at(self, angle: Array, speed: float | Array = 1.0) -> Array:
        """Value over the angle of the shaft (n,) [rad] at its speed [rad/s], one or (n,) -> (n,).

        The speed may be left out where no amplitude depends on it.
        """
        waves = (
            part.amplitude * speed**part.speed_power * np.cos(part.order * angle - part.phase)
            for part in self.parts
        )
        return np.asarray(sum(waves, np.zeros_like(angle)))


def rotating_load(name: str, load: Complex, dof: int, part: LoadOrder) -> tuple[PeriodicLoad, PeriodicLoad]:
    """Cosine and sine of a load (n,) complex: Re(load exp(i (order angle - phase))) times the amplitude of ``part``."""
    sine = LoadOrder(
        order=part.order,
        amplitude=part.amplitude,
        phase=part.phase + 0.5 * math.pi,
        speed_power=part.speed_power,
    )
    return (
        PeriodicLoad(name=name, load=np.real(load).copy(), dof=dof, parts=(part,)),
        PeriodicLoad(name=name, load=-np.imag(load), dof=dof, parts=(sine,)),
    )


def waves_within(order: float, ratio: float, turns: float) -> int | None:
    """Waves of an order in ``turns`` of the reference, whose shaft turns ``ratio`` times as fast; None if no whole
    number: a response of that period cannot hold them."""
    waves = order * abs(ratio) * turns
    return round(waves) if abs(waves - round(waves)) < WHOLE * max(waves, 1.0) else None


def within_period(loads: Sequence[PeriodicLoad], ratios: Array, turns: float) -> list[PeriodicLoad]:
    """The same loads with the orders alone that a period of so many turns of the reference holds."""
    return [
        PeriodicLoad(
            name=of_part.name,
            load=of_part.load,
            dof=of_part.dof,
            parts=tuple(p for p in of_part.parts if waves_within(p.order, float(ratios[of_part.dof]), turns)),
        )
        for of_part in loads
    ]


def harmonic_loads(
    loads: Sequence[PeriodicLoad], ratios: Array, turns: float, speed: float = 1.0
) -> dict[int, Complex]:
    """Complex load on all freedoms (n,) by harmonic of a period: the load is Re(value exp(i harmonic w t)).

    ratios : (n,) speed of each freedom per speed of the reference; turns : of the reference in the period; speed : of
    the reference [rad/s]. What does not fit the period is left out.
    """
    by_harmonic: dict[int, Complex] = {}
    for of_part in loads:
        ratio = float(ratios[of_part.dof])
        for part in of_part.parts:
            harmonic = waves_within(part.order, ratio, turns)
            if harmonic:
                value = part.at_speed(ratio * speed) * np.exp(-1j * part.phase) * of_part.load
                by_harmonic[harmonic] = by_harmonic.get(harmonic, 0.0) + value
    return by_harmonic


def left_out(loads: Sequence[PeriodicLoad], ratios: Array, turns: float) -> list[str]:
    """Names and orders that a period of so many turns of the reference cannot hold, each once."""
    missing = (
        f"{of_part.name} order {part.order:g}"
        for of_part in loads
        for part in of_part.parts
        if waves_within(part.order, float(ratios[of_part.dof]), turns) is None
    )
    return list(dict.fromkeys(missing))


End = Literal["left", "right"]


@dataclass(frozen=True, kw_only=True)
class JointStiffness:
    """What a joint of two parts of one axis resists besides torsion; the torsional model does not read it.

    axial, lateral : between its middle sections, the same in all lateral directions [N/m]; angular : against tilting
    of one part against the other [N m/rad]; the dampers likewise [N s/m], [N m s/rad], turning with the shaft.

    Raises DrivetrainError for a negative value.
    """

    axial: float = 0.0
    lateral: float = 0.0
    angular: float = 0.0
    axial_damping: float = 0.0
    lateral_damping: float = 0.0
    angular_damping: float = 0.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value >= 0.0:
                raise DrivetrainError(f"joint: {name} = {value}: must not be negative; correct the sign")


@dataclass(frozen=True, kw_only=True)
class GearBody:
    """Rigid gear on a shaft, joined by a spline or key.

    position : on the shaft [m]; inertia [kg m2]; stiffness [N m/rad]; damping [N m s/rad]; loss_factor [-] : instead of
    a damping, friction whose damper depends on the speed (`dynamics.rotor.graph`).

    Of the elastic rig alone: mass [kg]; diametral_inertia [kg m2], that of a cylinder if not given; width [m];
    offset : of the centre of the gear from its position, towards the right end of the shaft [m]; seat : None is rigid
    with the shaft in every direction but torsion.
    """

    name: str
    shaft: str
    position: float
    inertia: float
    stiffness: float
    damping: float = 0.0
    mass: float = 0.0
    diametral_inertia: float | None = None
    width: float = 0.0
    offset: float = 0.0
    seat: JointStiffness | None = None
    loss_factor: float = 0.0

    @property
    def tilting_inertia(self) -> float:
        """Inertia about a diameter [kg m2]: as given, else that of a cylinder, I_p / 2 + m b^2 / 12."""
        return tilting_inertia(f"gear body {self.name!r}", self)


@dataclass(frozen=True, kw_only=True)
class Coupling:
    """Massless spring and damper between two shaft ends: stiffness [N m/rad], damping [N m s/rad].

    Flange masses (a torque flange, say) are discs on the shafts. ``excitation`` acts between its ends, positive where
    it draws the first shaft ahead, and counts the turns of the first shaft. ``flexibility`` is what it resists besides
    torsion: nothing unless given.
    """

    name: str
    shafts: tuple[str, str]
    ends: tuple[End, End] = ("right", "left")
    stiffness: float
    damping: float = 0.0
    excitation: tuple[LoadOrder, ...] = ()
    flexibility: JointStiffness = JointStiffness()


@dataclass(frozen=True, kw_only=True)
class BearingPlace:
    """Bearing of a shaft as a place that brakes.

    ``linear_drag`` [N m s/rad] enters the damping matrix (P2, Table 1: 0.0007). Leave it 0 when the drag
    torque comes from a loss model: it is then applied through the drag load of the same name.
    """

    name: str
    shaft: str
    position: float
    linear_drag: float = 0.0


@dataclass(frozen=True, kw_only=True)
class DragPlace:
    """Any other place of a shaft that brakes (seal, windage of a disc): a named drag load."""

    name: str
    shaft: str
    position: float


@dataclass(frozen=True, kw_only=True)
class MeshConnection:
    """Gear mesh between two gear bodies: base radii [m], tooth numbers, working centre distance [m].

    base_helix_angle : [rad], positive for a right-hand pinion, of a double-helical one for its half towards the front
    (lower x); of the elastic rig alone.
    """

    name: str
    pinion: str
    wheel: str
    base_radii: tuple[float, float]
    teeth: tuple[int, int]
    centre_distance: float
    base_helix_angle: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Motor:
    """Drive on a shaft: torque acts at ``position`` [m], on a rotor of its own if ``stiffness`` is given.

    inertia : rotor [kg m2], added to the station when there is no stiffness. ripple : of its torque about the mean.
    mass [kg], width [m] and diametral_inertia [kg m2] : of the elastic rig alone, for a rotor that the shaft carries,
    rigid with the station. Without a diametral inertia bearings of its own carry it, and only its torsion counts.
    """

    shaft: str
    position: float
    inertia: float = 0.0
    stiffness: float | None = None
    damping: float = 0.0
    ripple: tuple[LoadOrder, ...] = ()
    mass: float = 0.0
    diametral_inertia: float | None = None
    width: float = 0.0

    @property
    def tilting_inertia(self) -> float:
        """Inertia about a diameter [kg m2]: as given, else that of a cylinder."""
        return tilting_inertia("motor", self)


# Can the power loops of a drivetrain close, and how fast does each shaft line turn?
#
# Lines are nodes, meshes are edges of a graph. Round any loop the product of the speed ratios must be one, the
# directions of rotation must alternate (external gears), and the parallel axes must be able to stand at the
# given centre distances.

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
        turned = ratios[b] / ratios[a]
        ratio = Fraction(mesh.teeth[0], mesh.teeth[1])
        if turned != ratio:
            raise DrivetrainError(
                f"mesh {mesh.name!r}: loop cannot turn: teeth {mesh.teeth[0]}/{mesh.teeth[1]} give the wheel "
                f"{float(ratio):.9g} of the pinion's speed, the rest of the loop {float(turned):.9g}, "
                "so the product of the ratios round the loop is "
                f"{float(ratio / turned):.9g} and not 1; change tooth numbers so that it is 1"
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

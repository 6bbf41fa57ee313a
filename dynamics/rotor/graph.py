"""Drivetrain of a gear test rig: shafts, joints and meshes as a graph, assembled to matrices.

Nodes of the graph are bodies that turn: stations of shafts, gear bodies on their splines, a motor rotor.
Edges with springs (shaft elements, splines, couplings) join them to *shaft lines*; gear meshes join the
lines and stay outside the matrices (`dynamics.tooth.law`). Any number of shafts, joints, meshes and loops is
allowed; whether the loops can close is checked in `dynamics.rotor.parts`.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.linear_system import LinearSystem, line_shapes
from dynamics.rotor.parts import (
    BearingPlace,
    Coupling,
    DragPlace,
    End,
    GearBody,
    MeshConnection,
    Motor,
    PeriodicLoad,
    check_loops,
    speed_ratios,
)
from dynamics.rotor.shaft import DrivetrainError, Section, Shaft, ShaftChain, discretise

Array = NDArray[np.float64]


_Part = TypeVar("_Part", "Shaft", "GearBody", "Coupling")


@dataclass(frozen=True, kw_only=True)
class Drivetrain:
    """All parts of a rig that turn. Names are unique within shafts, gears, couplings, meshes and drag places.

    bracing_coupling : coupling in which the bracing twist is made; None if the rig has no twist bracing.
    """

    shafts: tuple[Shaft, ...]
    gears: tuple[GearBody, ...]
    meshes: tuple[MeshConnection, ...]
    motor: Motor
    couplings: tuple[Coupling, ...] = ()
    bearings: tuple[BearingPlace, ...] = ()
    drag_places: tuple[DragPlace, ...] = ()
    bracing_coupling: str | None = None

    def __post_init__(self) -> None:
        _check_names(self)
        _check_references(self)
        check_loops(self)

    def shaft(self, name: str) -> Shaft:
        """Shaft by its name."""
        return _named(self.shafts, name, "shaft")

    def gear(self, name: str) -> GearBody:
        """Gear body by its name."""
        return _named(self.gears, name, "gear body")

    def lines(self) -> dict[str, int]:
        """Index of the shaft line of every shaft: shafts joined by couplings form one line."""
        line = {shaft.name: i for i, shaft in enumerate(self.shafts)}
        for coupling in self.couplings:
            keep, drop = sorted(line[name] for name in coupling.shafts)
            line = {name: keep if value == drop else value for name, value in line.items()}
        order = {value: i for i, value in enumerate(dict.fromkeys(line.values()))}
        return {name: order[value] for name, value in line.items()}


class _NoDrivetrain(Drivetrain):
    """Nothing that turns."""

    def __post_init__(self) -> None:
        """Nothing to check."""


NO_DRIVETRAIN = _NoDrivetrain(shafts=(), gears=(), meshes=(), motor=Motor(shaft="", position=0.0))
"""Of a rig of which no part that turns is stated."""


class TorsionalJoint(NamedTuple):
    """Spring and damper between two freedoms; all elements of a shaft share its name."""

    name: str
    kind: Literal["shaft", "spline", "coupling", "motor", "mesh"]
    dof_a: int
    dof_b: int
    stiffness: float
    damping: float


def assemble(drivetrain: Drivetrain) -> LinearSystem:
    """Matrices of the drivetrain without its meshes.

    Freedoms: stations of every shaft in the order given, then the gear bodies, then a motor rotor. Inertia is
    lumped, the matrix diagonal. Every angle is positive in the running direction of its line.
    """
    builder = _Builder(drivetrain)
    gear_dof = {gear.name: builder.stations + i for i, gear in enumerate(drivetrain.gears)}
    places = {place.name: builder.station(place.shaft, place.position) for place in drivetrain.drag_places}
    for bearing in drivetrain.bearings:
        places[bearing.name] = builder.station(bearing.shaft, bearing.position)
    places.update(gear_dof)

    stiffness, damping = builder.matrices()
    n = builder.size
    twist_load = np.zeros(n)
    if drivetrain.bracing_coupling is not None:
        braced = next(
            joint
            for joint in builder.joints
            if joint.name == drivetrain.bracing_coupling and joint.kind == "coupling"
        )
        twist_load[braced.dof_a], twist_load[braced.dof_b] = braced.stiffness, -braced.stiffness
    line = drivetrain.lines()
    return LinearSystem(
        inertia=np.diag(builder.inertia),
        damping=damping,
        stiffness=stiffness,
        dofs=tuple(builder.names),
        mesh_ports=np.array(
            [(gear_dof[m.pinion], gear_dof[m.wheel]) for m in drivetrain.meshes], dtype=np.int64
        ).reshape(-1, 2),
        rigid=line_shapes(np.array([line[shaft] for shaft in builder.shaft_of], dtype=np.int64)),
        drive_dof=builder.drive,
        twist_load=twist_load,
        drag_loads={name: -np.eye(1, n, dof)[0] for name, dof in places.items()},
        periodic_loads=tuple(_periodic_loads(drivetrain, builder)),
    )


def _periodic_loads(drivetrain: Drivetrain, builder: "_Builder") -> Iterator[PeriodicLoad]:
    """Ripple of the motor and excitation of the couplings, each part that has any."""
    if drivetrain.motor.ripple:
        load = np.eye(1, builder.size, builder.drive)[0]
        yield PeriodicLoad(name="motor", load=load, dof=builder.drive, parts=drivetrain.motor.ripple)
    for coupling in drivetrain.couplings:
        if coupling.excitation:
            a, b = (builder.end(name, end) for name, end in zip(coupling.shafts, coupling.ends))
            load = np.zeros(builder.size)
            load[a], load[b] = 1.0, -1.0
            yield PeriodicLoad(name=coupling.name, load=load, dof=a, parts=coupling.excitation)


def joints(drivetrain: Drivetrain) -> tuple[TorsionalJoint, ...]:
    """All springs and dampers between the freedoms of ``assemble``, meshes left out."""
    return tuple(_Builder(drivetrain).joints)


def shaft_chains(drivetrain: Drivetrain) -> dict[str, ShaftChain]:
    """Stations of every shaft, as `assemble` numbers them."""
    return _Builder(drivetrain).chains


@dataclass
class _Builder:
    """Collects bodies and joints of one assembly."""

    drivetrain: Drivetrain
    inertia: list[float] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    shaft_of: list[str] = field(default_factory=list)
    joints: list[TorsionalJoint] = field(default_factory=list)
    chains: dict[str, ShaftChain] = field(default_factory=dict)
    first: dict[str, int] = field(default_factory=dict)
    stations: int = 0
    drive: int = 0

    def __post_init__(self) -> None:
        self._add_shafts()
        self.stations = self.size
        for gear in self.drivetrain.gears:
            self.add_body(f"{gear.shaft}/{gear.name}", gear.inertia, gear.shaft)
            seat = self.station(gear.shaft, gear.position)
            self.joints.append(
                TorsionalJoint(gear.name, "spline", self.size - 1, seat, gear.stiffness, gear.damping)
            )
        for coupling in self.drivetrain.couplings:
            a, b = (self.end(name, end) for name, end in zip(coupling.shafts, coupling.ends))
            self.joints.append(
                TorsionalJoint(coupling.name, "coupling", a, b, coupling.stiffness, coupling.damping)
            )
        self._add_motor(self.drivetrain.motor)

    def _add_shafts(self) -> None:
        for shaft in self.drivetrain.shafts:
            chain = discretise(shaft, _stations(self.drivetrain, shaft.name))
            self.chains[shaft.name] = chain
            self.first[shaft.name] = start = self.size
            for position, inertia in zip(chain.positions, chain.inertia):
                self.add_body(f"{shaft.name}/{position * 1e3:.2f} mm", float(inertia), shaft.name)
            for i, spring in enumerate(chain.springs):
                self.joints.append(
                    TorsionalJoint(
                        shaft.name,
                        "shaft",
                        start + i,
                        start + i + 1,
                        float(spring),
                        shaft.damping_time * float(spring),
                    )
                )

    @property
    def size(self) -> int:
        return len(self.inertia)

    def add_body(self, name: str, inertia: float, shaft: str) -> None:
        self.inertia.append(inertia)
        self.names.append(name)
        self.shaft_of.append(shaft)

    def station(self, shaft: str, position: float) -> int:
        return self.first[shaft] + self.chains[shaft].node(position)

    def end(self, shaft: str, end: End) -> int:
        return self.station(shaft, 0.0 if end == "left" else self.drivetrain.shaft(shaft).length)

    def _add_motor(self, motor: Motor) -> None:
        self.drive = self.station(motor.shaft, motor.position)
        if motor.stiffness is None:
            self.inertia[self.drive] += motor.inertia
            return
        self.add_body(f"{motor.shaft}/motor", motor.inertia, motor.shaft)
        self.joints.append(
            TorsionalJoint("motor", "motor", self.size - 1, self.drive, motor.stiffness, motor.damping)
        )
        self.drive = self.size - 1

    def matrices(self) -> tuple[Array, Array]:
        """Stiffness and damping matrix (n, n)."""
        stiffness, damping = np.zeros((2, self.size, self.size))
        for _, _, a, b, k, c in self.joints:
            for matrix, value in ((stiffness, k), (damping, c)):
                matrix[a, a] += value
                matrix[b, b] += value
                matrix[a, b] -= value
                matrix[b, a] -= value
        for bearing in self.drivetrain.bearings:
            dof = self.station(bearing.shaft, bearing.position)
            damping[dof, dof] += bearing.linear_drag
        return stiffness, damping


def _stations(drivetrain: Drivetrain, shaft: str) -> tuple[float, ...]:
    parts: tuple[GearBody | BearingPlace | DragPlace | Motor, ...] = (
        *drivetrain.gears,
        *drivetrain.bearings,
        *drivetrain.drag_places,
        drivetrain.motor,
    )
    return tuple(part.position for part in parts if part.shaft == shaft)


def _named(parts: Iterable[_Part], name: str, kind: str) -> _Part:
    known = []
    for part in parts:
        if part.name == name:
            return part
        known.append(part.name)
    raise DrivetrainError(f"{kind} {name!r} does not exist: the drivetrain has {', '.join(known) or 'none'}")


def _check_names(drivetrain: Drivetrain) -> None:
    if not drivetrain.shafts:
        raise DrivetrainError("the drivetrain has no shaft; give at least one")
    groups: dict[str, list[str]] = {
        "shaft": [part.name for part in drivetrain.shafts],
        "coupling": [part.name for part in drivetrain.couplings],
        "mesh": [part.name for part in drivetrain.meshes],
        "gear body, bearing or drag place": [
            *(part.name for part in drivetrain.gears),
            *(part.name for part in drivetrain.bearings),
            *(part.name for part in drivetrain.drag_places),
        ],
    }
    for kind, names in groups.items():
        for name in names:
            if names.count(name) > 1:
                raise DrivetrainError(
                    f"{kind} {name!r} is given {names.count(name)} times: rename all but one"
                )


def _check_references(drivetrain: Drivetrain) -> None:
    for gear in drivetrain.gears:
        drivetrain.shaft(gear.shaft).check_position(gear.position, f"gear body {gear.name!r}")
        _check_positive(f"gear body {gear.name!r}", inertia=gear.inertia, stiffness=gear.stiffness)
        _check_not_negative(f"gear body {gear.name!r}", damping=gear.damping, loss_factor=gear.loss_factor)
        if gear.damping and gear.loss_factor:
            raise DrivetrainError(
                f"gear body {gear.name!r}: damping = {gear.damping} N m s/rad and loss_factor = {gear.loss_factor} "
                "exclude each other; give one of them"
            )
    for coupling in drivetrain.couplings:
        for name in coupling.shafts:
            drivetrain.shaft(name)
        _check_positive(f"coupling {coupling.name!r}", stiffness=coupling.stiffness)
        _check_not_negative(f"coupling {coupling.name!r}", damping=coupling.damping)
    for bearing in drivetrain.bearings:
        drivetrain.shaft(bearing.shaft).check_position(bearing.position, f"bearing {bearing.name!r}")
        _check_not_negative(f"bearing {bearing.name!r}", linear_drag=bearing.linear_drag)
    for place in drivetrain.drag_places:
        drivetrain.shaft(place.shaft).check_position(place.position, f"drag place {place.name!r}")
    motor = drivetrain.motor
    drivetrain.shaft(motor.shaft).check_position(motor.position, "motor")
    _check_not_negative("motor", inertia=motor.inertia, damping=motor.damping)
    if motor.stiffness is not None:
        _check_positive("motor on a joint of its own", inertia=motor.inertia, stiffness=motor.stiffness)
    for mesh in drivetrain.meshes:
        drivetrain.gear(mesh.pinion)
        drivetrain.gear(mesh.wheel)
    if drivetrain.bracing_coupling is not None:
        _named(drivetrain.couplings, drivetrain.bracing_coupling, "bracing coupling")


def _check_positive(part: str, **values: float) -> None:
    for name, value in values.items():
        if not value > 0.0:
            raise DrivetrainError(f"{part}: {name} = {value}: must be above 0; correct the value")


def _check_not_negative(part: str, **values: float) -> None:
    for name, value in values.items():
        if not value >= 0.0:
            raise DrivetrainError(f"{part}: {name} = {value}: must not be negative; correct the sign")


# Where torque passes through a drivetrain, shaft elements and joints, and the twist that tells how much.
#
# The torque of a spring and damper is k (w - offset) + c w' with the twist w = row . q; inside a section it changes
# from element to element by the inertia between them.

SectionKind = Literal["shaft", "spline", "coupling", "motor"]


@dataclass(frozen=True, kw_only=True)
class TorqueSection:
    """Section of a shaft between two steps of its diameter, or a joint.

    part : shaft, or name of the joint; start, end : on the shaft [m], 0 of a joint; section : None of a joint
    """

    kind: SectionKind
    part: str
    start: float = 0.0
    end: float = 0.0
    section: Section | None = None

    @property
    def name(self) -> str:
        """As it is called in tables: part and place [mm], or kind and part."""
        if self.kind != "shaft":
            return f"{self.kind} {self.part}"
        return f"{self.part} {1e3 * self.start:.0f} to {1e3 * self.end:.0f} mm"

    @property
    def shear_per_torque(self) -> float:
        """Nominal shear stress at the surface per torque [Pa/(N m)]; 0 of a joint."""
        if self.section is None:
            return 0.0
        return 0.5 * self.section.outer_diameter / self.section.polar_moment


@dataclass(frozen=True, kw_only=True)
class TwistRows:
    """Springs through which torque passes; several of one section stand one after the other.

    sections : (r,) of each
    rows : (r, n) twist per freedom; stiffness [N m/rad], damping [N m s/rad] : (r,)
    bracing : (r,) offset of the twist per bracing twist [-]
    """

    sections: tuple[TorqueSection, ...]
    rows: Array
    stiffness: Array
    damping: Array
    bracing: Array


@dataclass(frozen=True)
class TwistSpring:
    """One spring: row (n,) with its stiffness and damping."""

    section: TorqueSection
    row: Array
    stiffness: float
    damping: float


def twist_rows(springs: Sequence[TwistSpring], braced: str | None) -> TwistRows:
    """Rows of springs; braced : name of the coupling that makes the bracing twist."""
    return TwistRows(
        sections=tuple(spring.section for spring in springs),
        rows=np.array([spring.row for spring in springs]),
        stiffness=np.array([spring.stiffness for spring in springs]),
        damping=np.array([spring.damping for spring in springs]),
        bracing=np.array([float(s.section.kind == "coupling" and s.section.part == braced) for s in springs]),
    )


def torsional_twist_rows(drivetrain: Drivetrain) -> TwistRows:
    """Rows on the freedoms of `assemble`: elements of the shafts from left to right, then splines and couplings."""
    size = len(assemble(drivetrain).inertia)
    chains = shaft_chains(drivetrain)
    places = {
        shaft.name: iter(section_of_elements(shaft, chains[shaft.name].positions))
        for shaft in drivetrain.shafts
    }
    springs = []
    for joint in joints(drivetrain):
        if joint.kind == "mesh":
            continue
        row = np.zeros(size)
        row[joint.dof_a], row[joint.dof_b] = 1.0, -1.0
        section = (
            next(places[joint.name])
            if joint.kind == "shaft"
            else TorqueSection(kind=joint.kind, part=joint.name)
        )
        springs.append(TwistSpring(section, row, joint.stiffness, joint.damping))
    return twist_rows(springs, drivetrain.bracing_coupling)


def section_of_elements(shaft: Shaft, positions: Array) -> Iterator[TorqueSection]:
    """Section of each element between neighbouring positions (n,) [m] of a chain."""
    ends = np.cumsum([0.0, *(section.length for section in shaft.sections)])
    sections = [
        TorqueSection(kind="shaft", part=shaft.name, start=float(a), end=float(b), section=section)
        for a, b, section in zip(ends[:-1], ends[1:], shaft.sections)
    ]
    middle = 0.5 * (positions[:-1] + positions[1:])
    index = np.clip(np.searchsorted(ends, middle) - 1, 0, len(sections) - 1)
    return (sections[i] for i in index)


# Friction in splines as a loss factor: what a cycle dissipates does not depend on its rate.
#
# A spline with stiffness k and loss factor eta dissipates pi eta k phi^2 in a cycle of twist of amplitude phi, at any
# frequency (structural damping, C. W. Bert, J. Sound Vib. 29, 1973, 129). Models in time need a damper: c = eta k /
# omega gives the same at one frequency, here the mesh frequency of the gear on the spline, at which its teeth drive it.
# At a frequency f times that the damper dissipates f times as much: a mode above the mesh frequency decays faster than
# eta says (logarithmic decrement pi eta f where the spline holds all of its strain energy), one below slower, and the
# second mesh order loses twice its share. At a small share of the highest speed the damper stiffens the spline for
# everything that oscillates well above the mesh frequency. At rest there is none: nothing meshes.


@dataclass(frozen=True, kw_only=True)
class SplineLoss:
    """Spline with a loss factor under a gear.

    loss : loss factor times stiffness [N m/rad]; cycles : meshing teeth per radian of the motor's shaft
    """

    gear: str
    loss: float
    cycles: float

    def damping(self, speed: float) -> float:
        """Damper at a speed of the motor's shaft [rad/s], eta k / omega [N m s/rad]; 0 at rest."""
        frequency = self.cycles * abs(speed)
        return self.loss / frequency if frequency > 0.0 else 0.0


def spline_losses(drivetrain: Drivetrain) -> Iterator[SplineLoss]:
    """Of every gear in a mesh whose spline has a loss factor."""
    if not any(gear.loss_factor for gear in drivetrain.gears):
        return
    ratios = speed_ratios(drivetrain)
    teeth = {mesh.pinion: mesh.teeth[0] for mesh in drivetrain.meshes}
    teeth |= {mesh.wheel: mesh.teeth[1] for mesh in drivetrain.meshes}
    for gear in drivetrain.gears:
        if gear.loss_factor and gear.name in teeth:
            yield SplineLoss(
                gear=gear.name,
                loss=gear.loss_factor * gear.stiffness,
                cycles=teeth[gear.name] * abs(ratios[gear.shaft]),
            )


def at_speed(drivetrain: Drivetrain, speed: float) -> Drivetrain:
    """The same with dampers in place of loss factors, as they are at a speed of the motor's shaft [rad/s]."""
    damping = {loss.gear: loss.damping(speed) for loss in spline_losses(drivetrain)}
    if not damping:
        return drivetrain
    return replace(
        drivetrain,
        gears=tuple(
            replace(gear, damping=damping[gear.name], loss_factor=0.0) if gear.name in damping else gear
            for gear in drivetrain.gears
        ),
    )


def with_spline_dampers(rows: TwistRows, drivetrain: Drivetrain, speed: float) -> TwistRows:
    """Rows of torques with the dampers of splines at a speed of the motor's shaft [rad/s], which carry torque too."""
    added = {loss.gear: loss.damping(speed) for loss in spline_losses(drivetrain)}
    damping = [added.get(section.part, 0.0) if section.kind == "spline" else 0.0 for section in rows.sections]
    return replace(rows, damping=rows.damping + damping) if added else rows

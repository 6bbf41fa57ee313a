"""The reduced elastic rig as a linear system of the drivetrain: what is seen from outside becomes a freedom.

The mesh ports, the drive and the ends of the couplings are freedoms of their own, as boundary freedoms are in a
component mode synthesis (Craig and Bampton, AIAA J. 6, 1968); the rest of the motion is spanned by coordinates that
none of them moves. With S the rows of what is seen, on the coordinates eta of the reduced rig, and N an orthonormal
basis of what S does not see, the freedoms are z = (S eta, N' eta), hence eta = (S^+, N) z.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from dynamics.rotor.assembly import WAVES, CrossJointLoad, ElasticModel, cross_joint_loads
from dynamics.rotor.beam import DIRECTIONS
from dynamics.rotor.bearing_state import RunningState, line_loads
from dynamics.rotor.freedoms import ElasticJoint
from dynamics.rotor.graph import (
    SectionKind,
    TorqueSection,
    TwistRows,
    TwistSpring,
    section_of_elements,
    twist_rows,
)
from dynamics.rotor.linear_system import Coordinates, LinearSystem, MeshWrench
from dynamics.rotor.parts import LoadOrder, PeriodicLoad, rotating_load
from dynamics.rotor.reduction import ReducedElasticRig
from dynamics.rotor.rotor_model import ElasticRig
from dynamics.rotor.shaft import DrivetrainError, Shaft

Array = NDArray[np.float64]


# Gear meshes in six degrees of freedom: directions of their flanks and rows of the approach.
#
# e points from the pinion to the wheel; t = sense x_axis x e is where the teeth of the pinion pass the mesh. The front
# flanks of the pinion drive the wheel along n = cos(alpha) t + sin(alpha) e, the back flanks along -cos(alpha) t +
# sin(alpha) e, alpha the working transverse pressure angle. A helical flank presses along x as well: a right-hand
# pinion that turns about +x presses the wheel with its front flanks towards -x. Approach along the transverse line of
# action:
#
#     x = r_b1 turn_1 - r_b2 turn_2 + d . (u_1 + theta_1 x r_1 - u_2 - theta_2 x r_2),    d = (-hand tan(beta_b), n)
#
# with r_i from the centre of the gear to the contact, and theta_i the tilt about y and z.

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


# What a gear mesh sees of its two gears in six degrees of freedom, as rows on the freedoms of the elastic rig.
#
# The forces of a mesh act on the same rows by which its motion is seen, so that its power is theirs and its forces on
# both gears balance. The turns count from the centre line, which the gears turn as they move: gears that move as one,
# turned about any axis, show no motion in any row. Friction across the normal n = +-cos(alpha) t + sin(alpha) e acts
# where both flanks slide,
#
#     omega_1 rho_1 - omega_2 rho_2 - cos(alpha) e . (v_1 - v_2),
#
# with the turns from the centre line, the path rho_1 + rho_2 = a sin(alpha) being that of its ends. Derived here.


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
    motion = np.zeros((3, model.size))
    for sign, name, radius, centre in zip((1.0, -1.0), names, directions.radii, centres):
        rows = model.rows(name)
        arm = sign * radius * directions.centre_line
        arm[0] = 0.5 * sum(centres) - centre
        turned = np.stack([np.zeros(model.size), rows[4], rows[5]])
        motion += sign * (rows[:3] + np.cross(turned.T, arm).T)
    return motion


def _face_direction(model: ElasticModel, mesh: str) -> float:
    """Face position z per x from the middle of the mesh, 1 or -1: z grows to the end that comes into mesh last."""
    connection = model.rig.mesh(mesh)
    if connection.base_helix_angle == 0.0:
        return 1.0
    sense = model.rig.placement(model.rig.drivetrain.gear(connection.pinion).shaft).sense
    return -math.copysign(1.0, connection.base_helix_angle) * sense


Complex = NDArray[np.complex128]

TURNING = ("unbalance", "bow and run-out")
"""What turns with a shaft line: loads that grow with the square of its speed, and loads that do not."""
INDEPENDENT = 1e-9
"""Smallest singular value of the scaled rows of what is seen, over the largest."""


@dataclass(frozen=True, kw_only=True)
class SeenRig:
    """A reduced rig and what of it is seen.

    ports : mesh -> (2, n_full) turns of pinion and wheel as their mesh sees them (`mesh_ports`), in the order of the
        drivetrain
    """

    reduced: ReducedElasticRig
    ports: Mapping[str, Array]

    def system(self, state: RunningState) -> LinearSystem:
        """Matrices at a running state, bearings in, meshes out; the freedoms are the same for all states.

        Raises DrivetrainError as `RunningState.check`.
        """
        matrices = self.reduced.matrices(state)
        back = self._back
        places = self._places
        return LinearSystem(
            inertia=back.T @ matrices.mass @ back,
            damping=back.T @ matrices.damping @ back,
            stiffness=back.T @ matrices.stiffness @ back,
            dofs=self._names,
            mesh_ports=np.array(
                [(places[f"{mesh} pinion"], places[f"{mesh} wheel"]) for mesh in self.ports], np.int64
            ),
            rigid=_exact(self._forth @ self.reduced.rigid),
            drive_dof=places["drive"],
            twist_load=self._twist_load,
            drag_loads=self._drag_loads,
            periodic_loads=(*self._periodic_loads, *self._cross_joints(state)),
            own_coordinates=Coordinates(
                freedoms=self._forth,
                inertia=matrices.mass,
                damping=_without_rounding(matrices.damping),
                stiffness=_without_rounding(matrices.stiffness),
                rigid=self.reduced.rigid,
            ),
            mesh_wrench=self._mesh_wrench,
        )

    @cached_property
    def drag(self) -> Array:
        """(n, n) linear drag of the bearings in the damping of every system [N m s/rad]."""
        return np.asarray(self._back.T @ self.reduced.drag @ self._back)

    def on_freedoms(self, rows: Array) -> Array:
        """Rows (m, n) on the freedoms of the system of rows (m, n_full) on those of the whole rig."""
        return np.asarray(self.reduced.rows(rows) @ self._back)

    def on_coordinates(self, motion: NDArray[Any]) -> NDArray[Any]:
        """Motions (n, k) of the freedoms of the system on the coordinates of the reduced rig."""
        return np.asarray(self._back @ motion)

    @cached_property
    def _mesh_wrench(self) -> MeshWrench:
        model = self.reduced.model
        turns, slides, tangents, sides = [], [], [], []
        for mesh, ports in self.ports.items():
            rows = dict(zip(ROWS, wrench_rows(model, mesh), strict=True))
            first, second = model.rig.mesh(mesh).base_radii
            approach = first * ports[0] - second * ports[1]
            apart = approach - rows["front approach"], approach + rows["back approach"]
            sides.append(1.0 if np.linalg.norm(apart[0]) < np.linalg.norm(apart[1]) else -1.0)
            turns.append(
                self.on_freedoms(np.array([rows["pinion turn"] - ports[0], rows["wheel turn"] - ports[1]]))
            )
            tangents.append(math.tan(mesh_directions(model.rig, mesh).pressure_angle))
            slides.append(self.on_freedoms(rows["slide"][None])[0])
        return MeshWrench(
            turns=np.array(turns), slide=np.array(slides), tangents=np.array(tangents), sides=np.array(sides)
        )

    @cached_property
    def _rows(self) -> dict[str, Array]:
        """Row (n_full,) of everything that is seen, by name."""
        model = self.reduced.model
        rows = {}
        for mesh, (pinion, wheel) in self.ports.items():
            rows[f"{mesh} pinion"], rows[f"{mesh} wheel"] = pinion, wheel
        rows["drive"] = model.row("motor", "turn")
        for joint in self._couplings:
            rows[f"{joint.name} twist"] = joint.row("turn")
        return rows

    @property
    def _couplings(self) -> Iterator[ElasticJoint]:
        return (joint for joint in self.reduced.model.joints if joint.kind == "coupling")

    @cached_property
    def _seen(self) -> Array:
        """(m, n) rows on the coordinates, those of no mesh scaled to the drive."""
        rows = self.reduced.rows(np.array(list(self._rows.values())))
        scaled = rows / np.linalg.norm(rows, axis=1, keepdims=True)
        smallest = float(np.linalg.svd(scaled, compute_uv=False)[-1])
        if smallest < INDEPENDENT:
            raise DrivetrainError(
                f"ports {', '.join(self._rows)}: rows depend on each other (smallest singular value {smallest:.1e}, "
                f"limit {INDEPENDENT:.0e}): two of them are one place; part the motor from the gear by a shaft station"
            )
        return rows

    @cached_property
    def _hidden(self) -> Array:
        """(n, n - m) orthonormal basis of what nothing seen moves with."""
        return np.asarray(scipy.linalg.null_space(self._seen))

    @cached_property
    def _forth(self) -> Array:
        """(n, n) freedoms per coordinate."""
        return np.vstack([self._seen, self._hidden.T])

    @cached_property
    def _back(self) -> Array:
        """(n, n) coordinates per freedom."""
        return np.hstack([np.linalg.pinv(self._seen), self._hidden])

    @cached_property
    def _names(self) -> tuple[str, ...]:
        hidden = (f"hidden motion {i}" for i in range(self._hidden.shape[1]))
        return (*self._rows, *hidden)

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self._rows)}

    def _load(self, row: Array) -> Array:
        """Load on the freedoms of one on a row of all freedoms (n_full,)."""
        return np.asarray(self._back.T @ self.reduced.rows(row))

    @cached_property
    def _twist_load(self) -> Array:
        drivetrain = self.reduced.model.rig.drivetrain
        if drivetrain.bracing_coupling is None:
            return np.zeros(len(self._forth))
        return self._load(self.reduced.model.joint(drivetrain.bracing_coupling, "coupling").load("turn"))

    @cached_property
    def _drag_loads(self) -> dict[str, Array]:
        drivetrain, model = self.reduced.model.rig.drivetrain, self.reduced.model
        parts = [bearing.name for bearing in drivetrain.bearings]
        parts += [place.name for place in drivetrain.drag_places]
        parts += [gear.name for gear in drivetrain.gears]
        return {name: -self._load(model.row(name, "turn")) for name in parts}

    @cached_property
    def _periodic_loads(self) -> tuple[PeriodicLoad, ...]:
        """Ripple of the motor, excitation of the couplings, which counts the turns of the line it is on, and what turns
        with every line."""
        drivetrain, model = self.reduced.model.rig.drivetrain, self.reduced.model
        loads = []
        if drivetrain.motor.ripple:
            load = self._load(model.row("motor", "turn"))
            loads.append(
                PeriodicLoad(
                    name="motor", load=load, dof=self._places["drive"], parts=drivetrain.motor.ripple
                )
            )
        for coupling in drivetrain.couplings:
            if coupling.excitation:
                load = self._load(model.joint(coupling.name, "coupling").row("turn"))
                loads.append(
                    PeriodicLoad(
                        name=coupling.name,
                        load=load,
                        dof=self._port_of_line(coupling.shafts[0]),
                        parts=coupling.excitation,
                    )
                )
        for (shaft, power), full in line_loads(model).items():
            if np.any(full):
                turning = self._load(full.real) + 1j * self._load(full.imag)
                part = LoadOrder(order=1.0, amplitude=1.0, speed_power=power)
                name = TURNING[0] if power else TURNING[1]
                loads += rotating_load(f"{name} of {shaft}", turning, self._port_of_line(shaft), part)
        return tuple(loads)

    def _cross_joints(self, state: RunningState) -> Iterator[PeriodicLoad]:
        """What cross joints make of the torque that they pass, twice a turn of their first shaft."""
        for load, turning in self._cross_joint_loads:
            torque = state.torques.get(load.coupling, 0.0)
            if torque:
                part = LoadOrder(order=WAVES, amplitude=torque)
                name = f"cross joint {load.coupling}"
                yield from rotating_load(name, turning, self._port_of_line(load.shaft), part)

    @cached_property
    def _cross_joint_loads(self) -> tuple[tuple[CrossJointLoad, Complex], ...]:
        """Each with its turning load on the freedoms."""
        return tuple(
            (load, self._load(load.turning.real) + 1j * self._load(load.turning.imag))
            for load in cross_joint_loads(self.reduced.model)
        )

    def _port_of_line(self, shaft: str) -> int:
        """A freedom that turns with the line of a shaft: a gear on it."""
        drivetrain = self.reduced.model.rig.drivetrain
        lines = drivetrain.lines()
        for mesh in drivetrain.meshes:
            for gear, side in ((mesh.pinion, "pinion"), (mesh.wheel, "wheel")):
                if lines[drivetrain.gear(gear).shaft] == lines[shaft]:
                    return self._places[f"{mesh.name} {side}"]
        raise DrivetrainError(
            f"shaft {shaft!r} has no gear on its line: nothing counts its turns; add the gear"
        )


def _exact(shapes: Array) -> Array:
    """Rigid shapes without rounding."""
    return np.where(np.abs(shapes) < 1e-12 * np.abs(shapes).max(axis=0, initial=1e-300), 0.0, shapes)


def _without_rounding(matrix: Array) -> Array:
    """A matrix without what rounding has left of entries that are zero: blocks stay apart."""
    scale = np.sqrt(np.abs(np.diag(matrix)))
    scale = np.maximum(scale, 1e-6 * scale.max(initial=1e-300))
    return np.where(np.abs(matrix) < 1e-12 * np.outer(scale, scale), 0.0, matrix)


# Rows of the torques in shafts and joints of the elastic rig, on the freedoms of its linear system.

JOINTS: tuple[SectionKind, ...] = ("spline", "coupling", "motor")
TURN = DIRECTIONS.index("turn")


def elastic_twist_rows(seen: SeenRig) -> TwistRows:
    """Rows on the freedoms of the systems of ``seen``; they are the same for all its running states."""
    model = seen.reduced.model
    springs = [replace(spring, row=seen.on_freedoms(spring.row)) for spring in _springs(model)]
    return twist_rows(springs, model.rig.drivetrain.bracing_coupling)


def _springs(model: ElasticModel) -> Iterator[TwistSpring]:
    """With rows on all freedoms of the model."""
    for shaft in model.rig.drivetrain.shafts:
        yield from _elements(model, shaft)
    for joint in model.joints:
        for kind in JOINTS:
            if joint.kind == kind and "turn" in joint.directions:
                turn = joint.directions.index("turn")
                yield TwistSpring(
                    TorqueSection(kind=kind, part=joint.name),
                    joint.row("turn"),
                    float(joint.stiffness[turn, turn]),
                    float(joint.damping[turn, turn]),
                )


def _elements(model: ElasticModel, shaft: Shaft) -> Iterator[TwistSpring]:
    nodes = model.freedoms.nodes[shaft.name]
    lengths = np.diff(nodes.positions)
    for i, section in enumerate(section_of_elements(shaft, nodes.positions)):
        assert section.section is not None
        row = np.zeros(model.size)
        first = nodes.first + 6 * i + TURN
        row[first], row[first + 6] = 1.0, -1.0
        stiffness = shaft.shear_modulus * section.section.polar_moment / float(lengths[i])
        yield TwistSpring(section, row, stiffness, shaft.damping_time * stiffness)

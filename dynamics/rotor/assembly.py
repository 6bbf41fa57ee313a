"""Matrices of the elastic rig: shafts, bodies, joints and seats, without bearings and meshes.

M q'' + (C + s G) q' + (K + s N) q = loads, with s the speed of the reference shaft [rad/s]. G is the skew gyroscopic
matrix. N belongs to dampers that turn with a shaft (material, couplings, gear seats): their force depends on the
motion in the rotating frame, C (q' - spin x q), which feeds forward whirl above a critical speed (Kimball 1924;
Friswell et al. 2010, section 7.3).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array

from dynamics.rotor.beam import (
    DIRECTIONS,
    elements_of,
    gyroscopic_matrices,
    mass_matrices,
    stiffness_matrices,
)
from dynamics.rotor.freedoms import ElasticJoint, Freedoms, Place, all_joints, number_freedoms, port_rows
from dynamics.rotor.location import RigidMotion, check_location, rigid_motions
from dynamics.rotor.parts import Coupling
from dynamics.rotor.rotor_model import CrossJoint, ElasticRig
from dynamics.rotor.shaft import Shaft, element_sections

Array = NDArray[np.float64]


Triplets = tuple[NDArray[np.int64], NDArray[np.int64], Array]

GRAVITY = 9.80665
"""Standard acceleration of fall [m/s2]."""


@dataclass(frozen=True, kw_only=True)
class ElasticModel:
    """Matrices (n, n) of a rig without bearings and meshes, and the rows that they act on.

    mass, stiffness, damping, gyroscopic, circulation : M, K, C, and G, N per reference speed (module)
    drag : (n,) linear drag of bearings on the turn of their stations [N m s/rad], not in ``damping``
    ports : name of a bearing -> (5, n) motion of its journal against its seat, order of `SEAT_DIRECTIONS`
    """

    rig: ElasticRig
    freedoms: Freedoms
    mass: csr_array
    stiffness: csr_array
    damping: csr_array
    gyroscopic: csr_array
    circulation: csr_array
    drag: Array
    joints: tuple[ElasticJoint, ...]
    ports: dict[str, Array]
    rigid: tuple[RigidMotion, ...]

    @property
    def size(self) -> int:
        """Number of freedoms n."""
        return self.freedoms.size

    @property
    def names(self) -> tuple[str, ...]:
        """Name of every freedom."""
        return tuple(self.freedoms.names)

    @cached_property
    def spins(self) -> dict[str, float]:
        """Angular speed about +x of every shaft per reference speed, with its sign."""
        return self.rig.spins()

    def rows(self, place: str) -> Array:
        """(6, n) motion of a gear centre, bearing journal, disc, drag place, station or motor; order `DIRECTIONS`."""
        return self.freedoms.place(place).rows(self.size)

    def row(self, place: str, direction: str) -> Array:
        """(n,) motion of a place in one of `DIRECTIONS`."""
        return np.asarray(self.rows(place)[DIRECTIONS.index(direction)])

    def joint(self, name: str, kind: str) -> ElasticJoint:
        """Joint by its name and kind."""
        return next(joint for joint in self.joints if (joint.name, joint.kind) == (name, kind))

    def weight(self) -> Array:
        """(n,) load of gravity on shafts and bodies [N, N m]; the seats carry none of their own."""
        fall = np.zeros(self.size)
        lateral = np.array(self.freedoms.family) == 2
        fall[np.char.endswith(np.array(self.freedoms.names), " u_z") & lateral] = -GRAVITY
        return np.asarray(self.mass @ fall)


def assemble_rig(rig: ElasticRig) -> ElasticModel:
    """Matrices of a rig.

    Raises DrivetrainError for a shaft that nothing locates axially or holds sideways (`check_location`).
    """
    freedoms = number_freedoms(rig)
    joints = all_joints(rig, freedoms)
    check_location(rig, freedoms, joints)
    n, spins = freedoms.size, rig.spins()
    beams = [_beam(rig, freedoms, shaft, spins[shaft.name]) for shaft in rig.drivetrain.shafts]
    bodies = list(_bodies(rig, freedoms))
    mass = [beam[0] for beam in beams] + [_body_mass(*body) for body in bodies] + _seat_mass(rig, freedoms)
    gyroscopic = [beam[2] for beam in beams]
    gyroscopic += [_body_gyroscopic(place, values, spins[place.shaft]) for place, values in bodies]
    material = _joined([beam[3] for beam in beams], n)
    turning = material + _springs([joint for joint in joints if joint.turning], n, "damping")
    standing = _springs([joint for joint in joints if not joint.turning], n, "damping")
    return ElasticModel(
        rig=rig,
        freedoms=freedoms,
        mass=_joined(mass, n),
        stiffness=_joined([beam[1] for beam in beams], n) + _springs(joints, n, "stiffness"),
        damping=csr_array(turning + standing),
        gyroscopic=_joined(gyroscopic, n),
        circulation=csr_array(-(turning @ _rotation(freedoms, rig, spins))),
        drag=_drag(rig, freedoms),
        joints=joints,
        ports={bearing.name: port_rows(bearing.name, freedoms) for bearing in rig.drivetrain.bearings},
        rigid=rigid_motions(rig, freedoms),
    )


def shaft_stiffness(model: ElasticModel, shaft: str) -> csr_array:
    """Stiffness (n, n) of the elements of one shaft alone."""
    part = next(part for part in model.rig.drivetrain.shafts if part.name == shaft)
    return _joined([_beam(model.rig, model.freedoms, part, 0.0)[1]], model.size)


def _beam(
    rig: ElasticRig, freedoms: Freedoms, shaft: Shaft, spin: float
) -> tuple[Triplets, Triplets, Triplets, Triplets]:
    """Mass, stiffness, gyroscopics and material damping of the elements of a shaft, front node first."""
    nodes = freedoms.nodes[shaft.name]
    sections = element_sections(shaft, nodes.positions)
    elements = elements_of(shaft, np.diff(nodes.positions), sections, rig.shear, rig.torsional_inertia)
    left = nodes.first + 6 * np.arange(len(sections))
    ahead = rig.placement(shaft.name).direction > 0
    front, rear = (left, left + 6) if ahead else (left + 6, left)
    index = np.hstack([front[:, None] + np.arange(6), rear[:, None] + np.arange(6)])
    stiffness = stiffness_matrices(elements)
    return (
        _triplets(index, mass_matrices(elements)),
        _triplets(index, stiffness),
        _triplets(index, spin * gyroscopic_matrices(elements)),
        _triplets(index, shaft.damping_time * stiffness),
    )


def _triplets(index: NDArray[np.int64], blocks: Array) -> Triplets:
    """Entries of blocks (m, k, k) at freedoms (m, k)."""
    shape = blocks.shape
    rows = np.broadcast_to(index[:, :, None], shape)
    columns = np.broadcast_to(index[:, None, :], shape)
    return rows.ravel(), columns.ravel(), blocks.ravel()


def _bodies(rig: ElasticRig, freedoms: Freedoms) -> Iterator[tuple[Place, tuple[float, float, float]]]:
    """Place of every rigid body and its mass [kg], polar and diametral inertia [kg m2], 0 if it does not tilt."""
    drivetrain = rig.drivetrain
    for shaft in drivetrain.shafts:
        for disc in shaft.discs:
            values = (disc.mass, disc.inertia, disc.tilting_inertia)
            yield freedoms.place(f"{shaft.name}/{disc.name}"), values
    for gear in drivetrain.gears:
        yield freedoms.place(gear.name), (gear.mass, gear.inertia, gear.tilting_inertia)
    motor = drivetrain.motor
    carried = motor.diametral_inertia is not None
    values = (motor.mass, motor.inertia, motor.tilting_inertia) if carried else (0.0, motor.inertia, 0.0)
    yield freedoms.place("motor"), values


def _body_mass(place: Place, values: tuple[float, float, float]) -> Triplets:
    mass, polar, diametral = values
    diagonal = np.diag([mass, mass, mass, polar, diametral, diametral])
    block = place.transform.T @ diagonal @ place.transform
    return _triplets(place.freedoms[None, :], block[None, :, :])


def _body_gyroscopic(place: Place, values: tuple[float, float, float], spin: float) -> Triplets:
    block, momentum = np.zeros((6, 6)), spin * values[1] if values[2] > 0.0 else 0.0
    block[4, 5], block[5, 4] = momentum, -momentum
    return _triplets(place.freedoms[None, :], block[None, :, :])


def _seat_mass(rig: ElasticRig, freedoms: Freedoms) -> list[Triplets]:
    return [
        _triplets(
            np.concatenate([freedoms.seats[bearing] for bearing in support.bearings])[None, :],
            0.5 * (support.mass + support.mass.T)[None, :, :],
        )
        for support in rig.supports
    ]


def _springs(joints: list[ElasticJoint] | tuple[ElasticJoint, ...], size: int, quantity: str) -> csr_array:
    """Sum of rows' k rows over joints, k their stiffness or damping."""
    total = csr_array((size, size))
    if not joints:
        return total
    rows = csr_array(np.vstack([joint.rows for joint in joints]))
    blocks, first = [], 0
    for joint in joints:
        values = np.asarray(getattr(joint, quantity))
        index = first + np.arange(values.shape[0])
        blocks.append(_triplets(index[None, :], values[None, :, :]))
        first += values.shape[0]
    return csr_array(rows.T @ _joined(blocks, first) @ rows)


def _joined(parts: list[Triplets], size: int) -> csr_array:
    """Sparse sum of entries, those that cancel left out."""
    rows, columns, values = (np.concatenate(entries) for entries in zip(*parts))
    matrix = csr_array(coo_array((values, (rows, columns)), shape=(size, size)))
    matrix.eliminate_zeros()
    return matrix


def _rotation(freedoms: Freedoms, rig: ElasticRig, spins: dict[str, float]) -> csr_array:
    """J of q' = spin x q for whatever turns with a shaft: lateral displacements and tilts as vectors about +x."""
    n = freedoms.size
    spin = np.array([0.0 if i < 0 else spins[rig.drivetrain.shafts[i].name] for i in freedoms.shaft_of])
    rotation = csr_array((n, n))
    for y, z in (("u_y", "u_z"), ("theta_y", "theta_z")):
        ends = np.array([name.rsplit(" ", 1)[1] for name in freedoms.names])
        first, second = np.flatnonzero(ends == y), np.flatnonzero(ends == z)
        plane = coo_array((np.ones(first.size), (second, first)), shape=(n, n))
        rotation = rotation + diags_array(spin) @ (plane - plane.T)
    return csr_array(rotation)


def _drag(rig: ElasticRig, freedoms: Freedoms) -> Array:
    drag = np.zeros(freedoms.size)
    for bearing in rig.drivetrain.bearings:
        drag[freedoms.place(bearing.name).turn] += bearing.linear_drag
    return drag


# Moments of a cross joint (Hooke's joint) on its shafts: how the torque that it passes under an angle bends them.
#
# The cross turns freely about its arm a_1 in the yoke of the first shaft and about its arm a_2, square to it, in that
# of the second, so that the moment from yoke to yoke stands on both arms: M n with n = a_1 x a_2. With the torque T_1
# of the first shaft along its axis e_1, M = T_1 / (n . e_1); what of M n is not along the axis bends a shaft. With the
# angle b between the axes, w across e_1 in their plane towards e_2, u square to that plane, and a_1 at the angle theta
# from u,
#
#     on the first shaft   -T_1 tan(b) cos(theta) (cos(theta) w - sin(theta) u)
#     on the second shaft  -T_1 tan(b) sin(theta) (sin(theta) w + cos(theta) u), to the second power of b.
#
# In the frame of a yoke this couple stands along one direction of it and swings once a turn with |T tan(b)|; bearings
# stand still and see, with cos^2 and sin cos, half of it all the time, -T b/2 w on either shaft, and half of it turning
# forward twice a turn, opposite on both shafts. There is no part once a turn: that would need arms that do not meet, or
# axes that run out. The torque is the mean one of the coupling, its oscillation is left out (a product of two small
# quantities); theta is zero with the angle of the first shaft, as in the torque twice a turn that the same kinematics
# make (`rigdesign.rig.drivetrain`).
#
# Source: H. C. Seherr-Thoss, F. Schmelz, E. Aucktor, Universal Joints and Driveshafts, 2nd ed. 2006, chapter 1, and R.
# M. Rosenberg, J. Appl. Mech. 25, 1958, 47, from memory: neither text was at hand. The formulas are derived above and
# held against the exact kinematics (`tests/verification/test_cross_joint_bending.py`).

Complex = NDArray[np.complex128]

WAVES = 2.0
"""Waves per turn of the first shaft."""


@dataclass(frozen=True)
class CrossJointLoad:
    """Loads on all freedoms (n,) per torque that the first shaft passes to the second along its rotation [-].

    standing : all the time; turning : Re(turning exp(2 i theta)) with the angle of the first shaft
    """

    coupling: str
    shaft: str
    standing: Array
    turning: Complex


def cross_joint_loads(model: ElasticModel) -> Iterator[CrossJointLoad]:
    """Of every cross joint of a rig under an angle."""
    for joint in model.rig.cross_joints:
        coupling = next(part for part in model.rig.drivetrain.couplings if part.name == joint.coupling)
        across, square = _directions(model, coupling, joint)
        first, second = (_tilts(model, coupling, side) for side in (0, 1))
        standing = -0.5 * across @ (first + second)
        turning = np.asarray(0.5 * (across + 1j * square) @ (second - first), np.complex128)
        yield CrossJointLoad(joint.coupling, coupling.shafts[0], standing, turning)


def tilt_rows(model: ElasticModel) -> Array:
    """(4 k, n) tilts of the shaft ends at k cross joints."""
    couplings = {coupling.name: coupling for coupling in model.rig.drivetrain.couplings}
    rows = [
        _tilts(model, couplings[joint.coupling], side) for joint in model.rig.cross_joints for side in (0, 1)
    ]
    return np.vstack([np.zeros((0, model.size)), *rows])


def standing_load(model: ElasticModel, torques: Mapping[str, float]) -> Array:
    """(n,) load of all cross joints all the time under the torques of their couplings [N m]."""
    loads = (torques[load.coupling] * load.standing for load in cross_joint_loads(model))
    return np.asarray(sum(loads, np.zeros(model.size)))


def bending_moment(joint: CrossJoint, sense: float, torque: float) -> Array:
    """(2,) moment about y and z that stands on either shaft under a torque along the rotation [N m].

    sense : of the rotation about x
    """
    return np.asarray(-0.5 * torque * _across(joint, sense))


def _across(joint: CrossJoint, sense: float) -> Array:
    """b w (2,) about y and z: e_2 - e_1 of axes s (1, slope) and s (1, 0, 0)."""
    return -sense * np.array(joint.slope)


def _directions(model: ElasticModel, coupling: Coupling, joint: CrossJoint) -> tuple[Array, Array]:
    """b w and b u (2,) in the plane (y, z); u = w x e_1."""
    sense = float(np.sign(model.spins[coupling.shafts[0]]))
    across = _across(joint, sense)
    return across, sense * np.array([across[1], -across[0]])


def _tilts(model: ElasticModel, coupling: Coupling, side: int) -> Array:
    """(2, n) tilt about y and z of the end of one shaft at the joint."""
    shaft = model.rig.drivetrain.shaft(coupling.shafts[side])
    position = 0.0 if coupling.ends[side] == "left" else shaft.length
    return model.freedoms.on_shaft(shaft.name, position).rows(model.size)[4:6]

"""The linear part of a drivetrain: everything but the gear meshes, as matrices with named freedoms."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, solve_triangular
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from dynamics.errors import DynamicsInputError
from dynamics.rotor.parts import PeriodicLoad
from dynamics.tooth.law import MeshLaw
from thermal.fe.kept_results import kept_as

Array = NDArray[np.float64]


# Exact complex-modal form of a linear system with rigid modes and strong dampers.
#
# The undamped real modes come first, with the rigid mode of every free line kept exact (frequency 0). In that basis
# rigid displacements leave the state, only their velocity stays, so the state matrix has no defective pole; dampers of
# any strength are real poles of it. Nothing is truncated here.

Complex = NDArray[np.complex128]

SLOWEST = 1.0
"""Least frequency that scales a displacement [rad/s]: films may leave a motion without stiffness of its own."""


@dataclass(frozen=True, kw_only=True)
class ModalForm:
    """Poles and mode shapes of ``M q'' + C q' + K q = f``.

    poles : (n_states,) eigenvalues of the state matrix [1/s]; 2 n_elastic + n_rigid of them
    shapes : (n, n_states) displacement shape of each pole; a rigid velocity state has its velocity / pole
    velocity_shapes : (n, n_states) velocity shape of each pole
    loads : (n_states, n) modal load of a unit torque on each freedom
    rigid : (n, n_rigid) mass-normalised rigid shapes
    """

    poles: Complex
    velocity_shapes: Complex
    loads: Complex
    rigid: Array

    def seen(self, freedoms: Array) -> "ModalForm":
        """The same in other freedoms (n, n_coordinates) per coordinate."""
        return ModalForm(
            poles=self.poles,
            velocity_shapes=times(freedoms, self.velocity_shapes),
            loads=times(freedoms, self.loads.T).T,
            rigid=freedoms @ self.rigid,
        )

    def receptance(self, omega: Array, dofs: NDArray[np.int64]) -> Complex:
        """Displacement per torque between some freedoms at frequencies above zero.

        omega : (n_omega,) [rad/s], all > 0; dofs : (n_dofs,). Returns (n_omega, n_dofs, n_dofs) [rad/(N m)].
        """
        return self.receptance_to(omega, dofs, self.loads[:, dofs])

    def into(self, rows: Array) -> Complex:
        """(n_states, k) modal loads of unit loads on rows (k, n) of all freedoms."""
        return times(rows, self.loads.T).T

    def receptance_to(self, omega: Array, dofs: NDArray[np.int64], into: Complex) -> Complex:
        """Displacement of some freedoms per modal loads ``into`` (n_states, k), (n_omega, n_dofs, k)."""
        out = self.velocity_shapes[dofs]
        s = 1j * np.asarray(omega)
        gain = 1.0 / (s[:, None] - self.poles)
        mobility = (out * gain[:, None, :]) @ into
        return np.asarray(mobility / s[:, None, None])


def times(matrix: Array, motion: Complex) -> Complex:
    """A real matrix times complex columns or a vector, without a complex copy of the matrix."""
    return np.asarray(matrix @ motion.real + 1j * (matrix @ motion.imag))


def modal_form(inertia: Array, damping: Array, stiffness: Array, rigid: Array) -> ModalForm:
    """Complex modes of a system with rigid shapes.

    inertia, damping, stiffness : (n, n) [kg m2], [N m s/rad], [N m/rad]; damping may have a gyroscopic, stiffness a
    skew part, which does not act on rigid motion
    rigid : (n, n_shapes) candidates; only the combinations of them that the stiffness does not resist are rigid, so
    that a line that is tied to ground or to another by a mesh has none
    """
    modes = real_modes(inertia, stiffness, rigid)
    n, n_rigid = modes.shapes.shape[0], modes.n_rigid
    n_elastic = n - n_rigid
    # states: frequency * elastic displacement, elastic velocity, rigid velocity (all of one unit)
    shapes = np.roll(modes.shapes, -n_rigid, axis=1)
    frequency = modes.frequencies[n_rigid:]
    state = np.zeros((n_elastic + n, n_elastic + n))
    state[:n_elastic, n_elastic : 2 * n_elastic] = np.diag(frequency)
    squared = modes.squared[n_rigid:]
    state[n_elastic : 2 * n_elastic, :n_elastic] = -np.diag(squared / frequency)
    state[n_elastic:, n_elastic:] = -shapes.T @ damping @ shapes
    skew = 0.5 * (stiffness - stiffness.T)
    if skew.any():
        state[n_elastic : 2 * n_elastic, :n_elastic] -= (
            shapes[:, :n_elastic].T @ skew @ (shapes[:, :n_elastic] / frequency)
        )
    poles, right = np.linalg.eig(state)  # numpy's, a quarter faster than scipy's
    loads = np.vstack((np.zeros((n_elastic, n)), shapes.T))
    return ModalForm(
        poles=np.asarray(poles, complex),
        velocity_shapes=times(shapes, right[n_elastic:]),
        loads=np.asarray(np.linalg.solve(right, loads), complex),
        rigid=modes.shapes[:, :n_rigid],
    )


def known_modal_form(inertia: Array, damping: Array, stiffness: Array, rigid: Array) -> ModalForm:
    """As `modal_form`; matrices met before are not solved again: of systems that differ in one bearing or shaft all
    branches but one are the same."""
    matrices = (inertia, damping, stiffness, rigid)
    content = sha256(b"".join(repr(matrix.shape).encode() + matrix.tobytes() for matrix in matrices)).digest()
    return kept_as((modal_form, content), lambda: modal_form(*matrices))


@dataclass(frozen=True, kw_only=True)
class RealModes:
    """Mass-normalised real modes of the symmetric part of the stiffness, undamped.

    shapes : (n, n), the rigid ones first
    squared : (n,) omega^2, exactly 0 for these [1/s2]; below 0 where the symmetric part of a film pushes
    frequencies : (n,) [rad/s] that scale the displacements, 0 for the rigid ones, else sqrt(|omega^2|), not below
        `SLOWEST`
    """

    shapes: Array
    squared: Array
    frequencies: Array
    n_rigid: int


def real_modes(inertia: Array, stiffness: Array, rigid: Array) -> RealModes:
    """Real modes with exact rigid ones; arguments as of ``modal_form``."""
    root = np.linalg.cholesky(inertia)
    symmetric = 0.5 * (stiffness + stiffness.T)
    scaled = solve_triangular(root, solve_triangular(root, symmetric, lower=True).T, lower=True)
    still = root.T @ _not_resisted(rigid, symmetric)
    n, n_rigid = still.shape
    whole = np.linalg.qr(still, mode="complete")[0] if n_rigid else np.eye(n)
    rest = whole[:, n_rigid:]
    reduced = rest.T @ scaled @ rest
    squares, vectors = eigh(0.5 * (reduced + reduced.T))
    basis = np.hstack([whole[:, :n_rigid], rest @ vectors])
    return RealModes(
        shapes=np.asarray(solve_triangular(root, basis, lower=True, trans="T"), float),
        squared=np.concatenate([np.zeros(n_rigid), squares]),
        frequencies=np.concatenate([np.zeros(n_rigid), np.maximum(np.sqrt(np.abs(squares)), SLOWEST)]),
        n_rigid=n_rigid,
    )


def _not_resisted(rigid: Array, stiffness: Array) -> Array:
    """(n, n_rigid) combinations of the candidates that the stiffness does not resist."""
    scale = float(np.max(np.diag(stiffness), initial=1e-300))
    rigid = rigid[:, np.any(rigid != 0.0, axis=0)]
    values, vectors = np.linalg.eigh(rigid.T @ stiffness @ rigid)
    return np.asarray(rigid @ vectors[:, np.abs(values) < 1e-9 * scale])


# Directions of mesh forces beside the line of action of the flank that carries.
#
# The ports of a mesh (`LinearSystem.mesh_ports`) hold the torques of its gears and the lateral force that goes with a
# normal force on the flanks that carry. What else the teeth press needs directions of its own: friction acts across the
# line of action, the torque from the change of the path turns a gear alone, the other flank has another normal.


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshWrench:
    """Rows on the freedoms of a system that see no rigid rotation, and no motion of both gears as one.

    turns : (n_meshes, 2, n) turns of pinion and wheel from their centre line less those of their ports [rad]
    slide : (n_meshes, n) slide of the pinion flank over the wheel's as both move along their centre line [m]
    tangents : (n_meshes,) of the working transverse pressure angles
    sides : (n_meshes,) flank on whose normal the ports see the gears: 1 in front, -1 on the back
    """

    turns: Array
    slide: Array
    tangents: Array
    sides: Array

    def friction_rows(self, laws: Sequence[MeshLaw]) -> Array:
        """(2 n_meshes, n) what torques of friction on pinion and wheel act on beside their ports: each with the
        force across the line of action that both make, their difference over the length T1T2 of the line."""
        rows = []
        for turns, slide, side, law in zip(self.turns, self.slide, self.sides, laws, strict=True):
            across = side * slide / line_length(law)
            rows += [turns[0] + across, turns[1] - across]
        return np.array(rows)

    def loads(self, laws: Sequence[MeshLaw]) -> Array:
        """Columns (n, 3 n_meshes): both friction rows of every mesh, then slides."""
        return np.vstack((self.friction_rows(laws), self.slide)).T

    @property
    def displaced(self) -> Array:
        """Rows (2 n_meshes, n) of slides, then of turns of the pinions beyond those of their ports."""
        return np.vstack((self.slide, self.turns[:, 0]))

    def numbers(self, laws: Sequence[MeshLaw]) -> Array:
        """(n_meshes, 5) plain numbers for the march: side, torques on both friction rows per path torque on the
        pinion less that torque, twice the tangent of the pressure angle, force across per difference of torques."""
        rows = []
        for side, tangent, law in zip(self.sides, self.tangents, laws, strict=True):
            length = line_length(law)
            part = tangent / (1.0 + tangent**2) / length
            rows.append(
                [
                    side,
                    -part * law.base_radius_1,
                    part * law.base_radius_2,
                    2.0 * tangent,
                    -2.0 * side / length,
                ]
            )
        return np.array(rows)


def line_length(law: MeshLaw) -> float:
    """Length T1T2 of the line of action between the base circles [m]."""
    return law.rolling_radius_1 + law.rolling_radius_2


Integers = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Coordinates:
    """Coordinates in which the matrices of a system fall into blocks: eta, with freedoms q = freedoms @ eta.

    freedoms : (n, n); inertia, damping, stiffness : (n, n) in these coordinates; rigid : (n, n_rigid)
    """

    freedoms: Array
    inertia: Array
    damping: Array
    stiffness: Array
    rigid: Array

    @cached_property
    def branches(self) -> Integers:
        """Number of the branch of each coordinate (n,): those between which nothing but a mesh acts are apart."""
        tied = (self.inertia != 0.0) | (self.damping != 0.0) | (self.stiffness != 0.0)
        tied |= self.rigid @ self.rigid.T != 0.0
        return np.asarray(connected_components(csr_matrix(tied), directed=False)[1], np.int64)

    @cached_property
    def form(self) -> ModalForm:
        """Complex modes of the system as its freedoms see them, branch by branch."""
        forms = []
        for branch in np.unique(self.branches):
            own = np.flatnonzero(self.branches == branch)
            block = np.ix_(own, own)
            form = known_modal_form(
                self.inertia[block], self.damping[block], self.stiffness[block], self.rigid[own]
            )
            forms.append(form.seen(self.freedoms[:, own]))
        return ModalForm(
            poles=np.concatenate([form.poles for form in forms]),
            velocity_shapes=np.hstack([form.velocity_shapes for form in forms]),
            loads=np.vstack([form.loads for form in forms]),
            rigid=np.hstack([form.rigid for form in forms]),
        )


@dataclass(frozen=True, kw_only=True)
class LinearSystem:
    """M q'' + C q' + K q = external loads + mesh reactions.

    The freedoms are the rotations of a torsional drivetrain [rad], each positive in the running direction of its own
    shaft, or generalised freedoms of a reduced elastic one. Whatever is seen from outside, the gears in their meshes,
    the drive, the ends of couplings, is a freedom of its own. The meshes are outside: without them each shaft line is
    free to turn, a rigid shape that K does not resist.

    inertia : (n, n) M, symmetric and positive definite [kg m2]
    damping : (n, n) [N m s/rad], joints and (if modelled linear) bearing drag; its skew part is gyroscopic
    stiffness : (n, n) [N m/rad]; its skew part is that of lubricant films
    dofs : name of each freedom, ``shaft/station``
    mesh_ports : (n_meshes, 2) freedoms of pinion and wheel of each mesh: how far their flanks move along the line of
        action, over the base radius [rad]
    rigid : (n, n_rigid) exact rigid shapes, each of freedoms that nothing ties to those of another
    drive_dof : freedom on which the motor torque acts
    twist_load : (n,) torque on each freedom per radian of bracing twist (zero sum) [N m/rad]
    drag_loads : name -> (n,) share of a drag torque that acts on each freedom, summing to -1 (drag opposes
        rotation); one entry per loss place that brakes (bearing, windage, seal)
    periodic_loads : loads that alternate with the rotation of a shaft
    own_coordinates : in which the matrices fall into more blocks than in the freedoms, where there are such
    mesh_wrench : directions of tooth forces beside those of the ports; None where gears only rotate
    """

    inertia: Array
    damping: Array
    stiffness: Array
    dofs: tuple[str, ...]
    mesh_ports: Integers
    rigid: Array
    drive_dof: int
    twist_load: Array
    drag_loads: dict[str, Array]
    periodic_loads: tuple[PeriodicLoad, ...] = ()
    own_coordinates: Coordinates | None = None
    mesh_wrench: MeshWrench | None = None

    def at(self, speed: float) -> "LinearSystem":
        """Itself: these matrices hold at every speed [rad/s]."""
        return self

    @cached_property
    def coordinates(self) -> Coordinates:
        """Coordinates of the eigenproblems: its own, else the freedoms themselves."""
        return self.own_coordinates or Coordinates(
            freedoms=np.eye(len(self.inertia)),
            inertia=self.inertia,
            damping=self.damping,
            stiffness=self.stiffness,
            rigid=self.rigid,
        )

    @property
    def form(self) -> ModalForm:
        """Complex modes without the meshes, solved once for all speeds and iterations."""
        return self.coordinates.form

    @cached_property
    def branches(self) -> Integers:
        """Number of the branch of each freedom (n,): that of its largest coordinate."""
        inner = self.coordinates
        return np.asarray(inner.branches[np.argmax(np.abs(inner.freedoms), axis=1)], np.int64)


def line_shapes(lines: Integers) -> Array:
    """Rigid shapes (n, n_lines) of freedoms that turn together, from the number of the shaft line of each (n,)."""
    return np.asarray(lines[:, None] == np.unique(lines), float)


# A drivetrain whose matrices depend on its speed: gyroscopic moments, stiffness and damping of the bearings.


class DrivetrainOverSpeed(Protocol):
    """Matrices of a drivetrain at any speed; all of them of the same freedoms."""

    def at(self, speed: float) -> LinearSystem:
        """Matrices at a speed of the pinion of the first mesh [rad/s]."""


@dataclass(frozen=True, kw_only=True)
class SpeedBands:
    """Bands of speed with constant matrices each.

    limits : (n - 1,) speeds of the pinion of the first mesh at which the bands meet, rising [rad/s]
    systems : (n,) matrices of each band, of the same freedoms

    Raises DynamicsInputError if numbers or freedoms do not agree.
    """

    limits: tuple[float, ...]
    systems: tuple[LinearSystem, ...]

    def __post_init__(self) -> None:
        if len(self.systems) != len(self.limits) + 1 or sorted(set(self.limits)) != list(self.limits):
            raise DynamicsInputError(
                f"{len(self.systems)} speed bands with limits {self.limits} rad/s: must be one limit less than bands, "
                "rising"
            )
        if any(system.dofs != self.systems[0].dofs for system in self.systems):
            raise DynamicsInputError("speed bands: systems have different freedoms; reduce them on one basis")

    def at(self, speed: float) -> LinearSystem:
        """Matrices of the band in which a speed lies [rad/s]."""
        return self.systems[bisect_right(self.limits, speed)]

"""The loop linearised about a motion that repeats from mesh to mesh, and its equations for one class of orders.

The tangents of the meshes repeat with the mesh period, so that they couple an order only to those that differ from it
by whole mesh orders. Unknowns of such a class are the harmonics of the approach of every mesh; outside the meshes the
drivetrain enters as its exact receptance.

Source: Hill's infinite determinant for linear equations with periodic coefficients (Nayfeh & Mook, Nonlinear
Oscillations, 1979, 5.2.3), here forced.
"""

from collections.abc import Sequence
from math import floor, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.static_loop import port_model
from dynamics.mesh.force import evaluate_mesh
from dynamics.mesh.law import MeshLaw
from dynamics.orders.tooth_excitation import Motion
from dynamics.response.harmonic_equations import input_torques
from dynamics.response.harmonic_newton import mesh_inputs
from dynamics.response.response_curve import CurvePoint

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

SAME_CLASS = 1e-7
"""Difference of two orders, in mesh orders, below which they are of one class."""
ANGLE_STEPS = 2
"""Corrections for the angle of the pinion, which moves the tangents along the path: each a per cent of the last, up to
a fifth where a loop runs slowly enough to turn as a whole."""


class MeshPeriodic:
    """Tangents and torques over one period of a motion with all teeth alike.

    phi is the mean angle of the pinion of the first mesh, zero where its pair 0 stands at the path position ``phase``
    of its law. A cell is the period: a whole number of mesh periods of every mesh.

    base : the motion; speed : of the pinion of the first mesh [rad/s]; start : phi at the first sample [rad]
    cell_order : cells per turn of that pinion; meshes : (n_meshes,) mesh periods of each mesh in a cell
    model : its ports; bodies : (n_bodies,) freedoms of the gear bodies; inputs : (n_meshes, k) of `mesh_inputs`
    approach : (n_meshes, n_bodies) approach per angle [m/rad]
    waves : (3, n_meshes, k, n) derivatives of the torques on the inputs over approach, its rate and pinion angle; those
        of friction beside the ports over the angle are left out
    torque : (n_inputs, n) harmonics of the torques on the inputs, those of order h at index h
    """

    def __init__(
        self, system: LinearSystem, ideal: Sequence[MeshLaw], base: CurvePoint, *, twist_held: bool
    ) -> None:
        """Linearise about ``base``, found for the laws ``ideal`` with all teeth alike."""
        self.system, self.ideal, self.twist_held = system, tuple(ideal), twist_held
        self.base = base
        self._classes: dict[tuple[float, int], HillSystem] = {}
        self.model = port_model(system, self.ideal)
        self.packed = self.model.packed
        wave = base.wave
        self.speed = base.speed
        self.bodies = self.model.dofs[: self.model.n_bodies]
        self.inputs = mesh_inputs(self.model)
        self.n_inputs = len(self.model.loads)
        self.approach = self.model.approach[:, :-1]
        self.motions = tuple(
            Motion(*map(np.ascontiguousarray, of_mesh))
            for of_mesh in zip(wave.angle, wave.approach, wave.omega_1, wave.omega_2)
        )
        self.samples = wave.time.size
        step = float(wave.time[1] - wave.time[0])
        self.cell_order = 2.0 * pi / (self.samples * step * self.speed)
        ratios = wave.omega_1.mean(axis=1) / self.speed
        self.meshes = np.array(
            [round(law.teeth_1 * ratio / self.cell_order) for law, ratio in zip(self.ideal, ratios)]
        )
        self.start = float(np.mean(wave.angle[0] - self.speed * step * np.arange(self.samples)))
        self._into = system.form.into(self.model.loads)
        self._linearise()

    def _linearise(self) -> None:
        torque = np.zeros((self.n_inputs, self.samples))
        self.waves = np.zeros((3, *self.inputs.shape, self.samples))
        for m, (packed, motion) in enumerate(zip(self.packed, self.motions)):
            reaction = evaluate_mesh(packed, *motion)
            acting = np.array(input_torques(self.model, m, reaction))
            np.add.at(torque, self.inputs[m], acting[:, 0])
            self.waves[:2, m] = acting[:, 1:].swapaxes(0, 1)
            self.waves[2, m, :2] = reaction.torque_1_per_angle, reaction.torque_2_per_angle
        self.torque = self.harmonics(torque)
        self._tangent = self.harmonics(self.waves)

    def on_inputs(self, m: int, outputs: Complex) -> Complex:
        """What torques on pinion and wheel and the normal force times the base radius of the pinion (3, ...) of a mesh
        are on its inputs (k, ...)."""
        first, second, normal = outputs
        ratio = self.ideal[m].base_radius_2 / self.ideal[m].base_radius_1
        return np.array([first, second, first + normal, second - ratio * normal])[: self.inputs.shape[1]]

    def loads(self, torque: Complex) -> Complex:
        """Loads on all freedoms (n,) of torques on the inputs (n_inputs,)."""
        return np.asarray(self.model.loads.T @ torque, np.complex128)

    def harmonics(self, values: Array | Complex, residue: float | Array = 0.0) -> Complex:
        """Two-sided coefficients (..., n) in phi, of order h at index h, of samples (..., n) over one cell.

        With a residue, or one for each row, they are those of exp(-i residue cell_order phi) times the values.
        """
        n = values.shape[-1]
        if np.any(residue):
            phi = self.start + 2.0 * pi / (n * self.cell_order) * np.arange(n)
            values = values * np.exp(-1j * residue * self.cell_order * phi)
        number = np.fft.fftfreq(n, 1.0 / n)
        return np.asarray(
            np.fft.fft(values, axis=-1) / n * np.exp(-1j * number * self.cell_order * self.start)
        )

    def residue(self, order: float) -> float:
        """Class of an order: what is left of it, in cell orders, above the next lower whole one."""
        share = order / self.cell_order
        left = share - floor(share + SAME_CLASS)
        return 0.0 if abs(left) < SAME_CLASS else left

    def omega(self, residue: float, reach: int) -> Array:
        """Frequencies of a class, cell orders -reach to reach beyond the residue [rad/s]."""
        return np.asarray((np.arange(-reach, reach + 1) + residue) * self.cell_order * self.speed)

    def receptance(self, omega: Array, rows: Array | None = None) -> Complex:
        """Of the bodies to the inputs and to loads on rows (k, n) of all freedoms, (n, n_bodies, n_inputs + k).

        At signed frequencies (n,); nothing at frequency zero.
        """
        still = omega == 0.0
        form, size = self.system.form, np.where(still, 1.0, np.abs(omega))
        into = self._into if rows is None else np.hstack([self._into, form.into(rows)])
        found = form.receptance_to(size, self.bodies, into)
        found = np.where((omega < 0.0)[:, None, None], found.conj(), found)
        found[still] = 0.0
        return np.asarray(found)

    def tangent(self, reach: int) -> Complex:
        """(3, n_meshes, k, n, n) harmonics of the torques per harmonics of approach, rate and pinion angle."""
        number = np.arange(-reach, reach + 1)
        return np.asarray(self._tangent[..., np.subtract.outer(number, number)])

    def classes(self, residues: Sequence[float], reach: int) -> "list[HillSystem]":
        """Equations of some classes without further loads, each made once."""
        left = [residue for residue in residues if (residue, reach) not in self._classes]
        if left:
            tangent, n = self.tangent(reach), 2 * reach + 1
            omega = np.concatenate([self.omega(residue, reach) for residue in left])
            receptance = self.receptance(omega).reshape(len(left), n, self.bodies.size, -1)
            for residue, own in zip(left, receptance):
                self._classes[residue, reach] = HillSystem(self, residue, tangent, own)
        return [self._classes[residue, reach] for residue in residues]


class ClassSolution(NamedTuple):
    """Two-sided changes of one class at cell orders -reach to reach beyond its residue.

    torque : (n_loads, n) on the inputs [N m], then of the further loads; approach : (n_meshes, n) [m]
    angle : (n_meshes, n) of the pinions, their mean left out [rad]
    """

    torque: Complex
    approach: Complex
    angle: Complex


class HillSystem:
    """Equations of one class of orders, factorised once."""

    def __init__(self, loop: MeshPeriodic, residue: float, tangent: Complex, receptance: Complex) -> None:
        """Prepare a class.

        tangent : ``loop.tangent(reach)``; receptance : at ``loop.omega(residue, reach)``, of the bodies to the inputs
        and to further loads
        """
        self.loop, self.n = loop, tangent.shape[-1]
        reach = self.n // 2
        self.omega = loop.omega(residue, reach)
        self.still = reach if residue == 0.0 else -1
        self.n_meshes, self.n_bodies = len(loop.ideal), loop.bodies.size
        self.tangent = tangent[0] + tangent[1] * (1j * self.omega)
        self.per_angle = tangent[2]
        self.gain = loop.approach @ receptance[:, : self.n_bodies]
        self.pinion = receptance[:, loop.inputs[:, 0]]
        split = self.gain[:, :, loop.inputs].transpose(1, 0, 2, 3)[..., None]
        size = self.n_meshes * self.n
        block = sum(split[:, :, :, k] * self.tangent[:, k].swapaxes(0, 1) for k in range(split.shape[3]))
        block = np.eye(size) - np.asarray(block).reshape(size, size)
        self.factors = lu_factor(block if self.still < 0 else self._with_mean(block), check_finite=False)

    def solve(self, forces: Complex, given: Complex) -> ClassSolution:
        """Answer to what acts on the inputs of each mesh (n_meshes, k, n) and on inputs and rows (n_loads, n) [N m]."""
        acting = forces
        for step in range(ANGLE_STEPS + 1):
            torque = given.copy()
            np.add.at(torque, self.loop.inputs, acting)
            known = (self.gain @ torque.T[:, :, None])[:, :, 0].T.ravel()
            approach = self._solve(known, torque[: self.loop.n_inputs], acting)
            np.add.at(torque, self.loop.inputs, (self.tangent @ approach[:, None, :, None])[..., 0])
            angle = (self.pinion @ torque.T[:, :, None])[:, :, 0].T
            if step < ANGLE_STEPS:
                acting = forces + (self.per_angle @ angle[:, None, :, None])[..., 0]
        return ClassSolution(torque, approach, angle)

    def _solve(self, known: Complex, torque: Complex, acting: Complex) -> Complex:
        load = known if self.still < 0 else self._load(known, torque, acting)
        found = lu_solve(self.factors, load, check_finite=False)
        return np.asarray(found[: self.n_meshes * self.n].reshape(self.n_meshes, self.n))

    def _with_mean(self, block: Complex) -> Complex:
        """The class of the mean: with the mean windup of all freedoms, drive torque and twist as further unknowns."""
        loop, size, still = self.loop, self.n_meshes * self.n, self.still
        system = loop.system
        ports, dofs = system.mesh_ports, len(system.inertia)
        at = np.arange(self.n_meshes) * self.n + still
        matrix = np.zeros((size + dofs + 2, size + dofs + 2), complex)
        matrix[:size, :size] = block
        matrix[at] = 0.0
        matrix[at, at] = 1.0
        for m, law in enumerate(loop.ideal):
            matrix[at[m], size + ports[m]] = -law.base_radius_1, law.base_radius_2
        self.scale = float(np.abs(system.stiffness).max())
        matrix[size : size + dofs, size : size + dofs] = system.stiffness / self.scale
        for m, inputs in enumerate(loop.inputs):
            for at_input, row in zip(inputs, self.tangent[m, :, still] / self.scale):
                load = np.outer(loop.model.loads[at_input], row)
                matrix[size : size + dofs, m * self.n : (m + 1) * self.n] -= load
        matrix[size + system.drive_dof, size + dofs] = -1.0
        matrix[size : size + dofs, size + dofs + 1] = -system.twist_load / self.scale
        matrix[size + dofs, size + system.drive_dof] = 1.0
        if loop.twist_held:
            matrix[size + dofs + 1, size + dofs + 1] = 1.0
        else:
            matrix[size + dofs + 1, : self.n] = self.tangent[0, 0, still] / self.scale
        return matrix

    def _load(self, known: Complex, torque: Complex, acting: Complex) -> Complex:
        loop, size, dofs = self.loop, self.n_meshes * self.n, len(self.loop.system.inertia)
        load = np.zeros(size + dofs + 2, complex)
        load[:size] = known
        load[np.arange(self.n_meshes) * self.n + self.still] = 0.0
        load[size : size + dofs] = loop.loads(torque[:, self.still]) / self.scale
        if not loop.twist_held:
            # the mean torque on the first pinion stays
            load[-1] = -acting[0, 0, self.still] / self.scale
        return load

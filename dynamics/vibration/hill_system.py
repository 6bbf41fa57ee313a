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
from scipy.sparse import csr_array

from dynamics.kernels.contact import CELLS_AT, CLOSING, DAMP_TIME, LEAST_GAP, N_CELLS, PackedMeshes
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import port_model
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.vibration.harmonic_balance import input_torques, mesh_inputs
from dynamics.vibration.response_curve import CurvePoint

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
        receptance = form.receptance_to(size, self.bodies, into)
        receptance = np.where((omega < 0.0)[:, None, None], receptance.conj(), receptance)
        receptance[still] = 0.0
        return np.asarray(receptance)

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
            for residue, of_class in zip(left, receptance):
                self._classes[residue, reach] = HillSystem(self, residue, tangent, of_class)
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
        solution = lu_solve(self.factors, load, check_finite=False)
        return np.asarray(solution[: self.n_meshes * self.n].reshape(self.n_meshes, self.n))

    def _with_mean(self, block: Complex) -> Complex:
        """The class of the mean: with the mean windup of all freedoms, drive torque and twist as further unknowns."""
        loop, size, still = self.loop, self.n_meshes * self.n, self.still
        system = loop.system
        ports, dofs = system.mesh_ports, len(system.inertia)
        means = np.arange(self.n_meshes) * self.n + still
        matrix = np.zeros((size + dofs + 2, size + dofs + 2), complex)
        matrix[:size, :size] = block
        matrix[means] = 0.0
        matrix[means, means] = 1.0
        for m, law in enumerate(loop.ideal):
            matrix[means[m], size + ports[m]] = -law.base_radius_1, law.base_radius_2
        self.scale = float(np.abs(system.stiffness).max())
        matrix[size : size + dofs, size : size + dofs] = system.stiffness / self.scale
        for m, inputs in enumerate(loop.inputs):
            for port, row in zip(inputs, self.tangent[m, :, still] / self.scale):
                load = np.outer(loop.model.loads[port], row)
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


# How the torques of a mesh answer to what single teeth deviate: sensitivity of every contact along a known motion.
#
# All teeth of the law are alike. Along a motion that repeats from mesh to mesh, a gap ``e_j(s)`` added to tooth j and a
# relative change ``q_j`` of its stiffness change each torque ``a`` (pinion, wheel, normal force) in first order by
#
#     sum over pairs p and slices i of  a_e e_j(s_pi) + a_e' e_j'(s_pi) + a_q q_j
#
# The contacts are those of ``dynamics.kernels.contact``, whose formulas are differentiated here. Where the pairs share
# a body, what a tooth deviates changes the force on it and so the approach that all pairs see.

Integers = NDArray[np.int64]

OUTPUTS = 3
"""Torque on the pinion, torque on the wheel [N m], front less back force times the pinion's base radius [N m]."""


class Motion(NamedTuple):
    """Motion of one mesh, each (n,): pinion angle [rad], approach with its offset [m], speeds [rad/s]."""

    angle: Array
    approach: Array
    omega_1: Array
    omega_2: Array


class PairSensitivity(NamedTuple):
    """Answer of each output to what one tooth pair deviates on one flank, at n places of a motion.

    first : number of the first pair in the tables
    pairs : pairs in the tables
    gap : OUTPUTS tables (pairs n, n_path): per gap at the points of the path [N m/m]
    gap_slope : the same per slope of the gap along the path [N m]
    scale : (OUTPUTS, pairs, n) per relative change of stiffness [N m]
    """

    first: int
    pairs: int
    gap: tuple[csr_array, ...]
    gap_slope: tuple[csr_array, ...]
    scale: Array


def pair_sensitivity(
    law: MeshLaw, packed: PackedMeshes, motion: Motion, *, back: bool = False
) -> PairSensitivity | None:
    """Return the sensitivities of all pairs that touch along a motion, front or back; None if none touches.

    law : with all teeth alike (``alike_teeth``); packed : the same, ``pack_meshes([law])``
    """
    sign = -1.0 if back else 1.0
    if law.body_compliance > 0.0:
        motion = motion._replace(approach=evaluate_mesh(packed, *motion).tooth_approach)
    contacts = _contacts(law, packed, motion, sign)
    if contacts is None or not contacts.pair.size:
        return None
    if law.body_compliance > 0.0:
        contacts = _through_body(law, contacts, _contacts(law, packed, motion, -sign), sign)
    n, n_path = motion.angle.size, law.stiffness.shape[1]
    first = int(contacts.pair.min())
    pairs = int(contacts.pair.max()) - first + 1
    row, share = (contacts.pair - first) * n + contacts.sample, contacts.fraction
    rows, columns = np.concatenate([row, row]), np.concatenate([contacts.cell, contacts.cell + 1])
    weight = np.concatenate([1.0 - share, share])

    def spread(values: Array) -> tuple[csr_array, ...]:
        return tuple(
            csr_array((np.tile(value, 2) * weight, (rows, columns)), shape=(pairs * n, n_path))
            for value in values
        )

    scale = np.array([np.bincount(row, value, pairs * n) for value in contacts.per_scale]).reshape(
        OUTPUTS, pairs, n
    )
    return PairSensitivity(first, pairs, spread(contacts.per_gap), spread(contacts.per_gap_slope), scale)


class ToothPattern(NamedTuple):
    """What the teeth of one gear deviate from their mean on one flank, as waves over the teeth.

    waves : (n_waves,) number of each wave, 0 to teeth - 1: tooth j has the factor exp(2 pi i wave j / teeth)
    gap : (n_waves, n_path) [m]; scale : (n_waves,) [-]
    """

    teeth: int
    waves: Integers
    gap: Complex
    scale: Complex


def tooth_pattern(deviation: Array, scale: Array, teeth: int, waves: Integers) -> ToothPattern:
    """Return waves of the tables ``deviation_1``, ``scale_1`` (2, back) of a law, the mean over all teeth left out."""
    waves = np.asarray(waves, np.int64) % teeth
    phase_shift = np.exp(-2j * np.pi / teeth * np.outer(waves, np.arange(teeth))) / teeth
    phase_shift[waves == 0] = 0.0
    gap = (
        phase_shift @ deviation
        if len(deviation) == teeth
        else np.zeros((waves.size, deviation.shape[1]), complex)
    )
    relative = scale / scale.mean() - 1.0
    part = phase_shift @ relative if len(scale) == teeth else np.zeros(waves.size, complex)
    return ToothPattern(teeth, waves, np.asarray(gap, complex), np.asarray(part, complex))


def excitation(
    sensitivity: PairSensitivity, law: MeshLaw, pattern: ToothPattern, first_tooth: int
) -> Complex:
    """Return the outputs (OUTPUTS, n_waves, n) that each wave over the teeth adds along the motion.

    first_tooth : tooth of this gear in pair 0 (of the wheel ``tooth_offset_2`` in front, the next one on the back)
    """
    n = sensitivity.scale.shape[2]
    pair = sensitivity.first + np.arange(sensitivity.pairs) + first_tooth
    phase_shift = np.exp(2j * np.pi / pattern.teeth * np.outer(pattern.waves, pair))
    gap_slope = np.gradient(pattern.gap, law.path_step, axis=1)
    out = np.empty((OUTPUTS, pattern.waves.size, n), complex)
    for output in range(OUTPUTS):
        along = np.asarray(
            sensitivity.gap[output] @ pattern.gap.T + sensitivity.gap_slope[output] @ gap_slope.T
        )
        wave = along.reshape(sensitivity.pairs, n, pattern.waves.size)
        wave = wave + sensitivity.scale[output][:, :, None] * pattern.scale
        out[output] = np.einsum("wp,pnw->wn", phase_shift, wave)
    return out


class _Contacts(NamedTuple):
    """Touching contacts of one flank: sample, pair, cell of the path and place in it, and their sensitivities."""

    sample: Integers
    pair: Integers
    cell: Integers
    fraction: Array
    stiffness: Array
    depth: Array
    per_gap: Array
    per_gap_slope: Array
    per_scale: Array


def _through_body(law: MeshLaw, contacts: _Contacts, other: _Contacts | None, sign: float) -> _Contacts:
    """The contacts of one flank with what their deviations do to all others by way of the shared body."""
    n = int(max(flank.sample.max(initial=-1) for flank in (contacts, other) if flank is not None)) + 1
    per_approach, stiffness = np.zeros((OUTPUTS, n)), np.zeros(n)
    for flank, side in ((contacts, sign), (other, -sign)):
        if flank is not None:
            stiffness += np.bincount(flank.sample, flank.stiffness, n)
            per_approach -= side * np.array([np.bincount(flank.sample, row, n) for row in flank.per_gap])
    given = law.body_compliance * per_approach / (1.0 + law.body_compliance * stiffness)
    moved = sign * given[:, contacts.sample] * contacts.stiffness
    return contacts._replace(
        per_gap=contacts.per_gap + moved, per_scale=contacts.per_scale - moved * contacts.depth
    )


def _contacts(law: MeshLaw, packed: PackedMeshes, motion: Motion, sign: float) -> _Contacts | None:
    """Contacts of one flank (sign +1 front, -1 back); None if none touches."""
    within = sign * motion.approach - (law.backlash if sign < 0.0 else 0.0)
    if not np.any(within > packed.values[0, LEAST_GAP]):
        return None
    n_cells = int(packed.counts[0, N_CELLS])
    pitch = law.base_pitch / law.path_step
    origin = (law.phase if sign > 0.0 else law.back_phase) - law.path_start
    travel = origin + sign * law.base_radius_1 * motion.angle[:, None] - sign * law.slice_shift
    whole = travel / law.path_step
    turn = np.floor(whole / pitch)
    later = np.arange(int(np.ceil(n_cells / pitch)))[:, None, None]
    place = whole - turn * pitch + later * pitch
    listed, sample, piece = np.nonzero(place < n_cells)
    place = place[listed, sample, piece]
    pair = (sign * (turn[sample, piece] - listed)).astype(np.int64)
    cell = np.minimum(place.astype(np.int64), n_cells - 1)
    f = place - cell
    c = packed.cells[packed.counts[0, CELLS_AT] + piece * n_cells + cell].T
    gap = c[4] + f * (c[5] + f * (c[6] + f * c[7]))
    reach = within[sample]
    near = reach > gap
    sample, pair, cell, f, c, reach, gap = (
        sample[near],
        pair[near],
        cell[near],
        f[near],
        c[:, near],
        reach[near],
        gap[near],
    )
    stiffness = c[0] + f * (c[1] + f * (c[2] + f * c[3]))
    stiffness_slope = (c[1] + f * (2.0 * c[2] + 3.0 * f * c[3])) / law.path_step
    gap_slope = (c[5] + f * (2.0 * c[6] + 3.0 * f * c[7])) / law.path_step
    s = law.path_start + (cell + f) * law.path_step
    omega_1, omega_2 = motion.omega_1[sample], motion.omega_2[sample]
    damp_time = packed.values[0, DAMP_TIME]
    closes = packed.values[0, CLOSING]
    path_speed = closes * sign * law.base_radius_1 * omega_1
    closing = damp_time * (
        sign * (law.base_radius_1 * omega_1 - law.base_radius_2 * omega_2) - gap_slope * path_speed
    )
    depth = reach - gap
    partly = depth < law.damping_depth
    grown = np.where(partly, depth / law.damping_depth, 1.0)
    grown_slope = np.where(partly, 1.0 / law.damping_depth, 0.0)
    pressed = depth + grown * closing
    k = np.where(pressed > 0.0, stiffness, 0.0)
    rho_1, rho_2 = law.rolling_radius_1 + s, law.rolling_radius_2 - s
    ratio = np.clip((omega_1 * rho_1 - omega_2 * rho_2) / max(law.friction_reversal_speed, 1e-9), -1.0, 1.0)
    rub = sign * law.friction * ratio * (1.5 - 0.5 * ratio**2)
    lever_1 = 1.0 - gap_slope + rub * rho_1 / law.base_radius_1
    lever_2 = 1.0 + rub * rho_2 / law.base_radius_2
    force, force_gap = k * pressed, -k * (1.0 + grown_slope * closing)
    force_slope = -k * grown * damp_time * path_speed
    damped, damped_gap, rotation = force - stiffness * depth, force_gap + stiffness, 1.0 - closes
    lever = rotation * gap_slope
    r_1, r_2 = -sign * law.base_radius_1, sign * law.base_radius_2
    none = np.zeros_like(force)
    return _Contacts(
        sample, pair, cell, f, stiffness, depth,
        np.array([
            r_1 * (force_gap * lever_1 + damped_gap * lever - stiffness_slope * depth), r_2 * force_gap * lever_2,
            -r_1 * force_gap,
        ]),
        np.array([
            r_1 * (force_slope * (lever_1 + lever) - force + damped * rotation), r_2 * force_slope * lever_2,
            -r_1 * force_slope,
        ]),
        np.array([
            r_1 * (force * lever_1 + damped * lever + 0.5 * stiffness_slope * depth**2), r_2 * force * lever_2,
            -r_1 * force,
        ]) + none,
    )  # fmt: skip

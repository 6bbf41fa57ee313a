"""Orders of the loop from deviations of single teeth and from harmonic torques: Hill's method about a periodic motion.

With all teeth alike the loop settles to a motion that repeats from mesh to mesh. Teeth that differ a little from each
other, and torques of any order, move it by ``dx``, which obeys in first order

    d tau = T_x(t) dx + T_v(t) dx' + T_theta(t) d theta + sum over the contacts of what their teeth deviate,

with tangents ``T`` of the mesh period. A wave over the teeth of one gear excites the orders of one residue class,
wave + multiples of the mesh order, and the tangents couple the orders of that class only: one small linear system per
class, as large as the meshes times the harmonics. Outside the meshes the drivetrain enters as its exact receptance.
Contacts that open or close by the deviations are left out; so is what they do to the mean state.

Source: Hill's infinite determinant for linear equations with periodic coefficients (Nayfeh & Mook, Nonlinear
Oscillations, 1979, 5.2.3), here forced.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, floor, pi

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve

from dynamics.linear_system import LinearSystem
from dynamics.mesh_force import evaluate_mesh, pack_meshes
from dynamics.mesh_law import MeshLaw
from dynamics.mesh_tables import has_individual_teeth
from dynamics.response_curve import CurvePoint
from dynamics.tooth_excitation import (
    Motion,
    PairSensitivity,
    excitation,
    mean_teeth,
    pair_sensitivity,
    tooth_pattern,
)

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

SAME_CLASS = 1e-7
"""Difference of two orders, in mesh orders, below which they are of one residue class."""
LEAST_HARMONICS, MARGIN = 12, 8
"""Mesh harmonics on both sides at least, and beyond the highest order asked for."""
ANGLE_STEPS = 2
"""Corrections for the angle of the pinion, which moves the tangents along the path; each is a per cent of the last."""


@dataclass(frozen=True, kw_only=True)
class HarmonicTorque:
    """Torque Re(amplitude exp(i order phi)) on one freedom [N m]; order per turn of the pinion of the first mesh."""

    dof: int
    order: float
    amplitude: complex


@dataclass(frozen=True, kw_only=True)
class OrderLoads:
    """Loads of one order on the linear drivetrain, one-sided amplitudes [N m]; phase zero as in DeviationResponse.

    order : per turn of the pinion of the first mesh; omega [rad/s]
    dofs : (n,) freedoms that are loaded; torque : (n,)
    """

    order: float
    omega: float
    dofs: Integers
    torque: Complex


class DeviationResponse:
    """Linear response about a periodic motion of one operating point.

    phi is the mean angle of the pinion of the first mesh, zero where its pair 0 is at the path position ``phase`` of
    its law.
    """

    def __init__(
        self, system: LinearSystem, laws: Sequence[MeshLaw], base: CurvePoint, *, twist_held: bool = False
    ) -> None:
        """Take the motion of ``base``, found for the laws with all teeth alike (``mean_teeth``), over one mesh period.

        laws : with their deviations; twist_held : the twist is held and not the mean torque of the first mesh
        """
        self.system, self.laws, self.base, self.twist_held = system, tuple(laws), base, twist_held
        wave = base.wave
        self.speed = base.speed
        self.bodies = np.array(list(dict.fromkeys(system.mesh_ports.ravel().tolist())), np.int64)
        place = {int(dof): i for i, dof in enumerate(self.bodies)}
        self.sides = np.array([[place[int(dof)] for dof in ports] for ports in system.mesh_ports])
        self.approach = np.zeros((len(self.laws), self.bodies.size))
        for m, law in enumerate(self.laws):
            self.approach[m, self.sides[m]] = law.base_radius_1, -law.base_radius_2
        self.motions = tuple(
            Motion(*map(np.ascontiguousarray, of_mesh))
            for of_mesh in zip(wave.angle, wave.approach, wave.omega_1, wave.omega_2)
        )
        n = wave.time.size
        step = float(wave.time[1] - wave.time[0])
        self.cell_order = 2.0 * pi / (n * step * self.speed)
        self.meshes = np.array([round(float(law.teeth_1 * mean) / (self.cell_order * self.speed))
                                for law, mean in zip(self.laws, wave.omega_1.mean(axis=1))])  # fmt: skip
        self.start = float(np.mean(wave.angle[0] - self.speed * step * np.arange(n)))
        self._tangents()

    def _tangents(self) -> None:
        """Torques on the gear bodies and tangents of the meshes over the period, as harmonics of the mesh order."""
        n = self.base.wave.time.size
        torque = np.zeros((self.bodies.size, n))
        tangent = np.empty((3, len(self.laws), 2, n))
        self.ideal = tuple(mean_teeth(law) if has_individual_teeth(law) else law for law in self.laws)
        self.packed = tuple(pack_meshes([law]) for law in self.ideal)
        for m, (packed, motion) in enumerate(zip(self.packed, self.motions)):
            reaction = evaluate_mesh(packed, *motion)
            torque[self.sides[m, 0]] += reaction.torque_1
            torque[self.sides[m, 1]] += reaction.torque_2
            tangent[0, m] = reaction.torque_1_per_approach, reaction.torque_2_per_approach
            tangent[1, m] = reaction.torque_1_per_rate, reaction.torque_2_per_rate
            tangent[2, m] = reaction.torque_1_per_angle, reaction.torque_2_per_angle
        self.torque = self._harmonics(torque)
        self.tangent = self._harmonics(tangent)
        self._sensitivities: dict[int, PairSensitivity] = {}

    def _harmonics(self, values: NDArray[np.generic]) -> Complex:
        """Two-sided harmonics of the cell (..., n) in phi, index h modulo n."""
        n = values.shape[-1]
        number = np.fft.fftfreq(n, 1.0 / n)
        turned = np.exp(-1j * number * self.cell_order * self.start)
        return np.asarray(np.fft.fft(values, axis=-1) / n * turned)

    def loads(self, orders: Iterable[float], torques: Sequence[HarmonicTorque] = ()) -> list[OrderLoads]:
        """Loads on the drivetrain at each order (per turn of the pinion of the first mesh, >= 0).

        torques : further torques on any freedoms

        Raises ValueError for an order or a torque of negative order.
        """
        wanted = [float(order) for order in orders]
        if min(wanted, default=0.0) < 0.0 or any(not torque.order > 0.0 for torque in torques):
            raise ValueError("orders must not be negative, those of torques above 0; turn the phase instead")
        classes: dict[float, list[int]] = {}
        for index, order in enumerate(wanted):
            classes.setdefault(self._residue(order), []).append(index)
        outer = np.array(sorted({torque.dof for torque in torques} - set(self.bodies.tolist())), np.int64)
        dofs = np.concatenate([self.bodies, outer])
        found: dict[int, OrderLoads] = {}
        for residue, members in classes.items():
            highest = max(abs(wanted[index]) for index in members) / self.cell_order
            reach = min(max(LEAST_HARMONICS, ceil(highest) + MARGIN), (self.base.wave.time.size - 1) // 4)
            number = np.arange(-reach, reach + 1)
            change = self._class(residue, number, dofs, torques)
            for index in members:
                h = round(wanted[index] / self.cell_order - residue)
                if abs(h) > reach:
                    raise ValueError(
                        f"order {wanted[index]:g}: above the highest harmonic {reach} of the mesh; take the base "
                        "solution with more samples"
                    )
                torque = change[:, reach + h].copy()
                if residue == 0.0:
                    torque[: self.bodies.size] += self.torque[:, h]
                found[index] = OrderLoads(
                    order=wanted[index], omega=wanted[index] * self.speed, dofs=dofs,
                    torque=torque * (2.0 if wanted[index] else 1.0),
                )  # fmt: skip
        return [found[index] for index in range(len(wanted))]

    def _residue(self, order: float) -> float:
        """Class of an order: what is left of it, in mesh orders, above the next lower multiple."""
        share = order / self.cell_order
        left = share - floor(share + SAME_CLASS)
        return 0.0 if abs(left) < SAME_CLASS else left

    def _class(
        self, residue: float, number: Integers, dofs: Integers, torques: Sequence[HarmonicTorque]
    ) -> Complex:
        """Changes of the torques on ``dofs`` (n_dofs, n_number), two-sided, of one residue class."""
        given = np.zeros((dofs.size, number.size), complex)
        self._add_torques(given, residue, number, dofs, torques)
        forces = np.zeros((len(self.laws), 2, number.size), complex)
        for m in range(len(self.laws)):
            for side in range(2):
                self._add_teeth(forces, m, side, residue, number)
        if not (np.any(given) or np.any(forces)):
            return given
        omega = (number + residue) * self.cell_order * self.speed
        still = omega == 0.0
        receptance = self._receptance(np.where(still, 1.0, omega), dofs)
        receptance[still] = 0.0
        return _HillSystem(self, number, omega, receptance).solve(forces, given)

    def _receptance(self, omega: Array, dofs: Integers) -> Complex:
        """(n, n_dofs, n_dofs) at signed frequencies, none zero."""
        found = self.system.form.receptance(np.abs(omega), dofs)
        return np.where((omega < 0.0)[:, None, None], found.conj(), found)

    def _add_torques(
        self,
        given: Complex,
        residue: float,
        number: Integers,
        dofs: Integers,
        torques: Sequence[HarmonicTorque],
    ) -> None:
        for torque in torques:
            for sign in (1.0, -1.0):
                share = sign * torque.order / self.cell_order - residue
                h = round(share)
                if abs(share - h) < SAME_CLASS and abs(h) <= number[-1]:
                    amplitude = 0.5 * (torque.amplitude if sign > 0.0 else torque.amplitude.conjugate())
                    given[int(np.flatnonzero(dofs == torque.dof)[0]), h - number[0]] += amplitude

    def _add_teeth(self, forces: Complex, m: int, side: int, residue: float, number: Integers) -> None:
        """Add to ``forces`` (n_meshes, 2, n_number) what the teeth of one gear excite in a class."""
        law = self.laws[m]
        teeth, deviation, scale, offset = (
            (law.teeth_1, law.deviation_1, law.scale_1, 0),
            (law.teeth_2, law.deviation_2, law.scale_2, law.tooth_offset_2),
        )[side]
        if len(deviation) == 1 and len(scale) == 1:
            return
        waves = np.arange(1, teeth)
        off = waves * self.meshes[m] / teeth - residue
        waves = waves[np.abs(off - np.round(off)) < SAME_CLASS]
        pattern = tooth_pattern(deviation, scale, teeth, waves)
        if not (np.any(pattern.gap) or np.any(pattern.scale)):
            return
        if m not in self._sensitivities:
            self._sensitivities[m] = pair_sensitivity(self.ideal[m], self.packed[m], self.motions[m])
        added = excitation(self._sensitivities[m], self.ideal[m], pattern, offset).sum(axis=1)
        n = added.shape[-1]
        phi = self.start + 2.0 * pi / (n * self.cell_order) * np.arange(n)
        forces[m] += self._harmonics(added[:2] * np.exp(-1j * residue * self.cell_order * phi))[:, number]


class _HillSystem:
    """Linear system of one residue class, factorised once."""

    def __init__(self, whole: DeviationResponse, number: Integers, omega: Array, receptance: Complex) -> None:
        self.whole, self.number, self.omega, self.receptance = whole, number, omega, receptance
        self.n_meshes, self.n = len(whole.laws), number.size
        self.n_bodies = whole.bodies.size
        lag = np.subtract.outer(number, number)
        stiff, damp, self.turned = (part[:, :, lag] for part in whole.tangent)
        self.tangent = stiff + damp * (1j * omega)
        self.gain = np.einsum("mb,kbj->kmj", whole.approach, receptance[:, : self.n_bodies])
        split = self.gain[:, :, whole.sides]
        size = self.n_meshes * self.n
        block = np.eye(size) - np.einsum("kamp,mpkl->akml", split, self.tangent, optimize=True).reshape(
            size, size
        )
        self.still = np.flatnonzero(omega == 0.0)
        self.factors = lu_factor(self._with_mean(block) if self.still.size else block)

    def solve(self, forces: Complex, given: Complex) -> Complex:
        """Torque changes on all loaded freedoms (n_dofs, n) from mesh forces (n_meshes, 2, n) and given torques."""
        whole = self.whole
        pinions = whole.sides[:, 0]
        acting = forces
        torque = given
        for step in range(ANGLE_STEPS + 1):
            if step:
                angle = np.einsum("kbj,jk->bk", self.receptance[:, pinions], torque)
                acting = forces + np.einsum("mpkl,ml->mpk", self.turned, angle)
            torque = given.copy()
            self._add_to_bodies(torque, acting)
            known = np.einsum("kmj,jk->mk", self.gain, torque).ravel()
            approach = self._solve(known, torque[: self.n_bodies])
            self._add_to_bodies(torque, np.einsum("mpkl,ml->mpk", self.tangent, approach))
        return torque

    def _add_to_bodies(self, torque: Complex, of_mesh: Complex) -> None:
        np.add.at(torque, self.whole.sides, of_mesh)

    def _solve(self, known: Complex, torque: Complex) -> Complex:
        size = self.n_meshes * self.n
        if self.still.size:
            return np.asarray(
                lu_solve(self.factors, self._load(known, torque))[:size].reshape(self.n_meshes, self.n)
            )
        return np.asarray(lu_solve(self.factors, known).reshape(self.n_meshes, self.n))

    def _with_mean(self, block: Complex) -> Complex:
        """The class that holds the mean: with the mean windup of all freedoms, drive torque and twist beside it."""
        whole, size = self.whole, self.n_meshes * self.n
        system, ports = whole.system, whole.system.mesh_ports
        dofs = system.inertia.size
        at = np.arange(self.n_meshes) * self.n + int(self.still[0])
        matrix = np.zeros((size + dofs + 2, size + dofs + 2), complex)
        matrix[:size, :size] = block
        matrix[at] = 0.0
        matrix[at, at] = 1.0
        for m, law in enumerate(whole.laws):
            matrix[at[m], size + ports[m]] = -law.base_radius_1, law.base_radius_2
        rest = slice(size, size + dofs)
        scale = float(np.abs(system.stiffness).max())
        matrix[rest, rest] = system.stiffness / scale
        for m in range(self.n_meshes):
            columns = slice(m * self.n, (m + 1) * self.n)
            for side in range(2):
                matrix[size + ports[m, side], columns] -= self.tangent[m, side, self.still[0]] / scale
        matrix[size + system.drive_dof, size + dofs] = -1.0 / scale
        matrix[rest, size + dofs + 1] = -system.twist_load / scale
        matrix[size + dofs, size + system.drive_dof] = 1.0
        if whole.twist_held:
            matrix[size + dofs + 1, size + dofs + 1] = 1.0
        else:
            matrix[size + dofs + 1, : self.n] = self.tangent[0, 0, self.still[0]] / scale
        self._scale = scale
        return matrix

    def _load(self, known: Complex, torque: Complex) -> Complex:
        size, dofs = self.n_meshes * self.n, self.whole.system.inertia.size
        load = np.zeros(size + dofs + 2, complex)
        load[:size] = known
        load[np.arange(self.n_meshes) * self.n + int(self.still[0])] = 0.0
        load[size + self.whole.bodies] = torque[:, self.still[0]] / self._scale
        return load


def motion_orders(system: LinearSystem, loads: OrderLoads, dofs: Sequence[int]) -> Complex:
    """One-sided amplitudes of the angles of some freedoms under the loads of an order above 0 (n_dofs,) [rad]."""
    asked = np.asarray(dofs, np.int64)
    together = np.concatenate([asked, loads.dofs])
    receptance = system.form.receptance(np.array([loads.omega]), together)[0]
    return np.asarray(receptance[: asked.size, asked.size :] @ loads.torque)


def mean_windup(
    system: LinearSystem, torque: Mapping[int, float], *, twist: float, drive: float, speed: Array,
    drags: Mapping[str, float],
) -> Array:  # fmt: skip
    """Mean windup of all freedoms (n,) [rad] under mean torques; each line against its own first freedom.

    torque : mean of mesh torque by freedom [N m]; twist : bracing [rad]; drive : motor torque [N m]; speed : (n,)
    mean speed of every freedom [rad/s]; drags : torque by name of ``drag_loads`` [N m]
    """
    load = system.twist_load * twist - system.damping @ speed
    for dof, value in torque.items():
        load[dof] += value
    load[system.drive_dof] += drive
    for name, value in drags.items():
        load = load + system.drag_loads[name] * value
    windup = np.zeros(system.inertia.size)
    for line in np.unique(system.lines):
        own = np.flatnonzero(system.lines == line)[1:]
        windup[own] = np.linalg.solve(system.stiffness[np.ix_(own, own)], load[own])
    return windup

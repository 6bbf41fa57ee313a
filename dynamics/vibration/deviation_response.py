"""Orders of the loop from deviations of single teeth and from harmonic torques.

With all teeth of a gear alike the loop reaches a motion that repeats from mesh to mesh. Teeth that differ a little
from each other, and torques of any order, move it by ``dx``, which obeys in first order

    d tau = T_x(t) dx + T_v(t) dx' + T_theta(t) d theta + sum over the contacts of what their teeth deviate,

with tangents ``T`` of the mesh period (``dynamics.vibration.hill_system``). A wave over the teeth of one gear excites
one class of orders, wave + multiples of the tooth number. What the first order leaves out, contacts that open, close
or carry another share, is added as forces over the cycle of the gear (``dynamics.orders.tooth_cycle``).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, gcd
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.linear_system import LinearSystem
from dynamics.tooth.law import MeshLaw, back_deviations
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.tooth.mesh_laws import alike_teeth
from dynamics.tooth.packed_laws import pack_meshes
from dynamics.vibration.harmonic_balance import input_torques
from dynamics.vibration.hill_system import (
    SAME_CLASS,
    ClassSolution,
    HillSystem,
    MeshPeriodic,
    Motion,
    PairSensitivity,
    excitation,
    pair_sensitivity,
    tooth_pattern,
)
from dynamics.vibration.response_curve import CurvePoint

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]


# Forces of unequal teeth on the linear equations of the loop, class of orders by class.

Flanks = tuple[PairSensitivity | None, PairSensitivity | None]


class ToothForcing:
    """First-order forces of unequal teeth on the gears of each mesh, class by class.

    gears : (mesh, 0 pinion or 1 wheel) of the gears whose teeth are not alike
    """

    def __init__(self, laws: Sequence[MeshLaw], loop: MeshPeriodic) -> None:
        self.laws, self.loop = tuple(laws), loop
        self.gears = [(m, side) for m, law in enumerate(self.laws) for side in range(2) if _differ(law, side)]
        self._sensitivities: dict[int, Flanks] = {}

    def none(self, reach: int) -> Complex:
        """No forces (n_meshes, k, 2 reach + 1)."""
        return np.zeros((*self.loop.inputs.shape, 2 * reach + 1), complex)

    def of_class(self, residue: float, number: Integers) -> Complex:
        """Forces of all gears in a class (n_meshes, k, n_number), two-sided [N m]."""
        forces = self.none(int(number[-1]))
        for m, side in self.gears:
            teeth = _teeth(self.laws[m], side).number
            waves = np.arange(1, teeth)
            off = waves * self.loop.meshes[m] / teeth - residue
            waves = waves[np.abs(off - np.round(off)) < SAME_CLASS]
            if waves.size:
                excited = self._excitation(m, side, waves).sum(axis=1)
                forces[m] += self.loop.harmonics(excited, residue)[:, number]
        return forces

    def of_cycle(self, m: int, side: int, cells: int, number: Integers) -> Complex:
        """Forces of one gear in the classes 0, 1 / cells ... up to a half (n_classes, k, n_number)."""
        teeth = _teeth(self.laws[m], side).number
        waves = np.arange(1, teeth)
        place = waves * int(self.loop.meshes[m]) * cells // teeth % cells
        waves, place = waves[2 * place <= cells], place[2 * place <= cells]
        excited = self._excitation(m, side, waves)
        forces = np.zeros((cells // 2 + 1, self.loop.inputs.shape[1], number.size), complex)
        values = self.loop.harmonics(excited, place[:, None] / cells)[..., number]
        np.add.at(forces, place, values.swapaxes(0, 1))
        return forces

    def _excitation(self, m: int, side: int, waves: Integers) -> Complex:
        """Torques on the inputs by each wave over the teeth of a gear (k, n_waves, n) along the cell."""
        excited = np.zeros((self.loop.inputs.shape[1], waves.size, self.loop.samples), complex)
        for back, sensitivity in enumerate(self._sensitivity(m)):
            if sensitivity is not None:
                teeth = _teeth(self.laws[m], side, bool(back))
                pattern = tooth_pattern(teeth.deviation, teeth.scale, teeth.number, waves)
                outputs = excitation(sensitivity, self.loop.ideal[m], pattern, teeth.first)
                excited += self.loop.on_inputs(m, outputs)
        return excited

    def _sensitivity(self, m: int) -> Flanks:
        """What the pairs of a mesh answer, front and back."""
        if m not in self._sensitivities:
            law, packed, motion = self.loop.ideal[m], self.loop.packed[m], self.loop.motions[m]
            self._sensitivities[m] = (
                pair_sensitivity(law, packed, motion),
                pair_sensitivity(law, packed, motion, back=True),
            )
        return self._sensitivities[m]


class _Teeth(NamedTuple):
    """Teeth of one gear on one flank: their number, tables of the law, and the tooth in pair 0."""

    number: int
    deviation: Array
    scale: Array
    first: int


def _teeth(law: MeshLaw, side: int, back: bool = False) -> _Teeth:
    deviations = back_deviations(law) if back else (law.deviation_1, law.deviation_2)
    if side == 0:
        return _Teeth(law.teeth_1, deviations[0], law.scale_1, 0)
    return _Teeth(law.teeth_2, deviations[1], law.scale_2, law.tooth_offset_2 + back)


def _differ(law: MeshLaw, side: int) -> bool:
    front, back = (_teeth(law, side, behind) for behind in (False, True))
    return any(bool(np.any(table != table[0])) for table in (front.deviation, back.deviation, front.scale))


# Contact forces beyond first order over the cycle of a gear with unequal teeth.
#
# Over the turns after which the same tooth of the gear stands at the same place of the mesh period, the true torques of
# the teeth along the motion found so far, less the tangents times its change, are forces on the linear equations that
# give the next motion: Newton's method with the tangent of the equal teeth, accelerated. Gears of the same cycle are
# taken together; gears of different cycles each alone, so that their joint effect beyond first order is left
# out.


REACH = 12
"""Mesh harmonics on both sides in the corrections."""
CONVERGED = 1e-2
"""Change of the approach, relative to its whole deviation, at which the corrections end [-]."""
HISTORY = 8
"""Earlier answers that the next motion is combined from (Anderson)."""


class CycleForces(NamedTuple):
    """Forces of the gears of one cycle on the linear equations, tooth deviations included.

    cells : mesh periods in the cycle; spectrum : (n_meshes, k, cells n) two-sided, order j / cells of the cell at j
    change : by which the approach still moved in the last step, relative to its whole deviation [-]
    """

    cells: int
    spectrum: Complex
    change: float

    def of_class(self, residue: float, number: Integers) -> Complex:
        """Forces of a class (n_meshes, k, n_number); zero where the cycle has no such orders."""
        share = residue * self.cells
        if abs(share - round(share)) > 1e-6:
            return np.zeros((*self.spectrum.shape[:2], number.size), complex)
        place = number * self.cells + round(share)
        inside = np.abs(place) < self.spectrum.shape[-1] // 2
        return np.asarray(np.where(inside, self.spectrum[..., place % self.spectrum.shape[-1]], 0.0))


def cycle_forces(loop: MeshPeriodic, forcing: ToothForcing, steps: int) -> tuple[CycleForces, ...]:
    """Forces beyond first order of every group of gears with unequal teeth.

    loop : motion with equal teeth and its tangents
    forcing : forces of the tooth deviations, first order
    steps : corrections at most, at least 1; they end when the approach changes by less than CONVERGED
    """
    groups: dict[int, list[tuple[int, int]]] = {}
    for m, side in forcing.gears:
        teeth = (forcing.laws[m].teeth_1, forcing.laws[m].teeth_2)[side]
        groups.setdefault(teeth // gcd(teeth, int(loop.meshes[m])), []).append((m, side))
    return tuple(_Cycle(loop, forcing, cells, gears).run(steps) for cells, gears in groups.items())


class _Cycle:
    """The loop over one cycle, sampled in phi."""

    def __init__(
        self, loop: MeshPeriodic, forcing: ToothForcing, cells: int, gears: list[tuple[int, int]]
    ) -> None:
        self.loop, self.cells = loop, cells
        self.reach = min(REACH, (loop.samples - 1) // 4)
        self.n = loop.samples
        self.packed = [
            pack_meshes([_with_teeth(loop.ideal[m], forcing.laws[m], gears, m)])
            for m in range(len(loop.ideal))
        ]
        self.waves = np.tile(loop.waves, cells)
        cell = np.repeat(np.arange(cells), self.n) * 2.0 * np.pi
        self.base = []
        for law, meshes, motion in zip(loop.ideal, loop.meshes, loop.motions):
            angle, *others = (np.tile(values, cells) for values in motion)
            self.base.append(Motion(angle + cell * (meshes / law.teeth_1), *others))
        known = np.empty((*loop.inputs.shape, self.n))
        for m, packed in enumerate(loop.packed):
            reaction = evaluate_mesh(packed, *(values[: self.n] for values in self.base[m]))
            known[m] = [torque for torque, *_ in input_torques(loop.model, m, reaction)]
        self.known = np.tile(known, cells)
        number = np.arange(-self.reach, self.reach + 1)
        self.number = number
        classes = np.arange(cells // 2 + 1) / cells
        self.systems = loop.classes(classes.tolist(), self.reach)
        self.first = np.zeros((classes.size, *loop.inputs.shape, number.size), complex)
        for m, side in gears:
            self.first[:, m] += forcing.of_cycle(m, side, cells, number)

    def run(self, steps: int) -> CycleForces:
        """Correct the forces until the motion stays, at most so many times."""
        count = self.cells * self.n
        order = np.fft.fftfreq(count, 1.0 / count) / self.cells
        shift = np.exp(-1j * order * self.loop.cell_order * self.loop.start) / count
        classes = np.arange(self.cells // 2 + 1) / self.cells
        motion = self._answer(self.first)
        mixing = _Mixing()
        result = CycleForces(self.cells, np.zeros(0, complex), np.inf)
        for _ in range(steps):
            spectrum = np.fft.fft(self._beyond(*motion), axis=-1) * shift
            result = CycleForces(self.cells, spectrum, 0.0)
            answer = self._answer([result.of_class(float(residue), self.number) for residue in classes])
            moved, whole = (float(np.abs(values).max()) for values in (answer[0] - motion[0], answer[0]))
            result = result._replace(change=moved / max(whole, 1e-300))
            if result.change < CONVERGED:
                break
            motion = mixing.next(motion, answer)
        return result

    def _answer(self, forces: Sequence[Complex] | Complex) -> Array:
        """Motion that forces of every class (n_classes, n_meshes, k, n_number) make, see `_in_time`."""
        nothing = np.zeros((self.loop.n_inputs, self.number.size), complex)
        return self._in_time(
            [system.solve(of_class, nothing) for system, of_class in zip(self.systems, forces)]
        )

    def _in_time(self, solutions: Sequence[ClassSolution]) -> Array:
        """Changes of approach, its rate, pinion angle and pinion speed over the cycle (4, n_meshes, count)."""
        loop, count = self.loop, self.cells * self.n
        spectra = np.zeros((4, len(loop.ideal), count), complex)
        for j, (system, solution) in enumerate(zip(self.systems, solutions)):
            place = self.number * self.cells + j
            values = np.stack(
                (
                    solution.approach,
                    1j * system.omega * solution.approach,
                    solution.angle,
                    1j * system.omega * solution.angle,
                )
            )
            spectra[..., place % count] = values
            if j > 0 and 2 * j != self.cells:
                spectra[..., -place % count] = values.conj()
        order = np.fft.fftfreq(count, 1.0 / count) / self.cells
        shifted = spectra * np.exp(1j * order * loop.cell_order * loop.start)
        return np.asarray(np.fft.ifft(shifted, axis=-1).real * count)

    def _beyond(self, approach: Array, rate: Array, angle: Array, speed: Array) -> Array:
        """True torques less those of equal teeth and tangents times change (n_meshes, k, count)."""
        forces = np.empty(self.known.shape)
        for m, (law, packed) in enumerate(zip(self.loop.ideal, self.packed)):
            theta_1, reach, omega_1, omega_2 = self.base[m]
            slower = (law.base_radius_1 * speed[m] - rate[m]) / law.base_radius_2
            reaction = evaluate_mesh(
                packed, theta_1 + angle[m], reach + approach[m], omega_1 + speed[m], omega_2 + slower
            )
            forces[m] = [torque for torque, *_ in input_torques(self.loop.model, m, reaction)]
        linear = (
            self.waves[0] * approach[:, None] + self.waves[1] * rate[:, None] + self.waves[2] * angle[:, None]
        )
        return np.asarray(forces - self.known - linear)


class _Mixing:
    """Next motion from the ones before and their answers (D. G. Anderson, J. ACM 12, 1965).

    Where a tooth is much weaker than the mean the plain step comes closer by a share only.
    """

    def __init__(self) -> None:
        self._before: list[tuple[Array, Array]] = []

    def next(self, motion: Array, answer: Array) -> Array:
        """Combination of the answers whose approach would be missed least."""
        miss = (answer - motion)[0].ravel()
        self._before = [*self._before, (answer, miss)][-HISTORY:]
        if len(self._before) == 1:
            return answer
        steps = np.array([miss - old for _, old in self._before[:-1]])
        shares = np.linalg.lstsq(steps @ steps.T, steps @ miss, rcond=1e-10)[0]
        return np.asarray(
            answer - sum(share * (answer - old) for share, (old, _) in zip(shares, self._before[:-1]))
        )


def _with_teeth(ideal: MeshLaw, law: MeshLaw, gears: list[tuple[int, int]], m: int) -> MeshLaw:
    """The law in which only the teeth of some gears deviate from their mean."""
    if (m, 0) in gears:
        ideal = ideal._replace(
            deviation_1=_from_mean(law.deviation_1), back_deviation_1=_from_mean(law.back_deviation_1),
            scale_1=law.scale_1 / law.scale_1.mean(),
        )  # fmt: skip
    if (m, 1) in gears:
        ideal = ideal._replace(
            deviation_2=_from_mean(law.deviation_2), back_deviation_2=_from_mean(law.back_deviation_2),
            scale_2=law.scale_2 / law.scale_2.mean(),
        )  # fmt: skip
    return ideal


@overload
def _from_mean(table: Array) -> Array: ...


@overload
def _from_mean(table: None) -> None: ...


def _from_mean(table: Array | None) -> Array | None:
    """What each tooth deviates from the mean of all."""
    return None if table is None else np.asarray(table - table.mean(axis=0))


LEAST_HARMONICS, MARGIN = 20, 8
"""Harmonics of the cell on both sides at least, and beyond the highest order asked for; as its samples hold them.

Angles of a slow loop near the resonance of its meshes are within 3 % of those by 63 harmonics (12: 7 %), torques within
0.1 %."""
CYCLE_STEPS = 30
"""Steps at most that correct for what the contacts do beyond first order."""


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderTorque:
    """Load Re(amplitude exp(i order phi)) times one row; order per turn of the pinion of the first mesh.

    load : (n,) on each freedom per unit of the amplitude
    """

    load: Array
    order: float
    amplitude: complex


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderLoads:
    """Loads of one order on the linear drivetrain, one-sided amplitudes [N m].

    order : per turn of the pinion of the first mesh; omega [rad/s]
    torque : (n,) on every freedom
    """

    order: float
    omega: float
    torque: Complex


class DeviationResponse:
    """Response of one operating point to its deviations, about the motion with all teeth alike.

    phi is the mean angle of the pinion of the first mesh, zero where its pair 0 stands at the path position ``phase``
    of its law.
    """

    def __init__(
        self,
        system: LinearSystem,
        laws: Sequence[MeshLaw],
        base: CurvePoint | MeshPeriodic,
        *,
        twist_held: bool = False,
        steps: int = CYCLE_STEPS,
    ) -> None:
        """Linearise about ``base``, found for the laws with all teeth alike (``alike_teeth``), over one mesh period.

        base : or what was linearised about it before, of the same drivetrain and laws but for what turns with a gear
        laws : with their deviations; twist_held : the twist is held and not the mean torque of the first mesh
        steps : corrections beyond first order; 0 is the linear response
        """
        self.laws, self.steps = tuple(laws), steps
        self.loop = base if isinstance(base, MeshPeriodic) else linearised(system, laws, base, twist_held)
        self.forcing = ToothForcing(self.laws, self.loop)

    @cached_property
    def cycles(self) -> tuple[CycleForces, ...]:
        """Forces of each group of gears that comes round in the same cycle; empty in the linear response."""
        return cycle_forces(self.loop, self.forcing, self.steps) if self.steps else ()

    @property
    def change(self) -> float:
        """By how much the approach still moved in the last correction, relative to its whole deviation [-]."""
        return max((cycle.change for cycle in self.cycles), default=0.0)

    def loads(self, orders: Iterable[float], torques: Sequence[OrderTorque] = ()) -> list[OrderLoads]:
        """Loads on the drivetrain at each order (per turn of the pinion of the first mesh, >= 0).

        torques : further loads, in first order

        Raises DynamicsInputError for a negative order, a torque without a positive one, or an order above the samples.
        """
        loop = self.loop
        wanted = [float(order) for order in orders]
        if min(wanted, default=0.0) < 0.0 or any(not torque.order > 0.0 for torque in torques):
            raise DynamicsInputError(
                "orders must not be negative, those of torques above 0; shift the phase instead"
            )
        highest = max((round(order / loop.cell_order) for order in wanted), default=0)
        reach = max(LEAST_HARMONICS, ceil(highest) + MARGIN)
        most = (loop.samples - 1) // 4
        if highest > most:
            raise DynamicsInputError(
                f"order {max(wanted):g}: above {most} mesh orders of {loop.cell_order:g}, the most that "
                f"{loop.samples} samples of a mesh hold; ask for less"
            )
        reach = min(reach, most)
        tangent = loop.tangent(reach)
        changes: dict[float, _Class] = {}
        order_loads = []
        for order in wanted:
            residue = loop.residue(order)
            if residue not in changes:
                changes[residue] = self._class(residue, reach, torques, tangent)
            h = round(order / loop.cell_order - residue)
            of_class = changes[residue]
            torque = of_class.torque[:, reach + h].copy()
            if residue == 0.0:
                torque[: loop.n_inputs] += loop.torque[:, h]
            whole = loop.loads(torque[: loop.n_inputs])
            for row, amplitude in zip(of_class.rows, torque[loop.n_inputs :]):
                whole += amplitude * row
            sides = 2.0 if order else 1.0
            order_loads.append(OrderLoads(order=order, omega=order * loop.speed, torque=sides * whole))
        return order_loads

    def _class(
        self, residue: float, reach: int, torques: Sequence[OrderTorque], tangent: Complex
    ) -> "_Class":
        """Changes of the loads of one class."""
        number = np.arange(-reach, reach + 1)
        waves = [(torque, self._wave(residue, number, torque)) for torque in torques]
        waves = [(torque, wave) for torque, wave in waves if np.any(wave)]
        rows = np.array([torque.load for torque, _ in waves]).reshape(-1, len(self.loop.system.inertia))
        inputs = np.zeros((self.loop.n_inputs, number.size), complex)
        given = np.vstack([inputs, *(wave for _, wave in waves)])
        if self.steps:
            forces = sum(
                (cycle.of_class(residue, number) for cycle in self.cycles), start=self.forcing.none(reach)
            )
        else:
            forces = self.forcing.of_class(residue, number)
        if not (np.any(given) or np.any(forces)):
            return _Class(given, rows)
        if not len(rows):
            (known,) = self.loop.classes([residue], reach)
            return _Class(known.solve(forces, given).torque, rows)
        receptance = self.loop.receptance(self.loop.omega(residue, reach), rows)
        return _Class(HillSystem(self.loop, residue, tangent, receptance).solve(forces, given).torque, rows)

    def _wave(self, residue: float, number: Integers, torque: OrderTorque) -> Complex:
        """Two-sided amplitudes of a further load in a class (1, n)."""
        wave = np.zeros((1, number.size), complex)
        for sign in (1.0, -1.0):
            share = sign * torque.order / self.loop.cell_order - residue
            h = round(share)
            if abs(share - h) < SAME_CLASS and abs(h) <= number[-1]:
                amplitude = torque.amplitude if sign > 0.0 else torque.amplitude.conjugate()
                wave[0, h - number[0]] += 0.5 * amplitude
        return wave


class _Class(NamedTuple):
    """Changes of the loads of one class, two-sided.

    torque : (n_inputs + k, 2 reach + 1) on the inputs, then of k further loads; rows : (k, n) of these
    """

    torque: Complex
    rows: Array


def linearised(
    system: LinearSystem, laws: Sequence[MeshLaw], base: CurvePoint, twist_held: bool
) -> MeshPeriodic:
    """The loop about a motion with all teeth alike; arguments as of `DeviationResponse`."""
    return MeshPeriodic(system, [alike_teeth(law) for law in laws], base, twist_held=twist_held)


def mean_windup(
    system: LinearSystem,
    torque: Array,
    *,
    twist: float,
    drive: float,
    speed: Array,
    drags: Mapping[str, float],
) -> Array:
    """Mean windup of all freedoms (n,) [rad] under mean torques; no branch turned as a whole.

    torque : (n,) mean torque of the meshes [N m]; twist : bracing [rad]; drive : motor torque [N m]; speed : (n,)
    mean speed of every freedom [rad/s]; drags : torque by name of ``drag_loads`` [N m]
    """
    load = system.twist_load * twist - system.damping @ speed + torque
    load[system.drive_dof] += drive
    for name, value in drags.items():
        load = load + system.drag_loads[name] * value
    rigid, n_rigid = system.rigid, system.rigid.shape[1]
    scale = float(np.abs(system.stiffness).max())
    matrix = np.block([[system.stiffness / scale, rigid], [rigid.T, np.zeros((n_rigid, n_rigid))]])
    windup = np.linalg.solve(matrix, np.concatenate((load / scale, np.zeros(n_rigid))))
    return np.asarray(windup[: len(load)])

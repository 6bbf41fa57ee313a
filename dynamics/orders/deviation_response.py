"""Orders of the loop from deviations of single teeth and from harmonic torques.

With all teeth of a gear alike the loop reaches a motion that repeats from mesh to mesh. Teeth that differ a little
from each other, and torques of any order, move it by ``dx``, which obeys in first order

    d tau = T_x(t) dx + T_v(t) dx' + T_theta(t) d theta + sum over the contacts of what their teeth deviate,

with tangents ``T`` of the mesh period (``dynamics.orders.hill_system``). A wave over the teeth of one gear excites
one class of orders, wave + multiples of the tooth number. What the first order leaves out, contacts that open, close
or carry another share, is added as forces over the cycle of the gear (``dynamics.orders.tooth_cycle``).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.errors import DynamicsInputError
from dynamics.mesh.flank import alike_teeth
from dynamics.mesh.law import MeshLaw
from dynamics.orders.hill_system import SAME_CLASS, HillSystem, MeshPeriodic
from dynamics.orders.tooth_cycle import CycleForces, cycle_forces
from dynamics.orders.tooth_forcing import ToothForcing
from dynamics.response.response_curve import CurvePoint

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

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
        found = []
        for order in wanted:
            residue = loop.residue(order)
            if residue not in changes:
                changes[residue] = self._class(residue, reach, torques, tangent)
            h = round(order / loop.cell_order - residue)
            here = changes[residue]
            torque = here.torque[:, reach + h].copy()
            if residue == 0.0:
                torque[: loop.n_inputs] += loop.torque[:, h]
            whole = loop.loads(torque[: loop.n_inputs])
            for row, amplitude in zip(here.rows, torque[loop.n_inputs :]):
                whole += amplitude * row
            sides = 2.0 if order else 1.0
            found.append(OrderLoads(order=order, omega=order * loop.speed, torque=sides * whole))
        return found

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

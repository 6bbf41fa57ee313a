"""Steady states over speed: torques, factors and losses of one state, and the curve that they make."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import pi
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.graph import TwistRows
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import harmonic_loads, within_period
from dynamics.rotor.static_loop import LoopLoad, PortModel, line_ratios, port_model
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.vibration.harmonic_balance import (
    BalanceProblem,
    HarmonicGrid,
    HarmonicSolution,
    in_time,
    input_torques,
    mesh_inputs,
    motion_of_mesh,
)
from dynamics.vibration.speed_continuation import (
    LEAST_HARMONICS,
    LEAST_SAMPLES,
    mesh_cells,
    quasi_static_start,
)
from dynamics.vibration.steady_motion import PERIODIC, Motion, Period, PeriodicResponse

Array = NDArray[np.float64]


# One period of a harmonic solution in time: motions, torques and losses of every mesh.


@dataclass(frozen=True, kw_only=True)
class Waveform:
    """One period in time at the mean speed of the drive freedom.

    time : (n,) [s]; angle : (n_meshes, n) pinion angle; approach [m], omega_1, omega_2 [rad/s] : the same
    shape torque : (n_meshes, n) torque transmitted at the pinion, r_b1 (front - back force) [N m]
    touching : (n_meshes, n) False where no flank carries; friction_power, damping_power : (n_meshes,) mean
    [W]
    """

    time: Array
    angle: Array
    approach: Array
    omega_1: Array
    omega_2: Array
    torque: Array
    touching: NDArray[np.bool_]
    friction_power: Array
    damping_power: Array


def waveform(model: PortModel, solution: HarmonicSolution, samples: int | None = None) -> Waveform:
    """Mesh motions and torques over one period of a harmonic solution.

    model : the loop that was solved
    samples : per mesh period; default those of the grid
    """
    grid, speed = solution.grid, solution.speed
    count = grid.cells * (samples or grid.samples)
    base = speed * 2.0 * np.pi / (grid.cell_angle * grid.cells)
    time = np.arange(count, dtype=np.float64) * (2.0 * np.pi / base / count)
    motion, rate = in_time(solution.ports, base, count)
    shape = (model.n_meshes, count)
    angle, approach, omega_1, omega_2, torque = (np.empty(shape) for _ in range(5))
    touching = np.empty(shape, bool)
    friction, damping = np.empty(model.n_meshes), np.empty(model.n_meshes)
    for m, packed in enumerate(model.packed):
        moving = motion_of_mesh(model, m, speed, speed * time, motion, rate)
        angle[m], approach[m], omega_1[m], omega_2[m] = moving
        reaction = evaluate_mesh(packed, *moving)
        torque[m] = model.base_radii[m, 0] * (reaction.force_front - reaction.force_back)
        touching[m] = (reaction.force_front > 0.0) | (reaction.force_back > 0.0)
        friction[m], damping[m] = reaction.friction_power.mean(), reaction.damping_power.mean()
    return Waveform(
        time=time, angle=angle, approach=approach, omega_1=omega_1, omega_2=omega_2,
        torque=torque, touching=touching, friction_power=friction, damping_power=damping,
    )  # fmt: skip


Method = Literal["harmonic_balance", "time_integration", "quasi_static"]


@dataclass(frozen=True, kw_only=True)
class CurvePoint:
    """Steady periodic state at one mean speed.

    speed : of the pinion of the first mesh [rad/s]; method : how it was found; residual : relative, of that method
    motion : whether it repeats in the asked period, after several of them, or not at all; the statistics are then those
    of the periods that ``wave`` holds
    flank : (n_meshes,) +1 where the front flank carries the mean torque, -1 the back flank
    mean, maximum, minimum : (n_meshes,) torque transmitted at the pinion, positive in load direction [N m]
    harmonics : (n_meshes, n + 1) mean and amplitudes of that torque over the orders of the mesh frequency
    [N m]
    lift_off_share : (n_meshes,) share of the period without contact [-]
    twist : bracing twist [rad]; drive_torque : mean motor torque that balances all losses [N m]
    friction_power, damping_power : (n_meshes,) mean losses in the mesh [W]
    wave : the motion over one period, for root stress and plots
    solution : the state of the harmonic balance, from which a neighbour may start; None of a time integration
    """

    speed: float
    method: Method
    residual: float
    iterations: int
    flank: Array
    mean: Array
    maximum: Array
    minimum: Array
    harmonics: Array
    lift_off_share: Array
    twist: float
    drive_torque: float
    friction_power: Array
    damping_power: Array
    wave: Waveform = field(repr=False)
    motion: Motion = PERIODIC
    solution: HarmonicSolution | None = field(default=None, repr=False)

    @property
    def dynamic_factor(self) -> Array:
        """K_V = max / mean of every mesh (n_meshes,) [-] (P2, Formula 1).

        Raises DynamicsInputError for a mesh that carries no mean torque.
        """
        return np.asarray(self.maximum / self._loaded_mean())

    @property
    def dynamic_factor_half_peak_to_peak(self) -> Array:
        """K_V from half the peak-to-peak value, 1 + (max - min) / (2 mean) (n_meshes,) [-]."""
        return np.asarray(1.0 + 0.5 * (self.maximum - self.minimum) / self._loaded_mean())

    def _loaded_mean(self) -> Array:
        if not np.all(self.mean > 0.0):
            raise DynamicsInputError(
                f"mesh {int(np.argmin(self.mean))} carries no mean torque ({self.mean.min():.3g} N m) at "
                f"{self.speed:.4g} rad/s: K_V does not exist; brace the loop with more torque"
            )
        return self.mean


@dataclass(frozen=True, kw_only=True)
class ResponseCurve:
    """Points in the order of the speeds asked for; ``failed`` holds (speed [rad/s], reason) of the others.

    other_branch : where a second stable response exists at a speed, from which the motion does not come to the first
        without a jump
    unstable : speeds without a point at which harmonic balance found a response with contact loss that does not last:
        what lasts there does not repeat in the asked period, or lies on another branch [rad/s]
    """

    points: tuple[CurvePoint, ...]
    failed: tuple[tuple[float, str], ...]
    other_branch: tuple[CurvePoint, ...] = ()
    unstable: tuple[float, ...] = ()

    @property
    def speeds(self) -> Array:
        """Speeds of the points [rad/s]."""
        return np.array([point.speed for point in self.points])

    def dynamic_factor(self, mesh: int) -> Array:
        """K_V of one mesh over the points [-]."""
        return np.array([point.dynamic_factor[mesh] for point in self.points])


def point_of(model: PortModel, solution: HarmonicSolution) -> CurvePoint:
    """Torques, factors and losses of a harmonic solution.

    model : the loop that was solved; the harmonics of the torque reach as far as those of the solution
    """
    wave = waveform(model, solution)
    return CurvePoint(
        **_statistics(wave, solution.grid.cells, solution.grid.harmonics)._asdict(),
        speed=solution.speed * float(model.ratios[0]),
        method="harmonic_balance",
        residual=solution.residual,
        iterations=solution.iterations,
        twist=solution.twist,
        drive_torque=solution.drive,
        friction_power=wave.friction_power,
        damping_power=wave.damping_power,
        wave=wave,
        solution=solution,
    )


def point_in_time(model: PortModel, result: PeriodicResponse, cells: int) -> CurvePoint:
    """The same from one period of the time integration.

    cells : mesh periods in the period [-]; the harmonics of the torque are those of the harmonic balance, as far as
    the internal steps resolve them
    """
    radius_1, radius_2 = model.base_radii.T
    wave = Waveform(
        time=result.time,
        angle=result.angle_1,
        approach=result.approach,
        omega_1=result.omega_1,
        omega_2=(radius_1[:, None] * result.omega_1 - result.approach_rate) / radius_2[:, None],
        torque=result.torque,
        touching=result.force != 0.0,
        friction_power=result.friction_loss,
        damping_power=result.mesh_damping_loss,
    )
    return CurvePoint(
        **_statistics(wave, cells, min(LEAST_HARMONICS, result.time.size // cells // 2))._asdict(),
        speed=result.speed,
        method="time_integration",
        residual=result.residual,
        iterations=result.periods,
        twist=result.twist,
        drive_torque=result.drive_torque,
        friction_power=wave.friction_power,
        damping_power=wave.damping_power,
        wave=wave,
        motion=result.motion,
    )


class _TorqueStatistics(NamedTuple):
    """Fields of ``CurvePoint`` with the same names, from the torque over one period."""

    flank: Array
    mean: Array
    maximum: Array
    minimum: Array
    harmonics: Array
    lift_off_share: Array


def _statistics(wave: Waveform, cells: int, orders: int) -> _TorqueStatistics:
    """Torque over one period of ``cells`` mesh periods, its harmonics up to ``orders`` of the mesh frequency."""
    mean = wave.torque.mean(axis=1)
    flank = np.where(mean < 0.0, -1.0, 1.0)
    loaded = flank[:, None] * wave.torque
    amplitudes = np.abs(np.fft.rfft(loaded, axis=1)[:, ::cells][:, : orders + 1]) / loaded.shape[1]
    amplitudes[:, 1:] *= 2.0
    return _TorqueStatistics(
        flank=flank,
        mean=loaded.mean(axis=1),
        maximum=loaded.max(axis=1),
        minimum=loaded.min(axis=1),
        harmonics=amplitudes,
        lift_off_share=1.0 - wave.touching.mean(axis=1),
    )


# The steady state of a loop that turns so slowly that nothing of it oscillates: the windup balances the tooth forces.
#
# Unlike the start of the harmonic balance it runs over the whole period, so that teeth that differ are in it.

HARMONICS = 24
"""Harmonics of each tooth mesh that the windup keeps."""


def quasi_static_point(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    load: LoopLoad,
    drag_torques: Mapping[str, float] | None = None,
    period: Period = "mesh",
) -> CurvePoint:
    """State at a mean speed of the pinion of the first mesh [rad/s] without inertia; loads that alternate left out.

    Parameters are those of `dynamics.vibration.speed_sweep.periodic_response`.

    Raises
    ------
    DynamicsNotConverged
        No windup balances the tooth forces.
    DynamicsInputError
        The mesh frequencies have no common period.
    """
    model = port_model(system, laws)
    problem = BalanceProblem(model=model, form=system.form, load=load)
    cells, cell_angle = mesh_cells(model, period, load.control_mesh)
    turned = cells * cell_angle
    meshes = max(
        law.teeth_1 * abs(float(model.ratios[pinion])) for law, pinion in zip(laws, model.pinions)
    ) * turned / (2.0 * pi)  # fmt: skip
    harmonics = round(HARMONICS * meshes)
    samples = 1 << (round(LEAST_SAMPLES * meshes) - 1).bit_length()
    grid = HarmonicGrid(cells=1, harmonics=harmonics, samples=samples, cell_angle=turned)
    solution = quasi_static_start(problem, grid, speed / float(model.ratios[0]), drag_torques)
    return replace(point_of(model, replace(solution, residual=0.0)), method="quasi_static")


# Torque in shafts and joints of a loop in a periodic state, from the forces of its meshes.
#
# The drivetrain between the meshes is linear: every harmonic of the torques on the gear bodies is taken to the twist of
# each section by the receptance, the mean by the stiffness. Exact for the state that is given.

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class SectionTorques:
    """A loop at one running state; makes the torques of its sections at any periodic state found with it."""

    system: LinearSystem
    rows: TwistRows
    model: PortModel
    ratios: Array
    """(n,) speed of each freedom per speed of the drive freedom."""
    into: Complex
    """(n_states, n_inputs) modal loads of unit torques on the inputs of the meshes (`mesh_inputs`)."""
    seen: Complex
    """(r, n_states) twist rate of each row per modal state."""
    flexibility: Array
    """(r, n) twist of each row per load on each freedom at rest."""

    def over_period(self, point: CurvePoint, drag_torques: Mapping[str, float] | None = None) -> Array:
        """Torque (r, count) at the times of ``point.wave`` [N m]; positive where the first end turns ahead.

        drag_torques : by name of ``system.drag_loads`` [N m], those with which the state was found
        """
        wave = point.wave
        count = wave.time.size
        base = 2.0 * np.pi / (count * float(wave.time[1] - wave.time[0]))
        loads = self._mesh_loads(wave)
        spectrum = np.fft.rfft(loads, axis=1) / count
        cells = round(self.model.laws[0].teeth_1 * point.speed / base)  # mesh periods in the period
        top = min(count // 4, cells * (point.harmonics.shape[1] - 1))
        drive_speed = point.speed / float(self.ratios[self.system.mesh_ports[0, 0]])
        omega = base * np.arange(1, top + 1)
        form = self.system.form
        states = self.into @ spectrum[:, 1 : top + 1]
        states += self._driven(point, base, drive_speed, top)
        states /= 1j * omega - form.poles[:, None]
        rate = self.seen @ states
        rows = self.rows
        coefficients = np.zeros((len(rows.sections), count // 2 + 1), complex)
        coefficients[:, 1 : top + 1] = (rows.stiffness[:, None] / (1j * omega) + rows.damping[:, None]) * rate
        coefficients[:, 0] = self._mean(point, spectrum[:, 0].real, drive_speed, drag_torques or {})
        return np.asarray(np.fft.irfft(coefficients * count, count, axis=1))

    def _mesh_loads(self, wave: Waveform) -> Array:
        """Torque (n_inputs, count) on the inputs of the meshes."""
        loads = np.zeros((len(self.model.loads), wave.time.size))
        for m, (packed, inputs) in enumerate(zip(self.model.packed, mesh_inputs(self.model))):
            motion = wave.angle[m], wave.approach[m], wave.omega_1[m], wave.omega_2[m]
            for i, (torque, *_) in zip(inputs, input_torques(self.model, m, evaluate_mesh(packed, *motion))):
                loads[i] += torque
        return loads

    def _driven(self, point: CurvePoint, base: float, drive_speed: float, top: int) -> Complex:
        """Modal loads (n_states, top) of loads that alternate with a shaft, in phase with the pinion.

        Those alone that the response was found with, which the asked period holds: not those that fit into the longer
        time that a subharmonic motion, or one without a period, is shown for.
        """
        wave = point.wave
        form = self.system.form
        loads = np.zeros((form.poles.size, top), complex)
        if not self.system.periodic_loads:
            return loads
        pinion = float(self.ratios[self.system.mesh_ports[0, 0]])
        lead = float(np.mean(wave.angle[0] / pinion - drive_speed * (wave.time - wave.time[0])))
        turns = drive_speed / base
        asked = (
            turns / point.motion.periods
            if point.motion.periods
            else 1.0 / (self.model.laws[0].teeth_1 * pinion)
        )
        within = within_period(self.system.periodic_loads, self.ratios, asked)
        for harmonic, load in harmonic_loads(within, self.ratios, turns, drive_speed).items():
            if harmonic <= top:
                phase = np.exp(1j * lead * harmonic / turns)
                loads[:, harmonic - 1] += 0.5 * phase * (form.loads @ load)
        return loads

    def _mean(
        self, point: CurvePoint, mesh: Array, drive_speed: float, drag_torques: Mapping[str, float]
    ) -> Array:
        system = self.system
        load = system.twist_load * point.twist - system.damping @ self.ratios * drive_speed
        load += self.model.loads.T @ mesh
        load[system.drive_dof] += point.drive_torque
        for name, torque in drag_torques.items():
            load = load + system.drag_loads[name] * torque
        twist = self.flexibility @ load - self.rows.bracing * point.twist
        return np.asarray(self.rows.stiffness * twist)


def section_torques(system: LinearSystem, laws: Sequence[MeshLaw], rows: TwistRows) -> SectionTorques:
    """Torques of the sections of a system with the mesh laws of its periodic states."""
    scale = float(np.max(np.abs(np.diag(system.stiffness))))
    restrained = system.stiffness + scale * system.rigid @ system.rigid.T
    model = port_model(system, laws)
    return SectionTorques(
        system=system,
        rows=rows,
        model=model,
        ratios=line_ratios(system, laws),
        into=system.form.into(model.loads),
        seen=rows.rows @ system.form.velocity_shapes,
        flexibility=np.asarray(np.linalg.solve(restrained.T, rows.rows.T).T, float),
    )

"""Periodic response of the loop over speed, by harmonic balance where it may be trusted, else in time.

Harmonic balance is used where its harmonics reach 1.5 times the highest oscillating mode that the propagator
keeps; it walks over the speeds in the order given, each start taken from the speed before, so that a rising
and a falling list may settle on different branches of a jump. Where it fails or may not be used, the
propagator of ``dynamics.response`` runs to a steady state.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.harmonic_balance import (
    HarmonicGrid,
    HarmonicSolution,
    Problem,
    Waveform,
    resample,
    solve_periodic,
    waveform,
)
from dynamics.linear_system import LinearSystem
from dynamics.mesh_law import MeshLaw
from dynamics.modal_form import ModalForm, modal_form
from dynamics.propagator import DEFAULT_CUTOFF
from dynamics.static_loop import NotConverged, PortModel, port_model, solve_static

Array = NDArray[np.float64]
Period = Literal["mesh", "revolution", "hunting_cycle"]
Drags = Mapping[str, float] | Callable[[float], Mapping[str, float]] | None
TimeSolver = Callable[[float], "PeriodicPoint"]

LEAST_HARMONICS, MOST_HARMONICS = 24, 96
LEAST_SAMPLES = 256
"""Harmonics of the mesh frequency and samples per mesh that are used at least and at most."""


@dataclass(frozen=True, kw_only=True)
class PeriodicPoint:
    """Steady periodic state at one mean speed.

    speed : of the drive freedom [rad/s]; method : how it was found; residual : relative, of that method
    flank : (n_meshes,) +1 where the front flank carries the mean torque, -1 the back flank
    mean, maximum, minimum : (n_meshes,) torque transmitted at the pinion, positive in load direction [N m]
    harmonics : (n_meshes, n + 1) mean and amplitudes of that torque over the orders of the mesh frequency
    [N m] lift_off_share : (n_meshes,) share of the period without contact [-]
    twist : bracing twist [rad]; drive_torque : mean motor torque that balances all losses [N m]
    friction_power, damping_power : (n_meshes,) mean losses in the mesh [W]
    wave : the motion over one period, for root stress and plots
    """

    speed: float
    method: Literal["harmonic_balance", "time_integration"]
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

    @property
    def dynamic_factor(self) -> Array:
        """K_V = max / mean of every mesh (n_meshes,) [-] (P2, Formula 1)."""
        return np.asarray(self.maximum / self.mean)

    @property
    def dynamic_factor_half_peak_to_peak(self) -> Array:
        """K_V from half the peak-to-peak value, 1 + (max - min) / (2 mean) (n_meshes,) [-]."""
        return np.asarray(1.0 + 0.5 * (self.maximum - self.minimum) / self.mean)


@dataclass(frozen=True, kw_only=True)
class PeriodicResponse:
    """Points in the order of the speeds asked for; ``failed`` holds (speed [rad/s], reason) of the others."""

    points: tuple[PeriodicPoint, ...]
    failed: tuple[tuple[float, str], ...]

    @property
    def speeds(self) -> Array:
        """Speeds of the points [rad/s]."""
        return np.array([point.speed for point in self.points])

    def dynamic_factor(self, mesh: int) -> Array:
        """K_V of one mesh over the points [-]."""
        return np.array([point.dynamic_factor[mesh] for point in self.points])


def periodic_response(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speeds: Sequence[float] | Array,
    torque: float | None,
    *,
    twist: float | None = None,
    control_mesh: int = 0,
    period: Period = "mesh",
    drag_torques: Drags = None,
    cutoff: float = DEFAULT_CUTOFF,
    tolerance: float = 1e-5,
    time_solver: TimeSolver | None = None,
) -> PeriodicResponse:
    """Steady state over speed with contact loss, both meshes coupled.

    Parameters
    ----------
    speeds : mean speeds of the drive freedom [rad/s], > 0, in the order in which they are walked
    torque : mean torque at the pinion of ``control_mesh`` [N m] (negative: back flank); the bracing twist
    that
        makes it is solved along. None: ``twist`` [rad] is held and the torque follows
    period : one mesh, one turn of the pinion of ``control_mesh``, or until the same teeth meet in all meshes
    drag_torques : torque by name of ``system.drag_loads`` [N m], or a function of the speed that gives it
    cutoff : highest mode that counts [Hz]; harmonics must reach 1.5 times the highest mode below it
    time_solver : steady state in time at a speed, used where harmonic balance may not be used or fails

    Raises
    ------
    ValueError
        If a speed is not positive, not exactly one of torque and twist is given, or the mesh frequencies of
        the meshes have no common period.
    """
    if any(not speed > 0.0 for speed in speeds):
        raise ValueError(
            f"speeds: {min(speeds)} rad/s: must be above 0; leave standstill to the static state"
        )
    if (torque is None) == (twist is None):
        raise ValueError("give either the torque or the twist of the loop, not both and not neither")
    walk = _Walk(system, laws, Problem(
        model=port_model(system, laws),
        form=modal_form(system.inertia, system.damping, system.stiffness, system.lines),
        torque=torque, twist=twist, control_mesh=control_mesh,
    ), period, cutoff, tolerance)  # fmt: skip
    points: list[PeriodicPoint] = []
    failed: list[tuple[float, str]] = []
    for speed in map(float, speeds):
        drags = drag_torques(speed) if callable(drag_torques) else drag_torques
        try:
            points.append(walk.point(speed, drags))
        except NotConverged as reason:
            if time_solver is None:
                failed.append((speed, str(reason)))
            else:
                points.append(time_solver(speed))
    return PeriodicResponse(points=tuple(points), failed=tuple(failed))


def highest_mode(form: ModalForm, cutoff: float) -> float:
    """Frequency [Hz] of the highest oscillating mode below the cutoff [Hz]; 0 if there is none."""
    frequency = np.abs(form.poles[form.poles.imag > 1e-3 * np.abs(form.poles)]) / (2.0 * math.pi)
    return float(np.max(frequency[frequency <= cutoff], initial=0.0))


class _Walk:
    """Harmonic balance from speed to speed with its retries."""

    def __init__(
        self,
        system: LinearSystem,
        laws: Sequence[MeshLaw],
        problem: Problem,
        period: Period,
        cutoff: float,
        tolerance: float,
    ) -> None:
        self.problem, self.tolerance = problem, tolerance
        self.cells, self.cell_angle = mesh_cells(problem.model, period, problem.control_mesh)
        self.highest = highest_mode(problem.form, cutoff)
        self.last: HarmonicSolution | None = None

    def grid(self, speed: float) -> HarmonicGrid:
        """Grid whose harmonics reach 1.5 times the highest mode; NotConverged if that takes too many."""
        cell_frequency = speed / self.cell_angle
        needed = math.ceil(1.5 * self.highest / cell_frequency)
        if needed > MOST_HARMONICS:
            raise NotConverged(
                f"harmonic balance at {speed:.6g} rad/s: {needed} harmonics are needed to reach 1.5 times "
                f"the highest mode of {self.highest:.4g} Hz, limit {MOST_HARMONICS}; integrate in time"
            )
        harmonics = max(needed, LEAST_HARMONICS)
        samples = max(LEAST_SAMPLES, 1 << (4 * harmonics - 1).bit_length())
        return HarmonicGrid(
            cells=self.cells, harmonics=harmonics, samples=samples, cell_angle=self.cell_angle
        )

    def point(self, speed: float, drags: Mapping[str, float] | None) -> PeriodicPoint:
        grid = self.grid(speed)
        reason = NotConverged("")
        for start in self._starts(grid, speed, drags):
            try:
                solution = self._solve(start, speed, drags)
            except NotConverged as error:
                reason = error
                continue
            self.last = solution
            return point_of(self.problem.model, solution)
        raise reason

    def _solve(
        self, start: HarmonicSolution, speed: float, drags: Mapping[str, float] | None
    ) -> HarmonicSolution:
        return solve_periodic(
            self.problem, start.grid, speed, start, drag_torques=drags, tolerance=self.tolerance
        )

    def _starts(
        self, grid: HarmonicGrid, speed: float, drags: Mapping[str, float] | None
    ) -> Iterator[HarmonicSolution]:
        """State of the speed before, with more samples, half way from it, then the quasi-static state."""
        finer = replace(grid, samples=4 * grid.samples)
        last = self.last
        if last is not None:
            yield resample(last, grid)
            yield resample(last, finer)
            with suppress(NotConverged):
                yield self._solve(resample(last, finer), 0.5 * (last.speed + speed), drags)
        yield quasi_static_start(self.problem, grid, speed, drags)
        yield quasi_static_start(self.problem, finer, speed, drags)


def mesh_cells(model: PortModel, period: Period, control_mesh: int) -> tuple[int, float]:
    """Number of common mesh periods in the period and rotation of the drive freedom over one of them [rad].

    All meshes share the cell: the shortest rotation that is a whole number of mesh periods of each.
    """
    law = model.laws[control_mesh]
    pitch = [
        Fraction(float(m.teeth_1 * model.ratios[2 * i] / (law.teeth_1 * model.ratios[2 * control_mesh])))
        .limit_denominator(10_000)
        for i, m in enumerate(model.laws)
    ]  # fmt: skip
    for value, m in zip(pitch, model.laws):
        if value.denominator > 200:
            raise ValueError(
                f"mesh frequencies have no common period: {m.teeth_1} teeth give {float(value):.6g} of "
                "the frequency of the control mesh; integrate in time"
            )
    common = math.lcm(*(value.denominator for value in pitch))
    cell_angle = common * 2.0 * math.pi / (law.teeth_1 * float(model.ratios[2 * control_mesh]))
    if period == "mesh":
        return 1, cell_angle
    meshes = math.lcm(law.teeth_1, common)
    if period == "hunting_cycle":
        for m, value in zip(model.laws, pitch):
            turns = math.lcm(m.teeth_1, m.teeth_2)
            meshes = math.lcm(meshes, turns * value.denominator // math.gcd(turns, value.numerator))
    return meshes // common, cell_angle


def quasi_static_start(
    problem: Problem, grid: HarmonicGrid, speed: float, drags: Mapping[str, float] | None
) -> HarmonicSolution:
    """Start state: the windup of the slowly rotating loop over one mesh period."""
    angles = np.arange(grid.samples) * (grid.cell_angle / grid.samples)
    state = solve_static(
        problem.model, torque=problem.torque, twist=problem.twist, control_mesh=problem.control_mesh,
        angles=np.asarray(angles, float), speed=speed, drag_torques=drags,
    )  # fmt: skip
    coefficients = np.fft.rfft(state.ports[:, :-1].T, axis=1)[:, : grid.harmonics + 1] / grid.samples
    ports = np.zeros((coefficients.shape[0], grid.top + 1), complex)
    ports[:, :: grid.cells] = coefficients
    return HarmonicSolution(
        grid=grid, speed=speed, ports=ports, twist=state.twist, drive=float(state.drive.mean()),
        residual=math.inf, iterations=0,
    )  # fmt: skip


def point_of(model: PortModel, solution: HarmonicSolution) -> PeriodicPoint:
    """Torques, factors and losses of a harmonic solution."""
    wave = waveform(model, solution)
    mean = wave.torque.mean(axis=1)
    flank = np.where(mean < 0.0, -1.0, 1.0)
    loaded = flank[:, None] * wave.torque
    grid = solution.grid
    orders = np.abs(np.fft.rfft(loaded, axis=1)[:, :: grid.cells][:, : grid.harmonics + 1]) / grid.count
    orders[:, 1:] *= 2.0
    return PeriodicPoint(
        speed=solution.speed,
        method="harmonic_balance",
        residual=solution.residual,
        iterations=solution.iterations,
        flank=flank,
        mean=loaded.mean(axis=1),
        maximum=loaded.max(axis=1),
        minimum=loaded.min(axis=1),
        harmonics=orders,
        lift_off_share=1.0 - wave.touching.mean(axis=1),
        twist=solution.twist,
        drive_torque=solution.drive,
        friction_power=wave.friction_power,
        damping_power=wave.damping_power,
        wave=wave,
    )

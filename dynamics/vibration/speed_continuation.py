"""Choice of harmonics, start states and continuation of the harmonic balance from speed to speed."""

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction

import numpy as np

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import ModalForm
from dynamics.rotor.static_loop import PortModel, SlowRotation, solve_static
from dynamics.vibration.harmonic_balance import (
    BalanceProblem,
    HarmonicGrid,
    HarmonicSolution,
    resample,
    solve_periodic,
)
from dynamics.vibration.steady_motion import Period

LEAST_HARMONICS, MOST_HARMONICS = 24, 640
"""Harmonics of the mesh frequency that are used at least and at most: a point of a rig with modes up to 9 kHz whose
excitation repeats with a revolution takes 1.3 s with 346 of them, 3.6 s with 520, 11 s with 830; marched in time it
takes 9 to 12 s and does not settle at the slowest of these speeds."""
LEAST_DAMPING = 1e-9
"""Damping ratio taken for a mode that no damper reaches [-]."""
LEAST_SAMPLES = 256
"""Samples per mesh that are used at least."""


SAME_PLACE = 5e-3
"""Relative distance of speeds up to which a state is sought for its small difference from the last one."""
SEEN = 1e-3
"""Approach of a mode at its resonance, per static approach of a mesh under the same force, from which it counts [-]."""


def highest_mode(model: PortModel, form: ModalForm, cutoff: float) -> float:
    """Frequency [Hz] of the highest mode below the cutoff [Hz] that a mesh moves by `SEEN` or more; 0 if there is none.

    Lateral and axial modes that a mesh hardly moves need no harmonics.
    """
    bodies = model.dofs[:-1]
    approach = model.approach[:, :-1]
    moved = (approach @ form.velocity_shapes[bodies]) * (approach @ form.loads[:, bodies].T)
    stiffness = np.array([law.mean_stiffness for law in model.laws])[:, None]
    oscillates = form.poles.imag > 1e-3 * np.abs(form.poles)
    poles = form.poles[oscillates]
    damping = np.maximum(-poles.real, LEAST_DAMPING * np.abs(poles))
    gain = (np.abs(moved[:, oscillates]) * stiffness / (damping * np.abs(poles))).max(axis=0, initial=0.0)
    frequency = np.abs(poles) / (2.0 * math.pi)
    return float(np.max(frequency[(frequency <= cutoff) & (gain >= SEEN)], initial=0.0))


class HarmonicWalk:
    """Harmonic balance from speed to speed with its retries."""

    def __init__(
        self,
        problem: BalanceProblem,
        period: Period,
        cutoff: float,
        tolerance: float,
        least: int = LEAST_HARMONICS,
    ) -> None:
        """Choose the cell and the highest mode that the harmonics must reach, see ``periodic_response``."""
        self.tolerance, self.cutoff, self.least = tolerance, cutoff, least
        self.cells, self.cell_angle = mesh_cells(problem.model, period, problem.load.control_mesh)
        self.take(problem)

    def take(self, problem: BalanceProblem) -> None:
        """Go on with the matrices of another speed band."""
        self.problem = problem
        self.highest = highest_mode(problem.model, problem.form, self.cutoff)

    def grid(self, speed: float) -> HarmonicGrid:
        """Grid whose harmonics reach 1.5 times the highest mode; DynamicsNotConverged if that takes too many."""
        cell_frequency = speed / self.cell_angle
        needed = math.ceil(1.5 * self.highest / cell_frequency)
        if needed > MOST_HARMONICS:
            raise DynamicsNotConverged(
                f"harmonic balance at {speed:.6g} rad/s: {needed} harmonics needed to reach 1.5 times "
                f"the highest mode of {self.highest:.4g} Hz, limit {MOST_HARMONICS}; integrate in time"
            )
        harmonics = max(needed, self.least)
        samples = max(LEAST_SAMPLES, 1 << (4 * harmonics - 1).bit_length())
        return HarmonicGrid(
            cells=self.cells, harmonics=harmonics, samples=samples, cell_angle=self.cell_angle
        )

    def solve(
        self, speed: float, drags: Mapping[str, float] | None, last: HarmonicSolution | None
    ) -> HarmonicSolution:
        """State at a speed of the drive freedom [rad/s], by continuation from ``last``; else DynamicsNotConverged.

        Where Newton's method stalls next to a state of nearly the same speed, what is left would hide the small change
        that is sought: the slowly rotating loop is tried as well, and the stalled state taken only where that leads
        nowhere.
        """
        grid = self.grid(speed)
        reason, stalled = DynamicsNotConverged(""), None
        near = last is not None and abs(last.speed - speed) <= SAME_PLACE * speed
        for start in self._starts(grid, speed, drags, last):
            try:
                solution = self._solve(start, speed, drags)
            except DynamicsNotConverged as error:
                reason = error
            else:
                if solution.residual < self.tolerance or not near:
                    return solution
                stalled = solution if stalled is None or solution.residual < stalled.residual else stalled
        if stalled is not None:
            return stalled
        raise reason

    def solve_near(
        self, speed: float, drags: Mapping[str, float] | None, start: HarmonicSolution
    ) -> HarmonicSolution:
        """State at a speed on the branch of ``start``, which lies next to it; else DynamicsNotConverged."""
        grid = self.grid(speed)
        try:
            return self._solve(resample(start, grid), speed, drags)
        except DynamicsNotConverged:
            return self._solve(resample(start, replace(grid, samples=4 * grid.samples)), speed, drags)

    def _solve(
        self, start: HarmonicSolution, speed: float, drags: Mapping[str, float] | None
    ) -> HarmonicSolution:
        return solve_periodic(self.problem, speed, start, drag_torques=drags, tolerance=self.tolerance)

    def _starts(
        self,
        grid: HarmonicGrid,
        speed: float,
        drags: Mapping[str, float] | None,
        last: HarmonicSolution | None,
    ) -> Iterator[HarmonicSolution]:
        """State of the speed before, with more samples, by small steps, then the quasi-static state."""
        finer = replace(grid, samples=4 * grid.samples)
        if last is not None:
            yield resample(last, grid)
        if last is not None and last.speed != speed:
            yield resample(last, finer)
            with suppress(DynamicsNotConverged):
                yield self._approach(resample(last, grid), speed, drags)
        yield quasi_static_start(self.problem, grid, speed, drags)
        yield quasi_static_start(self.problem, finer, speed, drags)

    def _approach(
        self, state: HarmonicSolution, speed: float, drags: Mapping[str, float] | None
    ) -> HarmonicSolution:
        """Walk to the speed in steps that halve on failure and double on success, down to 1/64 of the way."""
        step = 0.5 * (speed - state.speed)
        least = abs(speed - state.speed) / 64.0
        while abs(step) >= least:
            left = speed - state.speed
            if abs(left) < 1e-12 * speed:
                return state
            step = math.copysign(min(abs(step), abs(left)), left)
            try:
                state = self._solve(state, state.speed + step, drags)
                step *= 2.0
            except DynamicsNotConverged:
                step *= 0.5
        raise DynamicsNotConverged(
            f"continuation stopped at {state.speed:.6g} rad/s on the way to {speed:.6g} rad/s"
        )


def mesh_cells(model: PortModel, period: Period, control_mesh: int) -> tuple[int, float]:
    """Number of common mesh periods in the period and rotation of the drive freedom over one of them [rad].

    All meshes share the cell: the shortest rotation that is a whole number of mesh periods of each.
    """
    law = model.laws[control_mesh]
    ratio = model.ratios[model.pinions[control_mesh]]
    pitch = [
        Fraction(float(m.teeth_1 * model.ratios[model.pinions[i]] / (law.teeth_1 * ratio)))
        .limit_denominator(10_000)
        for i, m in enumerate(model.laws)
    ]  # fmt: skip
    for value, m in zip(pitch, model.laws):
        if value.denominator > 200:
            raise DynamicsInputError(
                f"mesh frequencies have no common period: {m.teeth_1} teeth give {float(value):.6g} of "
                "the frequency of the control mesh; integrate in time"
            )
    common = math.lcm(*(value.denominator for value in pitch))
    cell_angle = common * 2.0 * math.pi / (law.teeth_1 * float(ratio))
    if period == "mesh":
        return 1, cell_angle
    meshes = math.lcm(law.teeth_1, common)
    if period == "hunting_cycle":
        for m, value in zip(model.laws, pitch):
            turns = math.lcm(m.teeth_1, m.teeth_2)
            meshes = math.lcm(meshes, turns * value.denominator // math.gcd(turns, value.numerator))
    return meshes // common, cell_angle


def quasi_static_start(
    problem: BalanceProblem, grid: HarmonicGrid, speed: float, drags: Mapping[str, float] | None
) -> HarmonicSolution:
    """Start state: the windup of the slowly rotating loop over one mesh period.

    Behind a motor shaft too soft to lead the loop from angle to angle the pinion of the control mesh leads it.
    """
    angles = np.arange(grid.samples) * (grid.cell_angle / grid.samples)
    rotation = SlowRotation(angles=np.asarray(angles, float), speed=speed, drag_torques=drags)
    try:
        state = solve_static(problem.model, problem.load, rotation)
    except DynamicsNotConverged:
        pinion = int(problem.model.pinions[problem.load.control_mesh])
        state = solve_static(problem.model, problem.load, replace(rotation, port=pinion))
    coefficients = np.fft.rfft(state.ports[:, :-1].T, axis=1)[:, : grid.harmonics + 1] / grid.samples
    ports = np.zeros((coefficients.shape[0], grid.top + 1), complex)
    ports[:, :: grid.cells] = coefficients
    return HarmonicSolution(
        grid=grid, speed=speed, ports=ports, twist=state.twist, drive=float(state.drive.mean()),
        residual=math.inf, iterations=0,
    )  # fmt: skip

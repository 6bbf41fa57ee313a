"""Steady heat conduction with everything a surface may do: full Newton, multigrid inside.

`solve_steady` runs Newton's method on the equations of thermal.conduction.terms and hands back the field with
the heat balance of thermal.conduction.balance, which closes to 1e-8 of the heat turned over or is no solution.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from thermal.conduction.balance import HeatBalance, heat_balance
from thermal.conduction.setup import Condition, check_conditions
from thermal.conduction.setup import ConductionSetup as ConductionSetup
from thermal.conduction.terms import ConductionProblem, Linearisation, Preconditioner
from thermal.errors import ThermalInputError, ThermalNotConverged
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import LinearSolution, conjugate_gradient, gmres

CLOSURE = 1e-8
"""Greatest allowed gap of the heat balance relative to the heat turned over."""


@dataclass(frozen=True, kw_only=True)
class TemperatureSolution:
    """A steady temperature field."""

    temperature: FloatArray
    """(n_nodes,) [K]"""
    balance: HeatBalance
    residuals: tuple[float, ...]
    """Sum of the nodal residuals' sizes relative to the heat turned over, after 0, 1, ... Newton steps."""
    linear_iterations: tuple[int, ...]
    """Iterations of the linear solve of each Newton step on the second-order space."""
    warnings: tuple[str, ...]
    """What is to be said of joints, and what the film laws said about their range; each sentence once."""
    volumes: dict[str, float]
    """Volume of a stream network -> temperature at which its fluid leaves [K]."""
    preconditioner: Preconditioner | None = field(repr=False, compare=False)
    """Of the last linear solve: good for the next problem nearby."""


def solve_steady(
    setup: ConductionSetup,
    conditions: Sequence[Condition],
    initial: FloatArray | float | None = None,
    *,
    near: TemperatureSolution | None = None,
    tolerance: float = 1e-9,
    max_steps: int = 30,
) -> TemperatureSolution:
    """Solve for the steady temperature of all bodies of a mesh and of the volumes of stream networks.

    setup : mesh and conductivities, with what does not depend on the conditions at hand
    conditions : at least one for every surface on the boundary, see thermal.conditions.boundary, contact, enclosure,
        streams
    initial : (n_nodes,) field or one value [K] to start from; the mean of all given temperatures if None
    near : solution on this mesh under conditions not far off, to start from in field and preconditioner
    tolerance : of the nodal residuals' sum relative to the heat turned over; the balance closes to ten times it

    Raises ConditionError (a ValueError) for conditions or values that cannot be computed, ThermalNotConverged (a
    RuntimeError with its history) if Newton's method or a linear solve stalls.
    """
    check_conditions(setup.elements, conditions)
    problem = ConductionProblem(setup, conditions)
    start = problem.start(initial if near is None else near.temperature)
    problem.check_paths(start)
    result = newton(problem, start, tolerance, max_steps, None if near is None else near.preconditioner)
    n = problem.n_nodes
    temperature, volumes = result.field[:n], dict(zip(problem.volumes.index, result.field[n:].tolist()))
    balance = heat_balance(setup, conditions, temperature, problem.reactions(result.field), volumes)
    if balance.closure > max(CLOSURE, 10.0 * tolerance) and balance.worst_piece > problem.roundoff(
        result.field
    ):
        raise ThermalNotConverged(
            f"heat balance open by {balance.closure:.3g} of the heat turned over, above {CLOSURE:g}; "
            "lower the tolerance",
            result.residuals,
        )
    return TemperatureSolution(
        temperature=temperature,
        balance=balance,
        residuals=result.residuals,
        linear_iterations=result.linear_iterations,
        warnings=(*setup.notes(conditions), *balance.warnings),
        volumes=volumes,
        preconditioner=result.preconditioner,
    )


# Newton's method on the equations of thermal.conduction.terms.
#
# Residual and Jacobian of a problem with multigrid inside: conjugate gradients where the Jacobian is symmetric, GMRES
# where mean temperatures add to it. It starts from one temperature everywhere as well as from a field on the corner
# nodes, which takes longer to find than it saves: where facets are curved, cells with straight edges are another
# problem.

CONTRACTION = 0.1
"""Fall of the residual in a Newton step of a time step below which the Jacobian is made afresh."""

WORN = 14
"""Iterations of a linear solve of a steady problem after which a preconditioner of an earlier field is replaced."""

SMALLEST_STEP = 1e-2
"""Share of a Newton step that is taken even if the residual rises."""


@dataclass(frozen=True)
class NewtonResult:
    """Unknowns (n_nodes + m,) with the history of the iteration and the preconditioner it ended with."""

    field: FloatArray
    residuals: tuple[float, ...]
    linear_iterations: tuple[int, ...]
    preconditioner: Preconditioner | None
    linear: Linearisation | None


def newton(
    problem: ConductionProblem,
    field: FloatArray,
    tolerance: float,
    max_steps: int = 30,
    preconditioner: Preconditioner | None = None,
    linear: Linearisation | None = None,
) -> NewtonResult:
    """Iterate on nodes and volumes from ``field`` (n_nodes + m,) until the residual is within tolerance.

    preconditioner : of a problem nearby, taken as it is; made from the first Jacobian if None
    linear : Jacobian of a time step nearby; a time step keeps its Jacobian as long as the residual falls by
        ``CONTRACTION`` from step to step

    Raises ThermalNotConverged with its history and the hottest place.
    """
    out, turned = problem.heat_out(field)
    residual = problem.residual(out)
    history: list[float] = []
    iterations: list[int] = []
    while True:
        size = float(np.abs(residual).sum())
        limit = max(tolerance * turned, problem.roundoff(field))
        history.append(size / turned if turned > 0.0 else 0.0)
        if size <= limit:
            return NewtonResult(field, tuple(history), tuple(iterations), preconditioner, linear)
        if len(iterations) == max_steps:
            raise ThermalNotConverged(
                f"Newton: residual {history[-1]:.3g} of the heat after {max_steps} steps is above "
                f"{tolerance:g}; {_hottest(problem, field)}; check the film laws for jumps or start from a "
                "nearer field",
                tuple(history),
            )
        slow = len(history) > 1 and history[-1] > CONTRACTION * history[-2]
        if problem.storage is None or slow:
            linear = None  # its memory serves the next one
        if linear is None:
            linear = problem.linearise(field)
        made = preconditioner is None
        if preconditioner is None:
            preconditioner = problem.preconditioner(linear, field)
        elif problem.storage is None or linear.symmetric:
            preconditioner.set_low_rank(linear.low_rank)
        load = linear.load(residual)
        step = _solved(linear, load, preconditioner, _forcing(history, limit / size))
        iterations.append(step.iterations)
        if step.iterations > WORN and not made and problem.storage is None:
            preconditioner = None
        whole = linear.whole(residual, step.values)
        field, residual, turned = _line_search(problem, field, whole, residual)


def _solved(
    linear: Linearisation, load: FloatArray, preconditioner: Preconditioner, tolerance: float
) -> LinearSolution:
    """Conjugate gradients where the Jacobian is symmetric, GMRES where it is not."""
    if linear.symmetric:
        return conjugate_gradient(linear.matrix, load, preconditioner, tolerance=tolerance)
    return gmres(linear, load, preconditioner, tolerance=tolerance)


def _hottest(problem: ConductionProblem, field: FloatArray) -> str:
    """Where the last field is hottest, in words."""
    node = int(field[: problem.n_nodes].argmax())
    mesh = problem.elements.mesh
    body = next((name for name, cells in mesh.bodies.items() if (mesh.cells[cells] == node).any()), "?")
    x, y, z = mesh.points[node]
    return f"hottest in body {body} at x, y, z = {x:.4g}, {y:.4g}, {z:.4g} m with {field[node]:.5g} K"


def _forcing(history: list[float], enough: float) -> float:
    """Tolerance of the linear solve: small enough for quadratic convergence, never smaller than needed.

    Source: Eisenstat, Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2 with exponent 2.
    """
    fall = history[-1] / history[-2] if len(history) > 1 and history[-2] > 0.0 else 1.0
    return max(min(1e-3, 0.5 * fall * fall), 0.1 * min(enough, 1.0), 1e-12)


def _line_search(
    problem: ConductionProblem,
    temperature: FloatArray,
    step: FloatArray,
    residual: FloatArray,
) -> tuple[FloatArray, FloatArray, float]:
    """Halve the step until temperatures are positive, every film law can be evaluated and the residual falls.

    Return field, residual and heat turned over. What a law raises is passed on if no part of the step helps.
    """
    before = float(np.linalg.norm(residual))
    share = 1.0
    while True:
        trial = temperature + share * step
        last = share < SMALLEST_STEP
        if trial.min() > 0.0:
            try:
                out, turned = problem.heat_out(trial)
            except ThermalInputError:
                if last:
                    raise
            else:
                after = problem.residual(out)
                if last or np.linalg.norm(after) <= (1.0 - 1e-4 * share) * before:
                    return trial, after, turned
        share *= 0.5

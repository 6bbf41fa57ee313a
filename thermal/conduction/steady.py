"""Steady heat conduction with everything a surface may do: full Newton, multigrid inside.

`solve_steady` runs thermal.conduction.newton on the equations of thermal.conduction.terms and hands back the field with
the heat balance of thermal.conduction.balance, which closes to 1e-8 of the heat turned over or is no solution.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

from thermal.conduction.balance import HeatBalance, heat_balance
from thermal.conduction.condition_checks import Condition, check_conditions
from thermal.conduction.newton import newton
from thermal.conduction.setup import ConductionSetup as ConductionSetup
from thermal.conduction.terms import ConductionProblem, Preconditioner
from thermal.errors import ThermalNotConverged
from thermal.fe.mesh import FloatArray

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

"""Steady heat conduction with films, radiation and exchange: full Newton, multigrid inside.

`solve_steady` iterates on the residual and Jacobian of thermal.conduction_terms and hands back the field with
the heat balance of thermal.balance, which closes to 1e-8 of the heat turned over or is no solution.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from thermal.balance import HeatBalance, heat_balance
from thermal.boundary import BoundaryCondition
from thermal.condition_checks import ConditionError, check_conditions, check_conductivity
from thermal.conduction_terms import ConductionProblem
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.fe.solver import LowRank, NotConverged, Operator, TwoLevelMultigrid, gmres

CLOSURE = 1e-8
"""Greatest allowed gap of the heat balance relative to the heat turned over."""

SMALLEST_STEP = 1e-2
"""Share of a Newton step that is taken even if the residual rises."""


@dataclass(frozen=True, kw_only=True)
class TemperatureSolution:
    """A steady temperature field."""

    temperature: FloatArray
    """(n_nodes,) [K]"""
    balance: HeatBalance
    residuals: tuple[float, ...]
    """Sum of the nodal residuals' sizes relative to the heat turned over, after 0, 1, ... Newton steps."""
    linear_iterations: tuple[int, ...]
    """GMRES iterations of each Newton step."""
    warnings: tuple[str, ...]
    """What the film laws said about their range, each sentence once."""


class ConductionSetup:
    """Conduction matrices of a mesh, assembled once and used for every stage and coupling pass.

    conductivity : body -> k [W/(m K)]
    elements : share the spaces of an earlier setup on the same mesh
    Raises MeshError for a bad mesh and ConditionError for missing, unknown or impossible conductivities.
    """

    def __init__(
        self,
        mesh: NamedMesh,
        conductivity: Mapping[str, float],
        elements: FiniteElements | None = None,
    ) -> None:
        check_conductivity(mesh.bodies, conductivity)
        self.mesh = mesh
        self.conductivity = dict(conductivity)
        self.elements = FiniteElements(mesh) if elements is None else elements
        per_cell = self.elements.per_cell(self.conductivity)
        self.fine = self.elements.conduction(per_cell, self.elements.fine)
        """(nnz,) values of the second-order matrix [W/K]."""
        self.coarse = self.elements.conduction(per_cell, self.elements.coarse)
        """Values of the linear matrix [W/K]."""

    def matches(self, mesh: NamedMesh, conductivity: Mapping[str, float]) -> bool:
        """Whether the setup was made for this mesh and these conductivities."""
        return self.mesh is mesh and self.conductivity == dict(conductivity)


def solve_steady(
    mesh: NamedMesh,
    conductivity: Mapping[str, float],
    conditions: Sequence[BoundaryCondition],
    initial: FloatArray | float | None = None,
    *,
    reuse: ConductionSetup | None = None,
    tolerance: float = 1e-9,
    max_steps: int = 30,
) -> TemperatureSolution:
    """Solve for the steady temperature of all bodies of ``mesh``.

    conductivity : body -> k [W/(m K)]
    conditions : at least one for every surface on the boundary, see thermal.boundary
    initial : (n_nodes,) field or one value [K] to start from; the mean of all given temperatures if None
    reuse : setup of the same mesh and conductivities; all but the boundary terms is then at hand
    tolerance : of the nodal residuals' sum relative to the heat turned over; the balance closes to it

    Raises ConditionError (a ValueError) for conditions or values that cannot be computed, NotConverged (a
    RuntimeError with its history) if Newton's method or a linear solve stalls.
    """
    setup = ConductionSetup(mesh, conductivity) if reuse is None else reuse
    if not setup.matches(mesh, conductivity):
        raise ConditionError(
            "the setup to reuse belongs to another mesh or other conductivities; make a new one"
        )
    check_conditions(setup.elements, conditions)
    problem = ConductionProblem(setup.elements, setup.fine, setup.coarse, conditions)
    temperature, residuals, iterations = _newton(problem, problem.start(initial), tolerance, max_steps)
    balance = heat_balance(setup.elements, conditions, temperature, problem.reactions(temperature))
    if balance.closure > CLOSURE and balance.worst_piece > problem.roundoff(temperature):
        raise NotConverged(
            f"heat balance open by {balance.closure:.3g} of the heat turned over, above {CLOSURE:g}; "
            "lower the tolerance",
            residuals,
        )
    said = [text for row in balance.rows if row.coefficient for text in row.coefficient.warnings]
    return TemperatureSolution(
        temperature=temperature,
        balance=balance,
        residuals=residuals,
        linear_iterations=iterations,
        warnings=tuple(dict.fromkeys(said)),
    )


def _newton(
    problem: ConductionProblem, temperature: FloatArray, tolerance: float, max_steps: int
) -> tuple[FloatArray, tuple[float, ...], tuple[int, ...]]:
    """Iterate to the tolerance; return field, residual history and linear iterations of each step."""
    out, turned = problem.heat_out(temperature)
    residual = np.where(problem.fixed, 0.0, out)
    history: list[float] = []
    iterations: list[int] = []
    multigrid: TwoLevelMultigrid | None = None
    while True:
        size = float(np.abs(residual).sum())
        limit = max(tolerance * turned, problem.roundoff(temperature))
        history.append(size / turned if turned > 0.0 else 0.0)
        if size <= limit:
            return temperature, tuple(history), tuple(iterations)
        if len(iterations) == max_steps:
            raise NotConverged(
                f"Newton: residual {history[-1]:.3g} of the heat after {max_steps} steps is above "
                f"{tolerance:g}; check the film laws for jumps or start from a nearer field",
                tuple(history),
            )
        slopes = problem.point_coefficients(temperature)
        jacobian = problem.jacobian(slopes)
        low_rank = problem.low_rank(temperature)
        if multigrid is None:
            multigrid = problem.multigrid(jacobian, slopes, temperature)
        multigrid.set_low_rank(low_rank)

        linear = gmres(
            _sum(jacobian, low_rank), -residual, multigrid, tolerance=_forcing(history, limit / size)
        )
        iterations.append(linear.iterations)
        temperature, residual, turned = _line_search(problem, temperature, linear.values, residual)


def _sum(matrix: sparse.csr_array, part: LowRank | None) -> Operator:
    """The operator ``matrix + part``."""
    return lambda x: matrix @ x if part is None else matrix @ x + part @ x


def _forcing(history: list[float], enough: float) -> float:
    """Tolerance of the linear solve: small enough for quadratic convergence, never smaller than needed.

    Source: Eisenstat, Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2 with exponent 2.
    """
    fall = history[-1] / history[-2] if len(history) > 1 and history[-2] > 0.0 else 1.0
    return max(min(1e-3, 0.5 * fall * fall), 0.1 * min(enough, 1.0), 1e-12)


def _line_search(
    problem: ConductionProblem, temperature: FloatArray, step: FloatArray, residual: FloatArray
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
            except ValueError:
                if last:
                    raise
            else:
                after = np.where(problem.fixed, 0.0, out)
                if last or float(np.linalg.norm(after)) <= (1.0 - 1e-4 * share) * before:
                    return trial, after, turned
        share *= 0.5

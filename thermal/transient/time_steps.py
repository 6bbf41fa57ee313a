"""One implicit time step of heat conduction, its local error, and the length of the next.

Alexander's two-stage method of order 2 (SDIRK, stiffly accurate, L-stable): with g = 1 - 1/sqrt(2)

    C k1 = -R(T1, t + g dt),  T1 = T + g dt k1,
    C k2 = -R(T2, t + dt),    T2 = T + (1 - g) dt k1 + g dt k2,

so that T2 is the new field and the heat of every term over the step is dt ((1 - g) Q(T1) + g Q(T2)): what
flows in is stored to the tolerance of Newton's method. Both stages have the matrix C / (g dt) + R'.
Source: Alexander, SIAM J. Numer. Anal. 14 (1977) 1006.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from thermal.conduction.balance import HeatBalance, heat_balance
from thermal.conduction.capacity import HeatCapacity, Storage, StoredHeat
from thermal.conduction.steady import newton
from thermal.conduction.terms import ConductionProblem, Linearisation, Preconditioner
from thermal.fe.mesh import FloatArray

GAMMA = 1.0 - math.sqrt(0.5)

STAGE_WEIGHTS = (1.0 - GAMMA, GAMMA)
"""Shares of the two stages in everything integrated over a step."""

ERROR_WEIGHTS = (2.0 / 3.0 * (1.0 - GAMMA), -2.0 / 3.0, 2.0 / 3.0 * GAMMA)
"""Weights of k0, k1, k2 in the local error over dt, exact to third order for a linear problem."""

SAFETY = 0.9
RATIO = (0.2, 2.5)
"""Least and greatest ratio of a step to the one before."""

KEPT = (0.9, 1.3)
"""Ratios inside of which the step stays as it is, and with it the matrix of the preconditioner."""

NEAR = 4.0
"""Ratio of step lengths up to which a preconditioner serves."""

STALE = 25
"""Linear iterations of a Newton step from which the next one gets a preconditioner of its own."""

NEWTON_STEPS = 12
"""Newton steps of a stage before the time step is shortened."""

ProblemAt = Callable[[float], ConductionProblem]
"""The problem at a time [s]."""


@dataclass(frozen=True)
class TimeStep:
    """A step made: the new unknowns with their slope in time, the error, the heat of both stages."""

    field: FloatArray
    """(n_nodes + m,) [K]"""
    slope: FloatArray
    """(n_nodes + m,) k2 [K/s]"""
    error: float
    """Greatest root mean square over a body, or size in a volume, of the local error [K]."""
    balances: tuple[HeatBalance, HeatBalance]
    """Heat of every term at the two stages [W]; the capacities take what is left over."""
    linear_iterations: int


class Stepper:
    """Makes steps on one mesh; keeps the preconditioner from step to step.

    tolerance : of Newton's method, see `thermal.conduction.steady.solve_steady`
    """

    def __init__(self, capacity: HeatCapacity, tolerance: float) -> None:
        self.capacity = capacity
        self._tolerance = tolerance
        self._preconditioner: Preconditioner | None = None
        self._linear: Linearisation | None = None
        self._rate = self._linear_rate = 0.0

    def forget(self) -> None:
        """Drop preconditioner and Jacobian: the conditions have changed."""
        self._preconditioner = self._linear = None

    def step(
        self, problem_at: ProblemAt, time: float, dt: float, field: FloatArray, slope: FloatArray | None
    ) -> TimeStep:
        """Make one step.

        field : (n_nodes + m,) at ``time`` [K]
        slope : k2 of the step before, None if there is none or the conditions have jumped

        Raises NotConverged if a stage does not converge.
        """
        guess = field if slope is None else field + GAMMA * dt * slope
        first, used_1, balance_1 = self._stage(problem_at(time + GAMMA * dt), dt, field, guess)
        k1 = (first - field) / (GAMMA * dt)
        base = field + (1.0 - GAMMA) * dt * k1
        problem = problem_at(time + dt)
        second, used_2, balance_2 = self._stage(problem, dt, base, first + (1.0 - GAMMA) * dt * k1)
        k2 = (second - base) / (GAMMA * dt)
        error = self._size(problem, GAMMA * dt * (k2 - k1))
        if slope is not None:
            parts = zip(ERROR_WEIGHTS, (slope, k1, k2), strict=True)
            third_order = sum((dt * w * k for w, k in parts), np.zeros_like(field))
            error = min(error, self._size(problem, third_order))
        return TimeStep(second, k2, error, (balance_1, balance_2), used_1 + used_2)

    def _stage(
        self, problem: ConductionProblem, dt: float, base: FloatArray, guess: FloatArray
    ) -> tuple[FloatArray, int, HeatBalance]:
        """Solve one stage; return the unknowns, the linear iterations and the heat of its terms."""
        rate = 1.0 / (GAMMA * dt)
        if not self._rate / NEAR < rate < self._rate * NEAR:
            self._preconditioner, self._rate = None, rate
        if rate != self._linear_rate:
            self._linear, self._linear_rate = None, rate
        storing = problem.storing(Storage(self.capacity, problem.volumes.capacity, rate, base))
        start = guess if guess.min() > 0.0 else base
        start = start if start.min() > 0.0 else np.full_like(base, float(np.abs(base).mean()))
        result = newton(
            storing,
            storing.start(start),
            self._tolerance,
            NEWTON_STEPS,
            preconditioner=self._preconditioner,
            linear=self._linear,
        )
        stale = max(result.linear_iterations, default=0) > STALE
        self._preconditioner = None if stale else result.preconditioner
        self._linear = result.linear
        n = problem.n_nodes
        balance = heat_balance(
            problem.setup,
            problem.conditions,
            result.field[:n],
            storing.reactions(result.field),
            dict(zip(problem.volumes.index, result.field[n:].tolist(), strict=True)),
        )
        return result.field, sum(result.linear_iterations), balance

    def _size(self, problem: ConductionProblem, error: FloatArray) -> float:
        """Greatest root mean square of a nodal error over a body, or error of a volume that stores heat [K]."""
        elements = problem.elements
        free = np.where(problem.fixed, 0.0, error[: problem.n_nodes])
        squares = elements.fine.at_points(free) ** 2 * elements.fine.volumes
        of_cell, volumes = squares.sum(axis=1), elements.fine.volumes.sum(axis=1)
        bodies = elements.mesh.bodies.values()
        sizes = [math.sqrt(of_cell[cells].sum() / volumes[cells].sum()) for cells in bodies]
        storing = problem.volumes.capacity > 0.0
        return max(*sizes, float(np.abs(error[problem.n_nodes :][storing]).max(initial=0.0)))


def next_length(dt: float, error: float, tolerance: float) -> float:
    """Length of the next step [s] from the error of a step of length ``dt`` (order 2)."""
    ratio = SAFETY * (tolerance / error) ** (1.0 / 3.0) if error > 0.0 else RATIO[1]
    if KEPT[0] <= ratio <= KEPT[1]:
        return dt
    return dt * min(max(ratio, RATIO[0]), RATIO[1])


def landing(dt: float, remaining: float) -> float:
    """A step that ends at ``remaining`` or leaves room for one of its kind [s]."""
    if dt >= 0.999 * remaining:
        return remaining
    return min(dt, 0.5 * remaining) if dt > 0.5 * remaining else dt


# Second-order backward differences over time steps of growing length: a warm-up in a few implicit steps.
#
# With y0, y1 the last two fields, h the step and w its ratio to the one before, the new field y satisfies
#
#     C (y - b) / s + R(y) = 0,   s = h (1 + w) / (1 + 2 w),   b = ((1 + w)^2 y1 - w^2 y0) / (1 + 2 w),
#
# which is the implicit step of `StoredHeat` from b over s; the first step is implicit Euler's. Steps that grow
# in geometric progression follow the fast rise after the start and the slow approach to steady alike. Stable for ratios
# below 1 + sqrt(2) (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, ch. III.5; Grigorieff, Numer.
# Math. 42 (1983) 359).

STEPS = 12
"""Steps of a warm-up."""
SPREAD = 3.0
"""Length of its last step over that of its first."""


def step_lengths(time: float, count: int = STEPS, spread: float = SPREAD) -> FloatArray:
    """(count,) lengths of the steps [s], each longer than the one before by the same ratio; they add up to ``time``."""
    lengths = np.geomspace(1.0, spread, count) if count > 1 else np.ones(1)
    return np.asarray(lengths * (time / lengths.sum()))


@dataclass(frozen=True)
class WarmingBody:
    """The last two fields of a body that warms up.

    capacity : body of the mesh -> density times specific heat [J/(m3 K)]
    latest, before : (n_nodes,) or one value [K]; ``before`` is None at the start
    length : of the step between them [s]
    """

    capacity: Mapping[str, float]
    latest: FloatArray | float
    before: FloatArray | float | None = None
    length: float = 0.0

    def step(self, length: float, kind: str) -> StoredHeat:
        """The condition of the next step; ``length`` [s], ``kind`` as its rows in the heat balance."""
        if self.before is None:
            return StoredHeat(capacity=self.capacity, start=self.latest, time=length, kind=kind)
        w = length / self.length
        start = ((1.0 + w) ** 2 * self.latest - w**2 * self.before) / (1.0 + 2.0 * w)
        time = length * (1.0 + w) / (1.0 + 2.0 * w)
        return StoredHeat(capacity=self.capacity, start=start, time=time, kind=kind)

    def after(self, field: FloatArray, length: float) -> "WarmingBody":
        """With the field (n_nodes,) that a step of ``length`` [s] ended with."""
        return WarmingBody(self.capacity, field, self.latest, length)

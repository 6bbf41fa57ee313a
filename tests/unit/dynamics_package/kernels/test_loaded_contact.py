"""Complementarity of contact forces against enumeration, a quadratic program and a general nonlinear solver."""

from itertools import product

import numpy as np
import pytest
from scipy.optimize import minimize, root

from dynamics.kernels.loaded_contact import (
    CONVERGED,
    NOT_POSITIVE,
    ContactProblem,
    local_approach,
    press_points,
)

SEEDS = pytest.mark.parametrize("seed", range(40))


def random_problem(seed: int, n: int, linear: bool) -> tuple[ContactProblem, float]:
    rng = np.random.default_rng(seed)
    root_ = rng.normal(size=(n, n))
    compliance = root_ @ root_.T / n + 0.05 * np.eye(n)
    c = 0.0 if linear else 10.0 ** rng.uniform(-2.5, -0.5)
    a = 10.0 ** rng.uniform(-3.0, 0.0) if linear else c * rng.uniform(3.0, 9.0)
    problem = ContactProblem(
        compliance, rng.uniform(0.0, 2.0, n), rng.uniform(0.8, 1.0, n), np.tile([a, c], (n, 1))
    )
    return problem, 10.0 ** rng.uniform(-1.5, 1.5)


def enumerated(problem: ContactProblem, force: float) -> np.ndarray:
    """Forces of a linear problem: the one set of touching points that pull nowhere and overlap nowhere."""
    n = len(problem.gap)
    whole = problem.compliance + np.diag(problem.local[:, 0])
    for touching in product([False, True], repeat=n):
        on = np.flatnonzero(touching)
        if not len(on):
            continue
        matrix = np.zeros((len(on) + 1,) * 2)
        matrix[:-1, :-1], matrix[:-1, -1], matrix[-1, :-1] = (
            whole[np.ix_(on, on)],
            -problem.weight[on],
            problem.weight[on],
        )
        solved = np.linalg.solve(matrix, np.append(-problem.gap[on], force))
        forces = np.zeros(n)
        forces[on] = solved[:-1]
        over = problem.weight * solved[-1] - problem.gap - whole @ forces
        if np.all(forces >= -1e-12) and np.all(over <= 1e-10):
            return forces
    raise AssertionError("no set of points solves the problem")


@SEEDS
def test_linear_problem_equals_the_enumeration_of_all_contact_sets(seed):
    problem, force = random_problem(seed, 2 + seed % 7, linear=True)
    solution = press_points(problem, force, np.nan, np.zeros(len(problem.gap)))
    assert solution.status == CONVERGED
    assert solution.force == pytest.approx(enumerated(problem, force), abs=1e-8 * force)


@pytest.mark.parametrize("seed", range(6))
def test_linear_problem_of_many_points_is_the_least_of_the_quadratic_program(seed):
    problem, force = random_problem(seed, 30, linear=True)
    forces = press_points(problem, force, np.nan, np.zeros(30)).force
    whole = problem.compliance + np.diag(problem.local[:, 0])

    def energy(at):
        return 0.5 * at @ whole @ at + problem.gap @ at

    found = minimize(
        energy,
        np.full(30, force / problem.weight.sum()),
        jac=lambda at: whole @ at + problem.gap,
        bounds=[(0.0, None)] * 30,
        constraints={
            "type": "eq",
            "fun": lambda at: problem.weight @ at - force,
            "jac": lambda at: problem.weight,
        },
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert energy(forces) <= found.fun * (1.0 + 1e-10)
    assert forces == pytest.approx(found.x, abs=2e-4 * force)


@SEEDS
@pytest.mark.parametrize("linear", [True, False])
def test_conditions_of_the_contact_hold_exactly(seed, linear):
    problem, force = random_problem(seed, 25, linear)
    solution = press_points(problem, force, np.nan, np.zeros(25))
    assert solution.status == CONVERGED and solution.residual <= 1e-12
    left = problem.weight * solution.approach - problem.gap - problem.compliance @ solution.force
    local = np.array(
        [local_approach(f, a, c) for f, (a, c) in zip(solution.force, problem.local, strict=True)]
    )
    on = solution.force > 0.0
    scale = np.abs(solution.closing).max()
    assert left[on] == pytest.approx(local[on], abs=1e-10 * scale)
    assert np.all(left[~on] <= 1e-10 * scale)
    assert problem.weight @ solution.force == pytest.approx(force, rel=1e-10)


@pytest.mark.parametrize("seed", range(20))
def test_nonlinear_local_approach_equals_a_general_solver(seed):
    problem, force = random_problem(seed, 8, linear=False)
    solution = press_points(problem, force, np.nan, np.zeros(8))
    on = solution.force > 0.0
    a, c = problem.local[0]
    turn = np.exp(a / c - 1.5)

    def local(forces):
        below = np.clip(forces, 1e-12, turn)
        return below * (a - c * np.log(below)) + 0.5 * c * np.maximum(forces - turn, 0.0)

    def equations(unknown):
        forces = np.exp(unknown[:-1])
        over = problem.weight[on] * unknown[-1] - problem.gap[on]
        over -= problem.compliance[np.ix_(on, on)] @ forces + local(forces)
        return np.append(over, problem.weight[on] @ forces - force)

    start = np.append(np.log(solution.force[on] * 1.05), solution.approach * 1.02)
    found = root(equations, start, tol=1e-13)
    assert np.exp(found.x[:-1]) == pytest.approx(solution.force[on], rel=1e-7)
    assert found.x[-1] == pytest.approx(solution.approach, rel=1e-8)


def test_tangent_is_the_derivative_of_the_force():
    problem, force = random_problem(3, 20, linear=False)
    solution = press_points(problem, force, np.nan, np.zeros(20))
    step = 1e-6 * solution.approach
    forces = [
        problem.weight @ press_points(problem, np.nan, solution.approach + d, solution.force).force
        for d in (-step, step)
    ]
    assert (forces[1] - forces[0]) / (2.0 * step) == pytest.approx(solution.tangent, rel=1e-6)


def test_given_approach_and_given_force_are_the_same_problem():
    problem, force = random_problem(5, 15, linear=False)
    by_force = press_points(problem, force, np.nan, np.zeros(15))
    by_approach = press_points(problem, np.nan, by_force.approach, np.zeros(15))
    assert by_approach.status == CONVERGED
    assert by_approach.force == pytest.approx(by_force.force, rel=1e-8, abs=1e-10 * force)


def test_approach_before_first_contact_gives_no_force():
    problem, _ = random_problem(5, 15, linear=False)
    solution = press_points(problem, np.nan, 0.5 * problem.gap.min(), np.zeros(15))
    assert solution.status == CONVERGED and not solution.force.any()


def test_start_from_the_neighbour_gives_the_same_in_fewer_steps():
    problem, force = random_problem(8, 30, linear=False)
    first = press_points(problem, force, np.nan, np.zeros(30))
    again = press_points(problem, 1.01 * force, first.approach, first.force)
    fresh = press_points(problem, 1.01 * force, np.nan, np.zeros(30))
    assert again.force == pytest.approx(fresh.force, rel=1e-8, abs=1e-10 * force)
    assert again.steps <= fresh.steps


def test_compliance_that_is_not_positive_definite_is_refused():
    n = 3
    problem = ContactProblem(-np.eye(n), np.zeros(n), np.ones(n), np.tile([0.1, 0.0], (n, 1)))
    assert press_points(problem, 1.0, np.nan, np.full(n, 1.0)).status == NOT_POSITIVE

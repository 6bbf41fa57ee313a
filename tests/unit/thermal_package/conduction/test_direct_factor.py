"""Factors as a preconditioner: exact for their own system, small-rank part included; small meshes only."""

import numpy as np
import pytest
from scipy import sparse

from tests.builders.coupled_blocks import CAPACITY, CONDUCTIVITY, conditions, coupled_blocks
from thermal.conduction import terms as conduction_terms
from thermal.conduction.capacity import HeatCapacity, Storage
from thermal.conduction.steady import ConductionSetup
from thermal.conduction.terms import ConductionProblem
from thermal.fe.direct_factor import DirectFactor
from thermal.fe.solver import LowRank, TwoLevelMultigrid, gmres


@pytest.fixture(scope="module")
def problem() -> ConductionProblem:
    setup = ConductionSetup(coupled_blocks(), CONDUCTIVITY)
    problem = ConductionProblem(setup, conditions())
    base = problem.start(320.0)
    return problem.storing(
        Storage(HeatCapacity(setup.elements, CAPACITY), problem.volumes.capacity, 0.1, base)
    )


def test_woodbury_inverts_the_small_rank_part() -> None:
    rng = np.random.default_rng(1)
    a = rng.normal(size=(30, 30))
    matrix = a @ a.T + 30.0 * np.eye(30)
    left, right = rng.normal(size=(2, 30, 3))
    factor = DirectFactor(sparse.csr_array(matrix), rng.normal(size=(30, 3)))
    load = rng.normal(size=30)
    assert factor(load) == pytest.approx(np.linalg.solve(matrix, load), rel=1e-10)
    factor.set_low_rank(LowRank(sparse.csc_array(left), sparse.csc_array(right)))
    assert factor(load) == pytest.approx(np.linalg.solve(matrix + left @ right.T, load), rel=1e-9)
    factor.set_low_rank(None)
    assert factor(load) == pytest.approx(np.linalg.solve(matrix, load), rel=1e-10)


def test_a_time_step_on_a_small_mesh_is_solved_at_once(problem: ConductionProblem) -> None:
    field = problem.start(320.0)
    linear = problem.linearise(field)
    made = problem.preconditioner(linear, field)
    assert isinstance(made, DirectFactor)
    load = linear.load(problem.residual(problem.heat_out(field)[0]))
    assert gmres(linear, load, made, tolerance=1e-10).iterations <= 2


def test_larger_meshes_and_steady_states_keep_multigrid(
    problem: ConductionProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    field = problem.start(320.0)
    steady = ConductionProblem(problem.setup, problem.conditions)
    assert isinstance(steady.preconditioner(steady.linearise(field), field), TwoLevelMultigrid)
    monkeypatch.setattr(conduction_terms, "MOST_NODES", problem.n_nodes - 1)
    assert isinstance(problem.preconditioner(problem.linearise(field), field), TwoLevelMultigrid)

"""Multigrid gives what a direct solver gives, in a number of iterations that does not grow with the mesh."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import sparse
from scipy.spatial import Delaunay

from tests.builders.direct_solution import solve_direct
from tests.builders.scikit_fem_mesh import second_order
from thermal.errors import ThermalNotConverged
from thermal.fe.aggregation import rigid_modes
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh, box_mesh, disjoint_union
from thermal.fe.multigrid import Scaling
from thermal.fe.solver import (
    HeldMatrix,
    LowRank,
    TwoLevelMultigrid,
    conjugate_gradient,
    constrain,
    gmres,
)


def heat_problem(divisions: int, held: bool = False):
    """Matrix, load and multigrid of a box with a film on one face, or with that face held at zero."""
    elements = FiniteElements(box_mesh((1.0, 1.5, 1.0), (divisions,) * 3))
    k = np.full(len(elements.mesh.cells), 45.0)
    fine, coarse = elements.fine.conduction(k), elements.coarse.conduction(k)
    face = elements.surfaces["z_min"]
    fixed = np.zeros(len(elements.mesh.points), dtype=bool)
    if held:
        fixed[face.nodes] = True
    else:
        face.add_mass(fine, np.full_like(face.weights, 50.0))
        face.add_coarse_mass(coarse, np.full_like(face.weights, 50.0))
    matrix = constrain(elements.fine.matrix(fine), fixed)
    held_corners = fixed[elements.corners]
    linear = constrain(elements.coarse.matrix(coarse), held_corners)
    multigrid = TwoLevelMultigrid(
        HeldMatrix(matrix, fixed), HeldMatrix(linear, held_corners), elements.prolongation
    )
    return elements, matrix, np.where(fixed, 0.0, elements.body_load("box")), multigrid


def elastic_problem(divisions: int):
    """The box clamped on one face, heated unevenly."""
    elements = FiniteElements(box_mesh((1.0, 1.5, 1.0), (divisions,) * 3))
    n = len(elements.mesh.cells)
    young, poisson = np.full(n, 210e9), np.full(n, 0.3)
    fixed = np.zeros((len(elements.mesh.points), 3), dtype=bool)
    fixed[elements.surfaces["z_min"].nodes] = True
    held_corners = fixed[elements.corners].ravel()
    blocks = [level.elasticity(young, poisson) for level in (elements.fine, elements.coarse)]
    matrix = constrain(elements.fine.block_matrix(blocks[0]), fixed.ravel())
    linear = constrain(elements.coarse.block_matrix(blocks[1]), held_corners)
    modes = rigid_modes(elements.mesh.points[elements.corners])
    multigrid = TwoLevelMultigrid(
        HeldMatrix(matrix, fixed.ravel()), HeldMatrix(linear, held_corners), elements.prolongation, modes
    )
    excess = 100.0 * np.sin(3.0 * elements.mesh.points).sum(axis=1)
    load = elements.fine.expansion_load(np.full(n, 6e6), excess).ravel()
    return matrix, np.where(fixed.ravel(), 0.0, load), multigrid


@pytest.mark.parametrize("held", [False, True])
def test_heat_multigrid_equals_direct(held: bool) -> None:
    _, matrix, load, multigrid = heat_problem(5, held)
    solution = conjugate_gradient(matrix, load, multigrid, tolerance=1e-12)
    direct = solve_direct(matrix, load)
    assert_allclose(solution.values, direct, rtol=0.0, atol=1e-10 * np.abs(direct).max())


def test_elastic_multigrid_equals_direct() -> None:
    matrix, load, multigrid = elastic_problem(4)
    solution = conjugate_gradient(matrix, load, multigrid, tolerance=1e-12)
    direct = solve_direct(matrix, load)
    assert_allclose(solution.values, direct, rtol=0.0, atol=1e-10 * np.abs(direct).max())


def test_heat_takes_eight_iterations_at_any_size() -> None:
    counts = []
    for divisions in (4, 8, 12):
        _, matrix, load, multigrid = heat_problem(divisions)
        counts.append(conjugate_gradient(matrix, load, multigrid, tolerance=1e-8).iterations)
    assert max(counts) <= 8
    assert max(counts) - min(counts) <= 1


def test_mechanics_takes_sixteen_iterations_at_any_size() -> None:
    counts = []
    for divisions in (4, 8):
        matrix, load, multigrid = elastic_problem(divisions)
        counts.append(conjugate_gradient(matrix, load, multigrid, tolerance=1e-8).iterations)
    assert max(counts) <= 16
    assert max(counts) - min(counts) <= 2


def flat_cells(divisions: int, off: float) -> NamedMesh:
    """Delaunay's tetrahedra of a grid whose inner points are moved by up to ``off`` spacings: many are flat."""
    grid = np.stack(np.meshgrid(*[np.arange(divisions + 1.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    inner = ((grid > 0) & (grid < divisions)).all(axis=1)
    points = grid + inner[:, None] * off * np.random.default_rng(0).uniform(-1.0, 1.0, grid.shape)
    cells = Delaunay(points).simplices
    cells = cells[np.abs(np.linalg.det(points[cells[:, 1:]] - points[cells[:, :1]])) > 1e-6]
    sides = np.sort(cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    facets, count = np.unique(sides, axis=0, return_counts=True)
    bodies = {"box": np.arange(len(cells), dtype=np.int32)}
    return second_order(points / divisions, cells.astype(np.int32), bodies, {"skin": facets[count == 1]})


def test_flat_cells_cost_few_iterations() -> None:
    # scaled node by node it is 37 iterations for heat, 54 for expansion; in groups 21 and 23
    mesh = flat_cells(12, 0.1)
    elements = FiniteElements(mesh)
    n = len(mesh.cells)
    k = np.full(n, 45.0)
    fine, coarse = elements.fine.conduction(k), elements.coarse.conduction(k)
    skin = elements.surfaces["skin"]
    skin.add_mass(fine, np.full_like(skin.weights, 50.0))
    skin.add_coarse_mass(coarse, np.full_like(skin.weights, 50.0))
    free, free_corners = np.zeros(len(mesh.points), dtype=bool), np.zeros(len(elements.corners), dtype=bool)
    matrix = elements.fine.matrix(fine)
    multigrid = TwoLevelMultigrid(
        HeldMatrix(matrix, free),
        HeldMatrix(elements.coarse.matrix(coarse), free_corners),
        elements.prolongation,
    )
    heat = conjugate_gradient(matrix, elements.body_load("box"), multigrid, tolerance=1e-8)
    levels = [
        level.block_matrix(level.elasticity(np.full(n, 210e9), np.full(n, 0.3)))
        for level in (elements.fine, elements.coarse)
    ]
    free_levels = [HeldMatrix(level, np.zeros(level.shape[0], dtype=bool)) for level in levels]
    modes = rigid_modes(mesh.points[elements.corners])
    elastic = TwoLevelMultigrid(*free_levels, elements.prolongation, modes)
    excess = 100.0 * np.sin(3.0 * mesh.points).sum(axis=1)
    load = elements.fine.expansion_load(np.full(n, 6e6), excess).ravel()
    expansion = conjugate_gradient(levels[0], load, elastic, tolerance=1e-8)
    assert heat.iterations <= 24
    assert expansion.iterations <= 27


@pytest.mark.parametrize("block", [1, 3])
def test_tied_nodes_are_scaled_by_the_inverse_of_their_block(block: int) -> None:
    # nodes 0 and 1 are tied, nodes 2 and 3 with one another, node 4 with nobody
    tie = np.eye(5)
    tie[[0, 1, 2, 3], [1, 0, 3, 2]] = -0.999, -0.999, -0.7, -0.7
    tie[[0, 4], [4, 0]] = 0.3
    dense = np.kron(tie, np.eye(block)) * np.outer(*[np.arange(1.0, 5 * block + 1)] * 2)
    matrix = sparse.csr_array(dense) if block == 1 else sparse.bsr_array(dense, blocksize=(3, 3))
    residual = np.linspace(1.0, 2.0, 5 * block)
    expected = np.zeros(5 * block)
    for group in ([0, 1], [2, 3], [4]):
        mine = (block * np.array(group)[:, None] + np.arange(block)).ravel()
        expected[mine] = np.linalg.solve(dense[np.ix_(mine, mine)], residual[mine])
    assert_allclose(Scaling(matrix)(residual.astype(np.float32)), expected, rtol=0.01)


def test_cycle_is_symmetric_and_positive() -> None:
    _, matrix, _, multigrid = heat_problem(3, held=True)
    rng = np.random.default_rng(1)
    a, b = rng.standard_normal((2, matrix.shape[0]))
    assert a @ multigrid(b) == pytest.approx(b @ multigrid(a), rel=1e-5)
    assert a @ multigrid(a) > 0.0


def test_constrained_matrix_keeps_the_rest_and_its_input() -> None:
    elements = FiniteElements(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)))
    blocks = elements.fine.elasticity(np.full(6, 2.0), np.full(6, 0.3))
    matrix = elements.fine.block_matrix(blocks)
    before = matrix.toarray()
    fixed = np.zeros(matrix.shape[0], dtype=bool)
    fixed[[0, 4, 17]] = True
    after = constrain(matrix, fixed).toarray()
    expected = before.copy()
    expected[fixed], expected[:, fixed] = 0.0, 0.0
    expected[fixed, fixed] = before[fixed, fixed]
    assert_array_equal(after, expected)
    assert_array_equal(matrix.toarray(), before)
    in_place = constrain(matrix, fixed, overwrite=True)
    assert_array_equal(in_place.toarray(), expected)
    assert np.shares_memory(in_place.data, matrix.data)


def test_gmres_with_small_rank_part_equals_direct() -> None:
    elements, matrix, load, multigrid = heat_problem(4)
    top, side = elements.surfaces["z_max"], elements.surfaces["x_min"]
    part = LowRank(
        sparse.csc_array(np.column_stack([30.0 * top.shares, -8.0 * side.shares])),
        sparse.csc_array(np.column_stack([side.shares, top.shares])),
    )

    def operator(x: np.ndarray) -> np.ndarray:
        return matrix @ x + part @ x

    multigrid.set_low_rank(part)
    solution = gmres(operator, load, multigrid, tolerance=1e-12)
    full = matrix.toarray() + part.left.toarray() @ part.right.toarray().T
    assert_allclose(solution.values, np.linalg.solve(full, load), rtol=1e-9)
    with_part = solution.iterations
    multigrid.set_low_rank(None)
    without = gmres(operator, load, multigrid, tolerance=1e-12).iterations
    plain = gmres(lambda x: matrix @ x, load, multigrid, tolerance=1e-12).iterations
    assert with_part <= plain + 1
    assert without > with_part


def test_zero_load_needs_no_iteration() -> None:
    _, matrix, load, multigrid = heat_problem(2)
    for solution in (
        conjugate_gradient(matrix, 0.0 * load, multigrid),
        gmres(lambda x: matrix @ x, 0.0 * load, multigrid),
    ):
        assert solution.iterations == 0
        assert not solution.values.any()


def test_a_stalled_solve_reports_its_history() -> None:
    _, matrix, load, _ = heat_problem(3)
    for solve in (
        lambda: conjugate_gradient(matrix, load, lambda r: r, max_iterations=3),
        lambda: gmres(lambda x: matrix @ x, load, lambda r: r, max_iterations=3),
    ):
        with pytest.raises(ThermalNotConverged, match="after 3 iterations is above 1e-10") as failure:
            solve()
        assert len(failure.value.residuals) == 4
        assert isinstance(failure.value, RuntimeError)


def test_solutions_are_the_same_bits_every_time() -> None:
    first, second = (heat_problem(4) for _ in range(2))
    results = [conjugate_gradient(m, b, g).values.tobytes() for _, m, b, g in (first, second)]
    assert results[0] == results[1]


@pytest.mark.parametrize("small", [1, 2])
def test_a_small_loose_piece_beside_a_large_one_costs_nothing(small: int) -> None:
    # it is one aggregate levels before the large one is, and must go down to the last level with it
    large = box_mesh((1.0, 1.0, 1.0), (9, 9, 9), name="large")
    piece = box_mesh((0.1, 0.1, 0.1), (small,) * 3, origin=(2.0, 0.0, 0.0), name="small")
    piece = replace(piece, surfaces={f"small_{name}": nodes for name, nodes in piece.surfaces.items()})
    mesh = disjoint_union(large, piece)
    elements = FiniteElements(mesh)
    n = len(mesh.cells)
    levels = [
        level.block_matrix(level.elasticity(np.full(n, 210e9), np.full(n, 0.3)))
        for level in (elements.fine, elements.coarse)
    ]
    free_levels = [HeldMatrix(level, np.zeros(level.shape[0], dtype=bool)) for level in levels]
    modes = rigid_modes(mesh.points[elements.corners])
    multigrid = TwoLevelMultigrid(*free_levels, elements.prolongation, modes)
    excess = 100.0 * np.sin(3.0 * mesh.points).sum(axis=1)
    load = elements.fine.expansion_load(np.full(n, 6e6), excess).ravel()
    assert conjugate_gradient(levels[0], load, multigrid, tolerance=1e-8).iterations <= 16
    vector = np.random.default_rng(0).standard_normal(len(load))
    for _ in range(15):
        vector = multigrid(levels[0] @ (vector / np.linalg.norm(vector)))
    assert np.linalg.norm(vector) < 1.05

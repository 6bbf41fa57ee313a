"""Order of elimination and the factor made in it, against a dense solution and against SuperLU."""

import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import LinAlgError
from scipy.sparse.linalg import splu

from thermal.fe.direct_factor import LEAF, DirectFactor, nested_dissection


def lattice(shape: tuple[int, int, int], unknowns: int, seed: int = 0) -> tuple[sparse.csr_array, np.ndarray]:
    """Springs between neighbours of a lattice with one node held: a matrix of ``unknowns`` a node, and the points."""
    rng = np.random.default_rng(seed)
    numbers = np.arange(np.prod(shape)).reshape(shape)
    points = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3) + 0.0
    pairs = [
        np.stack([np.take(numbers, range(n - 1), axis).ravel(), np.take(numbers, range(1, n), axis).ravel()], axis=1)
        for axis, n in enumerate(shape)
    ]  # fmt: skip
    block = rng.normal(size=(unknowns, unknowns))
    spring = block @ block.T + np.eye(unknowns)
    ends = np.concatenate(pairs)
    graph = sparse.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(points),) * 2).tocsr()
    graph = graph + graph.T
    laplacian = sparse.diags_array(graph.sum(axis=0) + 1e-3) - graph
    order = rng.permutation(len(points))
    return sparse.csr_array(sparse.kron(laplacian[order][:, order], spring)), points[order]


def test_separators_part_the_whole_and_hold_every_node_once() -> None:
    matrix, points = lattice((12, 9, 7), 1)
    separators = nested_dissection(matrix, points)
    assert np.array_equal(np.sort(np.concatenate([one.nodes for one in separators])), np.arange(len(points)))
    whole: list[np.ndarray] = []
    for one in separators:
        parts = [whole[part] for part in one.parts]
        if len(parts) == 2:
            assert matrix[parts[0]][:, parts[1]].nnz == 0
        whole.append(np.concatenate([one.nodes, *parts]))
        assert one.parts or len(one.nodes) <= LEAF
    assert len(separators[-1].nodes) < 0.15 * len(points) and len(separators) > 10


@pytest.mark.parametrize("unknowns", [1, 2, 3])
def test_several_loads_are_solved_to_rounding(unknowns: int) -> None:
    matrix, points = lattice((11, 6, 5), unknowns)
    loads = np.random.default_rng(1).normal(size=(matrix.shape[0], 4))
    factor = DirectFactor(matrix, points, np.arange(0, len(loads), unknowns))
    assert factor(loads) == pytest.approx(splu(sparse.csc_array(matrix)).solve(loads), rel=1e-9, abs=1e-9)
    assert factor(loads[:, 2]) == pytest.approx(factor(loads)[:, 2], rel=1e-12)


def test_points_that_no_plane_parts_are_eliminated_at_once() -> None:
    matrix, points = lattice((5, 5, 5), 1)
    load = np.arange(125.0)
    assert DirectFactor(matrix, 0.0 * points)(load) == pytest.approx(DirectFactor(matrix, points)(load))


def test_a_matrix_that_is_not_positive_definite_is_refused() -> None:
    matrix, points = lattice((6, 6, 6), 1)
    with pytest.raises(LinAlgError, match="not positive definite"):
        DirectFactor(sparse.csr_array(matrix - 2.0 * sparse.eye_array(len(points))), points)
    with pytest.raises(ValueError, match="10 points for 216 nodes"):
        DirectFactor(matrix, points[:10])

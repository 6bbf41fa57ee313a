"""Quadrature integrates every monomial up to its degree; shape functions are what they must be."""

from itertools import product
from math import factorial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from thermal.fe import reference
from thermal.fe.reference import Rule


@pytest.mark.parametrize(
    ("rule", "degree"),
    [(reference.TETRAHEDRON_4, 2), (reference.TETRAHEDRON_14, 5), (reference.TRIANGLE_7, 5)],
)
def test_rules_are_exact_to_their_degree_and_no_further(rule: Rule, degree: int) -> None:
    dimension = rule.points.shape[1]

    def error(powers: tuple[int, ...]) -> float:
        exact = np.prod([factorial(p) for p in powers]) / factorial(sum(powers) + dimension)
        return abs(float(rule.weights @ np.prod(rule.points ** np.array(powers), axis=1)) - exact)

    powers = list(product(range(degree + 2), repeat=dimension))
    assert max(error(p) for p in powers if sum(p) <= degree) < 1e-15
    assert max(error(p) for p in powers if sum(p) == degree + 1) > 1e-7
    assert rule.weights.min() > 0.0
    assert rule.points.min() > 0.0
    assert rule.points.sum(axis=1).max() < 1.0


@pytest.mark.parametrize(
    ("values", "gradients", "dimension"),
    [
        (reference.tetrahedron_values, reference.tetrahedron_gradients, 3),
        (reference.triangle_values, reference.triangle_gradients, 2),
    ],
)
def test_shape_functions_are_nodal_and_their_gradients_their_slopes(
    values, gradients, dimension: int
) -> None:
    corners = np.vstack([np.zeros(dimension), np.eye(dimension)])
    edges = reference.CELL_EDGES[: 6 if dimension == 3 else 3]
    nodes = np.vstack([corners, [0.5 * (corners[a] + corners[b]) for a, b in edges]])
    assert_allclose(values(nodes), np.eye(len(nodes)), atol=1e-15)
    at, step = np.full((1, dimension), 0.2), 1e-6
    for axis in range(dimension):
        move = step * np.eye(dimension)[axis]
        slope = (values(at + move) - values(at - move)) / (2.0 * step)
        assert_allclose(gradients(at)[0, :, axis], slope[0], atol=1e-9)
    assert_allclose(gradients(at).sum(axis=1), 0.0, atol=1e-15)

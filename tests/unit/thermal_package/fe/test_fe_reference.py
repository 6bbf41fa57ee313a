"""The tables taken from scikit-fem: rules of the right degree, nodes, sides and orders where they must be."""

from itertools import product
from math import factorial

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from thermal.fe.reference_elements import (
    CELLS,
    HEXAHEDRON_20,
    HEXAHEDRON_27,
    SIDES,
    TETRAHEDRON_10,
    CellElement,
    QuadratureRule,
    ReferenceElement,
)

ELEMENTS = (*CELLS.values(), *SIDES.values())


def on_simplex(powers: tuple[int, ...]) -> float:
    return float(np.prod([factorial(p) for p in powers]) / factorial(sum(powers) + len(powers)))


def on_cube(powers: tuple[int, ...]) -> float:
    return float(np.prod([1.0 / (p + 1) for p in powers]))


@pytest.mark.parametrize(
    ("rule", "points", "degree"),
    [
        (TETRAHEDRON_10.linear_rule, 1, 1),
        (TETRAHEDRON_10.stiffness_rule, 4, 2),
        (TETRAHEDRON_10.load_rule, 14, 5),
        (TETRAHEDRON_10.side.load_rule, 7, 5),
    ],
)
def test_simplex_rules_are_exact_to_their_degree_and_no_further(
    rule: QuadratureRule, points: int, degree: int
) -> None:
    def error(powers: tuple[int, ...]) -> float:
        return abs(
            float(rule.weights @ np.prod(rule.points ** np.array(powers), axis=1)) - on_simplex(powers)
        )

    assert len(rule.weights) == points
    powers = list(product(range(degree + 2), repeat=rule.points.shape[1]))
    assert max(error(p) for p in powers if sum(p) <= degree) < 1e-15
    assert max(error(p) for p in powers if sum(p) == degree + 1) > 1e-7
    assert rule.weights.min() > 0.0
    assert rule.points.min() > 0.0
    assert rule.points.sum(axis=1).max() < 1.0


@pytest.mark.parametrize(
    ("rule", "points", "degree"),
    [
        (HEXAHEDRON_20.linear_rule, 8, 3),
        (HEXAHEDRON_27.stiffness_rule, 27, 5),
        (HEXAHEDRON_27.load_rule, 27, 5),
        (HEXAHEDRON_20.side.load_rule, 9, 5),
    ],
)
def test_brick_rules_are_exact_to_their_degree_in_each_coordinate(
    rule: QuadratureRule, points: int, degree: int
) -> None:
    def error(powers: tuple[int, ...]) -> float:
        return abs(float(rule.weights @ np.prod(rule.points ** np.array(powers), axis=1)) - on_cube(powers))

    assert len(rule.weights) == points
    powers = list(product(range(degree + 2), repeat=rule.points.shape[1]))
    assert max(error(p) for p in powers if max(p) <= degree) < 1e-14
    assert min(error(p) for p in powers if max(p) == degree + 1) > 1e-6
    assert rule.weights.min() > 0.0
    assert rule.points.min() > 0.0 and rule.points.max() < 1.0


@pytest.mark.parametrize("shape", ELEMENTS, ids=lambda s: s.name)
def test_shape_functions_are_nodal_and_their_gradients_their_slopes(shape: ReferenceElement) -> None:
    dimension = shape.corners.shape[1]
    assert_array_equal(shape.values(shape.nodes), np.eye(shape.n_nodes))
    assert_array_equal(shape.corner_values(shape.corners), np.eye(shape.n_corners))
    at, step = np.array([[0.2, 0.15, 0.3]])[:, :dimension], 1e-6
    pairs = ((shape.values, shape.gradients), (shape.corner_values, shape.corner_gradients))
    for values, gradients in pairs:
        assert values(at).sum() == pytest.approx(1.0, abs=1e-15)
        assert_allclose(gradients(at).sum(axis=1), 0.0, atol=1e-14)
        for axis in range(dimension):
            move = step * np.eye(dimension)[axis]
            slope = (values(at + move) - values(at - move)) / (2.0 * step)
            assert_allclose(gradients(at)[0, :, axis], slope[0], atol=1e-9)


@pytest.mark.parametrize("shape", CELLS.values(), ids=lambda s: s.name)
def test_quadratic_fields_are_in_the_space(shape: CellElement) -> None:
    at = np.random.default_rng(0).uniform(0.05, 0.3, (5, 3))
    for powers in product(range(3), repeat=3):
        if sum(powers) <= 2:
            nodal = np.prod(shape.nodes ** np.array(powers), axis=1)
            assert_allclose(shape.values(at) @ nodal, np.prod(at ** np.array(powers), axis=1), atol=1e-15)


@pytest.mark.parametrize("shape", CELLS.values(), ids=lambda s: s.name)
def test_nodes_stand_in_the_order_of_vtk(shape: CellElement) -> None:
    # vtkQuadraticTetra; vtkQuadraticHexahedron and vtkTriQuadraticHexahedron: edges below, above, between, then sides
    edges = {
        4: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
        8: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
    }[shape.n_corners]
    sides = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (2, 3, 7, 6), (0, 3, 2, 1), (4, 5, 6, 7), range(8))
    between = [*edges, *sides][: shape.n_nodes - shape.n_corners]
    middles = [shape.corners[list(corners)].mean(axis=0) for corners in between]
    assert_array_equal(shape.nodes[shape.n_corners :], middles)
    assert [set(parents) for parents in shape.parents] == [set(corners) for corners in between]
    a, b, c = shape.corners[[1, 3, 4] if shape.n_corners == 8 else [1, 2, 3]] - shape.corners[0]
    assert np.cross(a, b) @ c == pytest.approx(1.0)


@pytest.mark.parametrize("shape", CELLS.values(), ids=lambda s: s.name)
def test_sides_look_outwards_and_mirrored_nodes_turn_the_cell_round(shape: CellElement) -> None:
    centre = shape.corners.mean(axis=0)
    for side in shape.sides:
        a, b, c = shape.nodes[side[:3]]
        assert np.cross(b - a, c - a) @ (a - centre) > 0.0
        for node, parents in zip(side[shape.side.n_corners :], shape.side.parents, strict=True):
            assert_array_equal(shape.nodes[node], shape.nodes[side[list(parents)]].mean(axis=0))
    determinant = np.linalg.det(np.einsum("nd,nj->dj", shape.nodes[list(shape.mirror)],
                                          shape.gradients(centre[None])[0]))  # fmt: skip
    assert determinant == pytest.approx(-1.0)


def test_gmsh_numbers_its_nodes_as_the_tables_say() -> None:
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(argv=["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        for kind, shape in ((11, TETRAHEDRON_10), (17, HEXAHEDRON_20), (12, HEXAHEDRON_27)):
            places = np.array(gmsh.model.mesh.getElementProperties(kind)[4]).reshape(-1, 3)
            if shape.n_corners == 8:  # gmsh's reference cube lies between -1 and 1
                places = 0.5 * (places + 1.0)
            assert_allclose(places[list(shape.gmsh_order)], shape.nodes, atol=1e-12)
    finally:
        gmsh.finalize()

"""Thermo-elasticity against exact fields: third order in L2, no stress under a linear temperature.

The manufactured field is Goodier's thermo-elastic potential: u = grad psi satisfies equilibrium without body
force if laplace psi = (1 + nu) / (1 - nu) alpha (T - T0). Source: Goodier, Phil. Mag. 23 (1937) 1017. A field
T - T0 = g . x leaves a free body without stress (Boley, Weiner, Theory of Thermal Stresses, 1960).
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from thermal.expansion.elastic import ElasticError, ElasticSetup, rigid_motion, three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh, box_mesh, disjoint_union
from thermal.fe.solver import HeldMatrix, TwoLevelMultigrid, conjugate_gradient, constrain

STEEL = (210e9, 0.3, 11.5e-6)
WAVES = np.array([2.0, 1.5, 1.0])


def bent_box(divisions: int) -> NamedMesh:
    """A box with curved cells inside and out."""
    mesh = box_mesh((1.0, 1.0, 1.0), (divisions,) * 3)
    x, y, z = mesh.points.T
    return replace(mesh, points=np.column_stack([x + 0.1 * np.sin(2.0 * z), y + 0.1 * x * z, z]))


def potential_slope(points: np.ndarray) -> np.ndarray:
    """Gradient (n, 3) of psi = 1e-4 sin(ax) sin(by) sin(cz)."""
    sines, cosines = np.sin(WAVES * points), np.cos(WAVES * points)
    parts = [WAVES[i] * cosines[:, i] * np.prod(np.delete(sines, i, axis=1), axis=1) for i in range(3)]
    return 1e-4 * np.column_stack(parts)


def excess(points: np.ndarray) -> np.ndarray:
    """Temperature above the cold one (n,) [K] that belongs to psi."""
    _, nu, alpha = STEEL
    psi = 1e-4 * np.prod(np.sin(WAVES * points), axis=1)
    return -(1.0 - nu) / (1.0 + nu) * (WAVES @ WAVES) * psi / alpha


def displacement_error(divisions: int) -> float:
    """L2 error [m^2.5] with the exact displacement prescribed on the whole boundary."""
    elements = FiniteElements(bent_box(divisions))
    points, n = elements.mesh.points, len(elements.mesh.cells)
    young, nu, alpha = (np.full(n, value) for value in STEEL)
    fixed = np.zeros((len(points), 3), dtype=bool)
    for surface in elements.surfaces.values():
        fixed[surface.nodes] = True
    blocks = [level.elasticity(young, nu) for level in (elements.fine, elements.coarse)]
    matrix = elements.fine.block_matrix(blocks[0])
    flat, held = fixed.ravel(), fixed[elements.corners].ravel()
    inner = constrain(matrix, flat)
    coarse = constrain(elements.coarse.block_matrix(blocks[1]), held)
    lift = np.where(fixed, potential_slope(points), 0.0).ravel()
    load = elements.fine.expansion_load(alpha * young / (1.0 - 2.0 * nu), excess(points)).ravel()
    multigrid = TwoLevelMultigrid(HeldMatrix(inner, flat), HeldMatrix(coarse, held), elements.prolongation)
    right = np.where(flat, 0.0, load - matrix @ lift)
    solution = lift + conjugate_gradient(inner, right, multigrid, tolerance=1e-12).values
    values, volumes = elements.at_points(solution.reshape(-1, 3))
    places, _ = elements.at_points(points)
    error = values - potential_slope(places)
    return float(np.sqrt(volumes @ np.sum(error**2, axis=1)))


def test_order_three_in_l2_on_curved_cells() -> None:
    errors = [displacement_error(divisions) for divisions in (2, 4, 8)]
    rate = -np.polyfit(np.log([2, 4, 8]), np.log(errors), 1)[0]
    assert rate == pytest.approx(3.0, abs=0.3)
    assert errors[-1] < 1e-3 * 1e-4


def supported(mesh: NamedMesh, face: str = "z_min") -> ElasticSetup:
    """A body on three, two and one supports in one face."""
    elements = FiniteElements(mesh)
    fixed = np.zeros((len(mesh.points), 3), dtype=bool)
    nodes = np.intersect1d(elements.surfaces[face].nodes, elements.corners)
    for node, directions in three_two_one(mesh.points, nodes.astype(np.int32)):
        fixed[node, list(directions)] = True
    assert fixed.sum() == 6
    return ElasticSetup(elements, dict.fromkeys(mesh.bodies, STEEL), fixed)


def stress(setup: ElasticSetup, displacement: np.ndarray, above: np.ndarray) -> np.ndarray:
    """Stress (n_q, 3, 3) [Pa] at the quadrature points."""
    young, nu, alpha = STEEL
    elements = setup.elements
    slope = np.stack([elements.fine.gradient(part) for part in displacement.T], axis=2).reshape(-1, 3, 3)
    heat = elements.fine.at_points(above).ravel()
    elastic = 0.5 * (slope + np.swapaxes(slope, 1, 2)) - alpha * heat[:, None, None] * np.eye(3)
    lam, mu = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * young / (1.0 + nu)
    return lam * np.trace(elastic, axis1=1, axis2=2)[:, None, None] * np.eye(3) + 2.0 * mu * elastic


@pytest.mark.parametrize(
    "mesh", [box_mesh((1.0, 0.7, 0.4), (3, 3, 3)), bent_box(3)], ids=["straight", "curved"]
)
@pytest.mark.parametrize("face", ["z_min", "x_max"])
def test_uniform_heating_is_free(mesh: NamedMesh, face: str) -> None:
    setup = supported(mesh, face)
    solution = setup.solve(np.full(len(mesh.points), 393.15), 293.15, tolerance=1e-12)
    # one ten-millionth of the 240 MPa that a clamped body would show, on the 0.3 m2 of a face
    assert np.abs(solution.reactions).max() < 1e-7 * 240e6 * 0.3
    assert np.abs(stress(setup, solution.values, np.full(len(mesh.points), 100.0))).max() < 1e-6 * 240e6
    growth = solution.values - solution.values[0] - 1.15e-3 * (mesh.points - mesh.points[0])
    _, _, turn = rigid_motion(mesh.points, growth, np.ones(len(mesh.points)))
    assert_allclose(growth, np.cross(turn, mesh.points - mesh.points[0]), atol=1e-12)


def test_linear_temperature_leaves_no_stress() -> None:
    mesh = box_mesh((1.0, 0.7, 0.4), (3, 3, 3))
    setup = supported(mesh)
    above = mesh.points @ [80.0, -50.0, 120.0]
    solution = setup.solve(293.15 + above, 293.15, tolerance=1e-13)
    assert np.abs(stress(setup, solution.values, above)).max() < 1e-6 * 240e6
    assert np.abs(solution.reactions).max() < 1.0
    bowed = setup.solve(293.15 + 100.0 * mesh.points[:, 0] ** 2, 293.15)
    assert np.abs(stress(setup, bowed.values, 100.0 * mesh.points[:, 0] ** 2)).max() > 1e-3 * 240e6


def test_reactions_are_those_of_a_clamped_bar() -> None:
    mesh = box_mesh((1.0, 0.1, 0.1), (10, 1, 1))
    elements = FiniteElements(mesh)
    fixed = np.zeros((len(mesh.points), 3), dtype=bool)
    for face, axis in (("x_min", 0), ("x_max", 0), ("y_min", 1), ("z_min", 2)):
        fixed[elements.surfaces[face].nodes, axis] = True
    setup = ElasticSetup(elements, {"box": STEEL}, fixed)
    solution = setup.solve(np.full(len(mesh.points), 303.15), 293.15, tolerance=1e-11)
    push = solution.reactions[elements.surfaces["x_min"].nodes, 0].sum()
    assert push == pytest.approx(STEEL[0] * STEEL[2] * 10.0 * 0.01, rel=1e-7)
    assert solution.reactions.sum(axis=0) == pytest.approx(0.0, abs=1e-3)


def test_loose_piece_and_bad_materials_are_refused() -> None:
    a = box_mesh((1.0, 1.0, 1.0), (1, 1, 1), name="a")
    b = box_mesh((1.0, 1.0, 1.0), (1, 1, 1), origin=(2.0, 0.0, 0.0), name="b")
    b = replace(b, surfaces={f"b_{name}": nodes for name, nodes in b.surfaces.items()})
    elements = FiniteElements(disjoint_union(a, b))
    fixed = np.zeros((len(elements.mesh.points), 3), dtype=bool)
    fixed[elements.surfaces["z_min"].nodes] = True
    for materials, message in (
        ({"a": STEEL, "b": STEEL}, "body b is held in 0 directions"),
        ({"a": STEEL}, "no elastic data for body b"),
        ({"a": STEEL, "b": STEEL, "c": STEEL}, "unknown body 'c'; nearest: a, b"),
        ({"a": STEEL, "b": (0.0, 0.3, 1e-5)}, "body 'b': Young's modulus 0.0 Pa"),
        ({"a": STEEL, "b": (1.0, 0.5, 1e-5)}, "body 'b': Poisson's ratio 0.5"),
        ({"a": STEEL, "b": (1.0, 0.3, float("nan"))}, "body 'b': expansion coefficient nan"),
    ):
        with pytest.raises(ElasticError, match=message):
            ElasticSetup(elements, materials, fixed)


def test_support_needs_more_than_a_line() -> None:
    points = np.column_stack([np.arange(5.0), np.zeros(5), np.zeros(5)])
    with pytest.raises(ElasticError, match="lie on one line"):
        three_two_one(points, np.arange(5, dtype=np.int32))


def test_very_flat_cells_are_solved_directly_where_the_iteration_stalls() -> None:
    thickness, width = 2e-4, 0.25
    mesh = box_mesh((1.0, 1.0, thickness), (4, 4, 1), cell="hexahedron20")
    setup = supported(mesh)
    solution = setup.solve(np.full(len(mesh.points), 303.15), 293.15)
    assert solution.iterations > 200
    assert solution.residuals[-1] < 1e-6
    left = solution.values - 1.15e-4 * mesh.points
    centre, shift, turn = rigid_motion(mesh.points, left, np.ones(len(left)))
    # stiffness of a cell: E width^2 / thickness across the plate, E thickness^3 / width^2 in bending; rounding of the
    # first divided by the second bends the plate (here 5e-4 of the expansion; ten operations are granted)
    rounding = 10.0 * np.finfo(float).eps * (width / thickness) ** 4
    assert_allclose(left, shift + np.cross(turn, mesh.points - centre), atol=rounding * 1.15e-4)

"""The recovered gradient against manufactured solutions: the estimated error is the true one."""

import numpy as np
import pytest

from tests.builders.curved_blocks import cylinder_sector
from tests.builders.poisson import solved
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, FloatArray, NamedMesh, box_mesh
from thermal.fe.recovery import energy_error


def true_error(elements: FiniteElements, u: FloatArray, gradient_at: FloatArray) -> float:
    """Energy norm of the error; gradient_at : (n_cells, n_q, 3) exact gradient at the stiffness points."""
    wrong = elements.fine.gradient(u) - gradient_at
    return float(np.sqrt(np.einsum("eq,eqi->", elements.fine.volumes, wrong**2)))


def sines(cell: CellName, n: int) -> tuple[float, float]:
    """Estimated and true error of u = sin 2x sin 3y sin z on a unit cube."""
    mesh = box_mesh((1.0, 1.0, 1.0), (n, n, n), cell=cell)
    k = np.array([2.0, 3.0, 1.0])

    def u(x: FloatArray) -> FloatArray:
        return np.asarray(np.prod(np.sin(k * x), axis=-1))

    elements, values = solved(mesh, u(mesh.points), 14.0 * u(mesh.points))
    at = elements.fine.at_points(mesh.points)
    sine, cosine = np.sin(k * at), k * np.cos(k * at)
    exact = np.stack([np.prod(np.where(np.arange(3) == i, cosine, sine), axis=-1) for i in range(3)], axis=-1)
    found = energy_error(elements, values, np.ones(len(mesh.cells)))
    return found.total, true_error(elements, values, exact)


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])
def test_effectivity_tends_to_one_and_the_order_is_two(cell: CellName) -> None:
    """Energy norm of second-order elements: order 2 (Ciarlet, theorem 3.2.2)."""
    coarse, fine = sines(cell, 4), sines(cell, 8)
    for estimate, true in (coarse, fine):
        assert 0.75 < estimate / true < 1.25
    assert abs(fine[0] / fine[1] - 1.0) < 0.15
    assert 1.7 < np.log2(coarse[0] / fine[0]) < 2.4


def test_curved_cells_with_a_singular_gradient_near_by() -> None:
    """u = ln r on a quarter ring from r = 0.2 to 1: the error sits at the bore, and is found there."""
    mesh = cylinder_sector((0.2, 1.0), (6, 6, 2), "ring", length=0.4)
    radius = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    elements, values = solved(mesh, np.log(radius), np.zeros(len(radius)))
    at = elements.fine.at_points(mesh.points)
    square = (at[..., :2] ** 2).sum(axis=-1)[..., None]
    exact = np.concatenate([at[..., :2] / square, np.zeros_like(square)], axis=-1)
    found = energy_error(elements, values, np.ones(len(mesh.cells)))
    whole = true_error(elements, values, exact)
    assert 0.7 < found.total / whole < 1.3
    inner = np.hypot(*at.mean(axis=1)[:, :2].T) < 0.34
    wrong = np.einsum("eq,eqi->e", elements.fine.volumes, (elements.fine.gradient(values) - exact) ** 2)
    share = wrong[inner].sum() / whole**2
    assert share > 0.7
    assert abs(np.sum(found.by_cell[inner] ** 2) / found.total**2 / share - 1.0) < 0.1


def test_a_quadratic_field_has_no_error_and_a_kink_between_bodies_is_none() -> None:
    elements = FiniteElements(box_mesh((1.0, 1.0, 1.0), (3, 3, 3)))
    x, y, z = elements.mesh.points.T
    ones = np.ones(len(elements.mesh.cells))
    exact = energy_error(elements, 2.0 * x**2 - y * z + 3.0 * z, ones)
    assert exact.relative < 1e-7
    assert energy_error(elements, np.full(len(x), 300.0), ones).total < 1e-9
    left = elements.mesh.points[elements.mesh.cells].mean(axis=1)[:, 0] < 1.0 / 3.0
    bodies = {name: np.flatnonzero(side).astype(np.int32) for name, side in (("a", left), ("b", ~left))}
    mesh = elements.mesh
    two = FiniteElements(NamedMesh(mesh.points, mesh.cells, bodies, mesh.surfaces))
    kink = np.where(x < 1.0 / 3.0, 5.0 * (x - 1.0 / 3.0), x - 1.0 / 3.0)
    assert energy_error(two, kink, np.where(left, 1.0, 5.0)).relative < 1e-7
    assert energy_error(elements, kink, ones).relative > 0.1

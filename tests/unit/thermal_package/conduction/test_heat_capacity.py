"""Capacity matrices against integrals known by hand, and against scikit-fem."""

import numpy as np
import pytest
import skfem
from numpy.testing import assert_allclose

from tests.builders.curved_blocks import cylinder_sector
from tests.builders.scikit_fem_mesh import from_scikit_fem
from thermal.conditions.boundary import ConditionError
from thermal.conduction.capacity import HeatCapacity
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, box_mesh


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20", "hexahedron27"])
def test_polynomials_are_integrated_exactly_in_both_spaces(cell: CellName) -> None:
    mesh = box_mesh((0.2, 0.3, 0.4), (2, 3, 2), cell=cell)
    capacity = HeatCapacity(FiniteElements(mesh), {"box": 2.0})
    x = mesh.points[:, 0]
    assert x**2 @ (capacity.matrix @ x**2) == pytest.approx(2.0 * 0.2**5 / 5.0 * 0.12, rel=1e-12)
    coarse = capacity.elements.coarse.matrix(capacity.coarse)
    corner = x[capacity.elements.corners]
    assert corner @ (coarse @ corner) == pytest.approx(2.0 * 0.2**3 / 3.0 * 0.12, rel=1e-12)


def test_equal_to_scikit_fem() -> None:
    reference = skfem.MeshTet1().refined(2)
    mesh = from_scikit_fem(reference)
    ours = HeatCapacity(FiniteElements(mesh), {"rest": 3.0}).matrix
    basis = skfem.Basis(reference, skfem.ElementTetP2(), intorder=4)
    theirs = skfem.BilinearForm(lambda u, v, w: 3.0 * u * v).assemble(basis)
    where = {tuple(np.round(p, 9)): i for i, p in enumerate(basis.doflocs.T)}
    order = np.array([where[tuple(np.round(p, 9))] for p in mesh.points])
    assert_allclose(ours.toarray(), theirs.toarray()[np.ix_(order, order)], atol=1e-15)


def test_heat_content_of_a_curved_body() -> None:
    mesh = cylinder_sector((0.04, 0.10), (3, 6, 2), "ring")
    capacity = HeatCapacity(FiniteElements(mesh), {"ring": 3.6e6})
    volume = 0.25 * np.pi * (0.10**2 - 0.04**2) * 0.1
    assert capacity.stored(np.full(len(mesh.points), 2.0), "ring") == pytest.approx(7.2e6 * volume, rel=1e-4)
    assert capacity.matrix.sum() == pytest.approx(3.6e6 * volume, rel=1e-4)


@pytest.mark.parametrize("bad", [{}, {"box": -1.0}, {"box": float("nan")}, {"box": 1.0, "lid": 1.0}])
def test_bad_capacities_are_refused(bad: dict[str, float]) -> None:
    with pytest.raises(ConditionError, match="heat capacity"):
        HeatCapacity(FiniteElements(box_mesh((1.0, 1.0, 1.0), (1, 1, 1))), bad)

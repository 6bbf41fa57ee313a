"""Thermo-elastic benchmarks of NAFEMS on both second-order cells; the problems are those of `rigdesign validate`."""

import pytest

from tests.published.benchmarks import le11_stress, t1_stress
from thermal.fe.mesh import CellName

CELLS: tuple[CellName, ...] = ("tetra10", "hexahedron20")


@pytest.mark.parametrize("cell", CELLS)
def test_t1_membrane_with_hot_spot(cell: CellName) -> None:
    assert t1_stress(cell) == pytest.approx(50e6, rel=0.02)


@pytest.mark.parametrize("cell", CELLS)
def test_le11_cylinder_taper_sphere(cell: CellName) -> None:
    assert le11_stress(cell) == pytest.approx(-106.0e6, rel=0.02)

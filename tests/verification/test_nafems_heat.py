"""Heat benchmarks of NAFEMS on both second-order cells; the problems are those of `rigdesign validate`."""

import pytest
from scipy.optimize import brentq

from tests.published.benchmarks import (
    local_flux_temperature,
    t2_end_temperature,
    t3_temperature,
    t4_temperature,
)
from thermal.fe.mesh import CellName
from thermal.films.law import STEFAN_BOLTZMANN

both = pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])


@both
def test_t2_radiating_bar(cell: CellName) -> None:
    exact = brentq(
        lambda t: 55.6 * (1000.0 - t) / 0.1 - 0.98 * STEFAN_BOLTZMANN * (t**4 - 300.0**4), 300.0, 1000.0
    )
    assert exact == pytest.approx(927.0, rel=1e-4)
    assert t2_end_temperature(cell) == pytest.approx(exact, abs=1e-6)


@both
def test_t3_bar_over_time(cell: CellName) -> None:
    assert t3_temperature(cell) == pytest.approx(36.603, abs=0.01)


@both
def test_t4_plate_with_convection(cell: CellName) -> None:
    assert t4_temperature(cell) == pytest.approx(18.2538, rel=1e-3)


@both
def test_cylinder_with_local_flux(cell: CellName) -> None:
    assert local_flux_temperature(cell) == pytest.approx(332.9705, abs=0.01)

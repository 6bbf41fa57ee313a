"""Nodal heat flux: exact for a linear field, Fourier's law with a conductivity that depends on temperature."""

import numpy as np
import pytest

from thermal.conduction.setup import heat_flux
from thermal.conduction.steady import ConductionSetup
from thermal.fe.mesh import CellName, box_mesh

SIZE = (0.4, 0.3, 0.2)


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])
def test_linear_field_has_one_flux_everywhere(cell: CellName) -> None:
    mesh = box_mesh(SIZE, (3, 2, 2), cell=cell, name="block")
    slope = np.array([120.0, -40.0, 15.0])
    flux = heat_flux(ConductionSetup(mesh, {"block": 42.0}), 300.0 + mesh.points @ slope)
    np.testing.assert_allclose(flux, np.broadcast_to(-42.0 * slope, flux.shape), rtol=1e-9)


def test_a_law_counts_at_the_temperature_of_the_place() -> None:
    """k = 40 (1 + b (T - 300)) and T linear in x: q = -k(x) dT/dx, up to the mean over the cells round a node."""
    mesh = box_mesh(SIZE, (16, 1, 1), cell="tetra10", name="block")
    x = mesh.points[:, 0]
    temperature = 300.0 + 200.0 * x
    flux = heat_flux(
        ConductionSetup(mesh, {"block": lambda t: 40.0 * (1.0 + 2e-3 * (t - 300.0))}), temperature
    )
    inside = (x > 0.03) & (x < 0.37)
    expected = -40.0 * (1.0 + 2e-3 * 200.0 * x) * 200.0
    np.testing.assert_allclose(flux[inside, 0], expected[inside], rtol=5e-3)
    np.testing.assert_allclose(flux[:, 1:], 0.0, atol=1e-6)


def test_uniform_temperature_conducts_nothing() -> None:
    mesh = box_mesh(SIZE, (1, 1, 1), cell="tetra10", name="block")
    assert (
        np.abs(heat_flux(ConductionSetup(mesh, {"block": 42.0}), np.full(len(mesh.points), 350.0))).max()
        < 1e-8
    )

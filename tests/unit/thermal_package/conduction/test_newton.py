"""Newton's method: which linear solver serves which Jacobian, and from where it starts."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, BoundaryCondition, Film, Radiation
from thermal.conduction import steady as newton
from thermal.conduction.setup import ConductionSetup
from thermal.conduction.steady import TemperatureSolution, solve_steady
from thermal.conduction.terms import ConductionProblem
from thermal.fe.mesh import NamedMesh, box_mesh


@pytest.fixture(scope="module")
def mesh() -> NamedMesh:
    return box_mesh((0.2, 0.1, 0.1), (8, 5, 5))


def glowing(power: float = 0.0) -> list[BoundaryCondition]:
    """A wall heated to some 1400 K that radiates into the room; the film's exponent is ``power``."""
    film = Film(surface="x_min", kind="oil", fluid_temperature=1500.0, law=law(900.0, power))
    radiation = Radiation(surface="x_max", emissivity=0.9, surroundings_temperature=300.0)
    return [film, radiation, *(Adiabatic(surface=f"{a}_{end}") for a in "yz" for end in ("min", "max"))]


def solved(mesh: NamedMesh, power: float = 0.0, initial: float | None = None) -> TemperatureSolution:
    return solve_steady(ConductionSetup(mesh, {"box": 45.0}), glowing(power), initial, tolerance=1e-10)


def unused(*_: object, **__: object) -> None:
    raise AssertionError("this solver is for the other kind of Jacobian")


@pytest.mark.parametrize(("power", "other"), [(0.0, "gmres"), (0.3, "conjugate_gradient")])
def test_the_jacobian_decides_on_the_solver(
    mesh: NamedMesh, power: float, other: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = ConductionProblem(ConductionSetup(mesh, {"box": 45.0}), glowing(power))
    linear = problem.linearise(np.linspace(700.0, 900.0, len(mesh.points)))
    dense = np.column_stack([linear(unit) for unit in np.eye(len(mesh.points))[:40]])[:40]
    assert linear.symmetric == (power == 0.0) == np.allclose(dense, dense.T, rtol=1e-9)
    monkeypatch.setattr(newton, other, unused)
    assert solved(mesh, power).residuals[-1] < 1e-10


@pytest.mark.parametrize("power", [0.0, 0.3])
def test_any_one_temperature_leads_to_the_field(mesh: NamedMesh, power: float) -> None:
    """Radiation at 1400 K from 250 K on: the step is halved where it overshoots."""
    near = solved(mesh, power, initial=1400.0)
    for start in (250.0, 400.0, 3000.0):
        found = solved(mesh, power, initial=start)
        assert_allclose(found.temperature, near.temperature, rtol=1e-9)
        assert len(found.linear_iterations) <= len(near.linear_iterations) + 6


def test_a_given_field_is_taken_as_it_is(mesh: NamedMesh) -> None:
    exact = solved(mesh)
    assert (
        solve_steady(ConductionSetup(mesh, {"box": 45.0}), glowing(), exact.temperature).linear_iterations
        == ()
    )
    near = solve_steady(ConductionSetup(mesh, {"box": 45.0}), glowing(), near=exact)
    assert near.linear_iterations == ()

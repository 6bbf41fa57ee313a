"""Conductivity that depends on temperature, against Kirchhoff's transformation.

With theta = int k dT the equation is linear: a field known for constant k gives one for k(T). The shell is a
manufactured case, theta/k0 = a + b/r - q r^2 / (6 k0), with films on both radii and radiation outside.
Source: Carslaw, Jaeger, Conduction of Heat in Solids, 2nd ed., 2.16.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, BodySource, Film, PrescribedTemperature, Radiation
from thermal.conduction.steady import ConductionSetup, solve_steady
from thermal.fe.mesh import CellName, NamedMesh, box_mesh
from thermal.films.law import STEFAN_BOLTZMANN

K0, SLOPE, REFERENCE = 20.0, 8e-4, 500.0


def conductivity(temperature: np.ndarray) -> np.ndarray:
    return K0 * (1.0 + SLOPE * (temperature - REFERENCE))


def transformed(theta: np.ndarray) -> np.ndarray:
    """T from theta / k0, which equals T at the reference."""
    return REFERENCE + (np.sqrt(1.0 + 2.0 * SLOPE * (theta - REFERENCE)) - 1.0) / SLOPE


def shell(divisions: int, cell: CellName) -> NamedMesh:
    """A sector of a spherical shell, radii 0.5 and 1; the sides pass through the centre."""
    box = box_mesh((1.0, 1.0, 0.5), (divisions,) * 3, (-0.5, -0.5, 0.5), "shell", cell)
    direction = np.column_stack([box.points[:, :2], np.ones(len(box.points))])
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return replace(box, points=direction * box.points[:, 2:])


def shell_error(divisions: int, cell: CellName) -> tuple[float, int]:
    """L2 error [K m^1.5] and number of Newton steps."""
    a, b, q = 300.0, 120.0, 2.0e4
    film_in, film_out, emissivity, room = 90.0, 150.0, 0.8, 250.0

    def exact(r: np.ndarray | float) -> np.ndarray:
        return transformed(np.asarray(a + b / r - q * r**2 / (6.0 * K0)))

    def outward(r: float) -> float:
        return K0 * b / r**2 + q * r / 3.0

    outer = float(exact(1.0))
    radiated = emissivity * STEFAN_BOLTZMANN * (outer**4 - room**4)
    mesh = shell(divisions, cell)
    setup = ConductionSetup(mesh, {"shell": conductivity})
    conditions = [
        Film(
            surface="z_min", kind="in", law=law(film_in),
            fluid_temperature=float(exact(0.5)) + outward(0.5) / film_in,
        ),
        Film(
            surface="z_max", kind="out", law=law(film_out),
            fluid_temperature=outer - (outward(1.0) - radiated) / film_out,
        ),
        Radiation(surface="z_max", emissivity=emissivity, surroundings_temperature=room),
        BodySource(body="shell", power=q * setup.elements.volume("shell"), kind="source"),
        *(Adiabatic(surface=name) for name in ("x_min", "x_max", "y_min", "y_max")),
    ]  # fmt: skip
    solution = solve_steady(setup, conditions)
    values, volumes = setup.elements.at_points(solution.temperature)
    places, _ = setup.elements.at_points(mesh.points)
    error = values - exact(np.linalg.norm(places, axis=1))
    return float(np.sqrt(volumes @ error**2)), len(solution.linear_iterations)


@pytest.mark.parametrize(("cell", "parts"), [("tetra10", (2, 4, 8)), ("hexahedron27", (2, 3, 5))])
def test_order_three_in_l2_with_robin_radiation_and_conductivity_law(
    cell: CellName, parts: tuple[int, ...]
) -> None:
    found = [shell_error(divisions, cell) for divisions in parts]
    errors = [error for error, _ in found]
    rate = -np.polyfit(np.log(parts), np.log(errors), 1)[0]
    assert rate == pytest.approx(3.0, abs=0.3)
    assert errors[-1] < 2e-2
    assert max(steps for _, steps in found) <= 6


@pytest.mark.parametrize(
    "other",
    [lambda temperature: 35.0 * np.exp(-(temperature - 300.0) / 400.0), lambda temperature: np.array(25.0)],
    ids=["exponential", "constant law"],
)
def test_bar_of_two_materials_with_laws(other: Callable[[np.ndarray], np.ndarray]) -> None:
    """Heat through both halves is the integral of k over temperature; the joint follows from their equality."""
    mesh = box_mesh((0.2, 0.02, 0.02), (16, 1, 1))
    middle = mesh.points[mesh.cells[:, :4], 0].mean(axis=1)
    cells = np.arange(len(mesh.cells), dtype=np.int32)
    halves = replace(mesh, bodies={"left": cells[middle < 0.1], "right": cells[middle > 0.1]})
    conditions = [
        PrescribedTemperature(surface="x_min", temperature=600.0),
        PrescribedTemperature(surface="x_max", temperature=300.0),
        *(Adiabatic(surface=f"{axis}_{end}") for axis in "yz" for end in ("min", "max")),
    ]
    solution = solve_steady(
        ConductionSetup(halves, {"left": conductivity, "right": other}), conditions, tolerance=1e-11
    )
    joint = float(solution.temperature[np.isclose(mesh.points[:, 0], 0.1)].mean())

    def through(k: Callable[[np.ndarray], np.ndarray], hot: float, cold: float) -> float:
        nodes, weights = np.polynomial.legendre.leggauss(12)
        at = 0.5 * (hot + cold) + 0.5 * (hot - cold) * nodes
        return float(4e-4 / 0.1 * 0.5 * (hot - cold) * (weights @ np.broadcast_to(k(at), at.shape)))

    heat = solution.balance.rows[0].power
    assert heat == pytest.approx(through(conductivity, 600.0, joint), rel=1e-5)
    assert heat == pytest.approx(through(other, joint, 300.0), rel=1e-5)
    assert solution.residuals[-1] < 1e-10

"""Steady conduction against closed-form solutions.

The spherical shell is a manufactured case: radial conduction with a uniform source,
T = a + b/r - q r^2 / (6 k), whose film and radiation data follow from the flux at the two radii.
"""

from dataclasses import replace

import numpy as np
import pytest

from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
)
from thermal.conduction.steady import ConductionSetup, solve_steady
from thermal.fe.mesh import NamedMesh, box_mesh, disjoint_union
from thermal.films.law import STEFAN_BOLTZMANN, FilmCoefficient

ZERO = 273.15


def fixed_film(value: float):
    """A film law that is one number."""
    record = FilmCoefficient(value=value, formula="given", inputs={}, valid_range="any", source="test")
    return lambda wall, fluid: record


def adiabatic(*names: str) -> list[Adiabatic]:
    return [Adiabatic(surface=name) for name in names]


def shell(divisions: int) -> NamedMesh:
    """A sector of a spherical shell, radii 0.5 and 1; the sides pass through the centre."""
    box = box_mesh((1.0, 1.0, 0.5), (divisions,) * 3, origin=(-0.5, -0.5, 0.5))
    direction = np.column_stack([box.points[:, :2], np.ones(len(box.points))])
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return replace(box, points=direction * box.points[:, 2:])


def shell_error(divisions: int) -> float:
    """L2 error of the shell with films on both radii, radiation outside and a uniform source [K m^1.5]."""
    k, a, b, q = 20.0, 300.0, 120.0, 2.0e4
    film_in, film_out, emissivity, room = 90.0, 40.0, 0.8, 250.0

    def exact(r: np.ndarray) -> np.ndarray:
        return a + b / r - q * r**2 / (6.0 * k)

    def outward(r: float) -> float:
        return k * b / r**2 + q * r / 3.0

    radiated = emissivity * STEFAN_BOLTZMANN * (exact(1.0) ** 4 - room**4)
    inside = exact(0.5) + outward(0.5) / film_in
    outside = exact(1.0) - (outward(1.0) - radiated) / film_out
    mesh = shell(divisions)
    setup = ConductionSetup(mesh, {"box": k})
    conditions = [
        Film(surface="z_min", kind="in", fluid_temperature=inside, law=fixed_film(film_in)),
        Film(surface="z_max", kind="out", fluid_temperature=outside, law=fixed_film(film_out)),
        Radiation(surface="z_max", emissivity=emissivity, surroundings_temperature=room),
        BodySource(body="box", power=q * setup.elements.volume("box"), kind="source"),
        *adiabatic("x_min", "x_max", "y_min", "y_max"),
    ]
    solution = solve_steady(setup, conditions)
    values, volumes = setup.elements.at_points(solution.temperature)
    places, _ = setup.elements.at_points(mesh.points)
    error = values - exact(np.linalg.norm(places, axis=1))
    return float(np.sqrt(volumes @ error**2))


def test_order_three_in_l2_on_curved_cells_with_robin_and_radiation() -> None:
    errors = [shell_error(divisions) for divisions in (2, 4, 8)]
    rate = -np.polyfit(np.log([2, 4, 8]), np.log(errors), 1)[0]
    assert rate == pytest.approx(3.0, abs=0.25)
    assert errors[-1] < 1e-2


def test_two_bars_through_a_gap_have_the_resistances_of_a_wall() -> None:
    left = box_mesh((0.1, 0.02, 0.02), (4, 1, 1), name="left")
    right = box_mesh((0.2, 0.02, 0.02), (4, 1, 1), origin=(0.101, 0.0, 0.0), name="right")
    right = replace(right, surfaces={f"r_{n}": nodes for n, nodes in right.surfaces.items()})
    sides = [f"{axis}_{end}" for axis in "yz" for end in ("min", "max")]
    conditions = [
        PrescribedTemperature(surface="x_min", temperature=400.0),
        PrescribedTemperature(surface="r_x_max", temperature=300.0),
        Exchange(surface_a="x_max", surface_b="r_x_min", kind="gap", law=fixed_film(500.0)),
        *adiabatic(*sides, *(f"r_{name}" for name in sides)),
    ]
    solution = solve_steady(
        ConductionSetup(disjoint_union(left, right), {"left": 40.0, "right": 160.0}), conditions
    )
    heat = 100.0 * 4e-4 / (0.1 / 40.0 + 1.0 / 500.0 + 0.2 / 160.0)
    rows = {row.surface: row.power for row in solution.balance.rows}
    expected = {"x_min": heat, "x_max": -heat, "r_x_min": heat, "r_x_max": -heat}
    assert rows == pytest.approx(expected, rel=1e-8)

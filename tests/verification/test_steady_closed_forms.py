"""Steady conduction against closed forms: wall between films, fin, concentric grey cylinders; on both cells.

Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed.: 3.1.1 (wall), 3.6.2 case B (fin with an
insulated tip), 13.3.3 (long concentric cylinders, grey and diffuse).
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.builders.curved_blocks import cylinder_sector
from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, Film, PrescribedTemperature
from thermal.conditions.enclosure import Enclosure
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, box_mesh, disjoint_union
from thermal.films.law import STEFAN_BOLTZMANN

both = pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])


def insulated(*names: str) -> list[Condition]:
    return [Adiabatic(surface=name) for name in names]


@both
def test_wall_between_two_films(cell: CellName) -> None:
    """Resistances 1/300 + 0.02/45 + 1/8 m2 K/W between 433.15 and 293.15 K: linear inside, exact on any mesh."""
    mesh = box_mesh((0.02, 0.05, 0.05), (3, 2, 2), cell=cell)
    conditions = [
        Film(surface="x_min", kind="oil", fluid_temperature=433.15, law=law(300.0)),
        Film(surface="x_max", kind="air", fluid_temperature=293.15, law=law(8.0)),
        *insulated("y_min", "y_max", "z_min", "z_max"),
    ]
    solution = solve_steady(ConductionSetup(mesh, {"box": 45.0}), conditions)
    flux = 140.0 / (1.0 / 300.0 + 0.02 / 45.0 + 1.0 / 8.0)
    exact = 433.15 - flux * (1.0 / 300.0 + mesh.points[:, 0] / 45.0)
    assert solution.temperature == pytest.approx(exact, abs=1e-6)
    assert solution.balance.by_kind()["oil"] == pytest.approx(flux * 0.0025, rel=1e-7)


@both
def test_fin_with_insulated_tip(cell: CellName) -> None:
    """Plate 2 mm thick, 60 mm long, h 40 on both sides: cosh m(L - x) / cosh mL; across it h t / 2k is 1e-3."""
    thickness, length, h, k = 2e-3, 0.06, 40.0, 45.0
    mesh = box_mesh((length, 0.01, thickness), (24, 1, 1), cell=cell)
    conditions = [
        PrescribedTemperature(surface="x_min", temperature=400.0),
        *(Film(surface=s, kind="air", fluid_temperature=300.0, law=law(h)) for s in ("z_min", "z_max")),
        *insulated("x_max", "y_min", "y_max"),
    ]
    solution = solve_steady(ConductionSetup(mesh, {"box": k}), conditions)
    m = np.sqrt(2.0 * h / (k * thickness))
    exact = 300.0 + 100.0 * np.cosh(m * (length - mesh.points[:, 0])) / np.cosh(m * length)
    assert solution.temperature == pytest.approx(exact, abs=0.05)
    lost = -solution.balance.by_kind()["air"]
    assert lost == pytest.approx(k * thickness * 0.01 * m * 100.0 * np.tanh(m * length), rel=1e-3)


@both
def test_concentric_grey_cylinders(cell: CellName) -> None:
    """A1 sigma (T1^4 - T2^4) / (1/e1 + A1/A2 (1/e2 - 1)), the walls between in series with it."""
    radii, emissivities, k = ((0.03, 0.04), (0.08, 0.09)), (0.8, 0.5), 20.0
    turn = 2.0 * np.pi
    mesh = disjoint_union(
        cylinder_sector(radii[0], (2, 24, 1), "inner", angle=turn, cell=cell),
        cylinder_sector(radii[1], (2, 24, 1), "outer", angle=turn, cell=cell),
    )
    surfaces = FiniteElements(mesh).surfaces
    ratio = surfaces["inner_outer"].area / surfaces["outer_inner"].area
    assert ratio == pytest.approx(0.5, rel=1e-4)
    enclosure = Enclosure(
        name="annulus", surfaces=("inner_outer", "outer_inner"), emissivities=emissivities,
        view_factors=((0.0, 1.0), (ratio, 1.0 - ratio)),
    )  # fmt: skip
    conditions = [
        PrescribedTemperature(surface="inner_inner", temperature=700.0),
        PrescribedTemperature(surface="outer_outer", temperature=350.0),
        enclosure,
        *insulated(
            *(f"{body}_{end}" for body in ("inner", "outer") for end in ("z_min", "z_max", "start", "end"))
        ),
    ]
    solution = solve_steady(ConductionSetup(mesh, {"inner": k, "outer": k}), conditions)
    wall = [np.log(r[1] / r[0]) / (2.0 * np.pi * k * 0.1) for r in radii]
    area = 2.0 * np.pi * radii[0][1] * 0.1

    def excess(power: float) -> float:
        """Power radiated between the walls that a power conducted through them leaves, less that power [W]."""
        hot, cold = 700.0 - wall[0] * power, 350.0 + wall[1] * power
        resistance = 1.0 / emissivities[0] + 0.5 * (1.0 / emissivities[1] - 1.0)
        return area * STEFAN_BOLTZMANN * (hot**4 - cold**4) / resistance - power

    exact = brentq(excess, 1.0, 1e3)
    assert solution.balance.by_surface()["inner_inner"] == pytest.approx(exact, rel=2e-4)

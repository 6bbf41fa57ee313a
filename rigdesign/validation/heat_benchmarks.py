"""The heat benchmarks of NAFEMS, each computed on a small mesh of either cell.

The Standard NAFEMS Benchmarks (1990): T2 bar with radiation, T3 bar over time, T4 plate with convection, and the
hollow cylinder with a local flux.
"""

import math

import numpy as np

from rigdesign.results.units import ZERO
from rigdesign.validation.mapped_mesh import mapped, split
from thermal.conditions.boundary import Adiabatic, Film, PrescribedTemperature, Radiation, SurfaceSource
from thermal.conduction.condition_checks import Condition
from thermal.conduction.setup import ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, FloatArray, NamedMesh, box_mesh
from thermal.films.convection import constant
from thermal.transient.history import StepControl, ThermalStage, solve_transient

SOURCE = "NAFEMS, The Standard NAFEMS Benchmarks (1990)"


def t2_end_temperature(cell: CellName = "tetra10") -> float:
    """T2: end of a bar of 0.1 m [K]; k 55.6, 1000 K at the other end, eps 0.98 to 300 K. Exact: 927.008 K."""
    mesh = box_mesh((0.1, 0.01, 0.01), (10, 1, 1), cell=cell)
    conditions: list[Condition] = [
        PrescribedTemperature(surface="x_min", temperature=1000.0),
        Radiation(surface="x_max", emissivity=0.98, surroundings_temperature=300.0),
        *_insulated("y_min", "y_max", "z_min", "z_max"),
    ]
    return _at(
        mesh, solve_steady(ConductionSetup(mesh, {"box": 55.6}), conditions).temperature, (0.1, 0.0, 0.0)
    )


def t3_temperature(cell: CellName = "tetra10") -> float:
    """T3: at 0.08 m of a bar of 0.1 m after 32 s [degC]; k 35, rho c 7200 x 440.5, its end at 100 sin(pi t/40)."""

    def conditions(time: float) -> list[Condition]:
        end = ZERO + 100.0 * math.sin(math.pi * time / 40.0)
        return [
            PrescribedTemperature(surface="x_min", temperature=ZERO),
            PrescribedTemperature(surface="x_max", temperature=end),
            *_insulated("y_min", "y_max", "z_min", "z_max"),
        ]

    mesh = box_mesh((0.1, 0.01, 0.01), (20, 1, 1), cell=cell)
    stage = ThermalStage(name="t3", duration=32.0, conditions=conditions)
    solution = solve_transient(
        ConductionSetup(mesh, {"box": 35.0}),
        {"box": 440.5 * 7200.0},
        [stage],
        ZERO,
        steps=StepControl(tolerance=0.01),
    )
    section = np.isclose(mesh.points[:, 0], 0.08)
    return float(solution.temperature[section].mean()) - ZERO


def t4_temperature(cell: CellName = "tetra10") -> float:
    """T4: at (0.6, 0.2) of a plate 0.6 x 1 m [degC]; bottom 100 degC, h 750 on right and top. Converged: 18.2538."""
    mesh = box_mesh((0.6, 1.0, 0.02), (18, 30, 1), cell=cell)
    film = constant(750.0, SOURCE)
    conditions: list[Condition] = [
        PrescribedTemperature(surface="y_min", temperature=100.0 + ZERO),
        *(Film(surface=side, kind="air", fluid_temperature=ZERO, law=film) for side in ("x_max", "y_max")),
        *_insulated("x_min", "z_min", "z_max"),
    ]
    return (
        _at(mesh, solve_steady(ConductionSetup(mesh, {"box": 52.0}), conditions).temperature, (0.6, 0.2, 0.0))
        - ZERO
    )


def local_flux_temperature(cell: CellName = "tetra10") -> float:
    """Hollow cylinder with a flux on the middle of its bore: at r = z = 0.04 m [K]. Converged: 332.9705 K.

    Radii 0.02 to 0.1 m, length 0.14 m, k 52; 5e5 W/m2 between z = 0.04 and 0.1 m of the bore, whose ends are
    insulated; 273.15 K on all else. The mesh is a sector of ten degrees.
    """
    angle = math.radians(10.0)

    def place(s: FloatArray, turn: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        radius = 0.02 + 0.08 * s
        return radius * np.cos(angle * turn), radius * np.sin(angle * turn), 0.14 * z

    mesh = split(
        mapped((16, 1, 28), place, cell),
        "x_min",
        {"heated": lambda centres: (centres[:, 2] > 0.04) & (centres[:, 2] < 0.1)},
    )
    heated = FiniteElements(mesh).surfaces["heated"].area
    conditions: list[Condition] = [
        SurfaceSource(surface="heated", power=5e5 * heated, kind="flux"),
        *(PrescribedTemperature(surface=side, temperature=ZERO) for side in ("x_max", "z_min", "z_max")),
        *_insulated("x_min", "y_min", "y_max"),
    ]
    return _at(
        mesh, solve_steady(ConductionSetup(mesh, {"box": 52.0}), conditions).temperature, (0.04, 0.0, 0.04)
    )


def _insulated(*surfaces: str) -> list[Condition]:
    return [Adiabatic(surface=surface) for surface in surfaces]


def _at(mesh: NamedMesh, temperature: FloatArray, point: tuple[float, float, float]) -> float:
    """Temperature at the node nearest to ``point`` [m]."""
    distance = np.linalg.norm(mesh.points - np.array(point), axis=1)
    return float(temperature[int(np.argmin(distance))])

"""Rows of the conduction benchmarks of NAFEMS, computed on small meshes with thermal.conduction."""

from collections.abc import Iterator

import numpy as np

from rigdesign.validation.rows import ValidationRow, compare, not_modelled
from thermal.boundary import Adiabatic, BoundaryCondition, Film, PrescribedTemperature, Radiation
from thermal.conduction import solve_steady
from thermal.convection import constant
from thermal.fe.mesh import FloatArray, NamedMesh, box_mesh

ZERO = 273.15
SOURCE = "NAFEMS, The Standard NAFEMS Benchmarks (1990)"


def benchmark_rows() -> Iterator[ValidationRow]:
    """T2 and T4 computed; what needs time, expansion of other shapes or axial symmetry is not modelled."""
    yield compare(
        id="NAFEMS-T2", quantity="T2, one-dimensional with radiation, end temperature", source=SOURCE,
        published=927.0, computed=_t2(), unit="K", basis="verification", gate=1e-3,
        assumptions="10 elements; analytic 927.008 K",
    )  # fmt: skip
    yield compare(
        id="NAFEMS-T4", quantity="T4, two-dimensional with convection, temperature at E", source=SOURCE,
        published=18.25, computed=_t4(), unit="degC", basis="verification", gate=1e-3,
        assumptions="18 x 30 x 1 bricks of tetrahedra; converged 18.2538 degC",
    )  # fmt: skip
    missing = (
        (
            "T1",
            "hot spot in a membrane, stress beside the spot",
            "50",
            "MPa",
            "plane-stress membrane with a spot",
        ),
        ("T3", "one-dimensional transient, x = 0.08 m, 32 s", "36.6", "degC", "temperature over time"),
        ("T-axi", "axisymmetric with flux, r = z = 0.04 m", "332.97", "K", "axisymmetric mesh"),
        (
            "LE11",
            "axial stress at A of the cylinder, taper and sphere",
            "-105",
            "MPa",
            "thermal stress recovery",
        ),
    )
    for name, quantity, published, unit, what in missing:
        yield not_modelled(
            id=f"NAFEMS-{name}", quantity=f"{name}, {quantity}", source=SOURCE, published=published,
            unit=unit,
            basis="verification", reason=f"{what}: not modelled yet",
        )  # fmt: skip


def _t2() -> float:
    """End temperature [K]: bar of 0.1 m, k 55.6, 1000 K at one end, eps 0.98 to 300 K at the other."""
    mesh = box_mesh((0.1, 0.01, 0.01), (10, 1, 1))
    conditions = [
        PrescribedTemperature(surface="x_min", temperature=1000.0),
        Radiation(surface="x_max", emissivity=0.98, surroundings_temperature=300.0),
        *_insulated("y_min", "y_max", "z_min", "z_max"),
    ]
    return _at(mesh, solve_steady(mesh, {"box": 55.6}, conditions).temperature, (0.1, 0.0, 0.0))


def _t4() -> float:
    """Temperature [degC] at (0.6, 0.2): plate 0.6 x 1 m, bottom 100 degC, h 750 on right and top."""
    mesh = box_mesh((0.6, 1.0, 0.02), (18, 30, 1))
    film = constant(750.0, SOURCE)
    conditions = [
        PrescribedTemperature(surface="y_min", temperature=100.0 + ZERO),
        *(Film(surface=side, kind="air", fluid_temperature=ZERO, law=film) for side in ("x_max", "y_max")),
        *_insulated("x_min", "z_min", "z_max"),
    ]
    return _at(mesh, solve_steady(mesh, {"box": 52.0}, conditions).temperature, (0.6, 0.2, 0.0)) - ZERO


def _insulated(*surfaces: str) -> list[BoundaryCondition]:
    return [Adiabatic(surface=surface) for surface in surfaces]


def _at(mesh: NamedMesh, temperature: FloatArray, point: tuple[float, float, float]) -> float:
    """Temperature at the node nearest to ``point`` [m]."""
    distance = np.linalg.norm(mesh.points - np.array(point), axis=1)
    return float(temperature[int(np.argmin(distance))])

"""Rows of the NAFEMS benchmarks of heat and thermal stress, computed on small meshes of tetrahedra."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from rigdesign.results.units import ZERO
from tests.published.mapped_mesh import mapped, piecewise, split
from tests.published.rows import Gate, PublishedQuantity, ValidationRow, compare
from tests.published.thermal_stress import stress_at_nodes
from thermal.conditions.boundary import Adiabatic, Film, PrescribedTemperature, Radiation, SurfaceSource
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.expansion.elastic import ElasticSetup
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, FloatArray, NamedMesh, box_mesh
from thermal.films.convection import constant
from thermal.transient.history import StepControl, ThermalStage, solve_transient

HEAT_GATE, STRESS_GATE = Gate(1e-3), Gate(2e-2)
MEGAPASCAL = 1e6


def benchmark_rows() -> Iterator[ValidationRow]:
    """T1 to T4, the cylinder with local flux and LE11."""
    yield from heat_rows()
    yield from stress_rows()


def heat_rows() -> Iterator[ValidationRow]:
    """T2, T3, T4 and the cylinder with local flux."""
    yield _row(
        _nafems("T2", "one-dimensional with radiation, end temperature", 927.0, "K"),
        t2_end_temperature(),
        HEAT_GATE,
        "10 elements; analytic 927.008 K",
    )
    yield _row(
        _nafems("T3", "one-dimensional transient, x = 0.08 m, 32 s", 36.6, "degC"),
        t3_temperature(),
        HEAT_GATE,
        "20 elements, steps by their error; analytic 36.603 degC",
    )
    yield _row(
        _nafems("T4", "two-dimensional with convection, temperature at E", 18.25, "degC"),
        t4_temperature(),
        HEAT_GATE,
        "18 x 30 x 1 bricks of tetrahedra; converged 18.2538 degC",
    )
    yield _row(
        _nafems("T-axi", "axisymmetric with local flux, r = z = 0.04 m", 332.97, "K"),
        local_flux_temperature(),
        HEAT_GATE,
        "sector of 10 degrees; converged 332.9705 K",
    )


def stress_rows() -> Iterator[ValidationRow]:
    """T1 and LE11, on bricks of 20 nodes."""
    yield _row(
        _nafems("T1", "hot spot in a membrane, stress next to the spot", 50.0, "MPa"),
        t1_stress("hexahedron20") / MEGAPASCAL,
        STRESS_GATE,
        "thin plate with a pinhole in the spot; Lame's field fitted next to the edge of the spot",
    )
    yield _row(
        _nafems("LE11", "axial stress at A of cylinder, taper and sphere", -105.0, "MPa"),
        le11_stress("hexahedron20") / MEGAPASCAL,
        STRESS_GATE,
        "90 degrees of the body; converged -106.0 MPa",
    )


def _nafems(name: str, text: str, value: float, unit: str) -> PublishedQuantity:
    """Target value of a benchmark."""
    return PublishedQuantity(
        id=f"NAFEMS-{name}", text=f"{name}, {text}", source=SOURCE, value=value, unit=unit
    )


def _row(target: PublishedQuantity, computed: float, gate: Gate, assumptions: str) -> ValidationRow:
    return compare(target, computed, "verification", gate, assumptions=assumptions)


# The thermo-elastic benchmarks of NAFEMS, T1 and LE11, each computed on a small mesh of either cell.
#
# The Standard NAFEMS Benchmarks (1990): T1 membrane with a hot spot, 50 MPa next to it; LE11 cylinder, taper and
# sphere under a linear temperature, -105 MPa at A. The converged axisymmetric value of LE11 is -106.0 MPa. At the
# edge of the spot a plate of finite thickness is no membrane, so the stress next to it is read from Lame's field
# a / r^2 + b fitted a few thicknesses away; the finite plate adds about (1/10)^2 of 50 MPa.

HOLE, EDGE, THICKNESS = 0.02, 10.0, 0.05
"""Radius of the hole that stands for the middle of the spot, half edge and thickness of the membrane of T1 [mm]."""


def t1_stress(cell: CellName = "tetra10") -> float:
    """T1: hoop stress next to the spot [Pa]; E 100 GPa, nu 0.3, alpha 1e-3 in the spot, 1 K. Analytic: 50 MPa."""
    mesh = _hot_spot(cell)
    elements = FiniteElements(mesh)
    materials = {"spot": (100e9, 0.3, 1e-3), "rest": (100e9, 0.3, 0.0)}
    setup = ElasticSetup(elements, materials, _symmetric(elements, {"y_min": 1, "y_max": 0, "z_min": 2}))
    warm = np.ones(len(mesh.points))
    stress = stress_at_nodes(setup, setup.solve(warm, 0.0).values, warm, 0.0)
    places = mesh.points[mesh.cells]
    radius, angle = np.hypot(places[..., 0], places[..., 1]), np.arctan2(places[..., 1], places[..., 0])
    around = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
    hoop = np.einsum("eai,eaij,eaj->ea", around, stress[..., :2, :2], around)
    ring = (radius > 1.0 + 6.0 * THICKNESS) & (radius < 3.0)
    basis = np.column_stack([radius[ring] ** -2.0, np.ones(np.count_nonzero(ring))])
    return float(np.linalg.lstsq(basis, hoop[ring])[0].sum())


def le11_stress(cell: CellName = "tetra10") -> float:
    """LE11: axial stress at A, r = 1 m and z = 0 [Pa]; E 210 GPa, nu 0.3, alpha 2.3e-4, T = r + z."""
    mesh = _cylinder_taper_sphere(cell)
    elements = FiniteElements(mesh)
    fixed = _symmetric(elements, {"y_min": 1, "y_max": 0, "z_min": 2, "z_max": 2})
    setup = ElasticSetup(elements, {"box": (210e9, 0.3, 2.3e-4)}, fixed)
    warm = np.hypot(*mesh.points[:, :2].T) + mesh.points[:, 2]
    stress = stress_at_nodes(setup, setup.solve(warm, 0.0).values, warm, 0.0)
    on_a = (np.abs(np.hypot(*mesh.points[:, :2].T) - 1.0) < 1e-4) & (mesh.points[:, 2] == 0.0)
    return float(stress[on_a[mesh.cells], 2, 2].mean())


def _symmetric(elements: FiniteElements, held: Mapping[str, int]) -> NDArray[np.bool_]:
    """(n_nodes, 3) directions held by planes of symmetry, surface -> axis."""
    fixed = np.zeros((len(elements.mesh.points), 3), dtype=bool)
    for surface, axis in held.items():
        fixed[elements.surfaces[surface].nodes, axis] = True
    return fixed


def _hot_spot(cell: CellName) -> NamedMesh:
    """Quarter of the membrane in millimetres: x from a small hole over r = 1 to the edge, y round."""

    def place(s: FloatArray, turn: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        angle = 0.5 * np.pi * turn
        edge = EDGE / np.maximum(np.cos(angle), np.sin(angle))
        inside = HOLE * (1.0 / HOLE) ** np.minimum(2.0 * s, 1.0)
        radius = np.where(s <= 0.5, inside, edge ** np.maximum(2.0 * s - 1.0, 0.0))
        return radius * np.cos(angle), radius * np.sin(angle), THICKNESS * z

    mesh = mapped((40, 12, 1), place, cell)
    corners = mesh.points[mesh.cells[:, : mesh.shape.n_corners], :2]
    spot = np.hypot(*corners.mean(axis=1).T) < 1.0
    mesh.bodies.clear()
    mesh.bodies.update(
        spot=np.flatnonzero(spot).astype(np.int32), rest=np.flatnonzero(~spot).astype(np.int32)
    )
    return mesh


def _cylinder_taper_sphere(cell: CellName) -> NamedMesh:
    """90 degrees of the body: x across the wall, y round, z along sphere, taper and cylinder."""
    parts = (8, 6, 4) if cell != "tetra10" else (14, 10, 6)
    top = 1.7971

    def place(
        across: FloatArray, turn: FloatArray, along: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        inner_angle = 0.25 * np.pi * np.minimum(along * sum(parts) / parts[0], 1.0)
        outer_angle = inner_angle / (0.25 * np.pi) * np.arcsin(0.7071 / 1.4)
        on_sphere = along <= parts[0] / sum(parts)
        height = piecewise(along, parts, np.array([0.0, 0.7071, 1.3971, top]))
        r_in = np.where(on_sphere, np.cos(inner_angle), 0.7071)
        z_in = np.where(on_sphere, np.sin(inner_angle), height)
        r_out = np.where(
            on_sphere, 1.4 * np.cos(outer_angle), piecewise(along, parts, np.array([1.4, 1.2083, 1.0, 1.0]))
        )
        z_out = np.where(on_sphere, 1.4 * np.sin(outer_angle), height)
        r, z = r_in + across * (r_out - r_in), z_in + across * (z_out - z_in)
        angle = 0.5 * np.pi * turn
        return r * np.cos(angle), r * np.sin(angle), z

    return mapped((parts[0] - 2, parts[0] - 4, sum(parts)), place, cell)


# The heat benchmarks of NAFEMS, each computed on a small mesh of either cell.
#
# The Standard NAFEMS Benchmarks (1990): T2 bar with radiation, T3 bar over time, T4 plate with convection, and the
# hollow cylinder with a local flux.

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

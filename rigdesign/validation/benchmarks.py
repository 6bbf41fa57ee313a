"""Rows of the NAFEMS benchmarks of heat and thermal stress, computed on small meshes of tetrahedra."""

from collections.abc import Iterator

from rigdesign.validation.heat_benchmarks import (
    SOURCE,
    local_flux_temperature,
    t2_end_temperature,
    t3_temperature,
    t4_temperature,
)
from rigdesign.validation.rows import ValidationRow, compare
from rigdesign.validation.stress_benchmarks import le11_stress, t1_stress

HEAT_GATE, STRESS_GATE = 1e-3, 2e-2
MEGAPASCAL = 1e6


def benchmark_rows() -> Iterator[ValidationRow]:
    """T1 to T4, the cylinder with local flux and LE11."""
    yield from heat_rows()
    yield from stress_rows()


def heat_rows() -> Iterator[ValidationRow]:
    """T2, T3, T4 and the cylinder with local flux."""
    yield _row(
        "T2", "one-dimensional with radiation, end temperature", 927.0, t2_end_temperature(), "K", HEAT_GATE,
        "10 elements; analytic 927.008 K",
    )  # fmt: skip
    yield _row(
        "T3", "one-dimensional transient, x = 0.08 m, 32 s", 36.6, t3_temperature(), "degC", HEAT_GATE,
        "20 elements, steps by their error; analytic 36.603 degC",
    )  # fmt: skip
    yield _row(
        "T4", "two-dimensional with convection, temperature at E", 18.25, t4_temperature(), "degC", HEAT_GATE,
        "18 x 30 x 1 bricks of tetrahedra; converged 18.2538 degC",
    )  # fmt: skip
    yield _row(
        "T-axi", "axisymmetric with local flux, r = z = 0.04 m", 332.97, local_flux_temperature(), "K", HEAT_GATE,
        "sector of 10 degrees; converged 332.9705 K",
    )  # fmt: skip


def stress_rows() -> Iterator[ValidationRow]:
    """T1 and LE11, on bricks of 20 nodes."""
    yield _row(
        "T1", "hot spot in a membrane, stress next to the spot", 50.0, t1_stress("hexahedron20") / MEGAPASCAL,
        "MPa", STRESS_GATE, "thin plate with a pinhole in the spot; Lame's field fitted next to the edge of the spot",
    )  # fmt: skip
    yield _row(
        "LE11", "axial stress at A of cylinder, taper and sphere", -105.0, le11_stress("hexahedron20") / MEGAPASCAL,
        "MPa", STRESS_GATE, "90 degrees of the body; converged -106.0 MPa",
    )  # fmt: skip


def _row(
    name: str, quantity: str, published: float, computed: float, unit: str, gate: float, assumptions: str
) -> ValidationRow:
    return compare(
        id=f"NAFEMS-{name}", quantity=f"{name}, {quantity}", source=SOURCE, published=published,
        computed=computed, unit=unit, basis="verification", gate=gate, assumptions=assumptions,
    )  # fmt: skip

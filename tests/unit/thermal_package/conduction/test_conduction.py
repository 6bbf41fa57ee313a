"""Newton's method with films that depend on mean temperatures, the reuse of a setup, and refused input."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.two_blocks import CONDUCTIVITY, conditions, law, two_blocks
from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    BoundaryCondition,
    ConditionError,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conduction.steady import ConductionSetup, solve_steady
from thermal.conduction.terms import ConductionProblem
from thermal.errors import ThermalNotConverged
from thermal.fe.mesh import NamedMesh
from thermal.films.law import FilmCoefficient, FilmError


@pytest.fixture(scope="module")
def mesh() -> NamedMesh:
    return two_blocks()


def test_jacobian_is_the_slope_of_the_residual(mesh: NamedMesh) -> None:
    setup = ConductionSetup(mesh, CONDUCTIVITY)
    problem = ConductionProblem(setup, conditions())
    rng = np.random.default_rng(7)
    field = np.where(problem.fixed, problem.held, 350.0 + 30.0 * rng.random(len(mesh.points)))
    step = np.where(problem.fixed, 0.0, 1.0 + 0.1 * rng.standard_normal(len(field)))
    linear = problem.linearise(field)
    matrix, part = linear.matrix, linear.low_rank
    assert part is not None
    assert part.left.shape[1] == 3
    predicted = matrix @ step + part @ step
    h = 1e-3
    slope = (problem.heat_out(field + h * step)[0] - problem.heat_out(field - h * step)[0]) / (2.0 * h)
    slope[problem.fixed] = 0.0
    assert_allclose(predicted, slope, atol=1e-7 * np.abs(slope).max())
    without = np.abs(matrix @ step - slope).max()
    assert without > 1e-3 * np.abs(slope).max()


def test_newton_converges_quadratically(mesh: NamedMesh) -> None:
    history = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), conditions(), tolerance=1e-12).residuals
    orders = [np.log(b) / np.log(a) for a, b in pairwise(history) if 1e-11 < b < a < 0.1]
    assert len(orders) >= 1
    assert min(orders) > 1.7
    assert len(history) <= 7


def test_means_taken_from_the_last_step_converge_with_the_power_of_the_law(
    mesh: NamedMesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), films_only(), tolerance=1e-10)
    assert len(exact.residuals) <= 7
    monkeypatch.setattr(ConductionProblem, "_low_rank", lambda self, columns: None)
    lagged = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), films_only(), tolerance=1e-10, max_steps=150)
    late = np.array(lagged.residuals[20:50])
    assert late[1:] / late[:-1] == pytest.approx(0.8, abs=0.01)
    assert_allclose(lagged.temperature, exact.temperature, rtol=1e-8)


def films_only() -> list[BoundaryCondition]:
    """Films with a steep dependence on the mean wall temperature."""
    sides = [f"{body}_{axis}_{end}" for body in ("hot", "cold") for axis in "xyz" for end in ("min", "max")]
    return [
        Film(surface=name, kind="air", fluid_temperature=300.0 + 5.0 * i, law=law(5.0, 0.8))
        for i, name in enumerate(sides)
    ]


def test_multigrid_newton_equals_a_dense_newton(mesh: NamedMesh) -> None:
    solution = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), conditions(), tolerance=1e-12)
    setup = ConductionSetup(mesh, CONDUCTIVITY)
    problem = ConductionProblem(setup, conditions())
    field = problem.start(350.0)
    for _ in range(12):
        residual = np.where(problem.fixed, 0.0, problem.heat_out(field)[0])
        linear = problem.linearise(field)
        part = linear.low_rank
        assert part is not None
        dense = linear.matrix.toarray()
        dense += part.left.toarray() @ part.right.toarray().T
        field = field - np.linalg.solve(dense, residual)
    assert_allclose(solution.temperature, field, rtol=0.0, atol=1e-7)


def test_setup_and_field_are_reused(mesh: NamedMesh) -> None:
    setup = ConductionSetup(mesh, CONDUCTIVITY)
    fine, coarse = setup.fine.copy(), setup.coarse.copy()
    cold = solve_steady(setup, conditions())
    again = solve_steady(setup, conditions())
    assert again.temperature.tobytes() == cold.temperature.tobytes()
    fresh = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), conditions())
    assert fresh.temperature.tobytes() == cold.temperature.tobytes()
    assert setup.fine.tobytes() == fine.tobytes()
    assert setup.coarse.tobytes() == coarse.tobytes()
    warm = solve_steady(setup, conditions(), cold.temperature)
    assert warm.linear_iterations == ()
    near = solve_steady(setup, conditions(), cold.temperature + 0.1)
    assert sum(near.linear_iterations) < sum(cold.linear_iterations)
    assert_allclose(near.temperature, cold.temperature, atol=1e-6)


def test_the_start_does_not_matter(mesh: NamedMesh) -> None:
    fields = [
        solve_steady(ConductionSetup(mesh, CONDUCTIVITY), conditions(), t).temperature
        for t in (200.0, 350.0, 900.0)
    ]
    assert_allclose(fields[0], fields[1], atol=1e-5)
    assert_allclose(fields[2], fields[1], atol=1e-5)


def test_no_heat_no_closure_error(mesh: NamedMesh) -> None:
    names = list(mesh.surfaces)
    still = [Film(surface=n, kind="air", fluid_temperature=300.0, law=law(10.0)) for n in names]
    solution = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), still, 320.0)
    assert_allclose(solution.temperature, 300.0, rtol=1e-9)


def test_warnings_of_film_laws_are_kept_once(mesh: NamedMesh) -> None:
    said = [
        replace(c, law=law(8.0, 0.0, "Re = 12 is below 800")) if isinstance(c, Film) else c
        for c in conditions()
    ]
    assert solve_steady(ConductionSetup(mesh, CONDUCTIVITY), said).warnings == ("Re = 12 is below 800",)


@pytest.mark.parametrize("limit", [400.0, 320.0])
def test_a_law_with_a_limit_shortens_the_step_or_speaks(mesh: NamedMesh, limit: float) -> None:
    def limited(wall: float, fluid: float) -> FilmCoefficient:
        if wall > limit:
            raise FilmError(f"wall = {wall:g} K is above {limit:g} K")
        return law(4.0, 0.5)(wall, fluid)

    names = list(mesh.surfaces)
    heated = [Film(surface=n, kind="air", fluid_temperature=300.0, law=limited) for n in names]
    heated += [BodySource(body=b, power=p, kind="loss") for b, p in (("hot", 75.0), ("cold", 45.0))]
    if limit == 400.0:
        solution = solve_steady(ConductionSetup(mesh, CONDUCTIVITY), heated, 300.1)
        assert solution.temperature.mean() == pytest.approx(300.0 + 187.5 ** (2.0 / 3.0), abs=1.0)
    else:
        with pytest.raises(FilmError, match="is above 320 K"):
            solve_steady(ConductionSetup(mesh, CONDUCTIVITY), heated, 300.1)


def without(surface: str) -> list[BoundaryCondition]:
    return [c for c in conditions() if getattr(c, "surface", "") != surface]


BAD: list[tuple[list[BoundaryCondition], str]] = [
    (without("hot_z_max"), r"without a boundary condition: hot_z_max \(next to hot_y_max, which has one\)"),
    ([*conditions(), Adiabatic(surface="hot_zmax")], "unknown surface 'hot_zmax'; nearest: hot_z_max"),
    ([*conditions(), BodySource(body="hat", power=1.0, kind="x")], "unknown body 'hat'; nearest: hot"),
    ([*conditions(), Adiabatic(surface="hot_y_max")], "'hot_y_max' is Adiabatic and carries Film as well"),
    (
        [*conditions(), SurfaceSource(surface="hot_z_min", power=1.0, kind="x")],
        "'hot_z_min' is PrescribedTemperature and carries SurfaceSource",
    ),
    ([*conditions(), BodySource(body="cold", power=1.0, kind="loss")], "cold: two BodySource of kind 'loss'"),
    (
        [*without("hot_x_min"), Film(surface="hot_x_min", kind="a", fluid_temperature=-3.0, law=law(1.0))],
        "hot_x_min: fluid_temperature = -3 K must be above 0 K",
    ),
    (
        [
            *without("hot_x_min"),
            Radiation(surface="hot_x_min", emissivity=1.2, surroundings_temperature=300.0),
        ],
        "emissivity = 1.2 is outside of 0 to 1",
    ),
    (
        [*without("hot_x_min"), SurfaceSource(surface="hot_x_min", power=float("nan"), kind="x")],
        "power = nan is no finite number",
    ),
    (
        [*without("hot_x_min"), Film(surface="hot_x_min", kind="a", fluid_temperature=300.0, law=law(-1.0))],
        r"coefficient of 'a' is -1.0 W/\(m2 K\)",
    ),
    (
        [*without("hot_y_max"), PrescribedTemperature(surface="hot_y_max", temperature=300.0)],
        "'hot_z_min' at 330 K and 'hot_y_max' at 300 K meet",
    ),
    (
        [*conditions(), Exchange(surface_a="hot_x_max", surface_b="hot_x_max", kind="x", law=law(1.0))],
        "needs two different surfaces",
    ),
]


@pytest.mark.parametrize(("bad", "message"), BAD, ids=[message[:40] for _, message in BAD])
def test_bad_conditions_are_refused(mesh: NamedMesh, bad: list[BoundaryCondition], message: str) -> None:
    with pytest.raises(ConditionError, match=message):
        solve_steady(ConductionSetup(mesh, CONDUCTIVITY), bad)


@pytest.mark.parametrize("gap", [None, law(0.0)])
def test_body_that_cannot_lose_heat_is_named(mesh: NamedMesh, gap) -> None:
    changed = [c for c in conditions() if not isinstance(c, Exchange)]
    if gap is None:
        changed += [Adiabatic(surface="hot_x_max"), Adiabatic(surface="cold_x_min")]
    else:
        changed += [Exchange(surface_a="hot_x_max", surface_b="cold_x_min", kind="gap", law=gap)]
    with pytest.raises(ConditionError, match="no way for the heat of body cold:"):
        solve_steady(ConductionSetup(mesh, CONDUCTIVITY), changed)


@pytest.mark.parametrize(
    ("conductivity", "message"),
    [
        ({"hot": 40.0}, "no conductivity for body cold"),
        ({"hot": 40.0, "cold": 0.0}, "conductivity of body 'cold' is 0.0"),
        ({"hot": 40.0, "cold": 15.0, "colt": 1.0}, "unknown body 'colt'; nearest: cold"),
    ],
)
def test_bad_conductivities_are_refused(
    mesh: NamedMesh, conductivity: dict[str, float], message: str
) -> None:
    with pytest.raises(ConditionError, match=message):
        ConductionSetup(mesh, conductivity)


@pytest.mark.parametrize("start", [-5.0, float("nan")])
def test_bad_start_is_refused(mesh: NamedMesh, start: float) -> None:
    with pytest.raises(ConditionError, match="initial temperature"):
        solve_steady(ConductionSetup(mesh, CONDUCTIVITY), conditions(), start)


def test_a_law_with_a_jump_does_not_converge_and_says_so(mesh: NamedMesh) -> None:
    def jump(wall: float, fluid: float) -> FilmCoefficient:
        return law(500.0 if wall > 380.0 else 1.0)(wall, fluid)

    jumping = [replace(c, law=jump) if getattr(c, "kind", "") == "oil" else c for c in conditions()]
    jumping.append(BodySource(body="hot", power=400.0, kind="x"))
    jumping = [
        replace(c, fluid_temperature=300.0) if getattr(c, "kind", "") == "oil" else c
        for c in jumping
        if not isinstance(c, PrescribedTemperature)
    ]
    jumping.append(Adiabatic(surface="hot_z_min"))
    with pytest.raises(
        ThermalNotConverged, match=r"Newton: residual .*; hottest in body \w+ at x"
    ) as failure:
        solve_steady(
            ConductionSetup(mesh, CONDUCTIVITY), jumping, max_steps=3
        )  # later steps land at the jump by rounding alone
    assert len(failure.value.residuals) == 4

"""Contact, enclosure, streams and k(T) in one Newton: the Jacobian, the balance, and every sign in it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.coupled_blocks import (
    CONDUCTIVITY,
    conditions,
    contact,
    coupled_blocks,
    enclosure,
    network,
)
from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, ConditionError, Film
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure, EnclosureTerms
from thermal.conditions.streams import StreamNetwork
from thermal.conduction.balance import heat_balance
from thermal.conduction.capacity import Conductivity
from thermal.conduction.setup import Condition
from thermal.conduction.steady import CLOSURE, ConductionSetup, TemperatureSolution, newton, solve_steady
from thermal.conduction.stream_terms import VolumeTerms
from thermal.conduction.terms import ConductionProblem, ContactTerms
from thermal.errors import ThermalNotConverged
from thermal.films.law import FilmLaw


def base_law(temperature: np.ndarray) -> np.ndarray:
    return 40.0 * (1.0 - 1e-3 * (temperature - 300.0))


VARIABLE: dict[str, Conductivity] = {**CONDUCTIVITY, "base": base_law}


@pytest.fixture(scope="module")
def setup() -> ConductionSetup:
    return ConductionSetup(coupled_blocks(), VARIABLE)


@pytest.fixture(scope="module")
def solved(setup: ConductionSetup) -> TemperatureSolution:
    return solve_steady(setup, conditions())


def test_linearisation_is_the_slope_of_the_residual_with_the_volumes_eliminated(setup) -> None:
    problem = ConductionProblem(setup, conditions())
    n = problem.n_nodes
    rng = np.random.default_rng(3)
    field = np.append(
        np.where(problem.fixed, problem.held, 350.0 + 30.0 * rng.random(n)), [360.0, 371.0, 365.0]
    )
    step = np.append(np.where(problem.fixed, 0.0, rng.standard_normal(n)), [1.0, -2.0, 0.5])
    h = 1e-3
    slope = (problem.heat_out(field + h * step)[0] - problem.heat_out(field - h * step)[0]) / (2.0 * h)
    slope = problem.residual(slope)
    linear = problem.linearise(field)
    reduced = linear.load(-slope)
    assert_allclose(linear(step[:n]), reduced, atol=1e-6 * np.abs(reduced).max())
    assert_allclose(linear.whole(-slope, step[:n])[n:], step[n:], rtol=1e-5)


def test_newton_converges_quadratically_and_the_balance_closes(solved: TemperatureSolution) -> None:
    history = solved.residuals
    assert len(history) <= 7
    assert history[-1] < 10.0 * history[-2] ** 1.5
    assert solved.balance.closure <= CLOSURE
    kinds = {row.kind for row in solved.balance.rows}
    assert kinds >= {"joint", "enclosure", "splash", "oil film", "stream", "bypass", "link", "power"}
    flows = [abs(row.power) for row in solved.balance.rows]
    assert min(flows) > 1e-4 * solved.balance.turnover


def test_volumes_balance_one_by_one(solved: TemperatureSolution) -> None:
    for volume in ("chamber", "wall oil", "collector"):
        powers = [row.power for row in solved.balance.rows if row.surface == volume]
        assert len(powers) >= 3
        assert sum(powers) == pytest.approx(0.0, abs=1e-8 * solved.balance.turnover)
    carried = 0.010 * 2000.0 * (solved.volumes["collector"] - 380.0)
    to_volumes = sum(
        row.power for row in solved.balance.rows if row.surface in solved.volumes and "stream" not in row.kind
        and row.kind not in ("bypass",)
    )  # fmt: skip
    assert to_volumes == pytest.approx(carried, rel=1e-7)


def flipped(law: FilmLaw) -> FilmLaw:
    return lambda a, b: replace(law(a, b), value=-law(a, b).value)


def flipped_stream(index: int) -> StreamNetwork:
    streams = list(network().streams)
    streams[index] = replace(streams[index], mass_flow=-streams[index].mass_flow)
    return replace(network(), streams=tuple(streams))


def flipped_film(index: int) -> StreamNetwork:
    films = list(network().films)
    films[index] = replace(films[index], law=flipped(films[index].law))
    return replace(network(), films=tuple(films))


def flipped_link(index: int) -> StreamNetwork:
    links = list(network().links)
    links[index] = replace(links[index], conductance=-links[index].conductance)
    return replace(network(), links=tuple(links))


def flipped_power() -> StreamNetwork:
    volumes = network().volumes
    return replace(network(), volumes=(replace(volumes[0], power=-volumes[0].power), *volumes[1:]))


WRONG: list[Condition] = [
    replace(contact(), law=flipped(contact().law)),
    replace(enclosure(), opening_temperature=450.0),
    *(flipped_stream(index) for index in range(4)),
    *(flipped_film(index) for index in range(4)),
    *(flipped_link(index) for index in range(2)),
    flipped_power(),
]


@pytest.mark.parametrize("wrong", WRONG)
def test_one_wrong_term_in_the_rows_opens_the_balance(setup, solved, wrong: Condition) -> None:
    changed = [wrong if type(c) is type(wrong) else c for c in conditions()]
    problem = ConductionProblem(setup, conditions())
    whole = np.append(solved.temperature, list(solved.volumes.values()))
    balance = heat_balance(setup, changed, solved.temperature, problem.reactions(whole), solved.volumes)
    assert balance.closure > 1e4 * CLOSURE


def negated(method: Callable[..., tuple[np.ndarray, float]]) -> Callable[..., tuple[np.ndarray, float]]:
    def wrong(self: object, *arguments: np.ndarray) -> tuple[np.ndarray, float]:
        out, turned = method(self, *arguments)
        return -out, turned

    return wrong


@pytest.mark.parametrize("terms", [ContactTerms, EnclosureTerms])
def test_one_wrong_sign_in_the_solver_is_no_solution(setup, terms, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(terms, "heat_out", negated(terms.heat_out))
    with pytest.raises(ThermalNotConverged):
        solve_steady(setup, conditions(), max_steps=12)


def test_one_wrong_sign_in_the_volumes_is_no_solution(setup, monkeypatch: pytest.MonkeyPatch) -> None:
    right = VolumeTerms.heat_out

    def wrong(self: VolumeTerms, *arguments: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        nodes, volumes, turned = right(self, *arguments)
        return -nodes, volumes, turned

    monkeypatch.setattr(VolumeTerms, "heat_out", wrong)
    with pytest.raises(ThermalNotConverged):
        solve_steady(setup, conditions(), max_steps=12)


def test_a_linear_problem_is_reciprocal(setup: ConductionSetup) -> None:
    """Heat at one place warms another as much as heat there warms the first (no stream: it goes one way)."""
    lids = [Film(surface="lid_z_max", kind="air", fluid_temperature=300.0, law=law(20.0))]
    joint = replace(contact(), law=law(300.0))
    names = {"base_z_max", "lid_z_min", "lid_z_max"}
    others = [Adiabatic(surface=name) for name in setup.mesh.surfaces if name not in names | {"wall_x_min"}]
    plain = ConductionSetup(setup.mesh, CONDUCTIVITY, setup.elements)
    wall = Film(surface="wall_x_min", kind="air", fluid_temperature=300.0, law=law(5.0))
    problem = ConductionProblem(plain, [joint, *lids, wall, *others])
    first, second = plain.elements.body_load("base"), plain.elements.body_load("lid")
    fields = []
    for load in (first, second):
        problem.source, problem.source_turnover = 1e5 * load, 1e5 * float(load.sum())
        fields.append(newton(problem, problem.start(310.0), 1e-12).field - 300.0)
    assert second @ fields[0] == pytest.approx(first @ fields[1], rel=1e-9)


def test_a_stiff_joint_costs_few_iterations(setup: ConductionSetup) -> None:
    stiff = [replace(c, law=law(1e5)) if isinstance(c, Contact) else c for c in conditions()]
    solution = solve_steady(setup, stiff)
    assert max(solution.linear_iterations) <= 15
    assert solution.balance.closure <= CLOSURE


def without(kind: type) -> list[Condition]:
    return [c for c in conditions() if not isinstance(c, kind)]


BAD: list[tuple[list[Condition], str]] = [
    (without(Contact), r"without a boundary condition: .*lid_z_min"),
    (
        [*without(Contact), replace(contact(), surface_b="wall_y_min")],
        "is Adiabatic and carries Contact as well",
    ),
    ([*without(Contact), replace(contact(), surface_b="lid_zmin")], "unknown surface 'lid_zmin'; nearest: lid_z_min"),
    ([*without(Contact), replace(contact(), surface_b="base_z_max")], "needs two different surfaces"),
    ([*without(Contact), replace(contact(), reach=-1.0)], "reach = -1 m must be above 0"),
    ([*conditions(), contact()], "two Contact of kind 'joint'"),
    ([*conditions(), enclosure()], "base_x_max: two Enclosure of kind 'enclosure'"),
    (
        [*without(Enclosure), replace(enclosure(), surfaces=("base_x_max", "wall_xmin"))],
        "unknown surface 'wall_xmin'",
    ),
    ([*without(Enclosure), replace(enclosure(), emissivities=(0.8, -0.1))], "wall_x_min: emissivity = -0.1 is outside"),
    ([*without(Enclosure), replace(enclosure(), emissivities=(0.8,))], "1 emissivities for 2 surfaces"),
    ([*without(Enclosure), replace(enclosure(), opening_temperature=-3.0)], "must be above 0 K; give kelvin"),
    ([*without(Enclosure), replace(enclosure(), opening_temperature=None)], "cannot close"),
    (
        [*without(StreamNetwork), replace(network(), volumes=(replace(network().volumes[0], name="lid"),))],
        "unknown place|has the name of a surface or body",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("bad", "message"), BAD, ids=[message[:40] for _, message in BAD])
def test_bad_conditions_are_refused(setup, bad: list[Condition], message: str) -> None:
    with pytest.raises(ConditionError, match=message):
        solve_steady(setup, bad)


def test_surfaces_that_do_not_touch_are_refused(setup: ConductionSetup) -> None:
    apart = [replace(c, surface_a="base_x_min") if isinstance(c, Contact) else c for c in conditions()]
    with pytest.raises(
        ConditionError, match=r"contact of base_x_min and lid_z_min: 0 of the smaller surface touches"
    ):
        solve_steady(setup, apart)


def test_a_conductivity_law_that_turns_negative_is_named(setup: ConductionSetup) -> None:
    with pytest.raises(ConditionError, match=r"conductivity of body .base. is .* K; it must be positive"):
        ConductionSetup(setup.mesh, {**CONDUCTIVITY, "base": lambda t: 250.0 - t}, setup.elements)

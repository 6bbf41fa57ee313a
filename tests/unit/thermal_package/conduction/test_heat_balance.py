"""The heat balance closes, and the sign of any single row matters: in the rows and in the solver."""

from dataclasses import replace

import numpy as np
import pytest

from tests.builders.two_blocks import CONDUCTIVITY, conditions, two_blocks
from thermal.conditions.boundary import (
    BodySource,
    BoundaryCondition,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
)
from thermal.conditions.boundary import SurfaceSource as Source
from thermal.conduction.balance import heat_balance
from thermal.conduction.steady import CLOSURE, ConductionSetup, TemperatureSolution, solve_steady
from thermal.conduction.terms import ConductionProblem
from thermal.errors import ThermalNotConverged

PLACES = [(type(c).__name__, getattr(c, "kind", "")) for c in conditions() if hasattr(c, "kind")]


@pytest.fixture(scope="module")
def solved() -> tuple[ConductionSetup, TemperatureSolution, np.ndarray]:
    setup = ConductionSetup(two_blocks(), CONDUCTIVITY)
    solution = solve_steady(setup, conditions())
    problem = ConductionProblem(setup, conditions())
    return setup, solution, problem.reactions(solution.temperature)


def reversed_heat(condition: BoundaryCondition) -> BoundaryCondition:
    """The condition with the opposite sign of its heat."""
    match condition:
        case Film(law=law) | Exchange(law=law):
            return replace(condition, law=lambda a, b: replace(law(a, b), value=-law(a, b).value))
        case Radiation():
            return replace(condition, emissivity=-condition.emissivity)
        case Source() | BodySource():
            return replace(condition, power=-condition.power)
    return condition


def test_balance_closes(solved) -> None:
    balance = solved[1].balance
    assert balance.closure <= CLOSURE
    assert balance.turnover > 50.0
    assert len(balance.rows) == len(PLACES) + 1
    assert min(abs(row.power) for row in balance.rows) > 1e-3 * balance.turnover


def test_sums_by_surface_and_kind(solved) -> None:
    balance = solved[1].balance
    rows = {(row.surface, row.kind): row.power for row in balance.rows}
    walls = balance.by_surface()
    assert walls["hot_y_min"] == rows["hot_y_min", "air"] + rows["hot_y_min", "radiation"]
    assert balance.by_kind()["gap"] == pytest.approx(0.0, abs=1e-12)
    assert balance.by_kind()["loss"] == 12.0
    assert balance.worst_piece <= CLOSURE * balance.turnover
    assert sum(walls.values()) == pytest.approx(balance.imbalance, abs=1e-10)


def test_rows_obey_their_own_law_at_the_mean(solved) -> None:
    setup, solution, _ = solved
    for row in solution.balance.rows:
        if row.kind in ("oil", "air"):
            assert row.coefficient is not None
            fluid = row.coefficient.inputs["fluid"]
            by_hand = row.coefficient.value * row.area * (fluid - row.mean_temperature)
            assert row.power == pytest.approx(by_hand, rel=1e-10)
            assert row.coefficient.inputs["wall"] == row.mean_temperature
            assert row.area == pytest.approx(setup.elements.surfaces[row.surface].area)


@pytest.mark.parametrize("index", range(len(PLACES)), ids=[f"{name}-{kind}" for name, kind in PLACES])
def test_one_wrong_sign_in_the_rows_opens_the_balance(solved, index: int) -> None:
    setup, solution, reactions = solved
    with_kind = [c for c in conditions() if hasattr(c, "kind")]
    wrong = list(with_kind)
    wrong[index] = reversed_heat(wrong[index])
    signed = -reactions if isinstance(wrong[index], PrescribedTemperature) else reactions
    balance = heat_balance(setup, wrong, solution.temperature, signed)
    assert balance.closure > 1e5 * CLOSURE


@pytest.mark.parametrize("name", ["hot_x_min", "hot_y_min", "hot_y_max"])
def test_one_wrong_sign_in_the_solver_is_no_solution(name: str) -> None:
    setup = ConductionSetup(two_blocks(), CONDUCTIVITY)
    surface = setup.elements.surfaces[name]
    right = surface.load
    surface.load = lambda values: -right(values)  # type: ignore[method-assign]
    with pytest.raises(ThermalNotConverged):
        solve_steady(setup, conditions())


def test_a_source_with_the_wrong_sign_in_the_solver_is_no_solution(monkeypatch: pytest.MonkeyPatch) -> None:
    right = ConductionProblem.__init__

    def wrong(self: ConductionProblem, *arguments) -> None:
        right(self, *arguments)
        self.source = -self.source

    monkeypatch.setattr(ConductionProblem, "__init__", wrong)
    with pytest.raises(ThermalNotConverged, match="heat balance open by"):
        solve_steady(ConductionSetup(two_blocks(), CONDUCTIVITY), conditions())


def test_one_side_of_an_exchange_with_the_wrong_sign_is_no_solution() -> None:
    setup = ConductionSetup(two_blocks(), CONDUCTIVITY)
    side = setup.elements.surfaces["hot_x_max"]
    right = ConductionProblem.heat_out

    def wrong(self: ConductionProblem, temperature: np.ndarray) -> tuple[np.ndarray, float]:
        out, turned = right(self, temperature)
        exchange = self.walls.exchanges[0]
        _, _, mean_a, mean_b = self.walls._sides(exchange, temperature)
        into_a = exchange.law(mean_a, mean_b).value * side.area * (mean_b - mean_a)
        return out + 2.0 * into_a * side.shares / side.area, turned

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ConductionProblem, "heat_out", wrong)
        with pytest.raises(ThermalNotConverged):
            solve_steady(setup, conditions())

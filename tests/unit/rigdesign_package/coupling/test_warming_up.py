"""A point that was not steady: bodies still take up heat, marched from the room; the balance shows it."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.coupling.located_loss import STORED
from rigdesign.postprocessing.housing import stage_balance
from rigdesign.prediction.places import place_weights
from rigdesign.run.warnings import _warming
from rigdesign.transient.heating import Heating
from rigdesign.transient.phases import Knot, Phase
from rigdesign.transient.thermal_history import BranchPlan, Marching, march
from tests.builders.two_blocks import CONDUCTIVITY, conditions, two_blocks
from tests.builders.warm_prototype import Settled, base, case_with, heat_by_kind, open_share, outlet, settled
from thermal.conditions.boundary import ConditionError, Film
from thermal.conduction.capacity import StoredHeat
from thermal.conduction.steady import CLOSURE, ConductionSetup, solve_steady
from thermal.films.convection import constant

pytestmark = pytest.mark.whole_run

START, CAPACITY = 293.15, 3.6e6
TIME = "ambient.warming_time"


def stored(setup: ConductionSetup, time: float) -> StoredHeat:
    return StoredHeat(capacity=dict.fromkeys(setup.mesh.bodies, CAPACITY), start=START, time=time)


def bathed(setup: ConductionSetup, film: float, bath: float) -> list[Film]:
    """The same film to one fluid all over."""
    law = constant(film, "test")
    return [Film(surface=name, kind="oil", fluid_temperature=bath, law=law) for name in setup.mesh.surfaces]


@pytest.fixture(scope="module")
def setup() -> ConductionSetup:
    return ConductionSetup(two_blocks(), CONDUCTIVITY)


def test_one_body_in_one_bath_warms_by_its_time_constant(setup: ConductionSetup) -> None:
    """Small Biot number: (T - T_0)/(T_bath - T_0) = time/(time + tau), tau = rho c V/(h A)."""
    film, bath = 0.05, 393.15
    films = bathed(setup, film, bath)
    capacity = setup.heat_capacity(dict.fromkeys(setup.mesh.bodies, CAPACITY))
    areas = {name: surface.area for name, surface in setup.elements.surfaces.items()}
    for body in setup.mesh.bodies:
        volume = capacity.stored(np.ones(len(setup.mesh.points)), body) / CAPACITY
        area = sum(a for name, a in areas.items() if name.startswith(body))
        tau = CAPACITY * volume / (film * area)
        field = solve_steady(setup, [*films, stored(setup, tau)])
        share = (setup.elements.body_mean(field.temperature, body) - START) / (bath - START)
        assert share == pytest.approx(0.5, abs=2e-3)


def test_balance_closes_with_the_stored_heat_in_it(setup: ConductionSetup) -> None:
    field = solve_steady(setup, [*conditions(), stored(setup, 600.0)])
    rows = {row.surface: row for row in field.balance.rows if row.kind == "stored"}
    assert set(rows) == set(setup.mesh.bodies)
    assert field.balance.closure <= CLOSURE
    for body, row in rows.items():
        volume = setup.heat_capacity(dict.fromkeys(setup.mesh.bodies, CAPACITY)).stored(
            np.full(len(setup.mesh.points), 1.0), body
        )
        assert row.power == pytest.approx(-volume * (row.mean_temperature - START) / 600.0, rel=1e-9)
    assert max(abs(row.power) for row in rows.values()) > 0.05 * field.balance.turnover


def test_no_time_is_the_start_and_long_is_steady(setup: ConductionSetup) -> None:
    films = bathed(setup, 50.0, 393.15)
    at_once = solve_steady(setup, [*films, stored(setup, 1e-3)]).temperature
    assert np.abs(at_once - START).max() < 1e-2
    steady = solve_steady(setup, conditions()).temperature
    late = solve_steady(setup, [*conditions(), stored(setup, 1e10)]).temperature
    assert np.abs(late - steady).max() < 1e-3


@pytest.mark.parametrize("key, value", [("time", 0.0), ("time", math.inf), ("start", -1.0)])
def test_stored_heat_refuses_what_cannot_be(setup: ConductionSetup, key: str, value: float) -> None:
    with pytest.raises(ConditionError, match=key):
        StoredHeat(**{"capacity": {}, "start": START, "time": 1.0, key: value})


@pytest.mark.slow
def test_a_point_taken_too_early_lies_between_room_and_steady() -> None:
    _, steady = settled()
    (early, young), (later, old) = (settled((TIME, time)) for time in ("30 min", "8 h"))
    room = early.case.ambient.temperature
    means = [float(last.fields["test"].temperature.mean()) for last in (young, old, steady)]
    assert room + 5.0 < means[0] < means[1] < means[2] - 0.2
    # the cold housing cools the oil that is to warm it
    outlets = [outlet(last, "test.gear_oil") for last in (young, old, steady)]
    assert outlets[0] < outlets[1] < outlets[2]
    assert STORED not in heat_by_kind(steady)
    for rig, last in ((early, young), (later, old)):
        assert last.fields["test"].solution.balance.closure <= CLOSURE
        assert stage_balance(rig, last).cooling.stored == pytest.approx(-heat_by_kind(last)[STORED])
        assert open_share(rig, last) < 2e-3
    assert heat_by_kind(young)[STORED] < 3.0 * heat_by_kind(old)[STORED] < 0.0


@pytest.mark.slow
def test_outer_walls_warm_up_as_the_thermal_history_says() -> None:
    """The history holds the losses of the warm rig; the colder one loses more and is a little warmer: 10 %."""
    rig, steady = base()
    _, early = settled((TIME, "1 h"))
    phase = Phase(name="hour", duration=3600.0, knots=(Knot(time=0.0, point=steady.point),), held=True)
    plan = BranchPlan(name="warm-up", phases=(phase,))
    history = march(rig, Heating(rig, [steady]), "test", plan, Marching(tolerance=0.05))
    for place in ("test.outer_warm", "test.gear_test_pinion"):
        nodes, weights = place_weights(rig, place, None)[1]
        marched, exact, warm = (
            float(weights @ field[nodes])
            for field in (
                early.fields["test"].temperature,
                history.fields[-1].astype(float),
                steady.last.fields["test"].temperature,
            )
        )
        assert 0.0 < warm - marched < warm - exact + 0.02
        assert marched - warm == pytest.approx(exact - warm, rel=0.10)


def test_a_warming_time_is_above_zero() -> None:
    with pytest.raises(CaseError, match="warming_time"):
        case_with(((TIME, "0 s"),))


def test_the_run_says_that_it_is_not_steady() -> None:
    found = [_said(settled((TIME, "30 min"))), _said(settled())]
    assert "1800 s" in found[0][0] and "steady state" in found[0][0]
    assert found[1] == []


def _said(state: Settled) -> list[str]:
    return list(_warming(SimpleNamespace(case=state[0].case)))  # type: ignore[arg-type]

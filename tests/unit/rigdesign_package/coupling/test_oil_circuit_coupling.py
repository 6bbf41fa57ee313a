"""A rig whose warm oil comes from a circuit with a heater that is too small: one coupled point, read from all sides."""

import pytest

from rigdesign.case import Case, load_case
from rigdesign.checks.oil_circuits import steady_checks
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.oil_circuits import circuit_balances, demand_setpoints
from rigdesign.coupling.time_run import held_points
from rigdesign.oil_circuit.steady import SetpointNotHeldError
from rigdesign.postprocessing.housing import stage_balance
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.rig.model import Rig, build_rig
from tests.builders.oil_circuit import ZERO, plant_case

pytestmark = pytest.mark.whole_run


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    return load_case(plant_case(tmp_path_factory.mktemp("case")))


@pytest.fixture(scope="module")
def solved(case: Case) -> tuple[Rig, PointResult]:
    rig = build_rig(case, "quick")
    return rig, solve_point(rig, held_points(rig)[-1])


def test_the_supply_falls_to_what_the_heater_can_hold(solved: tuple[Rig, PointResult]) -> None:
    rig, result = solved
    supply = result.last.coupling_state.oil_supply["test.gear_oil"]
    found = circuit_balances(rig, result.last)["warm"]
    assert 95.0 < supply - ZERO < 115.0
    assert found.lines["mesh"].supply == pytest.approx(supply, abs=0.1)
    assert found.heater is not None
    assert found.heater.power == pytest.approx(1500.0)
    assert found.heater.margin < -500.0
    stream = next(s for s in result.last.streams if s.name == "test.gear_oil")
    assert stream.inlet == supply
    assert stream.outlet < supply


def test_the_heat_of_the_rig_closes_with_its_circuit(solved: tuple[Rig, PointResult]) -> None:
    found = stage_balance(solved[0], solved[1].last)
    balance = found.cooling
    assert balance.circulation is not None
    given = balance.losses + balance.heater + balance.circulation
    assert abs(balance.imbalance) < 0.01 * given
    assert balance.tanks == pytest.approx(
        4.0 * (found.circuits["warm"].tank_temperature - ZERO - 20.0), rel=1e-6
    )
    assert balance.circulation == pytest.approx(1e-4 * 5e5 / 0.7)


def test_the_check_fails_with_the_distance_from_the_setpoint(solved: tuple[Rig, PointResult]) -> None:
    rig, result = solved
    (check,) = steady_checks(SolvedRig(rig=rig, points=[result], balances=[stage_balance(rig, result.last)]))
    assert check.id == "oil.supply.warm.lines.mesh"
    assert check.verdict == "fail"
    assert check.value == pytest.approx(
        140.0 + ZERO - result.last.coupling_state.oil_supply["test.gear_oil"], abs=0.2
    )


def test_a_hard_setpoint_that_is_not_held_is_an_error(solved: tuple[Rig, PointResult], case: Case) -> None:
    rig, result = solved
    demand_setpoints(rig, result.last)
    hard = build_rig(case.with_value("oil_circuits.warm.lines.mesh.hard", True), "quick")
    with pytest.raises(SetpointNotHeldError, match=r"cannot be held at 140 degC within 1 K; .*1\.5 kW"):
        demand_setpoints(hard, result.last)

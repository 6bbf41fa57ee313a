"""Heat of the whole rig at one coupled point: what comes in goes out, by hand and by sum."""

import math
from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.checks.oil import checks as oil_checks
from rigdesign.checks.rig_heat import checks as room_checks
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.oil_circuits import demand_loss_maps, drive_heat
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.housing import circuit_balances_at, stage_balance
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.housing import StageBalance
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig_heat.component import CouplingRotor, room_balance
from tests.builders.oil_circuit import PLANT, ZERO
from tests.builders.rig_heat import ROOM, TRANSMISSION, loss_map

pytestmark = pytest.mark.whole_run
REST = """
[rig_heat.machines.motor]
drives = "transmission"
efficiency = 0.9
coolant = "water"
coolant_share = 0.8
[rig_heat.machines.pump_motor_of_the_rig]
drives = "motor"
efficiency = 0.95
coolant = "oil_cooler"
coolant_share = 0.5
[rig_heat.couplings.pinion_side]
shaft = "test_pinion"
diameter = "60 mm"
length = "40 mm"
"""


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Rig, PointResult]:
    file = tmp_path_factory.mktemp("case") / "case.toml"
    file.write_text(PLANT + TRANSMISSION + REST + ROOM, encoding="utf-8")
    rig = build_rig(load_case(file), "quick")
    return rig, solve_point(rig, held_points(rig)[-1])


@pytest.fixture(scope="module")
def balance(solved: tuple[Rig, PointResult]) -> StageBalance:
    return stage_balance(solved[0], solved[1].last)


def power_of(balance: StageBalance, name: str) -> float:
    return next(source.power for source in balance.heat.sources if source.name == name)


def test_the_drive_delivers_the_losses_and_every_machine_its_own(
    solved: tuple[Rig, PointResult], balance: StageBalance
) -> None:
    result = solved[1]
    rotor = CouplingRotor(name="pinion_side", radius=0.03, length=0.04)
    windage = rotor.heat(result.point.speed, ZERO + 20.0).power
    losses = math.fsum(placed.loss.power for placed in result.last.losses)
    heat = balance.heat
    assert power_of(balance, "pinion_side") == pytest.approx(windage)
    assert heat.drive_power == pytest.approx(losses + windage)
    assert power_of(balance, "transmission") == pytest.approx(heat.drive_power * (1.0 / 0.97 - 1.0))
    assert heat.mains_power == pytest.approx(heat.drive_power / (0.97 * 0.9 * 0.95))


def test_power_from_the_mains_leaves_by_all_sinks(balance: StageBalance) -> None:
    """Within what the coupling loop leaves open; the machines add nothing to that."""
    heat = balance.heat
    out = math.fsum(heat.into(sink) for sink in ("room", "oil", "water", "no_heat"))
    assert heat.into("stored") == 0.0
    assert heat.input_power - out == pytest.approx(heat.imbalance)
    assert abs(heat.imbalance) < 0.005 * heat.input_power
    assert heat.imbalance == pytest.approx(balance.cooling.imbalance, abs=1e-3 * heat.input_power)
    assert heat.into("oil") == pytest.approx(balance.cooling.cooler, rel=5e-3)
    assert heat.input_power == pytest.approx(
        heat.mains_power + balance.cooling.put_in - balance.cooling.losses - (balance.cooling.machines or 0.0)
    )


def test_a_machine_cooled_with_the_oil_of_a_circuit_warms_its_tank(
    solved: tuple[Rig, PointResult], balance: StageBalance
) -> None:
    circuit = balance.circuits["warm"]
    given = 0.9 * power_of(balance, "transmission")
    assert circuit.machine_heat == pytest.approx(given)
    assert abs(circuit.imbalance) < 1e-6
    (shown,) = circuit_balances_at(balance)
    assert shown.machines == pytest.approx(given)
    assert shown.devices[0].capability == 1500.0
    assert shown.lines[0].supply == pytest.approx(circuit.lines["mesh"].supply)
    machines = given + 0.5 * power_of(balance, "pump_motor_of_the_rig")
    assert balance.cooling.machines == pytest.approx(machines)


def test_the_room_takes_what_everything_gives_it(
    solved: tuple[Rig, PointResult], balance: StageBalance
) -> None:
    rig, _ = solved
    by_hand = math.fsum(
        (
            balance.cooling.room,
            balance.cooling.tanks or 0.0,
            power_of(balance, "pinion_side"),
            0.1 * power_of(balance, "transmission"),
            0.2 * power_of(balance, "motor"),
            0.5 * power_of(balance, "pump_motor_of_the_rig"),
        )
    )
    room, parts = balance.heat.room, rig.heat_parts.room
    assert room is not None and parts is not None
    assert room.heat == pytest.approx(by_hand)
    assert balance.heat.into("room") == pytest.approx(by_hand)
    assert room.temperature == pytest.approx(room_balance(parts, {"all": by_hand}).temperature)
    assert room.temperature - ZERO - 20.0 == pytest.approx(
        by_hand / (1500.0 / 3600.0 * 1.204 * 1006.0), rel=5e-3
    )
    assert (room.limit, room.air_flow) == (parts.temperature_limit, parts.air_flow)


def test_the_checks_hold_the_same_room(solved: tuple[Rig, PointResult], balance: StageBalance) -> None:
    rig, result = solved
    whole = SolvedRig(rig=rig, points=[result], balances=[balance])
    (check,) = room_checks(whole)
    room = balance.heat.room
    assert room is not None
    assert check.id == "oil.room_temperature"
    assert check.limit == pytest.approx(30.0)
    assert check.value == pytest.approx(room.temperature - ZERO)
    assert f"{3600.0 * (room.needed_air_flow or 0.0):.4g} m3/h" in check.reason
    found = {check.id: check.value for check in oil_checks(whole)}
    assert found["oil.room"] == pytest.approx(1e-3 * balance.heat.into("room"))


def test_a_torque_outside_of_the_loss_map_is_an_error_once_the_loop_is_done(
    solved: tuple[Rig, PointResult], tmp_path: Path
) -> None:
    _, result = solved
    file = tmp_path / "case.toml"
    file.write_text(PLANT + loss_map(torque="0.2 N m"), encoding="utf-8")
    rig = build_rig(load_case(file), "quick")
    near = drive_heat(rig, result.point, result.last.losses, nearest=True)
    assert 0.0 < near.mains - near.power <= 900.0
    with pytest.raises(CaseError) as caught:
        demand_loss_maps(rig, result.last)
    assert caught.value.faults[0].path == "rig_heat.machines.motor.loss_map.torques"
    assert "must lie within the map, 0 N m to 0.2 N m" in caught.value.faults[0].problem

"""Checks around the heat of the rig: what they leave out, and what moves them."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.case import Case, load_case
from rigdesign.checks.assumptions import influences_of
from rigdesign.checks.oil_circuits import machines_over_time
from rigdesign.checks.rig_heat import TEMPERATURE, checks, without_machines
from rigdesign.studies.modified_rig import parts_of, through_heat
from tests.builders.oil_circuit import PLANT
from tests.builders.paths import CASES
from tests.builders.rig_heat import ROOM, TRANSMISSION


def loaded(folder: Path, text: str) -> Case:
    file = folder / "case.toml"
    file.write_text(PLANT + text, encoding="utf-8")
    return load_case(file)


def solved(case: Case, **more: Any) -> Any:
    return SimpleNamespace(case=case, balances=(), **more)


def test_the_history_of_a_circuit_leaves_out_the_machine_it_cools(tmp_path: Path) -> None:
    check: Any = SimpleNamespace(id="transient.oil_supply.warm.lines.mesh")
    whole = loaded(tmp_path, TRANSMISSION)
    assert [each.text for each in machines_over_time(solved(whole), check)] == [
        "heat of machine transmission in oil circuit warm over time"
    ]
    by_water = whole.with_value("rig_heat.machines.transmission.coolant", "water")
    assert not list(machines_over_time(solved(by_water), check))


def test_a_room_without_the_machines_of_its_drivetrain_names_them(tmp_path: Path) -> None:
    case = load_case(CASES / "uhcf_prototype")
    check: Any = SimpleNamespace(id=TEMPERATURE.key)
    (left_out,) = without_machines(solved(case), check)
    assert "heat of motor and drive" in left_out.text
    driven = load_case(CASES / "uhcf_main" / "whole_rig.toml")
    assert not list(without_machines(solved(driven), check))


def test_no_check_of_the_room_without_a_limit(tmp_path: Path) -> None:
    assert not list(TEMPERATURE.rules(loaded(tmp_path, "")))
    free = loaded(tmp_path, ROOM.replace('temperature_maximum = "30 degC"', ""))
    assert not list(TEMPERATURE.rules(free))
    assert not list(checks(solved(free)))
    (rule,) = TEMPERATURE.rules(loaded(tmp_path, ROOM))
    assert (rule.id, rule.unit) == ("oil.room_temperature", "degC")


@pytest.mark.parametrize(("coolant", "moves"), [("water", ("rig heat",)), ("warm", None)])
def test_a_machine_moves_all_checks_only_through_an_oil_circuit(
    tmp_path: Path, coolant: str, moves: tuple[str, ...] | None
) -> None:
    case = loaded(tmp_path, TRANSMISSION.replace("warm", coolant))
    assert influences_of(case, "rig_heat.machines.transmission.efficiency") == moves
    assert influences_of(case, "rig_heat.room.air_flow") == ("rig heat",)


def test_only_the_coupling_is_solved_again_for_a_machine_and_nothing_for_the_room() -> None:
    assert parts_of("rig_heat.room.air_flow") == ()
    assert parts_of("rig_heat.machines.motor.efficiency") == ("coupling",)
    assert through_heat("rig_heat.machines.motor.efficiency")


def test_the_air_flow_that_holds_the_limit_is_the_reason(tmp_path: Path) -> None:
    room = SimpleNamespace(temperature=300.15, needed_air_flow=0.5)
    walls = SimpleNamespace(temperature=301.15, needed_air_flow=None)
    case = loaded(tmp_path, ROOM)
    cooling = [SimpleNamespace(heat=SimpleNamespace(stage="a", room=each)) for each in (room, walls)]
    whole: Any = SimpleNamespace(case=case, balances=cooling)
    (warmest,) = checks(whole)
    assert warmest.value == pytest.approx(28.0)
    assert warmest.verdict == "pass"
    assert "no ventilation" in warmest.reason
    first: Any = SimpleNamespace(case=case, balances=cooling[:1])
    (only,) = checks(first)
    assert only.reason == "stage a, 1800 m3/h of air hold the limit"

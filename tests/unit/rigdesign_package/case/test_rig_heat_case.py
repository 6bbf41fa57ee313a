"""Machines, couplings and room in a case: faults name key, value, limit and remedy; what is left out is assumed."""

from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import Case, load_case
from rigdesign.rig.model import build_rig
from tests.builders.oil_circuit import PLANT, ZERO
from tests.builders.rig_heat import MAP, ROOM, TRANSMISSION, loss_map

PLAIN = """
[rig_heat.machines.motor]
efficiency = 0.95
"""


def loaded(folder: Path, text: str) -> Case:
    file = folder / "case.toml"
    file.write_text(PLANT + text, encoding="utf-8")
    return load_case(file)


def faults(folder: Path, text: str) -> tuple[Fault, ...]:
    with pytest.raises(CaseError) as caught:
        build_rig(loaded(folder, text), "quick")
    return caught.value.faults


def test_a_case_without_rig_heat_says_and_assumes_nothing_of_it(tmp_path: Path) -> None:
    case = loaded(tmp_path, "")
    assert not case.rig_heat.stated
    assert not [record for record in case.assumptions if record.path.startswith("rig_heat")]


def test_machines_stand_from_the_rig_to_the_mains_in_any_order(tmp_path: Path) -> None:
    chain = f'[rig_heat.machines.converter]\ndrives = "motor"\nefficiency = 0.97\n{PLAIN}drives = "transmission"\n'
    rig = build_rig(loaded(tmp_path, chain + TRANSMISSION + ROOM), "quick")
    assert [machine.name for machine in rig.heat_parts.machines] == ["transmission", "motor", "converter"]
    transmission = rig.heat_parts.machines[0]
    assert (transmission.speed_ratio, transmission.split.coolant) == (0.25, "warm")
    room = rig.heat_parts.room
    assert room is not None
    assert room.air_flow * 3600.0 == pytest.approx(1500.0)
    assert room.supply_temperature == room.outside_temperature == pytest.approx(ZERO + 20.0)


def test_what_is_left_out_and_moves_a_result_is_an_assumption(tmp_path: Path) -> None:
    text = f'[rig_heat.couplings.side]\nshaft = "test_pinion"\ndiameter = "100 mm"\nlength = "50 mm"\n{PLAIN}{ROOM}'
    found = {record.path: record.value for record in loaded(tmp_path, text).assumptions}
    assert found["rig_heat.machines.motor.coolant_share"] == "0"
    assert found["rig_heat.couplings.side.hub_diameter"] == "0 mm"
    assert found["rig_heat.room.supply_temperature"] == "20 degC"
    assert found["rig_heat.room.wall_conductance"] == "0 W/K"
    assert "rig_heat.machines.motor.speed_ratio" not in found


def test_the_speed_ratio_ahead_of_a_loss_map_is_an_assumption(tmp_path: Path) -> None:
    text = TRANSMISSION.replace("speed_ratio = 0.25\n", "") + MAP
    found = [record.path for record in loaded(tmp_path, text).assumptions]
    assert "rig_heat.machines.transmission.speed_ratio" in found


MOTOR = "rig_heat.machines.motor"
BAD = [
    (PLAIN.replace("0.95", "0.0"), f"{MOTOR}.efficiency", "not greater than 0", "above 0"),
    (PLAIN.replace("0.95", "1.2"), f"{MOTOR}.efficiency", "not less than or equal to 1", "at most 1"),
    (PLAIN.replace("efficiency = 0.95", ""), MOTOR, "needs efficiency or loss_map", "data sheet"),
    (PLAIN + 'coolant = "warm"\n', MOTOR, "coolant and coolant_share need each other", "coolant_share = 0.9"),
    (
        PLAIN + 'coolant = "warme"\ncoolant_share = 0.5\n', f"{MOTOR}.coolant", "no such coolant or oil circuit",
        'did you mean "warm"? known: warm, water, oil_cooler',
    ),
    (PLAIN + 'drives = "gear"\n', f"{MOTOR}.drives", "no such machine", "known: motor"),
    (PLAIN + 'drives = "motor"\n', f"{MOTOR}.drives", "drive each other and not the rig", "leave out drives"),
    (
        PLAIN + "[rig_heat.machines.second]\nefficiency = 0.9\n", "rig_heat.machines.second.drives",
        "the rig is driven by motor already", "name with drives",
    ),
    (
        loss_map().replace('"100 N m"', '"90 N m"', 1), f"{MOTOR}.loss_map", "must occur once, occurs 0 times",
        "every torque",
    ),
    (
        loss_map("4000 rpm"), f"{MOTOR}.loss_map",
        "the speed of its output at stage test, outside of the map, 0 rpm to 4000 rpm", "extend the map",
    ),
    (
        '[rig_heat.couplings.side]\ndiameter = "100 mm"\nlength = "50 mm"\n', "rig_heat.couplings.side.shaft",
        "drivetrain.couplings has no side", "write the shaft",
    ),
    (
        '[rig_heat.couplings.side]\nshaft = "shaft"\ndiameter = "100 mm"\nlength = "50 mm"\n',
        "rig_heat.couplings.side.shaft", "no such shaft of the rig", "test_pinion",
    ),
    (
        '[rig_heat.couplings.side]\ndiameter = "100 mm"\nlength = "50 mm"\nhub_diameter = "110 mm"\n',
        "rig_heat.couplings.side", "hub_diameter = 110 mm is not below diameter = 100 mm", "exchange",
    ),
    (ROOM.replace("1500", "0"), "rig_heat.room", "no way out", 'air_flow = "2000 m3/h"'),
    (ROOM.replace("1500", "-5"), "rig_heat.room.air_flow", "is below 0 m3/h", "at least 0 m3/h"),
    (
        ROOM.replace("30 degC", "20 degC"), "rig_heat.room.temperature_maximum",
        "not above the supplied air, 20 degC", "colder air",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("text", "path", "problem", "remedy"), BAD)
def test_a_bad_key_names_value_limit_and_remedy(
    tmp_path: Path, text: str, path: str, problem: str, remedy: str
) -> None:
    found = {fault.path: fault for fault in faults(tmp_path, text)}
    assert path in found, list(found)
    assert problem in found[path].problem
    assert remedy in found[path].remedy


def test_all_faults_come_at_once(tmp_path: Path) -> None:
    text = PLAIN + 'coolant = "beer"\ncoolant_share = 0.5\n' + ROOM.replace("30 degC", "15 degC")
    assert {fault.path for fault in faults(tmp_path, text)} == {
        f"{MOTOR}.coolant",
        "rig_heat.room.temperature_maximum",
    }

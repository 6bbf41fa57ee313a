"""Oil circuits in a case: setpoints stand for inlet temperatures, every fault names key, value, limit and remedy."""

from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import Case, load_case
from rigdesign.rig.model import build_rig
from tests.builders.oil_circuit import ZERO
from tests.builders.paths import CASES

PROTOTYPE = (CASES / "uhcf_prototype" / "given_losses.toml").as_posix()
WARM = """
[oil_circuits.warm]
oil = "MIL-PRF-23699"
tank = { volume = "60 l", fill = "45 l", suction_minimum = "10 l", wall_conductance = "4 W/K" }
pump = { flow = "6 l/min", pressure = "5 bar", efficiency = 0.7 }
heater = { power_limit = "3 kW", setpoint = "140 degC" }
[oil_circuits.warm.lines.mesh]
consumers = ["test.gear_oil"]
"""
COOLER = (
    '\ncooler = { conductance = "200 W/K", coolant = { flow = "10 l/min", inlet_temperature = "20 degC" } }\n'
)
COLD = f"""
[oil_circuits.cold]
oil = "MIL-PRF-23699"
tank = {{ volume = "60 l", fill = "45 l" }}
[oil_circuits.cold.lines.bearings]
consumers = ["test.bearing_oil"]
setpoint = "40 degC"{COOLER}
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "case.toml"
    file.write_text(f'extends = "{PROTOTYPE}"\nname = "plant"\ntitle = "plant"\n{text}', encoding="utf-8")
    return file


def faults(folder: Path, text: str) -> tuple[Fault, ...]:
    with pytest.raises(CaseError) as caught:
        load_case(written(folder, text))
    return caught.value.faults


def without_inlets(folder: Path, text: str) -> Case:
    """The prototype with its inlet temperature of the gear oil left out."""
    gears = """
[gearboxes.test.oil]
remove = ["inlet_temperature"]
"""
    return load_case(written(folder, gears + text))


def test_a_circuit_stands_in_the_rig_with_the_flows_of_its_gearboxes(tmp_path: Path) -> None:
    rig = build_rig(load_case(written(tmp_path, WARM + COLD)), "quick")
    warm, cold = rig.oil_circuits["warm"], rig.oil_circuits["cold"]
    assert warm.flow * 6e4 == pytest.approx(5.0)
    assert cold.flow * 6e4 == pytest.approx(4 * 2.0)
    assert warm.tank.fill == pytest.approx(0.045)
    assert cold.lines[0].cooler is not None
    assert cold.lines[0].cooler.conductance == pytest.approx(200.0)


@pytest.mark.parametrize("place", ["line", "heater"])
def test_an_inlet_temperature_left_out_is_the_setpoint(tmp_path: Path, place: str) -> None:
    text = WARM.replace("140", "120")
    if place == "line":
        text = WARM + 'setpoint = "120 degC"\n'
    box = without_inlets(tmp_path, text).gearboxes["test"]
    assert box.gear_oil_temperature == pytest.approx(ZERO + 120.0)


def test_a_changed_setpoint_moves_the_inlet_temperature_with_it(tmp_path: Path) -> None:
    case = without_inlets(tmp_path, WARM)
    colder = case.with_value("oil_circuits.warm.heater.setpoint", "110 degC")
    assert colder.gearboxes["test"].gear_oil_temperature == pytest.approx(ZERO + 110.0)


def test_without_a_circuit_the_inlet_temperature_is_required(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        without_inlets(tmp_path, "")
    assert [fault.path for fault in caught.value.faults] == ["gearboxes.test.oil.inlet_temperature"]


BAD = [
    (WARM.replace("test.gear_oil", "test.gear_oli"), "oil_circuits.warm.lines.mesh.consumers", "no such", "gear_oil"),
    (
        WARM + COLD.replace("test.bearing_oil", "test.gear_oil"),
        "oil_circuits.cold.lines.bearings.consumers", "fed by oil_circuits.warm.lines.mesh already", "one line",
    ),
    (WARM.replace("MIL-PRF-23699", "FVA 3"), "oil_circuits.warm.oil", "another oil", "same oil"),
    (WARM.replace("MIL-PRF-23699", "MIL"), "oil_circuits.warm.oil", "no such oil", "MIL-PRF-23699"),
    (
        WARM + 'holdup = "36 l"\n', "oil_circuits.warm.tank.fill", "leaves 9 l in the tank", "fill in more",
    ),
    (WARM.replace("45 l", "65 l"), "oil_circuits.warm.tank.fill", "at most the volume", "larger tank"),
    (WARM.replace("6 l/min", "4 l/min"), "oil_circuits.warm.pump.flow", "5 l/min of all", "larger pump"),
    (
        WARM.replace("140", "130"), "gearboxes.test.oil.inlet_temperature", "feeds it with 130 degC", "leave it out",
    ),
    (
        WARM.replace("140", "210"), "oil_circuits.warm.heater.setpoint", "above the 200 degC", "an oil made for it",
    ),
    (
        COLD.replace('"20 degC"', '"40 degC"'), "oil_circuits.cold.lines.bearings.setpoint", "not above the coolant",
        "colder coolant",
    ),
    (
        COLD.replace('"20 degC"', '"20 degC", fluid = "Beer"'), "oil_circuits.cold.lines.bearings.cooler.coolant.fluid",
        "no properties", "Water",
    ),
    (
        COLD.replace('conductance = "200 W/K", ', ""), "oil_circuits.cold.lines.bearings.cooler",
        "needs conductance or rated", "conductance",
    ),
    (
        COLD.replace(
            'conductance = "200 W/K"', 'rated = { heat = "90 kW", flow = "8 l/min", inlet_temperature = "60 degC" }'
        ),
        "oil_circuits.cold.lines.bearings.cooler.rated.heat", "must be below", "rated point",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("text", "path", "problem", "remedy"), BAD)
def test_a_bad_circuit_names_key_value_limit_and_remedy(
    tmp_path: Path, text: str, path: str, problem: str, remedy: str
) -> None:
    found = {fault.path: fault for fault in faults(tmp_path, text)}
    assert path in found, list(found)
    assert problem in found[path].problem
    assert remedy in found[path].remedy


def test_all_faults_of_circuits_come_at_once(tmp_path: Path) -> None:
    text = WARM.replace("45 l", "65 l") + COLD.replace('"20 degC"', '"40 degC"')
    assert {fault.path.split(".")[1] for fault in faults(tmp_path, text)} == {"warm", "cold"}

"""Small oil circuits for tests."""

from pathlib import Path
from typing import Any

from rigdesign.oil_circuit.circuit import Circuit, Consumer, Coolant, Cooler, RatedPoint, SupplyLine, Tank
from rigdesign.properties.oil import FVA_3, MIL_PRF_23699, Oil
from tests.builders.paths import CASES

ZERO = 273.15
LITRE_A_MINUTE = 1e-3 / 60.0
WATER = Coolant(flow=20.0 * LITRE_A_MINUTE, inlet_temperature=ZERO + 15.0)
TANK = Tank(volume=0.1, fill=0.08, suction_minimum=0.02, wall_conductance=10.0)


def cooler(heat: float = 20e3, oil: Oil = FVA_3, coolant: Coolant = WATER) -> Cooler:
    """Counterflow cooler rated at 30 l/min of oil at 90 degC."""
    rated = RatedPoint(oil=oil, heat=heat, flow=30.0 * LITRE_A_MINUTE, inlet_temperature=ZERO + 90.0)
    return Cooler.from_rated_point(rated, coolant)


def line(name: str = "gears", litres: float = 15.0, **given: Any) -> SupplyLine:
    """A line with one consumer of its own name."""
    return SupplyLine(name=name, consumers=(Consumer(name=name, flow=litres * LITRE_A_MINUTE),), **given)


def circuit(*lines: SupplyLine, oil: Oil = MIL_PRF_23699, tank: Tank = TANK, **given: Any) -> Circuit:
    """A circuit of 80 l."""
    return Circuit(name="test", oil=oil, tank=tank, lines=lines or (line(),), **given)


PLANT = f"""
extends = "{(CASES / "uhcf_prototype" / "given_losses.toml").as_posix()}"
name = "plant"
title = "plant"
[oil_circuits.warm]
oil = "MIL-PRF-23699"
tank = {{ volume = "60 l", fill = "45 l", suction_minimum = "10 l", wall_conductance = "4 W/K" }}
pump = {{ flow = "6 l/min", pressure = "5 bar", efficiency = 0.7 }}
heater = {{ power_limit = "1.5 kW", setpoint = "140 degC" }}
[oil_circuits.warm.lines.mesh]
consumers = ["test.gear_oil"]
setpoint = "140 degC"
"""


def plant_case(folder: Path) -> Path:
    """Write the prototype with given losses, its gear oil from a circuit whose heater is 1.4 kW short."""
    file = folder / "case.toml"
    file.write_text(PLANT, encoding="utf-8")
    return file

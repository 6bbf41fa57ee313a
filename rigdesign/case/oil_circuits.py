"""Oil circuits of the rig: tank, pump, heater, cooler, and the lines that feed gears and bearings.

A consumer is an oil stream of a gearbox, ``test.gear_oil`` or ``test.bearing_oil``. Its supply temperature then is a
result of the circuit; one that no circuit feeds has the inlet temperature that the case states.
"""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, TypeGuard

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    BodyHeatCapacity,
    Conductance,
    Flow,
    Name,
    Part,
    Power,
    Pressure,
    Share,
    Temperature,
    TemperatureDifference,
    Text,
    Usual,
    Volume,
    fault,
)

STREAM_KEYS = {"gear_oil": "oil", "bearing_oil": "bearing_oil"}
"""Oil stream of a gearbox -> table of the gearbox that feeds it."""
StreamName = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*\.[a-z_]+$", max_length=80)]


class TankInput(Part):
    """Tank of a circuit, its oil well mixed."""

    volume: Annotated[Volume, Usual(60.0, 3000.0, "pump flow")]
    """Most oil it holds."""
    fill: Annotated[Volume, Usual(0.2, 1.0, "tank volume")]
    """Oil of the whole circuit at room temperature, pipes and gearboxes included."""
    suction_minimum: Annotated[Volume, Usual(0.02, 0.6, "tank volume")] | None = None
    """Oil in the tank below which the pump draws air; 0 when left out."""
    wall_conductance: Conductance = 0.0
    """From the oil to the room; 0 for a lagged tank."""
    heat_capacity: BodyHeatCapacity = 0.0
    """Of the steel that has the temperature of the oil."""
    start_temperature: Temperature | None = None
    """At the begin of the schedule; the room temperature when left out, that of a heated tank where it is stated."""


class PumpInput(Part):
    """Pump of all lines of a circuit."""

    flow: Flow
    """Delivered; what the lines do not take returns to the tank over the relief valve."""
    pressure: Annotated[Pressure, Usual("0.6 bar", "59 bar")]
    """Rise of pressure."""
    efficiency: Annotated[float, Field(gt=0.0, le=1.0), Usual(0.2, 1.0)]
    """Hydraulic over shaft power."""
    heat_share: Share = 1.0
    """Share of the shaft power that ends in the oil; the rest goes to the room."""


class HeaterInput(Part):
    """Electric heater in the tank."""

    power_limit: Power
    """Most power."""
    setpoint: Temperature
    """Temperature of the tank it holds."""
    band: TemperatureDifference | None = None
    """Hysteresis of its thermostat, on or off at full power; left out: its power is controlled continuously."""


class CoolantInput(Part):
    """What takes the heat of a cooler."""

    flow: Flow
    """At its inlet."""
    inlet_temperature: Temperature
    """As it enters the cooler."""
    fluid: Text = "Water"
    """Name in CoolProp, such as ``Water`` or ``INCOMP::MEG[0.3]``."""
    pressure: Pressure = 3e5
    """Absolute."""


class RatedPointInput(Part):
    """Point of the data sheet of a cooler, with the coolant of the case."""

    heat: Power
    """Carried."""
    flow: Flow
    """Of the oil at its inlet."""
    inlet_temperature: Temperature
    """Of the oil."""


class CoolerInput(Part):
    """Cooler from oil to a coolant, by ``conductance`` or by a ``rated`` point."""

    coolant: CoolantInput
    """What takes the heat."""
    conductance: Conductance | None = None
    """UA, overall coefficient times area."""
    rated: RatedPointInput | None = None
    """Point of its data sheet, in place of ``conductance``."""
    arrangement: Literal["counterflow", "parallel", "crossflow", "shell_and_tube"] = "counterflow"
    """Flows against each other; shell_and_tube: one shell pass, two or more tube passes."""

    @model_validator(mode="after")
    def _one_size(self) -> "CoolerInput":
        if (self.conductance is None) == (self.rated is None):
            raise fault("needs conductance or rated, one of the two", 'write e.g. conductance = "1 kW/K"')
        return self


class TankCoolerInput(CoolerInput):
    """Cooler that holds the temperature of the tank."""

    setpoint: Temperature
    """Temperature of the tank."""
    band: TemperatureDifference | None = None
    """Hysteresis of its thermostat; left out: continuous control."""
    flow: Flow | None = None
    """Oil of its own pump, from the tank and back; left out: it stands in the common return."""


class PipeInput(Part):
    """Pipe between tank and consumers."""

    volume: Volume
    """Inside."""
    wall_conductance: Conductance = 0.0
    """To the room; 0 for a lagged pipe."""


class LineInput(Part):
    """Consumers fed at one temperature."""

    consumers: tuple[StreamName, ...] = Field(min_length=1, strict=False)
    """Oil streams, such as ``test.gear_oil``."""
    setpoint: Temperature | None = None
    """Supply temperature that valve and trim heater hold; left out: oil as the pump gives it."""
    tolerance: TemperatureDifference = 1.0
    """Of the supply temperature, to either side."""
    hard: bool = False
    """Whether a supply that is not held ends the run with an error; else it is a result with a check."""
    cooler: CoolerInput | None = None
    """With a three-way valve that mixes cooled and bypassed oil to the setpoint."""
    valve_band: TemperatureDifference | None = None
    """Proportional band of that valve; left out: it holds the setpoint."""
    trim_heater: Power = 0.0
    """Most power of a heater of the line, controlled continuously."""
    supply_pipe: PipeInput | None = None
    """From valve and trim heater to the consumers."""
    return_pipe: PipeInput | None = None
    """From the consumers to the tank."""
    holdup: Volume | None = None
    """Oil that stands in the consumers of the line and drains back when the pump stops."""


class OilCircuit(Part):
    """One oil, one tank, and the lines it feeds."""

    oil: Text
    """Built-in oil or a name under ``oils``; that of all consumers."""
    tank: TankInput
    """Tank of the circuit."""
    lines: Mapping[Name, LineInput] = Field(min_length=1)
    """Lines by name, each with a supply temperature of its own."""
    pump: PumpInput | None = None
    """Its heat is left out without one."""
    heater: HeaterInput | None = None
    """Heater in the tank."""
    tank_cooler: TankCoolerInput | None = None
    """Cooler of the tank; a line may have one of its own."""

    def supply_setpoint(self, line: str) -> float | None:
        """Supply temperature a line is meant to have [K]: its own setpoint, or that of the heater."""
        stated = self.lines[line].setpoint
        if stated is None and self.heater is not None:
            return self.heater.setpoint
        return stated


def place_of(circuits: Mapping[str, OilCircuit], stream: str) -> tuple[str, str] | None:
    """Names of the circuit and line that feed an oil stream; None where none does."""
    for name, circuit in circuits.items():
        for line, entry in circuit.lines.items():
            if stream in entry.consumers:
                return name, line
    return None


def with_setpoints(tree: Any) -> Any:
    """A case as the file writes it, with the inlet temperatures that it leaves to setpoints of oil circuits.

    A consumer without an inlet temperature of its own gets the setpoint of its line, or of the heater of the tank.
    What does not have the form of a case is left for the validation to name.
    """
    if not (isinstance(tree, dict) and isinstance(tree.get("oil_circuits"), dict)):
        return tree
    boxes = dict(tree["gearboxes"]) if isinstance(tree.get("gearboxes"), dict) else {}
    for circuit in filter(_is_table, tree["oil_circuits"].values()):
        lines = circuit.get("lines")
        for line in filter(_is_table, lines.values() if _is_table(lines) else ()):
            heater = circuit.get("heater")
            setpoint = line.get("setpoint", heater.get("setpoint") if _is_table(heater) else None)
            consumers = line.get("consumers")
            for stream in consumers if isinstance(consumers, list | tuple) else ():
                box, _, kind = str(stream).partition(".")
                key = STREAM_KEYS.get(kind, "")
                feed = boxes[box].get(key) if _is_table(boxes.get(box)) else None
                if setpoint is None or not _is_table(feed) or "inlet_temperature" in feed:
                    continue
                if feed.get("lubrication", "jet") in ("jet", "fed"):
                    boxes[box] = {**boxes[box], key: {**feed, "inlet_temperature": setpoint}}
    return {**tree, "gearboxes": boxes} if boxes else tree


def _is_table(entry: object) -> TypeGuard[dict[str, Any]]:
    return isinstance(entry, dict)

"""Oil of a gearbox: how it gets to gears and bearings, the ways it takes, and its state.

Every kind of lubrication is a class whose key ``lubrication`` has one choice, joined in `GearOil` or `BearingOil`.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, TypeAlias, TypeGuard

from pydantic import Field, Tag, model_validator

from rigdesign.base.part_name import OilStreamName
from rigdesign.case.fields import (
    SCUFFING,
    BodyHeatCapacity,
    Conductance,
    Flow,
    LoadStage,
    Name,
    Offset,
    Part,
    Power,
    Pressure,
    Share,
    Size,
    Temperature,
    TemperatureDifference,
    Text,
    Usual,
    Velocity,
    Volume,
    fault,
    kind_from,
)

if TYPE_CHECKING:
    from dynamics.rotor.rolling_friction import Lubrication


class JetOil(Part):
    """Oil injected at the meshes of a gearbox."""

    lubrication: Literal["jet"] = "jet"
    """Selects injection at the meshes."""
    oil: Text
    """Built-in oil or a name under ``oils``."""
    inlet_temperature: Temperature
    """Temperature at which the oil enters the gearbox."""
    flow: Annotated[Flow, Usual(7e-11, 2.1e-9, "circulating power")]
    """Flow per mesh."""
    jet_direction: Literal["into_mesh", "out_of_mesh", "radial"]
    """Where the jets point: with the motion of the teeth into the mesh, against their motion out of the
    mesh, or radially; decides the power that brings the oil up to speed."""
    jet_velocity: Annotated[Velocity, Usual("4 m/s", "80 m/s")]
    """Velocity of the oil as it leaves the jets, all open and nothing in ``oil_paths.bypass``."""
    outlet_temperature: Temperature | None = None
    """Measured outlet; computed from the heat when left out."""
    blocked_jets: Annotated[float, Field(ge=0.0, le=0.9)] = 0.0
    """Share of the jets that is closed: the same flow leaves the others faster, and wets so much less face width."""
    scuffing_load_stage: LoadStage | None = None
    """Load stage of the FZG test A/8.3/90 at which this oil lets the gears scuff; that of the oil when left out."""
    scuffing_temperature: Annotated[Temperature, SCUFFING] | None = None
    """Contact temperature at which this oil lets gears scuff, where a test or table has it; goes before the stage."""

    temperature_key: ClassVar[str] = "inlet_temperature"
    """Key of the temperature with which its oil comes."""
    scuffing_supply: ClassVar[str] = "injection"
    """As ISO/TS 6336-22 names it."""

    @property
    def jets(self) -> "JetOil":
        """Oil injected at the meshes."""
        return self

    @property
    def sump(self) -> None:
        """It has none."""
        return

    @property
    def temperature(self) -> float:
        """With which the oil comes [K]."""
        return self.inlet_temperature


class DipOil(Part):
    """Sump of a gearbox into which its gears dip."""

    lubrication: Literal["dip"]
    """Selects a sump."""
    oil: Text
    """Built-in oil or a name under ``oils``."""
    level: Offset
    """Height of the oil at rest above the shaft axes; below them it is negative."""
    volume: Annotated[Volume, Usual(0.35, 12.0, "cube of the centre distance")]
    """Oil in the sump."""
    sump_temperature: Temperature | None = None
    """Held by heater and cooler of the sump. Left out: it follows from the losses and from what the housing gives to
    its surroundings."""
    churning: Literal["recommended", "changenet_2011", "changenet_2007", "iso_tr_14179_2"] = "recommended"
    """Law of the churning loss; recommended: of the three the one that is extrapolated least."""
    plan_length: Size | None = None
    """Inner length of the box along the shafts, for ISO/TR 14179-2 in a gearbox without a housing."""
    plan_width: Size | None = None
    """Inner width of the box across the shafts, for ISO/TR 14179-2 in a gearbox without a housing."""
    scuffing_load_stage: LoadStage | None = None
    """Load stage of the FZG test A/8.3/90 at which this oil lets the gears scuff; that of the oil when left out."""
    scuffing_temperature: Annotated[Temperature, SCUFFING] | None = None
    """Contact temperature at which this oil lets gears scuff, where a test or table has it; goes before the stage."""

    temperature_key: ClassVar[str] = "sump_temperature"
    """Key of the temperature with which its oil comes."""
    scuffing_supply: ClassVar[str] = "dip"
    """As ISO/TS 6336-22 names it."""

    @property
    def jets(self) -> None:
        """It has none."""
        return

    @property
    def sump(self) -> "DipOil":
        """Sump into which the gears dip."""
        return self

    @property
    def temperature(self) -> float | None:
        """At which the sump is held [K]; None for a free one."""
        return self.sump_temperature


GearOil: TypeAlias = Annotated[
    Annotated[JetOil, Tag("jet")] | Annotated[DipOil, Tag("dip")], kind_from("lubrication", "jet")
]
"""Oil of the gears; a further kind of lubrication joins here."""


class FedOil(Part):
    """Oil fed to the bearings of a gearbox."""

    lubrication: Literal["fed"] = "fed"
    """Selects oil that is fed to every bearing."""
    oil: Text
    """Built-in oil or a name under ``oils``."""
    inlet_temperature: Temperature
    """Temperature at which the oil enters the bearings."""
    flow: Annotated[Flow, Usual(4.2e-3, 0.1, "bore times width of the bearings")]
    """Flow per bearing."""
    outlet_temperature: Temperature | None = None
    """Measured outlet; computed from the heat when left out."""

    temperature_key: ClassVar[str] = "inlet_temperature"
    """Key of the temperature with which its oil comes."""
    splash_share: ClassVar[float] = 0.0
    """Nothing is thrown on the bearings."""
    takes_heat: ClassVar[bool] = True
    """Whether it carries heat away."""

    @property
    def fed(self) -> "FedOil":
        """Oil fed to the bearings."""
        return self

    def oil_name(self, gear_oil: str) -> str:
        """Its oil."""
        return self.oil

    def rolling_supply(self, level: float) -> "Lubrication":
        """How it comes to a rolling bearing; level : of oil at rest above the lowest point of its raceway [m]."""
        return "oil_jet"


class SplashOil(Part):
    """What the gears throw off lubricates the bearings."""

    lubrication: Literal["splash"]
    """Selects the oil of the gears as it is thrown off."""
    splash_share: Annotated[float, Field(ge=0.001, le=0.1)] = 0.01
    """Share of the oil that the gears lift, or the jets inject, which passes each bearing. No law predicts it."""

    temperature_key: ClassVar[str] = "inlet_temperature"
    """Key of the temperature with which its oil comes."""
    takes_heat: ClassVar[bool] = True
    """Whether it carries heat away."""

    @property
    def fed(self) -> None:
        """None is fed."""
        return

    def oil_name(self, gear_oil: str) -> str:
        """That of the gears."""
        return gear_oil

    def rolling_supply(self, level: float) -> "Lubrication":
        """A bath as far as one stands in the bearing, else drops; level as in `FedOil.rolling_supply`."""
        return "oil_bath" if level else "oil_spot"


class Grease(Part):
    """Bearings packed with grease."""

    lubrication: Literal["grease"]
    """Selects grease."""
    oil: Text
    """Base oil of the grease: built-in oil or a name under ``oils``."""

    temperature_key: ClassVar[str] = "inlet_temperature"
    """Key of the temperature with which its oil comes."""
    splash_share: ClassVar[float] = 0.0
    """Nothing is thrown on the bearings."""
    takes_heat: ClassVar[bool] = False
    """Whether it carries heat away."""

    @property
    def fed(self) -> None:
        """None is fed."""
        return

    def oil_name(self, gear_oil: str) -> str:
        """Its base oil."""
        return self.oil

    def rolling_supply(self, level: float) -> "Lubrication":
        """Grease."""
        return "grease"


BearingOil: TypeAlias = Annotated[
    Annotated[FedOil, Tag("fed")] | Annotated[SplashOil, Tag("splash")] | Annotated[Grease, Tag("grease")],
    kind_from("lubrication", "fed"),
]
"""Oil of the bearings; a further kind of lubrication joins here."""


PathShare = Annotated[float, Field(ge=0.0, le=0.9)]
"""Part of the gear oil that takes another way."""


class OilPaths(Part):
    """Ways of the gear oil other than jets, meshes, walls, drain: shares of what is fed."""

    leak_warm_cold: PathShare = 0.0
    """Through the seals of the chamber into the oil of the bearings, and out with it."""
    leak_front_share: Share = 0.5
    """Part of that leak that reaches the cold chamber at the front; the rest reaches the one at the rear."""
    bypass: PathShare = 0.0
    """Round meshes and walls straight to the outlet."""
    short_circuit: PathShare = 0.0
    """From the meshes straight to the outlet, past walls, shafts and gear bodies."""

    @model_validator(mode="after")
    def _leave_some(self) -> "OilPaths":
        total = self.leak_warm_cold + self.bypass + self.short_circuit
        if total > 0.9:
            raise fault(
                f"leak_warm_cold, bypass and short_circuit add up to {total:g}, which leaves no oil for the gears",
                "write shares whose sum is at most 0.9",
            )
        return self


class OilState(Part):
    """How the oil in a gearbox differs from its data sheet; for gears and bearings alike."""

    air_content: Annotated[float, Field(ge=0.0, le=0.3)] = 0.0
    """Volume share of free air in the oil fed, bubbles: less mass and conductivity, more viscosity."""
    viscosity_factor: Annotated[float, Field(ge=0.2, le=5.0), Usual(0.4, 2.5)] = 1.0
    """Viscosity over that of the data sheet, at every temperature."""
    heat_capacity_factor: Annotated[float, Field(ge=0.5, le=2.0)] = 1.0
    """Heat capacity over that of the data sheet."""


# Oil circuits of the rig: tank, pump, heater, cooler, and the lines that feed gears and bearings.
#
# A consumer is an oil stream of a gearbox, ``test.gear_oil`` or ``test.bearing_oil``. Its supply temperature then is a
# result of the circuit; one that no circuit feeds has the inlet temperature that the case states.

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
                box, kind = OilStreamName.read(str(stream)).both
                key = STREAM_KEYS.get(kind, "")
                feed = boxes[box].get(key) if _is_table(boxes.get(box)) else None
                if setpoint is None or not _is_table(feed) or "inlet_temperature" in feed:
                    continue
                if feed.get("lubrication", "jet") in ("jet", "fed"):
                    boxes[box] = {**boxes[box], key: {**feed, "inlet_temperature": setpoint}}
    return {**tree, "gearboxes": boxes} if boxes else tree


def _is_table(entry: object) -> TypeGuard[dict[str, Any]]:
    return isinstance(entry, dict)

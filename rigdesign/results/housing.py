"""Temperatures and heat of the housings at the held stages: SI records."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Literal

from rigdesign.oil_circuit.steady import SteadyCircuit
from rigdesign.results.quantity import Degrees, Quantity, Watts
from thermal.conduction.balance import HeatFlow

# Heat of the whole rig at one held stage by source and sink, the room that takes its share, and the power it costs.

Sink = Literal["room", "oil", "water", "stored", "no_heat"]
"""room: air and walls of the room; oil: the oils, whose coolers carry it; water: cooling water of machines; stored:
parts that still warm up; no_heat: work of mesh dampers, heat of no part of the model."""
SINKS: tuple[Sink, ...] = ("room", "oil", "water", "stored", "no_heat")
Power = Annotated[float | None, Quantity("W")]


ROUND_OFF = 1e-8
"""Share of a heat below which a balance is closed: numbers of results.json have ten digits."""


def _left_open(difference: float, whole: float) -> float:
    """Difference of two sums [W]; 0 where it is round-off."""
    return 0.0 if abs(difference) < ROUND_OFF * abs(whole) else difference


@dataclass(frozen=True, kw_only=True)
class HeatSource:
    """Power that becomes heat in one part of the rig, and where it goes; a negative one is taken from there."""

    name: str
    kind: Literal["gearbox", "oil supply", "coupling", "machine"]
    power: Watts
    sinks: Annotated[Mapping[Sink, float], Quantity("W")]

    @property
    def open(self) -> float:
        """Power without a sink: what the coupling loop leaves open [W]."""
        return self.power - math.fsum(self.sinks.values())


@dataclass(frozen=True, kw_only=True)
class RoomTemperature:
    """The room in balance with the heat it takes."""

    temperature: Degrees
    limit: Annotated[float | None, Quantity("degC")]
    """None where the case states none."""
    heat: Watts
    """Of all sources."""
    by_air: Watts
    by_walls: Watts
    air_flow: Annotated[float, Quantity("m3/h")]
    needed_air_flow: Annotated[float | None, Quantity("m3/h", "air flow that holds the limit")]
    """To hold the limit; None without one, and where the supplied air is not below it."""


@dataclass(frozen=True, kw_only=True)
class RigHeat:
    """Every source of heat of the rig at one held stage.

    drive_power : at the shaft that drives the rig
    mains_power : of the machines that drive it
    input_power : of all: drive, oil pumps, heaters
    room : None where the case states none
    """

    stage: str
    sources: tuple[HeatSource, ...]
    drive_power: Watts
    mains_power: Watts
    input_power: Watts
    room: RoomTemperature | None = None
    warnings: tuple[str, ...] = ()

    def into(self, sink: Sink) -> float:
        """Heat of all sources into a sink [W]."""
        return math.fsum(source.sinks.get(sink, 0.0) for source in self.sources)

    @property
    def imbalance(self) -> Watts:
        """Power that goes in less heat of all sinks."""
        return _left_open(self.input_power - math.fsum(self.into(sink) for sink in SINKS), self.input_power)


@dataclass(frozen=True, kw_only=True)
class BodyTemperature:
    """Temperatures of one body."""

    mean: Degrees
    """Over its volume."""
    max: Degrees
    min: Degrees


@dataclass(frozen=True, kw_only=True)
class GearHeatSplit:
    """Where the friction heat of one gear goes; friction = at once into the oil + into the rim."""

    gear: str
    """``gearbox.gear``."""
    rule: Literal["assumed", "flank_film"]
    friction: Watts
    """Of all its meshes, into its flanks."""
    at_once: Watts
    """Leaves with the oil before it reaches the rim."""
    film: Watts
    """From the rim into the gear oil; other heat of the gear leaves this way too."""
    bulk: Degrees
    """Mean of the gear body."""
    tooth: Annotated[float | None, Quantity("degC")]
    """Mean of the teeth; None without a flank film."""
    flank_film: Annotated[float | None, Quantity("W/(m2 K)")]
    """Mean coefficient over all flanks."""
    fin_efficiency: float | None
    weak_film: "GearHeatSplit | None" = None
    """The same gear at the low ends of the ranges of the film; None where the case states none."""
    strong_film: "GearHeatSplit | None" = None
    """At the high ends."""

    @property
    def share_into_oil(self) -> Annotated[float, Quantity()]:
        """(at once + film) / friction; above 1 where other heat of the gear leaves through its teeth."""
        return (self.at_once + self.film) / self.friction

    @property
    def share_into_bodies(self) -> Annotated[float, Quantity()]:
        """The rest of the friction."""
        return 1.0 - self.share_into_oil


@dataclass(frozen=True, kw_only=True)
class RadiationReadings:
    """The field under both readings of the given film coefficients: radiation apart from them, or counted in them."""

    highest_radiation_included_false: Degrees
    highest_radiation_included_true: Degrees
    heat_to_the_room_under_the_other_reading: Watts
    """Under the one that the case does not take."""


@dataclass(frozen=True, kw_only=True)
class FluidTemperature:
    """A volume or stream of a housing; heat + power + links = 0 for a volume."""

    name: str
    kind: Literal["volume", "stream"]
    inlet: Annotated[float | None, Quantity("degC")]
    """Of a stream; None for a volume."""
    temperature: Degrees
    """Of a volume, at the outlet of a stream."""
    heat: Watts
    """From its surfaces into it."""
    links: Annotated[Mapping[str, float], Quantity("W")]
    """Link -> heat that it brings into the volume."""
    power: Watts = 0.0
    """Set free in it."""


@dataclass(frozen=True, kw_only=True)
class HousingTemperatures:
    """Steady temperatures and heat of one gearbox at one held stage."""

    gearbox: str
    stage: str
    max_temperature: Degrees
    """Of the whole field."""
    max_temperature_body: str
    bodies: Mapping[str, BodyTemperature]
    heat: tuple[HeatFlow, ...]
    """Of every condition at every surface."""
    closure_relative: float
    """Gap of the heat balance relative to the heat turned over."""
    room_heat: Watts
    nodes: int
    elements: int
    alternatives: RadiationReadings | None = None
    """None where the other reading was not solved."""
    heat_split: tuple[GearHeatSplit, ...] = ()
    """Of every gear that friction heats."""
    fluids: tuple[FluidTemperature, ...] = ()
    """Volumes and streams of the housing."""


@dataclass(frozen=True, kw_only=True)
class CoolingBalance:
    """What shafts, pump and heaters put in and cooler and room take out at one held stage, of the whole rig."""

    stage: str
    losses: Watts
    """Of the shafts, as far as they are heat."""
    pump: Watts
    """Kinetic energy of the jets."""
    heater: Watts
    cooler: Watts
    room: Watts
    stored: Power
    """Taken up by bodies that still warm up; None in the steady state."""
    circulation: Power = None
    """Heat of the pumps of the oil circuits into the oil; None without circuits."""
    tanks: Power = None
    """From tanks and pipes of the oil circuits to the room; None without circuits."""
    streams: Power = None
    """Heat that streams of the housings carry off; None where there are none."""
    volumes: Power = None
    """Heat set free in volumes of the housings; None where there are none."""
    machines: Power = None
    """Of machines that drive the rig, into the oils; None where there are none."""
    not_heat: Watts
    """Work of mesh dampers: power of the motor that is heat of no part."""
    flow: Annotated[float, Quantity("l/min")]
    """Of all oils."""

    @property
    def put_in(self) -> float:
        """By shafts, pumps, heaters and machines [W]."""
        return math.fsum((self.losses, self.pump, self.heater, self.circulation or 0.0, self.machines or 0.0))

    @property
    def taken_out(self) -> float:
        """By cooler, room, tanks and pipes [W]."""
        return math.fsum((self.cooler, self.room, self.tanks or 0.0))

    @property
    def imbalance(self) -> Watts:
        """Put in less taken out and stored."""
        given = self.losses + self.pump + self.heater + (self.circulation or 0.0) + (self.machines or 0.0)
        given += self.volumes or 0.0
        return _left_open(
            given
            - self.cooler
            - self.room
            - (self.tanks or 0.0)
            - (self.stored or 0.0)
            - (self.streams or 0.0),
            given,
        )


@dataclass(frozen=True, kw_only=True)
class StageBalance:
    """Heat of one held stage: its balance, every source and sink, and the oil circuits in balance by name."""

    cooling: CoolingBalance
    heat: RigHeat
    circuits: Mapping[str, SteadyCircuit] = field(default_factory=dict)


# Oil circuits at the held stages.


@dataclass(frozen=True, kw_only=True)
class CircuitLine:
    """Oil of one line."""

    line: str
    setpoint: Annotated[float | None, Quantity("degC")]
    tolerance: Annotated[float, Quantity("K")]
    supply: Degrees
    drain: Degrees
    back: Annotated[float, Quantity("degC", "back in the tank")]
    """As it comes back into the tank."""
    flow: Annotated[float, Quantity("l/min")]
    heat: Watts
    """Of its consumers."""

    @property
    def holds(self) -> bool | None:
        """Whether the supply temperature is within its tolerance; None without a setpoint."""
        return None if self.setpoint is None else abs(self.supply - self.setpoint) <= self.tolerance


@dataclass(frozen=True, kw_only=True)
class CircuitDevice:
    """A heater or cooler: what it gives, what its setpoint needs, and what it can do there."""

    device: str
    power: Watts
    needed: Watts
    capability: Watts


@dataclass(frozen=True, kw_only=True)
class CircuitBalance:
    """One oil circuit at one held stage."""

    circuit: str
    stage: str
    tank: Degrees
    flow: Annotated[float, Quantity("l/min")]
    heater: Watts
    cooler: Watts
    pump: Watts
    machines: Watts
    """From what is cooled with its oil and is no consumer."""
    room: Watts
    """To the room, of tank, pipes and pump."""
    imbalance: Watts
    lines: tuple[CircuitLine, ...]
    devices: tuple[CircuitDevice, ...]

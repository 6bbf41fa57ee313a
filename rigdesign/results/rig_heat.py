"""Heat of the whole rig at one held stage by source and sink, the room that takes its share, and the power it costs."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from rigdesign.rig_heat.room import RoomBalance

Sink = Literal["room", "oil", "water", "stored", "no_heat"]
"""room: air and walls of the room; oil: the oils, whose coolers carry it; water: cooling water of machines; stored:
parts that still warm up; no_heat: work of mesh dampers, heat of no part of the model."""
SINKS: tuple[Sink, ...] = ("room", "oil", "water", "stored", "no_heat")


@dataclass(frozen=True, kw_only=True)
class HeatSource:
    """Power that becomes heat in one part of the rig, and where it goes [W]; a negative one is taken from there."""

    name: str
    kind: Literal["gearbox", "oil supply", "coupling", "machine"]
    power: float
    sinks: Mapping[Sink, float]

    @property
    def open(self) -> float:
        """Power without a sink: what the coupling loop leaves open."""
        return self.power - math.fsum(self.sinks.values())


@dataclass(frozen=True, kw_only=True)
class RigHeat:
    """Every source of heat of the rig at one held stage [W].

    drive_power : at the shaft that drives the rig
    mains_power : of the machines that drive it
    input_power : of all: drive, oil pumps, heaters
    room : None where the case states none
    """

    stage: str
    sources: tuple[HeatSource, ...]
    drive_power: float
    mains_power: float
    input_power: float
    room: RoomBalance | None = None
    warnings: tuple[str, ...] = ()

    def into(self, sink: Sink) -> float:
        """Heat of all sources into a sink [W]."""
        return math.fsum(source.sinks.get(sink, 0.0) for source in self.sources)

    @property
    def imbalance(self) -> float:
        """Power that goes in less heat of all sinks [W]."""
        return self.input_power - math.fsum(self.into(sink) for sink in SINKS)

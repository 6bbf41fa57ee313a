"""Heat of the whole rig at a held stage: every source with its sinks, and the balance of the room."""

import math
from collections.abc import Iterator, Mapping, Sequence

from rigdesign.base.number_faults import celsius
from rigdesign.case.rig_heat import OIL_COOLER
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.oil_circuits import into_tank
from rigdesign.coupling.rig_heat import DriveHeat
from rigdesign.coupling.temperatures import heat_stored, heat_to_room
from rigdesign.oil_circuit.steady_result import SteadyCircuit
from rigdesign.results.rig_heat import HeatSource, RigHeat, Sink
from rigdesign.rig.model import Rig
from rigdesign.rig_heat.component import ComponentHeat
from rigdesign.rig_heat.room import RoomBalance, room_balance

FAR_FROM_AMBIENT = 5.0
"""Between the room and ``ambient.temperature``, from which it is named [K]."""


def rig_heat(
    rig: Rig,
    last: IterationResult,
    drive: DriveHeat,
    circuits: Mapping[str, SteadyCircuit],
    stated_heater: float,
) -> RigHeat:
    """Heat of the rig at one held stage.

    drive : what drives it; circuits : oil circuits in balance
    stated_heater : power that heats the oils whose inlet temperatures the case states [W]
    """
    sources = (
        *_gearboxes(rig, last),
        *_oil_supplies(circuits, stated_heater),
        *(
            HeatSource(name=part.name, kind="coupling", power=part.power, sinks={"room": part.power})
            for part in drive.couplings
        ),
        *(_machine(rig, part) for part in drive.machines),
    )
    pumps = [placed.pumped for placed in last.losses]
    pumps += [found.pump_heat + found.pump_to_room for found in circuits.values()]
    heaters = [stated_heater, *(found.heater_power for found in circuits.values())]
    room = _room(rig, sources)
    return RigHeat(
        stage=last.point.stage,
        sources=sources,
        drive_power=drive.power,
        mains_power=drive.mains,
        input_power=math.fsum((drive.mains, *pumps, *heaters)),
        room=room,
        warnings=_warnings(rig, drive, room),
    )


def _gearboxes(rig: Rig, last: IterationResult) -> Iterator[HeatSource]:
    """Losses with the energy of the jets; what the walls do not give away leaves with the oil."""
    steady = rig.case.ambient.warming_time is None
    for name in rig.case.gearboxes:
        own = [placed for placed in last.losses if placed.gearbox == name]
        field = last.fields.get(name)
        oil = (into_tank(rig, stream) for stream in last.streams if stream.name.startswith(f"{name}."))
        sinks: dict[Sink, float] = {
            "room": 0.0 if field is None else heat_to_room(field),
            "oil": math.fsum(oil),
            "no_heat": math.fsum(placed.not_heat for placed in own),
        }
        if field is not None and not steady:
            sinks["stored"] = heat_stored(field)
        power = math.fsum((*(placed.loss.power for placed in own), *(placed.pumped for placed in own)))
        yield HeatSource(name=name, kind="gearbox", power=power, sinks=sinks)


def _oil_supplies(circuits: Mapping[str, SteadyCircuit], stated_heater: float) -> Iterator[HeatSource]:
    """Pumps and heaters of the oil circuits; their tanks and pipes give heat of the oil to the room."""
    for name, found in circuits.items():
        power = found.heater_power + found.pump_heat + found.pump_to_room
        sinks: dict[Sink, float] = {"room": found.room_loss, "oil": power - found.room_loss}
        yield HeatSource(name=name, kind="oil supply", power=power, sinks=sinks)
    if stated_heater:
        yield HeatSource(name="heaters", kind="oil supply", power=stated_heater, sinks={"oil": stated_heater})


def _machine(rig: Rig, part: ComponentHeat) -> HeatSource:
    sinks: dict[Sink, float] = {"room": part.to_room}
    if part.to_coolant:
        sinks["oil" if into_oil(rig, part) else "water"] = part.to_coolant
    return HeatSource(name=part.name, kind="machine", power=part.power, sinks=sinks)


def into_oil(rig: Rig, part: ComponentHeat) -> bool:
    """Whether the coolant of a machine is an oil of the rig; else it is water of its own."""
    return part.split.coolant in (*rig.case.oil_circuits, OIL_COOLER)


def _room(rig: Rig, sources: Sequence[HeatSource]) -> RoomBalance | None:
    room = rig.heat_parts.room
    if room is None:
        return None
    heats = {f"{source.kind} {source.name}": source.sinks.get("room", 0.0) for source in sources}
    return room_balance(room, {name: heat for name, heat in heats.items() if heat})


def _warnings(rig: Rig, drive: DriveHeat, room: RoomBalance | None) -> tuple[str, ...]:
    found = [f"{part.name}: {text}" for part in drive.components for text in part.warnings]
    ambient = rig.case.ambient.temperature
    if room is not None and abs(room.temperature - ambient) > FAR_FROM_AMBIENT:
        found.append(
            f"room: temperature = {celsius(room.temperature)}: the housings are computed in a room of "
            f"{celsius(ambient)} (ambient.temperature); write that of the room and compute again"
        )
    return tuple(found)

"""Heat of the whole rig as rows of the result."""

import math
from typing import Any

from rigdesign.results.rig_heat import SINKS, HeatSource, RigHeat
from rigdesign.results.units import ZERO
from rigdesign.rig_heat.room import Room, RoomBalance

M3_H = 3600.0
"""m3/h of a flow [m3/s]."""


def rig_heat_row(heat: RigHeat, room: Room | None) -> dict[str, Any]:
    """Sources, room and powers of one held stage; room : the one that the case states."""
    return {
        "stage": heat.stage,
        "drive_power_W": heat.drive_power,
        "mains_power_W": heat.mains_power,
        "input_power_W": heat.input_power,
        "open_W": heat.imbalance,
        "sources": [_source_row(source) for source in heat.sources],
        "room": None if room is None or heat.room is None else _room_row(room, heat.room),
    }


def _source_row(source: HeatSource) -> dict[str, Any]:
    sinks = {f"{sink}_W": source.sinks.get(sink, 0.0) for sink in SINKS}
    return {"source": source.name, "kind": source.kind, "power_W": source.power, **sinks}


def _room_row(room: Room, found: RoomBalance) -> dict[str, Any]:
    needed = found.needed_air_flow
    return {
        "temperature_degC": found.temperature - ZERO,
        "limit_degC": None if room.temperature_limit is None else room.temperature_limit - ZERO,
        "heat_W": found.heat,
        "by_air_W": found.by_air,
        "by_walls_W": found.by_walls,
        "air_flow_m3_h": M3_H * room.air_flow,
        "needed_air_flow_m3_h": None if needed is None or math.isinf(needed) else M3_H * needed,
    }

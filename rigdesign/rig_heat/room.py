"""Steady heat balance of the room a rig stands in: all its heat against ventilation and walls.

    sum P = rho c_p V (T - T_supply) + U (T - T_outside)

rho c_p V with the density of the air as it is supplied; heat, not moisture.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rigdesign.base.units import celsius, refuse, require_above, require_at_least
from thermal.films.air import air


@dataclass(frozen=True, kw_only=True)
class Room:
    """A room with ventilation.

    air_flow : supplied [m3/s]; supply_temperature : of that air [K]
    wall_conductance : of its walls to the outside [W/K]; outside_temperature : [K]
    temperature_limit : most [K]
    """

    air_flow: float
    supply_temperature: float
    wall_conductance: float = 0.0
    outside_temperature: float = 293.15
    temperature_limit: float | None = None

    def __post_init__(self) -> None:
        require_at_least("room.air_flow", self.air_flow, "m3/s", "give 0 for a room without ventilation")
        require_at_least(
            "room.wall_conductance", self.wall_conductance, "W/K", "give 0 for walls that keep heat"
        )
        require_above("room.supply_temperature", self.supply_temperature, "K", "give an absolute temperature")
        require_above(
            "room.outside_temperature", self.outside_temperature, "K", "give an absolute temperature"
        )
        if not (self.air_flow or self.wall_conductance):
            refuse(
                "room.air_flow",
                "0 m3/s",
                "must be above 0 without wall_conductance",
                "give the heat a way out",
            )

    @property
    def air_capacity_rate(self) -> float:
        """Heat that warms the supplied air by one kelvin [W/K]."""
        supplied = air(self.supply_temperature)
        return supplied.density * supplied.specific_heat * self.air_flow


@dataclass(frozen=True, kw_only=True)
class RoomBalance:
    """A room in balance."""

    heats: Mapping[str, float]
    """Into the room [W]."""
    temperature: float
    """[K]"""
    by_air: float
    """[W]"""
    by_walls: float
    """[W]"""
    needed_air_flow: float | None
    """To hold the limit [m3/s]; None without one, infinite where the supplied air is not below it."""
    warnings: tuple[str, ...]

    @property
    def heat(self) -> float:
        """Of all sources [W]."""
        return math.fsum(self.heats.values())


def room_balance(room: Room, heats: Mapping[str, float]) -> RoomBalance:
    """Temperature of a room that takes up ``heats`` [W] by name; negative ones are taken out of it."""
    heat = math.fsum(heats.values())
    rate, walls = room.air_capacity_rate, room.wall_conductance
    temperature = (heat + rate * room.supply_temperature + walls * room.outside_temperature) / (rate + walls)
    needed = _needed_air_flow(room, heat)
    limit = room.temperature_limit
    warnings: tuple[str, ...] = ()
    if limit is not None and needed is not None and temperature > limit:
        remedy = (
            f"ventilate with {3600.0 * needed:.4g} m3/h at least, or cool the air"
            if math.isfinite(needed)
            else f"supply colder air than {celsius(room.supply_temperature)}"
        )
        warnings = (f"room: temperature = {celsius(temperature)}: above {celsius(limit)}; {remedy}",)
    return RoomBalance(
        heats=dict(heats),
        temperature=temperature,
        by_air=rate * (temperature - room.supply_temperature),
        by_walls=walls * (temperature - room.outside_temperature),
        needed_air_flow=needed,
        warnings=warnings,
    )


def _needed_air_flow(room: Room, heat: float) -> float | None:
    """Air flow that holds the limit of a room [m3/s]."""
    limit = room.temperature_limit
    if limit is None:
        return None
    left = heat - room.wall_conductance * (limit - room.outside_temperature)
    if left <= 0.0:
        return 0.0
    supplied = air(room.supply_temperature)
    rise = limit - room.supply_temperature
    return left / (supplied.density * supplied.specific_heat * rise) if rise > 0.0 else math.inf

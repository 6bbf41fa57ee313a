"""Heat of a component and where it goes."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from dynamics.losses.windage import Mist, disc_coefficient, shaft_windage
from rigdesign.base.errors import CaseError
from rigdesign.base.units import celsius, refuse, require_above, require_at_least, require_share, show
from thermal.films.still import air

# Loss of a machine over speed and torque of its output shaft: constant efficiency, or a measured map.

FloatArray = NDArray[np.float64]
SAME = 1e-9
"""Distance from the edge of a map that still counts as on it, as a share of its largest value."""


class MachineLoss(Protocol):
    """Loss over the operating point of the output shaft."""

    @property
    def source(self) -> str:
        """What it follows from."""

    def power(self, speed: float, torque: float) -> float:
        """Loss [W] at a speed [rad/s] and a torque [Nm] of the output; their signs do not matter."""

    def nearest(self, speed: float, torque: float) -> tuple[float, float]:
        """Operating point nearest to this one at which the loss is known."""

    def missed_speeds(self, speed: float) -> tuple[float, float] | None:
        """Ends of the speeds at which the loss is known, where this one [rad/s] is outside of them; else None."""


@dataclass(frozen=True, kw_only=True)
class EfficiencyLoss:
    """Loss by a constant efficiency, output over input power: P (1/efficiency - 1).

    It vanishes without load; a machine that idles needs a map.
    """

    efficiency: float

    def __post_init__(self) -> None:
        require_share("efficiency", self.efficiency, "give output over input power", zero=False)

    @property
    def source(self) -> str:
        """What it follows from."""
        return f"efficiency {self.efficiency:.4g}"

    def power(self, speed: float, torque: float) -> float:
        """Loss [W] at a speed [rad/s] and a torque [Nm] of the output."""
        return abs(speed * torque) * (1.0 / self.efficiency - 1.0)

    def nearest(self, speed: float, torque: float) -> tuple[float, float]:
        """The operating point itself."""
        return speed, torque

    def missed_speeds(self, speed: float) -> None:
        """It holds at every speed."""
        return


@dataclass(frozen=True, eq=False, kw_only=True)
class LossMap:
    """Loss measured on a grid, bilinear between its points.

    speeds : (n,) of the output [rad/s], rising; torques : (m,) [Nm], rising; losses : (n, m) [W]

    Raises CaseError for a grid that does not rise, and outside of it: a map is not extrapolated.
    """

    speeds: FloatArray
    torques: FloatArray
    losses: FloatArray

    def __post_init__(self) -> None:
        for key, axis in (("speeds", self.speeds), ("torques", self.torques)):
            if axis.ndim != 1 or len(axis) < 2 or not np.all(np.diff(axis) > 0.0) or axis[0] < 0.0:
                refuse(
                    f"loss_map.{key}",
                    f"{len(axis)} values",
                    "must rise from 0 or more, two at least",
                    "sort them",
                )
        expected = len(self.speeds), len(self.torques)
        if self.losses.shape != expected:
            shape = " x ".join(str(length) for length in self.losses.shape)
            refuse(
                "loss_map.losses", shape, f"must be {expected[0]} x {expected[1]}", "give one for every point"
            )
        if not (np.all(np.isfinite(self.losses)) and np.all(self.losses >= 0.0)):
            refuse("loss_map.losses", "", "must be finite and not negative", "correct the map")

    @classmethod
    def from_columns(cls, speeds: Sequence[float], torques: Sequence[float], losses: Sequence[float]) -> Self:
        """Map from the columns of a table with one row a point, in any order; every point of the grid once."""
        if not len(speeds) == len(torques) == len(losses):
            refuse(
                "loss_map",
                f"{len(speeds)}, {len(torques)}, {len(losses)} rows",
                "must be as many",
                "complete it",
            )
        first, row = np.unique(np.asarray(speeds, dtype=np.float64), return_inverse=True)
        second, column = np.unique(np.asarray(torques, dtype=np.float64), return_inverse=True)
        counts = np.zeros((len(first), len(second)), dtype=np.int64)
        np.add.at(counts, (row, column), 1)
        if not np.all(counts == 1):
            cell = tuple(np.argwhere(counts != 1)[0])
            refuse(
                "loss_map",
                f"{show(float(first[cell[0]]), 'speed')}, {show(float(second[cell[1]]), 'torque')}",
                f"must occur once, occurs {counts[cell]} times",
                "give every speed with every torque",
            )
        grid = np.zeros(counts.shape)
        grid[row, column] = losses
        return cls(speeds=first, torques=second, losses=grid)

    @property
    def source(self) -> str:
        """What it follows from."""
        return f"loss map, {len(self.speeds)} speeds by {len(self.torques)} torques"

    def power(self, speed: float, torque: float) -> float:
        """Loss [W] at a speed [rad/s] and a torque [Nm] of the output. Raises CaseError outside the map."""
        row, along = _cell("speed", self.speeds, abs(speed))
        column, across = _cell("torque", self.torques, abs(torque))
        corners = self.losses[row : row + 2, column : column + 2]
        return float(np.array([1.0 - along, along]) @ corners @ np.array([1.0 - across, across]))

    def nearest(self, speed: float, torque: float) -> tuple[float, float]:
        """Operating point of the map nearest to this one."""
        return _within(self.speeds, speed), _within(self.torques, torque)

    def missed_speeds(self, speed: float) -> tuple[float, float] | None:
        """Ends of the map, where a speed [rad/s] of the output is outside of it."""
        low, high = float(self.speeds[0]), float(self.speeds[-1])
        slack = SAME * high
        return None if low - slack <= abs(speed) <= high + slack else (low, high)


def _within(axis: FloatArray, value: float) -> float:
    return min(max(abs(value), float(axis[0])), float(axis[-1]))


def _cell(kind: str, axis: FloatArray, value: float) -> tuple[int, float]:
    """Number of the interval a value lies in, and its share of it; kind : of quantity, speed or torque."""
    low, high = float(axis[0]), float(axis[-1])
    if not low - SAME * high <= value <= high + SAME * high:
        refuse(
            f"loss_map.{kind}s",
            show(value, kind),
            f"must lie within the map, {show(low, kind)} to {show(high, kind)}",
            "extend the map to this operating point; it is not extrapolated",
        )
    value = min(max(value, low), high)
    interval = min(int(np.searchsorted(axis, value, side="right")) - 1, len(axis) - 2)
    return interval, float((value - axis[interval]) / (axis[interval + 1] - axis[interval]))


ROOM = "room"
"""Where heat goes that no coolant takes."""


@dataclass(frozen=True, kw_only=True)
class HeatSplit:
    """How the heat of a component splits.

    coolant : what takes part of it, an oil circuit or the cooling water of a motor
    coolant_share : of the heat [-]; the rest goes to the room
    """

    coolant: str = "coolant"
    coolant_share: float = 0.0

    def __post_init__(self) -> None:
        require_share("coolant_share", self.coolant_share, "give 0 for a component cooled by air")


@dataclass(frozen=True, kw_only=True)
class ComponentHeat:
    """Heat of one component [W]."""

    name: str
    power: float
    split: HeatSplit
    source: str
    warnings: tuple[str, ...] = ()

    @property
    def to_coolant(self) -> float:
        """[W]"""
        return self.split.coolant_share * self.power

    @property
    def to_room(self) -> float:
        """[W]"""
        return self.power - self.to_coolant


def heat_by_sink(components: Iterable[ComponentHeat]) -> dict[str, float]:
    """Heat of all components by where it goes [W]: `ROOM`, and every coolant by name."""
    parts: dict[str, list[float]] = {ROOM: []}
    for each in components:
        parts[ROOM].append(each.to_room)
        if each.split.coolant_share:
            parts.setdefault(each.split.coolant, []).append(each.to_coolant)
    return {sink: math.fsum(values) for sink, values in parts.items()}


class CouplingHeat(Protocol):
    """Shaft coupling with the heat that it makes."""

    def heat(self, speed: float, air_temperature: float) -> ComponentHeat:
        """Heat [W] at a speed [rad/s] in air of a temperature [K] at one atmosphere."""


# Windage of a shaft coupling in the air of its guard: two free faces and a smooth cylinder.
#
#     P = rho omega^3 R^5 C_disc / 2  +  pi C_cylinder rho omega^3 R^4 L
#
# Source: free disc (Schlichting, Boundary-Layer Theory) and rotating cylinder (Theodorsen and Regier, NACA Report 793),
# both of `dynamics.losses.windage`. Bolt heads and a tight guard are not in it: take a rig's measured torque where they
# count.


@dataclass(frozen=True, kw_only=True)
class CouplingRotor:
    """Coupling as the air sees it.

    radius : of its rim [m]; length : of its rim [m]
    hub_radius : inside of which its faces are covered by the shafts [m]
    """

    name: str
    radius: float
    length: float
    hub_radius: float = 0.0
    split: HeatSplit = field(default_factory=HeatSplit)

    def __post_init__(self) -> None:
        require_above(f"{self.name}.length", self.length, "m", "give the length of the rim")
        require_at_least(f"{self.name}.hub_radius", self.hub_radius, "m", "give 0 for whole faces")
        require_above(
            f"{self.name}.radius", self.radius, "m", "the rim is outside of the hub", limit=self.hub_radius
        )

    def heat(self, speed: float, air_temperature: float) -> ComponentHeat:
        """Windage [W] at a speed [rad/s] in air of a temperature [K] at one atmosphere.

        The faces are those of a disc less what the shafts cover, each with the coefficient of its own radius.
        """
        gas = air(air_temperature)
        mist = Mist(density=gas.density, viscosity=gas.viscosity)
        rim = shaft_windage(self.name, self.radius, self.length, speed, mist)
        faces = _faces(self.radius, speed, mist) - _faces(self.hub_radius, speed, mist)
        return ComponentHeat(
            name=self.name,
            power=rim.power + faces,
            split=self.split,
            source="free disc (Schlichting) and rotating cylinder (NACA Report 793)",
            warnings=rim.warnings,
        )


def _faces(radius: float, speed: float, mist: Mist) -> float:
    """Friction of both faces of a disc [W]."""
    return 0.5 * mist.density * abs(speed) ** 3 * radius**5 * disc_coefficient(mist.reynolds(speed, radius))


# From the power a back-to-back rig takes to the mains: transmission gearbox, motor, drive, each with its loss.


@dataclass(frozen=True, kw_only=True)
class Machine:
    """A machine between the mains and the rig.

    loss : over the operating point of its output
    speed_ratio : speed of its input over that of its output [-]; for a motor, and for a frequency converter, 1: a loss
        map of a converter stands over speed and torque of its motor
    """

    name: str
    loss: MachineLoss
    speed_ratio: float = 1.0
    split: HeatSplit = field(default_factory=HeatSplit)

    def __post_init__(self) -> None:
        require_above(f"{self.name}.speed_ratio", self.speed_ratio, "", "give input over output speed")


@dataclass(frozen=True, kw_only=True)
class DriveTrainHeat:
    """Heat of every machine, and the power taken from the mains [W]."""

    components: tuple[ComponentHeat, ...]
    input_power: float


def drive_train_heat(
    speed: float, power: float, machines: Sequence[Machine], *, nearest: bool = False
) -> DriveTrainHeat:
    """Losses of the machines that drive a rig.

    Parameters
    ----------
    speed : of the shaft that drives the rig [rad/s], above 0
    power : at that shaft [W]; in a back-to-back rig the sum of its losses
    machines : from the rig to the mains, each driving the one before
    nearest : an operating point outside of a loss map has the loss of the nearest one in it, for a power that is not
        yet the final one

    Raises CaseError for a negative power, or an operating point outside of a loss map.
    """
    require_above("drive.speed", speed, "rad/s", "give the speed of the driven shaft")
    require_at_least("drive.power", power, "W", "the losses of the rig cannot be negative")
    components = []
    for machine in machines:
        lost = _lost(machine, speed, power / speed, nearest=nearest)
        components.append(
            ComponentHeat(name=machine.name, power=lost, split=machine.split, source=machine.loss.source)
        )
        power += lost
        speed *= machine.speed_ratio
    return DriveTrainHeat(components=tuple(components), input_power=power)


def _lost(machine: Machine, speed: float, torque: float, *, nearest: bool) -> float:
    """Loss of a machine [W]; faults begin with its name."""
    try:
        return machine.loss.power(*(machine.loss.nearest(speed, torque) if nearest else (speed, torque)))
    except CaseError as error:
        raise CaseError(
            [replace(fault, path=f"{machine.name}.{fault.path}") for fault in error.faults]
        ) from error


# Steady heat balance of the room a rig stands in: all its heat against ventilation and walls.
#
#     sum P = rho c_p V (T - T_supply) + U (T - T_outside)
#
# rho c_p V with the density of the air as it is supplied; heat, not moisture.


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

"""An oil circuit over time, driven by what its consumers give back.

Unknowns are the heat contents of tank and pipes. A step is the L-stable diagonally implicit method of second order
with two stages of weight gamma = 1 - 1/sqrt(2) (Alexander 1977, SIAM J. Numer. Anal. 14): each stage is a balance of
the tank with storage, the second gives the end of the step. A step is cut where it would be inexact (a pipe that fills,
a heater that comes to its setpoint), and where an on-off thermostat switches.

What a consumer gives back during a step is taken as heat: its return temperature against the supply and the flow it
was given before that step. So heat is kept whatever the step, and the lag between circuit and consumers is one step.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Literal

from scipy.optimize import brentq

from rigdesign.base.errors import NotConvergedError
from rigdesign.base.units import celsius, require_above
from rigdesign.oil_circuit.circuit import Circuit, enthalpy
from rigdesign.oil_circuit.line_balance import (
    RANGE,
    Contents,
    HeatTaken,
    Setpoints,
    TankBalance,
    TankEquation,
    pipe_content,
    tank_content,
)
from rigdesign.oil_circuit.steady import SteadyCircuit, require_heats

# On-off thermostats of a tank: when they switch next, and what they force while they do not.

Device = Literal["heater", "tank_cooler"]
EDGE = 1e-6
"""Distance from a threshold that counts as standing there [K]."""


@dataclass(frozen=True, kw_only=True)
class Thermostat:
    """An on-off device of the tank.

    threshold : temperature of the tank at which it switches next [K]
    sign : 1 where that is passed upwards, -1 downwards
    """

    device: Device
    threshold: float
    sign: float

    def passed(self, temperature: float) -> float:
        """Distance by which a temperature is beyond the threshold [K]; negative before it."""
        return self.sign * (temperature - self.threshold)


def thermostats(circuit: Circuit, on: frozenset[Device]) -> list[Thermostat]:
    """Heater and tank cooler as far as they have a band; ``on``: those that work."""
    found = []
    heater, cooler = circuit.heater, circuit.tank_cooler
    if heater and heater.band:
        sign = 1.0 if "heater" in on else -1.0
        found.append(
            Thermostat(device="heater", threshold=heater.setpoint + 0.5 * sign * heater.band, sign=sign)
        )
    if cooler and cooler.band:
        sign = -1.0 if "tank_cooler" in on else 1.0
        threshold = cooler.setpoint + 0.5 * sign * cooler.band
        found.append(Thermostat(device="tank_cooler", threshold=threshold, sign=sign))
    return found


def switched(circuit: Circuit, on: frozenset[Device], temperature: float) -> frozenset[Device]:
    """Devices that work once the thermostats have met a temperature of the tank [K]."""
    return on ^ {each.device for each in thermostats(circuit, on) if each.passed(temperature) > EDGE}


def forced_setpoints(circuit: Circuit, on: frozenset[Device]) -> Setpoints:
    """Setpoints of continuous control; infinite ones for on-off devices, as their thermostats stand."""
    given = Setpoints.of(circuit)
    if circuit.heater and circuit.heater.band:
        given = replace(given, heater=math.inf if "heater" in on else -math.inf)
    if circuit.tank_cooler and circuit.tank_cooler.band:
        given = replace(given, cooler=-math.inf if "tank_cooler" in on else math.inf)
    return given


GAMMA = 1.0 - math.sqrt(0.5)
TOLERANCE = 0.2
"""Distance from a step of first order (backward Euler) above which a step is halved [K]; its own error is far less."""
SHORTEST = 1e-9
"""Share of a step below which its rest is left out."""
MOST_SWITCHINGS = 500
"""Of the thermostats in one step."""


@dataclass(frozen=True, kw_only=True)
class OilSupply:
    """Oil a consumer is fed with while the pump runs."""

    temperature: float
    """[K]"""
    mass_flow: float
    """[kg/s]"""


@dataclass(frozen=True, kw_only=True)
class Energies:
    """Heat moved during a step [J]."""

    heater: float = 0.0
    trim_heaters: float = 0.0
    pump: float = 0.0
    """Into the oil."""
    consumers: float = 0.0
    """Into the oil."""
    tank_cooler: float = 0.0
    line_coolers: float = 0.0
    room: float = 0.0
    """Of tank and pipes."""
    stored: float = 0.0
    """In tank and pipes."""

    def __add__(self, other: "Energies") -> "Energies":
        return Energies(
            **{each.name: getattr(self, each.name) + getattr(other, each.name) for each in fields(self)}
        )

    @property
    def imbalance(self) -> float:
        """What the heat balance leaves open [J]."""
        into = (self.heater, self.trim_heaters, self.pump, self.consumers)
        out = (self.tank_cooler, self.line_coolers, self.room, self.stored)
        return math.fsum((*into, *(-each for each in out)))


@dataclass(frozen=True, kw_only=True)
class CircuitStep:
    """A step: the state at its end, and the heat moved."""

    state: "CircuitState"
    energies: Energies
    switchings: int
    """Of the thermostats."""

    @property
    def supplies(self) -> Mapping[str, float]:
        """Consumer -> supply temperature at the end of the step [K]."""
        return {name: supply.temperature for name, supply in self.state.supplies.items()}


@dataclass(frozen=True, kw_only=True)
class CircuitState:
    """A circuit at one time; a step gives the next one and leaves this as it is."""

    circuit: Circuit
    contents: Contents
    supplies: Mapping[str, OilSupply]
    """Consumer -> what it is fed with in the next step, if the pump runs."""
    on: frozenset[Device] = frozenset()
    """On-off devices of the tank that work."""

    @classmethod
    def uniform(cls, circuit: Circuit, temperature: float) -> "CircuitState":
        """All oil at one temperature [K]: a circuit that has stood."""
        pipes = {line.name: temperature for line in circuit.lines}
        return cls._of(circuit, temperature, pipes, pipes)

    @classmethod
    def steady(cls, found: SteadyCircuit) -> "CircuitState":
        """A circuit in balance; on-off thermostats start off."""
        supply = {name: line.supply for name, line in found.lines.items()}
        back = {name: line.back for name, line in found.lines.items()}
        return cls._of(found.circuit, found.tank_temperature, supply, back)

    @classmethod
    def _of(
        cls, circuit: Circuit, tank: float, supply: Mapping[str, float], back: Mapping[str, float]
    ) -> "CircuitState":
        oil, room = circuit.oil, circuit.room_temperature
        contents = Contents(
            tank=tank_content(circuit).at(tank),
            supply={
                line.name: pipe_content(oil, line.supply_pipe, room).at(supply[line.name])
                for line in circuit.lines
            },
            return_={
                line.name: pipe_content(oil, line.return_pipe, room).at(back[line.name])
                for line in circuit.lines
            },
        )
        return cls(circuit=circuit, contents=contents, supplies=_fed(circuit, supply))

    @property
    def tank_temperature(self) -> float:
        """[K]"""
        return tank_content(self.circuit).temperature(self.contents.tank)

    def step(self, duration: float, returns: Mapping[str, float], *, running: bool = True) -> CircuitStep:
        """The circuit after a time [s].

        Parameters
        ----------
        returns : consumer -> temperature at which it gave back, over the step, the oil of `supplies` [K]; not looked
            at while the pump rests
        running : whether the pump runs; without it heater and a tank cooler with a pump of its own still work

        Raises
        ------
        CaseError
            No time, or consumers without a return temperature.
        NotConvergedError
            No balance of the tank, or a thermostat that switches without end.
        """
        if not running:
            return self.step_with_heats(duration, dict.fromkeys(self.supplies, 0.0), running=False)
        require_heats(self.circuit, returns)
        oil = self.circuit.oil
        heats = {
            name: fed.mass_flow * (enthalpy(oil, returns[name]) - enthalpy(oil, fed.temperature))
            for name, fed in self.supplies.items()
        }
        return self.step_with_heats(duration, heats)

    def step_with_heats(
        self, duration: float, heats: Mapping[str, HeatTaken], *, running: bool = True
    ) -> CircuitStep:
        """The same, driven by the heat into the oil of each consumer [W], or that over its supply temperature [K]."""
        require_above("step.duration", duration, "s", "give a time step")
        require_heats(self.circuit, heats)
        flows = {
            line.name: running * sum(self.supplies[each.name].mass_flow for each in line.consumers)
            for line in self.circuit.lines
        }
        on = switched(self.circuit, self.on, self.tank_temperature)
        state, left, trial, moved, switchings = replace(self, on=on), duration, duration, Energies(), 0
        while left > SHORTEST * duration:
            length = min(trial, left)
            advanced = state._attempt(length, flows, heats)
            if advanced is None:
                trial = 0.5 * length
                if trial < SHORTEST * duration:
                    raise NotConvergedError(
                        f"oil circuit {self.circuit.name}: no step from a tank of {celsius(state.tank_temperature)}, "
                        f"however short: the heat of the consumers leads out of {celsius(RANGE[0])} to "
                        f"{celsius(RANGE[1])}; correct it, or give it a way out"
                    )
                continue
            device: Device | None = None
            if switched(self.circuit, state.on, advanced[0].tank_temperature) != state.on:
                length, device = state._next_switching(length, advanced[0], flows, heats)
                advanced = state._stages(length, flows, heats)
            state, moved, left, trial = advanced[0], moved + advanced[1], left - length, 2.0 * length
            if device:
                state, switchings = replace(state, on=state.on ^ {device}), switchings + 1
            if switchings > MOST_SWITCHINGS:
                raise NotConvergedError(
                    f"oil circuit {self.circuit.name}: thermostats switch more than {MOST_SWITCHINGS} times in "
                    f"{duration:.4g} s; widen heater.band or tank_cooler.band, or take a smaller heater"
                )
        return CircuitStep(state=state, energies=moved, switchings=switchings)

    def _temperatures(self) -> list[float]:
        """Of the tank and of every pipe that holds oil [K]."""
        circuit, found = self.circuit, [self.tank_temperature]
        for line in circuit.lines:
            for pipe, content in (
                (line.supply_pipe, self.contents.supply[line.name]),
                (line.return_pipe, self.contents.return_[line.name]),
            ):
                if pipe.volume:
                    found.append(
                        pipe_content(circuit.oil, pipe, circuit.room_temperature).temperature(content)
                    )
        return found

    def _attempt(
        self, duration: float, flows: Mapping[str, float], heats: Mapping[str, HeatTaken]
    ) -> tuple["CircuitState", Energies] | None:
        """A step, thermostats held; None where it is too long: one of first order ends elsewhere, or it has no end."""
        try:
            advanced = self._stages(duration, flows, heats)
            equation = self._equation(duration, flows, heats)
            euler = equation.solve(forced_setpoints(self.circuit, self.on))
        except NotConvergedError:
            return None
        first_order = replace(self, contents=_filled(self.contents, euler, duration))
        error = max(abs(a - b) for a, b in zip(advanced[0]._temperatures(), first_order._temperatures()))
        return advanced if error <= TOLERANCE else None

    def _next_switching(
        self,
        duration: float,
        advanced: "CircuitState",
        flows: Mapping[str, float],
        heats: Mapping[str, HeatTaken],
    ) -> tuple[float, Device]:
        """Time [s] at which the first thermostat switches on the way to ``advanced``, and the device it switches."""
        before, after, shortest = self.tank_temperature, advanced.tank_temperature, 1e-7 * duration

        def beyond(time: float, thermostat: Thermostat) -> float:
            reached = self._stages(time, flows, heats)[0].tank_temperature if time else before
            return thermostat.passed(reached)

        events: list[tuple[float, Device]] = []
        for each in thermostats(self.circuit, self.on):
            if each.passed(after) <= EDGE:
                continue
            crosses = each.passed(before) < 0.0
            time = float(brentq(beyond, 0.0, duration, args=(each,), xtol=shortest)) if crosses else 0.0
            events.append((max(time, shortest), each.device))
        return min(events)

    def _equation(
        self, weight: float, flows: Mapping[str, float], heats: Mapping[str, HeatTaken]
    ) -> TankEquation:
        return TankEquation(
            circuit=self.circuit, mass_flows=flows, heats=heats, before=self.contents, weight=weight
        )

    def _stages(
        self, duration: float, flows: Mapping[str, float], heats: Mapping[str, HeatTaken]
    ) -> tuple["CircuitState", Energies]:
        """Both stages of the implicit method, thermostats held."""
        weight, setpoints = GAMMA * duration, forced_setpoints(self.circuit, self.on)
        equation = self._equation(weight, flows, heats)
        first = equation.solve(setpoints)
        rest = (1.0 - GAMMA) * duration
        between = _filled(self.contents, first, rest)
        second = replace(equation, before=between).solve(setpoints)
        supplies = _fed(self.circuit, {name: line.supply for name, line in second.lines.items()})
        energies = _moved(self.circuit, first, flows, rest) + _moved(self.circuit, second, flows, weight)
        return replace(self, contents=_filled(between, second, weight), supplies=supplies), energies


def _fed(circuit: Circuit, supply: Mapping[str, float]) -> dict[str, OilSupply]:
    """Consumers -> oil at the supply temperature [K] of their line."""
    return {
        consumer.name: OilSupply(
            temperature=supply[line.name], mass_flow=circuit.oil.density(supply[line.name]) * consumer.flow
        )
        for line in circuit.lines
        for consumer in line.consumers
    }


def _filled(contents: Contents, balance: TankBalance, weight: float) -> Contents:
    """Contents after the heat of a stage over a weight [s]."""
    lines = balance.lines
    return Contents(
        tank=contents.tank + weight * balance.stored,
        supply={name: value + weight * lines[name].supply_stored for name, value in contents.supply.items()},
        return_={
            name: value + weight * lines[name].return_stored for name, value in contents.return_.items()
        },
    )


def _moved(circuit: Circuit, balance: TankBalance, flows: Mapping[str, float], weight: float) -> Energies:
    """Heat moved by a stage over a weight [s]."""
    lines = balance.lines.values()
    stored = (balance.stored, *(each for line in lines for each in (line.supply_stored, line.return_stored)))
    return Energies(
        heater=weight * balance.heater_power,
        trim_heaters=weight * math.fsum(line.trim_power for line in lines),
        pump=weight * circuit.pump_heat if any(flows.values()) else 0.0,
        consumers=weight * math.fsum(heat for line in lines for heat in line.heats.values()),
        tank_cooler=weight * balance.cooler_heat,
        line_coolers=weight * math.fsum(line.cooler_heat for line in lines),
        room=weight * balance.room_loss,
        stored=weight * math.fsum(stored),
    )

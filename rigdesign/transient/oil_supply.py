"""Oil circuits over one branch of the thermal history, driven by the heat that the housings give back.

Housings and circuits are marched in turn over the whole branch (waveform relaxation): the housings with the supply
temperatures of the sweep before, then the circuits with the heats of these housings. The circuits know about
how much less heat a stream brings back the warmer it is fed, so that few sweeps are needed. At the end both have the
same supply temperatures within `SWEEP_TOLERANCE`, whatever the time steps; heater and cooler are within their limits
at every time.

Source: Lelarasmee, Ruehli, Sangiovanni-Vincentelli, IEEE Trans. CAD 1 (1982) 131.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.model import Case
from rigdesign.oil_circuit.line_balance import HeatTaken
from rigdesign.oil_circuit.state import CircuitState, Energies
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import meant_supplies
from rigdesign.transient.phases import Phase

FloatArray = NDArray[np.float64]
SWEEP_TOLERANCE = 0.5
"""Difference of the supply temperatures of housings and circuits that ends the sweeps [K]."""
MOST_SWEEPS = 8
PARTS = 4
"""Parts of a time step of the housings in which the circuits are computed: supply temperatures are curved over it."""


@dataclass(frozen=True, kw_only=True)
class CircuitCurve:
    """One oil circuit over one branch; n times, powers are means over the step that ends at each."""

    tank: FloatArray
    """(n,) [K]"""
    heater: FloatArray
    """(n,) of tank and lines [W]."""
    cooler: FloatArray
    """(n,) of tank and lines [W]."""
    energies: Energies
    """Of the whole branch."""


@dataclass(frozen=True, kw_only=True)
class SupplyHistory:
    """What the oil circuits do over one branch."""

    times: FloatArray
    """(n,) since the start of the schedule [s]."""
    supplies: Mapping[str, FloatArray]
    """``gearbox.stream`` -> (n,) supply temperature of its line [K]; that it would have while no oil runs."""
    circuits: Mapping[str, CircuitCurve]
    states: Sequence[Mapping[str, CircuitState]]
    """Circuit -> its state, at every time."""

    def at(self, time: float) -> dict[str, float]:
        """Stream -> supply temperature [K] at a time since the start of the schedule [s]."""
        return {
            stream: float(np.interp(time, self.times, values)) for stream, values in self.supplies.items()
        }

    def sampled(self, times: FloatArray) -> dict[str, FloatArray]:
        """Stream -> (n,) supply temperature [K] at n times since the start of the schedule [s]."""
        return {stream: np.interp(times, self.times, values) for stream, values in self.supplies.items()}

    def states_at(self, time: float) -> Mapping[str, CircuitState]:
        """The circuits at the last of the times up to one [s]."""
        row = int(np.searchsorted(self.times, time * (1.0 + 1e-12), side="right")) - 1
        return self.states[max(row, 0)]

    def change(self, other: "SupplyHistory") -> float:
        """Largest difference of a supply temperature to another history of the same branch [K]."""
        return max(
            float(np.max(np.abs(values - np.interp(self.times, other.times, other.supplies[stream]))))
            for stream, values in self.supplies.items()
        )


@dataclass(frozen=True, kw_only=True)
class WallAnswer:
    """How the walls of a stream answer another supply temperature, as one body: what the sweeps expect of a housing.

        C dw/dt = G (T - w) - L w ,    heat of the stream changes by - G (T - w)

    with T and w the changes of supply and walls. It speeds the sweeps up and moves no result.

    prompt : G, while the walls stay [W/K]; lasting : G L / (G + L), once they are warm [W/K]; capacity : C [J/K]
    """

    prompt: float
    lasting: float = 0.0
    capacity: float = math.inf

    @property
    def lost(self) -> float:
        """L [W/K]"""
        if self.lasting >= 0.99 * self.prompt:
            return 99.0 * self.prompt
        return self.lasting * self.prompt / (self.prompt - self.lasting)

    def after(self, wall: float, supply: float, duration: float) -> float:
        """Change of the walls [K] after a time [s] with a change of the supply [K]; implicit."""
        rate = duration / self.capacity
        return (wall + rate * self.prompt * supply) / (1.0 + rate * (self.prompt + self.lost))

    def heat(self, wall: float, supply: float, duration: float) -> float:
        """Change of the heat of the stream at the end of that time [W]."""
        return -self.prompt * (supply - self.after(wall, supply, duration))


@dataclass(frozen=True, kw_only=True)
class StreamHeats:
    """Heat that the oil streams of all housings bring to their tanks over one branch."""

    times: FloatArray
    """(n,) since the start of the schedule [s]."""
    phases: Sequence[Phase]
    phase: NDArray[np.int32]
    """(n,) number of the phase each time ends."""
    heats: Mapping[str, FloatArray]
    """``gearbox.stream`` -> (n,) above its supply temperature [W]."""
    leaked: Mapping[str, FloatArray]
    """``gearbox.stream`` -> (n,) what leaks between circuits add to that [W], see `OilStream.leaked`."""
    supplies: Mapping[str, FloatArray]
    """``gearbox.stream`` -> (n,) supply temperature these heats belong to [K]."""

    @property
    def to_tank(self) -> dict[str, FloatArray]:
        """``gearbox.stream`` -> (n,) heat into the tank of its circuit [W]."""
        return {name: heat + self.leaked.get(name, 0.0) for name, heat in self.heats.items()}


def start_states(rig: Rig) -> dict[str, CircuitState]:
    """Oil circuits at the begin of the schedule: at the temperature of the room, or that which the case states."""
    return {
        name: CircuitState.uniform(circuit, start_temperature(rig.case, name))
        for name, circuit in rig.oil_circuits.items()
    }


def start_temperature(case: Case, circuit: str) -> float:
    """Of a tank at the begin of the schedule [K]."""
    return case.oil_circuits[circuit].tank.start_temperature or case.ambient.temperature


def first_guess(rig: Rig, states: Mapping[str, CircuitState]) -> SupplyHistory:
    """Supply temperatures at what they are meant to be all the time: what the first sweep starts from."""
    return SupplyHistory(
        times=np.zeros(1),
        supplies={name: np.full(1, meant) for name, meant in meant_supplies(rig).items()},
        circuits={},
        states=[states],
    )


class Secants:
    """Supply temperatures of the next sweep of one branch from those of all sweeps so far (Anderson acceleration).

    A heater that stays at its limit lets body and tank answer each other over hours: plain sweeps then close in slowly.

    Source: Walker, Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
    """

    def __init__(self) -> None:
        self._sweeps: list[tuple[SupplyHistory, SupplyHistory]] = []

    def following(self, fed: SupplyHistory, found: SupplyHistory) -> SupplyHistory:
        """What to feed next, at the times of ``found``.

        fed, found : that of this sweep, and what the circuits gave under its heats
        """
        self._sweeps.append((fed, found))
        ins, outs = (
            np.array([np.concatenate(list(each.sampled(found.times).values())) for each in histories])
            for histories in zip(*self._sweeps, strict=True)
        )
        after = outs[-1]
        if len(outs) > 1:
            residuals = outs - ins
            shares = np.linalg.lstsq(np.diff(residuals, axis=0).T, residuals[-1], rcond=1e-6)[0]
            after = after - np.diff(outs, axis=0).T @ shares
        parts = np.split(after, len(found.supplies))
        return replace(found, supplies=dict(zip(found.supplies, parts, strict=True)))


def in_parts(times: FloatArray) -> FloatArray:
    """The times (n,), and between each two of them `PARTS` - 1 more."""
    return np.interp(np.arange(PARTS * (len(times) - 1) + 1) / PARTS, np.arange(len(times)), times)


def circuits_over(
    start: Mapping[str, CircuitState], given: StreamHeats, answers: Mapping[str, WallAnswer]
) -> SupplyHistory:
    """The circuits over one branch.

    start : at the first of the times
    answers : stream -> how its heat answers its supply temperature

    Raises
    ------
    NotConvergedError
        As `CircuitState.step_with_heats`.
    """
    runs = {name: _run(state, given, answers) for name, state in start.items()}
    count = len(given.times)
    states = [{name: run[0][row] for name, run in runs.items()} for row in range(count)]
    return SupplyHistory(
        times=given.times,
        supplies={
            consumer.name: np.array([each[name].supplies[consumer.name].temperature for each in states])
            for name, state in start.items()
            for consumer in state.circuit.consumers
        },
        circuits={name: run[1] for name, run in runs.items()},
        states=states,
    )


def _run(
    start: CircuitState, given: StreamHeats, answers: Mapping[str, WallAnswer]
) -> tuple[list[CircuitState], CircuitCurve]:
    states, moved, whole = [start], [Energies()], Energies()
    lengths = np.diff(given.times)
    given = replace(given, heats=given.to_tank)
    walls = {consumer.name: 0.0 for consumer in start.circuit.consumers}
    for step, length in enumerate(lengths.tolist()):
        running = given.phases[given.phase[step + 1]].oil
        heats = {name: _answered(given, name, step, answers[name], wall) for name, wall in walls.items()}
        done = states[-1].step_with_heats(length, heats, running=running)
        states.append(done.state)
        moved.append(done.energies)
        whole = whole + done.energies
        for name, wall in walls.items():
            change = done.supplies[name] - float(given.supplies[name][step + 1]) if running else 0.0
            walls[name] = answers[name].after(wall, change, length)
    each = np.concatenate([[1.0], lengths])
    heater = np.array([energies.heater + energies.trim_heaters for energies in moved])
    cooler = np.array([energies.tank_cooler + energies.line_coolers for energies in moved])
    curve = CircuitCurve(
        tank=np.array([state.tank_temperature for state in states]),
        heater=heater / each,
        cooler=cooler / each,
        energies=whole,
    )
    return states, curve


def _answered(given: StreamHeats, name: str, step: int, answer: WallAnswer, wall: float) -> HeatTaken:
    """Heat of a stream over a step as a function of its supply temperature: mean of both ends in one phase.

    wall : change of its walls before the step [K]
    """
    same = given.phase[step] == given.phase[step + 1] and step > 0
    ends = slice(step if same else step + 1, step + 2)
    heat, fed = (float(np.mean(values[name][ends])) for values in (given.heats, given.supplies))
    length = float(given.times[step + 1] - given.times[step])
    return lambda supply: heat + answer.heat(wall, supply - fed, length)

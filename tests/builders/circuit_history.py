"""An oil circuit alone over a schedule of times, its consumers given by their heat."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.units import celsius, refuse
from rigdesign.oil_circuit.circuit import SupplyLine
from rigdesign.oil_circuit.line_balance import HeatTaken
from rigdesign.oil_circuit.state import CircuitState, CircuitStep, Energies

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class CircuitHistory:
    """Temperatures at n times, and mean powers of the n - 1 steps between them."""

    times: FloatArray
    """(n,) [s]"""
    tank: FloatArray
    """(n,) [K]"""
    supplies: Mapping[str, FloatArray]
    """Consumer -> (n,) [K]."""
    heater: FloatArray
    """(n - 1,) of tank and lines [W]."""
    cooler: FloatArray
    """(n - 1,) of tank and lines [W]."""
    energies: Energies
    """Of all steps."""
    last: CircuitState

    def held_from(self, line: SupplyLine) -> float | None:
        """First of the times [s] from which on a line is fed within the tolerance of its setpoint; None if never."""
        if line.setpoint is None:
            return float(self.times[0])
        outside = np.abs(self.supplies[line.consumers[0].name] - line.setpoint) > line.tolerance
        if outside[-1]:
            return None
        last = np.flatnonzero(outside)
        return float(self.times[last[-1] + 1 if len(last) else 0])

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on lines whose setpoint is not held at the end, and on a heater at its limit there."""
        circuit, found = self.last.circuit, []
        for line in circuit.lines:
            if line.setpoint is None or self.held_from(line) is not None:
                continue
            reached = float(self.supplies[line.consumers[0].name][-1])
            limit = ""
            if reached < line.setpoint:
                possible = math.fsum(each.trim_power_limit for each in circuit.lines)
                possible += circuit.heater.power_limit if circuit.heater else 0.0
                limit = f", with {1e-3 * self.heater[-1]:.4g} of {1e-3 * possible:.4g} kW of the heaters"
            found.append(
                f"{circuit.name}.lines.{line.name}: supply temperature after {self.times[-1] - self.times[0]:.4g} s = "
                f"{celsius(reached)}{limit}: not held at {celsius(line.setpoint)} within {line.tolerance:.3g} K; "
                + (
                    "a larger heater or more time"
                    if reached < line.setpoint
                    else "a larger cooler or less heat"
                )
            )
        return tuple(found)

    def time_below(self, consumer: str, temperature: float) -> float:
        """Time for which the supply of a consumer is below a temperature [s], straight between the times."""
        supply = self.supplies[consumer] - temperature
        before, after, length = supply[:-1], supply[1:], np.diff(self.times)
        low, high = np.minimum(before, after), np.maximum(before, after)
        crossing = np.where(high > low, -low / np.where(high > low, high - low, 1.0), 0.0)
        share = np.where(high <= 0.0, np.where(low < 0.0, 1.0, 0.0), np.clip(crossing, 0.0, 1.0))
        return float(np.sum(share * length))


def circuit_history(
    start: CircuitState, times: Sequence[float], heats: Mapping[str, HeatTaken], *, running: bool = True
) -> CircuitHistory:
    """The circuit at rising times [s], the first that of ``start``.

    heats : consumer -> heat into its oil [W], or that as a function of its supply temperature [K]

    Raises CaseError for times that do not rise, and what `CircuitState.step` raises.
    """
    lengths = np.diff(np.asarray(times, dtype=np.float64))
    if not (len(lengths) and np.all(lengths > 0.0)):
        refuse("times", f"{len(times)} times", "must be at least two, each above the one before", "sort them")
    state, steps = start, list[CircuitStep]()
    for length in lengths:
        steps.append(state.step_with_heats(float(length), heats, running=running))
        state = steps[-1].state
    states = [start, *(step.state for step in steps)]
    moved = Energies()
    for step in steps:
        moved = moved + step.energies
    return CircuitHistory(
        times=np.asarray(times, dtype=np.float64),
        tank=np.array([each.tank_temperature for each in states]),
        supplies={
            name: np.array([each.supplies[name].temperature for each in states]) for name in start.supplies
        },
        heater=np.array([step.energies.heater + step.energies.trim_heaters for step in steps]) / lengths,
        cooler=np.array([step.energies.tank_cooler + step.energies.line_coolers for step in steps]) / lengths,
        energies=moved,
        last=state,
    )

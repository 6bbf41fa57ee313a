"""Heaters and cooler over time as records: curves, and the moment at which each must give or take most."""

from collections.abc import Iterator, Sequence

import numpy as np

from rigdesign.case.model import Case
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.transient import Extreme, OilPowerCurve, SupplyHeld
from rigdesign.results.units import ZERO
from rigdesign.transient.oil_power import OilPower


def oil_power_curve(power: OilPower) -> OilPowerCurve:
    """One branch in the units of the result."""
    circuits = {} if power.supply is None else power.supply.circuits
    supplies = {} if power.supply is None else power.supply.supplies
    return OilPowerCurve(
        branch=power.name,
        time_s=power.times.tolist(),
        phase=[power.phases[number].name for number in power.phase],
        heater_W=power.heater.tolist(),
        cooler_W=power.cooler.tolist(),
        streams_W={name: heat.tolist() for name, heat in power.streams.items()},
        tanks_degC={name: (found.tank - ZERO).tolist() for name, found in circuits.items()},
        supplies_degC={name: (values - ZERO).tolist() for name, values in supplies.items()},
    )


def supplies_held(case: Case, power: OilPower) -> Iterator[SupplyHeld]:
    """When every line of an oil circuit holds its setpoint over the schedule; a branch with a dwell."""
    if power.supply is None:
        return
    last = max(i for i, phase in enumerate(power.phases) if phase.held)
    until = power.phase <= last
    times = power.times[until]
    for name, circuit in case.oil_circuits.items():
        for key, line in circuit.lines.items():
            if line.setpoint is None:
                continue
            values = power.supply.supplies[line.consumers[0]][until]
            outside = np.flatnonzero(np.abs(values - line.setpoint) > line.tolerance)
            held = not len(outside) or outside[-1] < len(values) - 1
            first = 0 if not len(outside) else int(outside[-1]) + 1
            warm = float(np.interp(case.transient.warm_up, times, values))
            yield SupplyHeld(
                place=f"{name}.lines.{key}",
                time=float(times[first]) if held else None,
                reached=(warm if held else float(values[-1])) - ZERO,
                end=float(times[-1]),
            )


def largest_stream(power: OilPower, quantity: str, at: int) -> str:
    """The stream that asks most of heaters or cooler at a time."""
    sign = -1.0 if quantity == "heater_power" else 1.0
    return max(power.streams, key=lambda name: sign * float(power.streams[name][at]))


def worst_powers(solved: SolvedRig, powers: Sequence[OilPower], planned: bool) -> Iterator[Extreme]:
    """Largest power of heaters and of the cooler over some branches [W]."""
    limits = solved.case.limits.oil
    for quantity, steady, limit in (
        ("heater_power", [balance.heater for balance in solved.cooling], limits.heater_power_maximum),
        ("cooler_power", [balance.cooler for balance in solved.cooling], limits.cooler_power_maximum),
    ):
        value, branch, at = max(
            (
                (float(values.max()), power, int(values.argmax()))
                for power in powers
                for values in (power.heater if quantity == "heater_power" else power.cooler,)
            ),
            key=lambda entry: entry[0],
        )
        yield Extreme(
            quantity=quantity,
            value=value,
            place=largest_stream(branch, quantity, at),
            steady=max(steady, default=None),
            limit=limit,
            planned=planned,
            time=float(branch.times[at]),
            branch=branch.name,
            phase=branch.phases[branch.phase[at]].name,
        )

"""Oil circuits in the coupling loop: supply temperatures from the heats that the streams of an iteration bring back.

A stream brings back less heat the warmer it is fed. Where a heater or cooler is at its limit, the circuit would answer
the heat of an iteration as if it did not, and overshoot; so it is given the heat over the supply temperature,

    Q(T) = Q_iteration - G (T - T_iteration) ,

with G at least what walls, films and friction answer in truth. At the end of the loop both temperatures are one.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from rigdesign.base.errors import CaseError
from rigdesign.base.units import celsius
from rigdesign.case.lubrication import place_of
from rigdesign.case.model import Case
from rigdesign.coupling.housing_context import AIR, BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.oil import OilStream
from rigdesign.coupling.state import OperatingPoint
from rigdesign.oil_circuit.line_balance import HeatTaken
from rigdesign.oil_circuit.steady import SetpointNotHeldError, SteadyCircuit, steady_circuit
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed, gear_feed
from rigdesign.rig_heat.component import ComponentHeat, drive_train_heat, heat_by_sink
from thermal.conduction.balance import HeatFlow

FRICTION_SLOPE = 0.04
"""Share by which the friction of a journal bearing falls per kelvin, at most: viscosity of a VG 32 at 40 degC."""

FILMS = (GEAR_OIL, BEARING_OIL, BEARING_FILM, AIR)
"""Kinds of films that end in a fluid."""
SOURCES = ("mesh_loss", "windage", "seal_loss")
"""Kinds of heat that losses put into the solids."""
SMALL_DIFFERENCE = 5.0
"""Difference of fluids below which their heat says nothing of the conductance between them [K]."""


def circuit_balances(rig: Rig, done: IterationResult) -> dict[str, SteadyCircuit]:
    """Every oil circuit in balance with the heats of an iteration, by its name.

    Raises
    ------
    NotConvergedError
        No balance: heat that has no way out.
    """
    if not rig.oil_circuits:
        return {}
    heats: dict[str, HeatTaken] = {
        stream.name: _heat_over_supply(rig, done, stream) for stream in done.streams
    }
    machines = machine_heat(rig, done)
    return {
        name: steady_circuit(
            circuit, {each.name: heats[each.name] for each in circuit.consumers}, machines.get(name, 0.0)
        )
        for name, circuit in rig.oil_circuits.items()
    }


def supplies(balances: Mapping[str, SteadyCircuit]) -> dict[str, float]:
    """Supply temperature of every consumer of some circuits [K]."""
    return {name: oil.supply for found in balances.values() for name, oil in found.consumers.items()}


def into_tank(rig: Rig, stream: OilStream) -> float:
    """Heat a stream brings to its tank above its supply temperature [W].

    Gear oil that leaks to bearings of the same circuit comes back to the same tank.
    """
    return stream.heat if one_tank(rig.case, stream.name.gearbox) else stream.to_tank


def one_tank(case: Case, gearbox: str) -> bool:
    """Whether gear oil and bearing oil of a gearbox come from one oil circuit."""
    gears, bearings = (place_of(case.oil_circuits, f"{gearbox}.{kind}") for kind in (GEAR_OIL, BEARING_OIL))
    return gears is not None and bearings is not None and gears[0] == bearings[0]


def demand_setpoints(rig: Rig, done: IterationResult) -> None:
    """Raise SetpointNotHeldError where a line whose setpoint is hard is not held."""
    for name, found in circuit_balances(rig, done).items():
        for key, line in rig.case.oil_circuits[name].lines.items():
            margin = found.supply_margin(key)
            if line.hard and line.setpoint is not None and margin is not None and margin < 0.0:
                raise SetpointNotHeldError(
                    f"oil_circuits.{name}.lines.{key}: supply temperature at stage {done.point.stage} = "
                    f"{celsius(found.lines[key].supply)}: cannot be held at {celsius(line.setpoint)} within "
                    f"{line.tolerance:.3g} K; " + "; ".join(_remedies(found.warnings))
                )


def _remedies(warnings: Sequence[str]) -> list[str]:
    return [text for text in warnings if "power needed" in text] or ["a larger heater or cooler"]


def _heat_over_supply(rig: Rig, done: IterationResult, stream: OilStream) -> HeatTaken:
    heat, slope, fed = into_tank(rig, stream), _slope(rig, done, stream), stream.inlet
    return lambda supply: heat - slope * (supply - fed)


def _slope(rig: Rig, done: IterationResult, stream: OilStream) -> float:
    """G of a stream [W/K]: heat that its walls give for one kelvin of its oil, and the friction of its bearings."""
    box, kind = stream.name.both
    bearings = kind == BEARING_OIL or rig.case.gearboxes[box].fed_bearings is None
    friction = math.fsum(
        placed.loss.power
        for placed in done.losses
        if bearings and placed.gearbox == box and placed.kind.at_bearings
    )
    return wall_slopes(rig, done, stream)[1] + FRICTION_SLOPE * friction


def wall_slopes(rig: Rig, done: IterationResult, stream: OilStream) -> tuple[float, float]:
    """What the heat of a stream falls by per kelvin of its supply temperature [W/K]: while walls stay, and steady.

    While they stay, films in series with the oil that passes them: 1 / (1/(m c) + 1/sum(h A)).
    """
    box, kind = stream.name.both
    if box not in done.fields or not stream.flow:
        return 0.0, 0.0
    bearings = kind == BEARING_OIL or rig.case.gearboxes[box].fed_bearings is None
    rows = done.fields[box].solution.balance.rows
    kinds = (kind, BEARING_FILM) if bearings else (kind,)
    own = [row for row in rows if row.coefficient and row.kind.partition(":")[0] in kinds]
    films = [row for row in rows if row.coefficient and row.kind.partition(":")[0] in FILMS]
    others = [row for row in films if row not in own]
    sources = math.fsum(row.power for row in rows if row.kind in SOURCES)
    feed = gear_feed if kind == GEAR_OIL else bearing_feed
    fed = feed(rig, box, stream.chamber, done.coupling_state.oil_supply)
    rate, conductance = replace(fed, flow=stream.flow).capacity_rate, _fluid(own)[0]
    prompt = 1.0 / (1.0 / rate + 1.0 / conductance) if conductance else 0.0
    return prompt, _wall_conductance(own, others, sources)


def _wall_conductance(own: Sequence[HeatFlow], others: Sequence[HeatFlow], sources: float) -> float:
    """Conductance from the oil of some films through the metal to what the other films wet [W/K], at most.

    Two bounds: films in series, without metal; and heat of the oil over the difference of the fluids, all heat of
    ``sources`` in the solids counted as if it drove back all it can.
    """
    mine, theirs = (_fluid(films) for films in (own, others))
    if not (mine[0] and theirs[0]):
        return 0.0
    in_series = 1.0 / (1.0 / mine[0] + 1.0 / theirs[0])
    heat = abs(math.fsum(row.power for row in own)) + abs(sources)
    difference = abs(mine[1] - theirs[1])
    return in_series if difference < SMALL_DIFFERENCE else min(in_series, heat / difference)


def _fluid(films: Sequence[HeatFlow]) -> tuple[float, float]:
    """Sum of h A of some films [W/K], and the mean temperature of what wets them [K]."""
    conductances = [row.coefficient.value * row.area if row.coefficient else 0.0 for row in films]
    whole = math.fsum(conductances)
    if not whole:
        return 0.0, 0.0
    carried = math.fsum(c * row.mean_temperature + row.power for c, row in zip(conductances, films))
    return whole, carried / whole


# Heat of machines and couplings at one operating point: the drive delivers the losses of a back-to-back rig.
#
#     power at the rig = losses of all gearboxes + windage of the couplings
#     power from the mains = that + losses of transmission gearbox, motor and converter
#
# Work of the mesh dampers is power of the drive as well; the kinetic energy of jets comes from the oil pumps.


@dataclass(frozen=True, kw_only=True)
class DriveHeat:
    """What drives the rig at one operating point [W]."""

    power: float
    """At the shaft that drives the rig."""
    mains: float
    """Into the machine nearest to the mains; ``power`` without machines."""
    couplings: tuple[ComponentHeat, ...]
    machines: tuple[ComponentHeat, ...]

    @property
    def components(self) -> tuple[ComponentHeat, ...]:
        """Couplings and machines."""
        return *self.couplings, *self.machines


def drive_heat(
    rig: Rig, point: OperatingPoint, losses: Iterable[PlacedLoss], *, nearest: bool = False
) -> DriveHeat:
    """Heat of couplings and machines that drive the rig against its losses.

    nearest : an operating point outside of a loss map has the loss of the nearest one in it, while the loop iterates

    Raises
    ------
    CaseError
        An operating point outside of the loss map of a machine.
    """
    parts, air = rig.heat_parts, rig.case.ambient.temperature
    rotors = tuple(rotor.heat(abs(rig.shaft_speed(shaft, point.speed)), air) for rotor, shaft in parts.rotors)
    lost = [*(placed.loss.power for placed in losses), *(rotor.power for rotor in rotors)]
    power = max(math.fsum(lost), 0.0)
    speed = rig.driven_speed(point.speed)
    if not speed:
        return DriveHeat(power=0.0, mains=0.0, couplings=rotors, machines=())
    try:
        train = drive_train_heat(speed, power, parts.machines, nearest=nearest)
    except CaseError as error:
        faults = [replace(fault, path=f"rig_heat.machines.{fault.path}") for fault in error.faults]
        raise CaseError(faults, f"{rig.case.path}, stage {point.stage}") from error
    return DriveHeat(power=power, mains=train.input_power, couplings=rotors, machines=train.components)


def machine_heat(rig: Rig, done: IterationResult) -> dict[str, float]:
    """Heat of machines into their coolants [W], by coolant, at an iteration that may still be far off."""
    machines = drive_heat(rig, done.point, done.losses, nearest=True).machines
    return {sink: heat for sink, heat in heat_by_sink(machines).items() if sink in rig.oil_circuits}


def demand_loss_maps(rig: Rig, done: IterationResult) -> None:
    """Raise CaseError where the operating point of a machine is outside of its loss map."""
    drive_heat(rig, done.point, done.losses)

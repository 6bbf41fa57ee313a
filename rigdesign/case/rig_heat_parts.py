"""Machines, couplings and room of `rigdesign.rig_heat` from the tables of the case."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.rig_heat import CouplingRotorInput, MachineInput, RoomInput
from rigdesign.rig_heat.component import (
    CouplingRotor,
    EfficiencyLoss,
    HeatSplit,
    LossMap,
    Machine,
    MachineLoss,
    Room,
)

if TYPE_CHECKING:
    from rigdesign.case.model import Case


@dataclass(frozen=True, kw_only=True)
class HeatParts:
    """What stands in the room besides gearboxes and oil circuits.

    machines : from the rig to the mains; rotors : coupling with the shaft whose speed it has
    """

    machines: tuple[Machine, ...] = ()
    rotors: tuple[tuple[CouplingRotor, str], ...] = ()
    room: Room | None = None


def heat_parts(case: "Case") -> HeatParts:
    """Machines, couplings and room of a case. Raises CaseError with all faults of them."""
    given = case.rig_heat
    faults: list[Fault] = []
    machines, rotors, room = [], [], None
    for name in given.chain:
        with _below(f"rig_heat.machines.{name}", faults):
            machines.append(_machine(name, given.machines[name]))
    for name, coupling in given.couplings.items():
        with _below(f"rig_heat.couplings.{name}", faults):
            rotors.append((_rotor(name, coupling), shaft_of(case, name, coupling)))
    if given.room is not None:
        with _below("rig_heat", faults):
            room = _room(given.room, case.ambient.temperature)
    if faults:
        raise CaseError(faults)
    return HeatParts(machines=tuple(machines), rotors=tuple(rotors), room=room)


def shaft_of(case: "Case", name: str, coupling: CouplingRotorInput) -> str:
    """Shaft with which a coupling turns. Raises CaseError where neither the table nor the drivetrain names one."""
    if coupling.shaft is not None:
        return coupling.shaft
    couplings: Mapping[str, object] = {} if case.drivetrain is None else case.drivetrain.couplings
    if case.drivetrain is None or name not in couplings:
        known = ", ".join(couplings) or "none"
        problem = f"is missing, and drivetrain.couplings has no {name} (known: {known})"
        raise CaseError([Fault("shaft", "", problem, "write the shaft with which it turns")])
    return case.drivetrain.couplings[name].shafts[0]


def _machine(name: str, given: MachineInput) -> Machine:
    return Machine(
        name=name,
        loss=_loss(given),
        speed_ratio=given.speed_ratio or 1.0,
        split=HeatSplit()
        if given.coolant is None
        else HeatSplit(coolant=given.coolant, coolant_share=given.coolant_share or 0.0),
    )


def _loss(given: MachineInput) -> MachineLoss:
    if given.loss_map is None:
        return EfficiencyLoss(efficiency=given.efficiency or 0.0)
    points = given.loss_map
    return LossMap.from_columns(
        [point.speed for point in points],
        [point.torque for point in points],
        [point.loss for point in points],
    )


def _rotor(name: str, given: CouplingRotorInput) -> CouplingRotor:
    return CouplingRotor(
        name=name,
        radius=0.5 * given.diameter,
        length=given.length,
        hub_radius=0.5 * (given.hub_diameter or 0.0),
    )


def _room(given: RoomInput, ambient: float) -> Room:
    supply = ambient if given.supply_temperature is None else given.supply_temperature
    return Room(
        air_flow=given.air_flow,
        supply_temperature=supply,
        wall_conductance=given.wall_conductance or 0.0,
        outside_temperature=supply if given.outside_temperature is None else given.outside_temperature,
        temperature_limit=given.temperature_maximum,
    )


@contextmanager
def _below(place: str, faults: list[Fault]) -> Iterator[None]:
    """Faults of a part, gathered with the place of its table in the case."""
    try:
        yield
    except CaseError as error:
        faults += [replace(fault, path=f"{place}.{fault.path}") for fault in error.faults]

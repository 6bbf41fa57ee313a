"""Rules of the heat of the rig: machines in one chain, coolants and shafts that exist, maps and room that can be."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show
from rigdesign.case.faults import unknown, written
from rigdesign.case.rig_heat import OIL_COOLER, WATER
from rigdesign.case.rig_heat_parts import heat_parts

if TYPE_CHECKING:
    from rigdesign.case.model import Case


def rig_heat_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with machines, couplings and room; they are built once their references are sound."""
    if not case.rig_heat.stated:
        return
    faults = [*_chain(case), *_coolants(case), *_shafts(case), *_room(case)]
    yield from faults
    if not faults:
        try:
            heat_parts(case)
        except CaseError as error:
            yield from error.faults


def _chain(case: "Case") -> Iterator[Fault]:
    """Machines that follow each other from the rig to the mains."""
    machines, driven = case.rig_heat.machines, dict[str | None, str]()
    faults = 0
    for name, machine in machines.items():
        at = f"rig_heat.machines.{name}.drives"
        target = machine.drives
        if target is not None and target not in machines:
            faults += 1
            yield unknown(at, target, machines, "machine")
        elif target in driven:
            faults += 1
            what = "the rig" if target is None else target
            yield Fault(
                at, "" if target is None else written(target), f"{what} is driven by {driven[target]} already",
                "name with drives the machine that this one drives: converter -> motor -> transmission -> rig",
            )  # fmt: skip
        driven.setdefault(target, name)
    lost = [name for name in machines if name not in case.rig_heat.chain]
    if lost and not faults:
        at = f"rig_heat.machines.{lost[0]}.drives"
        yield Fault(
            at, written(machines[lost[0]].drives), f"{', '.join(lost)} drive each other and not the rig",
            "leave out drives of the machine that drives the rig",
        )  # fmt: skip


def _coolants(case: "Case") -> Iterator[Fault]:
    known = [*case.oil_circuits, WATER, OIL_COOLER]
    for name, machine in case.rig_heat.machines.items():
        if machine.coolant is not None and machine.coolant not in known:
            yield unknown(
                f"rig_heat.machines.{name}.coolant", machine.coolant, known, "coolant or oil circuit"
            )


def _shafts(case: "Case") -> Iterator[Fault]:
    shafts = {gear.shaft for box in case.gearboxes.values() for gear in box.gears.values()}
    if case.drivetrain is not None:
        shafts = {*case.drivetrain.shafts}
    for name, coupling in case.rig_heat.couplings.items():
        if coupling.shaft is not None and coupling.shaft not in shafts:
            yield unknown(
                f"rig_heat.couplings.{name}.shaft", coupling.shaft, sorted(shafts), "shaft of the rig"
            )


def _room(case: "Case") -> Iterator[Fault]:
    """A limit that the room can hold with any ventilation."""
    room = case.rig_heat.room
    if room is None or room.temperature_maximum is None:
        return
    supply = case.ambient.temperature if room.supply_temperature is None else room.supply_temperature
    if room.air_flow and room.temperature_maximum <= supply:
        yield Fault(
            "rig_heat.room.temperature_maximum", show(room.temperature_maximum, "temperature"),
            f"is not above the supplied air, {show(supply, 'temperature')}: no ventilation holds it, however strong",
            "raise it, or supply colder air",
        )  # fmt: skip

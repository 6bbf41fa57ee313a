"""Rules of the heat of the rig: machines in one chain, coolants and shafts that exist, maps and room that can be."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show
from rigdesign.case.circuit_parts import heat_parts
from rigdesign.case.faults import unknown, written
from rigdesign.case.films import RotatingCylinder, RotatingDisc
from rigdesign.case.losses import LOSS_KINDS
from rigdesign.case.rig_heat import OIL_COOLER, WATER

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
        shafts = {*case.power_circuit.shafts}
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


# Rules of the losses: what a basis needs, and places that exist.


def loss_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with how the losses are to be found."""
    losses = case.losses
    stages = [stage.name for stage in case.schedule.stages]
    if losses.basis == "computed" and case.drivetrain is None:
        yield Fault(
            "losses.basis", '"computed"', "losses can only be computed with a drivetrain",
            'add a [drivetrain] table, or write basis = "input" and give the losses',
        )  # fmt: skip
    if losses.basis == "computed" and losses.chamber_density is None:
        yield Fault(
            "losses.chamber_density", "", "windage needs the density round the gears",
            'add it, e.g. { value = "5 kg/m3", assumed = "oil mist", range = ["1.2 kg/m3", "20 kg/m3"] }',
        )  # fmt: skip
    if losses.basis == "input" and not losses.given:
        yield Fault(
            "losses.given", "", "no loss is given", "add a table per place, e.g. [losses.given.test_mesh]"
        )
    if losses.friction.law == "constant" and losses.friction.coefficient is None:
        yield Fault(
            "losses.friction.coefficient",
            "",
            "a constant friction needs its coefficient",
            "add it, e.g. 0.04",
        )
    if losses.friction.law == "doleschel" and losses.friction.doleschel is None:
        yield Fault(
            "losses.friction.doleschel", "", "Doleschel's law needs the constants of the oil",
            "add [losses.friction.doleschel], or take the law schlenk or michaelis",
        )  # fmt: skip
    yield from _media(case)
    for name, loss in losses.given.items():
        at = f"losses.given.{name}"
        if loss.gearbox not in case.gearboxes:
            yield unknown(f"{at}.gearbox", loss.gearbox, list(case.gearboxes), "gearbox")
            continue
        kind = LOSS_KINDS[loss.kind]
        parts = kind.parts_of(case.gearboxes[loss.gearbox])
        if loss.part not in parts:
            yield unknown(
                f"{at}.part", loss.part, parts, f"part with {loss.kind} loss in gearbox {loss.gearbox}"
            )
        if losses.bearing_drag == "constant" and case.drivetrain is not None and not kind.of_teeth:
            yield Fault(
                f"{at}.kind", f'"{loss.kind}"', "would heat without braking: losses.bearing_drag is constant, so that "
                "the torsional damping of the bearings is all that brakes besides the teeth",
                'write bearing_drag = "film" or remove the given loss',
            )  # fmt: skip
        for stage in loss.stages:
            if stage not in stages:
                yield unknown(f"{at}.stages", stage, stages, "stage")
    if losses.bearing_drag == "constant":
        for box_name, box in case.gearboxes.items():
            for name, bearing in box.bearings.items():
                if bearing.torsional_damping is None:
                    yield Fault(
                        f"gearboxes.{box_name}.bearings.{name}.torsional_damping", "",
                        "a constant bearing drag needs it", 'add it, e.g. "0.0007 N m s/rad"',
                    )  # fmt: skip


def _media(case: "Case") -> Iterator[Fault]:
    """Films in the mist of the chamber need its density, those in a bath a sump; both the oil of the gears."""
    for box_name, box in case.gearboxes.items():
        films = {} if box.housing is None else box.housing.boundary
        for name, film in films.items():
            if not isinstance(film, RotatingCylinder | RotatingDisc) or film.medium == "air":
                continue
            entry = f"gearboxes.{box_name}.housing.boundary.{name}"
            at, written = f"{entry}.medium", f'"{film.medium}"'
            if film.medium == "mist" and case.losses.chamber_density is None:
                yield Fault(
                    at, written, "losses.chamber_density is not given", 'add it or write medium = "air"'
                )
            if film.medium == "bath" and box.sump is None:
                yield Fault(
                    at, written, "the gearbox has no sump", 'write oil.lubrication = "dip" or medium = "air"'
                )
            if not film.fluid.startswith("gear_oil"):
                yield Fault(
                    at, written, f"the {film.medium} is that of the chamber of the gears, the fluid is not its oil",
                    'write fluid = "gear_oil_mean" or medium = "air"',
                )  # fmt: skip
            if film.correlation == "jungnickel" or (
                film.medium == "bath" and "correlation" in film.model_fields_set
            ):
                yield Fault(
                    f"{entry}.correlation", f'"{film.correlation}"', f"is not used: medium = {written}",
                    'leave it out or write medium = "air"',
                )  # fmt: skip

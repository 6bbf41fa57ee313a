"""Circuits of `rigdesign.oil_circuit` from the tables of the case."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.part_name import OilStreamName
from rigdesign.case.gearbox import mesh_jet
from rigdesign.case.lubrication import (
    CoolerInput,
    HeaterInput,
    LineInput,
    OilCircuit,
    PipeInput,
    PumpInput,
    TankCoolerInput,
    TankInput,
)
from rigdesign.case.rig_heat import MachineInput, RoomInput
from rigdesign.oil_circuit.circuit import (
    NO_PIPE,
    Arrangement,
    Circuit,
    Consumer,
    Coolant,
    Cooler,
    Heater,
    Pipe,
    Pump,
    RatedPoint,
    SupplyLine,
    Tank,
    TankCooler,
)
from rigdesign.properties.oil import Oil
from rigdesign.rig_heat.component import (
    CouplingHeat,
    EfficiencyLoss,
    HeatSplit,
    LossMap,
    Machine,
    MachineLoss,
    Room,
)

if TYPE_CHECKING:
    from rigdesign.case.model import Case

ARRANGEMENTS: Mapping[str, Arrangement] = {
    "counterflow": "counterflow",
    "parallel": "parallel",
    "crossflow": "crossflow approximate",
    "shell_and_tube": "S&T",
}


def oil_circuits(case: "Case", oils: Mapping[str, Oil]) -> dict[str, Circuit]:
    """Every oil circuit of a case by its name.

    oils : by the name the case uses

    Raises CaseError with all faults of the circuits.
    """
    found: dict[str, Circuit] = {}
    faults: list[Fault] = []
    for name, given in case.oil_circuits.items():
        try:
            found[name] = oil_circuit(case, name, _oil(case, given, oils))
        except CaseError as error:
            faults += error.faults
    if faults:
        raise CaseError(faults, str(case.path))
    return found


def oil_circuit(case: "Case", name: str, oil: Oil) -> Circuit:
    """One oil circuit of a case; raises CaseError with paths of the case."""
    given, at = case.oil_circuits[name], f"oil_circuits.{name}"
    with _below(at):
        tank = _tank(given.tank)
        pump = _pump(given.pump) if given.pump else None
        heater = _heater(given.heater) if given.heater else None
    tank_cooler = None
    if given.tank_cooler:
        with _below(f"{at}.tank_cooler", "cooler.", "tank_cooler."):
            tank_cooler = _tank_cooler(given.tank_cooler, oil)
    lines = tuple(_line(case, f"{at}.lines.{key}", key, line, oil) for key, line in given.lines.items())
    with _below(at):
        return Circuit(
            name=name,
            oil=oil,
            tank=tank,
            lines=lines,
            pump=pump,
            heater=heater,
            tank_cooler=tank_cooler,
            room_temperature=case.ambient.temperature,
        )


def fed_flow(case: "Case", stream: str) -> float:
    """Flow of an oil stream that is fed, of all its meshes or bearings [m3/s]."""
    name = OilStreamName.read(stream)
    feed, count = case.gearboxes[name.gearbox].feeds[name.part]
    return feed.flow * count


def _jet_power(case: "Case", stream: str, oil: Oil) -> float:
    """Kinetic energy of the jets of an oil stream [W] as far as the losses of the case count it; zero without jets."""
    name = OilStreamName.read(stream)
    box = case.gearboxes[name.gearbox]
    if name.part != "gear_oil" or box.jets is None:
        return 0.0
    meshes = set(box.meshes)
    if case.losses.basis == "input":
        jets = [loss for loss in case.losses.given.values() if loss.kind == "oil_acceleration"]
        meshes &= {loss.part for loss in jets if loss.gearbox == name.gearbox}
    return len(meshes) * mesh_jet(box, box.jets, oil).power


def _oil(case: "Case", given: OilCircuit, oils: Mapping[str, Oil]) -> Oil:
    """The oil of a circuit in the state all its gearboxes state; where they differ, that of its data sheet."""
    states = {
        case.gearboxes[OilStreamName.read(stream).gearbox].oil_state
        for line in given.lines.values()
        for stream in line.consumers
    }
    state = states.pop()
    oil = oils[given.oil]
    if states:
        return oil
    return oil.in_state(
        air_content=state.air_content,
        viscosity_factor=state.viscosity_factor,
        heat_capacity_factor=state.heat_capacity_factor,
    )


def _tank(given: TankInput) -> Tank:
    return Tank(
        volume=given.volume,
        fill=given.fill,
        suction_minimum=given.suction_minimum or 0.0,
        wall_conductance=given.wall_conductance,
        body_heat_capacity=given.heat_capacity,
    )


def _pump(given: PumpInput) -> Pump:
    return Pump(
        flow=given.flow, pressure=given.pressure, efficiency=given.efficiency, heat_share=given.heat_share
    )


def _heater(given: HeaterInput) -> Heater:
    return Heater(power_limit=given.power_limit, setpoint=given.setpoint, band=given.band or 0.0)


def _cooler(given: CoolerInput, oil: Oil) -> Cooler:
    stated = given.coolant
    coolant = Coolant(
        flow=stated.flow,
        inlet_temperature=stated.inlet_temperature,
        fluid=stated.fluid,
        pressure=stated.pressure,
    )
    coolant.capacity_rate  # noqa: B018  asks CoolProp now, so that a fluid it does not know is a fault of the case
    arrangement = ARRANGEMENTS[given.arrangement]
    if given.rated is None:
        return Cooler(conductance=given.conductance or 0.0, coolant=coolant, arrangement=arrangement)
    point = RatedPoint(
        oil=oil,
        heat=given.rated.heat,
        flow=given.rated.flow,
        inlet_temperature=given.rated.inlet_temperature,
    )
    return Cooler.from_rated_point(point, coolant, arrangement)


def _tank_cooler(given: TankCoolerInput, oil: Oil) -> TankCooler:
    return TankCooler(
        cooler=_cooler(given, oil), setpoint=given.setpoint, band=given.band or 0.0, flow=given.flow
    )


def _pipe(given: PipeInput | None) -> Pipe:
    return (
        NO_PIPE
        if given is None
        else Pipe(volume=given.volume, wall_conductance=given.wall_conductance)
    )  # fmt: skip


def _line(case: "Case", at: str, name: str, given: LineInput, oil: Oil) -> SupplyLine:
    cooler = None
    if given.cooler:
        with _below(f"{at}.cooler", "cooler."):
            cooler = _cooler(given.cooler, oil)
    each = (given.holdup or 0.0) / len(given.consumers)
    with _below(at, f"lines.{name}."):
        return SupplyLine(
            name=name,
            consumers=tuple(
                Consumer(
                    name=stream,
                    flow=fed_flow(case, stream),
                    holdup=each,
                    jet_power=_jet_power(case, stream, oil),
                )
                for stream in given.consumers
            ),
            setpoint=given.setpoint,
            tolerance=given.tolerance,
            # a limit that binds while the loop still iterates is no error: `coupling.oil_circuits` asks at its end
            hard=False,
            cooler=cooler,
            valve_band=given.valve_band or 0.0,
            trim_power_limit=given.trim_heater,
            supply_pipe=_pipe(given.supply_pipe),
            return_pipe=_pipe(given.return_pipe),
        )


@contextmanager
def _below(place: str, *prefixes: str) -> Iterator[None]:
    """Faults of a part with the place of its table in the case; ``prefixes`` of their keys are left out."""
    try:
        yield
    except CaseError as error:
        raise CaseError([_placed(fault, place, prefixes) for fault in error.faults]) from error


def _placed(fault: Fault, place: str, prefixes: tuple[str, ...]) -> Fault:
    key = fault.path
    for prefix in prefixes:
        key = key.removeprefix(prefix)
    return replace(fault, path=f"{place}.{key}")


# Machines, couplings and room of `rigdesign.rig_heat` from the tables of the case.


@dataclass(frozen=True, kw_only=True)
class HeatParts:
    """What stands in the room besides gearboxes and oil circuits.

    machines : from the rig to the mains; rotors : coupling with the shaft whose speed it has
    """

    machines: tuple[Machine, ...] = ()
    rotors: tuple[tuple[CouplingHeat, str], ...] = ()
    room: Room | None = None


def heat_parts(case: "Case") -> HeatParts:
    """Machines, couplings and room of a case. Raises CaseError with all faults of them."""
    given = case.rig_heat
    faults: list[Fault] = []
    machines, rotors, room = [], [], None
    for name in given.chain:
        with _below_key(f"rig_heat.machines.{name}", faults):
            machines.append(_machine(name, given.machines[name]))
    for name, coupling in given.couplings.items():
        with _below_key(f"rig_heat.couplings.{name}", faults):
            rotors.append((coupling.rotor(name), shaft_of(case, name, coupling.shaft)))
    if given.room is not None:
        with _below_key("rig_heat", faults):
            room = _room(given.room, case.ambient.temperature)
    if faults:
        raise CaseError(faults)
    return HeatParts(machines=tuple(machines), rotors=tuple(rotors), room=room)


def shaft_of(case: "Case", name: str, stated: str | None) -> str:
    """Shaft with which a coupling turns. Raises CaseError where neither the table nor the drivetrain names one."""
    if stated is not None:
        return stated
    couplings = case.power_circuit.couplings
    if name not in couplings:
        known = ", ".join(couplings) or "none"
        problem = f"is missing, and drivetrain.couplings has no {name} (known: {known})"
        raise CaseError([Fault("shaft", "", problem, "write the shaft with which it turns")])
    return couplings[name].shafts[0]


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
def _below_key(place: str, faults: list[Fault]) -> Iterator[None]:
    """Faults of a part, gathered with the place of its table in the case."""
    try:
        yield
    except CaseError as error:
        faults += [replace(fault, path=f"{place}.{fault.path}") for fault in error.faults]

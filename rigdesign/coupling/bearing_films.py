"""Bearings at one operating point: what they carry and what heats their oil."""

import math
from collections.abc import Callable

from dynamics.bearing.protocol import Bearing, BearingOperation, BearingState, OilSupply
from rigdesign.base.errors import named
from rigdesign.case.bearings import BearingInput
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import GearMesh
from rigdesign.coupling.given_losses import given_power
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed

GRAVITY = 9.81


def solve_bearing(bearing: Bearing, operation: BearingOperation) -> BearingState:
    """State of one bearing, whatever its kind."""
    return bearing.operating_state(operation)


def solve_bearings(
    rig: Rig,
    point: OperatingPoint,
    coupling_state: CouplingState,
    solve: Callable[[Bearing, BearingOperation], BearingState] = solve_bearing,
) -> dict[str, BearingState]:
    """State of every bearing by ``gearbox.bearing``.

    solve : of one bearing; one with memoisation may take its place

    A loss that the case prescribes heats the oil in place of the friction the bearing would make.

    Raises
    ------
    BearingError
        A hot clearance that is used up.
    BearingNotConvergedError
        No oil temperature balances friction and oil flow.
    """
    states = {}
    loads = bearing_loads(rig, coupling_state)
    for name, box, entry in rig.bearings():
        box_name, part = name.split(".")
        chamber = coupling_state.oil_outlet[f"{box_name}.gear_oil"]
        feed = bearing_feed(rig, box_name, chamber, coupling_state.oil_supply)
        with named(f"gearboxes.{box_name}.bearings.{part}"):
            bearing = entry.at_clearance(coupling_state.bearing_clearance[name])
            operation = BearingOperation(
                load=loads[name],
                speed=rig.shaft_speed(entry.shaft, point.speed),
                oil=OilSupply(
                    inlet_temperature=feed.inlet,
                    flow=feed.flow,
                    viscosity=feed.oil.dynamic_viscosity,
                    density=feed.oil.density(feed.inlet),
                    heat_capacity=feed.oil.heat_capacity(feed.inlet),
                ),
                heat_from_bodies=coupling_state.bearing_heat[name],
                friction_heat=_imposed_heat(rig, name, entry, point),
                friction_factor=box.loss_factors.bearing,
            )
            states[name] = solve(bearing, operation)
    return states


def _imposed_heat(rig: Rig, name: str, entry: BearingInput, point: OperatingPoint) -> float | None:
    """Friction heat that the case prescribes for a film [W]; None where the film makes its own."""
    box, part = name.split(".")
    given = given_power(rig.case, point, box, "bearing", part)
    if given is not None:
        return given
    return 0.0 if rig.case.losses.basis == "input" else constant_drag(rig, box, entry, point)


def constant_drag(rig: Rig, box: str, entry: BearingInput, point: OperatingPoint) -> float | None:
    """Power of a bearing whose drag the case states as constant damping [W]; None where the film decides."""
    if rig.case.losses.bearing_drag == "film" or entry.torsional_damping is None:
        return None
    factor = rig.case.gearboxes[box].loss_factors.bearing
    return factor * entry.torsional_damping * rig.shaft_speed(entry.shaft, point.speed) ** 2


def bearing_loads(rig: Rig, coupling_state: CouplingState) -> dict[str, float]:
    """Radial load of every bearing [N]: tooth forces and weight by the lever rule on its shaft.

    Tooth forces add as vectors where the housing says where the axes stand: at an idler between two wheels the
    tangential forces add and the separating ones cancel. Without a housing they add as if all pointed one way.
    Weight is counted with the tangential force, which is on the safe side. Axial forces of a double-helical gear
    cancel; those of a single-helical one and their tilting moment are left out.
    """
    return {
        name: _radial_load(rig, name, box, entry, coupling_state)
        if entry.radial_load is None
        else entry.radial_load
        for name, box, entry in rig.bearings()
    }


def _radial_load(
    rig: Rig, name: str, box: Gearbox, entry: BearingInput, coupling_state: CouplingState
) -> float:
    box_name = name.split(".")[0]
    tangential, separating, weight = 0.0, 0.0, 0.5 * GRAVITY * rig.shaft_mass(entry.shaft)
    first = box.first_meshes()
    for gear_name, gear in box.gears.items():
        if gear.shaft != entry.shaft:
            continue
        share = _lever(box, entry.shaft, entry.position, gear.position)
        mesh_name, side = first[gear_name]
        weight += share * GRAVITY * box.halves(gear_name) * rig.pairs[f"{box_name}.{mesh_name}"].masses[side]
        for mesh_name, mesh in box.meshes.items():
            if gear_name in (mesh.pinion, mesh.wheel):
                full = f"{box_name}.{mesh_name}"
                towards, drives = _direction(box, mesh, gear_name, coupling_state.mesh_torque[full])
                pair = rig.pairs[full]
                force = share * abs(coupling_state.mesh_torque[full]) / pair.base_radii[0]
                tangential += towards * drives * force * math.cos(pair.working_pressure_angle)
                separating += towards * force * math.sin(pair.working_pressure_angle)
    return math.hypot(abs(tangential) + weight, separating)


def _direction(box: Gearbox, mesh: GearMesh, gear: str, torque: float) -> tuple[float, float]:
    """Side on which the partner stands, +1 towards y, and +1 if the gear drives it; 1, 1 without a housing."""
    if box.housing is None:
        return 1.0, 1.0
    here, there = (mesh.pinion, mesh.wheel) if gear == mesh.pinion else (mesh.wheel, mesh.pinion)
    y = [box.housing.shafts[box.gears[name].shaft].lateral_position for name in (here, there)]
    return math.copysign(1.0, y[1] - y[0]), math.copysign(1.0, torque if here == mesh.pinion else -torque)


def _lever(box: Gearbox, shaft: str, position: float | None, gear_position: float | None) -> float:
    """Share of a gear force that one of the two bearings of a shaft carries."""
    stations = [bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft]
    if position is None or gear_position is None or None in stations or len(stations) != 2:
        return 1.0 / len(stations)
    first, second = (station for station in stations if station is not None)
    other = second if position == first else first
    return abs(other - gear_position) / abs(other - position)

"""Where the coupling loop starts: all of the rig at room temperature, its oil as it is fed."""

from collections.abc import Callable
from dataclasses import replace

from dynamics.bearing.protocol import BearingState
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.bearing_seats import initial_seats
from rigdesign.coupling.braced_loop import first_torques
from rigdesign.coupling.expansion import uniform_expansion
from rigdesign.coupling.misalignment import warm_misalignment
from rigdesign.coupling.shaft_positions import axis_tilt, flank_approach, mesh_placements
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import meant_supplies

FIRST_SUMP_RISE = 40.0
"""First guess of a sump that finds its own temperature, above room temperature [K]; the loop leaves it behind."""


def initial_state(
    rig: Rig, point: OperatingPoint, bearings: Callable[..., dict[str, BearingState]] = solve_bearings
) -> CouplingState:
    """All of the rig at room temperature, no heat from bodies, oil as fed; mesh torques without losses.

    Elastic shafts already stand in their turning bearings; bearings : solves these, as `solve_bearings`
    """
    case = rig.case
    names = (f"{box}.{gear}" for box, entry in case.gearboxes.items() for gear in entry.gears)
    streams = {}
    for name, box in case.gearboxes.items():
        gears = box.gear_oil_temperature or case.ambient.temperature + FIRST_SUMP_RISE
        fed = box.fed_bearings
        streams[f"{name}.gear_oil"] = gears
        streams[f"{name}.bearing_oil"] = gears if fed is None else fed.inlet_temperature
    state = CouplingState(
        gear_temperature=dict.fromkeys(names, case.ambient.temperature),
        centre_distance={
            mesh: distance
            for box in case.gearboxes
            for mesh, distance in uniform_expansion(rig, box, case.ambient.temperature).items()
        },
        bearing_clearance={name: entry.drawn_clearance for name, _, entry in rig.bearings()},
        bearing_heat={name: 0.0 for name, _, _ in rig.bearings()},
        wall_heat=dict.fromkeys(streams, 0.0),
        oil_outlet=streams,
        oil_supply=meant_supplies(rig),
        mesh_torque=first_torques(rig, point),
        axial_expansion=dict.fromkeys(rig.pairs, 0.0),
        seat_temperature=initial_seats(rig, case.ambient.temperature),
    )
    if rig.shaft_model == "torsional":
        return state
    as_set = warm_misalignment(rig, {})
    state = replace(state, coupling_offset=as_set.offset, coupling_angle=as_set.angle)
    placements = mesh_placements(rig, point, state, bearings(rig, point, state))
    return replace(
        state,
        centre_distance={
            name: distance + placements[name].apart for name, distance in state.centre_distance.items()
        },
        flank_approach=flank_approach(placements),
        axis_tilt=axis_tilt(placements),
    )

"""Bearings at one operating point: what they carry and what heats their oil."""

from collections.abc import Callable
from dataclasses import replace

from dynamics.rotor.bearing import Bearing, BearingOperation, BearingState, OilSupply
from rigdesign.base.errors import named
from rigdesign.case.bearings import BearingInput
from rigdesign.case.gearbox import injected_flow
from rigdesign.case.rolling_bearing import BearingPlace
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.bearing_seats import HOUSING, SHAFT, bearing_seats, seats_of
from rigdesign.coupling.flank_heat import splash_to_bearing
from rigdesign.coupling.located_loss import given_power
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import OilFeed, bearing_feed


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
        feed = _supply(rig, box_name, point, coupling_state)
        seats = seats_of(name, coupling_state)
        if seats == (None, None) and feed.flow == 0.0:
            seats = None, feed.inlet  # stands in oil that nothing moves: all round it is as warm as that
        with named(f"gearboxes.{box_name}.bearings.{part}"):
            bearing = entry.as_it_runs(_place(rig, name, coupling_state.bearing_clearance[name]))
            operation = BearingOperation(
                load=loads[name].radial,
                axial_load=loads[name].axial,
                speed=rig.shaft_speed(entry.shaft, point.speed),
                oil=OilSupply(
                    inlet_temperature=feed.inlet,
                    flow=feed.flow,
                    viscosity=feed.oil.dynamic_viscosity,
                    density=feed.oil.density(feed.inlet),
                    heat_capacity=feed.oil.heat_capacity(feed.inlet),
                ),
                heat_from_bodies=coupling_state.bearing_heat[name] if entry.has_film else 0.0,
                friction_heat=_imposed_heat(rig, name, entry, point),
                friction_factor=box.loss_factors.bearing * entry.friction_factor,
                shaft_temperature=seats[0],
                housing_temperature=seats[1],
            )
            states[name] = solve(bearing, operation)
    return states


def _place(rig: Rig, name: str, clearance: float) -> BearingPlace:
    """What the gearbox makes of the place of a bearing."""
    box = rig.case.gearboxes[name.split(".")[0]]
    factors = {seat: found.factor for seat, found in bearing_seats(rig, name).items()}
    return BearingPlace(
        clearance=clearance,
        lubrication=box.bearing_oil.lubrication,
        sump_level=None if box.sump is None else box.sump.level,
        seat_factors=(factors.get(SHAFT, 1.0), factors.get(HOUSING, 1.0)),
    )


def _supply(rig: Rig, box_name: str, point: OperatingPoint, coupling_state: CouplingState) -> OilFeed:
    """Oil that passes each bearing of a gearbox: fed, a share of what the gears lift or the jets inject, or none."""
    box, chamber = rig.case.gearboxes[box_name], coupling_state.oil_outlet[f"{box_name}.gear_oil"]
    feed = bearing_feed(rig, box_name, chamber, coupling_state.oil_supply)
    share = box.splash_share
    if share == 0.0:
        return feed
    if box.sump is not None:
        return replace(feed, flow=splash_to_bearing(rig, box_name, point, chamber, share))
    return replace(feed, flow=share * injected_flow(box) * len(box.meshes))


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
    factor = rig.case.gearboxes[box].loss_factors.bearing * entry.friction_factor
    return factor * entry.torsional_damping * rig.shaft_speed(entry.shaft, point.speed) ** 2

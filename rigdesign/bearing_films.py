"""Films of the journal bearings at one operating point: what they carry and what heats them."""

import math

from dynamics.journal_bearing import BearingState, JournalBearing, solve_bearing
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gearbox import JournalBearing as CaseBearing
from rigdesign.errors import named
from rigdesign.given_losses import given_power
from rigdesign.rig.model import Rig
from rigdesign.state import Feedback, OperatingPoint

GRAVITY = 9.81


def solve_bearings(rig: Rig, point: OperatingPoint, feedback: Feedback) -> dict[str, BearingState]:
    """Film of every journal bearing by ``gearbox.bearing``.

    A loss that the case prescribes heats its film in place of the friction the film would make.

    Raises
    ------
    BearingError
        A hot clearance that is used up.
    BearingNotConvergedError
        No film temperature balances friction and oil flow.
    """
    states = {}
    loads = bearing_loads(rig, feedback)
    for name, box, entry in rig.bearings():
        oil = rig.oils[box.bearing_oil.oil]
        inlet = box.bearing_oil.inlet_temperature
        box_name, part = name.split(".")
        with named(f"gearboxes.{box_name}.bearings.{part}"):
            states[name] = solve_bearing(
                JournalBearing(
                    diameter=entry.diameter,
                    width=entry.width,
                    diametral_clearance=feedback.bearing_clearance[name],
                    feed_share=entry.feed_share,
                ),
                loads[name],
                rig.shaft_speed(entry.shaft, point.speed),
                inlet,
                box.bearing_oil.flow,
                oil.dynamic_viscosity,
                oil.density(inlet),
                oil.heat_capacity(inlet),
                feedback.bearing_heat[name],
                friction_heat=_imposed_heat(rig, name, entry, point),
            )
    return states


def _imposed_heat(rig: Rig, name: str, entry: CaseBearing, point: OperatingPoint) -> float | None:
    """Friction heat that the case prescribes for a film [W]; None where the film makes its own."""
    box, part = name.split(".")
    given = given_power(rig.case, point, box, "bearing", part)
    if given is not None:
        return given
    return 0.0 if rig.case.losses.basis == "input" else constant_drag(rig, entry, point)


def constant_drag(rig: Rig, entry: CaseBearing, point: OperatingPoint) -> float | None:
    """Power of a bearing whose drag the case states as constant damping [W]; None where the film decides."""
    if rig.case.losses.bearing_drag == "film" or entry.torsional_damping is None:
        return None
    return entry.torsional_damping * rig.shaft_speed(entry.shaft, point.speed) ** 2


def bearing_loads(rig: Rig, feedback: Feedback) -> dict[str, float]:
    """Radial load of every bearing [N]: tooth force and weight by the lever rule on its shaft.

    Tangential forces of the meshes of a shaft add, as at an idler; weight is counted with the tangential
    force, which is on the safe side for the loaded bearings. Axial forces of a double-helical gear cancel.
    """
    loads = {}
    for name, box, entry in rig.bearings():
        if entry.radial_load is not None:
            loads[name] = entry.radial_load
            continue
        box_name = name.split(".")[0]
        tangential, radial, weight = 0.0, 0.0, 0.5 * GRAVITY * rig.shaft_mass(entry.shaft)
        for gear_name, gear in box.gears.items():
            if gear.shaft != entry.shaft:
                continue
            share = _lever(box, entry.shaft, entry.position, gear.position)
            for mesh_name, mesh in box.meshes.items():
                if gear_name not in (mesh.pinion, mesh.wheel):
                    continue
                full = f"{box_name}.{mesh_name}"
                pair = rig.pairs[full]
                force = abs(feedback.mesh_torque[full]) / pair.base_radii[0]
                tangential += share * force * math.cos(pair.working_pressure_angle)
                radial += share * force * math.sin(pair.working_pressure_angle)
                weight += share * GRAVITY * pair.masses[0 if gear_name == mesh.pinion else 1]
        loads[name] = math.hypot(tangential + weight, radial)
    return loads


def _lever(box: Gearbox, shaft: str, position: float | None, gear_position: float | None) -> float:
    """Share of a gear force that one of the two bearings of a shaft carries."""
    stations = [bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft]
    if position is None or gear_position is None or None in stations or len(stations) != 2:
        return 1.0 / len(stations)
    first, second = (station for station in stations if station is not None)
    other = second if position == first else first
    return abs(other - gear_position) / abs(other - position)

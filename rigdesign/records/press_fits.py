"""Torque that the press fits of the gears carry, hot and at speed, against the largest torque of their seats.

Elastic fit of a gear without web (DIN 7190-1:2017, thick rings after Lame; `dynamics.rating.mean_stress`): the bore
opens by the centrifugal load, and by the heat of the gear over that of the shaft. The shaft is taken at the outlet
temperature of its bearing oil, which is on the safe side. The interference is the least that the case states.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from dynamics.rating.mean_stress import PressFit, seat_pressure
from rigdesign.coupling.loop import PointResult
from rigdesign.records.part_torques import PartTorque
from rigdesign.records.tooth_history import GearInMesh, gear_meshes, seated_gear, shaft_material
from rigdesign.results.seats import PressFitCapacity
from rigdesign.results.units import ZERO
from rigdesign.rig.model import Rig

FRICTION = 0.12
"""Coefficient of a steel seat against slip along the circumference, joined with oil (DIN 7190-1, table of values)."""
REFERENCE = ZERO + 20.0
"""Temperature at which the interference counts [K] (ISO 1)."""


def press_fits(rig: Rig, torques: Iterable[PartTorque]) -> Iterator[PressFitCapacity]:
    """Of every gear whose interference the case states, at every torque of its seat.

    A press fit on the teeth of a spline, whose toothing is stated, carries no torque by friction and is left out.
    """
    first = {gear: places[0] for gear, places in gear_meshes(rig).items()}
    for seat in torques:
        fit = least_fit(rig, first[seat.part])
        if fit is not None and not splined(rig, first[seat.part]):
            yield _capacity(rig, first[seat.part], fit, seat)


def least_fit(rig: Rig, place: GearInMesh) -> PressFit | None:
    """Press fit of a gear with its least interference; None where the case states none."""
    _, fit = seated_gear(rig, place)
    entry = rig.mesh_gear(place.mesh, place.index)
    least = entry.shaft_interference_minimum
    return fit if fit is None or least is None else replace(fit, interference=least)


def splined(rig: Rig, place: GearInMesh) -> bool:
    """Whether the teeth of a spline carry the torque of a gear."""
    spline = rig.mesh_gear(place.mesh, place.index).spline
    return spline is not None and spline.toothing is not None


def slip_torque(pressure: float, diameter: float, length: float, friction: float) -> float:
    """Torque at which a seat slips [N m]: mu p pi D^2 L / 2; pressure [Pa], diameter and length [m]."""
    return 0.5 * friction * pressure * math.pi * diameter**2 * length


def grown_over_shaft(rig: Rig, place: GearInMesh, point: PointResult) -> tuple[float, float, float]:
    """What the bore of a gear grows over its shaft by heat, on the diameter [m]; temperatures of both [K]."""
    entry = rig.mesh_gear(place.mesh, place.index)
    name = rig.mesh_gears(rig.mesh_names[place.mesh])[place.index]
    warm = point.last.coupling_state.gear_temperature[name]
    cold = _shaft_temperature(name, point, warm)
    of_gear = rig.materials[entry.material]
    of_shaft = shaft_material(rig, entry.shaft) or of_gear
    grown = of_gear.expansion_coefficient * (warm - REFERENCE)
    grown -= of_shaft.expansion_coefficient * (cold - REFERENCE)
    return entry.bore_diameter * grown, warm, cold


def _capacity(rig: Rig, place: GearInMesh, fit: PressFit, seat: PartTorque) -> PressFitCapacity:
    entry, box = rig.mesh_gear(place.mesh, place.index), rig.mesh(rig.mesh_names[place.mesh])[0]
    disc, _ = seated_gear(rig, place)
    grown, warm, cold = grown_over_shaft(rig, place, seat.point)
    hot = fit.interference - grown
    pressure = seat_pressure(disc, rig.shaft_speed(entry.shaft, seat.speed), replace(fit, interference=hot))
    width = box.body_width(seat.part.split(".")[1])
    return PressFitCapacity(
        gear=seat.part,
        stage=seat.point.point.stage,
        where=seat.where,
        interference=fit.interference,
        interference_hot=hot,
        gear_temperature=warm,
        shaft_temperature=cold,
        pressure_at_rest=seat_pressure(disc, 0.0, fit),
        pressure=pressure,
        friction=FRICTION,
        slip_torque=slip_torque(pressure, entry.bore_diameter, width, FRICTION),
        peak_torque=seat.torque,
    )


def _shaft_temperature(name: str, point: PointResult, warm: float) -> float:
    """That of the oil that leaves the bearings, not above the gear; of the gear where there is none [K]."""
    outlet = point.last.coupling_state.oil_outlet
    return min(warm, outlet.get(f"{name.split('.')[0]}.bearing_oil", warm))

"""Torque that the press fits of the gears carry, hot and at speed, against the largest torque of their seats.

Elastic fit of a gear without web (DIN 7190-1:2017, thick rings after Lame; `dynamics.rating.root_stress`): the bore
opens by the centrifugal load, and by the heat of the gear over that of the shaft. The shaft is taken at the outlet
temperature of its bearing oil, which is on the safe side. The interference is the least that the case states.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from dynamics.rating.root_stress import PressFit, seat_pressure
from dynamics.standards import dudley_1957 as dudley
from rigdesign.case.gears import SplineToothing
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing.run_torques import PartTorque
from rigdesign.postprocessing.tooth_history import (
    GearInMesh,
    gear_meshes,
    seated_gear,
    shaft_bore,
    shaft_material,
)
from rigdesign.results.check import SEAT_FRICTION
from rigdesign.results.loads import PressFitCapacity, SplineStress, SplineStressKind
from rigdesign.results.units import ZERO
from rigdesign.rig.model import Rig

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
    width = box.body_width(rig.mesh_gear_name(place.mesh, place.index))
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
        friction=SEAT_FRICTION,
        slip_torque=slip_torque(pressure, entry.bore_diameter, width, SEAT_FRICTION),
        peak_torque=seat.torque,
    )


def _shaft_temperature(name: str, point: PointResult, warm: float) -> float:
    """That of the oil that leaves the bearings, not above the gear; of the gear where there is none [K]."""
    outlet = point.last.coupling_state.oil_outlet
    return min(warm, outlet.get(f"{name.split('.')[0]}.bearing_oil", warm))


# Stresses of the splines of the gears at the largest torque of their seats, hot and at speed, by Dudley.
#
# The hub is the gear: its tension is that of the tooth forces, of its rotation, and of a press fit on the teeth, whose
# pressure follows heat and speed as in `records.press_fits`; a press fit counts cold and at rest as well, where it
# presses most. The torque is the computed dynamic one: application factors of the meshes are not counted on top.
# Source: `dynamics.standards.dudley_1957`.


def spline_stresses(rig: Rig, torques: Iterable[PartTorque]) -> Iterator[SplineStress]:
    """Every stress whose allowable value the case states, at every torque of the seats with a toothing."""
    first = {gear: places[0] for gear, places in gear_meshes(rig).items()}
    cold: set[str] = set()
    for seat in torques:
        place = first[seat.part]
        toothing = toothing_of(rig, place)
        if toothing is None:
            continue
        yield from _of_teeth(rig, place, toothing, seat)
        if toothing.allowable_tension is not None and toothing.hub_root_diameter is not None:
            tension = _tension(rig, place, toothing, seat)
            yield _stress(seat, "tension of the hub", tension, toothing.allowable_tension)
            still = _press_fit_tension(rig, place, 0.0, 0.0)
            if still and seat.part not in cold:
                cold.add(seat.part)
                rest = replace(seat, torque=0.0, where="at rest, 20 degC")
                yield _stress(rest, "tension of the hub", still, toothing.allowable_tension)


def toothing_of(rig: Rig, place: GearInMesh) -> SplineToothing | None:
    """Toothing of the spline of a gear; None where the case states none."""
    spline = rig.mesh_gear(place.mesh, place.index).spline
    return None if spline is None else spline.toothing


def _of_teeth(
    rig: Rig, place: GearInMesh, toothing: SplineToothing, seat: PartTorque
) -> Iterator[SplineStress]:
    spline = _spline(toothing)
    if toothing.allowable_pressure is not None:
        yield _stress(seat, "flank pressure", dudley.S_c(spline, seat.torque), toothing.allowable_pressure)
    if toothing.allowable_shear is None:
        return
    shear = dudley.S_s_teeth(spline, seat.torque)
    yield _stress(seat, "shear of the teeth", shear, toothing.allowable_shear)
    if toothing.shaft_root_diameter is not None:
        entry = rig.mesh_gear(place.mesh, place.index)
        bore = 2.0 * shaft_bore(rig, entry.shaft, entry.seat_position)
        shear = dudley.S_s_shaft(seat.torque, toothing.shaft_root_diameter, bore)
        yield _stress(seat, "shear of the shaft", shear, toothing.allowable_shear)


def _tension(rig: Rig, place: GearInMesh, toothing: SplineToothing, seat: PartTorque) -> float:
    """Of the hub hot and at speed [Pa]."""
    entry = rig.mesh_gear(place.mesh, place.index)
    disc, _ = seated_gear(rig, place)
    inner = toothing.hub_root_diameter
    assert inner is not None
    outer = 2.0 * disc.root if toothing.hub_diameter is None else toothing.hub_diameter
    spline = _spline(toothing)
    speed = rig.shaft_speed(entry.shaft, seat.speed)
    of_teeth = dudley.S_1(spline, seat.torque, 0.5 * (outer - inner)) + dudley.S_3(spline, seat.torque)
    turning = dudley.S_2(speed, disc.solid.density, disc.solid.poisson, outer, inner)
    pressed = _press_fit_tension(rig, place, speed, grown_over_shaft(rig, place, seat.point)[0])
    return dudley.S_t(of_teeth, turning, spline.K_m) + pressed


def _press_fit_tension(rig: Rig, place: GearInMesh, speed: float, grown: float) -> float:
    """Hoop stress at the bore under a press fit at a speed of the shaft [rad/s] [Pa].

    grown : what the bore grows over the shaft by heat, on the diameter [m]
    """
    disc, fit = seated_gear(rig, place)
    if fit is None:
        return 0.0
    squared = (disc.bore / disc.root) ** 2
    pressure = seat_pressure(disc, speed, replace(fit, interference=fit.interference - grown))
    return pressure * (1.0 + squared) / (1.0 - squared)


def _spline(toothing: SplineToothing) -> dudley.Spline:
    return dudley.Spline(
        N=toothing.teeth,
        D=toothing.reference_diameter,
        phi=toothing.pressure_angle,
        F_e=toothing.length,
        h=toothing.contact_height,
        K_m=toothing.load_distribution_factor,
    )


def _stress(seat: PartTorque, kind: SplineStressKind, stress: float, allowable: float) -> SplineStress:
    return SplineStress(
        gear=seat.part, kind=kind, where=seat.where, torque=seat.torque, stress=stress, allowable=allowable
    )

"""Torque that the press fits of the gears carry at the held stages, hot and at speed, against the dynamic torque.

Elastic fit of a gear without web (DIN 7190-1:2017, thick rings after Lame; `dynamics.rating.mean_stress`): the bore
opens by the centrifugal load, and by the heat of the gear over that of the shaft. The shaft is taken as cold as the oil
that leaves its bearings, which is on the safe side.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

from dynamics.rating.mean_stress import seat_pressure
from rigdesign.coupling.loop import PointResult
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.tooth_history import GearInMesh, gear_meshes, seated_gear, shaft_material
from rigdesign.results.press_fit import PressFitCapacity
from rigdesign.results.section_torques import SectionTorqueRecord
from rigdesign.results.units import ZERO
from rigdesign.rig.model import Rig

FRICTION = 0.12
"""Coefficient of a steel seat against slip along the circumference, joined with oil (DIN 7190-1, table of values)."""
REFERENCE = ZERO + 20.0
"""Temperature at which the interference counts [K] (ISO 1)."""


def press_fits(rig: Rig, run: DynamicRun, torques: SectionTorqueRecord) -> Iterator[PressFitCapacity]:
    """Of every gear whose interference the case states, at every held point."""
    for gear, places in gear_meshes(rig).items():
        if rig.mesh_gear(places[0].mesh, places[0].index).shaft_interference > 0.0:
            for point in run.points:
                peak = _peak_torque(rig, gear, places, point, torques)
                yield _capacity(rig, gear, places[0], point, peak)


def slip_torque(pressure: float, diameter: float, length: float, friction: float) -> float:
    """Torque at which a seat slips [N m]: mu p pi D^2 L / 2; pressure [Pa], diameter and length [m]."""
    return 0.5 * friction * pressure * math.pi * diameter**2 * length


def _capacity(rig: Rig, name: str, place: GearInMesh, point: PointResult, peak: float) -> PressFitCapacity:
    entry, box = rig.mesh_gear(place.mesh, place.index), rig.mesh(rig.mesh_names[place.mesh])[0]
    disc, fit = seated_gear(rig, place)
    assert fit is not None
    state = point.last.coupling_state
    warm = state.gear_temperature[name]
    cold = _shaft_temperature(name, point, warm)
    of_gear = rig.materials[entry.material]
    of_shaft = shaft_material(rig, entry.shaft) or of_gear
    grown = of_gear.expansion_coefficient * (warm - REFERENCE)
    grown -= of_shaft.expansion_coefficient * (cold - REFERENCE)
    hot = fit.interference - entry.bore_diameter * grown
    speed = rig.shaft_speed(entry.shaft, point.point.speed)
    pressure = seat_pressure(disc, speed, replace(fit, interference=hot))
    return PressFitCapacity(
        gear=name,
        stage=point.point.stage,
        interference=fit.interference,
        interference_hot=hot,
        gear_temperature=warm,
        shaft_temperature=cold,
        pressure_at_rest=seat_pressure(disc, 0.0, fit),
        pressure=pressure,
        friction=FRICTION,
        slip_torque=slip_torque(pressure, entry.bore_diameter, box.body_width(name.split(".")[1]), FRICTION),
        peak_torque=peak,
    )


def _shaft_temperature(name: str, point: PointResult, warm: float) -> float:
    """That of the oil that leaves the bearings, not above the gear; of the gear where there is none [K]."""
    outlet = point.last.coupling_state.oil_outlet
    return min(warm, outlet.get(f"{name.split('.')[0]}.bearing_oil", warm))


def _peak_torque(
    rig: Rig, gear: str, places: list[GearInMesh], point: PointResult, torques: SectionTorqueRecord
) -> float:
    """Highest torque of the seat: of its spring, else of the meshes of a gear that is rigid with its shaft."""
    for held in torques.held:
        if held.stage == point.point.stage and (held.place.kind, held.place.part) == ("spline", gear):
            return held.swing.peak
    response = point.last.response
    assert response is not None
    peaks = []
    for place in places:
        teeth = rig.pairs[rig.mesh_names[place.mesh]].teeth
        peaks.append(float(response.maximum[place.mesh]) * teeth[place.index] / teeth[0])
    return max(peaks)

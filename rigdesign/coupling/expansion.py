"""Expansion of the housings: the clearances that go back into gears and bearings."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rigdesign.base.part_name import BearingName
from rigdesign.case.bearings import BearingInput
from rigdesign.case.rolling_bearing import BearingSeats
from rigdesign.coupling.bearing_seats import WarmBearing
from rigdesign.coupling.temperatures import HousingField
from rigdesign.properties.materials import Material
from rigdesign.rig.model import Rig
from thermal.expansion.alignment import BearingExpansion, CentreDistance
from thermal.expansion.expansion import Expansion, expand

TOLERANCE = 1e-6
"""Relative residual of the expansion solve: some nanometres at the seals, far below the loop's 0.5 um."""


@dataclass(frozen=True)
class HousingExpansion:
    """Hot shape of one housing, read by the names of the case."""

    gearbox: str
    deformed: Expansion
    centre_distance: Mapping[str, float]
    """Hot centre distance by ``gearbox.mesh`` [m]."""
    axial_expansion: Mapping[str, float]
    """Axial travel of the pinion of a helical mesh against its wheel, by ``gearbox.mesh`` [m]."""


def expand_housing(rig: Rig, field: HousingField, start: HousingExpansion | None = None) -> HousingExpansion:
    """Expand one housing from the temperature its drawing holds at; ``start`` is the thermal expansion of an earlier
    iteration.

    Raises
    ------
    NotConverged
        The linear solve stalls.
    """
    name = field.gearbox
    setup = rig.expansion[name]
    shape = expand(
        setup,
        field.temperature,
        rig.case.ambient.reference_temperature,
        tolerance=TOLERANCE,
        start=None if start is None else start.deformed,
    )
    return named_expansion(rig, name, shape)


def named_expansion(rig: Rig, name: str, shape: Expansion) -> HousingExpansion:
    """A hot shape read by the names of the case."""
    box = rig.case.gearboxes[name]
    distances, travels = {}, {}
    for mesh_name, mesh in box.meshes.items():
        shafts = box.gears[mesh.pinion].shaft, box.gears[mesh.wheel].shaft
        full = f"{name}.{mesh_name}"
        distances[full] = mesh.centre_distance + axes_of(rig, name, shape, shafts).change
        travel = 0.0
        if mesh.helix_angle and not mesh.double_helical:
            travel = _axial(rig, name, shape, shafts[0]) - _axial(rig, name, shape, shafts[1])
        travels[full] = travel
    return HousingExpansion(gearbox=name, deformed=shape, centre_distance=distances, axial_expansion=travels)


def axes_of(rig: Rig, name: str, shape: Expansion, shafts: tuple[str, str]) -> CentreDistance:
    """Axes of the two shafts of a mesh."""
    shaft_of = {gear.name: gear.shaft for gear in rig.models[name].gears}
    return next(
        axes
        for axes in shape.centre_distances
        if {shaft_of[axes.gear_a], shaft_of[axes.gear_b]} == set(shafts)
    )


def bearing_expansion(rig: Rig, name: str, shape: Expansion, entry: BearingInput) -> BearingExpansion:
    """Thermal expansion of the bearing of the case at one end of a shaft."""
    surface = f"bearing_bore_{entry.shaft}_{entry.side}"
    station = next(b for b in rig.models[name].bearings if b.bore_surface == surface)
    return shape.bearings[station.name]


def hot_clearances(
    rig: Rig,
    speed: float,
    expansion: Mapping[str, HousingExpansion],
    bearings: Mapping[str, WarmBearing] | None = None,
) -> dict[str, float]:
    """Clearance of every bearing as it runs, on the diameter [m].

    bearings : temperatures of those that conduct heat to their seats, by ``gearbox.bearing``

    A film runs in the thermal expansion of bore and journal; a gearbox without a housing has both at one temperature,
    so that only the spin counts. Rings follow their fits and their own temperatures.
    """
    known = bearings or {}
    clearances: dict[str, float] = {}
    for full, _, entry in rig.bearings():
        name = full.gearbox
        if not entry.has_film and full not in known:
            clearances[full] = entry.drawn_clearance
            continue
        change = 0.0
        if name in expansion and entry.has_film:
            change = bearing_expansion(rig, name, expansion[name].deformed, entry).clearance_change
        clearances[full] = entry.running_clearance(_seats(rig, full, entry, speed, change, known.get(full)))
    return clearances


def _seats(
    rig: Rig, full: BearingName, entry: BearingInput, speed: float, change: float, warm: WarmBearing | None
) -> BearingSeats:
    """Warm seats of a bearing; change : of the bore less that of the journal [m]."""
    housing = rig.case.gearboxes[full.gearbox].housing
    walls = rig.materials["structural_steel" if housing is None else housing.material]
    cold = rig.case.ambient.reference_temperature
    return BearingSeats(
        bore_less_journal=change,
        spin=centrifugal_expansion(rig, entry, speed),
        shaft=cold if warm is None else warm.shaft,
        bearing=cold if warm is None else warm.bearing,
        housing=cold if warm is None else warm.housing,
        shaft_expansion=_shaft_material(rig, entry).expansion_coefficient,
        housing_expansion=walls.expansion_coefficient,
        shaft_bore=0.0 if housing is None else housing.shafts[entry.shaft].bore_diameter,
    )


def centrifugal_expansion(rig: Rig, entry: BearingInput, speed: float) -> float:
    """Expansion of the journal diameter by rotation [m]: solid disc, rho w^2 R^3 (1 - nu) / (4 E) on the radius.

    Source: Timoshenko and Goodier, Theory of Elasticity, section 32.
    """
    steel = _shaft_material(rig, entry)
    radius = 0.5 * entry.shaft_diameter
    omega = rig.shaft_speed(entry.shaft, speed)
    return steel.density * omega**2 * radius**3 * (1.0 - steel.poisson_ratio) / (2.0 * steel.elastic_modulus)


def _shaft_material(rig: Rig, entry: BearingInput) -> Material:
    shafts = rig.case.power_circuit.shafts
    return rig.materials[shafts[entry.shaft].material if entry.shaft in shafts else "case_hardened_steel"]


def uniform_expansion(rig: Rig, name: str, temperature: float) -> dict[str, float]:
    """Hot centre distances of a gearbox without a housing: all of it at one temperature [K]."""
    steel = rig.materials["structural_steel"]
    strain = steel.expansion_coefficient * (temperature - rig.case.ambient.reference_temperature)
    return {
        f"{name}.{mesh_name}": mesh.centre_distance * (1.0 + strain)
        for mesh_name, mesh in rig.case.gearboxes[name].meshes.items()
    }


def _axial(rig: Rig, name: str, shape: Expansion, shaft: str) -> float:
    """Mean axial displacement of the rim of the gear on a shaft [m]."""
    gear = next(g for g in rig.models[name].gears if g.shaft == shaft)
    nodes = np.unique(rig.models[name].mesh.surfaces[gear.rim_surface])
    return float(shape.displacement[nodes, 0].mean())

"""Expansion of the housings: the clearances that go back into gears and bearings."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rigdesign.case.bearings import BearingInput
from rigdesign.coupling.temperatures import HousingField
from rigdesign.rig.model import Rig
from thermal.expansion.clearances import BearingExpansion, CentreDistance
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


def hot_clearances(rig: Rig, speed: float, expansion: Mapping[str, HousingExpansion]) -> dict[str, float]:
    """Hot diametral clearance of every bearing [m]: thermal expansion of bore and journal, centrifugal of the journal.

    A gearbox without a housing has journal and shell at one temperature: only the spin counts.
    """
    clearances = {}
    for full, _, entry in rig.bearings():
        name = full.split(".")[0]
        change = -centrifugal_expansion(rig, entry, speed)
        if name in expansion:
            change += bearing_expansion(rig, name, expansion[name].deformed, entry).clearance_change
        clearances[full] = entry.diametral_clearance + change
    return clearances


def centrifugal_expansion(rig: Rig, entry: BearingInput, speed: float) -> float:
    """Expansion of the journal diameter by rotation [m]: solid disc, rho w^2 R^3 (1 - nu) / (4 E) on the radius.

    Source: Timoshenko and Goodier, Theory of Elasticity, section 32.
    """
    power = rig.case.drivetrain
    name = (
        power.shafts[entry.shaft].material if power and entry.shaft in power.shafts else "case_hardened_steel"
    )
    steel = rig.materials[name]
    radius = 0.5 * entry.diameter
    omega = rig.shaft_speed(entry.shaft, speed)
    return steel.density * omega**2 * radius**3 * (1.0 - steel.poisson_ratio) / (2.0 * steel.elastic_modulus)


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

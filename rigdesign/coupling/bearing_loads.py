"""Forces on the bearings from teeth and weight: radial by the lever rule, axial to the locating bearing."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from dynamics.bearing.rolling_pair import pair_axial_loads
from rigdesign.case.bearings import BearingInput
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import GearMesh
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig

GRAVITY = 9.81


@dataclass(frozen=True, kw_only=True)
class BearingLoad:
    """Radial force and axial force inside the bearing [N], not negative."""

    radial: float
    axial: float = 0.0


def bearing_loads(rig: Rig, coupling_state: CouplingState) -> dict[str, BearingLoad]:
    """Load of every bearing: tooth forces and weight by the lever rule on its shaft, axial forces to what locates it.

    Tooth forces add as vectors where the housing says where the axes stand: at an idler between two wheels the
    tangential forces add and the separating ones cancel. Without a housing they add as if all pointed one way.
    Weight is counted with the tangential force, which is on the safe side. Axial forces of a double-helical gear
    cancel. Those of the single-helical gears of a shaft go to its locating bearing, the first where none is; their
    tilting moment F_a r is carried by both bearings of the shaft as a couple over their distance, with the separating
    force on either of them, which is on the safe side; it is left out where the case does not state both positions
    (`tilt_counted`).

    Where the radial load of a bearing induces an axial force, its partner takes that up as well (`pair_axial_loads`);
    the locating bearing is the one that the gears press, whether the pair stands face to face or back to back.
    """
    loads = {
        name: BearingLoad(
            radial=_radial_load(rig, name, box, entry, coupling_state)
            if entry.radial_load is None
            else entry.radial_load
        )
        for name, box, entry in rig.bearings()
    }
    for name, box in rig.case.gearboxes.items():
        for shaft in dict.fromkeys(entry.shaft for entry in box.bearings.values()):
            loads |= _axial_loads(rig, name, shaft, loads, coupling_state)
    return loads


def tilt_counted(box: Gearbox, shaft: str) -> bool:
    """Whether the tilting moment of axial forces is in the radial loads of the bearings of a shaft."""
    return _span(box, shaft) > 0.0


def axial_force(rig: Rig, name: str, shaft: str, coupling_state: CouplingState) -> float:
    """Axial force of the single-helical gears of a shaft [N], of several gears on the safe side: all push one way."""
    box = rig.case.gearboxes[name]
    return math.fsum(
        abs(math.fsum(force for force, _ in _thrusts(rig, name, gear, coupling_state)))
        for gear, entry in box.gears.items()
        if entry.shaft == shaft
    )


def _axial_loads(
    rig: Rig, name: str, shaft: str, loads: dict[str, BearingLoad], coupling_state: CouplingState
) -> dict[str, BearingLoad]:
    """Loads of the bearings of a shaft that carry axial force."""
    box = rig.case.gearboxes[name]
    own = [f"{name}.{part}" for part, entry in box.bearings.items() if entry.shaft == shaft]
    entries = {full: box.bearings[full.split(".")[1]] for full in own}
    first = next((full for full in own if entries[full].locating), own[0])
    external = axial_force(rig, name, shaft, coupling_state)
    induced = {full: entries[full].induced_axial_load(loads[full].radial) for full in own}
    axial = {first: external}
    if len(own) == 2 and max(induced.values()) > 0.0:
        other = own[1] if first == own[0] else own[0]
        axial = dict(
            zip((first, other), pair_axial_loads((induced[first], induced[other]), external), strict=True)
        )
    return {
        full: replace(loads[full], axial=force)
        for full, force in axial.items()
        if force > 0.0 and not entries[full].has_film  # a thrust face carries it beside the film
    }


def _thrusts(rig: Rig, name: str, gear: str, coupling_state: CouplingState) -> Iterator[tuple[float, float]]:
    """(axial force [N], radius at which it acts [m]) of every mesh of a gear; signs against each other.

    F_a = T / r tan(beta) at the reference circle. Its sign follows that of the torque on the gear in its own sense of
    rotation: driven in one mesh and driving in the other, the forces on an idler cancel.
    """
    box = rig.case.gearboxes[name]
    for own, mesh in box.meshes.items():
        if gear not in (mesh.pinion, mesh.wheel) or mesh.double_helical:
            continue
        full = f"{name}.{own}"
        pair, side = rig.pairs[full], 0 if gear == mesh.pinion else 1
        force = coupling_state.mesh_torque[full] / pair.gears[0].reference_radius * math.tan(mesh.helix_angle)
        yield (-force, force)[side], pair.working_radii[side]


def _tilting(rig: Rig, name: str, shaft: str, coupling_state: CouplingState) -> float:
    """Radial force by which the tilting moments load either bearing of a shaft [N]; 0 where positions are missing."""
    box = rig.case.gearboxes[name]
    span = _span(box, shaft)
    if not span:
        return 0.0
    moments = (
        abs(force) * radius
        for gear, entry in box.gears.items()
        if entry.shaft == shaft
        for force, radius in _thrusts(rig, name, gear, coupling_state)
    )
    return math.fsum(moments) / span


def _span(box: Gearbox, shaft: str) -> float:
    """Distance of the two bearings of a shaft [m]; 0 where it is not stated."""
    stations = [bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft]
    if len(stations) != 2 or stations[0] is None or stations[1] is None:
        return 0.0
    return abs(stations[0] - stations[1])


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
    tilting = _tilting(rig, box_name, entry.shaft, coupling_state)
    return math.hypot(abs(tangential) + weight, abs(separating) + tilting)


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

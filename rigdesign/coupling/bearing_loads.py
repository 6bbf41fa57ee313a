"""Forces on the bearings from teeth and weight: radial by the lever rule, axial to the locating bearing."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dynamics.bearing.rolling_pair import pair_axial_loads
from rigdesign.case.bearings import BearingInput
from rigdesign.case.gearbox import Gearbox
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]

GRAVITY = 9.81


@dataclass(frozen=True, kw_only=True)
class BearingLoad:
    """Radial force and axial force inside the bearing [N], not negative.

    direction : unit vector of the radial force of the shaft on the bearing in the plane (y, z), its two components
    """

    radial: float
    axial: float = 0.0
    direction: tuple[float, float] = (0.0, -1.0)


def bearing_loads(rig: Rig, coupling_state: CouplingState) -> dict[str, BearingLoad]:
    """Load of every bearing: tooth forces and weight by the lever rule on its shaft, axial forces to what locates it.

    Forces add as vectors where the axes stand (`rigdesign.rig.shaft_axes`): at an idler between two wheels the
    tangential forces add and the separating ones cancel. Axial forces of a double-helical gear cancel. Those of the
    single-helical gears of a shaft go to its locating bearing, the first where none is; their tilting moment F_a r is
    carried by both bearings of the shaft as a couple over their distance, with the separating force on either of
    them, which is on the safe side; it is left out where the case does not state both positions (`tilt_counted`).

    Where the radial load of a bearing induces an axial force, its partner takes that up as well (`pair_axial_loads`);
    the locating bearing is the one that the gears press, whether the pair stands face to face or back to back.
    """
    loads: dict[str, BearingLoad] = {}
    for full, box, entry in rig.bearings():
        force = _radial_force(rig, full.split(".")[0], box, entry, coupling_state)
        size = float(np.hypot(*force))
        direction = (float(force[0]) / size, float(force[1]) / size) if size > 0.0 else (0.0, -1.0)
        radial = size if entry.radial_load is None else entry.radial_load
        loads[full] = BearingLoad(radial=radial, direction=direction)
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


def _radial_force(
    rig: Rig, name: str, box: Gearbox, entry: BearingInput, coupling_state: CouplingState
) -> Array:
    """Force of the shaft on one of its bearings in the plane (y, z) (2,) [N]."""
    force = np.array([0.0, -0.5 * GRAVITY * rig.shaft_mass(entry.shaft)])
    tilting = _tilting(rig, name, entry.shaft, coupling_state)
    first = box.first_meshes()
    for gear_name, gear in box.gears.items():
        if gear.shaft != entry.shaft:
            continue
        own, side = first[gear_name]
        mass = box.halves(gear_name) * rig.pairs[f"{name}.{own}"].masses[side]
        acting = np.array([0.0, -GRAVITY * mass])
        for mesh_name, mesh in box.meshes.items():
            if gear_name in (mesh.pinion, mesh.wheel):
                acting += tooth_force(rig, f"{name}.{mesh_name}", gear_name, coupling_state)
        force += _lever(box, entry.shaft, entry.position, gear.position) * acting
        if tilting:
            centres = rig.line_of_action(f"{name}.{own}").centres
            force += math.copysign(tilting, float(force @ centres)) * centres
            tilting = 0.0
    return force


def tooth_force(rig: Rig, mesh: str, gear: str, coupling_state: CouplingState) -> Array:
    """Mean force of the teeth of a mesh ``gearbox.mesh`` on one of its gears, in the plane (y, z) (2,) [N]."""
    pair, torque = rig.pairs[mesh], coupling_state.mesh_torque[mesh]
    direction = rig.line_of_action(mesh).normal(pair.working_pressure_angle, math.copysign(1.0, torque))
    pushed = 1.0 if gear == rig.mesh_gears(mesh)[1].split(".")[1] else -1.0
    return np.asarray(pushed * abs(torque) / pair.base_radii[0] * direction)


def _lever(box: Gearbox, shaft: str, position: float | None, gear_position: float | None) -> float:
    """Share of a gear force that one of the two bearings of a shaft carries; negative beyond the other one."""
    stations = [bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft]
    if position is None or gear_position is None or None in stations or len(stations) != 2:
        return 1.0 / len(stations)
    first, second = (station for station in stations if station is not None)
    other = second if position == first else first
    return (other - gear_position) / (other - position)

"""Standing force and moment of couplings whose axes are out of line, on both of their shafts.

Out of line as they were set up, and by what warm housings move the ends of their shafts. A coupling presses with its
stiffness times what the shafts do not give way of the offset and angle: with bearings at the reference stiffness of the
reduced rig, as the load decides on their own. Both act at the middle of the coupling. A cross joint under an angle
bends both shafts by half of its torque times that angle on top (`dynamics.rotor.assembly`).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor import assembly
from dynamics.rotor.assembly import bending_moment
from dynamics.rotor.bearing_state import misalignment_load
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.rotor_model import AxisMisalignment
from rigdesign.coupling.alignment import coupling_places, end_motion
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig
from thermal.expansion.expansion import Expansion

Array = NDArray[np.float64]

ARM = 1.0
"""Distance of the two forces that stand for a moment [m]."""


@dataclass(frozen=True, kw_only=True)
class WarmMisalignment:
    """Of all couplings that resist it: the fields ``coupling_offset`` and ``coupling_angle`` of the coupling state."""

    offset: dict[str, float]
    angle: dict[str, float]


def warm_misalignment(rig: Rig, shapes: Mapping[str, Expansion]) -> WarmMisalignment:
    """What thermal expansion adds to the misalignment of couplings that a housing moves, as the record of the alignment
    has it: a shaft end that no expanded housing carries stays where it is. Nothing for shafts that only twist.

    shapes : by gearbox; without one the rig stands as it was set up
    """
    offset: dict[str, float] = {}
    angle: dict[str, float] = {}
    if rig.shaft_model == "torsional":
        return WarmMisalignment(offset=offset, angle=angle)
    axes = {box: shape.axes for box, shape in shapes.items()}
    for place in coupling_places(rig):
        coupling = rig.case.power_circuit.couplings[place.name]
        first, second = (end_motion(end, axes) for end in (place.first, place.second))
        for i, way in enumerate(("lateral", "vertical")):
            key = f"{place.name}.{way}"
            if coupling.radial_stiffness:
                offset[key] = first[0][i] - second[0][i]
            if coupling.angular_stiffness:
                angle[key] = first[1][i] - second[1][i]
    return WarmMisalignment(offset=offset, angle=angle)


def axis_misalignments(rig: Rig, coupling_state: CouplingState) -> tuple[AxisMisalignment, ...]:
    """Of every coupling that is out of line, as set up and warm."""
    as_set = {part.coupling: part for part in rig.elastic.rig.misalignments}
    offset, angle = coupling_state.coupling_offset, coupling_state.coupling_angle
    names = dict.fromkeys([*as_set, *(key.rpartition(".")[0] for key in (*offset, *angle))])
    found = []
    for name in names:
        own = as_set.get(name, AxisMisalignment(coupling=name))
        keys = f"{name}.lateral", f"{name}.vertical"
        both = AxisMisalignment(
            coupling=name,
            offset=(own.offset[0] + offset.get(keys[0], 0.0), own.offset[1] + offset.get(keys[1], 0.0)),
            slope=(own.slope[0] + angle.get(keys[0], 0.0), own.slope[1] + angle.get(keys[1], 0.0)),
        )
        if any((*both.offset, *both.slope)):
            found.append(both)
    return tuple(found)


def coupling_forces(rig: Rig, shaft: str, coupling_state: CouplingState) -> Iterator[tuple[float, Array]]:
    """Forces (2,) in the plane (y, z) [N] on a shaft that bends, each with its place on it [m].

    A moment is two opposite forces; places may lie beyond the ends of the shaft. Cross joints bend by the torques of
    the coupling state.
    """
    if rig.shaft_model == "torsional":
        return
    pressed = reactions(rig, coupling_state)
    bent = _bent_by_cross_joints(rig, coupling_state.mesh_torque)
    for name in pressed.keys() | bent.keys():
        coupling = rig.case.power_circuit.couplings[name]
        if shaft not in coupling.shafts:
            continue
        push = 1.0 if shaft == coupling.shafts[0] else -1.0
        axis, at = rig.axes[shaft], _middle(rig, name)
        both = push * pressed.get(name, np.zeros(4)) + bent.get(name, np.zeros(4))
        force, couple = both[:2], both[2:] / ARM
        place = axis.direction * (at - axis.start)
        yield place, force - couple
        yield place + axis.direction * ARM, couple


def _bent_by_cross_joints(rig: Rig, mesh_torque: Mapping[str, float]) -> dict[str, Array]:
    """As `reactions`, alike on both shafts of every cross joint: no force, moment along the slopes [N m]."""
    torques = coupling_torques(rig, mesh_torque)
    found = {}
    for joint in rig.elastic.rig.cross_joints:
        sense = rig.axes[rig.case.power_circuit.couplings[joint.coupling].shafts[0]].sense
        about_y, about_z = bending_moment(joint, sense, torques[joint.coupling])
        found[joint.coupling] = np.array([0.0, 0.0, about_z, -about_y])
    return found


def coupling_torques(rig: Rig, mesh_torque: Mapping[str, float]) -> dict[str, float]:
    """Mean torque that the first shaft of every cross joint passes to the second along their rotation [N m].

    mesh_torque : of the pinion of every mesh [N m]. What the motor and the drags take part in is left out.
    """
    drivetrain = rig.drivetrain
    if rig.shaft_model == "torsional":
        return {}
    found = {}
    for joint in rig.elastic.rig.cross_joints:
        side = _side_of(drivetrain, joint.coupling)
        torque = 0.0
        for mesh in drivetrain.meshes:
            ratio = mesh.base_radii[1] / mesh.base_radii[0]
            for gear, share in ((mesh.pinion, -1.0), (mesh.wheel, ratio)):
                if drivetrain.gear(gear).shaft in side:
                    torque += share * mesh_torque[mesh.name]
        found[joint.coupling] = torque
    return found


def _side_of(drivetrain: Drivetrain, coupling: str) -> set[str]:
    """Shafts on the side of the first shaft of a coupling, of the line that it is in."""
    others = [one.shafts for one in drivetrain.couplings if one.name != coupling]
    side = {next(one for one in drivetrain.couplings if one.name == coupling).shafts[0]}
    while True:
        joined = {shaft for shafts in others if side & set(shafts) for shaft in shafts}
        if joined <= side:
            return side
        side |= joined


def standing_load(rig: Rig, coupling_state: CouplingState) -> Array:
    """(n,) load of axes out of line on the coordinates of the reduced rig, with that of cross joints under torque."""
    elastic = rig.elastic
    load = misalignment_load(elastic.model, axis_misalignments(rig, coupling_state))
    if elastic.rig.cross_joints:
        torques = coupling_torques(rig, coupling_state.mesh_torque)
        load = load + assembly.standing_load(elastic.model, torques)
    return elastic.reduced.rows(load)


def reactions(rig: Rig, coupling_state: CouplingState) -> dict[str, Array]:
    """Of every coupling on its first shaft: force along y and z [N], moment along the slopes of y and z [N m].

    Of axes out of line alone, cross joints left out; empty where all are in line.
    """
    misaligned = axis_misalignments(rig, coupling_state)
    if not misaligned:
        return {}
    elastic = rig.elastic
    reduced = elastic.reduced
    load = reduced.rows(misalignment_load(elastic.model, misaligned))
    bent = np.zeros(reduced.size)
    bent[reduced.n_rigid :] = load[reduced.n_rigid :] / reduced.squared[reduced.n_rigid :]
    found = {}
    for joint in elastic.model.joints:
        if joint.kind != "coupling":
            continue
        gap = np.zeros(len(joint.directions))
        for part in misaligned:
            if part.coupling == joint.name:
                built_in = dict(zip(SLOPES, (*part.offset, part.slope[0], -part.slope[1]), strict=True))
                gap = np.array([built_in.get(direction, 0.0) for direction in joint.directions])
        pressed = dict(
            zip(joint.directions, -joint.stiffness @ (gap + reduced.rows(joint.rows) @ bent), strict=True)
        )
        force_y, force_z, about_z, about_y = (pressed.get(direction, 0.0) for direction in SLOPES)
        found[joint.name] = np.array([force_y, force_z, about_z, -about_y])
    return found


SLOPES = ("u_y", "u_z", "theta_z", "theta_y")
"""Across a coupling; the slopes over x are theta_z of y and -theta_y of z."""


def _middle(rig: Rig, coupling: str) -> float:
    """x of the middle between the two ends [m]."""
    entry = rig.case.power_circuit.couplings[coupling]
    ends = [
        rig.axes[shaft].place(0.0 if end == "start" else rig.drivetrain.shaft(shaft).length)
        for shaft, end in zip(entry.shafts, entry.ends, strict=True)
    ]
    return 0.5 * sum(ends)

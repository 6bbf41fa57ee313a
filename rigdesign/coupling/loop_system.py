"""Matrices of the power circuit at an operating point: torsional, the same always, or elastic, with its bearings."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import (
    BearingState,
    LateralCoefficients,
    LateralOperation,
    constant_coefficients,
)
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.craig_bampton import elastic_twist_rows
from dynamics.rotor.graph import TwistRows, torsional_twist_rows, with_spline_dampers
from dynamics.rotor.linear_system import LinearSystem
from rigdesign.base.part_name import MeshName
from rigdesign.case.rolling_bearing import ROLLING_DAMPING_TIME
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.misalignment import coupling_torques, standing_load
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig

Sense = Literal[1, -1]


def loop_system(
    rig: Rig, point: OperatingPoint, coupling_state: CouplingState, bearings: Mapping[str, BearingState]
) -> LinearSystem:
    """Matrices without the meshes.

    bearings : state of every bearing at this point, by ``gearbox.bearing``
    """
    if rig.shaft_model == "torsional":
        return rig.twisting.at(point.speed)
    return rig.elastic.seen.system(running_state(rig, point, coupling_state, bearings))


def running_state(
    rig: Rig, point: OperatingPoint, coupling_state: CouplingState, bearings: Mapping[str, BearingState]
) -> RunningState:
    """Speed, bearings and torques of cross joints of the elastic rig at an operating point."""
    state = running_at(rig, point, bearing_coefficients(rig, coupling_state, bearings))
    return replace(state, torques=coupling_torques(rig, coupling_state.mesh_torque))


def running_at(
    rig: Rig, point: OperatingPoint, coefficients: Mapping[str, LateralCoefficients]
) -> RunningState:
    """Speed of the elastic rig at an operating point with these coefficients in its bearings."""
    return RunningState(
        speed=rig.drive_speed(point.speed),
        bearings={name: at_seat(one, name in rig.elastic.pressed) for name, one in coefficients.items()},
    )


def bearing_coefficients(
    rig: Rig, coupling_state: CouplingState, bearings: Mapping[str, BearingState]
) -> dict[str, LateralCoefficients]:
    """Lateral stiffness, damping and static position of every bearing, by ``gearbox.bearing``.

    Computed from its state at the load of this coupling state, or as the case states them.
    """
    power = rig.case.power_circuit
    loads = bearing_loads(rig, coupling_state)
    found: dict[str, LateralCoefficients] = {}
    for name, _, entry in rig.bearings():
        load = loads[name]
        if power.bearing_coefficients == "stated":
            assert entry.radial_stiffness is not None
            found[name] = constant_coefficients(
                entry.radial_stiffness, entry.radial_damping or 0.0, load.force
            )
            continue
        sense: Sense = 1 if rig.axes[entry.shaft].sense > 0.0 else -1
        operation = LateralOperation(
            force=load.force,
            axial_force=load.axial_sense * load.axial,
            sense=sense,
            structural_damping=ROLLING_DAMPING_TIME,
        )
        found[name] = bearings[name].lateral_coefficients(operation)
    return found


def at_seat(coefficients: LateralCoefficients, pressed: bool = False) -> BearingCoefficients:
    """Coefficients in the order of the elastic rig.

    pressed : against another bearing of its shaft, so that its elements locate the shaft; where they do not, a spring
        of its own does, and they hold it laterally and against tilting only
    """
    order = [1, 2, 0, 3, 4]
    stiffness = coefficients.node_stiffness[order][:, order]
    damping = coefficients.node_damping[order][:, order]
    if not pressed:
        for matrix in (stiffness, damping):
            matrix[2] = 0.0
            matrix[:, 2] = 0.0
    return BearingCoefficients(stiffness=stiffness, damping=damping)


# Where the gears stand under load: shafts that bend, journals that float in their clearance, rings on their balls.
#
# Bending, and bearings taken as springs at their stiffness, are in the dynamics: the mean of the response has them. A
# film or a row of balls is no straight spring: the journal stands elsewhere than its stiffness times its load says.
# This rest, and all of what changes the shape of the mesh, centre distance and tilt of the axes, is found here from the
# mean forces and goes back into the gears.

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class MeshPlacement:
    """How the mean load moves the gears of a mesh.

    apart : change of their centre distance [m]
    approach : by which the flanks come nearer that carry, beyond bending and springs at the bearings [m], in the sense
        of the front flanks; ``apart`` is not in it
    inclination, skew : of the wheel axis against that of the pinion over the axis of the gearbox from its front to its
        rear, along the centre line and across [rad]
    """

    apart: float
    approach: float
    inclination: float
    skew: float


def mesh_placements(
    rig: Rig, point: OperatingPoint, coupling_state: CouplingState, bearings: Mapping[str, BearingState]
) -> dict[str, MeshPlacement]:
    """Placement of every mesh under the mean torques of a coupling state; empty for shafts that only twist.

    bearings : state of every bearing at this point, by ``gearbox.bearing``
    """
    if rig.shaft_model == "torsional":
        return {}
    coefficients = bearing_coefficients(rig, coupling_state, bearings)
    moved = _displacements(rig, running_at(rig, point, coefficients), coefficients, coupling_state)
    found: dict[str, MeshPlacement] = {}
    for name, pair in rig.pairs.items():
        rows = [rig.elastic.lateral_rows[full] for full in rig.mesh_gears(name)]
        spring, rest = ((rows[1] - rows[0]) @ moved).T  # y, z and their slopes over x
        both = spring + rest
        line = rig.line_of_action(name)
        across = np.array([-line.centres[1], line.centres[0]])
        flank = math.copysign(1.0, coupling_state.mesh_torque[name])
        sine, cosine = math.sin(pair.working_pressure_angle), math.cos(pair.working_pressure_angle)
        found[name] = MeshPlacement(
            apart=float(line.centres @ both[:2]),
            approach=float(-cosine * line.tangent @ rest[:2] + flank * sine * line.centres @ spring[:2]),
            inclination=float(line.centres @ both[2:]) * _towards_rear(rig, name),
            skew=float(across @ both[2:]),
        )
    return found


def _towards_rear(rig: Rig, mesh: MeshName) -> float:
    """1 where the gearbox of a mesh stands in the rig front ahead, -1 the other way round; its skew is the same."""
    box, own = rig.mesh(mesh)
    return rig.axes[box.gears[box.meshes[own].pinion].shaft].direction


def flank_approach(placements: Mapping[str, MeshPlacement]) -> dict[str, float]:
    """The field of the coupling state."""
    return {name: placement.approach for name, placement in placements.items()}


def axis_tilt(placements: Mapping[str, MeshPlacement]) -> dict[str, float]:
    """The field of the coupling state."""
    return {
        f"{name}.{angle}": getattr(placement, angle)
        for name, placement in placements.items()
        for angle in ("inclination", "skew")
    }


def _displacements(
    rig: Rig,
    running: RunningState,
    coefficients: Mapping[str, LateralCoefficients],
    coupling_state: CouplingState,
) -> Array:
    """(n, 2) mean displacement of the reduced rig, rigid motions 0: under tooth forces with bearings as springs, which
    the dynamics have as well; and the rest, by weight, couplings out of line and by what journals move beyond the
    springs of their bearings.

    That part acts like a seat that is displaced: shafts on two bearings follow it straight, others bend.
    """
    reduced, drivetrain = rig.elastic.reduced, rig.elastic.rig.drivetrain
    teeth = np.zeros(reduced.size)
    for mesh in drivetrain.meshes:
        pinion, wheel = rig.elastic.turn_rows[mesh.name]
        ratio = mesh.base_radii[1] / mesh.base_radii[0]
        teeth -= coupling_state.mesh_torque[mesh.name] * (pinion - ratio * wheel)
    stiffness = reduced.matrices(running).stiffness
    standing = rig.elastic.weight + standing_load(rig, coupling_state)
    springs = _elastic(reduced.n_rigid, stiffness, np.column_stack([teeth, standing]))
    rest = np.zeros(reduced.size)
    for bearing in drivetrain.bearings:
        ports = reduced.ports[bearing.name]
        beyond = coefficients[bearing.name].position - ports[:2] @ springs.sum(axis=1)
        rest += ports.T @ (running.bearings[bearing.name].padded()[0][:, :2] @ beyond)
    return springs + np.outer(_elastic(reduced.n_rigid, stiffness, rest), [0.0, 1.0])


def _elastic(rigid: int, stiffness: Array, load: Array) -> Array:
    """Displacement under loads (n, ...), the first ``rigid`` coordinates 0."""
    moved = np.zeros_like(load)
    moved[rigid:] = np.linalg.solve(stiffness[rigid:, rigid:], load[rigid:])
    return moved


# Where torque passes through the shafts and joints of a rig, on the freedoms of its linear system.


def twist_rows_of(rig: Rig, speed: float | None = None) -> TwistRows:
    """Rows of the torques on the freedoms of the linear systems of the rig.

    speed : of the schedule [rad/s], at which the dampers of splines with a loss factor carry torque too; None leaves
        their share out, a factor sqrt(1 + eta^2)
    """
    rows = (
        torsional_twist_rows(rig.drivetrain)
        if rig.shaft_model == "torsional"
        else elastic_twist_rows(rig.elastic.seen)
    )
    return rows if speed is None else with_spline_dampers(rows, rig.drivetrain, rig.drive_speed(speed))

"""Matrices of the power circuit at an operating point: torsional, the same always, or elastic, with its bearings."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

from dynamics.bearing.lateral import LateralCoefficients, constant_coefficients
from dynamics.bearing.protocol import BearingState, LateralOperation
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.elastic_rig.running_state import BearingCoefficients, RunningState
from rigdesign.case.rolling_bearing import ROLLING_DAMPING_TIME
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.misalignment import coupling_torques
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
    power = rig.case.drivetrain
    assert power is not None
    loads = bearing_loads(rig, coupling_state)
    found = {}
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

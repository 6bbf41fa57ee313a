"""Where the gears stand under load: shafts that bend, journals that float in their clearance, rings on their balls.

Bending, and bearings taken as springs at their stiffness, are in the dynamics: the mean of the response has them. A
film or a row of balls is no straight spring: the journal stands elsewhere than its stiffness times its load says. This
rest, and all of what changes the shape of the mesh, centre distance and tilt of the axes, is found here from the mean
forces and goes back into the gears.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.bearing.lateral import LateralCoefficients
from dynamics.bearing.protocol import BearingState
from dynamics.elastic_rig.running_state import RunningState
from rigdesign.coupling.loop_system import at_seat, bearing_coefficients
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class MeshPlacement:
    """How the mean load moves the gears of a mesh.

    apart : change of their centre distance [m]
    approach : by which the flanks come nearer that carry, beyond bending and springs at the bearings [m], in the sense
        of the front flanks; ``apart`` is not in it
    inclination, skew : of the wheel axis against that of the pinion over x, along the centre line and across [rad]
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
    if rig.shaft_model == "torsional" or rig.drivetrain is None:
        return {}
    coefficients = bearing_coefficients(rig, coupling_state, bearings)
    bent = _deflection(rig, point, coupling_state, coefficients)
    rest = _rest_of_journals(rig, coefficients, bent)
    model, found = rig.elastic.model, {}
    for name, pair in rig.pairs.items():
        linear, beyond = [], []
        for full in rig.mesh_gears(name):
            rows = rig.elastic.reduced.rows(model.rows(full)[[1, 2, 4, 5]])
            y, z, about_y, about_z = rows @ bent
            linear.append(np.array([y, z, about_z, -about_y]))
            shaft = rig.drivetrain.gear(full).shaft
            beyond.append(_at(rest[shaft], rig.axes[shaft].place(rig.drivetrain.gear(full).position)))
        spring, journal = linear[1] - linear[0], beyond[1] - beyond[0]
        both = spring + journal
        line = rig.line_of_action(name)
        across = np.array([-line.centres[1], line.centres[0]])
        flank = math.copysign(1.0, coupling_state.mesh_torque[name])
        sine, cosine = math.sin(pair.working_pressure_angle), math.cos(pair.working_pressure_angle)
        found[name] = MeshPlacement(
            apart=float(line.centres @ both[:2]),
            approach=float(-cosine * line.tangent @ journal[:2] + flank * sine * line.centres @ spring[:2]),
            inclination=float(line.centres @ both[2:]),
            skew=float(across @ both[2:]),
        )
    return found


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


def _deflection(
    rig: Rig,
    point: OperatingPoint,
    coupling_state: CouplingState,
    coefficients: Mapping[str, LateralCoefficients],
) -> Array:
    """Mean deflection (n,) of the reduced rig under tooth forces and weight, bearings as springs; rigid motions 0."""
    reduced, drivetrain = rig.elastic.reduced, rig.elastic.rig.drivetrain
    load = reduced.rows(rig.elastic.model.weight())
    for mesh in drivetrain.meshes:
        torque = coupling_state.mesh_torque[mesh.name]
        pinion, wheel = reduced.rows(rig.elastic.port_rows[mesh.name])
        ratio = mesh.base_radii[1] / mesh.base_radii[0]
        load -= torque * (pinion - ratio * wheel)
    at = reduced.matrices(
        RunningState(
            speed=rig.drive_speed(point.speed),
            bearings={name: at_seat(one) for name, one in coefficients.items()},
        )
    )
    rigid = reduced.n_rigid
    bent = np.zeros(reduced.size)
    bent[rigid:] = np.linalg.solve(at.stiffness[rigid:, rigid:], load[rigid:])
    return bent


def _rest_of_journals(
    rig: Rig, coefficients: Mapping[str, LateralCoefficients], bent: Array
) -> dict[str, tuple[Array, Array]]:
    """Of every shaft: displacement (2,) [m] at x = 0 and slope (2,) over x [rad] through the places at which its
    journals stand beyond the springs of their bearings, by least squares."""
    assert rig.drivetrain is not None
    places: dict[str, list[tuple[float, Array]]] = {shaft.name: [] for shaft in rig.drivetrain.shafts}
    for bearing in rig.drivetrain.bearings:
        spring = rig.elastic.reduced.ports[bearing.name][:2] @ bent
        x = rig.axes[bearing.shaft].place(bearing.position)
        places[bearing.shaft].append((x, coefficients[bearing.name].position - spring))
    return {shaft: _straight(found) for shaft, found in places.items()}


def _straight(places: list[tuple[float, Array]]) -> tuple[Array, Array]:
    if not places:
        return np.zeros(2), np.zeros(2)
    x = np.array([place for place, _ in places])
    moved = np.array([value for _, value in places])
    middle = float(x.mean())
    away = x - middle
    spread = float(away @ away)
    slope = away @ moved / spread if spread > 0.0 else np.zeros(2)
    return moved.mean(axis=0) - middle * slope, slope


def _at(line: tuple[Array, Array], x: float) -> Array:
    """Displacement and slope over x (4,) of a shaft at a place."""
    start, slope = line
    return np.concatenate([start + x * slope, slope])

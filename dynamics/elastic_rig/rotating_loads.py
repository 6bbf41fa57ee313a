"""Loads once a turn from unbalance, bow and flange run-out, and the standing load of axes out of line.

A shaft that turns with the angle theta in its sense s about x carries what is fixed to it along (cos theta, s sin
theta): a complex amplitude a means u_y = Re(a exp(i theta)), u_z = Re(-i s a exp(i theta)), tilts follow from u_y' =
theta_z, u_z' = -theta_y. The load of an unbalance is U Omega^2. A bent shaft pulls with K_s q_b, K_s the stiffness of
its elements alone and q_b its shape without load: rigid motion of the shape loads nothing (J. C. Nicholas, E. J.
Gunter, P. E. Allaire, J. Eng. Power 98, 1976, 182). A coupling with stiffness K whose flanges stand o apart loads both
shafts with -K o (M. Xu, R. D. Marangoni, J. Sound Vib. 176, 1994, 663, for the stiffness of the coupling as the path).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.shaft import Shaft, element_sections
from dynamics.elastic_rig.assembly import ElasticModel, shaft_stiffness
from dynamics.elastic_rig.joints import ElasticJoint
from dynamics.elastic_rig.rotating_parts import (
    AxisMisalignment,
    FlangeRunOut,
    RotatingPart,
    ShaftBow,
    ShaftUnbalance,
    SpeedPower,
)

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class RotatingLoad:
    """Re(load exp(i theta)) on all freedoms (n,) [N], [N m] with the angle of a shaft.

    speed_power : 2 where it grows with the square of the speed of that shaft, per [rad2/s2]
    """

    shaft: str
    load: Complex
    speed_power: SpeedPower


def rotating_loads(model: ElasticModel) -> tuple[RotatingLoad, ...]:
    """Load of every rotating part of a rig, in its order; DrivetrainError for a coupling that does not resist."""
    return tuple(_rotating_load(model, part) for part in model.rig.rotating)


def line_loads(model: ElasticModel) -> dict[tuple[str, SpeedPower], Complex]:
    """Loads (n,) by shaft line, under the name of its first loaded shaft, and by power of the speed."""
    lines = model.rig.drivetrain.lines()
    first: dict[int, str] = {}
    found: dict[tuple[str, SpeedPower], Complex] = {}
    for load in rotating_loads(model):
        name = first.setdefault(lines[load.shaft], load.shaft)
        key = (name, load.speed_power)
        found[key] = found.get(key, 0.0) + load.load
    return found


def misalignment_load(model: ElasticModel, misalignments: tuple[AxisMisalignment, ...]) -> Array:
    """Standing load (n,) of axes out of line on both shafts of their couplings [N], [N m].

    Raises DrivetrainError for a coupling that does not resist the offset or angle.
    """
    total = np.zeros(model.size)
    for part in misalignments:
        joint = model.joint(part.coupling, "coupling")
        y, z, slope_y, slope_z = *part.offset, *part.slope
        total -= _joint_load(joint, {"u_y": y, "u_z": z, "theta_z": slope_y, "theta_y": -slope_z}).real
    return total


def _rotating_load(model: ElasticModel, part: RotatingPart) -> RotatingLoad:
    match part:
        case ShaftUnbalance():
            place = model.freedoms.on_shaft(part.shaft, part.position)
            across, up = place.rows(model.size)[1:3]
            force = part.moment * np.exp(1j * part.angle)
            turning = across - 1j * _sense(model, part.shaft) * up
            return RotatingLoad(shaft=part.shaft, load=force * turning, speed_power=2)
        case ShaftBow():
            load = shaft_stiffness(model, part.shaft) @ _bent(model, part)
            return RotatingLoad(shaft=part.shaft, load=np.asarray(load), speed_power=0)
        case FlangeRunOut():
            joint = model.joint(part.coupling, "coupling")
            coupling = next(one for one in model.rig.drivetrain.couplings if one.name == part.coupling)
            turn = -1j * _sense(model, coupling.shafts[0])
            offset = part.offset * np.exp(1j * part.offset_angle)
            slope = part.tilt * np.exp(1j * part.tilt_angle)
            gap = {"u_y": offset, "u_z": turn * offset, "theta_z": slope, "theta_y": -turn * slope}
            return RotatingLoad(shaft=coupling.shafts[0], load=-_joint_load(joint, gap), speed_power=0)


def _joint_load(joint: ElasticJoint, gap: dict[str, complex]) -> Complex:
    """Sum of loads of built-in offsets by direction; directions without an offset may be free."""
    loads = [value * joint.load(direction) for direction, value in gap.items() if value]
    return np.asarray(sum(loads, np.zeros(joint.rows.shape[1], complex)))


def _sense(model: ElasticModel, shaft: str) -> float:
    return float(np.sign(model.spins[shaft]))


def _bent(model: ElasticModel, bow: ShaftBow) -> Complex:
    """Shape (n,) of a bent shaft on all freedoms, complex amplitudes over its angle."""
    nodes = model.freedoms.nodes[bow.shaft]
    shaft = next(one for one in model.rig.drivetrain.shafts if one.name == bow.shaft)
    residual = bow.amplitude / bow.height * np.array([bow.shape(float(at)) for at in nodes.positions])
    thermal = bow.gradient * np.array(list(_curved(shaft, nodes.positions)))
    shape = residual * np.exp(1j * bow.angle) + thermal * np.exp(1j * bow.gradient_angle)
    ahead = model.rig.placement(bow.shaft).direction
    turn = -1j * _sense(model, bow.shaft)
    bent = np.zeros(model.size, complex)
    base = nodes.first + 6 * np.arange(nodes.positions.size)
    bent[base + 1], bent[base + 2] = shape[:, 0], turn * shape[:, 0]
    bent[base + 5], bent[base + 4] = ahead * shape[:, 1], -ahead * turn * shape[:, 1]
    return bent


def _curved(shaft: Shaft, positions: Array) -> Iterator[tuple[float, float]]:
    """Distance [m] and slope of the axis at positions (n,) from its left end, for a curvature of 1 / diameter."""
    height, slope = 0.0, 0.0
    yield height, slope
    for section, length in zip(element_sections(shaft, positions), np.diff(positions)):
        curvature = 1.0 / section.outer_diameter
        height += slope * length + 0.5 * curvature * length**2
        slope += curvature * length
        yield height, slope

"""Moments of a cross joint (Hooke's joint) on its shafts: how the torque that it passes under an angle bends them.

The cross turns freely about its arm a_1 in the yoke of the first shaft and about its arm a_2, square to it, in that of
the second, so that the moment from yoke to yoke stands on both arms: M n with n = a_1 x a_2. With the torque T_1 of the
first shaft along its axis e_1, M = T_1 / (n . e_1); what of M n is not along the axis bends a shaft. With the angle b
between the axes, w across e_1 in their plane towards e_2, u square to that plane, and a_1 at the angle theta from u,

    on the first shaft   -T_1 tan(b) cos(theta) (cos(theta) w - sin(theta) u)
    on the second shaft  -T_1 tan(b) sin(theta) (sin(theta) w + cos(theta) u), to the second power of b.

In the frame of a yoke this couple stands along one direction of it and swings once a turn with |T tan(b)|; bearings
stand still and see, with cos^2 and sin cos, half of it all the time, -T b/2 w on either shaft, and half of it turning
forward twice a turn, opposite on both shafts. There is no part once a turn: that would need arms that do not meet, or
axes that run out. The torque is the mean one of the coupling, its oscillation is left out (a product of two small
quantities); theta is zero with the angle of the first shaft, as in the torque twice a turn that the same kinematics
make (`rigdesign.rig.drivetrain`).

Source: H. C. Seherr-Thoss, F. Schmelz, E. Aucktor, Universal Joints and Driveshafts, 2nd ed. 2006, chapter 1, and R. M.
Rosenberg, J. Appl. Mech. 25, 1958, 47, from memory: neither text was at hand. The formulas are derived above and held
against the exact kinematics (`tests/verification/test_cross_joint_bending.py`).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.parts import Coupling
from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.rotating_parts import CrossJoint

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

WAVES = 2.0
"""Waves per turn of the first shaft."""


@dataclass(frozen=True)
class CrossJointLoad:
    """Loads on all freedoms (n,) per torque that the first shaft passes to the second along its rotation [-].

    standing : all the time; turning : Re(turning exp(2 i theta)) with the angle of the first shaft
    """

    coupling: str
    shaft: str
    standing: Array
    turning: Complex


def cross_joint_loads(model: ElasticModel) -> Iterator[CrossJointLoad]:
    """Of every cross joint of a rig under an angle."""
    for joint in model.rig.cross_joints:
        coupling = next(one for one in model.rig.drivetrain.couplings if one.name == joint.coupling)
        across, square = _directions(model, coupling, joint)
        first, second = (_tilts(model, coupling, side) for side in (0, 1))
        standing = -0.5 * across @ (first + second)
        turning = np.asarray(0.5 * (across + 1j * square) @ (second - first), np.complex128)
        yield CrossJointLoad(joint.coupling, coupling.shafts[0], standing, turning)


def tilt_rows(model: ElasticModel) -> Array:
    """(4 k, n) tilts of the shaft ends at k cross joints."""
    couplings = {one.name: one for one in model.rig.drivetrain.couplings}
    rows = [
        _tilts(model, couplings[joint.coupling], side) for joint in model.rig.cross_joints for side in (0, 1)
    ]
    return np.vstack([np.zeros((0, model.size)), *rows])


def standing_load(model: ElasticModel, torques: Mapping[str, float]) -> Array:
    """(n,) load of all cross joints all the time under the torques of their couplings [N m]."""
    loads = (torques[load.coupling] * load.standing for load in cross_joint_loads(model))
    return np.asarray(sum(loads, np.zeros(model.size)))


def bending_moment(joint: CrossJoint, sense: float, torque: float) -> Array:
    """(2,) moment about y and z that stands on either shaft under a torque along the rotation [N m].

    sense : of the rotation about x
    """
    return np.asarray(-0.5 * torque * _across(joint, sense))


def _across(joint: CrossJoint, sense: float) -> Array:
    """b w (2,) about y and z: e_2 - e_1 of axes s (1, slope) and s (1, 0, 0)."""
    return -sense * np.array(joint.slope)


def _directions(model: ElasticModel, coupling: Coupling, joint: CrossJoint) -> tuple[Array, Array]:
    """b w and b u (2,) in the plane (y, z); u = w x e_1."""
    sense = float(np.sign(model.spins[coupling.shafts[0]]))
    across = _across(joint, sense)
    return across, sense * np.array([across[1], -across[0]])


def _tilts(model: ElasticModel, coupling: Coupling, side: int) -> Array:
    """(2, n) tilt about y and z of the end of one shaft at the joint."""
    shaft = model.rig.drivetrain.shaft(coupling.shafts[side])
    position = 0.0 if coupling.ends[side] == "left" else shaft.length
    return model.freedoms.on_shaft(shaft.name, position).rows(model.size)[4:6]

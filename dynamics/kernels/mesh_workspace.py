"""Mesh workspace: the state of each mesh within a step of the march, one row of numbers.

It is a single flat array, ``space``, read at fixed offsets from the start of a row, so that the compiler keeps numbers
that were just written in registers. A last row belongs to the place holder for a mesh that does not exist.
"""

import numpy as np
from numpy.typing import NDArray

(
    APPROACH,  # without the imposed part, at the start of the step [m]
    ANGLE,  # of the pinion, at the start of the step [rad]
    OFFSET,  # imposed approach at the start of the step [m]
    OFFSET_RATE,
    REACH,  # approach and its rate at the end of the step, imposed ones included, moving with the torques
    RATE,
    AT_REACH,  # the same where the mesh was last looked at
    AT_RATE,
    TEETH,  # approach that the teeth see, where the mesh was last looked at, then at the end of the step [m]
    TEETH_OLD,  # the same at the end of the last step
    HELD_ANGLE,  # angle of the pinion at which the rows are held [rad]
    FRACTION,  # of the cell of the path there
    OFF,  # by how much the approach behind the bodies is off there [m]
    SHARE,  # part of a change of the reach that the teeth take there [-]
    LOW,  # range of the approach of the teeth in which the held rows are good [m]
    HIGH,
    GIVEN,  # part of the reach that bodies outside the table give, in this step and in the last [m]
    GIVEN_OLD,
    PRESSED,  # force of both flanks, and its derivatives over approach and rate
    PRESSED_X,
    PRESSED_V,
    NET,  # force to be recorded, front less back, and its derivatives
    NET_X,
    NET_V,
    FILTERED,  # force that acts in the march, front less back; its derivatives are those of NET
    BENT,  # what a Newton step leaves out of the torque: over approach twice, over approach and rate
    BENT_V,
    LOWER,  # shares of two levels of friction, and how far sliding reverses per sliding speed, of the sample
    UPPER,
    PER_SPEED,
    PATH_TORQUE,  # on the pinion by the change of the path and by dampers on it [N m]
    OTHER_FRONT,  # 1 where the flank in front, and on the back, is not on the normal of the ports, else 0
    OTHER_BACK,
    APART,  # by how much the gears stand closer on that flank, at the end of the step [m]
    APART_RATE,
    LEAN,  # turn of the pinion from the centre line beyond that of its port, at the end of the step [rad]
    LEAN_RATE,  # per step [rad]
    OTHER_PRESSED,  # its normal force [N], and friction torque on the pinion less that on the wheel [N m]
    OTHER_RUBBED,
    INVERSE,  # of the Newton matrix, four numbers
) = range(40)
# of both ports, the pinion's first and the wheel's PORT further
PORT = 11
(
    SPEED,  # at the end of the step [rad/s]
    TURN,  # in the step [rad]
    TURN_OLD,  # in the last step
    TAU,  # torque at the end of the step [N m], then one, two and three steps earlier
    OLD,
    OLDER,
    OLDEST,
    MISSING,  # torque that speed and turn do not hold yet
    REACTION,  # torque that the contacts answer where they were last looked at, and its derivatives
    TANGENT_X,
    TANGENT_V,
) = range(INVERSE + 4, INVERSE + 4 + PORT)
N_SPACE = INVERSE + 4 + 2 * PORT


def port_place(port: int) -> int:
    """Return the place of a port in the mesh workspace: port 2 m is the pinion of mesh m, 2 m + 1 its wheel."""
    return port // 2 * N_SPACE + port % 2 * PORT


# Arrays that begin with a cache line: what a kernel reads together then stands in one line, not in two.

Array = NDArray[np.float64]

LINE = 64
"""Bytes in a cache line."""


def aligned_zeros(count: int) -> Array:
    """Return ``count`` zeros."""
    room = np.zeros(count + LINE // 8)
    first = (-room.ctypes.data // 8) % (LINE // 8)
    return room[first : first + count]


def aligned(array: Array) -> Array:
    """Return a flat copy of an array."""
    copy = aligned_zeros(array.size)
    copy[:] = array.ravel()
    return copy

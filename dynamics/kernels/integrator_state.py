"""State of the gear meshes within a step of the time integration: one record a mesh, in it one a port.

The records stand in one structured array, from which the compiled loops read ``mesh.pinion.speed`` by name. A last
record belongs to the place holder for a mesh that does not exist.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels.contact import POSITIVE, inlined

Array = NDArray[np.float64]
Meshes = NDArray[np.void]
"""(n_meshes + 1,) of ``STEP``."""


class PortStep:
    """A port of a mesh, where its pinion or its wheel acts on its shaft."""

    speed: float
    """At the end of the step [rad/s]."""
    turn: float
    """In the step [rad]."""
    turn_old: float
    """In the last step."""
    torque: float
    """At the end of the step [N m], then one, two and three steps earlier."""
    torque_old: float
    torque_older: float
    torque_oldest: float
    missing: float
    """Torque that speed and turn do not hold yet."""
    reaction: float
    """Torque that the contacts answer where they were last looked at, then its derivatives over approach and rate."""
    reaction_x: float
    reaction_v: float


class MeshStep:
    """A mesh. Approaches are those of the gears, the imposed part included, unless said otherwise [m]."""

    approach: float
    """Without the imposed part, at the start of the step."""
    angle: float
    """Of the pinion, at the start of the step [rad]."""
    offset: float
    """Imposed approach at the start of the step."""
    offset_rate: float
    reach: float
    """Approach and its rate at the end of the step, moving with the torques."""
    rate: float
    reach_seen: float
    """The same where the mesh was last looked at."""
    rate_seen: float
    teeth: float
    """Approach that the teeth see, where the mesh was last looked at, then at the end of the step."""
    teeth_old: float
    """The same at the end of the last step."""
    table_angle: float
    """Angle of the pinion at which the table was looked up [rad]."""
    fraction: float
    """Of the cell of the path there."""
    off: float
    """By how much the approach behind the bodies is off there."""
    share: float
    """Part of a change of the reach that the teeth take there [-]."""
    low: float
    """Range of the approach of the teeth in which the rows that were looked up are good."""
    high: float
    given: float
    """Part of the reach that bodies outside the table give, in this step and in the last."""
    given_old: float
    force: float
    """Of both flanks, and its derivatives over approach and rate."""
    force_x: float
    force_v: float
    net: float
    """Force to be recorded, front less back, and its derivatives."""
    net_x: float
    net_v: float
    filtered: float
    """Force that acts, front less back; its derivatives are those of ``net``."""
    bent: float
    """What a Newton step leaves out of the torque: over approach twice, over approach and rate."""
    bent_v: float
    lower: float
    """Shares of two levels of friction, and how far sliding reverses per sliding speed, of the sample."""
    upper: float
    per_speed: float
    path_torque: float
    """On the pinion by the change of the path and by dampers on it [N m]."""
    other_front: float
    """1 where the flank in front, and on the back, is not on the normal of the ports, else 0."""
    other_back: float
    apart: float
    """By how much the gears stand closer on that flank, at the end of the step, and its rate."""
    apart_rate: float
    lean: float
    """Turn of the pinion from the centre line beyond that of its port, at the end of the step, and per step [rad]."""
    lean_rate: float
    other_force: float
    """Normal force of that flank [N], and its friction torque on the pinion less that on the wheel [N m]."""
    other_friction: float
    inverse_11: float
    """Inverse of the Newton matrix."""
    inverse_12: float
    inverse_21: float
    inverse_22: float
    pinion: PortStep
    wheel: PortStep


PORT: Any = np.dtype([(name, np.float64) for name in PortStep.__annotations__])
STEP: Any = np.dtype([
    (name, PORT if kind is PortStep else np.float64) for name, kind in MeshStep.__annotations__.items()
])  # fmt: skip


OLD, NEW, MISSING = range(3)
"""Torques of a port: at the start of the step, at its end, and what speed and turn do not hold yet of that."""

# Port 2 m is the pinion of mesh m, 2 m + 1 its wheel. A compiled function gives its caller a copy of a record, so that
# none of these returns one.


@inlined
def torque_at(meshes: Meshes, number: int, kind: int) -> float:
    """Return a torque of a port."""
    mesh: MeshStep = meshes[(number >> 1) & POSITIVE]
    port = mesh.wheel if number & 1 else mesh.pinion
    return port.torque_old if kind == OLD else port.torque if kind == NEW else port.missing


@inlined
def move_port(meshes: Meshes, number: int, speed: float, turn: float) -> None:
    """Add to speed and turn of a port."""
    mesh: MeshStep = meshes[(number >> 1) & POSITIVE]
    port = mesh.wheel if number & 1 else mesh.pinion
    port.speed += speed
    port.turn += turn


# Arrays that begin with a cache line: what a kernel reads together then stands in one line, not in two.

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

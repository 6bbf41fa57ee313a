"""What is watched through an event: torque of every shaft section, gear seat and coupling, forces of the bearings.

Each channel is a row, or two across a shaft, on angles and speeds of the freedoms of a drivetrain; so it can be read at
any instant of a march.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.twist_rows import TorqueSection, TwistRows
from dynamics.elastic_rig.running_state import RunningState
from dynamics.elastic_rig.seen_system import SeenRig
from dynamics.response.march_inputs import DriveState

Array = NDArray[np.float64]
ChannelKind = Literal["shaft", "spline", "coupling", "motor", "bearing", "journal velocity", "journal travel"]


@dataclass(frozen=True, kw_only=True)
class Channel:
    """A torque [N m], or the amount of a force [N] or velocity [m/s] across a shaft.

    place : section of the shaft as in tables, gear of a seat, name of coupling or bearing
    section : of a torque; its elements are channels of the same place
    angle, speed : (k, n) per angle [rad] and speed [rad/s] of the freedoms, k = 1 or 2; twist : per bracing twist
    """

    place: str
    kind: ChannelKind
    angle: Array
    speed: Array
    twist: float = 0.0
    section: TorqueSection | None = None


def torque_channels(rows: TwistRows) -> tuple[Channel, ...]:
    """Torques of all elements of the shafts and of the joints, on the freedoms of ``rows``."""
    return tuple(
        Channel(
            place=section.name if section.kind == "shaft" else section.part,
            kind=section.kind,
            angle=rows.stiffness[i] * rows.rows[i : i + 1],
            speed=rows.damping[i] * rows.rows[i : i + 1],
            twist=float(-rows.stiffness[i] * rows.bracing[i]),
            section=section,
        )
        for i, section in enumerate(rows.sections)
    )


def bearing_channels(seen: SeenRig, system: LinearSystem, state: RunningState) -> tuple[Channel, ...]:
    """Force on every bearing, and velocity of every journal against its seat.

    system : of ``seen`` at this running state. The force of a film is its tangent times the displacement by the
    meshes; the weight of the shafts is left out.
    """
    zero = np.zeros((2, len(system.inertia)))
    found = []
    for name, coefficients in state.bearings.items():
        stiffness, damping = coefficients.padded()
        rows = seen.on_freedoms(seen.reduced.model.ports[name])
        found.append(
            Channel(place=name, kind="bearing", angle=stiffness[:2] @ rows, speed=damping[:2] @ rows)
        )
        found.append(Channel(place=name, kind="journal velocity", angle=zero, speed=rows[:2]))
    return tuple(found)


class Watched:
    """Channels of a march, read together."""

    def __init__(self, channels: tuple[Channel, ...]) -> None:
        """Stack the rows of channels of one system."""
        self.channels = channels
        self._angle = np.vstack([channel.angle for channel in channels])
        self._speed = np.vstack([channel.speed for channel in channels])
        sizes = [len(channel.angle) for channel in channels]
        self._first = np.concatenate([[0], np.cumsum(sizes)])[:-1]
        self._pairs = np.array(sizes) == 2
        self._twist = np.zeros(len(self._angle))
        self._twist[self._first] = [channel.twist for channel in channels]

    def read(self, state: DriveState) -> Array:
        """(n_channels,) values at a state: torques with their sign, amounts of forces and velocities."""
        values = self._angle @ state.angles + self._speed @ state.speeds + self._twist * state.twist
        first = values[self._first]
        second = values[np.minimum(self._first + 1, len(values) - 1)]
        return np.asarray(np.where(self._pairs, np.hypot(first, second), first))

    def index(self, place: str, kind: ChannelKind) -> int:
        """Number of a channel; KeyError if there is none."""
        for i, channel in enumerate(self.channels):
            if (channel.place, channel.kind) == (place, kind):
                return i
        raise KeyError(f"{kind} {place}")

"""What is watched through an event: torque of every shaft section and coupling, forces of the bearings.

Each channel is a row, or two across a shaft, on angles and speeds of the freedoms of a drivetrain; so it can be read at
any instant of a march.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.graph import Drivetrain, joints
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.shaft import discretise, element_sections
from dynamics.elastic_rig.beam import elements_of, stiffness_matrices
from dynamics.elastic_rig.running_state import RunningState
from dynamics.elastic_rig.seen_system import SeenRig
from dynamics.response.march_inputs import DriveState

Array = NDArray[np.float64]
ChannelKind = Literal["shaft", "coupling", "bearing", "journal velocity"]


@dataclass(frozen=True, kw_only=True)
class Channel:
    """A torque [N m], or the amount of a force [N] or velocity [m/s] across a shaft.

    place : ``shaft 12.5 mm`` (middle of the element from the left end), name of coupling or bearing
    angle, speed : (k, n) per angle [rad] and speed [rad/s] of the freedoms, k = 1 or 2; twist : per bracing twist
    """

    place: str
    kind: ChannelKind
    angle: Array
    speed: Array
    twist: float = 0.0


def torsional_channels(drivetrain: Drivetrain, system: LinearSystem) -> tuple[Channel, ...]:
    """Torques of all elements of the shafts and of the couplings; the system is ``assemble`` of the drivetrain."""
    n, found, count = len(system.inertia), [], dict.fromkeys((s.name for s in drivetrain.shafts), 0)
    names = {shaft.name: _element_names(drivetrain, shaft.name) for shaft in drivetrain.shafts}
    for joint in joints(drivetrain):
        if joint.kind not in ("shaft", "coupling"):
            continue
        row = np.zeros((1, n))
        row[0, joint.dof_a], row[0, joint.dof_b] = 1.0, -1.0
        braced = joint.kind == "coupling" and joint.name == drivetrain.bracing_coupling
        place = joint.name
        if joint.kind == "shaft":
            place = names[joint.name][count[joint.name]]
            count[joint.name] += 1
        found.append(
            Channel(
                place=place,
                kind="shaft" if joint.kind == "shaft" else "coupling",
                angle=joint.stiffness * row,
                speed=joint.damping * row,
                twist=-joint.stiffness if braced else 0.0,
            )
        )
    return tuple(found)


def elastic_channels(seen: SeenRig, system: LinearSystem, state: RunningState) -> tuple[Channel, ...]:
    """Torques as of the torsional rig, force on every bearing, and velocity of every journal against its seat.

    system : of ``seen`` at this running state. The force of a film is its tangent times the displacement by the
    meshes; the weight of the shafts is left out.
    """
    model = seen.reduced.model
    back = np.linalg.inv(system.coordinates.freedoms)

    def own(rows: Array) -> Array:
        return np.asarray(seen.reduced.rows(np.atleast_2d(rows)) @ back)

    found = [*_beams(seen, own)]
    for joint in model.joints:
        if joint.kind == "coupling" and "turn" in joint.directions:
            turn = joint.directions.index("turn")
            braced = joint.name == model.rig.drivetrain.bracing_coupling
            found.append(
                Channel(
                    place=joint.name,
                    kind="coupling",
                    angle=own(joint.load("turn")),
                    speed=own(joint.damping[turn] @ joint.rows),
                    twist=-float(joint.stiffness[turn, turn]) if braced else 0.0,
                )
            )
    for name, coefficients in state.bearings.items():
        stiffness, damping = coefficients.padded()
        rows = own(model.ports[name])
        zero = np.zeros((2, len(system.inertia)))
        found.append(
            Channel(place=name, kind="bearing", angle=stiffness[:2] @ rows, speed=damping[:2] @ rows)
        )
        found.append(Channel(place=name, kind="journal velocity", angle=zero, speed=rows[:2]))
    return tuple(found)


def _beams(seen: SeenRig, own: Callable[[Array], Array]) -> Iterator[Channel]:
    rig = seen.reduced.model.rig
    for shaft in rig.drivetrain.shafts:
        nodes = seen.reduced.model.freedoms.nodes[shaft.name]
        elements = elements_of(
            shaft, np.diff(nodes.positions), element_sections(shaft, nodes.positions), rig.shear, rig.torsional_inertia
        )  # fmt: skip
        springs = stiffness_matrices(elements)[:, 3, 3]
        rows = np.zeros((len(nodes.positions), seen.reduced.model.size))
        rows[np.arange(len(rows)), nodes.first + 3 + 6 * np.arange(len(rows))] = 1.0
        turns = own(rows)
        for i, spring in enumerate(springs):
            row = float(spring) * (turns[i] - turns[i + 1])[None, :]
            yield Channel(
                place=_named(shaft.name, nodes.positions[i], nodes.positions[i + 1]),
                kind="shaft",
                angle=row,
                speed=shaft.damping_time * row,
            )


def _element_names(drivetrain: Drivetrain, shaft: str) -> list[str]:
    places = [(part.shaft, part.position) for part in drivetrain.gears]
    places += [(part.shaft, part.position) for part in drivetrain.bearings]
    places += [(part.shaft, part.position) for part in drivetrain.drag_places]
    places.append((drivetrain.motor.shaft, drivetrain.motor.position))
    stations = tuple(position for own, position in places if own == shaft)
    positions = discretise(drivetrain.shaft(shaft), stations).positions
    return [_named(shaft, a, b) for a, b in pairwise(positions)]


def _named(shaft: str, start: float, end: float) -> str:
    return f"{shaft} {500.0 * (start + end):.1f} mm"


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

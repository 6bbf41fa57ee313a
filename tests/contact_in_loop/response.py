"""Steady response with the tooth contact in the loop: a march until the factors of the meshes stay as they are.

The twist of the bracing is held; motor torque and speed are corrected from window to window. A step is a whole part of
the shortest mesh period: what is faster than the steps then falls on harmonics of the mesh, and not between them, where
it would beat with the mesh and find other modes of the drivetrain.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.vibration.initial_state import pinion_ratios, wound_state
from dynamics.vibration.steady_motion import HeldSpeed
from tests.contact_in_loop.loop import ContactLoop, LoopRecord, MeshInLoop

Array = NDArray[np.float64]

LEAST_STEPS = 16
"""In the shortest mesh period."""
LONGEST_STEP = 4e-6
"""[s]; the factors of the prototype at 3000 rpm are 1e-3 from those of ever shorter steps."""
WINDOW, WINDOW_PERIODS = 0.03, 40
"""Time [s] and periods of the slowest mesh over which factors are taken, the longer of the two."""
STEADY_SPEED = 1e-4
"""Distance of the mean speed from the one asked for, over that, with which it is held [-]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LoopedProblem:
    """A drivetrain whose steady response is sought with the contact in the loop.

    system : without its meshes; rows : as of `ContactLoop`; meshes : in the order of the rows
    speed : of the pinion of the first mesh [rad/s]; twist : of the bracing, held [rad]
    drive_torque : of the motor, first guess [N m]; drag_torques : by name of ``system.drag_loads`` [N m]
    cutoff : highest mode that is followed [Hz]
    """

    system: LinearSystem
    rows: Array = field(repr=False)
    meshes: Sequence[MeshInLoop]
    speed: float
    twist: float
    drive_torque: float
    drag_torques: Mapping[str, float]
    cutoff: float

    def __post_init__(self) -> None:
        if not self.speed > 0.0:
            raise DynamicsInputError(
                f"contact in the loop: speed = {self.speed} rad/s must be above 0; leave standstill to the static state"
            )

    @property
    def mesh_periods(self) -> Array:
        """(n_meshes,) [s]."""
        ratios = pinion_ratios(self.system, [mesh.law for mesh in self.meshes])
        speeds = self.speed * ratios[self.system.mesh_ports[:, 0]]
        teeth = np.array([mesh.law.teeth_1 for mesh in self.meshes])
        return np.asarray(2.0 * np.pi / (teeth * np.abs(speeds)))


@dataclass(frozen=True, kw_only=True)
class LoopedResponse:
    """Motion of the meshes in the last window, (n_meshes,) each; forces along the line of action.

    speed : mean, of the pinion of the first mesh [rad/s]
    dynamic_factor, least_share : largest and least net force over the mean [-]
    mean_force : of the flanks that carry, less that of the others [N]
    other_flank : largest force of the flanks that do not carry, over the mean [-]; apart : share of the time without
        contact [-]
    tilt : of the gears against each other about the mean, peak to peak [rad]
    change : of the factors that is still to come, estimated from the last windows [-]; settled : within the tolerance
    time : marched [s]; steps, unconverged : in all, and those whose contacts were not solved to their tolerance
    """

    speed: float
    dynamic_factor: Array
    least_share: Array
    mean_force: Array
    other_flank: Array
    apart: Array
    tilt: Array
    change: Array
    settled: bool
    time: float
    steps: int
    unconverged: int


def looped_response(
    problem: LoopedProblem, *, tolerance: float = 1e-3, longest: float = 0.6
) -> LoopedResponse:
    """March from uniform rotation until the factors stay.

    tolerance : change of the factors that is still to come with which the march ends [-]
    longest : time after which it ends in any case [s]; ``settled`` tells

    Raises
    ------
    DynamicsInputError
        As `ContactLoop` and `wound_state`.
    DynamicsNotConverged
        No static state is found, or the motion leaves the finite numbers.
    """
    laws = [mesh.law for mesh in problem.meshes]
    wound = wound_state(
        problem.system, laws, problem.speed, LoopLoad(twist=problem.twist), problem.drag_torques
    )
    periods = problem.mesh_periods
    per_mesh = max(LEAST_STEPS, math.ceil(float(periods.min()) / LONGEST_STEP))
    step = float(periods.min()) / per_mesh
    loop = ContactLoop(
        problem.system, problem.rows, problem.meshes, wound, step=step, cutoff=problem.cutoff,
        drag_torques=problem.drag_torques,
    )  # fmt: skip
    count = math.ceil(max(WINDOW, WINDOW_PERIODS * float(periods.max())) / step)
    held, windows, drive = HeldSpeed(problem.system, laws, problem.speed), _Windows(), problem.drive_torque
    while True:
        record = loop.advance(count, drive)
        windows.add(record)
        speed, time = float(record.speed[0].mean()), windows.count * count * step
        steady = abs(speed - problem.speed) <= STEADY_SPEED * problem.speed
        settled = steady and bool(np.all(windows.to_come <= tolerance))
        if settled or time + count * step > longest:
            break
        change = held.correction(speed, count * step)
        loop.kick(change.kick)
        drive += change.drive_torque
    return LoopedResponse(
        speed=speed, **_in_motion(record), change=windows.to_come, settled=settled, time=time,
        steps=windows.count * count, unconverged=loop.unconverged,
    )  # fmt: skip


class _Windows:
    """Factors of the meshes from window to window, and how far they still are from where they go."""

    def __init__(self) -> None:
        self.count = 0
        self._factors: list[Array] = []

    def add(self, record: LoopRecord) -> None:
        force = record.net_force
        self.count += 1
        self._factors = [*self._factors[-2:], force.max(axis=1) / force.mean(axis=1)]

    @property
    def to_come(self) -> Array:
        """(n_meshes,) rest of a geometric series of changes, the last change at least."""
        if len(self._factors) < 3:
            return np.full(len(self._factors[0]), np.inf)
        first, second, last = self._factors
        change, before = np.abs(last - second), np.abs(second - first)
        ratio = np.minimum(change / np.maximum(before, 1e-12), 0.9)
        return np.asarray(change * np.maximum(1.0, ratio / (1.0 - ratio)))


def _in_motion(record: LoopRecord) -> dict[str, Array]:
    """What `LoopedResponse` takes from a window."""
    force = record.net_force
    mean = force.mean(axis=1)
    return {
        "dynamic_factor": force.max(axis=1) / mean,
        "least_share": force.min(axis=1) / mean,
        "mean_force": mean,
        "other_flank": record.other_force.max(axis=1) / mean,
        "apart": ((record.force == 0.0) & (record.other_force == 0.0)).mean(axis=1),
        "tilt": np.ptp(record.tilt, axis=1),
    }

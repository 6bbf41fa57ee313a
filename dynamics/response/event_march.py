"""March through an event: teeth lost at an instant, the motor off and the brake on, what parts of the rig feel.

It starts from the steady state at a speed and torque, with the twist of the bracing held: nothing that braces follows
within the milliseconds of an event. Loads that alternate with a shaft act before and after it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.errors import DynamicsInputError
from dynamics.mesh.law import MeshLaw
from dynamics.response.event_channels import Watched
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.march_inputs import DriveLoads
from dynamics.response.march_loads import march_model
from dynamics.response.modal_model import DEFAULT_CUTOFF
from dynamics.response.steady_start import SAMPLE_RATE, SteadyStart, constant_drags, march_settings
from dynamics.response.time_march import TimeMarch
from dynamics.response.tooth_loss import Member, teeth_in_mesh
from dynamics.response.turning_loads import TurningLoads, acting

Array = NDArray[np.float64]

BEFORE = 0.03
"""Time before the event over which means are taken at most, beyond a mesh period [s]."""


@dataclass(frozen=True, kw_only=True)
class Brake:
    """Torque against the rotation on the motor, reached in a straight ramp.

    torque : [N m]; onset : [s]
    """

    torque: float
    onset: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Trip:
    """What stops the rig: the first crossing of a limit by the amount of a channel, then a delay [s], then the brake.

    channel : its number; None stops at once. limit : [N m] or [m/s]
    """

    channel: int | None
    limit: float = 0.0
    delay: float = 0.0

    def crossed(self, values: Array) -> bool:
        """Whether values of all channels (n_channels,) trip it."""
        return self.channel is None or abs(float(values[self.channel])) > self.limit


@dataclass(frozen=True, kw_only=True)
class EventHistory:
    """Samples from the instant of the event on, n of them.

    time : (n,) [s]; speed : (n,) of the first pinion [rad/s]; drive : (n,) motor torque [N m]
    least, greatest : (n_meshes, n) torque at the pinion in every sample, positive on its front flank [N m]
    values : (n_channels, n); before : (n_channels,) mean over a mesh period before the event, over a turn of the first
        pinion, ``BEFORE`` [s] at most, where loads alternate with a shaft
    before_torque : (n_meshes,) mean then; open_share : (n_meshes,) share of the time without contact
    tripped : first crossing of the limit [s], None without one; braked : begin of the brake [s], None
    """

    time: Array
    speed: Array
    drive: Array
    least: Array
    greatest: Array
    values: Array
    before: Array
    before_torque: Array
    open_share: Array
    tripped: float | None
    braked: float | None


class EventMarch:
    """Marches of one drivetrain from one steady state through events."""

    def __init__(
        self,
        system: LinearSystem,
        laws: Sequence[MeshLaw],
        start: SteadyStart,
        watched: Watched,
        cutoff: float = DEFAULT_CUTOFF,
    ) -> None:
        """Prepare; the channels are of the same system."""
        self._system, self._laws, self._start, self._watched = system, tuple(laws), start, watched
        self._model = march_model(system, laws, tuple(start.drags), cutoff)
        self._cutoff = cutoff
        self._turning = TurningLoads(system)

    def run(
        self,
        duration: float,
        *,
        laws: Sequence[MeshLaw] | None = None,
        trip: Trip | None = None,
        brake: Brake | None = None,
    ) -> EventHistory:
        """March on.

        duration : [s]; laws : of the meshes from the instant of the event on; trip : nothing stops without one
        brake : that the trip sets off; without one the motor torque goes to zero

        Raises DynamicsInputError for a duration that is not positive; DynamicsNotConverged if the march diverges.
        """
        if not duration > 0.0:
            raise DynamicsInputError(f"event: duration = {duration} s: must be above 0")
        before = self._marched(self._laws, self._period(), None, None)
        after = self._marched(tuple(laws or self._laws), duration, trip, brake or Brake(torque=0.0))
        return EventHistory(
            **after,
            before=before["values"].mean(axis=1),
            before_torque=0.5 * (before["least"] + before["greatest"]).mean(axis=1),
        )

    def carrying_teeth(self, mesh: int, member: Member, count: int) -> tuple[int, ...]:
        """Adjacent teeth of a gear from the one that carries most at the instant of the event on."""
        law, (pinion, wheel) = self._laws[mesh], self._start.state.angles[self._system.mesh_ports[mesh]]
        approach = law.base_radius_1 * pinion - law.base_radius_2 * wheel + law.offset
        return teeth_in_mesh(law, float(pinion), float(approach), member, count)

    def _period(self) -> float:
        """Time before the event over which means are taken [s]."""
        turn, teeth = float(2.0 * np.pi / self._start.speed), self._laws[0].teeth_1
        whole = int(BEFORE / turn * teeth) if acting(self._system.periodic_loads) else 1
        return turn / teeth * min(max(whole, 1), teeth)

    def _marched(
        self, laws: tuple[MeshLaw, ...], duration: float, trip: Trip | None, brake: Brake | None
    ) -> dict[str, Any]:
        start, watched, turning = self._start, self._watched, self._turning
        speeds = turning.speeds(start.state.speeds)
        angles = start.angle * pinion_ratios(self._system, laws)[turning.dofs]
        march = TimeMarch(
            self._system,
            laws,
            start.state,
            march_settings(self._cutoff),
            DriveLoads(
                drive_torque=start.drive_torque,
                drag_torques=start.drags,
                periodic=turning.values(angles, speeds),
            ),
            self._model,
        )
        tables = constant_drags(start.drags)
        n = max(2, round(duration * SAMPLE_RATE))
        radius = np.array([law.base_radius_1 for law in laws])
        values, speed, drive = np.empty((len(watched.channels), n)), np.empty(n), np.empty(n)
        least, greatest = np.empty((len(laws), n)), np.empty((len(laws), n))
        still = np.zeros(len(laws))
        tripped: float | None = 0.0 if trip is not None and trip.channel is None else None
        first = self._system.mesh_ports[0, 0]
        for i in range(n):
            now = (i + 1) / SAMPLE_RATE
            drive[i] = start.drive_torque
            if tripped is not None and trip is not None and brake is not None:
                since = now - tripped - trip.delay
                share = float(np.clip(since / brake.onset, 0.0, 1.0)) if brake.onset else float(since >= 0.0)
                drive[i] += share * (-brake.torque - start.drive_torque)
            angles = angles + speeds / SAMPLE_RATE
            given = np.concatenate(([drive[i], start.state.twist, 0.0, 0.0], turning.values(angles, speeds)))[
                None
            ]
            block = march.advance(given, drags=tables)
            state = march.state()
            speeds = turning.speeds(state.speeds)
            values[:, i], speed[i] = watched.read(state), state.speeds[first]
            torque = radius[:, None] * block.force
            least[:, i], greatest[:, i] = torque.min(axis=1), torque.max(axis=1)
            still += (block.force == 0.0).mean(axis=1)
            if tripped is None and trip is not None and trip.crossed(values[:, i]):
                tripped = now
        braked = None if tripped is None or trip is None else tripped + trip.delay
        return {
            "time": np.arange(1, n + 1) / SAMPLE_RATE, "speed": speed, "drive": drive, "least": least,
            "greatest": greatest, "values": values, "open_share": still / n, "tripped": tripped, "braked": braked,
        }  # fmt: skip


def time_to_standstill(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    brake: Brake,
    drag: Callable[[float], float],
) -> float:
    """Time in which the rig comes to rest [s], as a rigid rotation.

    Enough for the time: brake and drags act for seconds on the momentum of the lines, in which vibration leaves no
    trace but the power of its damping. Not for forces on the way: what the rig feels as it passes its resonances while
    it slows down is that of a ``run_down`` stage of the time run.

    speed : of the drive freedom [rad/s]; drag : torque on that freedom of all losses at a speed of it [N m]

    Raises DynamicsInputError where nothing brakes.
    """
    ratios = pinion_ratios(system, laws)
    inertia = float(ratios @ system.inertia @ ratios) / float(ratios[system.drive_dof]) ** 2
    at = np.linspace(speed, 0.0, 401)
    torque = np.array([brake.torque + drag(float(value)) for value in at])
    if torque.min() <= 0.0:
        raise DynamicsInputError(
            f"event: {torque.min():.3g} N m brake the rig at {at[int(torque.argmin())]:.3g} rad/s: must be above 0; "
            "give a brake torque"
        )
    # half of the ramp of the brake acts
    return float(cumulative_trapezoid(inertia / torque, -at)[-1]) + 0.5 * brake.onset

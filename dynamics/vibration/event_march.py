"""March through an event: teeth lost at an instant, the motor off and the brake on, what parts of the rig feel.

It starts from the steady state at a speed and torque, with the twist of the bracing held: nothing that braces follows
within the milliseconds of an event. Loads that alternate with a shaft act before and after it.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from dynamics.errors import DynamicsInputError
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.craig_bampton import SeenRig
from dynamics.rotor.graph import TorqueSection, TwistRows
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import left_out, within_period
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw, back_deviations
from dynamics.tooth.mesh_force import tooth_forces
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.march_inputs import (
    DragTables,
    DriveLoads,
    DriveState,
    MarchSettings,
    TurningLoads,
    acting,
    march_model,
)
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from dynamics.vibration.steady_motion import (
    DEFAULT_TIME,
    HeldSpeed,
    Period,
    TimeSettings,
    period_length,
    periodic_by_time,
)
from dynamics.vibration.time_integration import TimeMarch

# Steady state from which an event starts, with all loads that alternate with a shaft.
#
# A periodic state holds those of them that have whole waves in its period. The others, as an unbalance of the wheel
# where the period is a turn of the pinion, come up afterwards while the rig turns on at constant speed.

SAMPLE_RATE, SUBSTEPS = 80e3, 4
"""Samples of the channels per second, and internal steps in one."""
RISE, RISE_TURNS = 0.1, 2.0
"""Time [s] and turns of the first pinion in which loads come up, the longer of the two."""
BLOCKS = 4
"""Length of the settling, in those of the rise; the mean speed is held from one to the next."""


@dataclass(frozen=True, kw_only=True)
class SteadyStart:
    """Steady state before an event: state, motor torque [N m], drag torques by name [N m].

    speed : of the first pinion [rad/s]; angle : of the first pinion [rad], by which loads that alternate stand
    period : in which the state was sought
    settled : names and orders of loads that no whole number of waves fits into that period: they came up during the
        ``settling`` [s] after it, and stand at the event as they happen to
    doubts : why it is not steady; empty where it is
    """

    speed: float
    state: DriveState
    drive_torque: float
    drags: Mapping[str, float]
    angle: float
    period: Period = "mesh"
    settled: tuple[str, ...] = ()
    settling: float = 0.0
    doubts: tuple[str, ...] = ()


def steady_start(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    torque: float,
    drags: Mapping[str, float],
    settings: TimeSettings = DEFAULT_TIME,
) -> SteadyStart:
    """Steady state at a speed of the first pinion [rad/s] and a torque of the first mesh [N m], by time integration.

    The period of the settings is taken for a turn of the first pinion where it is that of a mesh and loads alternate
    with a shaft.

    Raises DynamicsInputError and DynamicsNotConverged as `TimeIntegration.periodic`.
    """
    period = _period(system, laws, settings.period)
    response = periodic_by_time(
        system, laws, speed, LoopLoad(torque=torque), drags, replace(settings, period=period)
    )
    start = SteadyStart(
        speed=speed,
        state=response.end,
        drive_torque=response.drive_torque,
        drags=dict(drags),
        angle=float(response.end.angles[system.mesh_ports[0, 0]]),
        period=period,
        doubts=() if response.steady else tuple(response.warnings),
    )
    missing = _left_out(system, laws, period)
    return _settled(system, laws, start, missing, settings.cutoff) if missing else start


def march_settings(cutoff: float) -> MarchSettings:
    """Steps of an event."""
    return MarchSettings(
        step=1.0 / SAMPLE_RATE / SUBSTEPS, substeps=SUBSTEPS, cutoff=cutoff, accounts=False, record_all=False
    )


def constant_drags(drags: Mapping[str, float]) -> DragTables:
    """Drag torques [N m] that do not follow the speed."""
    return DragTables(torque=np.array([[value, value] for value in drags.values()]).reshape(len(drags), 2))


def _period(system: LinearSystem, laws: Sequence[MeshLaw], asked: Period) -> Period:
    if asked != "mesh" or not acting(system.periodic_loads):
        return asked
    try:
        _turns(system, laws, "revolution")
    except DynamicsInputError:
        return asked
    return "revolution"


def _turns(system: LinearSystem, laws: Sequence[MeshLaw], period: Period) -> float:
    ratios = pinion_ratios(system, laws)
    return period_length(laws, [ratios[pinion] for pinion in system.mesh_ports[:, 0]], period)


def _left_out(system: LinearSystem, laws: Sequence[MeshLaw], period: Period) -> tuple[str, ...]:
    loads = acting(system.periodic_loads)
    if not loads:
        return ()
    return tuple(left_out(loads, pinion_ratios(system, laws), _turns(system, laws, period)))


def _settled(
    system: LinearSystem, laws: Sequence[MeshLaw], start: SteadyStart, missing: tuple[str, ...], cutoff: float
) -> SteadyStart:
    """March on with constant motor torque and twist while the missing loads come up; the mean speed is held."""
    steady = HeldSpeed(system, laws, start.speed)
    ratios = steady.ratios
    kept, rising = _parted(system, laws, start.period)
    turn = 2.0 * np.pi / start.speed
    rise = turn * np.ceil(max(RISE / turn, RISE_TURNS))
    count = round(rise * SAMPLE_RATE)
    angles, speeds = start.angle * ratios[kept.dofs], start.speed * ratios[kept.dofs]
    drive = start.drive_torque
    march = TimeMarch(
        system,
        laws,
        start.state,
        march_settings(cutoff),
        DriveLoads(drive_torque=drive, drag_torques=start.drags, periodic=kept.values(angles, speeds)),
        march_model(system, laws, tuple(start.drags), cutoff),
    )
    for block in range(BLOCKS):
        time = (block * count + 1 + np.arange(count)) / SAMPLE_RATE
        phi = angles + time[:, None] * speeds
        share = np.minimum(time / rise, 1.0)[:, None]
        given = np.zeros((count, 4 + len(system.periodic_loads)))
        given[:, 0], given[:, 1] = drive, start.state.twist
        given[:, 4:] = kept.values(phi, speeds) + share**2 * (3.0 - 2.0 * share) * rising.values(phi, speeds)
        turned = march.advance(given, drags=constant_drags(start.drags)).slow_speed[:, 0]
        mean = float(turned.mean() / ratios[system.drive_dof])
        change = steady.correction(mean, rise)
        march.kick(change.kick)
        drive += change.drive_torque
    duration = BLOCKS * count / SAMPLE_RATE
    return replace(
        start,
        state=march.state(),
        drive_torque=drive,
        angle=start.angle + start.speed * duration,
        settled=missing,
        settling=duration,
    )


def _parted(
    system: LinearSystem, laws: Sequence[MeshLaw], period: Period
) -> tuple[TurningLoads, TurningLoads]:
    """The loads of a system with the orders that a period holds alone, and with the others alone."""
    loads = system.periodic_loads
    within = within_period(loads, pinion_ratios(system, laws), _turns(system, laws, period))
    rest = [
        replace(load, parts=tuple(part for part in load.parts if part not in kept.parts))
        for load, kept in zip(loads, within)
    ]
    return TurningLoads(system, within), TurningLoads(system, rest)


# A gear that has lost teeth: where they stood, nothing touches, on either flank.
#
# A lost tooth is one whose flanks stand back by more than the gears can approach each other; all other teeth keep their
# law. Which teeth carry at an instant follows from the angle of the pinion.

Member = Literal["pinion", "wheel"]

GONE = 0.05
"""Gap of a tooth that is not there [m]: beyond what a loop unwinds by."""


def teeth_in_mesh(law: MeshLaw, angle: float, approach: float, member: Member, count: int) -> tuple[int, ...]:
    """Numbers of adjacent teeth of a gear: the one that carries most, then those that come next.

    angle : of the pinion [rad]; approach : of the gears [m]

    Raises DynamicsInputError where no tooth carries.
    """
    forces = tooth_forces(law, angle, approach)
    front, back = forces.front[0].sum(axis=1), forces.back[0].sum(axis=1)
    force, behind = (back, 1) if back.sum() > front.sum() else (front, 0)
    if not force.max() > 0.0:
        raise DynamicsInputError(
            f"approach = {approach:.3g} m: no tooth carries; load the mesh before one is lost"
        )
    first = int(forces.pair[0, int(force.argmax())])
    pairs = range(first, first + count)
    if member == "pinion":
        return tuple(pair % law.teeth_1 for pair in pairs)
    return tuple((pair + law.tooth_offset_2 + behind) % law.teeth_2 for pair in pairs)


def without_teeth(law: MeshLaw, member: Member, teeth: tuple[int, ...]) -> MeshLaw:
    """The law of a mesh one of whose gears has lost teeth.

    Raises DynamicsInputError for no teeth, or so many that the gears cannot roll on.
    """
    number = law.teeth_1 if member == "pinion" else law.teeth_2
    if not 0 < len(set(teeth)) < number:
        raise DynamicsInputError(f"lost teeth {teeth}: must be from 1 to {number - 1} of {number}")
    front = law.deviation_1 if member == "pinion" else law.deviation_2
    back = back_deviations(law)[member == "wheel"]
    gaps = []
    for deviation in (front, back):
        gap = np.tile(deviation, (number, 1)) if len(deviation) == 1 else deviation.copy()
        gap[[tooth % number for tooth in teeth]] += GONE
        gaps.append(gap)
    other = law.deviation_2 if member == "pinion" else law.deviation_1
    other_back = back_deviations(law)[member == "pinion"]
    if member == "pinion":
        return law._replace(
            deviation_1=gaps[0], back_deviation_1=gaps[1], deviation_2=other, back_deviation_2=other_back
        )
    return law._replace(
        deviation_1=other, back_deviation_1=other_back, deviation_2=gaps[0], back_deviation_2=gaps[1]
    )


Array = NDArray[np.float64]


# What is watched through an event: torque of every shaft section, gear seat and coupling, forces of the bearings.
#
# Each channel is a row, or two across a shaft, on angles and speeds of the freedoms of a drivetrain; so it can be read
# at any instant of a march.

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
    channels = []
    for name, coefficients in state.bearings.items():
        stiffness, damping = coefficients.padded()
        rows = seen.on_freedoms(seen.reduced.model.ports[name])
        channels.append(
            Channel(place=name, kind="bearing", angle=stiffness[:2] @ rows, speed=damping[:2] @ rows)
        )
        channels.append(Channel(place=name, kind="journal velocity", angle=zero, speed=rows[:2]))
    return tuple(channels)


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
            time = (i + 1) / SAMPLE_RATE
            drive[i] = start.drive_torque
            if tripped is not None and trip is not None and brake is not None:
                since = time - tripped - trip.delay
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
                tripped = time
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
    speeds = np.linspace(speed, 0.0, 401)
    torque = np.array([brake.torque + drag(float(value)) for value in speeds])
    if torque.min() <= 0.0:
        raise DynamicsInputError(
            f"event: {torque.min():.3g} N m brake the rig at {speeds[int(torque.argmin())]:.3g} rad/s: must be above "
            "0; give a brake torque"
        )
    # half of the ramp of the brake acts
    return float(cumulative_trapezoid(inertia / torque, -speeds)[-1]) + 0.5 * brake.onset

"""Periodic response by time integration: run at constant mean speed until nothing changes from block to
block.

The mean speed is held without a controller in the loop: after each block of periods the motor torque is
corrected by the momentum that was gained or lost, and the small error of the mean speed is taken out of the
rigid motion.
At the end motor torque times speed is what the drivetrain loses, known from momentum alone. The bracing
twist is corrected in the same way until the first mesh carries the asked mean torque.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, gcd, lcm, pi
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import within_period
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.initial_state import WoundLoop, pinion_ratios, wound_state
from dynamics.vibration.march_inputs import DragTables, DriveLoads, DriveState, MarchSettings, march_model
from dynamics.vibration.modal_model import DEFAULT_CUTOFF, ModalModel
from dynamics.vibration.time_integration import Block, TimeMarch

Array = NDArray[np.float64]


# What kind of steady motion a march shows: of the mesh period, of several of them, modulated or chaotic.
#
# A motion that repeats after n periods of its excitation is subharmonic of order n. One that never repeats is chaotic
# if two marches from nearly the same state part exponentially (largest Lyapunov exponent by neighbouring trajectories:
# Benettin et al., Meccanica 15 (1980) 9), else it has a second frequency of its own and is quasi-periodic. One that
# swings so slowly that neighbouring periods look alike shows in the extremes of a longer time. Both are known of gear
# pairs with backlash: Kahraman & Blankenship, J. Appl. Mech. 64 (1997) 217.

Kind = Literal["periodic", "subharmonic", "quasi-periodic", "chaotic"]

REPEATS = 0.02
"""Difference of a period from an earlier one, over the peak-to-peak value, up to which it repeats [-]."""
WATCHED = 0.2
"""Time over which a motion that repeats is watched for a slow swing of its extremes [s]."""
LONGEST = 12
"""Periods after which a motion is sought to repeat at most."""
CHAOTIC = 0.02
"""Growth of a small difference per period from which a motion is chaotic [-]: e-fold in 50 periods."""


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Kind of a motion.

    periods : after which it repeats, 0 if it does not; growth : of a small difference per period [-], 0 if not asked
    """

    kind: Kind
    periods: int
    growth: float = 0.0

    def __str__(self) -> str:
        match self.kind:
            case "periodic":
                return "periodic"
            case "subharmonic":
                return f"subharmonic, repeats after {self.periods} periods"
            case "quasi-periodic":
                return (
                    "quasi-periodic: it does not repeat, and a small difference does not grow "
                    f"({self.growth:+.3f} per period)"
                )
        return f"chaotic: a small difference grows by exp({self.growth:.3f}) in every period"


PERIODIC = Motion(kind="periodic", periods=1)


def repeats_after(force: Array, steps: int, longest: int = LONGEST) -> int:
    """Fewest periods after which a motion repeats; 0 if it does not.

    force : (n_meshes, n) over whole periods of ``steps``, of which at least twice ``longest`` are compared if there
        are that many
    """
    waves = force.reshape(len(force), -1, steps)
    scale = np.maximum(np.ptp(force, axis=1), 1e-3 * np.abs(force).max(axis=1)) + 1e-300
    for periods in range(1, min(longest, waves.shape[1] // 2) + 1):
        # what creeps from one to the next shows between the first and the last of them
        apart = [np.ptp(waves[:, first::periods], axis=1).max(axis=1) for first in range(periods)]
        if np.all(np.max(apart, axis=0) <= REPEATS * scale):
            return periods
    return 0


def swings(extremes: Array, periods: int, size: Array) -> bool:
    """Whether a motion that seemed to repeat after ``periods`` swings over a longer time.

    extremes : (n_meshes, n, 2) least and greatest force of n periods; size : (n_meshes,) peak-to-peak value
    """
    apart = [np.ptp(extremes[:, first::periods], axis=1).max(axis=1) for first in range(periods)]
    scale = np.maximum(size, 1e-3 * np.abs(extremes).max(axis=(1, 2))) + 1e-300
    return bool(np.any(np.max(apart, axis=0) > REPEATS * scale))


def growth_per_period(distance: Array) -> float:
    """Mean growth of the logarithm of a distance over its periods, up to where it is no longer small [-].

    distance : (n,) between two motions in every period, relative to their size
    """
    small = np.flatnonzero(distance > 1e-2)
    end = int(small[0]) if small.size else len(distance)
    used = np.log(np.maximum(distance[:end], 1e-300))
    if len(used) < 3:
        return math.inf if len(distance) >= 3 else 0.0
    place = np.arange(len(used))
    return float(np.polyfit(place, used, 1)[0])


def kind_of(periods: int, growth: float = 0.0) -> Motion:
    """Motion that repeats after ``periods``, or does not repeat and lets small differences grow."""
    if periods:
        return Motion(kind="periodic" if periods == 1 else "subharmonic", periods=periods)
    return Motion(kind="chaotic" if growth > CHAOTIC else "quasi-periodic", periods=0, growth=growth)


# Search for a steady state in time: mean speed and mean torque held by corrections between blocks of periods.


SMALL = 1e-9
"""Difference in speed from which two marches part, over the speed [-]."""
AT_ONCE = 50
"""Periods that are marched at once where their extremes alone are kept."""


@dataclass(frozen=True, kw_only=True)
class PeriodGrid:
    """One period: mean speed of the first pinion [rad/s], its turns, length [s] and internal steps."""

    speed: float
    turns: float
    length: float
    steps: int


class SteadySearch:
    """March blocks, hold mean speed and mean torque by corrections between them, and test for the steady state."""

    def __init__(
        self,
        march: TimeMarch,
        system: LinearSystem,
        load: LoopLoad,
        wound: WoundLoop,
        period: PeriodGrid,
        tolerance: float,
    ) -> None:
        self.march, self.speed, self.torque, self.tolerance = march, period.speed, load.torque, tolerance
        self.drive, self.twist = wound.drive_torque, wound.state.twist
        self.balanced_drive = self.drive
        self.steady, self.residual = False, float("inf")
        self._stiffness, self._period = wound.loop_stiffness, period
        self._speed_hold = HeldSpeed(system, march.laws, period.speed)
        self._ratios = self._speed_hold.ratios
        self._loads = within_period(system.periodic_loads, self._ratios, period.turns)
        self._last: Array | None = None
        self._change = float("inf")
        self._quiet = 0

    def block(self, periods: int, tables: Array) -> Block:
        """March some periods with constant drag torques (n_drags, 2), correct, and return what was marched."""
        march = self.march
        steps = self._period.steps
        before = march.pinion_angle()
        result = march.advance(self._given(periods), drags=DragTables(torque=tables))
        span = periods * self._period.length
        mean_speed = (march.pinion_angle() - before) / span
        radius = np.array([law.base_radius_1 for law in march.laws])
        wave = radius[:, None] * result.force[:, -steps:]
        mean = float(radius[0] * result.force[0].mean())
        torque_error = 0.0 if self.torque is None else self.torque - mean
        self.balanced_drive = self.drive - self._speed_hold.inertia * self._speed_hold.drift(mean_speed, span)
        self._test(wave, mean, torque_error, mean_speed)
        if not self.steady:
            self._correct(mean_speed, span, torque_error)
        return result

    def uncorrected(self, periods: int, tables: Array) -> Block:
        """March some periods without corrections."""
        return self.march.advance(self._given(periods), drags=DragTables(torque=tables))

    def parting(self, periods: int, tables: Array) -> Array:
        """Distance from a march that starts with a small difference, by period, over the peak force (periods,) [-]."""
        given, drags = self._given(periods), DragTables(torque=tables)
        other = self.march.continued(self.march.system, self.march.model)
        other.kick(SMALL * self.speed * np.cos(np.arange(len(self._ratios))))
        first, second = (march.advance(given, drags=drags).force for march in (self.march, other))
        apart = (np.abs(first - second) / np.abs(first).max(axis=1, keepdims=True)).max(axis=0)
        return np.asarray(apart.reshape(periods, -1).max(axis=1))

    def extremes(self, periods: int, tables: Array) -> Array:
        """Least and greatest force (n_meshes, periods, 2) in each of so many periods further on [N]; the march itself
        stays where it is."""
        march, drags = self.march.continued(self.march.system, self.march.model), DragTables(torque=tables)
        blocks = []
        for first in range(0, periods, AT_ONCE):
            given = self._given(min(AT_ONCE, periods - first), march)
            waves = march.advance(given, drags=drags).force.reshape(len(march.laws), -1, self._period.steps)
            blocks.append(np.stack((waves.min(axis=2), waves.max(axis=2)), axis=2))
        return np.concatenate(blocks, axis=1)

    def _given(self, periods: int, marched: TimeMarch | None = None) -> Array:
        """Commands over some periods: drive torque and twist as they are."""
        march = marched or self.march
        samples = periods * self._period.steps // march.substeps
        given = np.zeros((samples, 4 + len(self._loads)))
        given[:, 0], given[:, 1] = self.drive, self.twist
        angle = march.pinion_angle() + self.speed * march.step * march.substeps * np.arange(1, samples + 1)
        for i, load in enumerate(self._loads):
            ratio = float(self._ratios[load.dof])
            given[:, 4 + i] = load.at(np.asarray(ratio * angle, float), ratio * self.speed)
        return given

    def _test(self, wave: Array, mean: float, torque_error: float, mean_speed: float) -> None:
        if self._last is not None:
            dynamic = np.ptp(wave, axis=1)
            scale = np.maximum(dynamic, 1e-3 * np.abs(wave).max(axis=1)) + 1e-300
            change = float(np.max(np.abs(wave - self._last).max(axis=1) / scale))
            decay = min(change / self._change, 0.95) if self._change > 0.0 else 0.0
            self._change = change
            self.residual = max(change, change * decay / (1.0 - decay))
            balanced = (
                abs(torque_error) <= 1e-4 * abs(mean)
                and abs(mean_speed / self.speed - 1.0) <= 1e-6
                and abs(self.balanced_drive - self.drive) <= 1e-4 * abs(self.drive)
            )
            self._quiet = self._quiet + 1 if self.residual <= self.tolerance and balanced else 0
            self.steady = self._quiet >= 2
        self._last = wave

    def _correct(self, mean_speed: float, span: float, torque_error: float) -> None:
        change = self._speed_hold.correction(mean_speed, span)
        self.drive += change.drive_torque
        self.march.kick(change.kick)
        self.twist += 0.5 * torque_error / self._stiffness
        self.march.set_slow(self.drive, self.twist)


Period = Literal["mesh", "revolution", "hunting_cycle"]

INTERNAL_RATE = 320e3
"""Internal steps per second: eight per sample at 40 kHz."""
SHOWN_PERIODS = 120
"""Periods of a motion that is searched for one and has none."""
LEAST_WATCHED = 4
"""Times that a motion repeats at least while it is watched for a slow swing; longer periods are not."""
LEAST_STEPS = 64
"""Internal steps per period at least."""
MOST_STEPS = 2_000_000
"""Steps of one period up to which a march is tried: at creep speed the motion is quasi-static."""


@dataclass(frozen=True, kw_only=True)
class PeriodicResponse:
    """One period of the response at constant mean speed; arrays are (n_meshes, n_steps) unless said
    otherwise.

    speed : of the pinion of the first mesh [rad/s]; period : [s]
    time : (n_steps,) [s], at the end of each internal step
    torque : dynamic torque, r_b1 times (front - back) normal force, friction left out [N m]
    force : front - back normal force in the transverse line of action [N]
    approach, approach_rate : for ``tooth_forces`` [m], [m/s]; angle_1, omega_1 : pinion [rad], [rad/s]
    torque_1 : generalized torque on the pinion body, friction included [N m]
    mean_torque, least_torque, greatest_torque : (n_meshes,) of ``torque`` [N m]
    lift_off_share : (n_meshes,) share of the period without any contact
    drive_torque : motor torque that holds the speed, from the momentum balance [N m]; twist : bracing [rad]
    friction_loss, mesh_damping_loss : (n_meshes,) mean power integrated from the contacts [W]
    joint_loss : mean power of joint and linear bearing damping [W]
    drag_loss : name -> mean power of each drag torque [W]
    drive_power : motor torque times mean speed of its freedom [W]; bracing_power : of the twist [W]
    motion : whether it repeats after the asked period, after several of them (``period`` is then as long), or not at
        all; then the arrays show ``SHOWN_PERIODS`` periods
    steady : the test was met; residual : change of the torque over a block, extrapolated, relative to its
        peak-to-peak value; periods : marched; unconverged_steps : contact iterations that ended early
    end : state at the end of the period, a start for a neighbouring speed
    """

    speed: float
    period: float
    time: Array
    torque: Array
    force: Array
    approach: Array
    approach_rate: Array
    angle_1: Array
    omega_1: Array
    torque_1: Array
    mean_torque: Array
    least_torque: Array
    greatest_torque: Array
    lift_off_share: Array
    drive_torque: float
    twist: float
    friction_loss: Array
    mesh_damping_loss: Array
    joint_loss: float
    drag_loss: dict[str, float]
    drive_power: float
    bracing_power: float
    motion: Motion
    steady: bool
    residual: float
    periods: int
    unconverged_steps: int
    end: DriveState
    warnings: tuple[str, ...]

    @property
    def total_loss(self) -> float:
        """Sum of all integrated losses [W]."""
        tooth = float(self.friction_loss.sum() + self.mesh_damping_loss.sum())
        return tooth + self.joint_loss + sum(self.drag_loss.values())


def period_length(laws: Sequence[MeshLaw], ratios: Sequence[float], kind: Period) -> float:
    """Return the period in revolutions of the first pinion.

    Parameters
    ----------
    ratios : speed of the pinion of each mesh per speed of the first pinion [-]
    kind : one tooth of the first mesh, one revolution of the first pinion, or the turns after which the
        same teeth of every mesh meet again

    Raises DynamicsInputError if ``mesh`` or ``revolution`` is no period of all meshes.
    """
    first = laws[0].teeth_1
    if kind == "mesh":
        for mesh, (law, ratio) in enumerate(zip(laws, ratios)):
            if abs(law.teeth_1 * abs(ratio) / first - 1.0) > 1e-9:
                raise DynamicsInputError(
                    f"period 'mesh': mesh {mesh} has {law.teeth_1 * abs(ratio) / first:.6g} times the mesh "
                    "frequency of the first, limit 1; use 'revolution' or 'hunting_cycle'"
                )
        return 1.0 / first
    if kind == "revolution":
        for mesh, (law, ratio) in enumerate(zip(laws, ratios)):
            teeth = law.teeth_1 * abs(ratio)
            if abs(teeth - round(teeth)) > 1e-6:
                raise DynamicsInputError(
                    f"period 'revolution': mesh {mesh} passes {teeth:.6g} teeth in it, must be whole; "
                    "use 'hunting_cycle'"
                )
        return 1.0
    turns = 1
    for law, ratio in zip(laws, ratios):
        cycle = law.teeth_2 // gcd(law.teeth_1, law.teeth_2)
        turn = cycle / abs(ratio)
        whole = next((k for k in range(1, 1000) if abs(k * turn - round(k * turn)) < 1e-6), None)
        if whole is None:
            raise DynamicsInputError(
                "period 'hunting_cycle': the pinions have no common cycle below 1000 turns; use 'mesh'"
            )
        turns = lcm(turns, round(whole * turn))
    return float(turns)


@dataclass(frozen=True, kw_only=True)
class TimeSettings:
    """Numerics of a periodic response by time integration.

    period : after which the motion repeats
    tolerance : of the steady state, relative to the peak-to-peak torque of each mesh [-]
    longest_time : simulated time after which the search ends with ``steady=False`` [s]
    internal_rate : internal steps per second, at least; least_steps : per period, at least
    cutoff : modes above this frequency keep their static effect only [Hz]
    """

    period: Period = "mesh"
    tolerance: float = 1e-3
    longest_time: float = 2.0
    internal_rate: float = INTERNAL_RATE
    least_steps: int = LEAST_STEPS
    cutoff: float = DEFAULT_CUTOFF


DEFAULT_TIME = TimeSettings()


def periodic_by_time(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    load: LoopLoad,
    drag_torques: Mapping[str, float] | None = None,
    settings: TimeSettings = DEFAULT_TIME,
) -> PeriodicResponse:
    """Run one speed to a tested steady state.

    Arguments, result and errors as in ``TimeIntegration.periodic``, which shares its modal model between speeds.
    """
    return TimeIntegration(system, laws, settings).periodic(speed, load, drag_torques)


class TimeIntegration:
    """Periodic responses of one drivetrain by time integration; its modal models are shared between speeds.

    turns : of the first pinion in the asked period
    """

    def __init__(
        self, system: LinearSystem, laws: Sequence[MeshLaw], settings: TimeSettings = DEFAULT_TIME
    ) -> None:
        """Raises DynamicsInputError as ``pinion_ratios`` and ``period_length``."""
        self.system, self.laws, self.settings = system, laws, settings
        self._ratios = pinion_ratios(system, laws)
        self.turns = period_length(laws, [self._ratios[p] for p in system.mesh_ports[:, 0]], settings.period)
        self._models: dict[tuple[str, ...], ModalModel] = {}

    def periodic(
        self,
        speed: float,
        load: LoopLoad,
        drag_torques: Mapping[str, float] | None = None,
        start: PeriodicResponse | None = None,
    ) -> PeriodicResponse:
        """Run to a tested steady state at constant mean speed and return one period of it.

        Parameters
        ----------
        speed : mean speed of the pinion of the first mesh [rad/s], positive
        load : mean dynamic torque of the first mesh, which the twist follows, or the twist that is held
        drag_torques : constant drag torque of each name of ``system.drag_loads`` at this speed [N m]
        start : response at a neighbouring speed (keeps the branch of a jump); default a wound-up rigid rotation

        Raises
        ------
        DynamicsInputError
            For impossible input, see ``wound_state``.
        DynamicsNotConverged
            If the initial state is not found, the march leaves the finite numbers, or a period has over `MOST_STEPS`.
        """
        if not speed > 0.0:
            raise DynamicsInputError(
                f"speed = {speed} rad/s must be positive; reverse the direction of all freedoms instead"
            )
        drags = dict(drag_torques or {})
        period = self._period(speed)
        if period.steps > MOST_STEPS:
            raise DynamicsNotConverged(
                f"speed = {speed:.4g} rad/s: a period of {period.length:.4g} s takes {period.steps} steps, limit "
                f"{MOST_STEPS}; the motion is quasi-static there, give a speed of at least "
                f"{speed * period.steps / MOST_STEPS:.3g} rad/s"
            )
        wound = wound_state(self.system, self.laws, speed, load, drags)
        if start is not None:
            state = _restarted(start, speed, self._ratios, wound.state if load.twist is not None else None)
            wound = wound._replace(state=state, drive_torque=start.drive_torque)
        march = TimeMarch(
            self.system,
            self.laws,
            wound.state,
            MarchSettings(
                step=period.length / period.steps, substeps=1 if self._alternates else period.steps
            ),
            DriveLoads(drive_torque=wound.drive_torque, drag_torques=drags),
            self._model(tuple(drags)),
        )
        search = SteadySearch(march, self.system, load, wound, period, self.settings.tolerance)
        return self._run(march, search, period, drags)

    @property
    def _alternates(self) -> bool:
        """Whether the period holds a load that alternates with a shaft."""
        loads = within_period(self.system.periodic_loads, self._ratios, self.turns)
        return any(load.parts for load in loads)

    def _period(self, speed: float) -> PeriodGrid:
        length = 2.0 * pi / speed * self.turns
        # whole steps per mesh of the first pair: what lies above the step rate then folds back on mesh orders only
        meshes = round(self.turns * self.laws[0].teeth_1)
        least = max(self.settings.least_steps, length * self.settings.internal_rate)
        return PeriodGrid(
            speed=speed, turns=self.turns, length=length, steps=meshes * ceil(least / meshes - 1e-9)
        )

    def _model(self, drags: tuple[str, ...]) -> ModalModel:
        if drags not in self._models:
            self._models[drags] = march_model(self.system, self.laws, drags, self.settings.cutoff)
        return self._models[drags]

    def _run(
        self, march: TimeMarch, search: SteadySearch, period: PeriodGrid, drags: Mapping[str, float]
    ) -> PeriodicResponse:
        """March blocks of periods until the search is steady or the time is over."""
        tables = np.array([[value, value] for value in drags.values()]).reshape(len(drags), 2)
        per_block = max(1, ceil(2e-3 / period.length))
        most = max(4 * per_block, ceil(self.settings.longest_time / period.length))
        done, block = 0, None
        before = march.accounts()
        while done < most and not search.steady:
            if self.settings.period == "mesh" and done >= most // 2:
                # a block of 12 periods repeats for subharmonic motions of order 2, 3, 4, 6, 12
                per_block = LONGEST * ceil(per_block / LONGEST)
            before = march.accounts()
            block = search.block(per_block, tables)
            done += per_block
        shown, motion = per_block, kind_of(1 if search.steady else 0)
        if self.settings.period == "mesh":
            before = march.accounts()
            shown = max(per_block, 2 * LONGEST) if search.steady else SHOWN_PERIODS
            block = search.uncorrected(shown, tables)
            motion = kind_of(repeats_after(block.force, period.steps))
            work = march.accounts().since(before)
            if not motion.periods:
                motion = kind_of(0, growth_per_period(search.parting(shown, tables)))
        else:
            work = march.accounts().since(before)
        assert block is not None
        watched = ceil(WATCHED / period.length)
        swinging = False
        if motion.periods and search.steady and watched >= LEAST_WATCHED * motion.periods:
            size = np.ptp(block.force, axis=1)
            swinging = swings(search.extremes(watched, tables), motion.periods, size)
        if swinging:
            motion = kind_of(0, growth_per_period(search.parting(shown, tables)))
        steady = search.steady and not swinging
        span = shown * period.length
        speed, steps = period.speed, period.steps
        steps *= (motion.periods or shown) if self.settings.period == "mesh" else 1
        last = slice(block.force.shape[1] - steps, None)
        radius = np.array([law.base_radius_1 for law in self.laws])
        force = block.force[:, last]
        dynamic = radius[:, None] * force
        warnings: list[str] = []
        if not search.steady:
            warnings.append(
                f"periodic response at {speed * 30 / pi:.1f} rpm: residual {search.residual:.2e} after {done} "
                f"periods, limit {self.settings.tolerance:.0e}; the motion is {motion}"
            )
        if swinging:
            warnings.append(
                f"periodic response at {speed * 30 / pi:.1f} rpm: peaks swing by more than {REPEATS:.0%} of the "
                f"peak-to-peak force within {WATCHED} s; the motion is {motion}"
            )
        if march.unconverged:
            warnings.append(
                f"{march.unconverged} contact iterations ended early, limit 0; use more internal steps"
            )
        return PeriodicResponse(
            speed=speed,
            period=steps * march.step,
            time=np.asarray(march.step * np.arange(1, steps + 1), float),
            torque=dynamic,
            force=force,
            approach=block.approach[:, last],
            approach_rate=block.rate[:, last],
            angle_1=block.angle_1[:, last],
            omega_1=block.omega_1[:, last],
            torque_1=block.torque_1[:, last],
            mean_torque=dynamic.mean(axis=1),
            least_torque=dynamic.min(axis=1),
            greatest_torque=dynamic.max(axis=1),
            lift_off_share=np.mean(force == 0.0, axis=1),
            drive_torque=search.balanced_drive,
            twist=search.twist,
            friction_loss=work.friction / span,
            mesh_damping_loss=work.mesh_damping / span,
            joint_loss=work.joint_damping / span,
            drag_loss=dict(zip(drags, (work.drag / span).tolist())),
            drive_power=search.balanced_drive * speed * float(self._ratios[self.system.drive_dof]),
            bracing_power=float(work.slow_work[1]) / span,
            motion=motion,
            steady=steady,
            residual=search.residual,
            periods=done,
            unconverged_steps=march.unconverged,
            end=march.state(),
            warnings=tuple(warnings),
        )


def _restarted(start: PeriodicResponse, speed: float, ratios: Array, wound: DriveState | None) -> DriveState:
    """Return the end of ``start`` brought to another speed (and to the twist of ``wound``)."""
    speeds = start.end.speeds + (speed - start.speed) * ratios
    twist = start.twist if wound is None else wound.twist
    return DriveState(angles=start.end.angles, speeds=speeds, twist=twist)


# Mean speed of a march that is held by corrections of motor torque and speed between its blocks.

CORRECTED = 0.7
"""Share of the drift in speed that a correction of the motor torque takes away."""


class SpeedCorrection(NamedTuple):
    """What is added after a block: motor torque [N m], and sudden changes of all speeds (n,) [rad/s]."""

    drive_torque: float
    kick: Array


class HeldSpeed:
    """Brings the mean speed of the first pinion to the one asked for and keeps it there.

    ratios : (n,) speed of every freedom per speed of that pinion [-]
    inertia : motor torque per angular acceleration of that pinion [kg m2]
    """

    def __init__(self, system: LinearSystem, laws: Sequence[MeshLaw], speed: float) -> None:
        """speed : of the first pinion [rad/s]; raises DynamicsInputError as `pinion_ratios`."""
        self.ratios = pinion_ratios(system, laws)
        self.inertia = float(self.ratios @ system.inertia @ self.ratios) / float(
            self.ratios[system.drive_dof]
        )
        self._speed = speed
        self._before: float | None = None

    def drift(self, mean: float, span: float) -> float:
        """Acceleration [rad/s2] since the last correction, after a block of ``span`` [s] with a mean speed [rad/s]; 0
        before the first."""
        return 0.0 if self._before is None else (mean - self._before) / span

    def correction(self, mean: float, span: float) -> SpeedCorrection:
        """After a block, as of `drift`; it counts as made."""
        drift = self.drift(mean, span)
        # at the end of a block the rigid motion is half a block ahead of its mean
        kick = self._speed - mean - 0.5 * drift * span
        self._before = mean + kick
        return SpeedCorrection(-CORRECTED * self.inertia * drift, kick * self.ratios)

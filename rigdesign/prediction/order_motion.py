"""The motion of a braced loop whose orders are read: about the motion with all teeth alike, or over a whole cycle."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import within_period
from dynamics.rotor.static_loop import LoopLoad, port_model
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.tooth.mesh_laws import alike_teeth
from dynamics.vibration.deviation_response import (
    CYCLE_STEPS,
    DeviationResponse,
    OrderLoads,
    OrderTorque,
    mean_windup,
)
from dynamics.vibration.hill_system import MeshPeriodic
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.speed_continuation import mesh_cells
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.steady_motion import TimeSettings, period_length, periodic_by_time
from rigdesign.base.errors import UsageError
from rigdesign.coupling.mesh_models import MeshModel, laws_of
from rigdesign.coupling.preloaded_loop import LoadedCircuit, shifted_laws, signed_torque
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel
from rigdesign.prediction.places import OscillatingTorque, motions, place_of
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


# The motion over the whole hunting cycle, all contacts opening and closing: what the fast way is held to.

Integers = NDArray[np.int64]

MOST_CELLS = 1000
"""Mesh periods in a cycle up to which the harmonic balance is used; beyond it the loop is marched."""
LONGEST_MARCH = 20.0
"""Simulated time after which a march that does not converge ends [s]."""


@dataclass(frozen=True, kw_only=True)
class ExactMotion:
    """Torques of the meshes over one cycle.

    speed : of the first pinion [rad/s]; turns : of it in the cycle; phi : (n,) its mean angle [rad]
    dofs : (n_bodies,) freedoms of the gears, of ``size`` in all; torque : (n_bodies, n) on them [N m]
    twist [rad], drive [N m]
    """

    speed: float
    turns: float
    phi: Array
    dofs: Integers
    size: int
    torque: Array
    twist: float
    drive: float

    def loads(self, order: float) -> OrderLoads:
        """Loads at an order of the first pinion; zero if the cycle does not hold it."""
        whole = abs(order * self.turns - round(order * self.turns)) < 1e-6
        wave = np.exp(-1j * order * self.phi) / self.phi.size if whole else np.zeros(self.phi.size, complex)
        torque = np.zeros(self.size, complex)
        torque[self.dofs] = self.torque @ wave * (2.0 if order else 1.0)
        return OrderLoads(order=order, omega=order * self.speed, torque=torque)


def exact_motion(
    rig: Rig,
    loop: LoadedCircuit,
    laws: Sequence[MeshLaw],
    *,
    march: bool | None = None,
) -> ExactMotion:
    """Solve over the hunting cycle: harmonic balance up to MOST_CELLS mesh periods, else the march in time.

    laws : of the meshes of ``loop`` as they are braced; march : take the one or the other
    Raises DynamicsNotConverged if neither converges.
    """
    point, setting = loop.point, loop.bracing
    controlled = setting.mode == "torque_controlled"
    torque, twist = (signed_torque(rig, point), None) if controlled else (None, setting.twist)
    speed = rig.pinion_speed(point.speed)
    if march is None:
        march = mesh_cells(port_model(loop.system, laws), "hunting_cycle", 0)[0] > MOST_CELLS
    if not march:
        curve = periodic_response(
            loop.system,
            laws,
            [speed],
            LoopLoad(torque=torque, twist=twist),
            drag_torques=loop.drags,
            settings=SweepSettings(
                period="hunting_cycle", cutoff=rig.highest_mode, methods=("harmonic_balance",)
            ),
        )
        if curve.points:
            found = curve.points[0]
            wave = found.wave
            motion = _MeshMotion(wave.time, wave.angle, wave.approach, wave.omega_1, wave.omega_2)
            return _over_cycle(loop.system, laws, speed, motion, (found.twist, found.drive_torque))
    marched = periodic_by_time(
        loop.system,
        laws,
        speed=speed,
        drag_torques=loop.drags,
        load=LoopLoad(torque=torque, twist=twist),
        settings=TimeSettings(period="hunting_cycle", longest_time=LONGEST_MARCH, cutoff=rig.highest_mode),
    )
    if not marched.steady:
        raise DynamicsNotConverged(
            f"march over the hunting cycle at {point.stage!r}: {'; '.join(marched.warnings)}"
        )
    radius_1, radius_2 = np.array([(law.base_radius_1, law.base_radius_2) for law in laws]).T[..., None]
    omega_2 = (radius_1 * marched.omega_1 - marched.approach_rate) / radius_2
    motion = _MeshMotion(marched.time, marched.angle_1, marched.approach, marched.omega_1, omega_2)
    return _over_cycle(loop.system, laws, speed, motion, (marched.twist, marched.drive_torque))


class _MeshMotion(NamedTuple):
    """Motion of all meshes over one cycle that begins anywhere; time (n,) [s], all others (n_meshes, n)."""

    time: Array
    angle: Array
    """Of the pinion [rad]."""
    approach: Array
    """[m]"""
    omega_1: Array
    """[rad/s]"""
    omega_2: Array


def _over_cycle(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    motion: _MeshMotion,
    held: tuple[float, float],
) -> ExactMotion:
    """Torques on the gear bodies along a motion.

    held : bracing twist [rad] and motor torque [N m]
    """
    torque: dict[int, Array] = {}
    for m, (law, ports) in enumerate(zip(laws, system.mesh_ports.tolist())):
        reaction = evaluate_mesh(law, *(values[m] for values in motion[1:]))
        for dof, wave in zip(ports, (reaction.torque_1, reaction.torque_2)):
            torque[dof] = torque[dof] + wave if dof in torque else wave
    time = motion.time
    start = float(np.mean(motion.angle[0] - speed * time))
    step = float(time[1] - time[0])
    return ExactMotion(
        speed=speed, turns=speed * step * time.size / (2.0 * pi), phi=start + speed * time,
        dofs=np.array(list(torque), np.int64), size=len(system.inertia), torque=np.array(list(torque.values())),
        twist=held[0], drive=held[1],
    )  # fmt: skip


SAME_ORDER = 1e-6
"""Relative difference below which two orders are the same."""


def ideal_response(rig: Rig, loop: LoadedCircuit) -> CurvePoint:
    """Response with all teeth of a gear alike and no oscillating torque, over one mesh period.

    Raises DynamicsNotConverged.
    """
    controlled = loop.bracing.mode == "torque_controlled"
    curve = periodic_response(
        _without_periodic_loads(loop.system),
        [alike_teeth(law) for law in shifted_laws(rig, loop.models, loop.bracing)],
        [rig.pinion_speed(loop.point.speed)],
        LoopLoad(
            torque=signed_torque(rig, loop.point) if controlled else None,
            twist=None if controlled else loop.bracing.twist,
        ),
        drag_torques=loop.drags,
        settings=SweepSettings(cutoff=rig.highest_mode),
    )
    if curve.failed:
        raise DynamicsNotConverged(f"mesh-periodic response at {loop.point.stage!r}: {curve.failed[0][1]}")
    (found,) = curve.points
    if found.motion.periods != 1:
        raise DynamicsNotConverged(
            f"mesh-periodic response at {loop.point.stage!r}: the motion is {found.motion}, must repeat in every mesh; "
            "ask at a higher torque or another speed"
        )
    return found


def is_ideal(rig: Rig, loop: LoadedCircuit) -> bool:
    """Whether the response of an iteration is the ideal one: it takes all teeth alike where it runs over one mesh, and
    leaves out what turns with a shaft where no order of it repeats from mesh to mesh."""
    if rig.case.numerics.response_period != "mesh":
        return False
    loads = loop.system.periodic_loads
    if not loads:
        return True
    laws = laws_of(loop.models)
    ratios = pinion_ratios(loop.system, laws)
    pinions = [float(ratios[port]) for port in loop.system.mesh_ports[:, 0]]
    held = within_period(loads, ratios, period_length(laws, pinions, "mesh"))
    return not any(load.parts for load in held)


def _without_periodic_loads(system: LinearSystem) -> LinearSystem:
    """The system without oscillating torques; its modes stay known."""
    if not system.periodic_loads:
        return system
    return replace(system, periodic_loads=(), own_coordinates=system.coordinates)


@dataclass(frozen=True)
class ReferenceGear:
    """The reference gear, against the pinion of the first mesh."""

    turns: float
    """Of the pinion per turn of the reference gear, inverted: order of the pinion per order of that gear [-]."""
    ahead: float
    """Its angle beyond that of tooth 0 at the pitch point where pair 0 meets [rad]."""

    @staticmethod
    def of(rig: Rig, models: Sequence[MeshModel]) -> "ReferenceGear":
        """The gear where the case counts torque."""
        law = models[0].law
        if rig.case.power_circuit.torque_at == rig.mesh_gears(rig.control_mesh)[0]:
            return ReferenceGear(1.0, 0.0)
        return ReferenceGear(law.teeth_1 / law.teeth_2, law.tooth_offset_2 * 2.0 * pi / law.teeth_2)

    def phase_shift(self, order: float) -> complex:
        """Factor exp(i order phi) of the reference gear at pinion angle zero."""
        return complex(np.exp(1j * order * self.ahead))


class OrderMotion(Protocol):
    """A motion: bracing twist [rad], motor torque [N m] and speed of the first pinion [rad/s]."""

    twist: float
    drive: float
    speed: float

    def loads(self, orders: Sequence[float], torques: Sequence[OscillatingTorque]) -> Sequence[OrderLoads]:
        """Loads on the drivetrain at orders of the first pinion."""


class DeviatingMotion:
    """About the motion with all teeth alike."""

    def __init__(self, response: DeviationResponse) -> None:
        self.response, base = response, response.loop.base
        self.twist, self.drive, self.speed = base.twist, base.drive_torque, base.speed

    def loads(self, orders: Sequence[float], torques: Sequence[OscillatingTorque]) -> Sequence[OrderLoads]:
        """Loads of the meshes and of the oscillating torques."""
        acting = [
            OrderTorque(load=torque.load, order=torque.order, amplitude=torque.amplitude)
            for torque in torques
        ]
        return self.response.loads(orders, acting)


class CycleMotion:
    """All contacts over the hunting cycle."""

    def __init__(self, motion: ExactMotion) -> None:
        self.motion = motion
        self.twist, self.drive, self.speed = motion.twist, motion.drive, motion.speed

    def loads(self, orders: Sequence[float], torques: Sequence[OscillatingTorque]) -> Sequence[OrderLoads]:
        """Loads of the meshes and of the oscillating torques."""
        return [self._with(self.motion.loads(order), torques) for order in orders]

    @staticmethod
    def _with(loads: OrderLoads, torques: Sequence[OscillatingTorque]) -> OrderLoads:
        """Loads of the meshes and of the oscillating torques at this order."""
        here = [torque for torque in torques if abs(torque.order - loads.order) < SAME_ORDER * torque.order]
        if not here:
            return loads
        whole = np.sum([torque.amplitude * torque.load for torque in here], axis=0)
        return replace(loads, torque=loads.torque + whole)


# Complex orders of torque and angle that the channels of a rig read at a converged operating point.
#
# Conventions. The signal is the sum of Re(X_k exp(i k phi)) over its orders k, per turn of the reference gear; phi is
# the mean angle of that gear, zero where its tooth 0 stands at the pitch point of its first mesh (plus the phase of the
# case). The torque in a coupling is what it transmits, positive where its first shaft is ahead of its second in the
# running direction. The angle of a shaft is that of the end that no coupling takes (of its start, if both or none are
# free), positive in its running direction, less its uniform rotation; its mean counts as zero.

Complex = NDArray[np.complex128]
Orders = dict[tuple[str, float], complex]

MOST_CHANGE = 0.05
"""Change of the approach in the last correction from which the corrections do not suffice [-]."""


def shaft_orders(
    rig: Rig,
    loop: LoadedCircuit,
    channels: Sequence[Channel],
    *,
    base: CurvePoint | MeshPeriodic | None = None,
    exact: bool | None = None,
    steps: int = CYCLE_STEPS,
) -> Orders:
    """Orders of the channels that read torque or angle; other channels are passed over. See `PointOrders`.

    Returns (channel, order) -> complex amplitude [N m], [rad]; the mean (order 0) is real.
    """
    read = [channel for channel in channels if channel.quantity in ORDER_QUANTITIES and channel.orders]
    if not read:
        return {}
    found = PointOrders(rig, loop, base=base, exact=exact, steps=steps)
    found.prepare(order for channel in read for order in channel.orders)
    return {(channel.name, order): value for channel in read for order, value in found.read(channel).items()}


class PointOrders:
    """All orders of one converged operating point, solved as channels ask for them."""

    def __init__(
        self,
        rig: Rig,
        loop: LoadedCircuit,
        *,
        base: CurvePoint | MeshPeriodic | None = None,
        exact: bool | None = None,
        steps: int = CYCLE_STEPS,
    ) -> None:
        """Take a point; nothing is solved yet.

        Parameters
        ----------
        loop : its warm meshes with the deviations of their teeth
        base : response of the same point with all teeth alike and no oscillating torque (`ideal_response`), where it
            is known, or what was linearised about it
        exact : follow all contacts over the hunting cycle instead (seconds to a minute, not milliseconds); left out,
            where the corrections do not suffice (a tooth that is all but missing); False: never
        steps : corrections at most for what the contacts do beyond first order; 0 is the linear response about the
            motion with all teeth alike
        """
        self.rig, self.loop = rig, loop
        self.system: LinearSystem = loop.system
        self.laws = shifted_laws(rig, loop.models, loop.bracing)
        self._base, self.exact, self.steps = base, exact, steps
        self._loads: dict[float, OrderLoads] = {}
        self._motions: dict[float, Complex] = {}

    @cached_property
    def count(self) -> ReferenceGear:
        """The reference gear."""
        return ReferenceGear.of(self.rig, self.loop.models)

    @cached_property
    def ratios(self) -> Array:
        """Speed of each freedom per speed of the first pinion (n,)."""
        return pinion_ratios(self.system, self.laws)

    @cached_property
    def solved(self) -> OrderMotion:
        """The motion. Raises DynamicsNotConverged."""
        if not self.exact:
            base = self._base or ideal_response(self.rig, self.loop)
            held = self.loop.bracing.mode != "torque_controlled"
            response = DeviationResponse(self.system, self.laws, base, twist_held=held, steps=self.steps)
            if self.steps < CYCLE_STEPS or response.change < MOST_CHANGE:
                return DeviatingMotion(response)
            if self.exact is False:
                raise DynamicsNotConverged(
                    f"orders at {self.loop.point.stage!r}: the last correction still moved the contacts by "
                    f"{response.change:.2g} of their deviation (limit {MOST_CHANGE:g}); follow them exactly"
                )
        return CycleMotion(exact_motion(self.rig, self.loop, self.laws))

    @cached_property
    def torques(self) -> tuple[OscillatingTorque, ...]:
        """Loads that oscillate with a shaft, in turns of the first pinion and the phase of its mean angle."""
        speed = self.rig.pinion_speed(self.loop.point.speed)
        return tuple(
            OscillatingTorque(
                name=torques.name,
                order=part.order * float(self.ratios[torques.dof]),
                amplitude=part.at_speed(float(self.ratios[torques.dof]) * speed)
                * complex(np.exp(-1j * part.phase)),
                load=torques.load,
            )
            for torques in self.system.periodic_loads
            for part in torques.parts
        )

    def prepare(self, orders: Iterable[float]) -> None:
        """Solve what is missing of some orders, per turn of the reference gear, at once."""
        missing = sorted({float(order) for order in orders} - self._loads.keys())
        if missing:
            turned = [order * self.count.turns for order in missing]
            found = dict(zip(missing, self.solved.loads(turned, self.torques)))
            moving = [order for order in missing if order > 0.0]
            self._loads |= found
            self._motions |= dict(zip(moving, motions(self.system, [found[order] for order in moving])))

    def read(self, channel: Channel) -> dict[float, complex]:
        """Amplitudes of a channel by order. UsageError for an unknown place or a channel without orders."""
        if channel.quantity not in ORDER_QUANTITIES:
            raise UsageError(f"channel {channel.name!r}: {channel.quantity} has no orders")
        place = place_of(self.rig, channel)
        self.prepare(channel.orders)
        found = {}
        for order in channel.orders:
            if order == 0.0:
                found[order] = complex(place.mean(self._windup, self.solved.twist))
                continue
            loads = self._loads[order]
            torques = [
                torque
                for torque in self.torques
                if abs(torque.order - loads.order) < SAME_ORDER * loads.order
            ]
            amplitude = place.amplitude(self._motions[order], loads.omega, torques)
            found[order] = amplitude / self.count.phase_shift(order)
        return found

    @cached_property
    def _windup(self) -> Array:
        """Mean windup of all freedoms [rad]."""
        self.prepare([0.0])
        mean = self._loads[0.0]
        return mean_windup(
            self.system, mean.torque.real, twist=self.solved.twist, drive=self.solved.drive,
            speed=self.solved.speed * self.ratios, drags=self.loop.drags,
        )  # fmt: skip


def numbers(channel: Channel, orders: Orders) -> list[float]:
    """Features of a channel in their order: means, real and imaginary parts."""
    found: list[float] = []
    for order in channel.orders:
        value = complex(orders[channel.name, order])
        found += [value.real, value.imag] if order else [value.real]
    return found

"""Complex orders of torque and angle that the channels of a rig read at a settled operating point.

Conventions. The signal is the sum of Re(X_k exp(i k phi)) over its orders k, per turn of the reference gear; phi is
the mean angle of that gear, zero where its tooth 0 stands at the pitch point of its first mesh (plus the phase of the
case). The torque in a coupling is what it transmits, positive where its first shaft is ahead of its second in the
running direction. The angle of a shaft is that of the end that no coupling takes (of its start, if both or none are
free), positive in its running direction, less its uniform rotation; its mean counts as zero.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.errors import DynamicsNotConverged
from dynamics.mesh.flank import alike_teeth
from dynamics.orders.deviation_response import (
    CYCLE_STEPS,
    DeviationResponse,
    OrderLoads,
    OrderTorque,
    mean_windup,
)
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.speed_sweep import CurvePoint, SweepSettings, periodic_response
from rigdesign.base.errors import UsageError
from rigdesign.coupling.loads import BracingState, MeshModel, shifted_laws, signed_torque
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.exact_orders import ExactMotion, exact_motion
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel
from rigdesign.prediction.order_places import Swing, motions, place_of
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Orders = dict[tuple[str, float], complex]

SAME_ORDER = 1e-6
"""Relative difference below which two orders are the same."""
UNSETTLED = 0.05
"""Change of the approach in the last correction from which the corrections do not suffice [-]."""


def shaft_orders(
    rig: Rig,
    point: OperatingPoint,
    models: Sequence[MeshModel],
    drags: Mapping[str, float],
    setting: BracingState,
    channels: Sequence[Channel],
    *,
    base: CurvePoint | None = None,
    exact: bool | None = None,
    steps: int = CYCLE_STEPS,
) -> Orders:
    """Orders of the channels that read torque or angle; other channels are passed over. See `PointOrders`.

    Returns (channel, order) -> complex amplitude [N m], [rad]; the mean (order 0) is real.
    """
    read = [channel for channel in channels if channel.quantity in ORDER_QUANTITIES and channel.orders]
    if not read:
        return {}
    found = PointOrders(rig, point, models, drags, setting, base=base, exact=exact, steps=steps)
    found.prepare(order for channel in read for order in channel.orders)
    return {(channel.name, order): value for channel in read for order, value in found.read(channel).items()}


class PointOrders:
    """All orders of one settled operating point, solved as channels ask for them."""

    def __init__(
        self,
        rig: Rig,
        point: OperatingPoint,
        models: Sequence[MeshModel],
        drags: Mapping[str, float],
        setting: BracingState,
        *,
        base: CurvePoint | None = None,
        exact: bool | None = None,
        steps: int = CYCLE_STEPS,
    ) -> None:
        """Take a point; nothing is solved yet.

        Parameters
        ----------
        models : warm meshes with the deviations of their teeth; drags : brake torques by place of the drivetrain
            [N m]; setting : as in `rigdesign.coupling.loads.respond`
        base : response of the same point with all teeth alike and no torque that swings (`ideal_response`), where
            it is known
        exact : follow all contacts over the hunting cycle instead (seconds to a minute, not milliseconds); left out,
            where the corrections do not suffice (a tooth that is all but missing); False: never
        steps : corrections at most for what the contacts do beyond first order; 0 is the linear response about the
            motion with all teeth alike
        """
        assert rig.system is not None and rig.drivetrain is not None
        self.rig, self.point, self.models, self.drags, self.setting = (
            rig,
            point,
            tuple(models),
            drags,
            setting,
        )
        self.system: LinearSystem = rig.system
        self.laws = shifted_laws(rig, models, setting)
        self._base, self.exact, self.steps = base, exact, steps
        self._loads: dict[float, OrderLoads] = {}
        self._motions: dict[float, Complex] = {}

    @cached_property
    def count(self) -> "_Count":
        """The reference gear."""
        return _Count.of(self.rig, self.models)

    @cached_property
    def ratios(self) -> Array:
        """Speed of each freedom per speed of the first pinion (n,)."""
        return pinion_ratios(self.system, self.laws)

    @cached_property
    def solved(self) -> "_Solved":
        """The motion. Raises DynamicsNotConverged."""
        if not self.exact:
            base = self._base or ideal_response(self.rig, self.point, self.models, self.drags, self.setting)
            held = self.setting.mode != "torque_controlled"
            response = DeviationResponse(self.system, self.laws, base, twist_held=held, steps=self.steps)
            if self.steps < CYCLE_STEPS or response.change < UNSETTLED:
                return _Deviating(response, base)
            if self.exact is False:
                raise DynamicsNotConverged(
                    f"orders at {self.point.stage!r}: the last correction still moved the contacts by "
                    f"{response.change:.2g} of their deviation (limit {UNSETTLED:g}); follow them exactly"
                )
        return _Exact(exact_motion(self.rig, self.point, self.laws, self.drags, self.setting))

    @cached_property
    def swings(self) -> tuple[Swing, ...]:
        """Torques that swing with a shaft, in turns of the first pinion and the phase of its mean angle."""
        return tuple(
            Swing(
                name=torques.name,
                order=part.order * float(self.ratios[torques.dof]),
                amplitude=part.torque * complex(np.exp(-1j * part.phase)),
                load=torques.load,
            )
            for torques in self.system.shaft_torques
            for part in torques.parts
        )

    def prepare(self, orders: Iterable[float]) -> None:
        """Solve what is missing of some orders, per turn of the reference gear, at once."""
        missing = sorted({float(order) for order in orders} - self._loads.keys())
        if missing:
            turned = [order * self.count.turns for order in missing]
            found = dict(zip(missing, self.solved.loads(turned, self.swings)))
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
            swings = [
                swing for swing in self.swings if abs(swing.order - loads.order) < SAME_ORDER * loads.order
            ]
            amplitude = place.amplitude(self._motions[order], loads.omega, swings)
            found[order] = amplitude / self.count.turned(order)
        return found

    @cached_property
    def _windup(self) -> Array:
        """Mean windup of all freedoms [rad]."""
        self.prepare([0.0])
        mean = self._loads[0.0]
        return mean_windup(
            self.system, dict(zip(mean.dofs.tolist(), mean.torque.real.tolist())), twist=self.solved.twist,
            drive=self.solved.drive, speed=self.solved.speed * self.ratios, drags=self.drags,
        )  # fmt: skip


def numbers(channel: Channel, orders: Orders) -> list[float]:
    """Features of a channel in their order: means, real and imaginary parts."""
    found: list[float] = []
    for order in channel.orders:
        value = complex(orders[channel.name, order])
        found += [value.real, value.imag] if order else [value.real]
    return found


def ideal_response(
    rig: Rig,
    point: OperatingPoint,
    models: Sequence[MeshModel],
    drags: Mapping[str, float],
    setting: BracingState,
) -> CurvePoint:
    """Response with all teeth of a gear alike and no torque that swings, over one mesh period.

    Raises DynamicsNotConverged.
    """
    assert rig.system is not None
    controlled = setting.mode == "torque_controlled"
    curve = periodic_response(
        _still(rig.system),
        [alike_teeth(law) for law in shifted_laws(rig, models, setting)],
        [rig.pinion_speed(point.speed)],
        LoopLoad(
            torque=signed_torque(rig, point) if controlled else None,
            twist=None if controlled else setting.twist,
        ),
        drag_torques=drags,
        settings=SweepSettings(cutoff=rig.highest_mode),
    )
    if curve.failed:
        raise DynamicsNotConverged(f"mesh-periodic response at {point.stage!r}: {curve.failed[0][1]}")
    return curve.points[0]


def is_ideal(rig: Rig) -> bool:
    """Whether the response of an iteration is the ideal one: it takes all teeth alike where it runs over one mesh."""
    return rig.case.numerics.response_period == "mesh" and not (rig.system and rig.system.shaft_torques)


def _still(system: LinearSystem) -> LinearSystem:
    """The system without torques that swing; its modes stay known."""
    if not system.shaft_torques:
        return system
    still = replace(system, shaft_torques=())
    still.__dict__["form"] = system.form
    return still


@dataclass(frozen=True)
class _Count:
    """The reference gear, against the pinion of the first mesh."""

    turns: float
    """Of the pinion per turn of the reference gear, inverted: order of the pinion per order of that gear [-]."""
    ahead: float
    """Its angle beyond that of tooth 0 at the pitch point where pair 0 meets [rad]."""

    @staticmethod
    def of(rig: Rig, models: Sequence[MeshModel]) -> "_Count":
        power, law = rig.case.drivetrain, models[0].law
        assert power is not None
        if power.torque_at == rig.mesh_gears(rig.control_mesh)[0]:
            return _Count(1.0, 0.0)
        return _Count(law.teeth_1 / law.teeth_2, law.tooth_offset_2 * 2.0 * pi / law.teeth_2)

    def turned(self, order: float) -> complex:
        """Factor exp(i order phi) of the reference gear at pinion angle zero."""
        return complex(np.exp(1j * order * self.ahead))


class _Solved(Protocol):
    """A motion: bracing twist [rad], motor torque [N m] and speed of the first pinion [rad/s]."""

    twist: float
    drive: float
    speed: float

    def loads(self, orders: Sequence[float], swings: Sequence[Swing]) -> Sequence[OrderLoads]:
        """Loads on the drivetrain at orders of the first pinion."""


class _Deviating:
    """About the motion with all teeth alike."""

    def __init__(self, response: DeviationResponse, base: CurvePoint) -> None:
        self.response = response
        self.twist, self.drive, self.speed = base.twist, base.drive_torque, base.speed

    def loads(self, orders: Sequence[float], swings: Sequence[Swing]) -> Sequence[OrderLoads]:
        torques = [
            OrderTorque(dof=int(dof), order=swing.order, amplitude=swing.amplitude * float(swing.load[dof]))
            for swing in swings
            for dof in np.flatnonzero(swing.load)
        ]
        return self.response.loads(orders, torques)


class _Exact:
    """All contacts over the hunting cycle."""

    def __init__(self, motion: ExactMotion) -> None:
        self.motion = motion
        self.twist, self.drive, self.speed = motion.twist, motion.drive, motion.speed

    def loads(self, orders: Sequence[float], swings: Sequence[Swing]) -> Sequence[OrderLoads]:
        return [self._with(self.motion.loads(order), swings) for order in orders]

    @staticmethod
    def _with(loads: OrderLoads, swings: Sequence[Swing]) -> OrderLoads:
        """Loads of the meshes and of the torques that swing at this order."""
        here = [swing for swing in swings if abs(swing.order - loads.order) < SAME_ORDER * swing.order]
        if not here:
            return loads
        whole = np.sum([swing.amplitude * swing.load for swing in here], axis=0)
        dofs = np.flatnonzero(whole)
        return replace(
            loads,
            dofs=np.concatenate([loads.dofs, dofs]),
            torque=np.concatenate([loads.torque, whole[dofs]]),
        )

"""Complex orders of torque and angle that the channels of a rig read at a converged operating point.

Conventions. The signal is the sum of Re(X_k exp(i k phi)) over its orders k, per turn of the reference gear; phi is
the mean angle of that gear, zero where its tooth 0 stands at the pitch point of its first mesh (plus the phase of the
case). The torque in a coupling is what it transmits, positive where its first shaft is ahead of its second in the
running direction. The angle of a shaft is that of the end that no coupling takes (of its start, if both or none are
free), positive in its running direction, less its uniform rotation; its mean counts as zero.
"""

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.vibration.deviation_response import CYCLE_STEPS, DeviationResponse, OrderLoads, mean_windup
from dynamics.vibration.hill_system import MeshPeriodic
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.errors import UsageError
from rigdesign.coupling.preloaded_loop import LoadedCircuit, shifted_laws
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel
from rigdesign.prediction.order_motion import (
    SAME_ORDER,
    CycleMotion,
    DeviatingMotion,
    OrderMotion,
    ReferenceGear,
    exact_motion,
    ideal_response,
)
from rigdesign.prediction.places import OscillatingTorque, motions, place_of
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
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

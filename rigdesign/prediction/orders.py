"""Complex orders of torque and angle that the channels of a rig read at a settled operating point.

Conventions. The signal is the sum of Re(X_k exp(i k phi)) over its orders k, per turn of the gear that counts; phi is
the mean angle of that gear, zero where its tooth 0 stands at the pitch point of its first mesh (plus the phase of the
case). The torque in a coupling is positive where its first shaft is ahead of its second in the running direction. The
angle of a shaft is that of the end that no coupling takes (of its start, if both or none are free), positive in its
running direction, less its uniform rotation; its mean counts as zero.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.deviation_response import (
    CYCLE_STEPS,
    DeviationResponse,
    HarmonicTorque,
    OrderLoads,
    ideal_laws,
    mean_windup,
    motion_orders,
)
from dynamics.drivetrain import Joint, joints
from dynamics.initial_state import pinion_ratios
from dynamics.linear_system import LinearSystem
from dynamics.mesh_force import evaluate_mesh
from dynamics.mesh_law import MeshLaw
from dynamics.periodic_response import PeriodicResponse, periodic_by_time
from dynamics.response_curve import CurvePoint, periodic_response
from dynamics.static_loop import NotConverged
from rigdesign.loads import MeshModel, Setting, shifted_laws, signed_torque
from rigdesign.prediction.model import Channel
from rigdesign.rig.model import Rig
from rigdesign.state import OperatingPoint

Array = NDArray[np.float64]
Orders = dict[tuple[str, float], complex]

LONGEST_MARCH = 20.0
"""Simulated time after which an exact march that does not settle ends [s]."""


class Ripple(NamedTuple):
    """Torque Re(amplitude exp(i order phi)) on one freedom; order and phi of the gear that counts."""

    freedom: int
    order: float
    amplitude: complex


def shaft_orders(
    rig: Rig,
    point: OperatingPoint,
    models: Sequence[MeshModel],
    drags: Mapping[str, float],
    setting: Setting,
    channels: Sequence[Channel],
    *,
    ripples: Sequence[Ripple] = (),
    base: CurvePoint | None = None,
    exact: bool = False,
    steps: int = CYCLE_STEPS,
) -> Orders:
    """Orders of the channels that read torque or angle; other channels are passed over.

    Parameters
    ----------
    models : warm meshes with the deviations of their teeth; drags : brake torques by place of the drivetrain [N m]
    setting : as in `rigdesign.loads.respond`
    ripples : harmonic torques of motor or couplings on freedoms of ``rig.system``
    base : response of the same point with all teeth alike (``ideal_response``), where it is known
    exact : march in time over the hunting cycle, contacts opening and closing, instead of the linear response about
        the motion with all teeth alike. It takes no ripples
    steps : corrections of the response for what the contacts do beyond first order; 0: the linear response alone

    Returns (channel, order) -> complex amplitude [N m], [rad]; the mean (order 0) is real.

    Raises
    ------
    NotConverged
        The motion with all teeth alike, or the march, does not settle.
    ValueError
        An unknown coupling or shaft, an order that is negative or above what is solved, ripples with ``exact``.
    """
    assert rig.system is not None and rig.drivetrain is not None
    read = [channel for channel in channels if channel.quantity in ("torque", "angle")]
    if not any(channel.orders for channel in read):
        return {}
    parts = joints(rig.drivetrain)
    places = {channel.name: _place(rig, parts, channel) for channel in read}
    count = _Count.of(rig, models)
    orders = sorted({order for channel in read for order in channel.orders})
    if exact:
        if ripples:
            raise ValueError(
                "exact = True: the march takes no ripples; leave them out or ask for the linear response"
            )
        state = _marched(rig, point, models, drags, setting, [order * count.turns for order in orders])
    else:
        torques = [
            HarmonicTorque(
                dof=ripple.freedom, order=ripple.order * count.turns,
                amplitude=ripple.amplitude * count.turned(ripple.order),
            )
            for ripple in ripples
        ]  # fmt: skip
        start = base or ideal_response(rig, point, models, drags, setting)
        turned = [order * count.turns for order in orders]
        state = _deviating(rig, models, setting, start, turned, torques, steps)
    by_order = dict(zip(orders, state.loads))
    found: Orders = {}
    for channel in read:
        place = places[channel.name]
        for order in channel.orders:
            if order == 0.0:
                found[channel.name, order] = complex(place.mean(rig, state, drags))
            else:
                value = place.amplitude(rig.system, by_order[order])
                found[channel.name, order] = value / count.turned(order)
    return found


def ideal_response(
    rig: Rig, point: OperatingPoint, models: Sequence[MeshModel], drags: Mapping[str, float], setting: Setting
) -> CurvePoint:
    """Response with all teeth of a gear alike, over one mesh period: what the linear response starts from.

    Raises NotConverged.
    """
    assert rig.system is not None
    controlled = setting.mode == "torque_controlled"
    laws = ideal_laws(shifted_laws(rig, models, setting))
    curve = periodic_response(
        rig.system,
        laws,
        [rig.pinion_speed(point.speed)],
        signed_torque(rig, point) if controlled else None,
        twist=None if controlled else setting.twist,
        drag_torques=drags,
    )
    if curve.failed:
        raise NotConverged(f"mesh-periodic response at {point.stage!r}: {curve.failed[0][1]}")
    return curve.points[0]


@dataclass(frozen=True)
class _Count:
    """The gear that counts, against the pinion of the first mesh."""

    turns: float
    """Of the gear that counts per turn of the pinion [-]."""
    ahead: float
    """Its angle beyond that of tooth 0 at the pitch point where pair 0 meets [rad]."""

    @staticmethod
    def of(rig: Rig, models: Sequence[MeshModel]) -> "_Count":
        law = models[0].law
        if rig.torque_ratio == 1.0 and _counts_at_pinion(rig):
            return _Count(1.0, 0.0)
        return _Count(law.teeth_1 / law.teeth_2, law.tooth_offset_2 * 2.0 * pi / law.teeth_2)

    def turned(self, order: float) -> complex:
        """Factor exp(i order phi) of the gear that counts at pinion angle zero."""
        return complex(np.exp(1j * order * self.ahead))


def _counts_at_pinion(rig: Rig) -> bool:
    power = rig.case.drivetrain
    assert power is not None
    return power.torque_at == rig.mesh_gears(rig.control_mesh)[0]


@dataclass(frozen=True, kw_only=True)
class _State:
    """Loads on the drivetrain, order by order, and what is constant.

    mean : mean torque of the meshes by freedom [N m]; twist : bracing [rad]; drive : motor torque [N m]
    speeds : (n,) of all freedoms [rad/s]
    """

    loads: Sequence[OrderLoads]
    mean: Mapping[int, float]
    twist: float
    drive: float
    speeds: Array


def _deviating(
    rig: Rig, models: Sequence[MeshModel], setting: Setting, base: CurvePoint, orders: Sequence[float],
    torques: Sequence[HarmonicTorque], steps: int,
) -> _State:  # fmt: skip
    assert rig.system is not None
    laws = shifted_laws(rig, models, setting)
    held = setting.mode != "torque_controlled"
    response = DeviationResponse(rig.system, laws, base, twist_held=held, steps=steps)
    mean, *loads = response.loads([0.0, *orders], torques)
    return _State(
        loads=loads,
        mean=dict(zip(mean.dofs.tolist(), mean.torque.real.tolist())),
        twist=base.twist,
        drive=base.drive_torque,
        speeds=base.speed * pinion_ratios(rig.system, laws),
    )


def _marched(
    rig: Rig, point: OperatingPoint, models: Sequence[MeshModel], drags: Mapping[str, float], setting: Setting,
    orders: Sequence[float],
) -> _State:  # fmt: skip
    """The same from a march in time over the hunting cycle; an order that is none of its harmonics is zero."""
    system = rig.system
    assert system is not None
    laws = shifted_laws(rig, models, setting)
    controlled = setting.mode == "torque_controlled"
    found = periodic_by_time(
        system, laws, speed=rig.pinion_speed(point.speed),
        torque=signed_torque(rig, point) if controlled else None,
        twist=None if controlled else setting.twist,
        period="hunting_cycle", drag_torques=drags, longest_time=LONGEST_MARCH,
    )  # fmt: skip
    if not found.steady:
        raise NotConverged(f"march at stage {point.stage!r}: {'; '.join(found.warnings)}")
    torque = _body_torques(system, laws, found)
    turns = found.period * found.speed / (2.0 * pi)
    start = float(np.mean(found.angle_1[0] - found.speed * found.time))
    phi = start + found.speed * found.time
    dofs = np.array(list(torque), np.int64)
    waves = np.array(list(torque.values()))
    loads = []
    for order in orders:
        whole = abs(order * turns - round(order * turns)) < 1e-6
        part = waves @ np.exp(-1j * order * phi) / phi.size if whole else np.zeros(len(waves), complex)
        loads.append(
            OrderLoads(
                order=order, omega=order * found.speed, dofs=dofs, torque=part * (2.0 if order else 1.0)
            )
        )
    return _State(
        loads=loads,
        mean={dof: float(wave.mean()) for dof, wave in torque.items()},
        twist=found.twist,
        drive=found.drive_torque,
        speeds=found.speed * pinion_ratios(system, laws),
    )


def _body_torques(system: LinearSystem, laws: Sequence[MeshLaw], found: PeriodicResponse) -> dict[int, Array]:
    """Torque of the meshes on each gear body over the period, by freedom."""
    torque: dict[int, Array] = {}
    for m, (law, ports) in enumerate(zip(laws, system.mesh_ports.tolist())):
        omega_2 = (law.base_radius_1 * found.omega_1[m] - found.approach_rate[m]) / law.base_radius_2
        reaction = evaluate_mesh(law, found.angle_1[m], found.approach[m], found.omega_1[m], omega_2)
        for dof, wave in zip(ports, (reaction.torque_1, reaction.torque_2)):
            torque[dof] = torque.get(dof, 0.0) + wave
    return torque


@dataclass(frozen=True)
class _InCoupling:
    """Torque in a coupling."""

    joint: Joint
    twisted: bool

    def mean(self, rig: Rig, state: _State, drags: Mapping[str, float]) -> float:
        assert rig.system is not None
        windup = mean_windup(
            rig.system, state.mean, twist=state.twist, drive=state.drive, speed=state.speeds, drags=drags
        )
        turned = float(windup[self.joint.dof_a] - windup[self.joint.dof_b])
        return self.joint.stiffness * (turned - (state.twist if self.twisted else 0.0))

    def amplitude(self, system: LinearSystem, loads: OrderLoads) -> complex:
        first, second = motion_orders(system, loads, (self.joint.dof_a, self.joint.dof_b))
        return complex((self.joint.stiffness + 1j * loads.omega * self.joint.damping) * (first - second))


@dataclass(frozen=True)
class _OfShaft:
    """Angle of a place of a shaft."""

    dof: int

    def mean(self, rig: Rig, state: _State, drags: Mapping[str, float]) -> float:
        return 0.0

    def amplitude(self, system: LinearSystem, loads: OrderLoads) -> complex:
        return complex(motion_orders(system, loads, (self.dof,))[0])


def _place(rig: Rig, parts: Sequence[Joint], channel: Channel) -> _InCoupling | _OfShaft:
    """Where a channel reads; ValueError for a place the drivetrain does not have."""
    drivetrain, system = rig.drivetrain, rig.system
    assert drivetrain is not None and system is not None
    if channel.quantity == "torque":
        for joint in parts:
            if joint.kind == "coupling" and joint.name == channel.place:
                return _InCoupling(joint, drivetrain.bracing_coupling == joint.name)
        known = ", ".join(coupling.name for coupling in drivetrain.couplings) or "none"
        raise ValueError(
            f"channel {channel.name!r}: place = {channel.place!r}: is no coupling; there are {known}"
        )
    stations = [
        i
        for i, name in enumerate(system.dofs)
        if name.rpartition("/")[0] == channel.place and name.endswith(" mm")
    ]
    if not stations:
        known = ", ".join(shaft.name for shaft in drivetrain.shafts)
        raise ValueError(
            f"channel {channel.name!r}: place = {channel.place!r}: is no shaft; there are {known}"
        )
    taken = {
        end
        for coupling in drivetrain.couplings
        for shaft, end in zip(coupling.shafts, coupling.ends)
        if shaft == channel.place
    }
    return _OfShaft(stations[-1] if taken == {"left"} else stations[0])

"""The motion of a braced loop whose orders are read: about the motion with all teeth alike, or over a whole cycle."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Protocol

import numpy as np

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.periodic_load import within_period
from dynamics.errors import DynamicsNotConverged
from dynamics.mesh.flank import alike_teeth
from dynamics.orders.deviation_response import DeviationResponse, OrderLoads, OrderTorque
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.periodic_response import period_length
from dynamics.response.response_curve import CurvePoint
from dynamics.response.speed_sweep import SweepSettings, periodic_response
from rigdesign.coupling.braced_loop import LoadedCircuit, shifted_laws, signed_torque
from rigdesign.coupling.mesh_models import MeshModel, laws_of
from rigdesign.prediction.exact_orders import ExactMotion
from rigdesign.prediction.order_places import OscillatingTorque
from rigdesign.rig.model import Rig

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
    reduced = replace(system, periodic_loads=())
    reduced.__dict__["form"] = system.form
    return reduced


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
        power, law = rig.case.drivetrain, models[0].law
        assert power is not None
        if power.torque_at == rig.mesh_gears(rig.control_mesh)[0]:
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

"""Where the channels of torque and angle read the drivetrain, and what they read of its loads."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.graph import TorsionalJoint
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.orders.deviation_response import OrderLoads
from rigdesign.base.errors import UsageError
from rigdesign.prediction.model import Channel
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class OscillatingTorque:
    """Torque of a motor or coupling that oscillates with a shaft: Re(amplitude load exp(i order phi)) on all freedoms.

    name : of its part; order : per turn of the pinion of the first mesh; load : (n,) per unit
    """

    name: str
    order: float
    amplitude: complex
    load: Array


@dataclass(frozen=True)
class InCoupling:
    """Torque that a coupling transmits, positive where its first shaft is ahead."""

    joint: TorsionalJoint
    twisted: bool

    def mean(self, windup: Array, twist: float) -> float:
        """Mean torque [N m] from the windup of all freedoms and the bracing twist [rad]."""
        turned = float(windup[self.joint.dof_a] - windup[self.joint.dof_b])
        return self.joint.stiffness * (turned - (twist if self.twisted else 0.0))

    def amplitude(self, motion: Complex, omega: float, torques: Sequence[OscillatingTorque]) -> complex:
        """Complex torque [N m] from the angles of all freedoms (n,) [rad] at a frequency [rad/s].

        What the coupling itself adds between its ends is transmitted too.
        """
        turned = motion[self.joint.dof_a] - motion[self.joint.dof_b]
        sprung = (self.joint.stiffness + 1j * omega * self.joint.damping) * turned
        return complex(sprung - sum(torque.amplitude for torque in torques if torque.name == self.joint.name))


@dataclass(frozen=True)
class OfShaft:
    """Angle of a place of a shaft beyond its uniform rotation."""

    dof: int

    def mean(self, windup: Array, twist: float) -> float:
        """Zero: an encoder counts from where it stands."""
        return 0.0

    def amplitude(self, motion: Complex, omega: float, torques: Sequence[OscillatingTorque]) -> complex:
        """Complex angle [rad]."""
        return complex(motion[self.dof])


def motions(system: LinearSystem, loads: Sequence[OrderLoads]) -> Complex:
    """One-sided amplitudes of the angles of all freedoms under the loads of orders above 0 (n_orders, n) [rad].

    As `dynamics.orders.deviation_response.motion_orders`, of all orders at once.
    """
    acting = np.zeros((len(system.inertia), len(loads)), complex)
    for column, one in zip(acting.T, loads):
        np.add.at(column, one.dofs, one.torque)
    form = system.form
    s = 1j * np.array([one.omega for one in loads])
    moved = form.velocity_shapes @ ((form.loads @ acting) / (s - form.poles[:, None]))
    return np.asarray((moved / s).T)


def place_of(rig: Rig, channel: Channel) -> InCoupling | OfShaft:
    """Where a channel of torque or angle reads; UsageError for a place that the drivetrain does not have."""
    drivetrain, system = rig.drivetrain, rig.system
    assert drivetrain is not None and system is not None
    if channel.quantity == "torque":
        for joint in rig.joints:
            if joint.kind == "coupling" and joint.name == channel.place:
                return InCoupling(joint, drivetrain.bracing_coupling == joint.name)
        known = ", ".join(coupling.name for coupling in drivetrain.couplings) or "none"
        raise UsageError(f"channel {channel.name!r}: {channel.place!r} is no coupling; there are {known}")
    stations = [
        i
        for i, name in enumerate(system.dofs)
        if name.rpartition("/")[0] == channel.place and name.endswith(" mm")
    ]
    if not stations:
        known = ", ".join(shaft.name for shaft in drivetrain.shafts)
        raise UsageError(f"channel {channel.name!r}: {channel.place!r} is no shaft; there are {known}")
    taken = {
        end
        for coupling in drivetrain.couplings
        for shaft, end in zip(coupling.shafts, coupling.ends)
        if shaft == channel.place
    }
    return OfShaft(stations[-1] if taken == {"left"} else stations[0])

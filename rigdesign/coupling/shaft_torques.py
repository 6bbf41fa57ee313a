"""Ripple of the motor and excitation of the couplings, as the response and the order analysis want them."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dynamics.drivetrain.shaft_torque import left_out
from dynamics.mesh.law import MeshLaw
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.periodic_response import period_length
from rigdesign.rig.model import Rig


class HarmonicTorque(NamedTuple):
    """Torque Re(amplitude exp(i order phi)) on one freedom of ``rig.system`` [N m].

    order, phi : of the gear at which the case counts, phi zero where its tooth 0 stands at the pitch point
    """

    freedom: int
    order: float
    amplitude: complex


def harmonic_torques(rig: Rig, laws: Sequence[MeshLaw]) -> tuple[HarmonicTorque, ...]:
    """What the case states of motor and couplings, on the freedoms it acts on; empty for a case that states none.

    laws : of the meshes, in the order of the drivetrain
    """
    assert rig.system is not None and rig.case.drivetrain is not None
    if not rig.system.shaft_torques:
        return ()
    ratios = pinion_ratios(rig.system, laws)
    pinion, law = rig.mesh_gears(rig.control_mesh)[0], laws[0]
    turns, ahead = 1.0, 0.0
    if rig.case.drivetrain.torque_at != pinion:
        turns = law.teeth_1 / law.teeth_2
        ahead = 2.0 * math.pi * law.tooth_offset_2 / law.teeth_2
    found = []
    for torques in rig.system.shaft_torques:
        for part in torques.parts:
            order = part.order * float(ratios[torques.dof]) / turns
            value = part.torque * np.exp(-1j * (part.phase + order * ahead))
            found += [
                HarmonicTorque(int(freedom), order, complex(value * torques.load[freedom]))
                for freedom in np.flatnonzero(torques.load)
            ]
    return tuple(found)


def torques_left_out(rig: Rig, laws: Sequence[MeshLaw]) -> list[str]:
    """Part and order of every oscillating torque that the period of the response cannot hold."""
    if rig.system is None or not rig.system.shaft_torques:
        return []
    ratios = pinion_ratios(rig.system, laws)
    pinions = [float(ratios[port]) for port in rig.system.mesh_ports[:, 0]]
    return left_out(
        rig.system.shaft_torques, ratios, period_length(laws, pinions, rig.case.numerics.response_period)
    )

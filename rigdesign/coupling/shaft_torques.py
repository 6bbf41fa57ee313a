"""Ripple of the motor and excitation of the couplings, as the response and the order analysis want them."""

from collections.abc import Sequence

from dynamics.drivetrain.shaft_torque import left_out
from dynamics.mesh.law import MeshLaw
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.periodic_response import period_length
from rigdesign.rig.model import Rig


def torques_left_out(rig: Rig, laws: Sequence[MeshLaw]) -> list[str]:
    """Part and order of every oscillating torque that the period of the response cannot hold."""
    if rig.system is None or not rig.system.shaft_torques:
        return []
    ratios = pinion_ratios(rig.system, laws)
    pinions = [float(ratios[port]) for port in rig.system.mesh_ports[:, 0]]
    return left_out(
        rig.system.shaft_torques, ratios, period_length(laws, pinions, rig.case.numerics.response_period)
    )

"""Ripple of the motor and excitation of the couplings, as the response and the order analysis want them."""

from collections.abc import Sequence

from dynamics.drivetrain.periodic_load import left_out
from dynamics.mesh.law import MeshLaw
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.periodic_response import period_length
from rigdesign.rig.model import Rig


def loads_left_out(rig: Rig, laws: Sequence[MeshLaw]) -> list[str]:
    """Part and order of every oscillating torque that the period of the response cannot hold."""
    if rig.system is None or not rig.system.periodic_loads:
        return []
    ratios = pinion_ratios(rig.system, laws)
    pinions = [float(ratios[port]) for port in rig.system.mesh_ports[:, 0]]
    return left_out(
        rig.system.periodic_loads, ratios, period_length(laws, pinions, rig.case.numerics.response_period)
    )

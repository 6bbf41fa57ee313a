"""Matrices of the power circuit at an operating point: torsional, the same always, or elastic, with its bearings."""

from collections.abc import Mapping

from dynamics.bearing.protocol import BearingState
from dynamics.drivetrain.linear_system import LinearSystem
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig


def loop_system(
    rig: Rig, point: OperatingPoint, coupling_state: CouplingState, bearings: Mapping[str, BearingState]
) -> LinearSystem:
    """Matrices without the meshes.

    bearings : state of every bearing at this point, by ``gearbox.bearing``
    """
    assert rig.system is not None
    return rig.system

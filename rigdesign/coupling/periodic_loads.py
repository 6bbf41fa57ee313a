"""Loads that alternate with a shaft, as the response holds them or leaves them out."""

from collections.abc import Sequence

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.periodic_load import left_out
from dynamics.elastic_rig.seen_system import TURNING
from dynamics.mesh.law import MeshLaw
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.periodic_response import period_length
from rigdesign.rig.model import Rig


def loads_left_out(rig: Rig, laws: Sequence[MeshLaw], system: LinearSystem | None = None) -> list[str]:
    """Part and order of every oscillating torque that the period of the response cannot hold.

    system : of the drivetrain; that of shafts that only twist when left out
    """
    return [name for name in _left_out(rig, laws, system) if not name.startswith(TURNING)]


def lines_left_out(rig: Rig, laws: Sequence[MeshLaw], system: LinearSystem | None) -> list[str]:
    """Shaft lines, by their first loaded shaft, whose unbalance, bow and run-out the period cannot hold."""
    found = (name for name in _left_out(rig, laws, system) if name.startswith(TURNING))
    return list(dict.fromkeys(name.partition(" of ")[2].partition(" order ")[0] for name in found))


def _left_out(rig: Rig, laws: Sequence[MeshLaw], system: LinearSystem | None) -> list[str]:
    system = rig.system if system is None else system
    if system is None or not system.periodic_loads:
        return []
    ratios = pinion_ratios(system, laws)
    pinions = [float(ratios[port]) for port in system.mesh_ports[:, 0]]
    return left_out(
        system.periodic_loads, ratios, period_length(laws, pinions, rig.case.numerics.response_period)
    )

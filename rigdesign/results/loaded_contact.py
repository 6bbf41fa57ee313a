"""Loaded contact of a mesh at a held stage, quasi-static: SI record."""

from dataclasses import dataclass

from dynamics.contact.mesh_cycle import MeshCycle
from dynamics.contact.root_course import RootCourse
from rigdesign.results.gauge_stress import GaugeStress


@dataclass(frozen=True, kw_only=True)
class LoadedContact:
    """Contact of the warm teeth over one mesh cycle, and the root stress it gives."""

    stage: str
    torque: float
    """Mean, at the pinion [N m]."""
    cycle: MeshCycle
    unloaded_contact_ratio: float
    """In the limit of no load, modifications included [-]."""
    roots: tuple[RootCourse, RootCourse]
    """Under the loaded flanks of pinion and wheel."""
    gauges: tuple[GaugeStress, ...] = ()
    """Of both gears, in the order of the case."""

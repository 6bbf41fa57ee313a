"""Loaded contact of a mesh at a held stage, quasi-static: SI record."""

from dataclasses import dataclass

from dynamics.contact.flank_gap import face_sense
from dynamics.contact.mesh_cycle import MeshCycle
from dynamics.contact.root_course import RootCourse
from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.field import Flank
from rigdesign.results.gauge_stress import GaugeStress


@dataclass(frozen=True, kw_only=True)
class LoadedContact:
    """Contact of the warm teeth over one mesh cycle, and the root stress it gives."""

    stage: str
    torque: float
    """Mean, at the pinion, positive on the flanks that carry [N m]."""
    flank: Flank
    """Which flanks carry."""
    axes: AxisMisalignment
    """As made and of the warm housing, over z of the face."""
    cycle: MeshCycle
    unloaded_contact_ratio: float
    """In the limit of no load, modifications included [-]."""
    roots: tuple[RootCourse, RootCourse]
    """Under the loaded flanks of pinion and wheel.

    Face positions of cycle and roots are those of the contact, z times `face_sense`.
    """

    gauges: tuple[GaugeStress, ...] = ()
    """Of both gears, in the order of the case."""

    @property
    def face_sense(self) -> float:
        """Face position z, positive at the end that comes into mesh last, per face position of the contact."""
        return face_sense(self.flank)

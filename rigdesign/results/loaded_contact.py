"""Loaded contact of a mesh at a held stage, quasi-static: SI record."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.flank_gap import face_sense
from dynamics.contact.mesh_cycle import MeshCycle
from dynamics.contact.root_course import RootCourse
from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.field import Flank
from rigdesign.results.gauge_stress import GaugeStress

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class LoadedContact:
    """Contact of the warm teeth over one mesh cycle, and the root stress it gives."""

    stage: str
    torque: float
    """Mean, at the pinion, positive on either flank [N m]."""
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

    at_tangent: tuple[Array, Array] | None = None
    """Highest stress at the 30 deg tangent over the face positions of ``roots`` [Pa]."""
    gauges: tuple[GaugeStress, ...] = ()
    """Of both gears, in the order of the case."""

    @property
    def face_sense(self) -> float:
        """Face position z, positive at the end that comes into mesh last, per face position of the contact."""
        return face_sense(self.flank)

    @cached_property
    def edges(self) -> "EdgeContact":
        """Contact at the tip edges and at the ends of the face."""
        return EdgeContact.of(self.cycle, self.flank)


@dataclass(frozen=True, kw_only=True)
class EdgeContact:
    """Contact where a flank ends; pressures [Pa], 0 without contact.

    tip_pressures : at the tip edges of pinion and wheel; tip_share : largest share of both in the mesh force
    end_pressures : on the flank at both ends of the face, negative z first, away from tip edges; None where the face
        is one position
    middle_pressure : the same at mid-face
    """

    tip_pressures: tuple[float, float]
    tip_share: float
    end_pressures: tuple[float, float] | None
    middle_pressure: float

    @classmethod
    def of(cls, cycle: MeshCycle, flank: Flank) -> "EdgeContact":
        """Over a mesh cycle on the flanks that carry."""
        on_edge, pressure = cycle.edge_contact, cycle.pressure
        carried = (cycle.points.weight * cycle.force * on_edge).sum(axis=(1, 2)) / cycle.mesh_force
        limits = cycle.points.pair.path
        ahead = cycle.points.path < 0.5 * (limits.start + limits.end)
        of_wheel, of_pinion = (
            float(np.where(on_edge & where, pressure, 0.0).max()) for where in (ahead, ~ahead)
        )
        free = np.where(on_edge, 0.0, pressure)
        over_face = free.max(axis=(0, 1))[:: int(face_sense(flank))]
        return cls(
            tip_pressures=(of_pinion, of_wheel),
            tip_share=float(carried.max()),
            end_pressures=(float(over_face[0]), float(over_face[-1])) if len(over_face) > 1 else None,
            middle_pressure=float(over_face[len(over_face) // 2]),
        )

    @property
    def tip_pressure(self) -> float:
        """Higher of both tip edges."""
        return max(self.tip_pressures)

    @property
    def where(self) -> str:
        """Tip edges that carry, in words."""
        named = [gear for gear, one in zip(("pinion", "wheel"), self.tip_pressures, strict=True) if one > 0.0]
        return f"tip edge of {' and '.join(named)}" if named else "no tip edge carries"

    @property
    def end_ratio(self) -> float | None:
        """Higher of both face ends over mid-face [-]; None without ends or without contact in the middle."""
        if self.end_pressures is None or self.middle_pressure == 0.0:
            return None
        return max(self.end_pressures) / self.middle_pressure

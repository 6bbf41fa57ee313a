"""Flanks and axes of a mesh at a held point, as its loaded contact sees them: the flanks that carry, and what the
expansion of the warm housing makes of the axes over the face.

The axes stand as made (``axis_inclination``, ``axis_skew``), are moved by the bores of the warm housing and, where
shafts bend, tilted by them and by the journals in their clearance. Signs: `rigdesign.coupling.mesh_axes`.
"""

from dataclasses import dataclass

from dynamics.contact.flank_gap import face_sense, modified_gap
from dynamics.contact.points import FlankGap
from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.field import Flank
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.mesh.pair_gap import PairGap
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_axes import axes_in_mesh
from rigdesign.coupling.microgeometry import mesh_microgeometry
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class HeldFlanks:
    """Flanks of a warm mesh that carry at a held point, and its axes.

    micro : modifications and deviations of pinion and wheel; axes : over z
    """

    pair: GearPair
    micro: tuple[Microgeometry, Microgeometry]
    axes: AxisMisalignment
    flank: Flank

    @property
    def gap(self) -> FlankGap:
        """Gap of the loaded flanks, all teeth alike with their modifications, at the face positions of the contact.

        Raises DynamicsInputError for a micro-geometry that does not fit.
        """
        return modified_gap(PairGap.of_pair(self.pair, self.micro, self.axes), self.flank)

    @property
    def face_sense(self) -> float:
        """Face position z per face position of the contact, 1 or -1."""
        return face_sense(self.flank)


def held_flanks(rig: Rig, point: PointResult, mesh: int) -> HeldFlanks:
    """Flanks of a mesh, by its number, that its mean torque loads at a held point."""
    name, model = rig.mesh_names[mesh], point.last.models[mesh]
    response = point.last.response
    assert response is not None
    return HeldFlanks(
        pair=model.pair,
        micro=mesh_microgeometry(rig, name, model.pair),
        axes=warm_axes(rig, point, mesh),
        flank="front" if response.flank[mesh] > 0.0 else "back",
    )


def warm_axes(rig: Rig, point: PointResult, mesh: int) -> AxisMisalignment:
    """Misalignment of a mesh as made, by its shafts and by the expansion of its housing, where these are computed."""
    name = rig.mesh_names[mesh]
    expansion = point.last.expansion.get(name.split(".")[0])
    shape = None if expansion is None else expansion.deformed
    return axes_in_mesh(rig, name, point.last.coupling_state, shape)

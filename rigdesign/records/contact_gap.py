"""Flanks and axes of a mesh at a held point, as its loaded contact sees them: the flanks that carry, and what the
expansion of the warm housing makes of the axes over the face.

Signs. Pinion and wheel turn in planes across x, which runs through the housing from front to rear. With e the direction
from pinion to wheel and the pinion turning in the sense sigma about x (+1: clockwise seen from the front), its teeth
pass the mesh towards t = sigma x cross e. Its front flanks look that way and drive the wheel there. Warm axes part over
x by their inclination along e and by their skew along x cross e, the wheel against the pinion, so that

    gap of the front flanks = x (inclination sin(alpha_wt) + sigma skew cos(alpha_wt))
    gap of the back flanks  = x (inclination sin(alpha_wt) - sigma skew cos(alpha_wt))

The face position z is positive at the end that comes into mesh last. A right-hand tooth lies further on in the sense
of rotation about +x at larger x: a right-hand pinion that turns about +x (sigma = 1) comes into mesh first at the
rear, and z = -x; in general z = -sigma h x with h = 1 for a right-hand pinion and -1 for a left-hand one. Spur gears
have z = x. Derived here. The axes stand as made (``axis_inclination``, ``axis_skew``) and are moved by the bores of the
warm housing; clearances of the bearings and bending of the shafts are not in it.
"""

from dataclasses import dataclass

from dynamics.contact.flank_gap import face_sense, modified_gap
from dynamics.contact.points import FlankGap
from dynamics.flank.axes import AxisMisalignment
from dynamics.flank.field import Flank
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.mesh.pair_gap import PairGap
from rigdesign.case.gearbox import Gearbox
from rigdesign.coupling.alignment import AxisAngles, axis_angles
from rigdesign.coupling.loads import mesh_microgeometry
from rigdesign.coupling.loop import PointResult
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
    """Misalignment of a mesh as made and by the expansion of its housing, where that is computed."""
    box, own = rig.mesh_names[mesh].split(".")
    expansion = point.last.expansion.get(box)
    shape = None if expansion is None else expansion.deformed
    return misalignment(rig.case.gearboxes[box], own, axis_angles(rig, box, own, shape))


def misalignment(box: Gearbox, mesh: str, axes: AxisAngles) -> AxisMisalignment:
    """Axes of a mesh of a housing, counted over x from front to rear, over z of its face."""
    last = last_end(box, mesh)
    return AxisMisalignment(
        inclination=last * axes.inclination,
        skew=last * pinion_sense(box, mesh) * axes.skew,
    )


def pinion_sense(box: Gearbox, mesh: str) -> float:
    """Sense in which the pinion of a mesh turns about x: 1 clockwise seen from the front, -1 the other way."""
    meshes = [(box.gears[entry.pinion].shaft, box.gears[entry.wheel].shaft) for entry in box.meshes.values()]
    first = 1.0 if box.rotation == "clockwise" else -1.0
    senses = {meshes[0][0]: first}
    for _ in meshes:
        for pinion, wheel in meshes:
            if pinion in senses:
                senses.setdefault(wheel, -senses[pinion])
            elif wheel in senses:
                senses[pinion] = -senses[wheel]
    return senses.get(box.gears[box.meshes[mesh].pinion].shaft, first)


def last_end(box: Gearbox, mesh: str) -> float:
    """End of the face that comes into mesh last, where z is positive: 1 the rear end of the housing, -1 the front end.

    The rear end for spur and double-helical gears and where the case states no hand.
    """
    entry = box.meshes[mesh]
    pinion, wheel = box.gears[entry.pinion].helix_hand, box.gears[entry.wheel].helix_hand
    if not (pinion or wheel) or not entry.helix_angle or entry.double_helical:
        return 1.0
    right = pinion == "right" if pinion else wheel == "left"
    return -pinion_sense(box, mesh) * (1.0 if right else -1.0)

"""Senses of rotation and ends of the face in a gearbox, from what the case states of one gear each."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigdesign.case.gearbox import Gearbox


def pinion_sense(box: "Gearbox", mesh: str) -> float:
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


def last_end(box: "Gearbox", mesh: str) -> float:
    """End of the face that comes into mesh last, where z is positive: 1 the rear end of the housing, -1 the front end.

    The rear end for spur and double-helical gears and where the case states no hand.
    """
    entry = box.meshes[mesh]
    pinion, wheel = box.gears[entry.pinion].helix_hand, box.gears[entry.wheel].helix_hand
    if not (pinion or wheel) or not entry.helix_angle or entry.double_helical:
        return 1.0
    right = pinion == "right" if pinion else wheel == "left"
    return -pinion_sense(box, mesh) * (1.0 if right else -1.0)

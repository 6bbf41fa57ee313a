"""Senses of rotation, hands of the teeth and ends of the face in a gearbox, from what the case states of one gear."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.gears import GearMesh

Rotation = Literal["clockwise", "anticlockwise"]
Hand = Literal["right", "left"]
OTHER: dict[Hand, Hand] = {"right": "left", "left": "right"}


Shafts = tuple[str, str]


def shaft_senses(
    known: Mapping[str, float], meshes: Sequence[Shafts], couplings: Sequence[tuple[Shafts, Shafts]] = ()
) -> dict[str, float]:
    """Senses of all shafts that meshes and couplings join to known ones, each about its own axis as it is drawn.

    known : 1 clockwise seen from the start of the shaft, -1 the other way
    couplings : names of the two shafts and the ends that meet; two like ends turn a shaft the other way as drawn
    """
    joints = [(pair, -1.0) for pair in meshes]
    joints += [(pair, -1.0 if ends[0] == ends[1] else 1.0) for pair, ends in couplings]
    senses = dict(known)
    for _ in joints:
        for (here, there), sign in joints:
            if here in senses:
                senses.setdefault(there, sign * senses[here])
            elif there in senses:
                senses[here] = sign * senses[there]
    return senses


def pinion_sense(box: "Gearbox", mesh: str) -> float:
    """Sense in which the pinion of a mesh turns about x: 1 clockwise seen from the front, -1 the other way."""
    meshes = mesh_shafts(box)
    first = 1.0 if box.rotation == "clockwise" else -1.0
    senses = shaft_senses({meshes[0][0]: first}, meshes)
    return senses.get(box.gears[box.meshes[mesh].pinion].shaft, first)


def mesh_shafts(box: "Gearbox") -> list[Shafts]:
    """Shafts of pinion and wheel of every mesh."""
    return [(box.gears[entry.pinion].shaft, box.gears[entry.wheel].shaft) for entry in box.meshes.values()]


@dataclass(frozen=True)
class GearHand:
    """Hand of the teeth of a gear, and the gear of which the case states the one it follows from."""

    hand: Hand
    stated: str


def helix_hands(box: "Gearbox") -> dict[str, GearHand]:
    """Hands of the single-helical gears of a gearbox, where one is known.

    A stated hand counts; without one a gear has the other hand than its partners, from mesh to mesh of a train.
    """
    hands = {
        name: GearHand(gear.helix_hand, name)
        for name, gear in box.gears.items()
        if gear.helix_hand is not None
    }
    pairs = [(entry.pinion, entry.wheel) for entry in box.meshes.values() if has_hands(entry)]
    for _ in pairs:
        for pair in pairs:
            for gear, partner in (pair, pair[::-1]):
                if gear in hands and partner not in hands:
                    hands[partner] = GearHand(OTHER[hands[gear].hand], hands[gear].stated)
    return hands


def pinion_hand(box: "Gearbox", mesh: str) -> float:
    """1 for a right-hand pinion, and where the case states no hand; -1 for a left-hand one; 0 where axial forces
    cancel."""
    entry = box.meshes[mesh]
    if not has_hands(entry):
        return 0.0
    found = helix_hands(box).get(entry.pinion)
    return 1.0 if found is None or found.hand == "right" else -1.0


def has_hands(mesh: "GearMesh") -> bool:
    """Whether the gears of a mesh are single-helical."""
    return bool(mesh.helix_angle) and not mesh.double_helical


def last_end(box: "Gearbox", mesh: str) -> float:
    """End of the face that comes into mesh last, where z is positive: 1 the rear end of the housing, -1 the front end.

    The rear end for spur and double-helical gears and where the case states no hand in the train of the mesh.
    """
    entry = box.meshes[mesh]
    found = helix_hands(box).get(entry.pinion)
    if found is None or not has_hands(entry):
        return 1.0
    return -pinion_sense(box, mesh) * (1.0 if found.hand == "right" else -1.0)

"""Rules of the senses of rotation: shafts that are coupled turn together."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.case.rotation import Rotation, mesh_shafts, shaft_senses

if TYPE_CHECKING:
    from rigdesign.case.model import Case


def rotation_faults(case: "Case") -> Iterator[Fault]:
    """Gearboxes whose stated rotation does not fit that of the one they are coupled to."""
    for name, partner, needed in contradicting_rotations(case):
        yield Fault(
            f"gearboxes.{name}.rotation", case.gearboxes[name].rotation,
            f"its shafts are coupled to gearbox {partner}, whose rotation makes it {needed}",
            f"write {needed} or leave it out; correct the ends of the couplings if they meet otherwise",
        )  # fmt: skip


def contradicting_rotations(case: "Case") -> Iterator[tuple[str, str, Rotation]]:
    """(gearbox, gearbox that turns it, rotation it then has) where what the case states does not fit its couplings."""
    train = case.drivetrain
    if train is None:
        return
    meshes = [pair for box in case.gearboxes.values() for pair in mesh_shafts(box)]
    couplings = [(one.shafts, one.ends) for one in train.couplings.values()]
    firsts = {name: mesh_shafts(box)[0][0] for name, box in case.gearboxes.items()}
    settled: dict[str, str] = {}
    senses: dict[str, float] = {}
    for name, box in case.gearboxes.items():
        first = 1.0 if box.rotation == "clockwise" else -1.0
        if firsts[name] not in senses:
            found = shaft_senses({firsts[name]: first}, meshes, couplings)
            settled |= dict.fromkeys(found, name)
            senses |= found
        elif senses[firsts[name]] != first:
            yield name, settled[firsts[name]], "anticlockwise" if first > 0.0 else "clockwise"

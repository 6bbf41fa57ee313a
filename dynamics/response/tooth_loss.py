"""A gear that has lost teeth: where they stood, nothing touches, on either flank.

A lost tooth is one whose flanks stand back by more than the gears can approach each other; all other teeth keep their
law. Which teeth carry at an instant follows from the angle of the pinion.
"""

from typing import Literal

import numpy as np

from dynamics.errors import DynamicsInputError
from dynamics.mesh.force import tooth_forces
from dynamics.mesh.law import MeshLaw, back_deviations

Member = Literal["pinion", "wheel"]

GONE = 0.05
"""Gap of a tooth that is not there [m]: beyond what a loop unwinds by."""


def teeth_in_mesh(law: MeshLaw, angle: float, approach: float, member: Member, count: int) -> tuple[int, ...]:
    """Numbers of adjacent teeth of a gear: the one that carries most, then those that come next.

    angle : of the pinion [rad]; approach : of the gears [m]

    Raises DynamicsInputError where no tooth carries.
    """
    forces = tooth_forces(law, angle, approach)
    front, back = forces.front[0].sum(axis=1), forces.back[0].sum(axis=1)
    force, behind = (back, 1) if back.sum() > front.sum() else (front, 0)
    if not force.max() > 0.0:
        raise DynamicsInputError(
            f"approach = {approach:.3g} m: no tooth carries; load the mesh before one is lost"
        )
    first = int(forces.pair[0, int(force.argmax())])
    pairs = range(first, first + count)
    if member == "pinion":
        return tuple(pair % law.teeth_1 for pair in pairs)
    return tuple((pair + law.tooth_offset_2 + behind) % law.teeth_2 for pair in pairs)


def without_teeth(law: MeshLaw, member: Member, teeth: tuple[int, ...]) -> MeshLaw:
    """The law of a mesh one of whose gears has lost teeth.

    Raises DynamicsInputError for no teeth, or so many that the gears cannot roll on.
    """
    number = law.teeth_1 if member == "pinion" else law.teeth_2
    if not 0 < len(set(teeth)) < number:
        raise DynamicsInputError(f"lost teeth {teeth}: must be from 1 to {number - 1} of {number}")
    front = law.deviation_1 if member == "pinion" else law.deviation_2
    back = back_deviations(law)[member == "wheel"]
    gaps = []
    for own in (front, back):
        gap = np.tile(own, (number, 1)) if len(own) == 1 else own.copy()
        gap[[tooth % number for tooth in teeth]] += GONE
        gaps.append(gap)
    other = law.deviation_2 if member == "pinion" else law.deviation_1
    other_back = back_deviations(law)[member == "pinion"]
    if member == "pinion":
        return law._replace(
            deviation_1=gaps[0], back_deviation_1=gaps[1], deviation_2=other, back_deviation_2=other_back
        )
    return law._replace(
        deviation_1=other, back_deviation_1=other_back, deviation_2=gaps[0], back_deviation_2=gaps[1]
    )

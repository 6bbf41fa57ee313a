"""Gap of flanks with modifications, deviations and misalignment, as the contact asks for it.

Beyond the path a tip corner touches the mating flank away from the line of action; the metal removed there is that of
the places that touch.
"""

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.points import FlankGap
from dynamics.flank.field import Flank
from dynamics.mesh.pair_gap import PairGap

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def modified_gap(gap: PairGap, flank: Flank = "front") -> FlankGap:
    """What modifications, axes and unequal base pitches of a pair leave between its flanks, all teeth alike.

    flank : on which the pair runs. A gear turned about a tooth axis by half a turn is the same gear with its back
        flanks in front and its face turned round: the face positions of the contact then count against z.
    """
    sense = face_sense(flank)

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        pinion, wheel = gap.flanks
        place = sense * face
        return (
            gap.of_axes(path, place, flank)
            + pinion.modification(rolls[0], place, flank)
            + wheel.modification(rolls[1], place, flank)
        )

    return of_points


def face_sense(flank: Flank) -> float:
    """Face position z of the gears per face position of the contact: 1 on the front flanks, -1 on the back flanks."""
    return 1.0 if flank == "front" else -1.0


def flank_gap(gap: PairGap) -> FlankGap:
    """The same with the deviations of single teeth."""
    modified = modified_gap(gap)

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        pinion, wheel = gap.flanks
        return (
            modified(pair, face, path, rolls)
            + pinion.deviation(rolls[0], face, pair)
            + wheel.deviation(rolls[1], face, pair + wheel.count.tooth_offset_2)
        )

    return of_points

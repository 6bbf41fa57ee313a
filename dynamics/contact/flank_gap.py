"""Gap of flanks with micro-geometry and misalignment, as the contact asks for it."""

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.points import FlankGap
from dynamics.gear.pair import GearPair
from dynamics.mesh.flank import flank_modification
from dynamics.mesh.microgeometry import Microgeometry

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def microgeometry_gap(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], misalignment: float = 0.0
) -> FlankGap:
    """Gap that the modifications of pinion and wheel leave, all teeth alike.

    micro : of pinion and wheel, without deviations of single teeth
    misalignment : gap per face width [rad], growing with z
    """

    def gap(numbers: Integers, face: Array, path: Array) -> Array:
        total = misalignment * face
        for position in np.unique(face):
            here = face == position
            for index, gear in enumerate(micro):
                total[here] += flank_modification(pair, gear, index, path[here], position[None])[0]
        return total

    return gap

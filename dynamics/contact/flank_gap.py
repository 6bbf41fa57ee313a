"""Gap of flanks with modifications, deviations and misalignment, as the contact asks for it."""

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.points import FlankGap
from dynamics.mesh.pair_gap import PairGap

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def flank_gap(gap: PairGap) -> FlankGap:
    """What flanks, axes and unequal base pitches of a pair leave between its front flanks, every tooth its own."""

    def of_points(numbers: Integers, face: Array, path: Array) -> Array:
        return gap.modifications(path, face) + gap.deviations(path, face, numbers)

    return of_points


def modified_gap(gap: PairGap) -> FlankGap:
    """The same without deviations: all teeth alike."""

    def of_points(numbers: Integers, face: Array, path: Array) -> Array:
        return gap.modifications(path, face)

    return of_points

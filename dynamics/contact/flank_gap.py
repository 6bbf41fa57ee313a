"""Gap of flanks with modifications, deviations and misalignment, as the contact asks for it.

Beyond the path a tip corner touches the mating flank away from the line of action; the metal removed there is that of
the places that touch.
"""

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.points import FlankGap
from dynamics.mesh.pair_gap import PairGap

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def modified_gap(gap: PairGap) -> FlankGap:
    """What modifications, axes and unequal base pitches of a pair leave between its front flanks, all teeth alike."""

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        pinion, wheel = gap.flanks
        return (
            gap.of_axes(path, face) + pinion.modification(rolls[0], face) + wheel.modification(rolls[1], face)
        )

    return of_points


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

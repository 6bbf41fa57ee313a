"""Gap of every place of every tooth pair: flanks of both gears, axes, expansion, corners beyond the path."""

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.flank.axes import PARALLEL, AxisMisalignment
from dynamics.flank.field import AT_PITCH_POINT, Flank, FlankField, TeethInMesh, require_whole_flanks
from dynamics.flank.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.mesh.tip_contact import tip_separation

Array = NDArray[np.float64]
FLAWLESS = (Microgeometry(), Microgeometry())


@dataclass(frozen=True, kw_only=True)
class PairGap:
    """Gap of the unloaded teeth of a pair along the transverse line of action, from pinion and wheel [m].

    flanks : of pinion and wheel; axes : how far these are from parallel

    Pair p, path position and teeth are those of ``dynamics.mesh.law``: on the front flanks pair p joins pinion tooth p
    with wheel tooth p + tooth_offset_2, on the back with the one after it; a path position on the back flanks is that
    of the mirrored path. A helical face position z sees its own path position, s - z tan(beta_b) of the pair's in
    front and s + z tan(beta_b) on the back.
    """

    pair: GearPair
    flanks: tuple[FlankField, FlankField]
    axes: AxisMisalignment = PARALLEL

    @classmethod
    def of_pair(
        cls,
        pair: GearPair,
        micro: tuple[Microgeometry, Microgeometry] = FLAWLESS,
        axes: AxisMisalignment = PARALLEL,
        count: TeethInMesh = AT_PITCH_POINT,
    ) -> "PairGap":
        """Gap of a pair with whole flanks.

        Raises GearGeometryError for pointed teeth and undercut within the path, DynamicsInputError for a
        micro-geometry that does not fit.
        """
        require_whole_flanks(pair)
        return cls(pair=pair, flanks=flank_fields(pair, micro, count), axes=axes)

    def at(self, path: ArrayLike, face: ArrayLike, pair_number: ArrayLike, flank: Flank = "front") -> Array:
        """Gap along the transverse line of action [m]; the shapes of the arguments are broadcast.

        path : position on the path from the pitch point, also beyond its ends [m]; face : from mid-face [m];
        pair_number : any integer
        """
        places = np.atleast_1d(np.asarray(path, dtype=np.float64))
        corner = tip_separation(self.pair, places.ravel()).reshape(np.shape(path))
        return (
            corner + self.modifications(path, face, flank) + self.deviations(path, face, pair_number, flank)
        )

    def normal(
        self, path: ArrayLike, face: ArrayLike, pair_number: ArrayLike, flank: Flank = "front"
    ) -> Array:
        """Gap along the normal of the flanks [m], cos(beta_b) of that along the transverse line of action."""
        return cos(self.pair.base_helix_angle) * self.at(path, face, pair_number, flank)

    def modifications(self, path: ArrayLike, face: ArrayLike, flank: Flank = "front") -> Array:
        """What every tooth pair has on the active path: modifications, misalignment, difference of base pitches [m].

        Gears of unequal thermal expansion keep the ratio of their tooth numbers; the difference of their base pitches
        becomes a gap along the path.
        """
        gap = self.of_axes(path, face, flank)
        for gear in self.flanks:
            gap = gap + gear.modification(gear.roll(path), face, flank)
        return np.asarray(gap)

    def of_axes(self, path: ArrayLike, face: ArrayLike, flank: Flank = "front") -> Array:
        """Misalignment and difference of base pitches [m]."""
        front, back = self.axes.gap_slope(self.pair)
        gap = np.asarray(path) * self.pair.base_pitch_difference / self.pair.base_pitch
        return np.asarray(gap + (front if flank == "front" else back) * np.asarray(face))

    def deviations(
        self, path: ArrayLike, face: ArrayLike, pair_number: ArrayLike, flank: Flank = "front"
    ) -> Array:
        """What the two teeth of a pair have beyond the others [m]."""
        pinion, wheel = self.flanks
        first = np.asarray(pair_number, dtype=np.int64)
        second = first + wheel.count.tooth_offset_2 + (flank == "back")
        return pinion.deviation(pinion.roll(path), face, first, flank) + wheel.deviation(
            wheel.roll(path), face, second, flank
        )


def flank_fields(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], count: TeethInMesh = AT_PITCH_POINT
) -> tuple[FlankField, FlankField]:
    """Flanks of pinion and wheel; raises DynamicsInputError for a micro-geometry that does not fit."""
    return (
        FlankField(pair=pair, index=0, micro=micro[0], count=count),
        FlankField(pair=pair, index=1, micro=micro[1], count=count),
    )

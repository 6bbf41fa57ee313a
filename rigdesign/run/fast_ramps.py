"""Ramps that pass a resonance faster than the time run updates the bearing positions.

From one speed band to the next the time run changes the mean position of the gears in their bearings, hence the
approach of their flanks, over the time `FADE` (`dynamics.response.band_change`). A band that is passed in less is left
before the change is complete.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from dynamics.response.band_change import FADE
from rigdesign.coupling.loop_over_speed import band_limits
from rigdesign.records.curves import own_ratio
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.units import RPM

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class PassedBand:
    """A band of speed that was entered at one end and left at the other.

    low, high : speeds of the first pinion [rad/s]; start, duration : in the run [s]
    """

    low: float
    high: float
    start: float
    duration: float


def fast_ramps(solved: SolvedRig) -> Iterator[str]:
    """Of every stage the band with a resonance that it passes fastest, where that takes less than `FADE`."""
    if solved.run is None or solved.loads is None:
        return
    rig, ramp = solved.rig, solved.run.ramp
    stages = rig.case.schedule.resolved()
    limits = band_limits(rig, (0.0, max(stage.speed_end for stage in stages)))
    resonances = [
        (one.speed / own_ratio(rig, mesh), rig.mesh_labels[name])
        for mesh, name in enumerate(rig.mesh_names)
        for one in solved.loads.meshes[rig.mesh_labels[name]].resonances
    ]
    ends = list(accumulate(stage.duration for stage in stages))
    worst: dict[int, tuple[PassedBand, float, str]] = {}
    for band in passed_bands(ramp.time, ramp.speed, limits):
        inside = [one for one in resonances if band.low < one[0] < band.high]
        if inside and band.duration < FADE:
            at = min(int(np.searchsorted(ends, band.start, "right")), len(stages) - 1)
            if at not in worst or band.duration < worst[at][0].duration:
                worst[at] = band, *min(inside)
    for number, (band, speed, mesh) in worst.items():
        stage = stages[number]
        longer = stage.duration * FADE / band.duration
        yield (
            f"stage {stage.name}: time in the band of {band.low * RPM:.0f} to {band.high * RPM:.0f} rpm with the "
            f"resonance of {mesh} at {speed * RPM:.0f} rpm = {band.duration:.3g} s, limit {FADE:g} s, in which the "
            "time run updates the bearing positions: its torques there lie between those of two bands; give the stage "
            f"{longer:.2g} s or more, or use the periodic response"
        )


def passed_bands(time: Array, speed: Array, limits: Sequence[float]) -> Iterator[PassedBand]:
    """Bands between two limits [rad/s] that a run passes from end to end, in the order in which it does.

    time, speed : (n,) of the samples [s], [rad/s]
    """
    band = np.searchsorted(limits, speed)
    first = np.flatnonzero(np.diff(band, prepend=-1))
    for here, after in pairwise(first[1:]):
        number = int(band[here])
        if 0 < number < len(limits) and (band[here - 1] - number) * (band[after] - number) < 0:
            yield PassedBand(
                low=limits[number - 1],
                high=limits[number],
                start=float(time[here]),
                duration=float(time[after] - time[here]),
            )

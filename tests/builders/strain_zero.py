"""The zero of a recorded bridge output over time: from readings without load or the unloaded part of each turn."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ZeroReadings:
    """Outputs without load, straight in between and constant outside: run-to-zero before and after a run.

    time : (n,) increasing [s]; ratio : (n,) U_B / U_E [V/V]
    """

    time: tuple[float, ...]
    ratio: tuple[float, ...]

    def __post_init__(self) -> None:
        faulty = not self.time or len(self.time) != len(self.ratio) or not np.all(np.diff(self.time) > 0.0)
        if faulty or not np.all(np.isfinite([*self.time, *self.ratio])):
            raise MeasurementError([Fault(
                "zero", f"{len(self.time)} times, {len(self.ratio)} readings", "must be as many, increasing in time",
                "read the zero before and after the run",
            )])  # fmt: skip

    def at(self, time: Array) -> Array:
        """(n,) zero [V/V]."""
        return np.interp(time, self.time, self.ratio)


@dataclass(frozen=True)
class UnloadedAngles:
    """Part of a turn in which neither the tooth with the gauge nor its neighbours carry.

    The zero found there removes offset, drift and thermal output, and with them what does not change over a turn:
    centrifugal and press-fit stress.

    start, end : rolling angles [rad], end above start, less than a turn apart
    """

    start: float
    end: float

    def __post_init__(self) -> None:
        if not 0.0 < self.end - self.start < 2.0 * np.pi:
            raise MeasurementError([Fault(
                "unloaded", f"{self.start:.4g} to {self.end:.4g} rad", "must be above 0 and less than a turn",
                "write where the tooth with the gauge is out of mesh",
            )])  # fmt: skip

    def readings(self, time: Array, angle: Array, ratio: Array) -> ZeroReadings:
        """Mean output and time of the unloaded part of every turn that has samples there.

        Parameters
        ----------
        time, angle, ratio : (n,) [s], [rad], [V/V]; NaN where missing

        Raises
        ------
        MeasurementError
            No sample in that part of any turn.
        """
        known = np.isfinite(angle) & np.isfinite(ratio)
        turn, place = np.divmod(angle[known] - self.start, 2.0 * np.pi)
        inside = place <= self.end - self.start
        index = turn[inside].astype(int)
        if not index.size:
            raise MeasurementError([Fault(
                "unloaded", f"{self.start:.4g} to {self.end:.4g} rad", "no sample there", "widen it or record longer",
            )])  # fmt: skip
        index -= index.min()
        count = np.bincount(index)
        used = count > 0
        moments, means = (
            np.bincount(index, values[known][inside])[used] / count[used] for values in (time, ratio)
        )
        if len(moments) > 1:
            moments, means = _to_the_ends(moments, means, time)
        return ZeroReadings(tuple(moments.tolist()), tuple(means.tolist()))


def _to_the_ends(moments: Array, means: Array, time: Array) -> tuple[Array, Array]:
    """The line through the first and the last two readings, drawn on to the ends of the record."""
    slopes = np.diff(means) / np.diff(moments)
    first, last = min(time[0], moments[0]), max(time[-1], moments[-1])
    means = means + np.array(
        [slopes[0] * (first - moments[0]), *np.zeros(len(means) - 2), slopes[-1] * (last - moments[-1])]
    )
    return np.concatenate([[first], moments[1:-1], [last]]), means

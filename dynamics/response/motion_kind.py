"""What kind of steady motion a march shows: of the mesh period, of several of them, modulated or chaotic.

A motion that repeats after n periods of its excitation is subharmonic of order n. One that never repeats is chaotic if
two marches from nearly the same state part exponentially (largest Lyapunov exponent by neighbouring trajectories:
Benettin et al., Meccanica 15 (1980) 9), else it has a second frequency of its own and is quasi-periodic. One that
swings so slowly that neighbouring periods look alike shows in the extremes of a longer time. Both are known of gear
pairs with backlash: Kahraman & Blankenship, J. Appl. Mech. 64 (1997) 217.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Kind = Literal["periodic", "subharmonic", "quasi-periodic", "chaotic"]

REPEATS = 0.02
"""Difference of a period from an earlier one, over the peak-to-peak value, up to which it repeats [-]."""
WATCHED = 0.2
"""Time over which a motion that repeats is watched for a slow swing of its extremes [s]."""
LONGEST = 12
"""Periods after which a motion is sought to repeat at most."""
CHAOTIC = 0.02
"""Growth of a small difference per period from which a motion is chaotic [-]: e-fold in 50 periods."""


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Kind of a motion.

    periods : after which it repeats, 0 if it does not; growth : of a small difference per period [-], 0 if not asked
    """

    kind: Kind
    periods: int
    growth: float = 0.0

    def __str__(self) -> str:
        match self.kind:
            case "periodic":
                return "periodic"
            case "subharmonic":
                return f"subharmonic, repeats after {self.periods} periods"
            case "quasi-periodic":
                return (
                    "quasi-periodic: it does not repeat, and a small difference does not grow "
                    f"({self.growth:+.3f} per period)"
                )
        return f"chaotic: a small difference grows by exp({self.growth:.3f}) in every period"


PERIODIC = Motion(kind="periodic", periods=1)


def repeats_after(force: Array, steps: int, longest: int = LONGEST) -> int:
    """Fewest periods after which a motion repeats; 0 if it does not.

    force : (n_meshes, n) over whole periods of ``steps``, of which at least twice ``longest`` are compared if there
        are that many
    """
    waves = force.reshape(len(force), -1, steps)
    scale = np.maximum(np.ptp(force, axis=1), 1e-3 * np.abs(force).max(axis=1)) + 1e-300
    for periods in range(1, min(longest, waves.shape[1] // 2) + 1):
        # what creeps from one to the next shows between the first and the last of them
        apart = [np.ptp(waves[:, first::periods], axis=1).max(axis=1) for first in range(periods)]
        if np.all(np.max(apart, axis=0) <= REPEATS * scale):
            return periods
    return 0


def swings(extremes: Array, periods: int, size: Array) -> bool:
    """Whether a motion that seemed to repeat after ``periods`` swings over a longer time.

    extremes : (n_meshes, n, 2) least and greatest force of n periods; size : (n_meshes,) peak-to-peak value
    """
    apart = [np.ptp(extremes[:, first::periods], axis=1).max(axis=1) for first in range(periods)]
    scale = np.maximum(size, 1e-3 * np.abs(extremes).max(axis=(1, 2))) + 1e-300
    return bool(np.any(np.max(apart, axis=0) > REPEATS * scale))


def growth_per_period(distance: Array) -> float:
    """Mean growth of the logarithm of a distance over its periods, up to where it is no longer small [-].

    distance : (n,) between two motions in every period, relative to their size
    """
    small = np.flatnonzero(distance > 1e-2)
    end = int(small[0]) if small.size else len(distance)
    used = np.log(np.maximum(distance[:end], 1e-300))
    if len(used) < 3:
        return math.inf if len(distance) >= 3 else 0.0
    place = np.arange(len(used))
    return float(np.polyfit(place, used, 1)[0])


def kind_of(periods: int, growth: float = 0.0) -> Motion:
    """Motion that repeats after ``periods``, or does not repeat and lets small differences grow."""
    if periods:
        return Motion(kind="periodic" if periods == 1 else "subharmonic", periods=periods)
    return Motion(kind="chaotic" if growth > CHAOTIC else "quasi-periodic", periods=0, growth=growth)

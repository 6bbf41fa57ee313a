"""Low-pass over the path that keeps a march free of aliasing.

A march sees a mesh at the ends of its steps only. Teeth that come in and out excite far above half the step rate: at
12,000 rpm and eight steps in 25 us, every sixteenth of their harmonics stands just beside the step rate and would act
as a slow force. Here the potential of a mesh loses what the steps do not resolve before it is tabulated; it stays a
potential. The force of the unfiltered law is kept beside it, to be recorded.

The march holds the torque within a step by Numerov's method (`dynamics.response.step_hold`). The table anticipates what
that makes of each of its harmonics (``hold_response``).

Source: Shannon 1949; Numerov's method as in Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I,
III.10.
"""

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

KEPT, LOST = 0.3, 0.7
"""Cycles in a step up to which all is kept, and from which all is lost."""
RESOLVED = 128
"""Steps in a base pitch with which a march needs no filter: what is left of the next harmonics does not matter."""
LEAST_CELLS = 128
"""Cells of a filtered base pitch, for the force that is recorded."""
TAIL = 4.0
"""Steps that a filtered pair reaches beyond its path."""


@dataclass(frozen=True, kw_only=True)
class PathFilter:
    """Low-pass of a flank that moves along its path.

    step : path that the flank takes in a step of the march, with its direction [m]
    """

    step: float

    def response(self, cycles: NDArray[np.floating[Any]]) -> Array:
        """Factor of parts of the potential that have so many cycles per path [1/m]."""
        per_step = cycles * self.step
        kept = np.clip((np.abs(per_step) - KEPT) / (LOST - KEPT), 0.0, 1.0)
        shares = np.cos(0.5 * np.pi * kept) ** 2
        return np.asarray(shares / hold_response(np.clip(per_step, -0.5, 0.5)))

    def acts_on(self, pitch: float) -> bool:
        """Whether teeth with this base pitch come in and out faster than the steps resolve [m]."""
        return abs(self.step) * RESOLVED > pitch

    def cells(self, pitch: float, most: int) -> int:
        """Cells of a base pitch [m] that hold what is left, three to its shortest wave, at ``most``."""
        wanted = 8 * ceil(3.0 * LOST * pitch / abs(self.step) / 8.0)
        return min(max(wanted, LEAST_CELLS), most)


def hold_response(cycles: Array) -> Array:
    """What the hold of the march makes of an oscillation with so many cycles in a step: displacement of a free mass
    over the exact one, 1 for slow ones.

    Numerov's x_1 - 2 x_0 + x_-1 = h^2 / 12 (f_1 + 10 f_0 + f_-1) with f = cos(theta n), exact -f / omega^2.
    """
    angle = np.maximum(2.0 * np.pi * np.abs(cycles), 1e-3)
    return np.asarray(angle**2 * (10.0 + 2.0 * np.cos(angle)) / (24.0 * (1.0 - np.cos(angle))))

"""Low-pass over the path that keeps a march free of aliasing.

A march sees a mesh at the ends of its steps only. Teeth that come in and out excite far above half the step rate: at
12,000 rpm and eight steps in 25 us, every sixteenth of their harmonics stands just beside the step rate and would act
as a slow force. Here the potential of a mesh loses what the steps do not resolve before it is tabulated; it stays a
potential. The force of the unfiltered law is kept beside it, to be recorded.

The march takes the torque within a step as the cubic through its four last values (``hold_response``). The table
anticipates what that makes of each of its harmonics.

Source: Shannon 1949; the response of an interpolation as in Unser, IEEE Signal Process. Mag. 16, 1999.
"""

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

KEPT, LOST = 0.3, 0.7
"""Cycles in a step up to which all is kept, and from which all is lost."""
RESOLVED = 128
"""Steps in a base pitch with which a march needs no filter: what is left of the next harmonics does not matter."""
LEAST_CELLS = 128
"""Cells of a filtered base pitch, for the force that is recorded."""
TAIL = 4.0
"""Steps that a filtered pair reaches beyond its path."""
HOLD = (-2.0, -1.0, 0.0, 1.0)
"""Instants, in steps from the start of a step, through which the torque within it is a cubic."""


@dataclass(frozen=True, kw_only=True)
class PathFilter:
    """Low-pass of a flank that moves along its path.

    step : path that the flank takes in a step of the march, with its direction [m]
    """

    step: float

    def response(self, cycles: NDArray[np.floating[Any]]) -> ComplexArray:
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


def hold_response(cycles: Array) -> ComplexArray:
    """What the hold of the march makes of an oscillation with so many cycles in a step: a factor, 1 for slow ones."""
    points, weights = np.polynomial.legendre.leggauss(12)
    at, weights = 0.5 * (points + 1.0), 0.5 * weights
    total = np.zeros(np.shape(cycles), complex)
    for node in HOLD:
        others = [other for other in HOLD if other != node]
        share = np.prod([(at - other) / (node - other) for other in others], axis=0)
        turned = np.exp(2j * np.pi * np.multiply.outer(cycles, node - at))
        total += turned @ (weights * share)
    return total

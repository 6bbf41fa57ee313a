"""Second-order backward differences over time steps of growing length: a warm-up in a few implicit steps.

With y0, y1 the last two fields, h the step and w its ratio to the one before, the new field y satisfies

    C (y - b) / s + R(y) = 0,   s = h (1 + w) / (1 + 2 w),   b = ((1 + w)^2 y1 - w^2 y0) / (1 + 2 w),

which is the implicit step of `StoredHeat` from b over s; the first step is implicit Euler's. Steps that grow
in geometric progression follow the fast rise after the start and the slow approach to steady alike. Stable for ratios
below 1 + sqrt(2) (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, ch. III.5; Grigorieff, Numer.
Math. 42 (1983) 359).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermal.conduction.capacity import StoredHeat
from thermal.fe.mesh import FloatArray

STEPS = 12
"""Steps of a warm-up."""
SPREAD = 3.0
"""Length of its last step over that of its first."""


def step_lengths(time: float, count: int = STEPS, spread: float = SPREAD) -> FloatArray:
    """(count,) lengths of the steps [s], each longer than the one before by the same ratio; they add up to ``time``."""
    lengths = np.geomspace(1.0, spread, count) if count > 1 else np.ones(1)
    return np.asarray(lengths * (time / lengths.sum()))


@dataclass(frozen=True)
class WarmingBody:
    """The last two fields of a body that warms up.

    capacity : body of the mesh -> density times specific heat [J/(m3 K)]
    latest, before : (n_nodes,) or one value [K]; ``before`` is None at the start
    length : of the step between them [s]
    """

    capacity: Mapping[str, float]
    latest: FloatArray | float
    before: FloatArray | float | None = None
    length: float = 0.0

    def step(self, length: float, kind: str) -> StoredHeat:
        """The condition of the next step; ``length`` [s], ``kind`` as its rows in the heat balance."""
        if self.before is None:
            return StoredHeat(capacity=self.capacity, start=self.latest, time=length, kind=kind)
        w = length / self.length
        start = ((1.0 + w) ** 2 * self.latest - w**2 * self.before) / (1.0 + 2.0 * w)
        time = length * (1.0 + w) / (1.0 + 2.0 * w)
        return StoredHeat(capacity=self.capacity, start=start, time=time, kind=kind)

    def after(self, field: FloatArray, length: float) -> "WarmingBody":
        """With the field (n_nodes,) that a step of ``length`` [s] ended with."""
        return WarmingBody(self.capacity, field, self.latest, length)

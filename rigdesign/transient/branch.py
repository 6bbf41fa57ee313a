"""Temperatures and clearances of one housing over the schedule, or over what an event makes of it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.alignment import Alignment
from rigdesign.transient.clearances import Clearances
from rigdesign.transient.phases import Timeline
from thermal.expansion.alignment import ShaftAxis

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Branch(Timeline):
    """Thermal history of one housing: over the schedule, or over what an event makes of it."""

    temperatures: Mapping[str, FloatArray]
    """Probe -> (n,) [K]."""
    clearances: tuple[Clearances, ...]
    """At every time."""
    alignment: tuple[Alignment, ...]
    """At every time."""
    axes: tuple[Mapping[str, ShaftAxis], ...]
    """Hot axis of every shaft at every time."""
    energy_closure: float
    warnings: tuple[str, ...]

    def ends(self, name: str) -> int:
        """Number of the last time of a phase."""
        number = [phase.name for phase in self.phases].index(name)
        return int(np.flatnonzero(self.phase == number)[-1])

"""Root stress at a strain gauge, and what its bridge gives: SI record."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rigdesign.strain_gauge.gauge_curve import GaugeCurve
from rigdesign.strain_gauge.measuring_point import MeasuringPoint

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class GaugeStress:
    """Quasi-static, of one tooth on its way through the mesh."""

    name: str
    gear: str
    """``pinion`` or ``wheel`` of the mesh."""
    tooth: int
    front: bool
    """Under the front flank, else under the back flank; the first is pulled where the mesh runs on its front flanks."""
    point: MeasuringPoint
    curve: GaugeCurve

    @cached_property
    def output(self) -> Array:
        """(n,) output of the bridge over its supply, balanced without load, at the angles of the curve [V/V]."""
        return np.asarray(self.point.ratio(self.curve.stress) - self.point.ratio(0.0))

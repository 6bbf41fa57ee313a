"""A measuring point: gauge, bridge and surface, from stress to bridge output and back."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.strain_gauge.bridge import Bridge
from rigdesign.strain_gauge.placement import (
    GaugePlacement,
    RootRegion,
    check_inside,
)
from rigdesign.strain_gauge.surface_stress import SurfaceStress

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StrainRecord:
    """Recorded bridge output of one measuring point.

    time : (n,) increasing [s]; ratio : (n,) U_B / U_E [V/V], NaN where missing; overloaded : samples at the input range
    """

    time: Array
    ratio: Array
    overloaded: int = 0


@dataclass(frozen=True, kw_only=True)
class MeasuringPoint:
    """One strain gauge with its bridge, on the surface of the tooth root.

    Parameters
    ----------
    name : as the rig has it, e.g. "II"
    placement, region : where it sits and what part of the root there is

    Raises
    ------
    CaseError
        The grid reaches over the face or the fillet.
    """

    name: str
    bridge: Bridge
    surface: SurfaceStress
    placement: GaugePlacement
    region: RootRegion

    def __post_init__(self) -> None:
        check_inside(self.name, self.bridge.gauge, self.placement, self.region)

    @property
    def strain_factor(self) -> float:
        """Indicated strain over strain along the fillet [-]: transverse sensitivity and misalignment."""
        return self.bridge.gauge.indicated(self.surface.strain_ratio, self.placement.misalignment)

    def ratio(self, stress: float | Array, temperature: float | Array | None = None) -> Array:
        """Bridge output U_B / U_E [V/V], not balanced, at stresses (n,) along the fillet [Pa]."""
        return self.bridge.ratio(self.strain_factor * self.surface.strain(stress), temperature)

    def stress(
        self,
        ratio: float | Array,
        zero: float | Array | None = None,
        temperature: float | Array | None = None,
    ) -> Array:
        """Stress along the fillet (n,) [Pa] from the bridge output (n,) [V/V]; the exact inverse of `ratio`.

        Parameters
        ----------
        zero : output without load (n,) or one of all [V/V]; None: that of the bridge itself at ``temperature``
        temperature : of gauge and root [K]; None: without thermal output

        Raises
        ------
        MeasurementError
            An output that no strain gives.
        """
        output = np.asarray(ratio, dtype=float)
        if zero is not None:
            output = output - zero + self.bridge.ratio(0.0, temperature)
        return self.surface.stress(self.bridge.strain(output, temperature) / self.strain_factor)

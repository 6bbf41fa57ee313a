"""A foil strain gauge: its grid, its gauge factor, and what it reads without being strained."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.units import ZERO_CELSIUS, refuse, require_above

Array = NDArray[np.float64]
REFERENCE_TEMPERATURE = 20.0 + ZERO_CELSIUS
"""Temperature at which data sheets give gauge factor and resistance [K]."""
CALIBRATION_POISSON_RATIO = 0.285
"""Of the beam on which makers find the gauge factor (Micro-Measurements TN-509)."""


@dataclass(frozen=True, kw_only=True)
class ThermalOutput:
    """Apparent strain of an unloaded gauge over its temperature, as the data sheet of its package has it.

    Parameters
    ----------
    coefficients : (m,) a_i in a_0 + a_1 t + a_2 t^2 + ..., strain [m/m] over t in degC
    gauge_factor : at which the polynomial is stated (Micro-Measurements: 2.0); None: that of the gauge
    expansion_mismatch : expansion coefficient of the part less that the gauge is matched to [1/K]
    """

    coefficients: tuple[float, ...]
    gauge_factor: float | None = None
    expansion_mismatch: float = 0.0

    def __post_init__(self) -> None:
        if not self.coefficients or not np.all(np.isfinite(self.coefficients)):
            refuse(
                "thermal_output.coefficients", str(self.coefficients), "must be numbers, one at least",
                "write those of the package, in strain: 1 um/m is 1e-6",
            )  # fmt: skip
        if self.gauge_factor is not None:
            require_above(
                "thermal_output.gauge_factor", self.gauge_factor, "", "write that of the data sheet"
            )

    def strain(self, temperature: float | Array, gauge_factor: float) -> Array:
        """Apparent strain [-] at ``temperature`` [K] of a gauge with ``gauge_factor``."""
        celsius = np.asarray(temperature, dtype=float) - ZERO_CELSIUS
        scale = 1.0 if self.gauge_factor is None else self.gauge_factor / gauge_factor
        stated = np.polynomial.polynomial.polyval(celsius, np.array(self.coefficients, dtype=float))
        mismatch = self.expansion_mismatch * (np.asarray(temperature, dtype=float) - REFERENCE_TEMPERATURE)
        return np.asarray(scale * stated + mismatch)


@dataclass(frozen=True, kw_only=True)
class StrainGauge:
    """Foil strain gauge.

    Parameters
    ----------
    gauge_factor : k, relative change of resistance over strain along the grid [-]
    resistance : [ohm]
    grid_length, grid_width : of the grid, along and across its wires [m]
    transverse_sensitivity : K_t, sensitivity across over along the grid [-]
    gauge_factor_slope : relative change of k over temperature [1/K]
    thermal_output : None: not corrected

    Raises
    ------
    CaseError
        k, resistance or grid not above zero; a transverse sensitivity beyond +-0.2.
    """

    gauge_factor: float = 2.0
    resistance: float = 120.0
    grid_length: float
    grid_width: float
    transverse_sensitivity: float = 0.0
    gauge_factor_slope: float = 0.0
    thermal_output: ThermalOutput | None = None

    def __post_init__(self) -> None:
        sheet = "write that of its data sheet"
        require_above("gauge_factor", self.gauge_factor, "", f"{sheet}, 2.0 to 2.2 for constantan")
        require_above("resistance", self.resistance, "ohm", f"{sheet}, 120 or 350 ohm as a rule")
        require_above("grid_length", self.grid_length, "m", sheet)
        require_above("grid_width", self.grid_width, "m", sheet)
        if not abs(self.transverse_sensitivity) <= 0.2:
            refuse(
                "transverse_sensitivity", f"{self.transverse_sensitivity:.6g}", "must lie within -0.2 to 0.2",
                f"{sheet} as a share: 0.2 % is 0.002",
            )  # fmt: skip

    def factor_at(self, temperature: float | Array | None) -> float | Array:
        """Gauge factor at ``temperature`` [K]; None: that of the data sheet."""
        if temperature is None:
            return self.gauge_factor
        excess = np.asarray(temperature, dtype=float) - REFERENCE_TEMPERATURE
        return np.asarray(self.gauge_factor * (1.0 + self.gauge_factor_slope * excess))

    def thermal_strain(self, temperature: float | Array | None) -> float | Array:
        """Apparent strain [-] at ``temperature`` [K]; zero where either is not known."""
        if temperature is None or self.thermal_output is None:
            return 0.0
        return self.thermal_output.strain(temperature, self.gauge_factor)

    def indicated(self, transverse_ratio: float, misalignment: float = 0.0) -> float:
        """Strain a gauge indicates by its gauge factor over the strain in the direction it is meant to measure.

        eps_ind = (eps_along + K_t eps_across) / (1 - nu_0 K_t), with both strains turned by the misalignment as
        Mohr's circle has it, shear being zero in the direction that is meant.

        Parameters
        ----------
        transverse_ratio : strain across over strain along the direction that is meant [-]
        misalignment : angle between the grid and that direction [rad]

        Source: Micro-Measurements TN-509 (transverse sensitivity) and TN-511 (misalignment), from memory.
        """
        along = np.cos(misalignment) ** 2 + transverse_ratio * np.sin(misalignment) ** 2
        across = np.sin(misalignment) ** 2 + transverse_ratio * np.cos(misalignment) ** 2
        sensitivity = self.transverse_sensitivity
        return float((along + sensitivity * across) / (1.0 - CALIBRATION_POISSON_RATIO * sensitivity))

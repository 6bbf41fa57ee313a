"""Spectra of the mesh torque as rows of the result."""

from typing import Any

from rigdesign.results.spectra import HeldSpectrum, Waterfall
from rigdesign.results.units import RPM

DIGITS = 4
"""Significant digits of the amplitudes of a waterfall: it is looked at, not computed with."""


def waterfall_row(found: Waterfall) -> dict[str, Any]:
    """Amplitudes by speed and frequency."""
    return {
        "gearbox": found.mesh,
        "stage": found.stage,
        "pinion_speed_rpm": [speed * RPM for speed in found.speed],
        "frequency_Hz": list(found.frequency),
        "amplitude_Nm": [[float(f"{value:.{DIGITS}g}") for value in row] for row in found.amplitude],
        "teeth": found.per_turn,
    }


def spectrum_row(found: HeldSpectrum) -> dict[str, Any]:
    """Amplitudes over the order of the pinion."""
    return {
        "gearbox": found.mesh,
        "stage": found.stage,
        "pinion_speed_rpm": found.speed * RPM,
        "mean_Nm": found.mean,
        "teeth": found.teeth,
        "order": list(found.order),
        "amplitude_Nm": list(found.amplitude),
        "mesh_harmonic_order": list(found.harmonic_order),
        "mesh_harmonic_amplitude_Nm": list(found.harmonic_amplitude),
    }

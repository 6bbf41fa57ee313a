"""Root stress in motion as rows of the result."""

from typing import Any

import numpy as np

from rigdesign.results.dynamic_root import DynamicRootCurve, DynamicRootRecord
from rigdesign.results.units import MPA, RPM

MICRO = 1e6


def dynamic_root_rows(record: DynamicRootRecord) -> dict[str, Any]:
    """Curves over the rolling angle and the speeds without one."""
    return {
        "curves": [_curve(curve) for curve in record.curves],
        "missing": [{"speed_rpm": one.speed * RPM, "reason": one.reason} for one in record.missing],
    }


def _curve(curve: DynamicRootCurve) -> dict[str, Any]:
    return {
        "gearbox": curve.mesh,
        "gear": curve.gear,
        "gauge": curve.gauge,
        "stage": curve.stage,
        "in_motion": curve.in_motion,
        "pinion_speed_rpm": curve.pinion_speed * RPM,
        "highest_MPa": max(curve.dynamic) * MPA,
        "highest_quasi_static_MPa": max(curve.quasi_static) * MPA,
        "ratio": curve.ratio,
        "highest_strain_um_m": max(curve.strain) * MICRO,
        "highest_strain_rate_per_s": curve.highest_rate,
        "rolling_angle_deg": np.degrees(curve.angle).tolist(),
        "dynamic_MPa": [stress * MPA for stress in curve.dynamic],
        "quasi_static_MPa": [stress * MPA for stress in curve.quasi_static],
        "strain_um_m": [strain * MICRO for strain in curve.strain],
        "strain_rate_per_s": list(curve.strain_rate),
        "source": curve.source,
    }

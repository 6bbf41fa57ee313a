"""Rolling bearings as rows of the result."""

import math
from typing import Any

from rigdesign.results.rolling_bearings import RollingBearingRecord
from rigdesign.results.units import RPM, UM, ZERO

N_UM = 1e-6
"""Newtons per micrometre in a newton per metre."""
KNM_RAD = 1e-3
"""Kilonewton metres in a newton metre."""


def rolling_bearing_row(found: RollingBearingRecord) -> dict[str, Any]:
    """One rolling bearing at one stage; a life without end is None."""
    rolling, sliding, seals, drag = found.torques
    return {
        "bearing": found.name,
        "stage": found.stage,
        "designation": found.designation,
        "radial_load_N": found.radial_load,
        "axial_load_N": found.axial_load,
        "minimum_load_N": found.minimum_load,
        "speed_rpm": RPM * found.speed,
        "speed_utilisation": found.speed_utilisation,
        "rolling_torque_Nm": rolling,
        "sliding_torque_Nm": sliding,
        "seal_torque_Nm": seals,
        "drag_torque_Nm": drag,
        "friction_W": found.power,
        "temperature_degC": found.temperature - ZERO,
        "inner_ring_degC": found.inner_ring - ZERO,
        "outer_ring_degC": found.outer_ring - ZERO,
        "heat_to_shaft_W": found.heat_to_shaft,
        "heat_to_housing_W": found.heat_to_housing,
        "operating_clearance_um": UM * found.clearance,
        "basic_life_h": _finite(found.basic_life),
        "modified_life_h": _finite(found.modified_life),
        "static_safety": _finite(found.static_safety),
        "viscosity_ratio": found.viscosity_ratio,
        "radial_stiffness_N_um": N_UM * found.radial_stiffness,
        "axial_stiffness_N_um": N_UM * found.axial_stiffness,
        "tilting_stiffness_kNm_rad": KNM_RAD * found.tilting_stiffness,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None

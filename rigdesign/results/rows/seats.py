"""Press fits and splines as rows of the result."""

from typing import Any

from rigdesign.results.seats import PressFitCapacity, SplineStress
from rigdesign.results.units import MPA, UM, ZERO


def press_fit_row(found: PressFitCapacity) -> dict[str, Any]:
    """Interference, pressure, torques."""
    return {
        "gear": found.gear,
        "where": found.where,
        "stage": found.stage,
        "interference_um": UM * found.interference,
        "interference_hot_um": UM * found.interference_hot,
        "gear_degC": found.gear_temperature - ZERO,
        "shaft_degC": found.shaft_temperature - ZERO,
        "pressure_at_rest_MPa": MPA * found.pressure_at_rest,
        "pressure_MPa": MPA * found.pressure,
        "friction": found.friction,
        "slip_torque_Nm": found.slip_torque,
        "peak_torque_Nm": found.peak_torque,
        "safety": found.safety,
    }


def spline_stress_row(found: SplineStress) -> dict[str, Any]:
    """Torque, stress and what is allowed."""
    return {
        "gear": found.gear,
        "where": found.where,
        "kind": found.kind,
        "torque_Nm": found.torque,
        "stress_MPa": MPA * found.stress,
        "allowable_MPa": MPA * found.allowable,
        "safety": found.safety,
    }

"""Stresses of splines as rows of the result."""

from typing import Any

from rigdesign.results.spline_capacity import SplineStress
from rigdesign.results.units import MPA


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

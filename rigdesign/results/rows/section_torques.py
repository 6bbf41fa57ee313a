"""Dynamic torque in shafts, joints and meshes as rows of the result."""

from collections.abc import Sequence
from typing import Any

from rigdesign.results.section_torques import (
    HeldTorque,
    RunTorque,
    SectionTorqueRecord,
    TorquePlace,
    TorqueSwing,
)
from rigdesign.results.units import MM, MPA, RPM


def section_torque_rows(record: SectionTorqueRecord) -> dict[str, Any]:
    """Held stages, all places over speed, and the stages of the time run."""
    return {
        "held": [_held(held) for held in record.held],
        "over_speed": {
            "torque": record.torque,
            "speed_rpm": [speed * RPM for speed in record.speeds],
            "places": [_place(curve.place) | _columns(curve.swings) for curve in record.curves],
        },
        "time_run": [_run(torque) for torque in record.run],
    }


def _held(held: HeldTorque) -> dict[str, Any]:
    return _place(held.place) | {
        "stage": held.stage,
        "speed_rpm": held.speed * RPM,
        "mean_Nm": held.swing.mean,
        "half_peak_to_peak_Nm": held.swing.half_peak_to_peak,
        "peak_Nm": held.swing.peak,
        "time_run_peak_Nm": held.run_peak,
        "shear_stress_MPa": None if held.shear_stress is None else held.shear_stress * MPA,
    }


def _run(torque: RunTorque) -> dict[str, Any]:
    return _place(torque.place) | {
        "stage": torque.stage,
        "peak_Nm": torque.peak,
        "shear_stress_MPa": None if torque.shear_stress is None else torque.shear_stress * MPA,
        "half_peak_to_peak_Nm": torque.half_peak_to_peak,
        "mean_Nm": torque.mean,
        "time_s": torque.time,
        "speed_rpm": torque.speed * RPM,
    }


def _place(place: TorquePlace) -> dict[str, Any]:
    return {
        "place": place.name,
        "kind": place.kind,
        "part": place.part,
        "from_mm": None if place.start is None else place.start * MM,
        "to_mm": None if place.end is None else place.end * MM,
    }


def _columns(swings: Sequence[TorqueSwing]) -> dict[str, list[float]]:
    return {
        "mean_Nm": [swing.mean for swing in swings],
        "half_peak_to_peak_Nm": [swing.half_peak_to_peak for swing in swings],
        "peak_Nm": [swing.peak for swing in swings],
    }

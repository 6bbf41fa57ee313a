"""Modes, torques and speeds to avoid as rows of the result."""

from collections.abc import Sequence
from typing import Any

from rigdesign.results.units import MM, MPA, RPM
from rigdesign.results.vibration import (
    AvoidedBand,
    AvoidedResonance,
    CampbellRecord,
    DwellRecord,
    DwellStage,
    HeldTorque,
    RunTorque,
    SectionTorqueRecord,
    TorquePlace,
    TorqueSwing,
)


def campbell_row(record: CampbellRecord) -> dict[str, Any]:
    """Modes over speed, orders and crossings."""
    return {
        "speed_rpm": [speed * RPM for speed in record.speeds],
        "modes": [
            {
                "mode": mode.number,
                "shape": mode.name,
                "driven_by": mode.driven_by,
                "frequency_Hz": list(mode.frequency),
                "damping_ratio": list(mode.damping_ratio),
                "logarithmic_decrement": list(mode.logarithmic_decrement),
                "whirl": list(mode.whirl),
                "gain": dict(mode.gain),
            }
            for mode in record.modes
        ],
        "orders": [
            {
                "kind": order.kind,
                "of": list(order.of),
                "harmonic": order.harmonic,
                "per_turn": order.cycles,
            }
            for order in record.orders
        ],
        "crossings": [
            {
                "mode": crossing.mode,
                "kind": crossing.kind,
                "of": list(crossing.of),
                "harmonic": crossing.harmonic,
                "speed_rpm": crossing.speed * RPM,
                "frequency_Hz": crossing.frequency,
                "damping_ratio": crossing.damping_ratio,
                "gain": crossing.gain,
            }
            for crossing in record.crossings
        ],
        "modes_left_out": record.left_out,
    }


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


def dwell_row(record: DwellRecord) -> dict[str, Any]:
    """Bands, what is left, stages, recommended ramp."""
    return {
        "share_limit": record.share_limit,
        "shaft_share_limit": record.shaft_share_limit,
        "margin": record.margin,
        "low_rpm": record.low * RPM,
        "high_rpm": record.high * RPM,
        "speed_limit_rpm": None if record.speed_limit is None else record.speed_limit * RPM,
        "speed_limit_source": record.speed_limit_source,
        "bands": [_band(band) for band in record.bands],
        "safe": [{"low_rpm": low * RPM, "high_rpm": high * RPM} for low, high in record.safe],
        "stages": [_stage(stage) for stage in record.stages],
        "ramp": [
            {
                "step": number,
                "action": step.action,
                "speed_rpm": step.speed * RPM,
                "torque_Nm": step.torque,
                "reason": step.reason,
            }
            for number, step in enumerate(record.ramp, start=1)
        ],
        "highest": {
            "speed_rpm": [speed * RPM for speed in record.speeds],
            **{kind.replace(" ", "_"): list(values) for kind, values in record.highest.items()},
        },
    }


def _band(band: AvoidedBand) -> dict[str, Any]:
    return {
        "low_rpm": band.low * RPM,
        "high_rpm": band.high * RPM,
        "resonances": [_resonance(one) for one in band.resonances],
    }


def _resonance(one: AvoidedResonance) -> dict[str, Any]:
    return {
        "kind": one.kind,
        "where": one.where,
        "speed_rpm": one.speed * RPM,
        "share": one.share,
        "low_rpm": one.low * RPM,
        "high_rpm": one.high * RPM,
    }


def _stage(stage: DwellStage) -> dict[str, Any]:
    band, near = stage.band, None if stage.near is None else stage.near.resonance
    return {
        "stage": stage.stage,
        "kind": stage.kind,
        "speed_rpm": stage.speed * RPM,
        "computed": stage.computed,
        "band": None if band is None else {"low_rpm": band.low * RPM, "high_rpm": band.high * RPM},
        "nearest_safe_rpm": None if stage.nearest_safe is None else stage.nearest_safe * RPM,
        "nearest_resonance": None if near is None else _resonance(near),
        "distance": None if stage.near is None else stage.near.distance,
        "above_limit": stage.above_limit,
        "loses_contact_at_start_torque": stage.loses_contact,
    }

"""Speeds at which a rig may dwell as rows of the result."""

from typing import Any

from rigdesign.results.dwell import AvoidedBand, AvoidedResonance, DwellRecord, DwellStage
from rigdesign.results.units import RPM


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

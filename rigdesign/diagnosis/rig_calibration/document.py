"""calibration.json of a rig: its values, how well they are known, and what the sets say of each other."""

from collections.abc import Mapping
from math import exp
from typing import Any

from rigdesign.base.json_text import to_plain
from rigdesign.base.version import __version__
from rigdesign.case.model import Case
from rigdesign.diagnosis.rig_calibration.estimate import Estimate
from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration

SCHEMA = 2
"""Of calibration.json; raise it where a value changes its meaning: a file of another one is refused."""

UNLIKE = "this set does not look like the others: leave it out or find out why"
UNLIKE_TWO = (
    "these two sets do not look like each other: find out what changed between them, or measure a third one"
)


def calibration_document(calibrated: RigCalibration) -> dict[str, Any]:
    """The document; plain values, numbers with ten significant digits at most.

    Raises
    ------
    NonFiniteResultError
        If a number is not finite.
    """
    case = calibrated.case
    document = {
        "schema_version": SCHEMA,
        "tool_version": __version__,
        "case": {"name": case.name, "hash": case.hash, "gears": gears_of(case)},
        "sets": [
            {
                "name": name,
                "title": one.title,
                "path": str(one.folder),
                "hash": one.hash,
                "points": len(one.points),
                "channels": list(one.channels),
            }
            for name, one in zip(calibrated.names, calibrated.measurements, strict=True)
        ],
        "values": [_value(one) for one in calibrated.fit.estimates],
        "leave_one_out": [
            {
                "set": row.name,
                "baseline": row.baseline,
                "calibrated_by": list(row.calibrated_by),
                "verdict": row.verdict,
                "alarm": row.alarm,
                "named": list(row.named),
                "reason": row.reason,
                "numbers": row.numbers,
                "chi_square_per_number": row.chi_square,
                "chi_square_per_number_shipped": row.before,
            }
            for row in calibrated.left_out
        ],
        "unlike_the_others": list(calibrated.odd),
        "advice": advice(calibrated),
    }
    plain = to_plain(document)
    assert isinstance(plain, dict)
    return plain


def _value(one: Estimate) -> dict[str, Any]:
    return {
        "name": one.name,
        "kind": one.kind,
        "value": one.used,
        "fitted": one.fitted,
        "spread_factor": exp(one.spread),
        "shipped": one.shipped,
    }


def gears_of(case: Case) -> Mapping[str, Mapping[str, int]]:
    """Teeth by gearbox and gear: by them a rig is known again, whatever constants of its case were changed."""
    return {
        box: {name: gear.teeth for name, gear in gearbox.gears.items()}
        for box, gearbox in case.gearboxes.items()
    }


def advice(calibrated: RigCalibration) -> list[str]:
    """What the sets say of each other, in sentences."""
    odd, rows = calibrated.odd, calibrated.left_out
    texts = []
    if len(calibrated.names) == len(odd) == 2:
        texts.append(f"{' and '.join(odd)}: {UNLIKE_TWO}")
    else:
        texts += [f"{name}: {UNLIKE}" for name in odd]
    alone = [row for row in rows if row.alarm and row.baseline is not None and row.name not in odd]
    texts += [f"{row.name} with baseline {row.baseline}: an alarm, {row.reason}" for row in alone]
    against = [row.name for row in rows if row.alarm and row.baseline is None]
    if against:
        texts.append(
            f"against the model alone {', '.join(against)} {'give alarms' if len(against) > 1 else 'gives an alarm'}: "
            "diagnose with a healthy set as baseline"
        )
    return texts

"""calibration.json of a rig: its values, how well they are known, and what the sets say of each other."""

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import replace
from math import exp
from pathlib import Path
from typing import Any

from rigdesign.base.errors import WIDEST_PLACE, UsageError, shortened
from rigdesign.base.json_text import to_plain
from rigdesign.base.version import __version__
from rigdesign.case.model import Case
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration, Origin
from rigdesign.diagnosis.rig_calibration.estimate import OF_THE_MEASUREMENT, Estimate, with_values
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
                "title": measurement.title,
                "path": str(measurement.folder),
                "hash": measurement.hash,
                "points": len(measurement.points),
                "channels": list(measurement.channels),
            }
            for name, measurement in zip(calibrated.names, calibrated.measurements, strict=True)
        ],
        "values": [_value(estimate) for estimate in calibrated.fit.estimates],
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


def _value(estimate: Estimate) -> dict[str, Any]:
    return {
        "name": estimate.name,
        "kind": estimate.kind,
        "value": estimate.used,
        "fitted": estimate.fitted,
        "spread_factor": exp(estimate.spread),
        "shipped": estimate.shipped,
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


# calibration.json of a rig read back for a diagnosis; refused where it is not of this rig or not whole.

FILE = "calibration.json"
NAME = "name the file that `rigdesign calibrate` wrote"
AGAIN = "run `rigdesign calibrate` again"


def load_rig_calibration(path: Path, case: Case, shipped: Calibration = DEFAULT) -> Calibration:
    """The calibration of a rig from the file, or the folder, that `rigdesign calibrate` wrote.

    Raises
    ------
    UsageError
        A file that cannot be read, is damaged or of another version, belongs to another rig, or holds a value that is
        unknown, missing, not finite or negative.
    """
    file = path / FILE if path.is_dir() else path
    where = f"calibration {shortened(str(file), WIDEST_PLACE)}"
    try:
        content = file.read_bytes()
    except OSError as error:
        raise UsageError(f"{where}: cannot be read ({error.strerror}); {NAME}") from error
    try:
        document = json.loads(content)
    except ValueError as error:
        raise UsageError(f"{where}: damaged, it is no JSON ({error}); {AGAIN}") from error
    _check_version(document, where)
    try:
        _check_rig(document["case"], case, where)
        values = {row["name"]: row["value"] for row in document["values"]}
        origin = Origin(
            kind="file",
            path=str(file),
            hash=hashlib.sha256(content).hexdigest(),
            case_hash=str(document["case"]["hash"]),
            sets=tuple(str(healthy_set["title"]) for healthy_set in document["sets"]),
            odd=tuple(str(name) for name in document["unlike_the_others"]),
        )
    except (KeyError, TypeError) as error:
        raise UsageError(f"{where}: damaged, {error} is missing or of another kind; {AGAIN}") from error
    return replace(with_values(shipped, _checked(values, shipped, where)), origin=origin)


def _check_version(document: Any, where: str) -> None:
    version = document.get("schema_version") if isinstance(document, dict) else None
    if version is None:
        raise UsageError(f"{where}: no schema_version, so this is no calibration of a rig; {NAME}")
    if version != SCHEMA:
        raise UsageError(f"{where}: schema_version = {shortened(str(version))}, must be {SCHEMA}; {AGAIN}")
    if "values" not in document:
        raise UsageError(f"{where}: no values, so this is no calibration of a rig; {NAME}")


def _check_rig(made_with: Mapping[str, Any], case: Case, where: str) -> None:
    """The name of the case and the teeth of its gears; constants may have been changed since, as by a patch."""
    if made_with["name"] != case.name:
        name = shortened(str(made_with["name"]))
        raise UsageError(
            f"{where}: of the case {name}, not of {case.name}; calibrate this rig by sets of its own"
        )
    if made_with["gears"] != gears_of(case):
        raise UsageError(
            f"{where}: of a rig with the gears {shortened(str(made_with['gears']))}, the case has "
            f"{shortened(str(gears_of(case)))}; calibrate this rig by sets of its own"
        )


def _checked(values: Mapping[str, Any], shipped: Calibration, where: str) -> dict[str, float]:
    """Every value known, finite and not negative, none of the drift missing."""
    amplitudes = {
        f"amplitudes.{name}" for name in shipped.amplitudes.as_dict() if name not in OF_THE_MEASUREMENT
    }
    shares = {f"drift.{name}" for name in shipped.drift.scales}
    unknown = [
        name for name in values if name not in amplitudes | shares and not name.startswith("channels.")
    ]
    if unknown:
        raise UsageError(f"{where}: unknown value {shortened(', '.join(unknown))}; {AGAIN}")
    if missing := sorted(shares - set(values)):
        raise UsageError(f"{where}: damaged, {', '.join(missing)} is missing; {AGAIN}")
    for name, value in values.items():
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (number and math.isfinite(value) and value >= 0.0):
            raise UsageError(
                f"{where}: {shortened(name)} = {shortened(str(value))}, must be finite and at least zero; {AGAIN}"
            )
    return {name: float(value) for name, value in values.items()}

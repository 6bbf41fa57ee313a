"""calibration.json of a rig read back for a diagnosis; refused where it is not of this rig or not whole."""

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from rigdesign.base.errors import WIDEST_PLACE, UsageError, shortened
from rigdesign.case.model import Case
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration, Origin
from rigdesign.diagnosis.rig_calibration.document import SCHEMA, gears_of
from rigdesign.diagnosis.rig_calibration.estimate import OF_THE_MEASUREMENT, with_values

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
            sets=tuple(str(one["title"]) for one in document["sets"]),
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

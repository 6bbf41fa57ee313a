"""What `rigdesign diagnose` writes: the document, the page, and the patches where they are not refused."""

import json
from pathlib import Path

from rigdesign.base.json_text import to_plain, to_text
from rigdesign.base.output_folder import remove_published, write_texts
from rigdesign.case.model import Case
from rigdesign.diagnosis.decision.patch import case_patch, variant_text
from rigdesign.diagnosis.document.document import diagnosis_document, measurement_patch
from rigdesign.diagnosis.document.outcome import CasePatch, Outcome
from rigdesign.diagnosis.rig_calibration.document import calibration_document
from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration
from rigdesign.diagnosis.run import Calibrated
from rigdesign.report.pages.diagnosis import diagnosis_page, rig_calibration_page

PATCHES = [
    "case.patch.json",
    "patched/case.toml",
    "suspected.patch.json",
    "suspected/case.toml",
    "measurement.patch.json",
]
"""Files that a verdict may leave out; those of an earlier run are removed then."""


def write_diagnosis(outcome: Outcome, out: Path) -> None:
    """Write diagnosis.json, diagnosis.html and the patches, each whole or not at all.

    The case and the measurement are not written to. ``patched/case.toml`` extends the case by a relative path.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    NonFiniteResultError
        If a number of the document is not finite; nothing is written then.
    """
    texts = diagnosis_texts(outcome, out)
    write_texts(out, texts)
    remove_published(out, [name for name in PATCHES if name not in texts])
    for folder in ("patched", "suspected"):
        if f"{folder}/case.toml" not in texts and _is_empty(out / folder):
            (out / folder).rmdir()


def diagnosis_texts(outcome: Outcome, out: Path) -> dict[str, str]:
    """Name of every file for ``out`` -> its text."""
    document = diagnosis_document(outcome)
    texts = {"diagnosis.html": diagnosis_page(outcome, document)}
    if outcome.case_patch is not None:
        texts |= _patch_texts(outcome.result.case, outcome.case_patch, "case.patch.json", out / "patched")
    if outcome.offered is not None:
        texts |= _patch_texts(outcome.result.case, outcome.offered, "suspected.patch.json", out / "suspected")
    if outcome.corrections:
        texts["measurement.patch.json"] = to_text(measurement_patch(outcome))
    texts["diagnosis.json"] = to_text(document)
    return texts


def _patch_texts(case: Case, patch: CasePatch, name: str, folder: Path) -> dict[str, str]:
    """The JSON Patch, and the case with it as a variant in a folder."""
    operations = to_plain(case_patch(case, patch.title, patch.values))
    return {
        name: json.dumps(operations, indent=1, ensure_ascii=False, allow_nan=False) + "\n",
        f"{folder.name}/case.toml": variant_text(case, patch.title, patch.values, folder),
    }


def _is_empty(folder: Path) -> bool:
    return folder.is_dir() and not any(folder.iterdir())


# What `rigdesign calibrate` writes: calibration.json and the page, or the case with fitted constants.


def write_rig_calibration(calibrated: RigCalibration, out: Path) -> None:
    """Write calibration.json and calibration.html, each whole or not at all.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    NonFiniteResultError
        If a number of the document is not finite; nothing is written then.
    """
    document = calibration_document(calibrated)
    page = rig_calibration_page(calibrated, document)
    write_texts(out, {"calibration.html": page, "calibration.json": to_text(document)})


def write_constants(calibrated: Calibrated, out: Path) -> None:
    """Write calibrated/case.toml, which extends the case, and constants.json with the covariance of the constants.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    """
    found = calibrated.constants
    document = {
        "case": {"name": calibrated.case.name, "hash": calibrated.case.hash},
        "measurement": {"title": calibrated.measurement.title, "hash": calibrated.measurement.hash},
        "constants": [
            {
                "effect": entry.effect.name,
                "parameter": entry.effect.parameters[0].name,
                "unit": entry.effect.parameters[0].unit,
                "value": entry.effect.parameters[0].value(entry.coordinate),
                "coordinate": "logarithm" if entry.effect.parameters[0].factor else "value",
                "deviation": entry.deviation,
                "deviation_before": entry.before,
            }
            for entry in found.entries
        ],
        "covariance": found.covariance.tolist(),
    }
    text = variant_text(calibrated.case, calibrated.title, calibrated.values, out / "calibrated")
    write_texts(out, {"calibrated/case.toml": text, "constants.json": to_text(document)})

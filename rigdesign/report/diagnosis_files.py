"""What `rigdesign diagnose` writes: the document, the page, and the patches where they are not refused."""

import json
from pathlib import Path

from rigdesign.base.json_text import to_plain, to_text
from rigdesign.base.output_folder import remove_published, staged
from rigdesign.diagnosis.decision.patch import case_patch, variant_text
from rigdesign.diagnosis.document.document import diagnosis_document, measurement_patch
from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.report.pages.diagnosis import diagnosis_page

PATCHES = ["case.patch.json", "patched/case.toml", "measurement.patch.json"]
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
    with staged(out) as scratch:
        for name, text in texts.items():
            file = scratch / name
            file.parent.mkdir(exist_ok=True)
            file.write_text(text, encoding="utf-8", newline="\n")
    remove_published(out, [name for name in PATCHES if name not in texts])
    if "patched/case.toml" not in texts and _is_empty(out / "patched"):
        (out / "patched").rmdir()


def diagnosis_texts(outcome: Outcome, out: Path) -> dict[str, str]:
    """Name of every file for ``out`` -> its text."""
    document = diagnosis_document(outcome)
    texts = {"diagnosis.html": diagnosis_page(outcome, document)}
    patch = outcome.case_patch
    if patch is not None:
        case = outcome.result.case
        operations = to_plain(case_patch(case, patch.title, patch.values))
        texts["case.patch.json"] = (
            json.dumps(operations, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
        )
        texts["patched/case.toml"] = variant_text(case, patch.title, patch.values, out / "patched")
    if outcome.corrections:
        texts["measurement.patch.json"] = to_text(measurement_patch(outcome))
    texts["diagnosis.json"] = to_text(document)
    return texts


def _is_empty(folder: Path) -> bool:
    return folder.is_dir() and not any(folder.iterdir())

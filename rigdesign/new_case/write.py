"""Writes a new case: loaded before it appears, whole or not at all, over nothing."""

import json
import tempfile
from pathlib import Path

from rigdesign.base.errors import CaseError, Fault, OutputError
from rigdesign.base.output_folder import prepare_output, staged
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.case.schema import json_schema
from rigdesign.case.source import CASE_FILE
from rigdesign.new_case.case_text import SCHEMA_FILE, commented_text, plain_text
from rigdesign.new_case.outline import FLAGS, AnswerFault, AnswersError, Outline

PLACES = {
    ".teeth": "teeth",
    ".normal_module": "module",
    ".centre_distance": "centre_distance",
    ".profile_shift": "profile_shift",
    ".face_width": "face_width",
    ".all_bearings": "bearings",
    ".bearings": "bearings",
    ".oil.oil": "oil",
    "_temperature": "oil_temperature",
    ".oil": "lubrication",
    ".housing": "box",
    "schedule.test_speed": "speed",
    "schedule.test_torque": "torque",
}
"""Part of the path of a fault -> the answer it comes from; the first that fits counts."""


def write_case(outline: Outline, out: Path) -> tuple[Path, ...]:
    """Write case.toml and the schema that editors check it with.

    Raises
    ------
    AnswersError
        Answers that no case can be made of, each by its flag.
    OutputError
        The folder cannot be written, or holds one of the files already.
    """
    paths = free_paths(out)
    text = commented_text(outline, _tried(outline), out)
    with staged(out) as scratch:
        (scratch / CASE_FILE).write_text(text, encoding="utf-8", newline="\n")
        (scratch / SCHEMA_FILE).write_text(schema_text(), encoding="utf-8", newline="\n")
        load_case(scratch / CASE_FILE)
    return paths


def free_paths(out: Path) -> tuple[Path, ...]:
    """Paths of the files of a new case.

    Raises
    ------
    OutputError
        The folder cannot be written, or holds one of the files already.
    """
    paths = (out / CASE_FILE, out / SCHEMA_FILE)
    for path in paths:
        if path.exists() or path.is_symlink():
            raise OutputError(f"{path} is there already; remove it or give another folder with --out")
    prepare_output(out)
    return paths


def schema_text() -> str:
    """The JSON Schema as the file that ``#:schema`` names."""
    return json.dumps(json_schema(), ensure_ascii=False, separators=(",", ":")) + "\n"


def _tried(outline: Outline) -> Case:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / CASE_FILE
        file.write_text(plain_text(outline), encoding="utf-8")
        try:
            return load_case(file)
        except CaseError as error:
            raise AnswersError([_answer_fault(fault) for fault in error.faults]) from None


def _answer_fault(fault: Fault) -> AnswerFault:
    """A fault of the case, by the answer it comes from."""
    key = next((key for part, key in PLACES.items() if part in fault.path), None)
    return AnswerFault(() if key is None else (key,), f"{FLAGS.get(key or '', 'the case')}: {fault}")

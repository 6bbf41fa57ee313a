"""Writes a new case: loaded before it appears, whole or not at all, over nothing."""

import json
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from textwrap import wrap

from rigdesign.base import units
from rigdesign.base.errors import CaseError, Fault, OutputError
from rigdesign.base.output_folder import prepare_output, staged
from rigdesign.case.defaults.fill import WRITTEN_ONCE
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.case.schema import json_schema
from rigdesign.case.source import CASE_FILE
from rigdesign.explanation.keys import declared_checks, depends_on, entry_at
from rigdesign.new_case.outline import FLAGS, AnswerFault, AnswersError, Outline, locating_sister

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


# A new case as text: one key a line, each with what it is and which checks depend on it.

SCHEMA_FILE = "case.schema.json"
WIDTH = 110
MOST_NAMED = 4
"""Checks that a comment names; of more it names the topics."""
FIRST_SENTENCE = re.compile(r"(?<!e\.g)\. (?=[A-Z])")

Comment = Callable[[str], Sequence[str]]
"""Lines of the comment at a path."""
Line = tuple[str, str]
"""Key within its table, value as TOML."""


def tables(outline: Outline) -> Iterator[tuple[str, str, list[Line]]]:
    """Every table of the case: title, path, lines."""
    first, second = (str(teeth) for teeth in outline.teeth)
    width, shift = _quoted(outline.face_width), outline.profile_shift
    temperature = _quoted(outline.oil_temperature)
    yield "the case", "", [("schema_version", "1"), ("name", _quoted(outline.name))]
    pinion = [("teeth", first), ("face_width", width)]
    if shift is not None:
        pinion.append(("profile_shift", f"{shift:g}"))
    yield "test gearbox: the specimens", "gearboxes.test.gears.pinion", pinion
    yield "", "gearboxes.test.gears.wheel", [("teeth", second), ("face_width", width)]
    mesh = [("normal_module", _quoted(outline.module)), ("centre_distance", _quoted(outline.centre_distance))]
    yield "", "gearboxes.test.meshes.main", mesh
    if outline.lubrication == "dip":
        oil = [("lubrication", '"dip"'), ("oil", _quoted(outline.oil)), ("level", '"0 mm"')]
        if outline.box is None:
            oil.append(("volume", '"1.5 l"'))
        yield "", "gearboxes.test.oil", [*oil, ("sump_temperature", temperature)]
    else:
        yield "", "gearboxes.test.oil", [("oil", _quoted(outline.oil)), ("inlet_temperature", temperature)]
    if outline.journal:
        yield "all four bearings", "gearboxes.test.all_bearings", [("diameter", _quoted(outline.bearings))]
    else:
        yield from _rolling(outline.bearings)
    if outline.box is not None and outline.inner_length is not None:
        yield "box of the test gearbox", "gearboxes.test.housing", _housing(outline.box, outline.inner_length)
    slave: list[Line] = [("like", '"test"')]
    if outline.box is not None:
        slave.append(("remove", '["housing"]'))
    yield "slave gearbox: twice as wide, so that it outlives the specimens", "gearboxes.slave", slave
    wider = _quoted(f"{2e3 * units.parse(outline.face_width, 'length'):.6g} mm")
    for gear in ("pinion", "wheel"):
        yield "", f"gearboxes.slave.gears.{gear}", [("face_width", wider)]
    run = [("test_speed", _quoted(outline.speed)), ("test_torque", _quoted(outline.torque))]
    yield "the test, counted at the pinion of the test gearbox", "schedule", run


def _rolling(designation: str) -> Iterator[tuple[str, str, list[Line]]]:
    """The same bearing everywhere; one that cannot hold its shaft has a sister at the rear that can."""
    lines = [("type", '"rolling"'), ("designation", _quoted(designation))]
    yield "all four bearings", "gearboxes.test.all_bearings", lines
    locating = locating_sister(designation)
    for gear in ("pinion", "wheel") if locating else ():
        path = f"gearboxes.test.bearings.{gear}_rear"
        yield "", path, [("designation", _quoted(locating)), ("locating", "true")]


def _housing(box: tuple[float, float, float], inner_length: float) -> list[Line]:
    """Outer measures of a box of one chamber as those of the case."""
    return [
        ("warm_length", _millimetres(inner_length)),
        ("width", _millimetres(box[1])),
        ("height", _millimetres(box[2])),
    ]


def plain_text(outline: Outline) -> str:
    """The case without comments."""
    return "\n".join(_written(outline, lambda path: ()))


def commented_text(outline: Outline, case: Case, folder: Path) -> str:
    """The case with a comment at every key.

    case : the same case, loaded; folder : as a user would name it in the next command
    """
    checks = declared_checks(case)

    def comment(path: str) -> Sequence[str]:
        place = path.replace(".all_bearings.", f".bearings.{next(iter(case.gearboxes['test'].bearings))}.")
        if (once := WRITTEN_ONCE.get(path.rpartition(".")[2])) is not None:
            return wrap(once[1], WIDTH)
        entry = entry_at(place, _kind(outline, place))
        if entry is None:
            return ()
        moved = [check.id for check in checks if depends_on(case, check, place)]
        said = FIRST_SENTENCE.split(entry.description, maxsplit=1)[0].rstrip(".")
        text = f"{said}. {_of_checks(moved, [check.id for check in checks])}"
        return wrap(text.replace("``", "").strip(), WIDTH)

    head = (
        f"#:schema {SCHEMA_FILE}",
        f"# Back-to-back rig {outline.name}. What this file leaves out is worked out by the tool and listed in the",
        "# report as an assumption with its reason and range; write a key to replace its default.",
        f"#   rigdesign explain {folder} gearboxes.test.gears.pinion     every key of a part, with its default",
        f"#   rigdesign check {folder} --fidelity quick                  loads, losses, temperatures, verdict",
        "",
    )
    return "\n".join([*head, *_written(outline, comment)])


def _kind(outline: Outline, path: str) -> str:
    """Which kind of table a key stands in, where its table comes in kinds."""
    if ".bearings." in path:
        return f"type = {'journal' if outline.journal else 'rolling'}"
    return f"lubrication = {outline.lubrication}" if ".oil." in path else ""


def _of_checks(moved: Sequence[str], all_checks: Sequence[str]) -> str:
    """Which checks depend on a key: by name, by topic, or all but a few."""
    if not moved:
        return ""
    if len(moved) <= MOST_NAMED:
        return f"Checks that depend on it: {', '.join(moved)}."
    left = [check for check in all_checks if check not in moved]
    if len(left) <= MOST_NAMED:
        but = f" but {', '.join(left)}" if left else ""
        return f"Every check depends on it{but}."
    topics = dict.fromkeys(check.partition(".")[0] for check in moved)
    return f"Checks that depend on it: {len(moved)} of {', '.join(topics)}."


def _written(outline: Outline, comment: Comment) -> Iterator[str]:
    for title, path, lines in tables(outline):
        if title:
            yield f"# {'-' * 12} {title}"
        if path:
            yield f"[{path}]"
        for key, value in lines:
            for line in comment(f"{path}.{key}" if path else key):
                yield f"# {line}"
            yield f"{key} = {value}"
        yield ""


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _millimetres(length: float) -> str:
    return _quoted(f"{1e3 * length:.5g} mm")

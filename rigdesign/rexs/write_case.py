"""Imports a REXS file: writes its case, whole or not at all, over nothing, and accounts for everything in the file."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

from rigdesign.base.errors import CaseError, OutputError
from rigdesign.base.output_folder import staged
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.case.source import CASE_FILE
from rigdesign.rexs.attribute_log import ListedAttribute, MappedAttribute
from rigdesign.rexs.case_tables import LIKE_THE_TEST, case_tables
from rigdesign.rexs.gear_stage import CaseTable, Entry, chosen_stage, left_out, toml_text
from rigdesign.rexs.gear_unit_import import LEFT_OVER, GearUnitImport, import_gear_unit
from rigdesign.rexs.model import printable
from rigdesign.rexs.reader import read_rexs

OTHER_PART = "of another stage, or a value that the case works out itself"
REASONS = {
    "operating_cases": "of another load case, which the case names in a comment, or not needed at the pinion",
    "bearings": "of a bearing of another stage, of one that its designation describes, or of operation",
    "couplings": LEFT_OVER["coupling"],
    "materials": LEFT_OVER["material"],
    "shafts": "the places along the shafts count",
}
"""First part of a place of the gear unit -> why the case does not take it."""


@dataclass(frozen=True)
class Assumption:
    """A key of the case that the file does not state: path, value as written, reason."""

    path: str
    value: str
    reason: str


@dataclass(frozen=True)
class ImportedCase:
    """What became of a REXS file.

    path : the case
    stated : keys that the file states, with their sources
    mapped, listed : attributes that went into the case, and those that did not, with the reason
    assumed : in place of what the file lacks
    defaults : further defaults of the tool, not of the test gearbox
    needed : what the user has to give, with the reason or remedy
    left_out : parts of the file at this stage or beside it that a case does not have, each with the reason
    """

    path: Path
    stated: tuple[tuple[str, Entry], ...]
    mapped: tuple[MappedAttribute, ...]
    listed: tuple[ListedAttribute, ...]
    assumed: tuple[Assumption, ...]
    defaults: int
    needed: tuple[str, ...]
    left_out: tuple[str, ...]


def import_case(file: Path, out: Path, stage: int | None = None) -> ImportedCase:
    """Write the case of one stage of a REXS file.

    Parameters
    ----------
    file : .rexs, .rexsj or .rexsz
    out : folder of the case; a case in it is not overwritten
    stage : number of the stage, from 1; needed where there are several

    Raises
    ------
    RexsError
        A file that cannot be read.
    UsageError
        No file, no stage that a case can hold, several and none chosen.
    OutputError
        The folder cannot be written, or holds a case.
    """
    path = out / CASE_FILE
    if path.exists() or path.is_symlink():
        raise OutputError(f"{path} is there already; remove it or give another folder with --out")
    imported = import_gear_unit(read_rexs(file))
    chosen = chosen_stage(imported.unit, stage, printable(str(file)))
    tables = case_tables(imported, chosen, file.name)
    tried = _tried(toml_text(tables, with_examples=True))
    with staged(out) as scratch:
        (scratch / CASE_FILE).write_text(_head(file.name) + toml_text(tables), encoding="utf-8", newline="\n")
    missing = (
        *(f"{part}: a case has no such stage" for part in imported.other_stages),
        *left_out(imported.unit, chosen),
    )
    return _account(path, imported, tables, tried, missing)


def _head(file: str) -> str:
    return (
        f"# Imported from {printable(' '.join(file.split()))}. What this file leaves out is worked out by the tool and "
        "listed in the\n# report as an assumption with its reason and range; write a key to replace its default.\n\n"
    )


def _tried(text: str) -> Case | CaseError:
    """The case, with examples for what is needed; or what is wrong with it."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / CASE_FILE
        file.write_text(text, encoding="utf-8")
        try:
            return load_case(file)
        except CaseError as error:
            return error


def _account(
    path: Path,
    imported: GearUnitImport,
    tables: tuple[CaseTable, ...],
    tried: Case | CaseError,
    missing: tuple[str, ...],
) -> ImportedCase:
    placed = [(table.place(entry), entry) for table in tables for entry in table.entries]
    used = {target for _, entry in placed for target in entry.targets}
    mapped = tuple(item for item in imported.mapped if item.target in used)
    unused = [item for item in imported.mapped if item.target not in used]
    own = [Assumption(place, entry.value, entry.text) for place, entry in placed if entry.kind == "assumed"]
    own = [item for item in own if item.reason != LIKE_THE_TEST]
    needed = [
        f"{place}, e.g. {entry.value}: {entry.text}" for place, entry in placed if entry.kind == "needed"
    ]
    stated_paths = {place for place, _ in placed}
    defaults: list[Assumption] = []
    if isinstance(tried, CaseError):
        trial = "with these examples, " if needed else ""
        needed += [f"{trial}{fault}" for fault in tried.faults or (tried,)]
    else:
        defaults = [
            Assumption(mark.path, mark.shown, (mark.assumed or "").removeprefix("default of the tool: "))
            for mark in tried.origin.marks
            if mark.assumed is not None and mark.path not in stated_paths
        ]
    shown = [item for item in defaults if item.path.startswith("gearboxes.test.")]
    return ImportedCase(
        path=path,
        stated=tuple((place, entry) for place, entry in placed if entry.kind == "stated" and entry.markable),
        mapped=mapped,
        listed=(*imported.listed, *(_not_used(item) for item in unused)),
        assumed=(
            Assumption("gearboxes.slave", 'like "test"', LIKE_THE_TEST),
            *own,
            *shown,
        ),
        defaults=len(
            [item for item in defaults if not item.path.startswith(("gearboxes.test.", "gearboxes.slave."))]
        ),
        needed=tuple(needed),
        left_out=missing,
    )


def _not_used(item: MappedAttribute) -> ListedAttribute:
    reason = REASONS.get(item.target.split("[")[0].split(".")[0], OTHER_PART)
    return ListedAttribute(item.component, item.type, item.attribute, item.written, reason, item.load_case)

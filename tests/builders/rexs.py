"""REXS files of the tests: a gear unit like that of an FZG rig (16/24, m_n 4.5, a 91.5), and changed copies of it."""

import io
import zipfile
from pathlib import Path

from rigdesign.rexs.gear_unit_import import GearUnitImport, import_gear_unit
from rigdesign.rexs.reader import parse_rexs

DATA = Path(__file__).parents[1] / "unit/rigdesign_package/rexs/data"
SUFFIXES = ("rexs", "rexsj", "rexsz")


def rexs_file(version: str = "2.0", suffix: str = "rexs") -> Path:
    """Path of the unit in a version (1.0, 2.0) and encoding."""
    return DATA / f"fzg_{version}.{suffix}"


def changed(*changes: tuple[str, str], version: str = "2.0", suffix: str = "rexs") -> bytes:
    """Its text with replacements, each of which has to hit."""
    text = rexs_file(version, suffix).read_text("utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text.encode()


def imported(*changes: tuple[str, str], version: str = "2.0", suffix: str = "rexs") -> GearUnitImport:
    """The unit as imported from a changed text."""
    return import_gear_unit(parse_rexs(changed(*changes, version=version, suffix=suffix), "unit.rexs"))


def archive_of(entries: dict[str, bytes]) -> bytes:
    """A zip archive of named entries."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in entries.items():
            file.writestr(name, content)
    return buffer.getvalue()

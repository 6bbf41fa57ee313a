"""A REXS file of any encoding, recognised by what is in it, whatever its name ends with."""

from pathlib import Path

from rigdesign.base.errors import UsageError
from rigdesign.base.files import foreign, read_regular
from rigdesign.rexs.archive import MOST_BYTES, model_in_archive
from rigdesign.rexs.external_parts import with_external_parts
from rigdesign.rexs.faults import FaultList
from rigdesign.rexs.json_reader import parse_json
from rigdesign.rexs.model import RexsModel
from rigdesign.rexs.xml_reader import parse_xml

_WIDE_STARTS = (b"\xff\xfe", b"\xfe\xff")
"""Byte order marks of UTF-16, in which XML may be written."""


def read_rexs(path: str | Path) -> RexsModel:
    """Model of a REXS file: XML (.rexs), JSON (.rexsj) or zip (.rexsz), version 1.0 to 2.0.

    Components that stand in other files of its folder are put in; not so for an archive.

    Raises
    ------
    UsageError
        A file that is not there, must not be read, is no regular file or above 64 MB.
    RexsError
        A file that is no REXS, truncated, damaged, dangerous or contradicts itself; names file, place and remedy.
    """
    path = Path(path)
    return with_external_parts(_read_one(path), path.parent, _read_one)


def _read_one(path: Path) -> RexsModel:
    try:
        content = read_regular(path, MOST_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{path}: {reason}; give a REXS file (.rexs, .rexsj, .rexsz)") from error
    return parse_rexs(content, str(path))


def parse_rexs(content: bytes, source: str) -> RexsModel:
    """Model of a REXS file that was read already.

    Parameters
    ----------
    content : the file
    source : its name, for messages

    Raises
    ------
    RexsError
        As ``read_rexs``.
    """
    if content.startswith(b"PK"):
        name, content = model_in_archive(content, source)
        return _parse_text(content, f"{source}:{name}")
    return _parse_text(content, source)


def _parse_text(content: bytes, source: str) -> RexsModel:
    start = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
    if start == b"<" or content.startswith(_WIDE_STARTS):
        return parse_xml(content.lstrip(), source)
    if start in (b"{", b"["):
        return parse_json(content, source)
    what = "an empty file" if not start else foreign(content) or "neither XML nor JSON"
    raise FaultList(source).error("file", None, what, "give a REXS file (.rexs, .rexsj, .rexsz)")

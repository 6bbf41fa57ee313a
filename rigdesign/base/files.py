"""Reading files of the user: regular ones of a bounded size, and what a file is that is not what was asked for."""

import os
import stat
from pathlib import Path

SIGNATURES = (
    (b"PK\x03\x04", "a zip archive"),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an Office document of the old kind (.xls, .doc)"),
    (b"%PDF", "a PDF document"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
    (b"TDSm", "a TDMS recording"),
    (b"SQLite format 3\x00", "an SQLite file"),
    (b"\x1f\x8b", "a gzip file"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
)
OFFICE = (
    (b"xl/", "an Excel workbook (.xlsx)"),
    (b"word/", "a Word document (.docx)"),
    (b"ppt/", "a PowerPoint file"),
)
ODS = b"application/vnd.oasis.opendocument.spreadsheet"


class RefusedFileError(OSError):
    """A file that is not read: a device, a pipe, a folder, or one above the limit of size.

    ``strerror`` says what it is and the limit; ``size`` [bytes] of a regular file that is too large, else None.
    """

    def __init__(self, text: str, size: int | None = None) -> None:
        super().__init__(0, text)
        self.size = size


def check_regular(path: Path, largest: float) -> None:
    """Raise RefusedFileError for what is no regular file of at most ``largest`` bytes, OSError for no file at all."""
    _refuse(path.stat(), largest)


def read_regular(path: Path, largest: int) -> bytes:
    """Content of a regular file of at most ``largest`` bytes.

    A device or a pipe is neither waited for nor read.

    Raises
    ------
    RefusedFileError
        For anything else than a regular file, and for a larger one.
    OSError
        For a file that is not there or must not be read.
    """
    check_regular(path, largest)
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as file:
        _refuse(os.fstat(handle), largest)
        return file.read(largest)


def _refuse(state: os.stat_result, largest: float) -> None:
    if not stat.S_ISREG(state.st_mode):
        kinds = (
            (stat.S_ISDIR, "a folder"), (stat.S_ISCHR, "a device"), (stat.S_ISBLK, "a device"),
            (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"),
        )  # fmt: skip
        kind = next((words for holds, words in kinds if holds(state.st_mode)), "no file")
        raise RefusedFileError(f"{kind}, not a regular file")
    if state.st_size > largest:
        text = f"{state.st_size / 1e6:.3g} MB, above the limit of {largest / 1e6:.3g} MB"
        raise RefusedFileError(text, state.st_size)


def foreign(content: bytes) -> str | None:
    """What the file is by its first bytes, in words; None for text and for what is not known."""
    kind = next((words for start, words in SIGNATURES if content.startswith(start)), None)
    if kind == "a zip archive":
        office = next((words for name, words in OFFICE if name in content), None)
        return office or ("an OpenDocument spreadsheet (.ods)" if ODS in content[:200] else kind)
    return kind

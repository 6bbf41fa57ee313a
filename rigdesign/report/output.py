"""The output folder: proved writable before the computation, filled file by file with whole files only."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rigdesign.errors import OutputError

STAGING_PREFIX = ".rigdesign-writing-"


def prepare_output(out: Path) -> None:
    """Show that files can be written to ``out`` without creating anything that stays.

    Writes and removes a file in ``out``, or in its nearest existing parent when ``out`` does not exist yet.

    Raises
    ------
    OutputError
        If the path is a file, lies below a file, or the folder refuses a new file.
    """
    folder = _nearest_existing(out.absolute())
    if not folder.is_dir():
        raise OutputError(_message(out, f"{folder} is a file, a folder is needed"))
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise OutputError(_message(out, f"{folder} refuses a new file ({error.strerror})")) from error


@contextmanager
def staged(out: Path) -> Iterator[Path]:
    """Give a scratch folder inside ``out``; on success move each of its files to its place in ``out``.

    A file of the result appears whole or not at all: it is complete before the rename, and the rename stays
    in one file system. Nothing moves when the body raises. The file ``results.json`` moves last, so its
    presence says that everything else is there.

    Raises
    ------
    OutputError
        If the folder cannot be made or written.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=STAGING_PREFIX, dir=out) as scratch:
            yield Path(scratch)
            _publish(Path(scratch), out)
    except OSError as error:
        raise OutputError(_message(out, error.strerror or str(error))) from error


def write_whole(path: Path, text: str) -> None:
    """Write one text file (UTF-8, newline ``\\n``) whole or not at all."""
    with staged(path.parent) as scratch:
        (scratch / path.name).write_text(text, encoding="utf-8", newline="\n")


def remove_published(out: Path, names: list[str]) -> None:
    """Remove files of an earlier run by paths relative to ``out``; paths that lead elsewhere are left."""
    root = out.resolve()
    for name in names:
        path = (root / name).resolve()
        if path.is_relative_to(root) and path.is_file():
            path.unlink()


def _nearest_existing(path: Path) -> Path:
    while not path.exists() and path != path.parent:
        path = path.parent
    return path


def _publish(scratch: Path, out: Path) -> None:
    files = [path for path in scratch.rglob("*") if path.is_file()]
    files.sort(key=lambda path: (path.name == "results.json", path.relative_to(scratch).as_posix()))
    for path in files:
        target = out / path.relative_to(scratch)
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(path, target)  # noqa: PTH105 - atomic on every platform


def _message(out: Path, what: str) -> str:
    return f"output folder {out}: {what}; give another folder with --out"

"""Files that a measurement set names: inside its folder, regular, no larger than the set allows."""

import hashlib
from collections.abc import Iterable
from pathlib import Path

from rigdesign import units
from rigdesign.errors import Fault, MeasurementError

LARGEST_DOCUMENT = 16e6
"""Most bytes of measurement.toml itself."""


def set_file(folder: Path, name: str, limit: float) -> Path:
    """Path of a file of the set, links followed.

    Parameters
    ----------
    folder : of the set
    name : as measurement.toml has it
    limit : most bytes, ``data.size_limit``

    Raises
    ------
    MeasurementError
        No name of a file, no such file, one outside the folder, no regular file (a folder, device or pipe), too large.
    """
    if "\0" in name:
        raise _refused(
            repr(name), "holds a NUL character", "write the name of a file in the folder of the set"
        )
    try:
        home, path = folder.resolve(), (folder / name).resolve()
        size = path.stat().st_size if path.is_file() else 0.0
    except (OSError, RuntimeError) as error:
        raise _refused(name, f"cannot be followed: {error}", "correct the name or the link") from None
    if not path.is_relative_to(home):
        raise _refused(
            name, f"leads to {path}, outside the folder of the set", "put the file itself into that folder"
        )
    if not path.exists():
        raise _refused(name, "no such file", "correct the name in [data] or add the file")
    if not path.is_file():
        raise _refused(name, "is a folder, device or pipe", "give a regular file")
    if size > limit:
        raise _refused(
            name,
            f"has {_shown(size)}, data.size_limit is {_shown(limit)}",
            f'if that is meant, write size_limit = "{_shown(1.2 * size)}" under [data]',
        )
    return path


def document_text(file: Path) -> str:
    """Text of measurement.toml; MeasurementError where it cannot be read, is too large or no UTF-8."""
    try:
        if file.stat().st_size > LARGEST_DOCUMENT:
            raise MeasurementError(
                f"has more than {_shown(LARGEST_DOCUMENT)}; readings belong into tables", str(file)
            )
        return file.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise MeasurementError(
            f"cannot be read: {error.strerror}; check the path and its rights", str(file)
        ) from None
    except UnicodeDecodeError as error:
        raise MeasurementError(
            f"is not UTF-8 text (byte {error.start}); save it as UTF-8", str(file)
        ) from None


def digest_of(file: Path, others: Iterable[Path]) -> str:
    """SHA-256 over measurement.toml and the files it names."""
    digest = hashlib.sha256(file.read_bytes())
    for path in dict.fromkeys(others):
        with path.open("rb") as stream:
            digest.update(hashlib.file_digest(stream, "sha256").digest())
    return digest.hexdigest()


def _refused(name: str, problem: str, remedy: str) -> MeasurementError:
    return MeasurementError([Fault(name, "", problem, remedy)])


def _shown(size: float) -> str:
    return units.show(size, "data_size", digits=3)

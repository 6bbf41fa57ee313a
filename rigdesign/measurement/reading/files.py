"""Files that a measurement set names: inside its folder, regular, no larger than the set allows."""

import hashlib
from collections.abc import Iterable
from pathlib import Path

from rigdesign.base import units
from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.files import RefusedFileError, check_regular, read_regular

LARGEST_DOCUMENT = 16_000_000
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
    try:
        home, path = folder.resolve(), (folder / name).resolve()
        if not path.is_relative_to(home):
            raise refused(
                name,
                f"leads to {path}, outside the folder of the set",
                "put the file itself into that folder",
            )
        check_regular(path, limit)
    except FileNotFoundError:
        raise refused(name, "no such file", "correct the name in [data] or add the file") from None
    except RefusedFileError as error:
        if error.size is None:
            raise refused(name, f"is {error.strerror}", "give a regular file") from None
        raise refused(
            name,
            f"has {_shown(error.size)}, data.size_limit is {_shown(limit)}",
            f'if that is meant, write size_limit = "{_shown(1.2 * error.size)}" under [data]',
        ) from None
    except (OSError, RuntimeError) as error:
        raise refused(name, f"cannot be followed: {error}", "correct the name or the link") from None
    return path


def document_text(file: Path) -> str:
    """Text of measurement.toml; MeasurementError where it cannot be read, is too large or no UTF-8."""
    try:
        return read_regular(file, LARGEST_DOCUMENT).decode("utf-8-sig")
    except RefusedFileError as error:
        raise MeasurementError(f"is {error.strerror}; readings belong into tables", str(file)) from None
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


def refused(path: str, problem: str, remedy: str) -> MeasurementError:
    """The error of a file, or of a place in it, that cannot be used."""
    return MeasurementError([Fault(path, "", problem, remedy)])


def _shown(size: float) -> str:
    return units.show(size, "data_size", digits=3)

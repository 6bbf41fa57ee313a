"""REXS in a zip archive (.rexsz): one model, perhaps with files it refers to. Nothing is unpacked to the disk."""

import io
import zlib
from pathlib import PurePosixPath
from zipfile import BadZipFile, ZipFile, ZipInfo

from rigdesign.rexs.faults import FaultList

MODEL_SUFFIXES = (".rexs", ".rexsj")
ARCHIVE_SUFFIXES = (".zip", ".rexsz", ".7z", ".gz", ".bz2", ".xz", ".zst", ".tar", ".rar")
MOST_ENTRIES = 1000
MOST_BYTES = 64_000_000
"""Limit of all entries unpacked, and of a model file."""
HIGHEST_RATIO = 200.0
"""Limit of unpacked over packed; the archives of FVA have 17."""
SMALL = 1_000_000
"""Bytes unpacked up to which the ratio does not count."""
_PLAIN_ARCHIVE = "pack the model file and what it refers to again, as an ordinary zip archive"
_UNPACK = "unpack it and give the model it holds"
_BROKEN = (
    BadZipFile, zlib.error, EOFError, OSError, RuntimeError, NotImplementedError, ValueError, KeyError, IndexError,
    OverflowError, MemoryError,
)  # fmt: skip
"""What zipfile raises for archives that are damaged, encrypted or packed by a method it does not have."""


def model_in_archive(content: bytes, source: str) -> tuple[str, bytes]:
    """Name and content of the model file in an archive.

    Parameters
    ----------
    content : the archive
    source : its name, for messages

    Raises
    ------
    RexsError
        A damaged or encrypted archive, one with too many or too large entries or a ratio above the limits, entries
        that lead out of the archive (absolute, ``..``), archives in it, no model or several.
    """
    faults = FaultList(source)
    try:
        with ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            _check_sizes(entries, faults)
            for entry in entries:
                _check_entry(entry, faults)
            faults.raise_if_any()
            entry = _model_entry(entries, faults)
            with archive.open(entry) as file:
                model = file.read(MOST_BYTES + 1)
    except _BROKEN as error:
        problem = f"a damaged archive ({type(error).__name__}: {str(error)[:100]})"
        faults.stop("archive", None, problem, _PLAIN_ARCHIVE)
    if len(model) > MOST_BYTES:
        problem = f"above the limit of {MOST_BYTES / 1e6:.3g} MB unpacked"
        faults.stop(
            f"entry {entry.filename[:100]}", None, problem, "export the model without results of calculation"
        )
    if model.startswith(b"PK\x03\x04"):
        faults.stop(f"entry {entry.filename[:100]}", None, "an archive in the archive", _UNPACK)
    return entry.filename, model


def _check_sizes(entries: list[ZipInfo], faults: FaultList) -> None:
    unpacked, packed = sum(item.file_size for item in entries), sum(item.compress_size for item in entries)
    if len(entries) > MOST_ENTRIES:
        faults.stop(
            "archive", None, f"{len(entries)} entries, above the limit of {MOST_ENTRIES}", _PLAIN_ARCHIVE
        )
    if unpacked > MOST_BYTES:
        limit = f"{unpacked / 1e6:.3g} MB unpacked, above the limit of {MOST_BYTES / 1e6:.3g} MB"
        faults.stop("archive", None, limit, "export the model without results of calculation")
    for name, size, stored in [("archive", unpacked, packed), *_sizes(entries)]:
        if size > SMALL and size > HIGHEST_RATIO * stored:
            problem = (
                f"{size / max(stored, 1):.4g} times its packed size, above the limit of {HIGHEST_RATIO:g}"
            )
            faults.stop(name, None, problem, _PLAIN_ARCHIVE)


def _sizes(entries: list[ZipInfo]) -> list[tuple[str, int, int]]:
    return [(f"entry {item.filename[:100]}", item.file_size, item.compress_size) for item in entries]


def _check_entry(entry: ZipInfo, faults: FaultList) -> None:
    name = entry.filename.replace("\\", "/")
    place = f"entry {entry.filename[:100]}"
    if (
        name.startswith("/")
        or name[1:2] == ":"
        or ".." in PurePosixPath(name).parts
        or "\0" in entry.orig_filename
    ):
        faults.add(place, None, "a name that leads out of the archive", _PLAIN_ARCHIVE)
    if entry.flag_bits & 0x1:
        faults.add(place, None, "encrypted", "pack the archive without a password")
    if name.lower().endswith(ARCHIVE_SUFFIXES):
        faults.add(place, None, "an archive in the archive", _UNPACK)


def _model_entry(entries: list[ZipInfo], faults: FaultList) -> ZipInfo:
    """The only model in the archive."""
    models = [item for item in entries if _is_model(item.filename)]
    names = ", ".join(item.filename[:60] for item in (models or entries)[:8])
    if not models:
        remedy = "pack the .rexs or .rexsj file of the model with it"
        faults.stop("archive", None, f"no model among its entries ({names or 'none'})", remedy)
    if len(models) > 1:
        faults.stop("archive", None, f"{len(models)} models ({names})", "keep the one to import")
    return models[0]


def _is_model(name: str) -> bool:
    """Whether an entry is a model by its name, and none of the hidden ones that macOS adds."""
    return name.lower().endswith(MODEL_SUFFIXES) and not PurePosixPath(name).name.startswith(".")

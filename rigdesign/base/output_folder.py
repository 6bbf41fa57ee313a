"""The output folder: proved writable before the computation, filled file by file with whole files only."""

import errno
import json
import os
import re
import secrets
import shutil
import socket
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType

from rigdesign.base.errors import WIDEST_PLACE, OutputError, shortened

# A lock file that names its owner; the operating system ends the lock with the process, however that ends.
#
# The name of the owner is for messages only: whether a lock is held is asked of the operating system, so that a file
# left by a killed process, on this machine or another, holds up nobody. A copy made by fork does not hold it.


@dataclass(frozen=True)
class Owner:
    """Process that holds a lock: host, process number, and when it took the lock (local time)."""

    host: str
    pid: int
    since: str

    def __str__(self) -> str:
        return f"process {self.pid} on {self.host} since {self.since}"


class HeldError(Exception):
    """A lock that another process holds; ``owner`` is None where its file does not say who."""

    def __init__(self, owner: Owner | None) -> None:
        super().__init__(owner)
        self.owner = owner


class FileLock:
    """Exclusive lock on the file ``path``, made if absent and removed when released. A context manager.

    Raises
    ------
    HeldError
        If a living process holds it.
    OSError
        If the file cannot be made or its file system knows no locks.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._handle = _locked(path)
        _HANDLES.add(self._handle)
        owner = Owner(socket.gethostname(), os.getpid(), time.strftime("%Y-%m-%d %H:%M:%S"))
        try:
            os.ftruncate(self._handle, 0)
            os.write(self._handle, json.dumps(asdict(owner)).encode())
        except OSError:
            self.release()
            raise

    def release(self) -> None:
        """Remove the file and end the lock."""
        if self._handle in _HANDLES:
            _HANDLES.remove(self._handle)
            with suppress(OSError):
                self._path.unlink()
            with suppress(OSError):
                os.close(self._handle)

    def __enter__(self) -> "FileLock":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.release()


_HANDLES: set[int] = set()
"""Of the locks that this process holds."""


def _leave_to_parent() -> None:
    """In a copy: close its doubles of the handles; the lock stays with the parent and ends with it."""
    while _HANDLES:
        os.close(_HANDLES.pop())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_to_parent)


def _locked(path: Path) -> int:
    """An open, locked file that still stands at ``path``: the last owner may remove it while it is opened here."""
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            _lock(handle)
            if _stands_at(handle, path):
                return handle
        except BlockingIOError:
            owner = _owner(handle)
            os.close(handle)
            raise HeldError(owner) from None
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)


def _stands_at(handle: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except FileNotFoundError:
        return False


def _owner(handle: int) -> Owner | None:
    """Who wrote the lock file; None for one that says nothing (its owner is about to write it)."""
    try:
        content = json.loads(os.pread(handle, 1000, 0) if hasattr(os, "pread") else os.read(handle, 1000))
        return Owner(str(content["host"]), int(content["pid"]), str(content["since"]))
    except (OSError, ValueError, KeyError, TypeError):
        return None


if sys.platform == "win32":
    import msvcrt

    FAR = 1 << 30
    """Place of the locked byte: beyond the content, which others have to read."""

    def _lock(handle: int) -> None:
        os.lseek(handle, FAR, os.SEEK_SET)
        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError as error:
            raise BlockingIOError(*error.args) from error
        finally:
            os.lseek(handle, 0, os.SEEK_SET)
else:
    import fcntl

    def _lock(handle: int) -> None:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)


STAGING_PREFIX = ".rigdesign-writing-"
OWNER_NAME, CONTENT_NAME = "owner", "content"
"""In a staging folder: its lock file, which can be locked once its process is dead, and the files in the making."""
NO_LOCKS = frozenset((errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EINVAL))
"""What a file system answers that knows no locks."""


def prepare_output(out: Path) -> None:
    """Show that files can be written to ``out`` without creating anything that stays.

    Writes and removes a file in ``out``, or in its nearest existing parent when ``out`` does not exist yet.

    Raises
    ------
    OutputError
        If the path is a file, lies below a file, or the folder refuses a new file.
    """
    try:
        with suppress(FileNotFoundError, NotADirectoryError):
            out.lstat()
        folder = _nearest_existing(out.absolute())
    except (OSError, ValueError) as error:
        raise OutputError(_message(out, getattr(error, "strerror", None) or str(error))) from error
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
    presence says that everything else is there. What killed processes left in ``out`` is removed first.

    Raises
    ------
    OutputError
        If the folder cannot be made or written.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        _remove_abandoned(out)
        with _scratch(out) as scratch:
            yield scratch
            _publish(scratch, out)
    except OSError as error:
        raise OutputError(_message(out, error.strerror or str(error))) from error


def write_whole(path: Path, text: str) -> None:
    """Write one text file (UTF-8, newline ``\\n``) whole or not at all."""
    write_texts(path.parent, {path.name: text})


def replace_whole(file: Path, content: bytes) -> None:
    """Write a file of a cache whole or not at all, with the rights that this user gives to files.

    Raises OSError where the folder cannot be written.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f".{secrets.token_hex(8)}.part")
    try:
        part.write_bytes(content)
        part.replace(file)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def write_texts(out: Path, texts: Mapping[str, str]) -> None:
    """Write text files (UTF-8, newline ``\\n``) by their path below ``out``, all whole or none.

    Raises OutputError as `staged`.
    """
    with staged(out) as scratch:
        for name, text in texts.items():
            file = scratch / name
            file.parent.mkdir(exist_ok=True)
            file.write_text(text, encoding="utf-8", newline="\n")


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


@contextmanager
def _scratch(out: Path) -> Iterator[Path]:
    """An empty folder of this process alone; the lock file above it stands as long as the process works there."""
    folder, lock = _new_staging(out)
    try:
        (folder / CONTENT_NAME).mkdir()
        yield folder / CONTENT_NAME
    finally:
        if lock is not None:
            lock.release()
        shutil.rmtree(folder, ignore_errors=True)


def _new_staging(out: Path) -> tuple[Path, FileLock | None]:
    """A staging folder with its lock; without one where the file system knows none."""
    while True:
        folder = Path(tempfile.mkdtemp(prefix=STAGING_PREFIX, dir=out))
        try:
            return folder, FileLock(folder / OWNER_NAME)
        except (HeldError, FileNotFoundError):
            continue  # another process took it for abandoned before the lock was there, and removes it
        except OSError as error:
            if error.errno in NO_LOCKS:
                return folder, None
            shutil.rmtree(folder, ignore_errors=True)
            raise


def _remove_abandoned(out: Path) -> None:
    """Remove staging folders whose process is dead; one that cannot be locked or removed stays."""
    for folder in out.glob(f"{STAGING_PREFIX}*"):
        if folder.is_symlink() or not folder.is_dir():
            continue
        with suppress(HeldError, OSError), FileLock(folder / OWNER_NAME):
            shutil.rmtree(folder, ignore_errors=True)


def _publish(scratch: Path, out: Path) -> None:
    files = [path for path in scratch.rglob("*") if path.is_file()]
    files.sort(key=lambda path: (path.name == "results.json", path.relative_to(scratch).as_posix()))
    for path in files:
        target = out / path.relative_to(scratch)
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(path, target)  # noqa: PTH105 - atomic on every platform


def _message(out: Path, problem: str) -> str:
    return f"output folder {shortened(str(out), WIDEST_PLACE)}: {problem}; give another folder with --out"


def file_stem(*names: str) -> str:
    """A file name made of the names a user gave: anything but letters, digits, dot, dash is an underscore."""
    return "_".join(re.sub(r"[^A-Za-z0-9.-]+", "_", name).strip("._") or "unnamed" for name in names)

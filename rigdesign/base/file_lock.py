"""A lock file that names its owner; the operating system ends the lock with the process, however that ends.

The name of the owner is for messages only: whether a lock is held is asked of the operating system, so that a file
left by a killed process, on this machine or another, holds up nobody. A copy made by fork does not hold it.
"""

import json
import os
import socket
import sys
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType


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

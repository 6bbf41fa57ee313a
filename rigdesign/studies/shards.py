"""The ledgers of a study: one, or one a job of an array that computes a share of the points."""

import re
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self, TypeVar

from rigdesign.base.errors import OutputError, UsageError, shortened
from rigdesign.base.file_lock import FileLock, HeldError
from rigdesign.studies.ledger import Ledger, read_points
from rigdesign.studies.result import Record

T = TypeVar("T")
LEDGER_NAME = "ledger.sqlite"
LOCK_NAME = ".rigdesign-study.lock"
START_LOCK = ".rigdesign-study.start.lock"
"""Held while a study takes the lock of its folder or share."""
START_WITHIN = 20.0
"""Time in which other studies have started, those of a large array on a slow file system too [s]."""
FILES_LOCK = ".rigdesign-study.files.lock"
"""Held by the share that writes the files."""
SHARD = re.compile(r"\s*(\d{1,6})\s*/\s*(\d{1,6})\s*")
SHARD_LEDGERS = "ledger.*-of-*.sqlite"
SHARD_LOCKS = ".rigdesign-study.*-of-*.lock"
Entry = tuple[bool, Record]


@dataclass(frozen=True)
class Shard:
    """Share ``number`` (from 1) of ``count`` shares of the points."""

    number: int
    count: int

    def of(self, items: Sequence[T]) -> Sequence[T]:
        """The share: every ``count``-th, so that all shares are of like work."""
        return items[self.number - 1 :: self.count]

    @property
    def ledger_name(self) -> str:
        """File of the points of this share."""
        return f"ledger.{self.number}-of-{self.count}.sqlite"

    @property
    def lock_name(self) -> str:
        """Lock file of this share."""
        return f".rigdesign-study.{self.number}-of-{self.count}.lock"


def parse_shard(text: str) -> Shard:
    """Read ``i/n``.

    Raises
    ------
    UsageError
        Another text, or a number that is none of 1 to n.
    """
    found = SHARD.fullmatch(text)
    if found is None or not 1 <= int(found[1]) <= int(found[2]):
        raise UsageError(
            f"--shard {shortened(text)}: no share of the points; write --shard 1/4, 2/4, 3/4 and 4/4 in four jobs"
        )
    return Shard(int(found[1]), int(found[2]))


class StudyLedgers:
    """All points stored in a folder; new ones go to the ledger of this process. A context manager.

    A share reads the ledgers of the others as they stand; a study without shares owns the folder and repairs them.

    Parameters
    ----------
    out : the folder
    shard : share of this process, None for all points

    Raises
    ------
    OutputError
        If a ledger cannot be opened.
    """

    def __init__(self, out: Path, shard: Shard | None) -> None:
        self._out = out
        self._shard = shard
        self.path = out / (LEDGER_NAME if shard is None else shard.ledger_name)
        self._ledger = Ledger(self.path)
        self.repaired = [self._ledger.repaired] if self._ledger.repaired else []
        self._others: dict[str, Entry] = {}
        self.read_others()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._ledger.__exit__(kind, error, traceback)

    def read_others(self) -> None:
        """Read what other processes have stored since."""
        paths = [self._out / LEDGER_NAME, *sorted(self._out.glob(SHARD_LEDGERS))]
        for path in paths:
            if path != self.path and path.exists():
                self._others = _joined(self._others, self._points_of(path))

    def _points_of(self, path: Path) -> dict[str, Entry]:
        if self._shard is not None:
            return read_points(path)
        with Ledger(path) as ledger:
            if ledger.repaired:
                self.repaired.append(ledger.repaired)
            return ledger.stored()

    def stored(self) -> dict[str, Entry]:
        """Every stored point: key -> (failed, record); a result goes before a failure of another ledger."""
        return _joined(self._others, self._ledger.stored())

    @property
    def ledger(self) -> Ledger:
        """Where new points go."""
        return self._ledger


def _joined(before: dict[str, Entry], more: dict[str, Entry]) -> dict[str, Entry]:
    """Both; of a point in both the one with a result, else that of ``more``."""
    chosen = {
        key: entry for key, entry in more.items() if not (entry[0] and key in before and not before[key][0])
    }
    return {**before, **chosen}


@contextmanager
def folder_lock(out: Path, shard: Shard | None) -> Iterator[None]:
    """Hold the lock of the folder, or of a share in it: a second study would compute every point twice.

    Shares run together; a study of all points runs alone. Studies start one after the other, each holding the lock of
    the start, so that each finds the locks of those before it.

    Raises
    ------
    OutputError
        If another study, or this share of one, runs in the folder.
    """
    with ExitStack() as held:
        with _start_lock(out):
            held.enter_context(_lock(out / (LOCK_NAME if shard is None else shard.lock_name), out))
            for path in [out / LOCK_NAME] if shard is not None else sorted(out.glob(SHARD_LOCKS)):
                if path.exists():
                    _lock(path, out).release()
        yield


def _start_lock(out: Path) -> FileLock:
    """The lock of the start, as soon as those that start at the same moment have released it."""
    until = time.monotonic() + START_WITHIN
    while True:
        try:
            return FileLock(out / START_LOCK)
        except OSError:
            return _lock(out / START_LOCK, out)
        except HeldError:
            if time.monotonic() > until:
                return _lock(out / START_LOCK, out)
            time.sleep(0.02)


def _lock(path: Path, out: Path) -> FileLock:
    try:
        return FileLock(path)
    except HeldError as error:
        raise OutputError(
            f"output folder {out}: a study of {error.owner or 'another process'} runs in it; wait for its end, or "
            "give another folder with --out"
        ) from None
    except OSError as error:
        raise OutputError(
            f"output folder {out}: {error.strerror} for {path.name}; give another folder with --out"
        ) from error


@contextmanager
def files_lock(out: Path, shard: Shard | None) -> Iterator[bool]:
    """Whether this process may write the files: not while another share of the same study does."""
    if shard is None:
        yield True
        return
    try:
        lock = FileLock(out / FILES_LOCK)
    except (HeldError, OSError):
        yield False
        return
    with lock:
        yield True

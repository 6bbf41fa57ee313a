"""The ledger of a study: every finished point, on disk the moment it is finished.

Every row carries a checksum of what it says. What cannot be read, or says something else than was written, is never
used: the file is set aside, its sound rows go into a new one, and the other points are computed again.
"""

import hashlib
import json
import os
import re
import sqlite3
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self, TypeVar

from rigdesign.base.errors import OutputError, UsageError, shortened
from rigdesign.base.output_folder import FileLock, HeldError
from rigdesign.base.version import __version__
from rigdesign.studies.result import Record

FORMAT = 4
"""Of the table below, kept in the file as user_version; raise it with any change."""
SYNCHRONOUS = "EXTRA"
"""A stored point is on the disk and not with the operating system: it stays when the power fails."""
SCHEMA = """
CREATE TABLE IF NOT EXISTS points (
    key TEXT PRIMARY KEY,
    tool_version TEXT NOT NULL,
    fidelity TEXT NOT NULL,
    case_hash TEXT NOT NULL,
    inputs TEXT NOT NULL,
    failed INTEGER NOT NULL,
    record TEXT NOT NULL,
    checksum TEXT NOT NULL
)
"""
COMPANIONS = ("", "-journal", "-wal", "-shm")
"""Endings of the files that make up one ledger."""
LARGEST_RECORD = 100_000_000
"""Bytes of one point; a damaged length may claim more than the machine has."""
MOST_ROWS = 200_000
"""Rows looked for in a damaged file that does not say how many it has; twice the points of the largest grid."""
NOT_DAMAGE = frozenset(
    (
        sqlite3.SQLITE_PERM, sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_NOMEM,
        sqlite3.SQLITE_IOERR, sqlite3.SQLITE_FULL, sqlite3.SQLITE_CANTOPEN,
    )
)  # fmt: skip
"""What SQLite says of a machine or a folder that refuses; all else of a file that can be read is damage."""


class _Row(NamedTuple):
    key: str
    tool_version: str
    fidelity: str
    case_hash: str
    inputs: str
    failed: int
    record: str
    checksum: str

    @property
    def sound(self) -> bool:
        """Whether the row says what was written."""
        return self.checksum == _checksum(self[:-1])


class _DamagedError(Exception):
    """A file that is no ledger of this version, or one with rows that are not sound; says what it is."""


def point_key(case_hash: str, fidelity: str, base_hash: str) -> str:
    """What makes two points the same computation: resolved case, that of the base they start from, tool, fidelity."""
    return hashlib.sha256(f"{case_hash}\n{base_hash}\n{__version__}\n{fidelity}".encode()).hexdigest()


class Ledger:
    """SQLite file; a killed process loses no point it has stored.

    Every point stands in the main file when it is stored, under the check of its pages and rows. (A write-ahead log
    would hold it first, and SQLite takes a damaged log for one that ends there, without a word.) Only the process
    that drives the study writes. A context manager. ``repaired`` says in a sentence what was set aside of a damaged
    file; it is empty for a sound one.

    Raises
    ------
    OutputError
        If the file cannot be opened, or a damaged one cannot be set aside.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.repaired = ""
        try:
            try:
                self._connection, self._points = _opened(path)
            except _DamagedError as damage:
                self._connection, self._points, self.repaired = _set_aside(path, str(damage))
        except (sqlite3.Error, OSError) as error:
            raise OutputError(
                f"ledger {path}: {error}; see that the folder can be written, or give another --out"
            ) from error

    def __enter__(self) -> "Ledger":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._connection.close()

    def stored(self) -> dict[str, tuple[bool, Record]]:
        """Every stored point: key -> (failed, record)."""
        return dict(self._points)

    def store(
        self, key: str, *, fidelity: str, case_hash: str, inputs: dict[str, str], failed: bool, record: Record
    ) -> None:
        """Write one point; durable when this returns.

        Raises
        ------
        OutputError
            If the disk refuses it.
        """
        content = json.dumps(record, allow_nan=False)
        row = (key, __version__, fidelity, case_hash, json.dumps(inputs), int(failed), content)
        try:
            _insert(self._connection, _Row(*row, _checksum(row)))
        except sqlite3.Error as error:
            raise OutputError(f"ledger {self._path}: {error}; free space and run the study again") from error
        self._points[key] = (failed, json.loads(content))


def read_points(path: Path) -> dict[str, tuple[bool, Record]]:
    """Points of a ledger that another process may be writing; none of one that cannot be read at this moment.

    Nothing is repaired here: whoever owns the ledger does it.
    """
    with suppress(sqlite3.Error, OSError, TypeError, ValueError):
        with closing(
            sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=30.0)
        ) as connection:
            if connection.execute("PRAGMA user_version").fetchone()[0] != FORMAT:
                return {}
            rows = [_Row(*row) for row in connection.execute(f"SELECT {', '.join(_Row._fields)} FROM points")]
        return {row.key: (bool(row.failed), json.loads(row.record)) for row in rows if row.sound}
    return {}


def _checksum(row: tuple[object, ...]) -> str:
    return hashlib.sha256(json.dumps(row).encode()).hexdigest()


def _insert(connection: sqlite3.Connection, row: _Row) -> None:
    connection.execute(f"INSERT OR REPLACE INTO points VALUES ({', '.join('?' * len(row))})", row)


def _opened(path: Path) -> tuple[sqlite3.Connection, dict[str, tuple[bool, Record]]]:
    """The connection to a sound ledger, made if absent, and its points; raises _DamagedError for any other file."""
    connection = sqlite3.connect(path, timeout=30.0, isolation_level=None)
    try:
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_RECORD)
        connection.execute("PRAGMA journal_mode=DELETE")
        connection.execute(f"PRAGMA synchronous={SYNCHRONOUS}")
        if connection.execute("SELECT COUNT(*) FROM sqlite_master").fetchone()[0] == 0:
            connection.execute(SCHEMA)
            connection.execute(f"PRAGMA user_version={FORMAT}")
        found = connection.execute("PRAGMA user_version").fetchone()[0]
        if found != FORMAT:
            raise _DamagedError(f"is of format {found}, this version writes {FORMAT}")
        answer = connection.execute("PRAGMA integrity_check(1)").fetchone()[0]
        if answer != "ok":
            raise _DamagedError(f"is damaged ({str(answer).splitlines()[-1]})")
        rows = [_Row(*row) for row in connection.execute(f"SELECT {', '.join(_Row._fields)} FROM points")]
        if broken := sum(not row.sound for row in rows):
            raise _DamagedError(f"is damaged ({broken} of {len(rows)} entries are not as they were written)")
        return connection, {row.key: (bool(row.failed), json.loads(row.record)) for row in rows}
    except BaseException as error:
        connection.close()
        if isinstance(error, sqlite3.Error | TypeError | UnicodeError) and _is_damage(error, path):
            raise _DamagedError(f"is damaged ({error})") from error
        raise


def _is_damage(error: Exception, path: Path) -> bool:
    """Whether the content of the file is to blame, not the machine or the rights of the folder."""
    code = (getattr(error, "sqlite_errorcode", None) or 0) & 0xFF
    if code == sqlite3.SQLITE_READONLY:
        return os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)
    return code not in NOT_DAMAGE


def _set_aside(path: Path, damage: str) -> tuple[sqlite3.Connection, dict[str, tuple[bool, Record]], str]:
    """Rename a damaged ledger, take its sound rows over into a new one, and say so."""
    rows = list(_sound_rows(path))
    aside = next(
        name for n in range(1, 1_000_000) if not (name := path.with_name(f"{path.name}.damaged-{n}")).exists()
    )
    for ending in COMPANIONS:
        with suppress(FileNotFoundError):
            path.with_name(path.name + ending).rename(aside.with_name(aside.name + ending))
    connection, points = _opened(path)
    connection.execute("BEGIN")
    for row in rows:
        _insert(connection, row)
        points[row.key] = (bool(row.failed), json.loads(row.record))
    connection.execute("COMMIT")
    text = (
        f"ledger {path} {damage}: it is kept as {aside.name}, {len(points)} points read from it are used, the others "
        "are computed again"
    )
    return connection, points, text


def _sound_rows(path: Path) -> Iterator[_Row]:
    """Rows of a damaged ledger that say what was written, found one by one: a damaged page costs its own rows."""
    with suppress(sqlite3.Error), closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_RECORD)
        last = MOST_ROWS
        with suppress(sqlite3.Error, TypeError):
            last = min(last, int(connection.execute("SELECT MAX(rowid) FROM points").fetchone()[0]))
        for number in range(1, last + 1):
            with suppress(sqlite3.Error, TypeError, UnicodeError):
                row = connection.execute("SELECT * FROM points WHERE rowid = ?", (number,)).fetchone()
                if row is not None and (found := _Row(*row)).sound:
                    yield found


# The ledgers of a study: one, or one a job of an array that computes a share of the points.

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

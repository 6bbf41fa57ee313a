"""The ledger of a study: every finished point, on disk the moment it is finished."""

import hashlib
import json
import sqlite3
from pathlib import Path
from types import TracebackType
from typing import Any

from rigdesign import __version__
from rigdesign.errors import OutputError

SCHEMA = """
CREATE TABLE IF NOT EXISTS points (
    key TEXT PRIMARY KEY,
    tool_version TEXT NOT NULL,
    fidelity TEXT NOT NULL,
    case_hash TEXT NOT NULL,
    inputs TEXT NOT NULL,
    failed INTEGER NOT NULL,
    record TEXT NOT NULL
)
"""

Record = dict[str, Any]
"""What is kept of a point: {verdict, max_temperature_degC, checks: [...]} or {error, traceback}."""


def point_key(case_hash: str, fidelity: str) -> str:
    """What makes two points the same computation: resolved case, tool version, fidelity."""
    return hashlib.sha256(f"{case_hash}\n{__version__}\n{fidelity}".encode()).hexdigest()


class Ledger:
    """SQLite file with write-ahead log; a killed process loses no point it has stored.

    Only the process that drives the study writes. A context manager.

    Raises
    ------
    OutputError
        If the file cannot be opened or is no ledger.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._connection = sqlite3.connect(path, timeout=30.0, isolation_level=None)
            self._connection.execute("PRAGMA journal_mode=WAL")
            self._connection.execute("PRAGMA synchronous=FULL")
            self._connection.execute(SCHEMA)
        except sqlite3.Error as error:
            raise OutputError(
                f"ledger {path}: {error}; remove the file to begin again, or give another --out"
            ) from error

    def __enter__(self) -> "Ledger":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._connection.close()

    def stored(self) -> dict[str, tuple[bool, Record]]:
        """Every stored point: key -> (failed, record)."""
        rows = self._connection.execute("SELECT key, failed, record FROM points")
        return {key: (bool(failed), json.loads(record)) for key, failed, record in rows}

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
            self._connection.execute("INSERT OR REPLACE INTO points VALUES (?, ?, ?, ?, ?, ?, ?)", row)
        except sqlite3.Error as error:
            raise OutputError(f"ledger {self._path}: {error}; free space and run the study again") from error

"""A ledger of a study as a killed process leaves it, and every kind of damage a disk can do to its files."""

import json
import random
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from rigdesign.studies.ledger import Ledger, Record

POINTS = 24
PAGE = 4096
JOURNALED = ("", "-journal")
"""Endings of the files of a ledger whose writer was killed."""
Entry = tuple[bool, Record]
Bytes = Callable[[bytes, random.Random], bytes]


def entries() -> dict[str, Entry]:
    """Points of the size of a real one; every fifth one failed."""
    found: dict[str, Entry] = {}
    for number in range(POINTS):
        checks = [
            {"id": f"check_{k}", "title": "a check", "value": number + 0.1 * k, "verdict": "pass"}
            for k in range(40)
        ]
        done: Record = {"verdict": "pass", "max_temperature_degC": 100.0 + number, "checks": checks}
        failed: Record = {"error": f"point {number} did not converge", "kind": "NotConvergedError"}
        found[f"{number:064x}"] = (number % 5 == 0, failed if number % 5 == 0 else done)
    return found


def store(ledger: Ledger, key: str, entry: Entry) -> None:
    ledger.store(key, fidelity="quick", case_hash=key, inputs={"a": key}, failed=entry[0], record=entry[1])


def write_ledger(path: Path) -> None:
    """As after SIGKILL within a transaction: its first pages in the file, what they replace in the journal."""
    work = path.with_name("work.sqlite")
    with Ledger(work) as ledger:
        for key, entry in entries().items():
            store(ledger, key, entry)
    with closing(sqlite3.connect(work, isolation_level=None)) as connection:
        connection.execute("PRAGMA cache_size = 2")
        connection.execute("BEGIN IMMEDIATE")
        connection.execute("UPDATE points SET record = 'never finished' WHERE rowid % 2")
        for ending in JOURNALED:
            shutil.copyfile(work.with_name(work.name + ending), path.with_name(path.name + ending))
        connection.execute("ROLLBACK")


def copy_ledger(source: Path, target: Path) -> None:
    """A ledger with its journal under another name; what belonged to one of that name before is gone."""
    for ending in JOURNALED:
        shutil.copyfile(source.with_name(source.name + ending), target.with_name(target.name + ending))


def _flip(content: bytes, choice: random.Random) -> bytes:
    place = choice.randrange(len(content))
    return content[:place] + bytes([content[place] ^ choice.randrange(1, 256)]) + content[place + 1 :]


def _flip_header(content: bytes, choice: random.Random) -> bytes:
    return _flip(content[:100], choice) + content[100:]


def _cut(content: bytes, choice: random.Random) -> bytes:
    return content[: choice.randrange(len(content))]


def _garbage_at_the_tail(content: bytes, choice: random.Random) -> bytes:
    return content + choice.randbytes(choice.randrange(1, 3 * PAGE))


def _page_lost(content: bytes, choice: random.Random) -> bytes:
    start = PAGE * choice.randrange(max(1, len(content) // PAGE))
    lost = choice.choice([bytes(PAGE), choice.randbytes(PAGE)])
    return content[:start] + lost + content[start + PAGE :]


def _piece_lost(content: bytes, choice: random.Random) -> bytes:
    start = choice.randrange(len(content))
    return content[:start] + content[start + choice.randrange(1, 2 * PAGE) :]


def _all_garbage(content: bytes, choice: random.Random) -> bytes:
    return choice.randbytes(choice.randrange(0, len(content)))


DAMAGE: dict[str, Bytes] = {
    "flip": _flip, "flip in the header": _flip_header, "cut": _cut, "garbage at the tail": _garbage_at_the_tail,
    "page lost": _page_lost, "piece lost": _piece_lost, "all garbage": _all_garbage,
}  # fmt: skip

ROWS = {
    "empty record": "UPDATE points SET record = '' WHERE rowid = 3",
    "cut record": "UPDATE points SET record = substr(record, 1, 50) WHERE rowid = 3",
    "record of another type": "UPDATE points SET record = x'ff00' WHERE rowid = 3",
    "record changed": "UPDATE points SET record = replace(record, 'pass', 'fail') WHERE rowid = 3",
    "failure hidden": "UPDATE points SET failed = 1 - failed WHERE rowid = 3",
    "another key": "UPDATE points SET key = 'k' WHERE rowid = 3",
    "another schema": "ALTER TABLE points RENAME COLUMN record TO result",
    "a column less": "ALTER TABLE points DROP COLUMN fidelity",
    "another table": "ALTER TABLE points RENAME TO results",
    "an earlier format": "PRAGMA user_version = 1",
}
"""What another program, or an earlier version, may have done to the table."""


def harm_rows(path: Path, statement: str) -> None:
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute(statement)


def harm_file(path: Path, kind: str, choice: random.Random) -> str:
    """Damage the ledger, or its journal, in one of the ways of ``DAMAGE``; name of the file damaged."""
    target = path.with_name(path.name + choice.choice(["", "", "-journal"]))
    target.write_bytes(DAMAGE[kind](target.read_bytes(), choice))
    return target.name


def resumed(path: Path) -> tuple[int, str]:
    """Open a damaged ledger, check that all it says is true, store what is missing, and check that it then is whole.

    Returns the number of points it kept, and what it said.
    """
    truth = entries()
    with Ledger(path) as ledger:
        kept, reported = ledger.stored(), ledger.repaired
        assert all(json.dumps(truth[key]) == json.dumps(entry) for key, entry in kept.items())
        for key in truth.keys() - kept.keys():
            store(ledger, key, truth[key])
    with Ledger(path) as ledger:
        assert json.dumps(ledger.stored(), sort_keys=True) == json.dumps(truth, sort_keys=True)
        assert ledger.repaired == ""
    return len(kept), reported

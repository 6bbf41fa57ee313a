"""Keys of an imported case: taken from the file, assumed, or needed from the user; and their form in TOML."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from rigdesign.rexs.attribute_log import MappedAttribute
from rigdesign.rexs.faults import printable

WIDEST_TEXT = 400
"""Characters of a text taken over from a file."""
MOST_PLACES = 6
"""Attributes that one source names; of more it names the first."""


@dataclass(frozen=True)
class Entry:
    """A key of a table.

    value : as TOML; of a needed key an example
    kind : stated: of the file; assumed: in place of what it lacks; needed: to be given by the user
    text : source, reason, or what to give
    targets : places of the gear unit that it is taken from
    range : lowest and highest plausible value of an assumption, as TOML
    markable : False for keys that select a kind of table, whose text becomes a comment
    """

    key: str
    value: str
    kind: Literal["stated", "assumed", "needed"]
    text: str
    targets: tuple[str, ...] = ()
    range: tuple[str, str] | None = None
    markable: bool = True


@dataclass(frozen=True)
class CaseTable:
    """A table of the case.

    path : empty for the keys at its head
    remarks : comments above it
    """

    path: str
    entries: tuple[Entry, ...]
    remarks: tuple[str, ...] = ()

    def place(self, entry: Entry) -> str:
        """Path of a key."""
        return f"{self.path}.{entry.key}" if self.path else entry.key


class Origins:
    """Where each value of a gear unit stands in its file.

    Parameters
    ----------
    file : name of the file, for sources
    mapped : attributes taken over from it
    """

    def __init__(self, file: str, mapped: Sequence[MappedAttribute]) -> None:
        self.file = file
        self._first: dict[str, MappedAttribute] = {}
        for item in mapped:
            self._first.setdefault(item.target, item)

    def knows(self, target: str) -> bool:
        """Whether the file states what stands at a place of the gear unit."""
        return target in self._first

    def attribute(self, target: str) -> str:
        """Name of the attribute, empty where the file does not state it."""
        return self._first[target].attribute if target in self._first else ""

    def under(self, target: str) -> tuple[str, ...]:
        """Places of the gear unit that begin with ``target``."""
        return tuple(known for known in self._first if known.startswith(target))

    def stated(self, key: str, value: str, *targets: str, note: str = "") -> Entry:
        """A key with its source: component and attribute of the first target, then those of the others."""
        found = [self._first[target] for target in targets if target in self._first]
        if note and len(found) > MOST_PLACES:
            found = found[:1]
        places = "; ".join(dict.fromkeys(map(_place, found))) or "structure of the model"
        text = f"{self.file}: {places}" + (f" ({note})" if note else "")
        return Entry(key, value, "stated", text, targets)


def assumed(key: str, value: str, reason: str, *ends: str) -> Entry:
    """An assumed value, with the two ends of its range where it has one."""
    limits = (ends[0], ends[1]) if len(ends) == 2 else None
    return Entry(key, value, "assumed", reason, range=limits)


def needed(key: str, example: str, remedy: str) -> Entry:
    """A key that the user has to give."""
    return Entry(key, example, "needed", remedy)


def _place(item: MappedAttribute) -> str:
    where = f"{item.type} {item.component}, {item.attribute}"
    return where if item.load_case is None else f"{where}, load case {item.load_case}"


def quoted(text: str) -> str:
    """A TOML string."""
    return json.dumps(printable(" ".join(text.split()))[:WIDEST_TEXT], ensure_ascii=False)


def quantity(value: float, unit: str) -> str:
    """A number in its unit as a TOML string, without the last digits of the conversion from SI."""
    return f'"{value:.9g} {unit}"'


def millimetres(length: float) -> str:
    """A length [m]."""
    return quantity(1e3 * length, "mm")


def toml_text(tables: Sequence[CaseTable], *, with_examples: bool = False) -> str:
    """The tables as a file; needed keys are comments, or with examples, keys like any other."""
    return "\n".join(line for table in tables for line in _table(table, with_examples)) + "\n"


def _table(table: CaseTable, with_examples: bool) -> Iterator[str]:
    for remark in table.remarks:
        yield f"# {printable(' '.join(remark.split()))}"
    if table.path:
        yield f"[{table.path}]"
    for entry in table.entries:
        yield from _entry(entry, with_examples)
    yield ""


def _entry(entry: Entry, with_examples: bool) -> Iterator[str]:
    if entry.kind == "needed":
        yield f"# NEEDED, {printable(entry.text)}:"
        yield f"{'' if with_examples else '# '}{entry.key} = {entry.value}"
    elif not entry.markable:
        said = "assumed: " if entry.kind == "assumed" else ""
        yield f"# {said}{printable(' '.join(entry.text.split()))[:WIDEST_TEXT]}"
        yield f"{entry.key} = {entry.value}"
    else:
        mark = "source" if entry.kind == "stated" else "assumed"
        limits = "" if entry.range is None else f", range = [{entry.range[0]}, {entry.range[1]}]"
        yield f"{entry.key} = {{ value = {entry.value}, {mark} = {quoted(entry.text)}{limits} }}"

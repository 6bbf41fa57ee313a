"""The stated values of a case as a tree again: what the input sheets and the drawing of the rig read."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rigdesign.case.inputs import InputRow
from rigdesign.report.numbers import stated_text


@dataclass(frozen=True)
class CaseSheet:
    """A table of the case by key: a table again, or a row with value and basis."""

    entries: Mapping[str, Any]

    @classmethod
    def of(cls, rows: Sequence[InputRow]) -> "CaseSheet":
        """The tree of ``RunResult.inputs``."""
        tree: dict[str, Any] = {}
        for row in rows:
            *tables, key = row.path.split(".")
            node = tree
            for table in tables:
                node = node.setdefault(table, {})
            node[key] = row
        return cls(tree)

    def table(self, path: str) -> "CaseSheet":
        """The table at a dotted path; an empty one where the case has none."""
        node: Any = self.entries
        for key in path.split("."):
            node = node.get(key, {}) if isinstance(node, Mapping) else {}
        return CaseSheet(node if isinstance(node, Mapping) else {})

    def tables(self, path: str) -> Iterator[tuple[str, "CaseSheet"]]:
        """Name and content of every table in the table at a path."""
        for name, node in self.table(path).entries.items():
            if isinstance(node, Mapping):
                yield name, CaseSheet(node)

    def raw(self, path: str, absent: str = "") -> str:
        """A value as the case writes it."""
        parent, _, key = path.rpartition(".")
        row = (self.table(parent) if parent else self).entries.get(key)
        return row.value if isinstance(row, InputRow) else absent

    def value(self, path: str, absent: str = "–") -> str:
        """A value as it reads in a report."""
        found = self.raw(path)
        return stated_text(found) if found else absent

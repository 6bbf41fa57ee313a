"""Every value a case states, as one list: for the report, and for what differs between two results."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rigdesign.case.provenance import Mark, item_name, take_off

LABELS = ("schema_version", "name", "title")
"""Keys that name a case or a part of it; no result depends on them."""


@dataclass(frozen=True, kw_only=True)
class InputRow:
    """One value of the resolved case.

    path : dotted path, items of a list by name or number
    value : as the case writes it; a list of values joined by commas
    basis : ``measured: …``, ``assumed: …`` or the source; empty where the case says none
    """

    path: str
    value: str
    basis: str = ""


def is_label(path: str) -> bool:
    """Whether a value only names something, or says who answers for the report."""
    return path.rpartition(".")[2] in LABELS or path.startswith("document.")


def input_rows(tree: Mapping[str, Any]) -> tuple[InputRow, ...]:
    """The values of a resolved tree with their marks, in the order of the file."""
    plain, marks, _ = take_off(dict(tree))
    basis = {mark.path: mark.basis for mark in marks}
    return tuple(
        InputRow(path=path, value=value, basis=basis.get(path, "")) for path, value in _leaves(plain, "")
    )


def _leaves(node: Any, path: str) -> Iterator[tuple[str, str]]:
    if isinstance(node, Mapping):
        for key, value in node.items():
            yield from _leaves(value, f"{path}.{key}" if path else str(key))
    elif (
        isinstance(node, Sequence) and not isinstance(node, str) and any(isinstance(i, Mapping) for i in node)
    ):
        for number, item in enumerate(node):
            yield from _leaves(item, f"{path}.{item_name(item, number)}")
    else:
        yield path, Mark(path, node).shown

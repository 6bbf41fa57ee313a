"""Marks: what a case file says about a value besides the value.

Any value may be written as a table that holds it under ``value`` with one or more marks:

    flow = { value = "5 l/min", assumed = "as for an FZG rig of this power", range = ["3 l/min", "8 l/min"] }
    damping = { value = "1000 N s/m", source = "P2, Table 1" }
    root_strength = { value = "1600 MPa", confirmed = "shot-peened, own pulsator tests" }
    heat_transfer_coefficient = { value = "9.1 W/(m2 K)", measured = "heat flux foil, 2026-05-12" }

The loader takes the marks off before the values are validated and keeps them by path.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from rigdesign.case.fields import RangeEnds, text_fault

MARKS = ("assumed", "range", "source", "measured", "confirmed")
KEYS = frozenset(("value", *MARKS))

MarkKind = Literal["measured", "assumed", "source", "confirmed"]
"""Where a value comes from, by its mark."""


@dataclass(frozen=True)
class Mark:
    """What is known about one value.

    path : dotted path of the value
    value : the value as written
    assumed : reason of an assumption
    range : lowest and highest plausible value, as written
    source : where it is printed
    measured : the measurement that replaces a computed or printed value
    confirmed : why a value outside of its usual range is right
    """

    path: str
    value: Any
    assumed: str | None = None
    range: RangeEnds | None = None
    source: str | None = None
    measured: str | None = None
    confirmed: str | None = None

    @property
    def shown(self) -> str:
        """The value as text; a list or table by its size."""
        if isinstance(self.value, list | tuple):
            items = [str(item) for item in self.value if not isinstance(item, dict)]
            return ", ".join(items) if len(items) == len(self.value) else f"{len(self.value)} entries"
        if isinstance(self.value, dict):
            return ", ".join(f"{key} {item}" for key, item in self.value.items())
        if isinstance(self.value, bool):
            return "true" if self.value else "false"
        if isinstance(self.value, float):
            return f"{self.value:g}"
        return str(self.value)

    @property
    def said(self) -> tuple[tuple[MarkKind, str], ...]:
        """Where the value comes from and in which words: measurement, assumption, printed source; what is given."""
        every: tuple[tuple[MarkKind, str | None], ...] = (
            ("measured", self.measured),
            ("assumed", self.assumed),
            ("source", self.source),
            ("confirmed", self.confirmed),
        )
        return tuple((kind, text) for kind, text in every if text is not None)

    @property
    def basis(self) -> str:
        """All of `said` in one line, ``measured: …; assumed: …; source``; empty where the mark is a range alone."""
        return "; ".join(text if kind == "source" else f"{kind}: {text}" for kind, text in self.said)

    def as_record(self) -> dict[str, Any]:
        """The marks without the value, for the hash of a case."""
        return {
            "path": self.path,
            **{key: getattr(self, key) for key in MARKS if getattr(self, key) is not None},
        }


@dataclass(frozen=True)
class MarkFault:
    """A mark that cannot be read."""

    path: str
    given: str
    problem: str
    remedy: str


def is_marked(node: object) -> bool:
    """Whether a table is a value with marks and not a part of the case."""
    if not isinstance(node, dict) or "value" not in node or not set(node) <= KEYS:
        return False
    return len(node) > 1 or not isinstance(node["value"], dict)


def take_off(tree: dict[str, Any]) -> tuple[dict[str, Any], tuple[Mark, ...], tuple[MarkFault, ...]]:
    """The tree with plain values, the marks found, and the marks that cannot be read."""
    marks: list[Mark] = []
    faults: list[MarkFault] = []

    def strip(node: Any, path: str) -> Any:
        if isinstance(node, dict):
            if is_marked(node):
                mark, wrong = _read(node, path)
                marks.extend([mark] if mark is not None else [])
                faults.extend(wrong)
                return strip(node["value"], path)
            return {key: strip(value, f"{path}.{key}" if path else key) for key, value in node.items()}
        if isinstance(node, list | tuple):
            return tuple(strip(item, f"{path}.{item_name(item, i)}") for i, item in enumerate(node))
        return node

    return strip(tree, ""), tuple(marks), tuple(faults)


def item_name(item: object, index: int) -> str:
    """How a path names an item of a list: by its ``name``, else by its number."""
    if isinstance(item, dict) and isinstance(item.get("name"), str):
        return str(item["name"])
    return str(index)


def _read(node: dict[str, Any], path: str) -> tuple[Mark | None, list[MarkFault]]:
    faults = []
    for key in ("assumed", "source", "measured", "confirmed"):
        text = node.get(key, key)
        if not (isinstance(text, str) and text.strip()):
            remedy = f'write {key} = "…", a reason or source'
            faults.append(MarkFault(path, repr(text), f"mark '{key}' is not a text", remedy))
        elif (wrong := text_fault(text)) is not None:
            faults.append(MarkFault(path, repr(text), f"mark '{key}': {wrong[0]}", wrong[1]))
    limits = node.get("range")
    if limits is not None and not (isinstance(limits, list | tuple) and len(limits) == 2):
        faults.append(
            MarkFault(path, repr(limits), "a range has two ends", 'write range = ["lowest", "highest"]')
        )
    if faults or set(node) == {"value"}:
        return None, faults
    mark = Mark(
        path=path,
        value=node["value"],
        assumed=node.get("assumed"),
        range=None if limits is None else (limits[0], limits[1]),
        source=node.get("source"),
        measured=node.get("measured"),
        confirmed=node.get("confirmed"),
    )
    return mark, []


# Every value a case states, as one list: for the report, and for what differs between two results.

LABELS = ("schema_version", "name", "title")
"""Keys that name a case or a part of it; no result depends on them."""


@dataclass(frozen=True, kw_only=True)
class MeasuredInput:
    """An input that a measured value replaces; measured : where from."""

    path: str
    value: str
    measured: str


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

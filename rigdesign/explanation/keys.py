"""Every key a case file may hold, from its schema: path, kind, units, default, what it is.

A path stands with placeholders: ``NAME`` for a part that the user names, ``N`` for an item of a list.
"""

import inspect
import re
import typing
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rigdesign.base import units
from rigdesign.base.errors import UsageError
from rigdesign.base.units import KINDS
from rigdesign.case.defaults.fill import WRITTEN_ONCE, has_default
from rigdesign.case.defaults.rule import BY_THE_TOOL
from rigdesign.case.fields import Name, Quantity, kind_key, of_kind, variant_of
from rigdesign.case.model import Case
from rigdesign.case.paths import Slot, known_paths, nearest_paths, path_pattern, slot_at, slot_of
from rigdesign.case.provenance import is_label, take_off
from rigdesign.case.usual import unusual_inputs
from rigdesign.checks.assumptions import depends, influences_of
from rigdesign.checks.registry import REGISTRY, RuleFamily
from rigdesign.checks.rules import Rule, not_applicable
from rigdesign.results.check import Check

NAMED, NUMBERED = "NAME", "N"
"""Placeholders of a path."""
PLAIN = {float: "number", int: "whole number", str: "text", bool: "true or false"}
LIMITS = {"ge": (Ge, "at least"), "gt": (Gt, "above"), "le": (Le, "at most"), "lt": (Lt, "below")}
_NAME_PATTERN = typing.get_args(Name)[1].metadata


@dataclass(frozen=True, kw_only=True)
class KeyEntry:
    """One key.

    path : with placeholders; variant : kind of table that has the key, as ``law = radiation``; empty elsewhere
    kind : quantity kind, type or choices, in words; units : accepted spellings, the usual one first
    default : as a case would write it; None where the key is required or nothing stands for it when left out
    filled_in : a case may leave it out, the tool then writes a default with its reason
    """

    path: str
    variant: str = ""
    kind: str
    units: tuple[str, ...] = ()
    bounds: str = ""
    default: str | None = None
    required: bool
    description: str
    table: bool = False
    """It holds further keys."""
    filled_in: bool = False

    @property
    def default_text(self) -> str:
        """The default in words."""
        if self.filled_in:
            return "by the tool"
        return "required" if self.required else self.default or "left out"


@cache
def case_keys() -> tuple[KeyEntry, ...]:
    """Every key and named part in the order of the schema, tables before their keys."""
    return tuple(_keys_of(Case, "", ""))


def entry_at(path: str, variant: str = "") -> KeyEntry | None:
    """The entry of a key or part of a case by its path, for a value of a list that of the list; None if there is none.

    variant : of the table that the path leads into
    """
    table, _, last = path.rpartition(".")
    fitting = [entry for fits, entry in _by_length().get(path.count("."), ()) if fits.fullmatch(path)]
    if not fitting:
        return entry_at(table, variant) if last.isdigit() else None
    return next((entry for entry in fitting if entry.variant in ("", variant)), fitting[0])


def starred(path: str) -> str:
    """A path with placeholders as a pattern with ``*``."""
    return ".".join("*" if key in (NAMED, NUMBERED) else key for key in path.split("."))


@cache
def _by_length() -> Mapping[int, tuple[tuple[re.Pattern[str], KeyEntry], ...]]:
    """Entries by the number of dots in their paths, each with the pattern that its paths fit."""
    found: dict[int, list[tuple[re.Pattern[str], KeyEntry]]] = {}
    for entry in case_keys():
        found.setdefault(entry.path.count("."), []).append((path_pattern(starred(entry.path)), entry))
    return {number: tuple(entries) for number, entries in found.items()}


def entry_of(path: str, field: FieldInfo, variant: str = "") -> KeyEntry:
    """The entry of one field."""
    slot = slot_of(field.annotation, field.metadata)
    quantity = slot.quantity
    filled_in = has_default(starred(path))
    return KeyEntry(
        path=path,
        variant=variant,
        kind=kind_text(slot),
        units=() if quantity is None else tuple(KINDS[quantity.kind].like(quantity.shown_example).units),
        bounds=_bounds(slot),
        default=_default(field, quantity),
        required=field.is_required() and not filled_in,
        filled_in=filled_in,
        description=" ".join((field.description or "").split()),
        table=slot.table is not None,
    )


def kind_text(slot: Slot) -> str:
    """What a place holds: kind of quantity, type, choices, or table."""
    words = dict.fromkeys(_kind(kind, metadata) for kind, metadata in slot.choices)
    return " or ".join(words)


def _kind(kind: Any, metadata: tuple[Any, ...]) -> str:
    quantity = next((item for item in metadata if isinstance(item, Quantity)), None)
    if quantity is not None:
        return KINDS[quantity.kind].label
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is typing.Literal:
        return " | ".join(f'"{value}"' if isinstance(value, str) else str(value) for value in arguments)
    if origin is tuple:
        inner = [argument for argument in arguments if argument is not Ellipsis]
        return f"list of {kind_text(slot_of(inner[0]))}" + (
            "" if Ellipsis in arguments else f" ({len(inner)})"
        )
    if origin is Mapping:
        return "tables by name"
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return "table"
    return "name" if any(item in _NAME_PATTERN for item in metadata) else PLAIN.get(kind, "text")


def _bounds(slot: Slot) -> str:
    """Possible and usual range of a number in words."""
    usually = [f"usually {usual.words}" for usual in slot.usual[-1:]]
    if slot.quantity is not None:
        return "; ".join(filter(None, (slot.quantity.bounds, *usually)))
    found = [
        f"{word} {getattr(item, name):g}"
        for _, metadata in slot.choices
        for item in _constraints(metadata)
        for name, (sign, word) in LIMITS.items()
        if isinstance(item, sign)
    ]
    return "; ".join(filter(None, (" and ".join(dict.fromkeys(found)), *usually)))


def _constraints(metadata: tuple[Any, ...]) -> Iterator[Any]:
    """Constraints of a field, also those inside a nested pydantic field."""
    for item in metadata:
        if isinstance(item, FieldInfo):
            yield from item.metadata
        else:
            yield item


def _default(field: FieldInfo, quantity: Quantity | None) -> str | None:
    if field.is_required():
        return None
    value = field.get_default(call_default_factory=True)
    if value is None or isinstance(value, BaseModel) or value in ((), {}):
        return None
    return value_text(value, quantity)


def value_text(value: Any, quantity: Quantity | None) -> str:
    """A value as a case would write it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return ", ".join(value_text(item, quantity) for item in value)
    if isinstance(value, float) and quantity is not None:
        return units.show(value, quantity.kind, quantity.shown_example.partition(" ")[2])
    return f"{value:g}" if isinstance(value, float) else str(value)


def _keys_of(model: type[BaseModel], path: str, variant: str) -> Iterator[KeyEntry]:
    for key, field in model.model_fields.items():
        here = f"{path}.{key}" if path else key
        yield entry_of(here, field, variant)
        for inner, below in _tables(slot_of(field.annotation, field.metadata), here):
            yield from _inner_keys(inner, below, variant)


def _inner_keys(models: tuple[type[BaseModel], ...], path: str, variant: str) -> Iterator[KeyEntry]:
    """Keys of a table that may be one of several, each with the kind that has it."""
    placeholder = path.endswith((f".{NAMED}", f".{NUMBERED}"))
    for model in models:
        own = variant_of(model, models) if len(models) > 1 else variant
        if placeholder:
            text = (inspect.getdoc(model) or "").partition("\n\n")[0]
            yield KeyEntry(
                path=path,
                variant=own,
                kind="table",
                required=False,
                description=" ".join(text.split()),
                table=True,
            )
        yield from _keys_of(model, path, own)


def _tables(slot: Slot, path: str) -> Iterator[tuple[tuple[type[BaseModel], ...], str]]:
    """Tables that a place holds, each with the path of its keys."""
    for kind, _ in slot.choices:
        origin, arguments = typing.get_origin(kind), typing.get_args(kind)
        if origin is tuple or origin is Mapping:
            models = tuple(slot_of(arguments[1 if origin is Mapping else 0]).models())
            if models:
                yield (
                    models,
                    f"{path}.{NAMED if origin is Mapping or 'name' in models[0].model_fields else NUMBERED}",
                )
    direct = tuple(slot.models())
    if direct:
        yield direct, path


# The key reference: every key of the case file by table, generated from the schema.

HEADER = f"""\
# Keys of a case file

Generated from the schema by `rigdesign schema --reference`; a test holds it current.
`{NAMED}` stands for the name of a part, `{NUMBERED}` for the number of an item in a list. A quantity is a text
with a unit, `"7 mm"`; any value may be a table that says where it comes from:
`{{ value = …, source = …, assumed = …, range = […], measured = … }}`.
`rigdesign explain CASE PATH` says what a key is in one case and which checks depend on it.

A key whose default is `by the tool` may be left out: its value is worked out from the rest of the case and stands in
the report as an assumption with its reason and range, "default of the tool: …". What is stated is never touched.
Equal parts are written once, in a table of `gearboxes`:

"""


def key_reference() -> str:
    """The reference as Markdown: a section for every table, a row for every key."""
    written_once = "".join(f"- `{key}`: {text}\n" for key, (_, text) in WRITTEN_ONCE.items())
    return "\n".join([HEADER + written_once, *_sections()])


def _sections() -> Iterator[str]:
    entries = case_keys()
    tables = {(entry.path, entry.variant): entry for entry in entries if entry.table}
    groups: dict[tuple[str, str], list[KeyEntry]] = {}
    for entry in entries:
        if not entry.path.endswith((f".{NAMED}", f".{NUMBERED}")):
            groups.setdefault((entry.path.rpartition(".")[0], entry.variant), []).append(entry)
    for (path, variant), keys in groups.items():
        yield f"## {path or 'case'}" + (f" with {variant}" if variant else "") + "\n"
        table = tables.get((path, variant)) or tables.get((path, ""))
        if table is not None and table.description:
            yield f"{_cell(table.description)}\n"
        yield "| key | holds | default | what it is |\n|---|---|---|---|"
        yield from (_row(key) for key in keys)
        yield ""


def _row(key: KeyEntry) -> str:
    name = key.path.rpartition(".")[2]
    units = f" [{', '.join(key.units)}]" if key.units else ""
    bounds = f", {key.bounds}" if key.bounds else ""
    default = key.default_text if key.required or key.filled_in or key.default is None else f"`{key.default}`"
    return f"| `{name}` | {_cell(key.kind + units + bounds)} | {_cell(default)} | {_cell(key.description)} |"


def _cell(text: str) -> str:
    return text.replace("``", "`").replace("|", "\\|")


# The checks of a case before it is solved, each with its family.


def declared_rules(case: Case) -> Iterator[tuple[RuleFamily, Rule]]:
    """Every rule of a case in the order of the report; those of the thermal history as well."""
    for family in REGISTRY.families():
        for rule in family.rules(case):
            yield family, rule


def declared_checks(case: Case) -> list[Check]:
    """The checks of a case without values."""
    return [not_applicable(rule, "not computed") for _, rule in declared_rules(case)]


def depends_on(case: Case, check: Check, path: str) -> bool:
    """Whether the value or limit of a check depends on an input, by what its family declares."""
    return not is_label(path) and depends(case, check, path)


# A key of a case explained: what it is, its value and where that comes from, what it moves.

BasisKind = Literal["measured", "assumed", "source", "confirmed", "stated", "default", "left out"]
"""Where a value comes from: a measurement, an assumption, a printed source, the case alone, the tool."""


@dataclass(frozen=True, kw_only=True)
class StatedValue:
    """The value of one key in a case.

    value : as the case writes it, else the default; empty where the key is left out and has none
    basis : kind of its origin; reason : in the words of the case; range : lowest and highest plausible value
    """

    path: str
    value: str
    basis: BasisKind
    reason: str = ""
    range: tuple[str, str] | None = None
    description: str = ""
    """Of a key of a table; empty for the key that was asked for."""
    table: bool = False


@dataclass(frozen=True, kw_only=True)
class PathExplanation:
    """A key, or a table with its keys.

    asked : path as asked, ``*`` for any name
    key : what the schema says of it
    values : of every place the path stands for
    keys : of a table, its keys with their values
    influences : groups of inputs it belongs to; None if it moves every check
    checks : ids of the checks that depend on it
    all_checks : how many checks the case has
    """

    asked: str
    key: KeyEntry
    values: tuple[StatedValue, ...]
    unusual: tuple[str, ...]
    """Which of them are outside of their usual range, in words."""
    keys: tuple[StatedValue, ...]
    influences: tuple[str, ...] | None
    checks: tuple[str, ...]
    all_checks: int


def explain_path(case: Case, path: str) -> PathExplanation:
    """What a path of a case stands for.

    path : dotted; ``*`` stands for any name

    Raises
    ------
    UsageError
        No such path; the nearest ones are named.
    """
    plain, _, _ = take_off(dict(case.origin.tree))
    known = known_paths(Case, plain)
    pattern = path_pattern(path)
    places = [one for one in known if pattern.fullmatch(one)]
    if not places:
        meant = nearest_paths(path, known)
        hint = (
            f"did you mean {' or '.join(meant)}?" if meant else "rigdesign schema --reference lists the keys"
        )
        raise UsageError(f"{path}: no such path in {case.path}; {hint}")
    kinds = list(dict.fromkeys(starred(_entry(plain, one).path) for one in places))
    if len(kinds) > 1:
        raise UsageError(
            f"{path}: stands for {len(kinds)} different keys of {case.path} ({', '.join(kinds[:3])} …); ask for one of "
            "them, or leave the path out for the whole case"
        )
    entry = _entry(plain, places[0])
    below = (
        (tuple(_keys_below(case, plain, known, places[0])) or _keys_of_parts(entry)) if entry.table else ()
    )
    influences = None if entry.table else influences_of(case, places[0])
    checks = declared_checks(case)
    moved = (
        ()
        if entry.table
        else tuple(check.id for check in checks if any(depends_on(case, check, one) for one in places))
    )
    return PathExplanation(
        asked=path,
        key=entry,
        values=() if entry.table else tuple(_value(case, one, entry) for one in places),
        unusual=tuple(text for one, text in unusual_inputs(case).items() if one in places),
        keys=below,
        influences=influences,
        checks=moved,
        all_checks=len(checks),
    )


def _entry(plain: Any, path: str) -> KeyEntry:
    entry = entry_at(path, _variant(plain, path))
    assert entry is not None, path
    return entry


def _variant(plain: Any, path: str) -> str:
    """The kind of the nearest table above a key that comes in kinds."""
    node, variant, keys = plain, "", list[str]()
    for key in path.split("."):
        keys.append(key)
        node = node.get(key) if isinstance(node, dict) else None
        place = slot_at(Case, plain, keys) if isinstance(node, dict) else None
        models = [] if place is None else list(place.models())
        if len(models) > 1 and isinstance(node, dict) and kind_key(models):
            variant = variant_of(of_kind(models, node)[0], models)
    return variant


def _keys_below(case: Case, plain: Any, known: list[str], path: str) -> Iterator[StatedValue]:
    """Keys one level below a table."""
    depth = path.count(".") + 1
    for one in known:
        if one.startswith(f"{path}.") and one.count(".") == depth:
            entry = _entry(plain, one)
            yield _value(case, one, entry, description=entry.description)


def _keys_of_parts(table: KeyEntry) -> tuple[StatedValue, ...]:
    """Keys that the parts of a table without parts would have."""
    return tuple(
        StatedValue(
            path=entry.path, value=entry.default_text, basis="left out", description=entry.description,
            table=entry.table,
        )
        for entry in case_keys()
        if starred(entry.path).rpartition(".")[0] == f"{starred(table.path)}.*"
    )  # fmt: skip


def _value(case: Case, path: str, entry: KeyEntry, *, description: str = "") -> StatedValue:
    stated = case.origin.value_of.get(path)
    mark = case.origin.mark_of.get(path)
    implied = next((record for record in case.assumptions if record.path == path), None)
    if stated is None and implied is not None:
        return StatedValue(
            path=path, value=implied.value, basis="assumed", reason=implied.reason, description=description
        )
    if entry.table:
        return StatedValue(path=path, value="", basis="stated", description=description, table=True)
    if stated is None:
        return StatedValue(
            path=path,
            value=entry.default or "",
            basis="left out" if entry.default is None else "default",
            description=description,
        )
    nothing: tuple[BasisKind, str] = ("stated", "")
    basis, reason = mark.said[0] if mark is not None and mark.said else nothing
    if reason.startswith(BY_THE_TOOL):
        basis, reason = "default", reason.removeprefix(BY_THE_TOOL)
    limits = None if mark is None or mark.range is None else (str(mark.range[0]), str(mark.range[1]))
    return StatedValue(
        path=path, value=stated, basis=basis, reason=reason, range=limits, description=description
    )

"""A key of a case explained: what it is, its value and where that comes from, what it moves."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

from rigdesign.base.errors import UsageError
from rigdesign.case.defaults.rule import BY_THE_TOOL
from rigdesign.case.fields import kind_key, of_kind, variant_of
from rigdesign.case.model import Case
from rigdesign.case.paths import known_paths, nearest_paths, path_pattern, slot_at
from rigdesign.case.provenance import take_off
from rigdesign.case.usual import unusual_inputs
from rigdesign.checks.assumptions import influences_of
from rigdesign.explanation.keys import KeyEntry, case_keys, declared_checks, depends_on, entry_at, starred

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

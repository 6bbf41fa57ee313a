"""Loads a case: file -> tree -> equal parts -> defaults -> marks off -> validated -> rules; every fault at once."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rigdesign.base import units
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.defaults.consequences import causes_first
from rigdesign.case.defaults.fill import filled_as_a_whole, with_defaults
from rigdesign.case.defaults.housings import missing_films
from rigdesign.case.equal_parts import EqualParts, written_out
from rigdesign.case.faults import MISSING, faults_of, written
from rigdesign.case.model import Case, Origin
from rigdesign.case.paths import Slot, known_paths, nearest_paths, places, slot_at
from rigdesign.case.provenance import Mark, is_marked, item_name, take_off
from rigdesign.case.rules.gathered import broken_rules
from rigdesign.case.source import case_file, read_tree


def load_case(path: str | Path) -> Case:
    """Load and validate a case.

    Parameters
    ----------
    path : case folder or its case file; ``extends`` in it is followed

    Raises
    ------
    CaseError
        With every fault found: path, value, what is accepted, remedy.
    """
    file = case_file(Path(path))
    stated, equal = written_out(read_tree(file), str(file))
    return _build(stated, file, equal)


def changed_together(case: Case, values: Mapping[str, object]) -> Case:
    """A copy of ``case`` with several values replaced by path, validated once: they may have to agree.

    Raises
    ------
    CaseError
        A path that does not exist, or faults of the changed case.
    """
    stated, plain = case.origin.stated, take_off(dict(case.origin.tree))[0]
    left_out: list[tuple[list[str], object]] = []
    for path, value in values.items():
        found = places(Case, path, plain)
        if not found:
            meant = nearest_paths(path, known_paths(Case, plain))
            remedy = "did you mean " + " or ".join(meant) + "?" if meant else "see the schema for its paths"
            raise CaseError([Fault(path, "", "no such path in this case", remedy)], str(case.path))
        for place, slot in found.items():
            keys, new = place.split("."), _coerced(value, slot)
            if _stands(stated, keys):
                stated = _replaced(stated, keys, new)
            else:
                left_out.append((keys, new))
    for keys, new in left_out:
        stated = _replaced(_with_default(stated, keys, case.origin.tree), keys, new)
    return _build(stated, case.path, EqualParts({}, {}, {}), copies_of=case.origin.copies_of)


def _stands(tree: Any, keys: Sequence[str]) -> bool:
    """Whether a tree holds something at a path."""
    node = tree
    for key in keys:
        node = node["value"] if is_marked(node) else node
        if isinstance(node, list | tuple):
            names = [item_name(item, index) for index, item in enumerate(node)]
            if key not in names and not (key.isdigit() and int(key) < len(node)):
                return False
            node = node[names.index(key) if key in names else int(key)]
        elif isinstance(node, Mapping) and key in node:
            node = node[key]
        else:
            return False
    return True


def _with_default(
    stated: Mapping[str, Any], keys: Sequence[str], known: Mapping[str, Any]
) -> Mapping[str, Any]:
    """``stated`` with the table or list around a path that a rule fills in as a whole, so that one of its values can
    be replaced; the other defaults still follow the rest of the case, but for films added to those that it states,
    which are as ``known``."""
    for depth in range(1, len(keys)):
        above = keys[:depth]
        if not _stands(stated, above) and filled_as_a_whole(".".join(above)):
            tree = with_defaults(stated)
            if _stands(tree, above):
                filled = dict(_replaced(stated, above, _node(tree, above)))
                for lost in _lost(tree, with_defaults(filled)):
                    filled = dict(_replaced(filled, lost, _node(tree, lost)))
                return filled
            if _stands(known, above):
                return dict(_replaced(stated, above, _node(known, above)))
    return stated


def _lost(before: Any, after: Any, keys: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Paths of what stands in one tree and not in another: defaults of a table that was not stated, and is now."""
    before = before["value"] if is_marked(before) else before
    after = after["value"] if is_marked(after) else after
    if not isinstance(before, Mapping) or not isinstance(after, Mapping):
        return
    for key, node in before.items():
        if key not in after:
            yield (*keys, key)
        else:
            yield from _lost(node, after[key], (*keys, key))


def _node(tree: Any, keys: Sequence[str]) -> Any:
    """What stands at a path of names, with its marks."""
    for key in keys:
        tree = tree["value"][key] if is_marked(tree) else tree[key]
    return tree


def _build(
    stated: Mapping[str, Any],
    file: Path,
    equal: EqualParts,
    tree: Mapping[str, Any] | None = None,
    *,
    copies_of: Callable[[str], tuple[str, ...]] | None = None,
) -> Case:
    """The case of what a file states; faults stand where ``equal`` has them.

    tree : with its defaults, as far as they are filled in already; copies_of : paths that follow that of
    an equal part, those of ``equal`` when left out
    """
    tree = with_defaults(stated) if tree is None else tree
    plain, marks, wrong_marks = take_off(dict(tree))
    faults = [Fault(wrong.path, wrong.given, wrong.problem, wrong.remedy) for wrong in wrong_marks]
    faults += [fault for mark in marks if mark.range is not None for fault in _range_faults(mark, plain)]
    try:
        case = Case.model_validate(plain)
    except ValidationError as error:
        found = causes_first([*faults_of(error, Case, plain), *faults], marks, MISSING)
        raise CaseError(equal.as_written(found), str(file)) from None
    if films := dict(missing_films(tree, case)):
        for path, film in films.items():
            tree = _replaced(tree, path.split("."), film)
        return _build(stated, file, equal, tree, copies_of=copies_of)
    faults += broken_rules(case)
    if faults:
        raise CaseError(equal.as_written(faults), str(file))
    case._origin = Origin(file, stated, tree, marks, changed_together, copies_of or equal.copies_of)
    return case


def _range_faults(mark: Mark, plain: Mapping[str, Any]) -> list[Fault]:
    """A range holds values of the same kind, in order, and contains the value."""
    assert mark.range is not None
    slot = slot_at(Case, plain, mark.path.split("."))
    if slot is None:
        return []
    shown = f"[{written(mark.range[0])}, {written(mark.range[1])}]"
    where = f"{mark.path} (range)"
    try:
        kind = slot.quantity.kind if slot.quantity is not None else units.kind_of(mark.value)
        low, high, value = (_number(item, kind) for item in (*mark.range, mark.value))
    except units.QuantityError as error:
        return [Fault(where, shown, error.problem, error.remedy)]
    if not low < high:
        return [Fault(where, shown, "the first end is not below the second", "exchange or correct them")]
    if not low <= value <= high:
        return [
            Fault(
                where,
                shown,
                f"does not contain the value {written(mark.value)}",
                "widen it or correct the value",
            )
        ]
    return []


def _number(item: object, kind: str | None) -> float:
    if kind is not None:
        return units.parse(item, kind)
    if isinstance(item, int | float) and not isinstance(item, bool):
        return float(item)
    raise units.QuantityError(
        f"{units.describe(item)} where a bare number belongs", "write bare numbers as the value itself is one"
    )


def _coerced(value: object, slot: Slot) -> object:
    """A text from a command line as the number or true/false the place holds."""
    if isinstance(value, str) and slot.quantity is None and set(slot.plain_types) & {float, int, bool}:
        words = {"true": True, "false": False}
        for read in (int, float, words.__getitem__):
            try:
                return read(value)
            except (ValueError, KeyError):
                continue
    return value


def _replaced(node: Any, keys: Sequence[str], value: object) -> Any:
    """The tree with one value replaced; the old tree is left alone, an assumption keeps its reason."""
    if is_marked(node) and not (keys and keys[0] == "value"):
        inner = _replaced(node["value"], keys, value)
        if keys:
            return {**node, "value": inner}
        return {"value": inner, "assumed": node["assumed"]} if "assumed" in node else inner
    if not keys:
        return value
    if isinstance(node, list | tuple):
        names = [item_name(item, index) for index, item in enumerate(node)]
        here = names.index(keys[0]) if keys[0] in names else int(keys[0])
        return [_replaced(item, keys[1:], value) if i == here else item for i, item in enumerate(node)]
    table = dict(node or {})
    table[keys[0]] = _replaced(table.get(keys[0]), keys[1:], value)
    return table

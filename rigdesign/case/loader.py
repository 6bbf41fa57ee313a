"""Loads a case: file -> tree -> equal parts -> defaults -> marks off -> validated -> rules; every fault at once."""

import copy
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rigdesign.base import units
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.defaults.fill import causes_first, filled_as_a_whole, with_defaults
from rigdesign.case.defaults.housings import missing_films
from rigdesign.case.defaults.rule import RawTree, follows, unmarked
from rigdesign.case.faults import MISSING, faults_of, unknown, written
from rigdesign.case.fields import RangeEnds
from rigdesign.case.model import Case, Origin
from rigdesign.case.paths import Slot, known_paths, nearest_paths, places, slot_at
from rigdesign.case.provenance import Mark, is_marked, item_name, take_off
from rigdesign.case.rules.gathered import broken_rules
from rigdesign.case.source import case_file, merge, read_tree

# Parts that are written once: a gearbox like another one, keys that all bearings of a gearbox have.
#
#     [gearboxes.slave]
#     like = "test"                       # everything of it but title and role
#     gears.pinion.face_width = "40 mm"   # except for this
#     remove = ["housing"]                # and that
#
#     [gearboxes.test]
#     all_bearings = { diameter = "30 mm" }
#     bearings.pinion_rear.width = "20 mm"    # except for this one
#
# Shafts of the copy are called after it: ``test_pinion`` becomes ``slave_pinion``, any other name ``slave_<name>``.
# Each shaft of a gear that has no bearings gets one at the front and one at the rear, called after the gear; a gear
# that states no shaft sits on ``<gearbox>_<gear>``.

OWN = ("title", "role", "like", "remove")
"""Keys of a gearbox that a copy does not take over."""
ALL_BEARINGS = "all_bearings"


@dataclass(frozen=True)
class EqualParts:
    """Where parts of a tree were written.

    like : gearbox -> the gearbox it is a copy of
    own : gearbox -> what it states besides
    bearings : (gearbox, bearing) -> keys that it states itself, for gearboxes with ``all_bearings``
    """

    like: Mapping[str, str]
    own: Mapping[str, Mapping[str, Any]]
    bearings: Mapping[tuple[str, str], frozenset[str]]

    def as_written(self, faults: Sequence[Fault]) -> list[Fault]:
        """Faults where the file has them: of a value that stands for several parts once, at its own place."""
        moved = list(dict.fromkeys(map(self._of_bearing, faults)))
        return [fault for fault in moved if not self._repeats(fault, moved)]

    def copies_of(self, path: str) -> tuple[str, ...]:
        """The same key of the gearboxes that are like the one of ``path`` and do not state it themselves."""
        group, _, rest = path.partition(".")
        original, _, key = rest.partition(".")
        if group != "gearboxes" or not key or key.split(".")[0] in OWN:
            return ()
        copies: list[str] = []
        for name, like in self.like.items():
            if like == original and not RawTree(dict(self.own[name])).has(key):
                copies += [f"gearboxes.{name}.{key}", *self.copies_of(f"gearboxes.{name}.{key}")]
        return tuple(copies)

    def _of_bearing(self, fault: Fault) -> Fault:
        keys = fault.path.split(".")
        if len(keys) < 5 or keys[0] != "gearboxes" or keys[2] != "bearings":
            return fault
        own = self.bearings.get((keys[1], keys[3]))
        if own is None or keys[4].split(" ")[0] in own or keys[4] in ("side", "shaft", "position"):
            return fault
        return replace(fault, path=".".join([*keys[:2], ALL_BEARINGS, *keys[4:]]))

    def _repeats(self, fault: Fault, faults: Sequence[Fault]) -> bool:
        """Whether a fault of a copy is one of its original that the copy does not state itself."""
        keys = fault.path.split(".")
        if len(keys) < 3 or keys[0] != "gearboxes" or keys[1] not in self.like:
            return False
        if RawTree(dict(self.own[keys[1]])).has(".".join(keys[2:]).split(" ")[0]):
            return False
        original = replace(fault, path=".".join(["gearboxes", self.like[keys[1]], *keys[2:]]))
        return original in faults


def written_out(tree: Mapping[str, Any], file: str) -> tuple[dict[str, Any], EqualParts]:
    """The tree with every part in its own place, and where it was written. Nothing but such parts is changed.

    Raises
    ------
    CaseError
        A gearbox like one that is not there, or like itself, all of them at once; keys removed that are not there.
    """
    boxes = unmarked(tree.get("gearboxes"))
    if not isinstance(boxes, dict):
        return dict(tree), EqualParts({}, {}, {})
    like = {name: box["like"] for name, box in boxes.items() if isinstance(box, dict) and "like" in box}
    if faults := list(_like_faults(boxes, like)):
        raise CaseError(faults, file)
    full: dict[str, Any] = {}
    for name in boxes:
        try:
            full[name] = _copied(name, boxes, like)
        except CaseError as error:
            raise CaseError(error.faults, file) from None
    bearings: dict[tuple[str, str], frozenset[str]] = {}
    for name, box in full.items():
        if isinstance(box, dict):
            _seat_gears(name, box)
            bearings |= {(name, bearing): own for bearing, own in _give_bearings(box).items()}
    own = {name: boxes[name] for name in like}
    return {**tree, "gearboxes": full}, EqualParts(like, own, bearings)


def _like_faults(boxes: Mapping[str, Any], like: Mapping[str, Any]) -> Iterator[Fault]:
    for name, original in like.items():
        path, others = f"gearboxes.{name}.like", [box for box in boxes if box != name]
        if not isinstance(original, str):
            yield Fault(
                path, written(original), "is no name", f"write the gearbox it equals: {', '.join(others)}"
            )
            continue
        trail = [name]
        while isinstance(trail[-1], str) and trail[-1] in like and trail.count(trail[-1]) == 1:
            trail.append(like[trail[-1]])
        if original not in boxes:
            yield unknown(path, original, others, "gearbox")
        elif trail[-1] == name:
            shown = " is like ".join(trail)
            yield Fault(path, written(original), f"is like itself: {shown}", "write one of them out")


def _copied(name: str, boxes: Mapping[str, Any], like: Mapping[str, str]) -> Any:
    """A gearbox with what it takes over; marks and values of its own come first."""
    if name not in like:
        return copy.deepcopy(boxes[name])
    original = _copied(like[name], boxes, like)
    if not isinstance(original, dict):
        return original
    taken = {key: value for key, value in original.items() if key not in OWN}
    own = {key: value for key, value in boxes[name].items() if key != "like"}
    try:
        return merge(_renamed(taken, like[name], name), copy.deepcopy(own))
    except CaseError as error:
        problem, _, remedy = str(error).partition("; ")
        raise CaseError([Fault(f"gearboxes.{name}", "", problem, remedy)]) from None


def _renamed(box: dict[str, Any], old: str, new: str) -> dict[str, Any]:
    """A copied gearbox with its shafts called after it."""

    def named(shaft: str) -> str:
        return f"{new}_{shaft.removeprefix(f'{old}_')}"

    renamed = dict(box)
    for kind in ("gears", "bearings", "seals"):
        parts = renamed.get(kind)
        for part in parts.values() if isinstance(parts, dict) else ():
            if isinstance(part, dict) and isinstance(unmarked(part.get("shaft")), str):
                part["shaft"] = named(unmarked(part["shaft"]))
    housing = renamed.get("housing")
    if isinstance(housing, dict) and isinstance(housing.get("shafts"), dict):
        housing["shafts"] = {named(shaft): value for shaft, value in housing["shafts"].items()}
    return renamed


def _seat_gears(name: str, box: dict[str, Any]) -> None:
    """Gives every gear without a shaft one of its own, in place."""
    gears = box.get("gears")
    for gear, part in gears.items() if isinstance(gears, dict) else ():
        if isinstance(part, dict) and not is_marked(part):
            part.setdefault("shaft", follows(f"{name}_{gear}", "named after gearbox and gear").as_marked())


def _give_bearings(box: dict[str, Any]) -> dict[str, frozenset[str]]:
    """Lays ``all_bearings`` under every bearing, in place; the keys that each states itself."""
    shared = box.pop(ALL_BEARINGS, None)
    if shared is None:
        return {}
    stated = box.setdefault("bearings", {})
    if not isinstance(shared, dict) or not isinstance(stated, dict):
        box[ALL_BEARINGS] = shared
        return {}
    own = {name: frozenset(bearing) for name, bearing in stated.items() if isinstance(bearing, dict)}
    seated = {_seat_of(stated[name]) for name in own}
    gears = box.get("gears")
    for gear, part in gears.items() if isinstance(gears, dict) else ():
        shaft = unmarked(part.get("shaft")) if isinstance(part, dict) else None
        for side in ("front", "rear") if isinstance(shaft, str) else ():
            bearing = stated.setdefault(f"{gear}_{side}", {})
            if (shaft, side) not in seated and isinstance(bearing, dict):
                seated.add((shaft, side))
                stated[f"{gear}_{side}"] = {**_seat(str(shaft), side), **bearing}
            elif not bearing:
                del stated[f"{gear}_{side}"]
    own = {name: own.get(name, frozenset()) for name in stated if isinstance(stated[name], dict)}
    for name in own:
        stated[name] = {**copy.deepcopy(shared), **stated[name]}
    return own


def _seat_of(bearing: Mapping[str, Any]) -> tuple[Any, Any]:
    return unmarked(bearing.get("shaft")), unmarked(bearing.get("side"))


def _seat(shaft: str, side: str) -> dict[str, Any]:
    reason = "every shaft has a bearing at both ends"
    return {"shaft": follows(shaft, reason).as_marked(), "side": follows(side, reason).as_marked()}


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
    faults += [
        fault for mark in marks if mark.range is not None for fault in _range_faults(mark, mark.range, plain)
    ]
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


def _range_faults(mark: Mark, limits: RangeEnds, plain: Mapping[str, Any]) -> list[Fault]:
    """A range holds values of the same kind, in order, and contains the value."""
    slot = slot_at(Case, plain, mark.path.split("."))
    if slot is None:
        return []
    shown = f"[{written(limits[0])}, {written(limits[1])}]"
    where = f"{mark.path} (range)"
    try:
        kind = slot.quantity.kind if slot.quantity is not None else units.kind_of(mark.value)
        low, high, value = (_number(item, kind) for item in (*limits, mark.value))
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

"""Parts that are written once: a gearbox like another one, keys that all bearings of a gearbox have.

    [gearboxes.slave]
    like = "test"                       # everything of it but title and role
    gears.pinion.face_width = "40 mm"   # except for this
    remove = ["housing"]                # and that

    [gearboxes.test]
    all_bearings = { diameter = "30 mm" }
    bearings.pinion_rear.width = "20 mm"    # except for this one

Shafts of the copy are called after it: ``test_pinion`` becomes ``slave_pinion``, any other name ``slave_<name>``. Each
shaft of a gear that has no bearings gets one at the front and one at the rear, called after the gear; a gear that
states no shaft sits on ``<gearbox>_<gear>``.
"""

import copy
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.defaults.raw_tree import RawTree, unmarked
from rigdesign.case.defaults.rule import follows
from rigdesign.case.faults import unknown, written
from rigdesign.case.provenance import is_marked
from rigdesign.case.source import merge

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

"""Fills what a case leaves out, topic by topic: later topics build on what earlier ones have filled in."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

from rigdesign.base.errors import Fault
from rigdesign.case.defaults import drivetrains, gearboxes, housings, runs
from rigdesign.case.defaults.rule import BY_THE_TOOL, DefaultRule, RawTree, fill
from rigdesign.case.defaults.runs import fill_limits
from rigdesign.case.model import Case
from rigdesign.case.paths import Slot, path_pattern, slot_of
from rigdesign.case.provenance import Mark


def rules() -> tuple[DefaultRule, ...]:
    """Every rule in the order in which it is asked.

    Measures of a housing come before the places on its shafts, these before the bores of the gears and the shafts of
    the housing, and all of them before the run.
    """
    housing, parts = list(housings.book.rules), list(gearboxes.book.rules)
    late = [rule for rule in housing if ".housing.shafts" in rule.path or rule.path.endswith(".boundary")]
    seats = [rule for rule in parts if rule.path.endswith(("bore_diameter", "oil.volume"))]
    walls = [rule for rule in housing if rule not in late]
    first = [rule for rule in parts if rule not in seats]
    return (*first, *walls, *drivetrains.book.rules, *seats, *late, *runs.book.rules)


def filled_as_a_whole(path: str) -> bool:
    """Whether a rule fills in the table or list at a path with all that is in it, rather than key by key."""
    if path == "limits" or path_pattern("gearboxes.*.housing.boundary.*").fullmatch(path):
        return True
    return any(not rule.completes and path_pattern(rule.path).fullmatch(path) for rule in rules())


def with_defaults(tree: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of the tree of a case with every key filled in that it leaves out and a rule knows."""
    filled = RawTree(copy.deepcopy(dict(tree)))
    for rule in rules():
        fill(filled, rule)
    fill_limits(filled)
    return filled.root


# Faults that follow from others: of values that the tool itself filled in, or could not.

NOT_WORKED_OUT = "left out, and the rest of the case does not say what its default is"


def causes_first(faults: Sequence[Fault], marks: Sequence[Mark], missing: str) -> list[Fault]:
    """Faults of what the case states, then keys without a default; defaults that are themselves wrong come last.

    Parameters
    ----------
    faults : of a case with its defaults
    marks : of all its values, those filled in by the tool among them
    missing : problem of a key that is missing

    Returns
    -------
    faults : a wrong default is left out where there are other faults: it follows from them
    """
    filled = {mark.path for mark in marks if (mark.assumed or mark.source or "").startswith(BY_THE_TOOL)}
    patterns = [path_pattern(rule.path) for rule in rules()]
    stated: list[Fault] = []
    unknown: list[Fault] = []
    wrong_defaults: list[Fault] = []
    for fault in faults:
        path = fault.path.partition(" ")[0]
        if path in filled:
            wrong_defaults.append(fault)
        elif fault.problem == missing and any(pattern.fullmatch(path) for pattern in patterns):
            unknown.append(fault)
        else:
            stated.append(fault)
    if stated and unknown:
        named = ", ".join(fault.path for fault in unknown)
        unknown = [
            Fault("", "", f"{NOT_WORKED_OUT}: {named}", "correct the faults above first, or add these keys")
        ]
    else:
        unknown = [replace(fault, problem=NOT_WORKED_OUT) for fault in unknown]
    return [*stated, *unknown] or wrong_defaults


# Which keys a case may leave out because the tool knows a default, and the keys that write several parts at once.

WRITTEN_ONCE = {
    "like": (
        "string",
        "Another gearbox that this one equals: everything of it but title and role, except for what stands here; "
        "remove lists keys it lacks. Shafts are renamed: test_pinion becomes slave_pinion.",
    ),
    "all_bearings": (
        "object",
        "Keys that every bearing of the gearbox has unless it states its own; a shaft of a gear without bearings gets "
        "one at the front and one at the rear, GEAR_front and GEAR_rear.",
    ),
}
"""Keys of a gearbox that are written out before the case is validated (`rigdesign.case.loader`): type, text."""

SEATED = "gearboxes.*.gears.*.shaft"
"""Key that is filled in where equal parts are written out: a gear sits on a shaft of its own."""


@cache
def has_default(path: str) -> bool:
    """Whether a required key may be left out; ``path`` with ``*`` for names. A table may if all it requires may."""
    if path == SEATED or path in {rule.path for rule in rules()}:
        return True
    slot = _slot(path)
    table = None if slot is None else slot.table
    if table is None or table[1] or table[2]:
        return False
    needed = [key for key, field in table[0].model_fields.items() if field.is_required()]
    return bool(needed) and all(has_default(f"{path}.{key}") for key in needed)


def _slot(path: str) -> Slot | None:
    slot = slot_of(Case)
    for key in path.split("."):
        table = slot.table
        if table is None:
            return None
        if key == "*":
            slot = slot_of(table[0])
            continue
        field = table[0].model_fields.get(key)
        if field is None:
            return None
        slot = slot_of(field.annotation, field.metadata)
    return slot


def relaxed(schema: dict[str, Any]) -> None:
    """Take keys with a default off the required ones of a JSON Schema and add those of `WRITTEN_ONCE`, in place."""
    definitions = schema.get("$defs", {})
    seen: set[tuple[int, str]] = set()

    def visit(node: Any, path: str) -> None:
        if not isinstance(node, Mapping):
            return
        if "$ref" in node:
            visit(definitions[node["$ref"].rpartition("/")[2]], path)
        if (id(node), path) in seen:
            return
        seen.add((id(node), path))
        for choice in (*node.get("anyOf", ()), *node.get("oneOf", ())):
            visit(choice, path)
        if isinstance(node.get("required"), list) and isinstance(node, dict):
            node["required"] = [key for key in node["required"] if not has_default(_join(path, key))]
        for key, inner in node.get("properties", {}).items():
            visit(inner, _join(path, key))
        for inner in (node.get("additionalProperties"), node.get("items")):
            visit(inner, _join(path, "*"))

    visit(schema, "")
    gearbox = definitions["Gearbox"]["properties"]
    for key, (kind, text) in WRITTEN_ONCE.items():
        gearbox[key] = {"type": kind, "description": text}
    gearbox["remove"] = {
        "type": "array",
        "items": {"type": "string"},
        "description": "Keys taken over that it lacks.",
    }
    definitions["Gearbox"]["required"] = []


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key

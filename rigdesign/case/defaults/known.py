"""Which keys a case may leave out because the tool knows a default, and the keys that write several parts at once."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from rigdesign.case.defaults.fill import rules
from rigdesign.case.model import Case
from rigdesign.case.paths import Slot, slot_of

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

"""Validation errors in the user's words: path, value, what is accepted, what to do."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from rigdesign.base.errors import WIDEST, Fault
from rigdesign.base.units import describe
from rigdesign.case.fields import FAULT, kind_key, kind_of, variant_of
from rigdesign.case.paths import Slot, nearest, slot_at
from rigdesign.case.provenance import KEYS, MARKS, item_name

IMPOSSIBLE = frozenset(("literal_error", "bool_type", "int_type", "int_from_float", "float_type"))
"""Kinds of error of a value that its place holds in no case."""
MISSING = "a required key is missing"


def faults_of(error: ValidationError, model: type[BaseModel], tree: Mapping[str, Any]) -> list[Fault]:
    """Every error of a validation as a fault, in the order of the model."""
    return [_fault(entry, model, tree) for entry in error.errors(include_url=False)]


def written(value: object, width: int = 70) -> str:
    """A value as the file shows it, cut to one line."""
    text = f'"{value}"' if isinstance(value, str) else str(value)
    if isinstance(value, bool):
        text = "true" if value else "false"
    if isinstance(value, dict | list | tuple):
        text = f"{describe(value)} of {len(value)}"
    return text if len(text) <= width else text[: width - 1] + "…"


def unknown(path: str, name: str, known: Collection[str], what: str) -> Fault:
    """A reference to a part that is not there."""
    meant = nearest(name, known, 1)
    hint = f'did you mean "{meant[0]}"? ' if meant else ""
    remedy = f"{hint}known: {', '.join(known) or 'none'}"
    return Fault(path, written(name), f"no such {what}", remedy, impossible=True)


def _fault(entry: Any, model: type[BaseModel], tree: Mapping[str, Any]) -> Fault:
    keys = _keys(entry["loc"], model, tree)
    path = ".".join(keys)
    kind, given, context = entry["type"], entry["input"], entry.get("ctx", {})
    if kind == "missing":
        slot = slot_at(model, tree, keys)
        return Fault(path, "", MISSING, _addition(path, slot))
    if kind == "extra_forbidden":
        return Fault(path, written(given), "unknown key", _known_here(keys, model, tree))
    if kind == FAULT:
        if isinstance(given, dict) and "value" in given:
            return _misspelt_mark(path, given)
        shown = "" if isinstance(given, dict | BaseModel) else written(given)
        return Fault(path, shown, context["problem"], context["remedy"], impossible=context["impossible"])
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        place = slot_at(model, tree, keys)
        key = "" if place is None else kind_key(list(place.models()))
        return _unknown_kind(path, given, context, key)
    if isinstance(given, dict) and "value" in given and set(given) - KEYS:
        return _misspelt_mark(path, given)
    slot = slot_at(model, tree, keys)
    words, accepted = _in_words(kind, given, entry["msg"]), _accepted(kind, given, context, slot)
    return Fault(path, written(given), words, accepted, impossible=kind in IMPOSSIBLE)


def _addition(path: str, slot: Slot | None) -> str:
    """How a missing key is written: a value, or the head of a table with the keys it needs."""
    if slot is None or (table := slot.table) is None:
        return f"add it: {slot.example if slot else 'a value'}"
    model, several, named = table
    head = f"[[{path}]]" if several else f"[{path}.NAME]" if named else f"[{path}]"
    needed = [name for name, field in model.model_fields.items() if field.is_required()]
    return f"add it: {head} with {', '.join(needed) or 'its keys'}"


def _in_words(kind: str, given: object, message: str) -> str:
    if kind.endswith("_type"):
        return f"{describe(given)} is not accepted here"
    if kind == "literal_error":
        return "not one of the choices"
    return message.replace("Input should be", "is not").replace("Value should have", "does not have")


def _accepted(kind: str, given: object, context: Mapping[str, Any], slot: Slot | None) -> str:
    if kind == "literal_error":
        choices = str(context.get("expected", "")).replace("'", '"')
        meant = nearest(str(given), choices.replace('"', "").replace(" or ", ", ").split(", "), 1)
        return (f'did you mean "{meant[0]}"? ' if meant else "") + f"write {choices}"
    limits = {
        "gt": "above",
        "ge": "at least",
        "lt": "below",
        "le": "at most",
        "min_length": "length at least",
        "max_length": "length at most",
    }
    bounds = " and ".join(f"{words} {context[key]}" for key, words in limits.items() if key in context)
    example = slot.example if slot is not None else "a value"
    if bounds:
        return f"write {example}, {bounds}"
    if "pattern" in context:
        return "write lower-case letters, digits and underscores, starting with a letter"
    return f"write {example}"


def _known_here(keys: Sequence[str], model: type[BaseModel], tree: Mapping[str, Any]) -> str:
    slot = slot_at(model, tree, keys[:-1])
    models = list(slot.models()) if slot else []
    owner = next((model for model in models if keys[-1] in model.model_fields), None)
    if owner is not None:
        return f"a key of {variant_of(owner, models)}: state that as well, or remove it"
    names = list(dict.fromkeys(name for table in models for name in table.model_fields))
    meant = nearest(keys[-1], names)
    if meant:
        return "did you mean " + " or ".join(f"'{name}'" for name in meant) + "?"
    return "remove it; known here: " + ", ".join(names)


def _misspelt_mark(path: str, given: Mapping[str, Any]) -> Fault:
    unknown = [key for key in given if key not in KEYS]
    meant = [name for key in unknown for name in nearest(key, MARKS, 1)]
    hint = f"did you mean '{meant[0]}'? " if meant else ""
    names = ", ".join(f"'{key}'" for key in unknown) or "none"
    return Fault(
        path, written(given["value"]), f"unknown mark {names}", f"{hint}marks are {', '.join(MARKS)}"
    )


def _unknown_kind(path: str, given: object, context: Mapping[str, Any], key: str) -> Fault:
    choices = str(context.get("expected_tags", "")).replace("'", '"')
    tag = str(context.get("tag", ""))[:WIDEST]
    if not isinstance(given, dict):
        return Fault(
            path, written(given), f"{describe(given)} is not accepted here", f'write a table with {key} = "…"'
        )
    if not tag:
        return Fault(f"{path}.{key}", "", MISSING, "add it: a law of heat transfer, see the schema")
    meant = nearest(tag, choices.replace('"', "").split(", "), 1)
    hint = f'did you mean "{meant[0]}"? ' if meant else ""
    return Fault(
        f"{path}.{key}",
        written(given.get(key, tag)),
        "not one of the choices",
        f"{hint}write {choices}",
        impossible=True,
    )


def _keys(location: Sequence[str | int], model: type[BaseModel], tree: Mapping[str, Any]) -> list[str]:
    """Keys of a path from a pydantic location: list items by name, union tags and key marks left out."""
    keys: list[str] = []
    node: Any = tree
    for part in location:
        if part == "[key]":
            continue
        if isinstance(part, int):
            item = node[part] if isinstance(node, list | tuple) and part < len(node) else None
            keys.append(item_name(item, part))
            node = item
        elif isinstance(node, Mapping) and part not in node and _is_kind(part, slot_at(model, tree, keys)):
            continue
        else:
            keys.append(part)
            node = node.get(part) if isinstance(node, Mapping) else None
    return keys


def _is_kind(part: str, place: Slot | None) -> bool:
    """Whether a part of a location names the kind of a table, which is no key."""
    models = [] if place is None else list(place.models())
    key = kind_key(models) if len(models) > 1 else ""
    return bool(key) and part in {kind_of(model, key) for model in models}

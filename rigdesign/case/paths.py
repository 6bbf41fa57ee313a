"""Dotted paths into a case: what a path may hold, and which path was meant.

``gearboxes.test.oil.inlet_temperature``; an item of a list goes by its ``name`` (``schedule.stages.dwell``)
or by its number (``drivetrain.shafts.test_pinion.sections.2.length``).
"""

import difflib
import re
import types
import typing
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

from pydantic import BaseModel

from rigdesign.case.fields import Effect, Quantity, Usual, of_kind
from rigdesign.case.provenance import item_name


@dataclass(frozen=True)
class Slot:
    """What a place of the case may hold: one or more types, each with its metadata."""

    choices: tuple[tuple[Any, tuple[Any, ...]], ...]

    @property
    def quantity(self) -> Quantity | None:
        """The quantity, if the place holds one (or a list of them)."""
        found = (item for _, metadata in self.choices for item in metadata if isinstance(item, Quantity))
        return next(found, None)

    @property
    def usual(self) -> tuple[Usual, ...]:
        """Ranges it usually lies in."""
        return tuple(item for _, metadata in self.choices for item in metadata if isinstance(item, Usual))

    @property
    def plain_types(self) -> tuple[type, ...]:
        """Bare number, integer, text or true/false types of the place."""
        return tuple(kind for kind, _ in self.choices if kind in (float, int, str, bool))

    @property
    def example(self) -> str:
        """What a user may write here."""
        if self.quantity is not None:
            return f'"{self.quantity.shown_example}"'
        for kind, _ in self.choices:
            if typing.get_origin(kind) is typing.Literal:
                return " or ".join(f'"{value}"' for value in typing.get_args(kind))
        words = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}
        return next((words[kind] for kind in self.plain_types), "a table")

    @property
    def table(self) -> tuple[type[BaseModel], bool, bool] | None:
        """Table of the place, whether it is one of a list, and whether it goes by a name; None for a value."""
        for kind, _ in self.choices:
            origin, arguments = typing.get_origin(kind), typing.get_args(kind)
            several, named = origin is tuple, origin is Mapping
            inner = slot_of(arguments[1 if named else 0]) if several or named else self
            for model in inner.models():
                return model, several, named
        return None

    def models(self) -> Iterator[type[BaseModel]]:
        """Tables the place may hold."""
        for kind, _ in self.choices:
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                yield kind


def slot_of(annotation: Any, metadata: Sequence[Any] = ()) -> Slot:
    """Unfold unions, optionals and annotated types."""
    return Slot(tuple(_unfold(annotation, tuple(metadata))))


@cache
def slot_of_field(model: type[BaseModel], key: str) -> Slot | None:
    """What a key of a table may hold; None where there is no such key."""
    field = model.model_fields.get(key)
    return None if field is None else slot_of(field.annotation, field.metadata)


def slot_at(model: type[BaseModel], tree: Mapping[str, Any], keys: Sequence[str]) -> Slot | None:
    """What the case may hold at ``keys``; None where there is no such place.

    tree : plain tree (no marks), which says how the items of lists and tables of named parts are called
    """
    slot, node = slot_of(model), tree
    for key in keys:
        found = _step(slot, node, key)
        if found is None:
            return None
        slot, node = found
    return slot


@cache
def effects_at(model: type[BaseModel], path: str) -> tuple[Effect, ...]:
    """Effects that the keys of a path state, from the case down; of several kinds of a table that of any."""
    slots, effects = [slot_of(model)], list[Effect]()
    for key in path.split("."):
        slots = [below for slot in slots for below in _below(slot, key)]
        stated = (item for slot in slots for _, metadata in slot.choices for item in metadata)
        effects += [item for item in dict.fromkeys(stated) if isinstance(item, Effect)]
    return tuple(effects)


def _below(slot: Slot, key: str) -> Iterator[Slot]:
    """What may stand one key further down, whatever names the case has."""
    for kind, _ in slot.choices:
        if typing.get_origin(kind) in (tuple, Mapping):
            yield slot_of(typing.get_args(kind)[typing.get_origin(kind) is Mapping])
    fields = (slot_of_field(model, key) for model in slot.models())
    yield from (field for field in fields if field is not None)


def known_paths(model: type[BaseModel], tree: Mapping[str, Any]) -> list[str]:
    """Every path that holds or may hold a value in this case."""
    paths: list[str] = []

    def visit(slot: Slot, node: Any, path: str) -> None:
        for key in _keys(slot, node):
            found = _step(slot, node, key)
            if found is not None:
                here = f"{path}.{key}" if path else key
                paths.append(here)
                visit(*found, here)

    visit(slot_of(model), tree, "")
    return paths


def path_pattern(path: str) -> re.Pattern[str]:
    """What the whole of a path has to fit, where ``*`` stands for any name."""
    return re.compile(re.escape(path).replace(r"\*", r"[^.]+"))


def places(model: type[BaseModel], path: str, tree: Mapping[str, Any]) -> dict[str, Slot]:
    """The place a path names, or all that fit it where ``*`` stands for any name; empty where there is none.

    tree : plain tree (no marks)
    """
    names = [path]
    if "*" in path:
        pattern = path_pattern(path)
        names = [known for known in known_paths(model, tree) if pattern.fullmatch(known)]
    slots = {name: slot_at(model, tree, name.split(".")) for name in names}
    return {name: slot for name, slot in slots.items() if slot is not None}


def nearest(wanted: str, known: Iterable[str], count: int = 3) -> list[str]:
    """The names most like ``wanted``, best first."""
    return difflib.get_close_matches(wanted, list(known), n=count, cutoff=0.6)


def nearest_paths(wanted: str, known: Iterable[str], count: int = 3) -> list[str]:
    """The paths most like ``wanted``: those that end alike, then those spelled alike."""
    paths = list(known)
    same_end = [path for path in paths if path.rpartition(".")[2] == wanted.rpartition(".")[2]]
    ranked = difflib.get_close_matches(wanted, same_end, n=count, cutoff=0.0)
    ranked += [path for path in nearest(wanted, paths, count) if path not in ranked]
    return ranked[:count]


def _unfold(annotation: Any, metadata: tuple[Any, ...]) -> Iterator[tuple[Any, tuple[Any, ...]]]:
    origin = typing.get_origin(annotation)
    if origin is Annotated:
        inner, *more = typing.get_args(annotation)
        yield from _unfold(inner, (*metadata, *more))
    elif origin in (typing.Union, types.UnionType):
        for choice in typing.get_args(annotation):
            yield from _unfold(choice, metadata)
    elif annotation is not type(None):
        yield annotation, metadata


def _step(slot: Slot, node: Any, key: str) -> tuple[Slot, Any] | None:
    """Slot and node one key further down."""
    for kind, _ in slot.choices:
        origin, arguments = typing.get_origin(kind), typing.get_args(kind)
        if origin is tuple and isinstance(node, list | tuple):
            for index, item in enumerate(node):
                if key in (item_name(item, index), str(index)):
                    return slot_of(arguments[0 if arguments[-1] is Ellipsis else index]), item
        elif origin is Mapping and isinstance(node, Mapping) and key in node:
            return slot_of(arguments[1]), node[key]
    for model in _models_for(slot, node):
        found = slot_of_field(model, key)
        if found is not None:
            return found, node.get(key) if isinstance(node, Mapping) else None
    return None


def _keys(slot: Slot, node: Any) -> list[str]:
    """Names one level down."""
    names: dict[str, None] = {}
    for kind, _ in slot.choices:
        origin = typing.get_origin(kind)
        if origin is tuple and isinstance(node, list | tuple):
            names.update(dict.fromkeys(item_name(item, i) for i, item in enumerate(node)))
        elif origin is Mapping and isinstance(node, Mapping):
            names.update(dict.fromkeys(node))
    for model in _models_for(slot, node):
        names.update(dict.fromkeys(model.model_fields))
    return list(names)


def _models_for(slot: Slot, node: Any) -> list[type[BaseModel]]:
    """The table the place holds: where several are possible, the kind the node says it is."""
    models = list(slot.models())
    return of_kind(models, node) if isinstance(node, Mapping) else models

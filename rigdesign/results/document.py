"""Records as JSON and back, and the JSON Schema of it: all three follow from the classes.

A record is an object; the key of a number carries its unit (`rigdesign.results.quantity`).
"""

import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from rigdesign.results.quantity import Shown, shown

Json = Any
"""What `json` reads and writes: objects, lists, texts, numbers, truth values, null."""


def as_shown(value: Any) -> Json:
    """Records as dicts by key, numbers in their units; arrays and numpy scalars as they are."""
    if is_dataclass(value) and not isinstance(value, type):
        return {item.key: as_shown(item.of(value)) for item in shown(type(value)).values()}
    if isinstance(value, Mapping):
        return {str(key): as_shown(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [as_shown(item) for item in value]
    return value


def record_of(kind: Any, value: Json, path: str = "") -> Any:
    """What a value of a document is as a certain type: the other way round of `as_shown`.

    Raises
    ------
    TypeError
        It is not of that type; names the key.
    KeyError
        A key is missing.
    """
    origin, arguments = get_origin(kind) or kind, get_args(kind)
    if origin is Annotated:
        return record_of(arguments[0], value, path)
    if origin in (Union, types.UnionType):
        return _one_of(arguments, value, path)
    if origin is Literal:
        return _required(value, value in arguments, path, " or ".join(map(str, arguments)))
    if is_dataclass(kind):
        return _record(kind, _required(value, isinstance(value, dict), path, "an object"), path)
    for base, read in _READ:
        if isinstance(origin, type) and issubclass(origin, base):
            return read(origin, arguments, value, path)
    return value


def _one_of(kinds: tuple[Any, ...], value: Json, path: str) -> Any:
    """Of several types the first that fits; null only where it is one of them."""
    if value is None and type(None) in kinds:
        return None
    others = [kind for kind in kinds if kind is not type(None)]
    for kind in others[:-1]:
        try:
            return record_of(kind, value, path)
        except (TypeError, KeyError):
            continue
    return record_of(others[-1], value, path)


def _record(kind: Any, value: Mapping[str, Json], path: str) -> Any:
    given = {}
    defaults = {
        item.name: item.default is not MISSING or item.default_factory is not MISSING for item in fields(kind)
    }
    for name, item in shown(kind).items():
        if item.derived or (item.key not in value and defaults[name]):
            continue
        given[name] = item.stored(record_of(item.kind, value[item.key], f"{path}.{item.key}"))
    return kind(**given)


def _required(value: Any, fits: bool, path: str, wanted: str) -> Any:
    if not fits:
        raise TypeError(f"{path.lstrip('.')}: {str(value)[:60]!r} where {wanted} belongs")
    return value


def _truth(origin: Any, arguments: tuple[Any, ...], value: Json, path: str) -> Any:
    return _required(value, isinstance(value, bool), path, "true or false")


def _number(origin: Any, arguments: tuple[Any, ...], value: Json, path: str) -> Any:
    fits = isinstance(value, int if origin is int else int | float) and not isinstance(value, bool)
    return origin(_required(value, fits, path, "a number"))


def _text(origin: Any, arguments: tuple[Any, ...], value: Json, path: str) -> Any:
    return _required(value, isinstance(value, str), path, "a text")


def _mapping(origin: Any, arguments: tuple[Any, ...], value: Json, path: str) -> Any:
    _required(value, isinstance(value, dict), path, "an object")
    item = arguments[1] if arguments else Any
    return {key: record_of(item, each, f"{path}.{key}") for key, each in value.items()}


def _list(origin: Any, arguments: tuple[Any, ...], value: Json, path: str) -> Any:
    _required(value, isinstance(value, list), path, "a list")
    arguments = arguments or _arguments(origin)
    if origin is tuple and arguments[-1:] != (...,):
        kinds = arguments
        _required(value, len(value) == len(kinds), path, f"a list of {len(kinds)}")
    else:
        kinds = ((arguments or (Any,))[0],) * len(value)
    items = (
        record_of(kind, each, f"{path}[{i}]") for i, (kind, each) in enumerate(zip(kinds, value, strict=True))
    )
    return tuple(items) if origin is tuple else _made(origin)(items)


def _arguments(kind: type) -> tuple[Any, ...]:
    """Of the list that a class is one of: ``Checks(list[Check])``."""
    return next((get_args(base) for base in getattr(kind, "__orig_bases__", ())), ())


def _made(origin: Any) -> Callable[..., Any]:
    return origin if issubclass(origin, list) else list


_READ: tuple[tuple[Any, Callable[[Any, tuple[Any, ...], Json, str], Any]], ...] = (
    (bool, _truth), (int, _number), (float, _number), (str, _text), (Mapping, _mapping), (Sequence, _list),
)  # fmt: skip
"""Types of values that are no records; a truth value is an int in Python."""


# JSON Schema.

DRAFT = "https://json-schema.org/draft/2020-12/schema"
_NAMES = {bool: "boolean", int: "integer", float: "number", str: "string", type(None): "null"}


def schema_of(kind: Any, instead: Mapping[str, Json], lists: Json) -> Json:
    """JSON Schema of a record and of everything in it.

    instead : schema of keys of the record itself that are written in another way; lists : of what may stand for a list
    """
    schemas = _Schemas(lists)
    whole = schemas.of_record(kind, instead)
    return {
        "$schema": DRAFT,
        **whole,
        "$defs": {each.__name__: schemas.records[each] for each in schemas.ordered},
    }


class _Schemas:
    """Schemas of all classes in a record."""

    def __init__(self, lists: Json) -> None:
        self.lists = lists
        self.records: dict[Any, Json] = {}

    @property
    def ordered(self) -> list[Any]:
        """Classes by name."""
        return sorted(self.records, key=lambda kind: str(kind.__name__))

    def of_record(self, kind: Any, instead: Mapping[str, Json]) -> Json:
        items = shown(kind).values()
        properties = {item.key: instead.get(item.key) or self._property(item) for item in items}
        return {
            "type": "object",
            "description": " ".join((kind.__doc__ or "").split("\n\n")[0].split()),
            "properties": properties,
            "required": list(properties),
            "additionalProperties": False,
        }

    def _property(self, item: Shown) -> Json:
        schema = self.of(item.kind)
        return schema if item.quantity.unit == "-" else {**schema, "unit": item.quantity.unit}

    def of(self, kind: Any) -> Json:
        """Of a type."""
        origin, arguments = get_origin(kind) or kind, get_args(kind)
        if origin is Annotated:
            return self.of(arguments[0])
        if origin in (Union, types.UnionType):
            return {"anyOf": [self.of(each) for each in arguments]}
        if origin is Literal:
            return {"enum": list(arguments)}
        if is_dataclass(kind):
            if kind not in self.records:
                self.records[kind] = {}
                self.records[kind] = self.of_record(kind, {})
            return {"$ref": f"#/$defs/{origin.__name__}"}
        if origin in _NAMES:
            return {"type": _NAMES[origin]}
        if isinstance(origin, type) and issubclass(origin, Mapping):
            return {"type": "object", "additionalProperties": self.of(arguments[1]) if arguments else {}}
        if isinstance(origin, type) and issubclass(origin, Sequence):
            items = arguments or _arguments(origin)
            return {"anyOf": [{"type": "array", "items": self.of(items[0]) if items else {}}, self.lists]}
        return {}

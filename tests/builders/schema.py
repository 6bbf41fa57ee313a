"""What a JSON Schema says of a value."""

import re
from collections.abc import Iterator
from typing import Any

from rigdesign.case import json_schema

SCHEMA = json_schema()


def complaints(value: Any, schema: dict[str, Any], path: str = "") -> Iterator[str]:
    """Where a value does not satisfy the part of JSON Schema that the case schema uses."""
    if "$ref" in schema:
        yield from complaints(value, SCHEMA["$defs"][schema["$ref"].rpartition("/")[2]], path)
        return
    for key in ("anyOf", "oneOf"):
        if key in schema:
            found = [list(complaints(value, choice, path)) for choice in schema[key]]
            if all(found):
                yield from min(found, key=len)
            return
    types = {
        "object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float),
        "null": type(None),
    }  # fmt: skip
    if "type" in schema and not isinstance(value, types[schema["type"]]):
        yield f"{path}: {value!r} is no {schema['type']}"
        return
    if "enum" in schema and value not in schema["enum"]:
        yield f"{path}: {value!r} is not among {schema['enum']}"
    if "const" in schema and value != schema["const"]:
        yield f"{path}: {value!r} is not {schema['const']}"
    if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
        yield f"{path}: {value!r} does not match {schema['pattern']}"
    if isinstance(value, dict):
        yield from _object(value, schema, path)
    if isinstance(value, list) and "items" in schema:
        for index, item in enumerate(value):
            yield from complaints(item, schema["items"], f"{path}.{index}")


def _object(value: dict[str, Any], schema: dict[str, Any], path: str) -> Iterator[str]:
    properties, more = schema.get("properties", {}), schema.get("additionalProperties", True)
    for key in schema.get("required", []):
        if key not in value:
            yield f"{path}: {key} is missing"
    for key, item in value.items():
        if key in properties:
            yield from complaints(item, properties[key], f"{path}.{key}")
        elif isinstance(more, dict):
            yield from complaints(item, more, f"{path}.{key}")
        elif not more and "patternProperties" not in schema:
            yield f"{path}: {key} is not known"
        for pattern, inner in schema.get("patternProperties", {}).items():
            if re.search(pattern, key):
                yield from complaints(item, inner, f"{path}.{key}")

"""JSON Schema for editors: it knows the shipped case and refuses what the loader refuses."""

import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rigdesign.case import json_schema

PROTOTYPE = Path(__file__).parents[2] / "cases" / "uhcf_prototype" / "case.toml"
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


def prototype() -> dict[str, Any]:
    return tomllib.loads(PROTOTYPE.read_text(encoding="utf-8"))


def test_shipped_case_satisfies_the_schema() -> None:
    assert list(complaints(prototype(), SCHEMA)) == []


@pytest.mark.parametrize(
    ("keys", "value"),
    [
        (("ambient", "temperature"), 20),
        (("ambient", "temperature"), "20 mm"),
        (("ambient", "temprature"), "20 degC"),
        (("losses", "basis"), "calculated"),
        (("gearboxes", "test", "oil", "flow"), "140 l"),
        (("gearboxes", "test", "oil", "flow"), {"value": "5 l/min", "asumed": "so"}),
        (("gearboxes", "test", "gears", "pinion", "teeth"), "99"),
        (("gearboxes", "test", "housing", "boundary", "housing_air", "law"), "niemann"),
    ],
)
def test_schema_flags_what_the_loader_refuses(keys: tuple[str, ...], value: object) -> None:
    tree = prototype()
    node = tree
    for key in keys[:-1]:
        node = node[key]
    node[keys[-1]] = value
    assert list(complaints(tree, SCHEMA))


def test_schema_describes_quantities_and_allows_variants() -> None:
    oil = SCHEMA["$defs"]["GearOil"]["properties"]["inlet_temperature"]
    assert oil["anyOf"][0]["examples"] == ["140 degC"]
    assert set(oil["anyOf"][1]["properties"]) == {"value", "assumed", "range", "source", "measured"}
    assert SCHEMA["$defs"]["GearOil"]["properties"]["flow"]["description"] == "Flow per mesh."
    assert SCHEMA["properties"]["extends"]["type"] == "string"
    assert json.loads(json.dumps(SCHEMA, allow_nan=False)) == SCHEMA

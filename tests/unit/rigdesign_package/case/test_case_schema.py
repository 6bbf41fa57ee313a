"""JSON Schema for editors: it knows the shipped case and refuses what the loader refuses."""

import json
import tomllib
from typing import Any

import pytest

from tests.builders.paths import CASES
from tests.builders.schema import SCHEMA, complaints

PROTOTYPE = CASES / "uhcf_prototype" / "case.toml"


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
    oil = SCHEMA["$defs"]["JetOil"]["properties"]["inlet_temperature"]
    assert oil["anyOf"][0]["examples"] == ["140 degC"]
    assert set(oil["anyOf"][1]["properties"]) == {
        "value",
        "assumed",
        "range",
        "source",
        "measured",
        "confirmed",
    }
    assert SCHEMA["$defs"]["JetOil"]["properties"]["flow"]["description"] == "Flow per mesh."
    assert SCHEMA["properties"]["extends"]["type"] == "string"
    assert json.loads(json.dumps(SCHEMA, allow_nan=False)) == SCHEMA

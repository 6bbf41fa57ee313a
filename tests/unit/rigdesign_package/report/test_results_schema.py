"""JSON Schema of results.json: published as the classes say it, and kept by what a run writes."""

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest

from rigdesign.report.results_json import results_schema
from rigdesign.report.writing import write_results
from rigdesign.results.quantity import Quantity, Records
from tests.builders.commands import Rigdesign
from tests.builders.paths import CASES
from tests.builders.report import make_result

TYPES = {
    "object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float),
    "null": type(None),
}  # fmt: skip


def faults(schema: dict[str, Any], value: Any, defs: dict[str, Any], path: str = "") -> Iterator[str]:
    """Where a value is not as a schema says, in the words of JSON Schema that ours uses."""
    if "$ref" in schema:
        yield from faults(defs[schema["$ref"].removeprefix("#/$defs/")], value, defs, path)
    if "anyOf" in schema and all(any(faults(each, value, defs, path)) for each in schema["anyOf"]):
        yield f"{path}: none of {len(schema['anyOf'])}: {str(value)[:80]}"
    if "const" in schema and value != schema["const"]:
        yield f"{path}: not {schema['const']}"
    if "enum" in schema and value not in schema["enum"]:
        yield f"{path}: {value} not in {schema['enum']}"
    kind = schema.get("type")
    if kind is not None and (
        not isinstance(value, TYPES[kind]) or (isinstance(value, bool) and kind not in ("boolean",))
    ):
        yield f"{path}: {str(value)[:80]} is no {kind}"
    elif isinstance(value, dict):
        known, others = schema.get("properties", {}), schema.get("additionalProperties", True)
        yield from (f"{path}.{key}: is missing" for key in schema.get("required", []) if key not in value)
        for key, each in value.items():
            if key not in known and others is False:
                yield f"{path}.{key}: no such key"
            rule = known.get(key, others)
            yield from faults(rule if isinstance(rule, dict) else {}, each, defs, f"{path}.{key}")
    elif isinstance(value, list):
        for number, each in enumerate(value):
            yield from faults(schema.get("items", {}), each, defs, f"{path}[{number}]")


def test_what_a_run_writes_is_as_the_schema_says(tmp_path):
    schema = results_schema()
    write_results(make_result(), tmp_path)
    document = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert list(faults(schema, document, schema["$defs"])) == []
    for key, value, said in (
        ("verdict", "good", "not in"),
        ("losses", [{"place": 3}], "none of"),
        ("more", 1, "no such key"),
        ("schema_version", "2", "not 3"),
    ):
        assert said in " ".join(faults(schema, document | {key: value}, schema["$defs"]))


def test_units_stand_in_the_schema_and_in_the_key():
    bearing = results_schema()["$defs"]["RollingBearingRecord"]
    assert bearing["properties"]["speed_rpm"] == {"type": "number", "unit": "rpm"}
    assert "tilting_stiffness_kNm_rad" in bearing["required"]


def test_a_unit_that_is_none_is_refused():
    with pytest.raises(KeyError, match="no unit 'furlong'"):
        Quantity("furlong")


def test_the_published_schema_is_that_of_the_classes(rigdesign: Rigdesign):
    """`rigdesign schema --results > cases/results.schema.json` carries it over."""
    printed = rigdesign("schema", "--results").out
    assert json.loads(printed) == results_schema()
    assert (CASES / "results.schema.json").read_text(encoding="utf-8") == printed
    assert re.search(r'"schema_version": \{\s+"const": "3"', printed)


def test_records_are_a_data_frame_in_their_units():
    frame = Records(make_result().cooler).to_dataframe()
    assert list(frame["flow_l_min"]) == [pytest.approx(26.0)]
    assert {"losses_W", "imbalance_W"} <= set(frame.columns)


def test_a_result_without_its_curves_is_refused_with_the_file_that_is_missing(rigdesign: Rigdesign, tmp_path):
    write_results(make_result(), tmp_path)
    (tmp_path / "curves" / "ramp.csv").unlink()
    ended = rigdesign("report", tmp_path, "--html")
    assert ended.status == 2 and "curves/ramp.csv: No such file" in ended.err
    assert "keep its folder together" in ended.err


def test_numbers_that_stand_in_a_file_of_curves_are_not_repeated(tmp_path):
    write_results(make_result(), tmp_path)
    ramp = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["dynamics"]["ramp"]
    assert ramp["time_s"] == {"file": "curves/ramp.csv", "column": "time [s]"}

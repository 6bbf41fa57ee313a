"""`rigdesign list`: everything built in, as a case may name it."""

import json

import pytest

from dynamics.rotor.rolling_catalogue import catalogue_bearing
from rigdesign.case import load_case
from rigdesign.case.defaults.rule import Given, RawTree
from rigdesign.case.defaults.runs import standard_limits
from rigdesign.explanation.built_in import KINDS, built_in
from rigdesign.explanation.keys import entry_at
from rigdesign.properties.materials import MATERIALS
from rigdesign.properties.oil import OILS
from tests.builders.commands import Rigdesign


@pytest.mark.parametrize("kind", KINDS)
def test_every_row_has_a_name_and_says_where_it_is_from(kind: str, rigdesign: Rigdesign) -> None:
    ended = rigdesign("list", kind, "--json")
    rows = json.loads(ended.out)["rows"]
    assert ended.status == 0 and len({row["name"] for row in rows}) == len(rows) >= 3
    assert all(row["name"] and row["source"] for row in rows)
    printed = "".join(rigdesign("list", kind).out.split())
    assert all("".join(row["name"].split()) in printed for row in rows)


def test_what_is_listed_is_what_a_case_may_name() -> None:
    assert all(catalogue_bearing(row["name"]).designation == row["name"] for row in built_in("bearings").rows)
    assert load_case("fzg").gearboxes["test"].oil.oil in {row["name"] for row in built_in("oils").rows}
    assert {row["name"] for row in built_in("oils").rows} == set(OILS)
    assert {row["name"] for row in built_in("materials").rows} == set(MATERIALS)
    assert {"Water", "Air"} <= {row["name"] for row in built_in("fluids").rows}


def test_a_table_has_units(rigdesign: Rigdesign) -> None:
    shown = rigdesign("list", "bearings", "NU", "406").out
    assert "[mm]" in shown and "[kN]" in shown and "[rpm]" in shown and "SKF" in shown
    assert "NU 208" not in shown


def test_every_limit_of_the_standard_set_is_listed_with_its_default_and_check() -> None:
    rows = {row["name"]: row for row in built_in("limits").rows}
    example = RawTree({"gearboxes": {"a": {"meshes": {"m": {"normal_module": "1 mm"}}}}})
    known = {
        f"limits.{table}.{key}": value
        for table, keys in standard_limits(example).items()
        for key, value in keys.items()
        if isinstance(value, Given)
    }
    assert known and all(rows[path]["default"] == str(value.value) for path, value in known.items())
    assert all(entry_at(path) is not None for path in rows)
    assert rows["limits.flanks.scuffing_safety_minimum"]["checks"] == ["flank.scuffing_safety"]
    assert not rows["limits.bearing.static_safety_minimum"]["filled_in"]


def test_words_that_nothing_has_name_what_is_near(rigdesign: Rigdesign) -> None:
    ended = rigdesign("list", "oils", "FVA 4")
    assert ended.status == 2 and "FVA 3" in ended.err and not ended.out
    assert rigdesign("list", "screws").status == 2

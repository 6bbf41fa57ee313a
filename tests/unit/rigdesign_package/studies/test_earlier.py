"""Pages of another study in the folder of a study: said before they are replaced, and only then."""

from dataclasses import replace
from pathlib import Path

from rigdesign.studies.design import BoundarySearch, DesignPoint, Plan
from rigdesign.studies.grid import Variation
from rigdesign.studies.result import CheckSelection
from rigdesign.studies.run import replaced_pages

INLET = "gearboxes.test.oil.inlet_temperature"


def plan(path: str, *values: str) -> Plan:
    return Plan(
        kind="grid",
        method="",
        variations=[Variation(path, values)],
        points=[DesignPoint({path: value}, {path: value}) for value in values],
        selection=CheckSelection(),
    )


def notes(out: Path, now: Plan, *rows: str, path: str = INLET) -> list[str]:
    (out / "results.csv").write_text(
        "\n".join([f"{path},status,verdict", *(f"{row},done,pass" for row in rows)])
    )
    return list(replaced_pages(out, now))


def test_a_folder_without_a_study_says_nothing(tmp_path: Path) -> None:
    assert list(replaced_pages(tmp_path, plan(INLET, "60 degC"))) == []


def test_the_same_study_and_a_finer_one_say_nothing(tmp_path: Path) -> None:
    assert notes(tmp_path, plan(INLET, "60 degC", "70 degC", "80 degC"), "60 degC", "80 degC") == []


def test_other_points_or_inputs_are_named(tmp_path: Path) -> None:
    [text] = notes(tmp_path, plan(INLET, "60 degC"), "60 degC", "80 degC")
    assert f"a study of {INLET} with 2 points" in text and "another --out" in text
    assert notes(tmp_path, plan("test_plan.time", "2 h"), "60 degC")


def test_a_boundary_search_that_goes_on_says_nothing(tmp_path: Path) -> None:
    """Its points of last time are chosen as it goes."""
    search: BoundarySearch = object()  # type: ignore[assignment]
    again = replace(plan(INLET, "60 degC", "80 degC"), search=search)
    assert notes(tmp_path, again, "60 degC", "70 degC", "80 degC") == []
    assert notes(tmp_path, again, "60 degC", path="test_plan.time")


def test_a_table_that_cannot_be_read_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "results.csv").write_bytes(b"\xff\xfe\x00")
    assert list(replaced_pages(tmp_path, plan(INLET, "60 degC"))) == []

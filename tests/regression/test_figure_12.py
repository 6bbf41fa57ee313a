"""Figure 12 of P2 against the thermal model of P2 as printed: too little to name anything, and still a story.

Slow: the library of the rig takes a minute or two. Run with
`python -m pytest -m slow tests/regression/test_figure_12.py`.
"""

import json

import pytest

from rigdesign.cli.main import app
from tests.builders.paths import CASES
from tests.builders.shared_runs import run_cache

CASE = CASES / "uhcf_main"
PRINTED = 345.23
"""Heat into the oil of the bearings [W]."""
OUR_OIL = 2798.0
"""Heat capacity flow of 90 l/min of the oil of the bearings [W/K], from the heat and rise of a check."""

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def document(tmp_path_factory):
    out = tmp_path_factory.mktemp("diagnosis")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(run_cache()))
        arguments = [
            "diagnose",
            str(CASE / "as_published.toml"),
            str(CASE / "measured" / "figure_12"),
            "--out",
            str(out),
        ]
        assert app(arguments, result_action="return_value") == 0
    assert "Suspected input errors" in (out / "diagnosis.html").read_text(encoding="utf-8")
    assert not (out / "case.patch.json").exists()
    return json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))


def test_one_point_without_repeats_names_nothing(document) -> None:
    assert document["verdict"] == "data_insufficient" and document["strength"] == "indicative"
    assert document["named"] == [] and document["patch"]["case"] is None


def test_the_residual_sits_at_the_bearings(document) -> None:
    first, second = document["located"][:2]
    assert first["channels"] == ["T_bearing_oil"]
    assert first["whitened_rms"] > 2.0 * second["whitened_rms"]
    assert "bearing oil" in document["headline"]


def test_a_joint_behind_the_shells_comes_first(document) -> None:
    """And cannot do it all: at its bound it ends, P2 asks for 0.036 m2 K/W, a millimetre of air."""
    evaluated = [row for row in document["alternatives"] if row["family"] != "none"]
    assert evaluated[0]["explanation"] == document["suspects"][0]["effect"] == "shell_contact:test"
    catalogue = [row["gain"] for row in evaluated if row["family"] == "physical"]
    assert catalogue[0] > 1.3 * max(catalogue[1:])
    [resistance] = document["suspects"][0]["parameters"]
    assert resistance["interval_open"] and resistance["interval_95"][1] == resistance["value"]


def test_the_contradictions_of_the_paper_are_told(document) -> None:
    doubts = [row for row in document["suspected_inputs"] if row["id"] == "doubt"]
    text = " ".join(row["text"] for row in doubts)
    assert len(doubts) == 9
    for number in ("345.23 W", "706 W", "617 W", "6.3 W/(m2 K)", "1.23", "4264 W", "733 l/min"):
        assert number in text


def test_other_points_are_what_to_measure_next(document) -> None:
    """A model that was never held against this rig is too uncertain for one more thermometer to tell."""
    steps = document["next_measurements"]
    computed = [step["measurement"] for step in steps if step["expected_odds"] is not None]
    assert computed and all("a point " in text for text in computed)
    assert "baseline" in steps[0]["measurement"]
    assert any("operating points" in step["measurement"] for step in steps)


def test_the_set_holds_the_printed_heat() -> None:
    table = (CASE / "measured" / "figure_12" / "data.csv").read_text(encoding="utf-8").splitlines()
    row = dict(zip(table[0].split(","), table[2].split(",")))
    assert (float(row["T_bearing_oil"]) - 40.0) * OUR_OIL == pytest.approx(PRINTED, rel=2e-3)
    assert float(row["T_max"]) == 178.59

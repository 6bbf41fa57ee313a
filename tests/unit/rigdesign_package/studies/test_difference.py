"""Two results against each other: inputs as quantities, verdicts, results, and files that cannot be read."""

import copy
import json
from pathlib import Path

import pytest

from rigdesign.base.errors import UsageError
from rigdesign.base.version import RESULTS_SCHEMA_VERSION, __version__
from rigdesign.case.provenance import InputRow
from rigdesign.cli.exit_status import exit_status
from rigdesign.cli.main import app
from rigdesign.cli.terminal.difference import print_difference
from rigdesign.report.numbers import change_text, quantity_texts
from rigdesign.report.pages.difference import write_difference
from rigdesign.report.results_json import results_document
from rigdesign.studies.difference import difference_document, headline, results_difference
from rigdesign.studies.stored_results import InputValue, changed_inputs, read_results, same_value
from tests.builders.browser import browser  # noqa: F401 - a fixture
from tests.builders.report import make_check, make_result

INPUTS = [
    InputRow(path="gearboxes.test.gears.pinion.face_width", value="7 mm", basis="P2, Figure 7"),
    InputRow(path="gearboxes.test.oil.inlet_temperature", value="140 degC", basis="assumed: as the main rig"),
    InputRow(path="schedule.test_torque", value="180 N m"),
    InputRow(path="gearboxes.test.title", value="test gearbox"),
]
CHECKS = [
    make_check("clearance.tip", 0.106, 0.1, comparison=">=", title="hot tip clearance"),
    make_check("temperature.outlet", 129.4, 160.0, unit="degC", title="hottest oil outlet", group="temperatures"),
    make_check("strength.root", 900.0, 950.0, unit="N/mm2", title="root stress <pinion>"),
    make_check("oil.flow", 26.0, 40.0, unit="l/min", title="oil flow"),
]  # fmt: skip


@pytest.fixture(scope="module")
def document():
    return results_document(make_result(inputs=INPUTS, checks=CHECKS, verdict="pass"))


@pytest.fixture
def first(document):
    return copy.deepcopy(document)


@pytest.fixture
def second(first):
    """Warmer oil: the clearance fails, a check came and one went, an assumption and a warning changed."""
    document = copy.deepcopy(first)
    document["verdict"] = "fail"
    document["inputs"][0]["value"] = "0.7 cm"
    document["inputs"][1]["value"] = "160 degC"
    document["inputs"][2]["basis"] = "measured: torque flange"
    document["inputs"][3] = {"path": "drivetrain.motor.inertia", "value": "0.01 kg m2", "basis": ""}
    tip, outlet, root, flow = document["checks"]
    tip.update(value=0.09, margin=-0.01, distance=-0.1, verdict="fail")
    outlet.update(value=145.5, margin=14.5, distance=14.5 / 160.0)
    root.update(value=900.0 * (1 + 1e-9))
    document["checks"][3] = {**flow, "id": "oil.other", "title": "other flow"}
    document["thermal"][0]["max_temperature_degC"] += 14.0
    document["losses"][0]["power_W"] += 10.0
    document["assumptions"] = document["assumptions"][1:]
    document["warnings"] = [*document["warnings"], {"id": "gear", "text": "tip meets fillet"}]
    return document


def written(document, folder):
    folder.mkdir(parents=True, exist_ok=True)
    text = document if isinstance(document, str) else json.dumps(document)
    (folder / "results.json").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def pair(first, second, tmp_path):
    return written(first, tmp_path / "a"), written(second, tmp_path / "b")


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("40 mm", "0.04 m", True),
        ("40 mm", "40.0 mm", True),
        ("140 degC", "413.15 K", True),
        ("12000 rpm", "12000 1/min", True),
        ("1e-3", "0.001", True),
        ("7 mm, 8 mm", "0.7 cm, 0.8 cm", True),
        ("7 mm, 8 mm", "7 mm, 9 mm", False),
        ("7 mm, 8 mm", "7 mm", False),
        ("40 mm", "41 mm", False),
        ("40 mm", "40 kg", False),
        ("steel", "bronze", False),
        ("true", "false", False),
        ("40 mm", "40", False),
    ],
)
def test_inputs_are_compared_as_quantities(one, other, same):
    assert same_value(one, other) is same and same_value(other, one) is same


def test_inputs_that_changed_came_went_or_have_another_source(pair):
    found = results_difference(*pair).inputs
    assert [(row.path, row.change) for row in found] == [
        ("gearboxes.test.oil.inlet_temperature", "changed"),
        ("drivetrain.motor.inertia", "added"),
        ("schedule.test_torque", "basis"),
    ]


def test_names_and_titles_are_no_inputs(first, tmp_path):
    """A case under another title is the same case to every check."""
    other = copy.deepcopy(first)
    labels = {"name": "other", "title": "Rig two", "document.author": "A. Smith", "schema_version": "1"}
    other["inputs"] += [{"path": path, "value": value, "basis": ""} for path, value in labels.items()]
    found = results_difference(written(first, tmp_path / "a"), written(other, tmp_path / "b"))
    assert found.inputs == () and found.same


def test_a_check_that_applies_to_one_result_only_is_no_flip(first, tmp_path):
    other = copy.deepcopy(first)
    for check in other["checks"][:2]:
        check.update(verdict="not applicable", value=None, margin=None, distance=None, reason="no housing")
    a, b = written(first, tmp_path / "a"), written(other, tmp_path / "b")
    found = results_difference(a, b)
    assert not found.flipped and not any(row.worse for row in found.checks)
    assert {row.id for row in found.checks_that("no longer applicable")} == {
        "clearance.tip",
        "temperature.outlet",
    }
    assert headline(found) == (
        "pass in both: no inputs changed, no verdicts flipped, 2 checks no longer applicable, no other checks moved"
    )
    back = results_difference(b, a)
    assert len(back.checks_that("now applicable")) == 2 and not back.flipped


def test_the_headline_counts_what_is_listed(pair, tmp_path, capsys):
    found = results_difference(*pair)
    print_difference(found, None, everything=True)
    text = capsys.readouterr().out
    for part in ("inputs changed (3)", "verdicts flipped (1)", "other checks moved (1)", "checks in A only (1)",
                 "checks in B only (1)"):  # fmt: skip
        assert part in text
    write_difference(found, tmp_path / "out")
    page = (tmp_path / "out" / "diff.html").read_text(encoding="utf-8")
    for part in ("Verdicts that flipped (1)", "Inputs that changed (3)", "Other checks that moved (1)",
                 "Checks in one result only (2)"):  # fmt: skip
        assert part in page
    assert headline(found) in page


def test_the_relative_change_of_an_input():
    def change(before, after):
        return changed_inputs(
            {"a": InputValue(value=before, basis="")}, {"a": InputValue(value=after, basis="")}
        )[0]

    assert change("40 mm", "0.05 m").relative == pytest.approx(0.25)
    assert change("140 degC", "160 degC").relative is None, "the zero of a temperature scale means nothing"
    assert change("steel", "bronze").relative is None


def test_verdicts_that_flipped_come_first_and_round_off_moves_nothing(pair):
    found = results_difference(*pair)
    assert [(row.id, row.change) for row in found.checks] == [
        ("clearance.tip", "flipped"), ("temperature.outlet", "moved"), ("oil.other", "added"), ("oil.flow", "removed"),
    ]  # fmt: skip
    assert found.checks[0].worse
    assert found.checks[0].distance_change == pytest.approx(-0.1 - (1.0 - 0.1 / 0.106))
    assert headline(found) == (
        "pass → fail: 3 inputs changed, 1 verdict flipped, 1 other check moved, 2 checks in one result only"
    )


def test_other_results_that_moved(pair, first):
    found = {(row.quantity, row.place): row for row in results_difference(*pair).quantities}
    thermal, loss = first["thermal"][0], first["losses"][0]
    hottest = found["highest temperature", f"{thermal['gearbox']}, stage {thermal['stage']}"]
    assert hottest.after - hottest.before == pytest.approx(14.0) and hottest.relative is None
    total = found["losses in all", f"stage {loss['stage']}"]
    assert total.after - total.before == pytest.approx(10.0)
    assert f"{loss['kind']} loss" in {quantity for quantity, _ in found}


def test_assumptions_and_warnings_that_came_and_went(pair, first):
    found = results_difference(*pair)
    assert found.warnings.added == ("tip meets fillet",) and not found.warnings.gone
    gone = first["assumptions"][0]
    assert found.assumptions.gone == (f"{gone['path']}: {gone['reason']}",) and not found.assumptions.added


def test_a_result_does_not_differ_from_itself(first, tmp_path):
    folder = written(first, tmp_path / "a")
    found = results_difference(folder, folder / "results.json")
    assert found.same and headline(found) == "nothing differs: pass in both"


def test_fidelity_version_and_case_are_said(first, tmp_path):
    other = {**first, "fidelity": "quick", "tool_version": "9.9", "case": {**first["case"], "name": "other"}}
    found = results_difference(written(first, tmp_path / "a"), written(other, tmp_path / "b"))
    assert [notice.split(":")[0] for notice in found.notices] == [
        "the cases are two", "fidelity standard and quick", f"rigdesign {__version__} and 9.9",
    ]  # fmt: skip


def damaged(**changes):
    return lambda document: json.dumps({**document, **changes})


def without(key):
    return lambda document: json.dumps({k: v for k, v in document.items() if k != key})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (damaged(schema_version="1"), "schema_version 1, this version reads 3; run `rigdesign check` again"),
        (
            without("inputs"),
            rf"lists no inputs \(written by rigdesign {__version__}\); run `rigdesign check` again",
        ),
        (without("schema_version"), "is no results.json of a check; diff takes"),
        (without("checks"), "is no results.json of a check; diff takes"),
        (without("losses"), r"is damaged \(KeyError: 'losses'\); run"),
        (damaged(checks=[{"id": "a"}]), "is damaged .*; run `rigdesign check` again"),
        (damaged(inputs=[{"path": "a", "value": 3, "basis": ""}]), "is damaged .*3 where a text belongs"),
        (damaged(thermal=7), "is damaged"),
        (lambda document: json.dumps(document)[:-200], "is damaged .*; run `rigdesign check` again"),
        (lambda document: json.dumps(document).replace('"pass"', "NaN", 1), "is damaged .*NaN is no number"),
        (lambda _: "", "is damaged"),
        (lambda _: "[1, 2]", "is no results.json of a check"),
        (lambda _: "[" * 100_000, "is damaged"),
    ],
)
def test_files_that_cannot_be_compared_say_what_to_do(first, tmp_path, change, message):
    good, bad = written(first, tmp_path / "good"), written(change(first), tmp_path / "bad")
    for order in ((good, bad), (bad, good)):
        with pytest.raises(UsageError, match=f"bad/results.json: .*{message}"):
            results_difference(*order)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("ledger.sqlite", "is the folder of a study"),
        ("case.toml", "is a case, not its results"),
        ("failure.json", "holds a run that did not converge"),
        ("diagnosis.json", "is the folder of a diagnosis"),
        ("notes.txt", "holds no results.json"),
    ],
)
def test_folders_of_something_else_are_named(tmp_path, name, message):
    (tmp_path / name).write_text("")
    with pytest.raises(
        UsageError, match=f"{message}; diff takes two folders that `rigdesign check --out` wrote"
    ):
        read_results(tmp_path)


def test_a_path_that_is_not_there(tmp_path):
    with pytest.raises(UsageError, match="no such file or folder; diff takes"):
        read_results(tmp_path / "nothing")


def test_a_file_that_is_no_text(tmp_path):
    (tmp_path / "results.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UsageError, match="is damaged"):
        read_results(tmp_path)


def test_what_a_check_writes_can_be_read(first):
    assert first["schema_version"] == RESULTS_SCHEMA_VERSION
    assert {"inputs", "checks", "losses", "thermal", "expansion", "oil", "dynamics"} <= set(first)


def test_the_terminal_keeps_to_80_columns(pair, capsys):
    print_difference(results_difference(*pair), Path("out"))
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    text = "\n".join(lines)
    assert "pass → fail: 3 inputs changed" in text
    assert "140 degC → 160 degC" in text
    flip = next(n for n, line in enumerate(lines) if "clearance.tip" in line)
    assert lines[flip - 1].endswith("distance to the limit") and lines[flip].endswith("5.66 → −10 %")
    assert "hot tip clearance: 0.106 → 0.09" in lines[flip + 1] and "limit ≥ 0.1 mm" in lines[flip + 1]
    assert text.index("verdicts flipped (1)") < text.index("inputs changed (3)") < text.index("checks moved")
    assert "+ tip meets fillet" in text and str(Path("out") / "diff.html") in text


def test_all_lists_everything(first, tmp_path, capsys):
    other = copy.deepcopy(first)
    other["inputs"] += [{"path": f"a.{n}", "value": str(n), "basis": ""} for n in range(30)]
    found = results_difference(written(first, tmp_path / "a"), written(other, tmp_path / "b"))
    print_difference(found, None)
    assert "… 24 more" in capsys.readouterr().out
    print_difference(found, None, everything=True)
    text = capsys.readouterr().out
    assert "a.29" in text and "more" not in text


def test_the_command_prints_one_document_and_ends_with_0(pair, tmp_path, capsys):
    status = app(
        ["diff", *map(str, pair), "--json", "--out", str(tmp_path / "out")], result_action="return_value"
    )
    document = json.loads(capsys.readouterr().out)
    assert status == 0 and document["schema_version"] == 1
    assert (
        document["checks"][0]["before"]["verdict"] == "pass" and document["checks"][0]["change"] == "flipped"
    )
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["diff.html", "diff.json"]
    assert json.loads((tmp_path / "out" / "diff.json").read_text())["inputs"] == document["inputs"]
    assert document == json.loads(json.dumps(difference_document(results_difference(*pair)), allow_nan=False))


def test_differences_are_no_failure_and_a_missing_result_is_status_2(pair, tmp_path, capsys):
    def ended(*paths):
        return exit_status(lambda: app(["diff", *map(str, paths)], result_action="return_value"))

    assert ended(*pair) == 0
    assert ended(pair[0], tmp_path / "nothing") == 2
    assert capsys.readouterr().err.startswith(f"rigdesign: {tmp_path / 'nothing'}: no such file or folder")


@pytest.mark.parametrize("width", [1280, 390])
def test_the_page_is_drawn_whole(browser, pair, tmp_path, width):  # noqa: F811
    write_difference(results_difference(*pair), tmp_path / "out")
    browser.open(tmp_path / "out" / "diff.html", width=width)
    assert browser.requests() == [] and browser.console() == []
    assert browser.overflow() == 0
    flipped = browser.find("#flipped tbody tr")
    assert len(flipped) == 1 and "hot tip clearance" in flipped[0].text
    assert "gearboxes.test.oil.inlet_temperature" in browser.find("#inputs")[0].text
    size = browser.run(
        "const s = document.querySelector('figure svg'); return [s.clientWidth, s.clientHeight]"
    )
    assert min(size) > 100
    assert "tip meets fillet" in browser.find("main")[0].text


def test_titles_are_escaped_and_nothing_differs_is_a_page(first, tmp_path):
    named = {**first, "case": {**first["case"], "title": "<b>rig</b>"}}
    folder = written(named, tmp_path / "a")
    write_difference(results_difference(folder, folder), tmp_path / "out")
    text = (tmp_path / "out" / "diff.html").read_text(encoding="utf-8")
    assert "&lt;b&gt;rig&lt;/b&gt;" in text and "<b>rig" not in text and "<svg" not in text
    assert "nothing differs: pass in both" in text


# ---------------------------------------------------------------------------- one unit, the right limit, new fails


def test_a_power_that_crosses_ten_kilowatts_stands_in_one_unit(first, tmp_path, capsys):
    other = copy.deepcopy(first)
    total = sum(row["power_W"] for row in first["losses"] if row["stage"] == first["losses"][0]["stage"])
    first["losses"][0]["power_W"] += 9_900.0 - total
    other["losses"][0]["power_W"] += 11_640.0 - total
    found = results_difference(written(first, tmp_path / "a"), written(other, tmp_path / "b"))
    print_difference(found, None, everything=True)
    line = next(line for line in capsys.readouterr().out.splitlines() if "losses in all" in line)
    assert line.rstrip().endswith("9.9 → 11.6 kW")
    assert quantity_texts((9_900.0, None, 11_640.0), "W") == ["9.9 kW", "–", "11.64 kW"]
    assert change_text(9_000.0, 9_900.0, "W") == "9000 → 9900 W"


@pytest.mark.parametrize(
    ("after", "shown"),
    [
        ({"limit": 700.0}, "700 … 1100 N/mm²"),
        ({"limit": 800.0}, "700 … 1100 N/mm² → 800 … 1100 N/mm²"),
    ],
)
def test_a_window_is_shown_whole_and_a_limit_that_moved_twice(after, shown, first, tmp_path, capsys):
    before = {"value": 1050.0, "comparison": "within", "limit": 700.0, "upper_limit": 1100.0, "margin": 50.0}
    first["checks"][2].update(before)
    other = copy.deepcopy(first)
    other["checks"][2].update(value=2351.0, margin=-1251.0, distance=-1.1, verdict="fail", **after)
    found = results_difference(written(first, tmp_path / "a"), written(other, tmp_path / "b"))
    print_difference(found, None)
    write_difference(found, tmp_path / "out")
    page = (tmp_path / "out" / "diff.html").read_text(encoding="utf-8")
    assert f"limit {shown}" in capsys.readouterr().out and f'<td class="n">{shown}</td>' in page


@pytest.mark.parametrize("there", [True, False])
def test_a_check_that_fails_now_and_did_not_apply_before_comes_first(there, first, tmp_path, capsys):
    """Whether the other result has it as not applicable, or not at all."""
    other = copy.deepcopy(first)
    other["checks"][0].update(value=0.09, margin=-0.01, distance=-0.1, verdict="fail", reason="too warm")
    first["checks"][0].update(verdict="not applicable", value=None, margin=None, distance=None)
    first["checks"] = first["checks"][0 if there else 1 :]
    found = results_difference(written(first, tmp_path / "a"), written(other, tmp_path / "b"))
    assert found.checks[0].change == "newly failing" and found.checks[0].worse
    assert "1 check newly failing" in headline(found) and "now applicable" not in headline(found)
    print_difference(found, None)
    shown = capsys.readouterr().out
    assert (
        "now failing, not applicable before (1)" in shown and "too warm" in shown and "limit ≥ 0.1" in shown
    )
    write_difference(found, tmp_path / "out")
    page = (tmp_path / "out" / "diff.html").read_text(encoding="utf-8")
    assert 'class="banner fail"' in page and "Now failing, not applicable before (1)" in page

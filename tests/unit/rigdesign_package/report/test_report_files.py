"""results.json, junit.xml, curves, fields and the rules of the output folder."""

import csv
import json
import re
import shutil
from dataclasses import replace
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

from rigdesign.base.errors import NonFiniteResultError, OutputError
from rigdesign.base.json_text import csv_text, to_plain, to_text
from rigdesign.base.output_folder import file_stem, prepare_output, staged
from rigdesign.cli.terminal.checks import print_checks
from rigdesign.report.junit import check_seconds, write_junit
from rigdesign.report.results_json import read_result, results_document
from rigdesign.report.writing import write_results
from rigdesign.results.curve_files import without_references
from tests.builders.commands import Rigdesign
from tests.builders.report import gearbox_field, make_check, make_result, small_result


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    out = tmp_path_factory.mktemp("report") / "new" / "out"
    result = make_result()
    write_results(result, out)
    return out, result


def test_results_json_keeps_the_contract(written):
    document = json.loads((written[0] / "results.json").read_text(encoding="utf-8"))
    assert document["schema_version"] == "3"
    assert set(document["case"]) >= {"name", "path", "hash"}
    assert document["verdict"] == "fail"
    assert set(document["checks"][0]) >= {
        "id", "title", "value", "limit", "unit", "margin", "distance", "verdict", "flags", "error", "source",
    }  # fmt: skip
    whole = without_references(document, written[0])
    gearbox = whole["dynamics"]["gearboxes"]["test"]
    assert set(gearbox["dynamic_factor"][0]) >= {
        "speed_rpm", "simulated", "simulated_half_peak_to_peak", "iso_6336_1_method_b",
    }  # fmt: skip
    assert {"dynamic_torque_peak_Nm", "lift_off", "resonances"} <= set(gearbox)
    assert set(document["losses"][0]) >= {"place", "stage", "power_W"}
    assert set(document["thermal"][0]) >= {
        "gearbox", "stage", "max_temperature_degC", "heat", "closure_relative", "nodes", "elements",
    }  # fmt: skip
    assert set(document["thermal"][0]["heat"][0]) >= {"surface", "kind", "power_W"}
    assert set(document["expansion"][0]) >= {"gearbox", "stage", "seal_gaps", "shafts"}
    (history,) = document["coupling"]
    assert (history["stage"], history["iterations"]) == ("dwell", 4)
    assert history["residuals"][1] == {
        "temperature_K": 4.0, "expansion_um": pytest.approx(300 / 18), "torque_relative": pytest.approx(0.02 / 12),
    }  # fmt: skip
    assert document["warnings"][0] == {
        "id": "iso_6336_range",
        "text": "stiffness regression outside its range",
        "checks": [],
    }
    assert {"assumptions", "timings_s", "tool_version"} <= set(document)


def test_every_listed_file_is_there_and_no_other(written):
    out = written[0]
    document = json.loads((out / "results.json").read_text(encoding="utf-8"))
    found = sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())
    assert document["files"] == found
    assert {"results.json", "report.html", "junit.xml", "fields/test_dwell.vtu", "curves/ramp.csv"} <= set(
        found
    )


def test_two_writes_are_the_same_bytes(written, tmp_path):
    out, result = written
    write_results(result, tmp_path)
    for path in out.rglob("*"):
        if path.is_file():
            assert path.read_bytes() == (tmp_path / path.relative_to(out)).read_bytes(), path


def test_case_without_drivetrain_keeps_the_keys(tmp_path):
    document = results_document(make_result(dynamics=None, expansion=[], thermal=[], fields=[], coupling=[]))
    assert (document["dynamics"], document["coupling"]) == (None, [])


@pytest.mark.parametrize("value", [float("nan"), float("inf"), np.float64("nan")])
def test_numbers_that_do_not_exist_are_named_and_nothing_is_written(value, tmp_path):
    result = make_result(checks=[make_check("gap", value, 0.3)])
    with pytest.raises(NonFiniteResultError, match=r"checks\[0\]\.value = (nan|inf)"):
        write_results(result, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_plain_values():
    mixed = {"a": np.array([1.0, 2.0]), "b": np.int64(3), "c": (np.bool_(True), None), "d": -0.0}
    assert to_text(to_plain(mixed)) == to_text({"a": [1.0, 2.0], "b": 3, "c": [True, None], "d": 0.0})
    assert to_plain(0.1 + 0.2) == 0.3
    assert to_plain(1.23456789012345e-7) == 1.23456789e-7
    with pytest.raises(TypeError, match="x: object"):
        to_plain({"x": object()})


def test_junit_has_a_testcase_per_check(written):
    out, result = written
    root = ElementTree.parse(out / "junit.xml").getroot()
    cases = {case.get("name"): case for case in root.iter("testcase")}
    assert set(cases) == {check.id for check in result.checks}
    failure = cases["root_stress_window"].find("failure")
    assert "2180 N/mm², limit ≤ 950 N/mm², margin −1230 N/mm²" in failure.get("message")
    assert "ISO 6336-3" in failure.text
    assert cases["bought_part_coupling"].find("skipped").get("message") == "no coupling is fitted"
    assert "close: holds" in cases["axial_play"].find("system-out").text
    assert cases["axial_play"].find("failure") is None
    assert root.get("failures") == "1"
    assert root.get("skipped") == "1"
    assert "margin 9 K" in cases["bearing_film"].find("system-out").text


def test_the_testcases_together_last_as_long_as_the_run(written):
    out, result = written
    root = ElementTree.parse(out / "junit.xml").getroot()
    cases = {case.get("name"): float(case.get("time")) for case in root.iter("testcase")}
    assert sum(cases.values()) == pytest.approx(sum(result.timings_s.values()), abs=0.001 * len(cases))
    assert cases["bought_part_coupling"] == 0.0


def test_a_part_of_the_run_goes_to_the_checks_that_use_it():
    checks = [
        make_check("load", 1.0, 2.0, group="dynamics"),
        make_check("gap", 1.0, 2.0, group="clearances"),
        make_check("play", 1.0, 2.0, group="clearances", verdict="not applicable"),
    ]
    timings = {"coupling": 4.0, "dynamics": 3.0, "discretisation": 1.0, "transient": 2.0}
    assert check_seconds(checks, timings) == {"load": 2.0 + 3.0 + 1.0, "gap": 2.0 + 1.0 + 1.0, "play": 0.0}


def test_two_runs_differ_in_the_times_of_junit_only(tmp_path):
    texts = []
    for name, seconds in (("one", 1.0), ("two", 7.5)):
        write_junit(small_result(timings_s={"coupling": seconds}), tmp_path / name)
        texts.append((tmp_path / name).read_text(encoding="utf-8"))
    assert texts[0] != texts[1]
    without = [re.sub(r' time="[^"]*"', "", text) for text in texts]
    assert without[0] == without[1] and "testcase" in without[0]


def test_junit_survives_characters_that_xml_lacks(tmp_path):
    result = small_result(checks=[make_check("gap", 1.0, 0.3, title="bad \x00 <title> & \x1b")])
    write_results(result, tmp_path)
    assert len(list(ElementTree.parse(tmp_path / "junit.xml").getroot().iter("testcase"))) == 1


def test_field_file_holds_temperature_displacement_and_body(written):
    out, result = written
    field = result.fields[0]
    mesh = meshio.read(out / "fields" / "test_dwell.vtu")
    np.testing.assert_allclose(mesh.points, field.mesh.points)
    np.testing.assert_array_equal(mesh.cells_dict["tetra10"], field.mesh.cells)
    np.testing.assert_allclose(mesh.point_data["temperature_degC"], field.temperature - 273.15)
    np.testing.assert_allclose(mesh.point_data["displacement_m"], field.displacement)
    bodies = json.loads((out / "results.json").read_text(encoding="utf-8"))["fields"][0]["bodies"]
    shaft = field.mesh.bodies["shaft_pinion"]
    assert set(mesh.cell_data_dict["body"]["tetra10"][shaft]) == {bodies.index("shaft_pinion")}


def test_curves_hold_what_the_result_holds(written):
    out, result = written
    names = {path.name for path in (out / "curves").iterdir()}
    assert names == {
        *("checks.csv", "losses.csv", "oil.csv", "heat.csv", "seal_gaps.csv", "ramp.csv"),
        *("dynamic_factor_test.csv", "dynamic_factor_reference.csv"),
        *("root_stress_test_pinion.csv", "root_stress_test_wheel.csv"),
    }
    lines = (out / "curves/dynamic_factor_test.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(lines))
    points = result.dynamics.gearboxes["test"].dynamic_factor
    assert len(rows) == 2 * len(points)
    assert {row["torque"] for row in rows} == {"180 Nm", "90 Nm"}
    assert float(rows[7]["max/mean [1]"]) == pytest.approx(points[7].simulated, rel=1e-9)
    ramp = list(csv.DictReader((out / "curves/ramp.csv").read_text(encoding="utf-8").splitlines()))
    assert float(ramp[-1]["reference maximum [Nm]"]) == pytest.approx(
        result.dynamics.ramp.torque["reference"]["maximum"][-1], rel=1e-9
    )
    lines = (out / "curves/losses.csv").read_text(encoding="utf-8").splitlines()
    total = sum(float(row["power [W]"]) for row in csv.DictReader(lines))
    assert total == pytest.approx(sum(row.power for row in result.losses))


def test_csv_cells():
    assert csv_text(("a", "b"), [(1.0, None), (2e-12, 'say "x", y')]) == 'a,b\n1,\n2e-12,"say ""x"", y"\n'


@pytest.mark.parametrize(
    ("text", "cell"),
    [
        ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
        ("@SUM(1+1)", "'@SUM(1+1)"),
        ("+1+cmd|x", "'+1+cmd|x"),
        ("-2 degC|calc!A0", "'-2 degC|calc!A0"),
        ("-10 degC", "-10 degC"),
        ("-4.5e-3 W/(m2 K)", "-4.5e-3 W/(m2 K)"),
        ("+12", "+12"),
        (-3.5, "-3.5"),
        ("two\nlines", "two lines"),
        ("a\u202eb\x1b", "a\\u202eb\\u001b"),
    ],
)
def test_no_cell_is_a_formula_and_each_is_one_line(text, cell):
    """OWASP, CSV injection; numbers keep their sign."""
    assert csv_text((text,), [(text,)]) == f"{cell}\n" * 2


def test_texts_of_a_case_are_no_formula_and_turn_no_line_of_the_output(tmp_path, capsys):
    title = "turned \u202e title\nverdict: pass"
    result = small_result(checks=[make_check("gap", 1.0, 0.3, title="=1+1", reason="\u2066moved")])
    result = replace(result, case={**result.case, "title": title})
    write_results(result, tmp_path)
    table = (tmp_path / "curves/checks.csv").read_text(encoding="utf-8")
    assert "'=1+1" in table
    print_checks(result, None, everything=True)
    shown = capsys.readouterr().out
    assert "\nverdict: pass" not in shown and "turned \\u202e title verdict: pass" in shown
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert not re.search("[\u202a-\u202e\u2066-\u2069]", table + shown + page)


def test_file_names_are_safe():
    assert file_stem("../../etc", "a b/c") == "etc_a_b_c"
    assert file_stem("..") == "unnamed"


def test_files_of_an_earlier_run_go_and_foreign_files_stay(tmp_path):
    write_results(small_result(dynamics=make_result().dynamics, fields=[gearbox_field(0.05)]), tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "fields" / "other.vtu").write_text("mine")
    write_results(small_result(), tmp_path)
    assert not (tmp_path / "fields" / "test_dwell.vtu").exists()
    assert not (tmp_path / "curves" / "ramp.csv").exists()
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert (tmp_path / "fields" / "other.vtu").read_text() == "mine"


def test_listed_files_outside_the_folder_are_never_removed(tmp_path):
    (tmp_path / "precious").write_text("mine")
    out = tmp_path / "out"
    out.mkdir()
    (out / "results.json").write_text(json.dumps({"files": ["../precious", 7]}))
    write_results(small_result(), out)
    assert (tmp_path / "precious").exists()


def test_a_failing_writer_leaves_the_earlier_result(tmp_path, monkeypatch):
    write_results(small_result(), tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}

    def fail(*_):
        raise RuntimeError("no picture")

    monkeypatch.setattr("rigdesign.report.pages.report.report_html", fail)
    with pytest.raises(RuntimeError, match="no picture"):
        write_results(small_result(verdict="pass"), tmp_path)
    assert before == {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}


def test_prepare_output_makes_nothing(tmp_path):
    prepare_output(tmp_path / "a" / "b")
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize("below", ["", "out", "deeper/out"])
def test_output_below_a_file_is_refused_before_the_run(below, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"is a file, a folder is needed; give another folder") as error:
        prepare_output(tmp_path / "file" / below)
    assert error.value.exit_code == 2


def test_a_folder_that_refuses_files_is_refused(tmp_path, monkeypatch):
    def refuse(**options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("rigdesign.base.output_folder.tempfile.TemporaryFile", refuse)
    with pytest.raises(OutputError, match="Permission denied"):
        prepare_output(tmp_path)


def test_results_json_appears_after_everything_else(tmp_path):
    """A file that cannot take its place keeps results.json away: who finds it finds the rest."""
    for name in ("a", "zz"):
        out = tmp_path / name
        (out / f"{name}.csv").mkdir(parents=True)
        with pytest.raises(OutputError), staged(out) as scratch:
            for written in (f"{name}.csv", "results.json"):
                (scratch / written).write_text("{}")
        assert not (out / "results.json").exists()


def test_staging_reports_a_disk_that_fills_up(tmp_path):
    with pytest.raises(OutputError, match="No space left"), staged(tmp_path / "out") as scratch:
        (scratch / "half").write_text("written")
        raise OSError(28, "No space left on device")
    assert list((tmp_path / "out").iterdir()) == []


# ---------------------------------------------------------------------------- printed again without solving


def test_a_result_comes_back_from_its_folder(written):
    out, result = written
    again, file = read_result(out)
    assert file == out / "results.json" and results_document(again) == results_document(result)
    assert len(again.fields) == len(result.fields) > 0
    for own, read in zip(result.fields, again.fields):
        assert (own.gearbox, own.stage) == (read.gearbox, read.stage)
        np.testing.assert_allclose(read.temperature, own.temperature, rtol=1e-12)
        np.testing.assert_array_equal(read.displacement, own.displacement)
        np.testing.assert_array_equal(read.mesh.cells, own.mesh.cells)
        for kind in ("bodies", "surfaces"):
            before, after = getattr(own.mesh, kind), getattr(read.mesh, kind)
            assert list(before) == list(after)
            for name in before:
                np.testing.assert_array_equal(after[name], before[name])


def test_the_report_printed_again_is_the_report(written, rigdesign: Rigdesign, tmp_path):
    """Numbers of the file have ten digits."""
    out, _ = written
    ended = rigdesign("report", out, "--html", "--out", tmp_path)
    assert ended.status == 0 and "verdict: fail" in ended.out and str(tmp_path / "report.html") in ended.out
    pages = [(folder / "report.html").read_text(encoding="utf-8") for folder in (out, tmp_path)]
    words, again = (_words(page) for page in pages)
    assert re.sub(r"\d+", "", words) == re.sub(r"\d+", "", again) and "Verdict" in words
    first, second = (np.array(re.findall(r"\d+", text), dtype=float) for text in (words, again))
    assert np.count_nonzero(first != second) <= 2, "a tie may be rounded either way"
    assert [page.count("<path") for page in pages] == [pages[0].count("<path")] * 2


def _words(page: str) -> str:
    """The page without its pictures and what names their parts."""
    return re.sub(r"<svg.*?</svg>", "", page, flags=re.DOTALL)


def test_a_pdf_beside_the_result_belongs_to_it(rigdesign: Rigdesign, tmp_path, monkeypatch):
    """The next run in the folder removes it."""
    monkeypatch.setattr("rigdesign.report.pdf.require_pdf", lambda: None)
    monkeypatch.setattr(
        "rigdesign.report.pdf.write_pdf", lambda page, path: path.write_text("pdf", encoding="utf-8")
    )
    write_results(make_result(fields=[]), tmp_path)
    before = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert rigdesign("report", tmp_path / "results.json", "--pdf").status == 0
    after = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert sorted([*before.pop("files"), "report.pdf"]) == after.pop("files") and before == after
    write_results(make_result(fields=[]), tmp_path)
    assert not (tmp_path / "report.pdf").exists()


def test_a_report_without_the_files_of_its_fields_has_no_pictures_of_them(written, tmp_path):
    out, _ = written
    shutil.copy(out / "results.json", tmp_path)
    shutil.copytree(out / "curves", tmp_path / "curves")
    again, _ = read_result(tmp_path)
    assert again.fields == [] and again.thermal


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda d: d | {"schema_version": "0"}, "schema_version 0"),
        (
            lambda d: d | {"schema_version": "2"},
            "schema_version 2, this version reads 3; run `rigdesign check` again",
        ),
        (lambda d: d | {"losses": [{"place": 3}]}, "is damaged"),
        (lambda d: {key: value for key, value in d.items() if key != "expansion"}, "is damaged"),
        (lambda d: {}, "is no results.json of a check; report takes"),
    ],
)
def test_what_is_no_result_is_refused_with_what_to_do(damage, said, written, rigdesign: Rigdesign, tmp_path):
    document = json.loads((written[0] / "results.json").read_text(encoding="utf-8"))
    (tmp_path / "results.json").write_text(json.dumps(damage(document)), encoding="utf-8")
    shutil.copytree(written[0] / "curves", tmp_path / "curves")
    ended = rigdesign("report", tmp_path, "--html")
    assert ended.status == 2 and said in ended.err and not (tmp_path / "report.html").exists()
    refused = rigdesign("report", written[0], "--out", tmp_path)
    assert refused.status == 2 and "--html or --pdf" in refused.err

"""calibration.json: written whole, read back as the same calibration, refused if damaged or of another rig."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from html import unescape
from pathlib import Path
from tempfile import mkdtemp

import pytest

from rigdesign import api
from rigdesign.base.errors import UsageError
from rigdesign.case import load_case
from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from rigdesign.diagnosis import run
from rigdesign.diagnosis.decision.defaults import DEFAULT
from rigdesign.diagnosis.document.advice import steps
from rigdesign.diagnosis.document.document import diagnosis_document
from rigdesign.diagnosis.document.outcome import outcome
from rigdesign.diagnosis.rig_calibration import healthy_sets
from rigdesign.diagnosis.rig_calibration.document import calibration_document, load_rig_calibration
from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration, calibrate_rig
from rigdesign.report.diagnosis_files import write_rig_calibration
from rigdesign.report.pages.diagnosis import diagnosis_page
from tests.builders.diagnosis import CASE, Rig, result_of, story, the_case, write_set
from tests.builders.paths import CASES


def by_formulas(case, measurement, effects, say=lambda message: None):
    result = result_of(measurement.folder)
    return result.data, result.problem.residuals


@cache
def calibrated(odd: bool = False) -> RigCalibration:
    folder = Path(mkdtemp(prefix="calibration-"))
    rigs = [Rig(seed=10), Rig(seed=11), Rig({"mesh_loss:test": (0.18,)}, seed=12) if odd else Rig(seed=12)]
    folders = [write_set(folder / f"week_{n}", rig, title=f"week {n}") for n, rig in enumerate(rigs)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(healthy_sets, "read_residuals", by_formulas)
        return calibrate_rig(the_case(), folders)


@pytest.fixture
def written(tmp_path: Path) -> Path:
    write_rig_calibration(calibrated(), tmp_path / "rig")
    return tmp_path / "rig" / "calibration.json"


def words(text: str) -> str:
    return re.sub(
        r"\s+",
        " ",
        unescape(re.sub(r"<[^>]+>", " ", re.sub(r"<style.*?</style>", "", text, flags=re.DOTALL))),
    )


# ------------------------------------------------------------------------ file


def test_the_file_holds_values_with_prior_spread_sets_and_hashes(written: Path) -> None:
    document = json.loads(written.read_text(encoding="utf-8"))
    assert document == calibration_document(calibrated())
    assert document["case"]["hash"] == the_case().hash
    assert [one["title"] for one in document["sets"]] == ["week 0", "week 1", "week 2"]
    assert len({one["hash"] for one in document["sets"]}) == 3
    values = {row["name"]: row for row in document["values"]}
    shaft = values["drift.shaft"]
    assert shaft["shipped"] == DEFAULT.drift.shaft and shaft["spread_factor"] > 1.0
    assert len(document["leave_one_out"]) == 9 and document["unlike_the_others"] == []
    assert sorted(path.name for path in written.parent.iterdir()) == ["calibration.html", "calibration.json"]


@pytest.mark.parametrize("by_folder", [True, False])
def test_the_calibration_read_back_is_the_one_that_was_made(written: Path, by_folder: bool) -> None:
    found = load_rig_calibration(written.parent if by_folder else written, the_case())
    made = calibrated().fit.calibration
    assert found.amplitudes.as_dict() == pytest.approx(made.amplitudes.as_dict(), rel=1e-9)
    assert found.drift.scales == pytest.approx(made.drift.scales, rel=1e-9)
    assert replace(found, amplitudes=made.amplitudes, drift=made.drift, origin=made.origin) == made
    assert found.origin.kind == "file" and len(found.origin.hash) == 64
    assert found.origin.sets == ("week 0", "week 1", "week 2") and found.origin.odd == ()


def test_a_variant_of_the_case_takes_the_calibration_of_its_rig(written: Path, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(f'extends = "{(CASE / "case.toml").as_posix()}"\ntitle = "patched"\n', encoding="utf-8")
    found = load_rig_calibration(written, load_case(file))
    assert found.origin.case_hash == the_case().hash


def test_another_rig_is_refused(written: Path, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"of the case loop_1to1, not of loop_hunting; calibrate this rig"):
        load_rig_calibration(written, load_case(CASES / "loop_hunting"))
    changed(written, lambda document: document["case"]["gears"]["test"].update(pinion=29))
    with pytest.raises(UsageError, match="of a rig with the gears"):
        load_rig_calibration(written, the_case())


def changed(file: Path, change: Callable[[dict], object]) -> None:
    document = json.loads(file.read_text(encoding="utf-8"))
    change(document)
    file.write_text(json.dumps(document), encoding="utf-8")


def row(document: dict, name: str) -> dict:
    return next(one for one in document["values"] if one["name"] == name)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(schema_version=99), r"schema_version = 99, must be 2; run `rigdesign calibrate` again"),
        (lambda d: d.pop("schema_version"), "no calibration of a rig"),
        (lambda d: d.pop("values"), "no calibration of a rig"),
        (lambda d: d.pop("sets"), "damaged, 'sets' is missing"),
        (lambda d: d["case"].pop("hash"), "damaged, 'hash' is missing"),
        (lambda d: d.update(case=[]), "damaged"),
        (lambda d: d.update(values=[1]), "damaged"),
        (lambda d: d["values"].remove(row(d, "drift.mesh")), r"damaged, drift\.mesh is missing"),
        (lambda d: row(d, "drift.mesh").update(name="drift.moon"), r"unknown value drift\.moon"),
        (lambda d: row(d, "drift.mesh").update(name="amplitudes.sensor"), r"unknown value amplitudes\.sensor"),
        (lambda d: row(d, "drift.mesh").update(value=-0.1), r"drift\.mesh = -0\.1, must be finite and at least zero"),
        (lambda d: row(d, "drift.mesh").update(value=float("nan")), r"drift\.mesh = nan, must be finite"),
        (lambda d: row(d, "drift.mesh").update(value=float("inf")), r"drift\.mesh = inf, must be finite"),
        (lambda d: row(d, "drift.mesh").update(value="1.0"), r"drift\.mesh = 1\.0, must be finite"),
        (lambda d: row(d, "drift.mesh").update(value=True), r"drift\.mesh = True, must be finite"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_used_says_why(written: Path, change, message: str) -> None:
    changed(written, change)
    with pytest.raises(UsageError, match=message) as refused:
        load_rig_calibration(written, the_case())
    assert str(written) in str(refused.value)


def test_a_file_cut_short_and_one_that_is_not_there(written: Path, tmp_path: Path) -> None:
    text = written.read_text(encoding="utf-8")
    written.write_text(text[: len(text) // 2], encoding="utf-8")
    with pytest.raises(UsageError, match="damaged, it is no JSON"):
        load_rig_calibration(written, the_case())
    written.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UsageError, match="damaged, it is no JSON"):
        load_rig_calibration(written, the_case())
    with pytest.raises(UsageError, match="cannot be read"):
        load_rig_calibration(tmp_path / "nowhere.json", the_case())


# ------------------------------------------------------------------------ page


def test_the_page_stands_alone_and_says_what_the_file_says(written: Path) -> None:
    page = (written.parent / "calibration.html").read_text(encoding="utf-8")
    assert not re.search(r"""(src|href)\s*=\s*["'](?!#|data:)""", page) and "<script" not in page
    text = words(page)
    assert "The healthy sets look alike" in text and "week 2" in text
    for name in ("drift.shaft", "amplitudes.link", "amplitudes.series_shaft"):
        assert (name in text) == any(one.name == name for one in calibrated().fit.estimates)
    assert not re.search(r"\bNone\b|\bnan\b|\binf\b", text)


def test_an_odd_set_is_said_on_the_page_and_in_the_file(tmp_path: Path) -> None:
    write_rig_calibration(calibrated(odd=True), tmp_path)
    sentence = "week_2: this set does not look like the others: leave it out or find out why"
    assert sentence in words((tmp_path / "calibration.html").read_text(encoding="utf-8"))
    assert sentence in json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))["advice"]
    assert load_rig_calibration(tmp_path, the_case()).origin.odd == ("week_2",)


# ------------------------------------------------------------------------ commands


def command(*arguments: str) -> int:
    return ending.exit_status(lambda: cli.app(list(arguments), result_action="return_value"))


def test_the_command_prints_every_set_left_out_and_where_the_file_is(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(healthy_sets, "calibrate_rig", lambda case, folders, say: calibrated(odd=True))
    monkeypatch.setenv("COLUMNS", "120")
    status = command("calibrate", str(CASE), "a", "b", "c", "--out", str(tmp_path))
    text = capsys.readouterr().out
    assert status == 0
    assert "check the healthy sets" in text and "week_2: this set does not look like the others" in text
    rows = [line for line in text.splitlines() if re.match(r"week_\d +(week_\d|none) ", line)]
    own = [line for line in rows if re.match(r"week_2 +week_\d ", line)]
    assert len(rows) == 9 and len(own) == 2 and all("mesh_loss:test" in line for line in own)
    assert str(tmp_path / "calibration.json") in text


def test_the_command_prints_one_document(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(healthy_sets, "calibrate_rig", lambda case, folders, say: calibrated())
    assert command("calibrate", str(CASE), "a", "b", "--out", str(tmp_path), "--json") == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))


def test_constants_take_one_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status = command("calibrate", str(CASE), "a", "b", "--constants", "--out", str(tmp_path))
    assert status == 2 and "--constants takes one healthy set, 2 given" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_constants_of_one_set_become_a_variant_of_the_case(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(run, "read_residuals", by_formulas)
    folder = write_set(tmp_path / "set", Rig({"bearing_loss:test": (0.1,)}, seed=3))
    out = tmp_path / "out"
    assert command("calibrate", str(CASE), str(folder), "--constants", "--out", str(out)) == 0
    assert "calibrated case" in capsys.readouterr().out
    names = sorted(path.relative_to(out).as_posix() for path in out.rglob("*.*"))
    assert names == ["calibrated/case.toml", "constants.json"]
    assert load_case(out / "calibrated").name == the_case().name
    fitted = json.loads((out / "constants.json").read_text(encoding="utf-8"))["constants"]
    [loss] = [one for one in fitted if one["effect"] == "bearing_loss:test"]
    assert loss["value"] == pytest.approx(1.105, rel=0.05)


def test_the_old_option_says_where_it_went(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status = command("diagnose", str(CASE), "set", "--out", str(tmp_path / "out"), "--calibrate")
    assert status == 2
    assert "rigdesign calibrate CASE SET --constants" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_diagnosis_records_the_calibration_it_used(
    written: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def instead(case, folder, *, calibration, say):
        return replace(story("healthy"), calibration=calibration)

    monkeypatch.setattr(run, "diagnose_measurement", instead)
    out = tmp_path / "out"
    for more, kind in (([], "shipped"), (["--calibration", str(written)], "file")):
        assert command("diagnose", str(CASE), "set", "--out", str(out), *more) == 0
        used = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))["calibration"]
        assert used["origin"]["kind"] == kind
        text, page = capsys.readouterr().out, words((out / "diagnosis.html").read_text(encoding="utf-8"))
        assert ("3 healthy sets of this rig" in text) == (kind == "file")
        assert ("3 healthy sets of this rig: week 0; week 1; week 2" in page) == (kind == "file")
        assert (used["origin"]["hash"] in page) and ("shipped values, no healthy sets" in page) == (
            kind == "shipped"
        )
    damaged = tmp_path / "damaged.json"
    damaged.write_text("{", encoding="utf-8")
    assert (
        command("diagnose", str(CASE), "set", "--out", str(tmp_path / "new"), "--calibration", str(damaged))
        == 2
    )
    assert not (tmp_path / "new").exists()


def test_the_library_takes_the_file_as_well(written: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    used = []

    def instead(case, folder, *, calibration):
        used.append(calibration)
        return story("healthy")

    monkeypatch.setattr(api, "diagnose_measurement", instead)
    api.diagnose(the_case(), "set")
    api.diagnose(the_case(), "set", calibration=written)
    assert used == [DEFAULT, load_rig_calibration(written, the_case())]


# ------------------------------------------------------------------------ no healthy set at all


def test_without_any_healthy_set_the_first_advice_is_to_measure_one(written: Path) -> None:
    alone = outcome(story("healthy"))
    assert steps(alone)[0].text.startswith("measure a healthy baseline first")
    assert "measure a healthy baseline first" in words(diagnosis_page(alone, diagnosis_document(alone)))
    given = outcome(story("mesh loss"))
    assert not any("baseline first" in step.text for step in steps(given))
    result = replace(story("healthy"), calibration=load_rig_calibration(written, the_case()))
    assert not any("baseline first" in step.text for step in steps(outcome(result)))

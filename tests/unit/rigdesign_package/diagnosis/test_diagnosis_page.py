"""The page and the command: self-contained, the same twice, told as a story, quiet on stdout with --json."""

import json
import re
from html import unescape
from pathlib import Path

import pytest

from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from rigdesign.cli.terminal.diagnosis import print_diagnosis
from rigdesign.diagnosis import run
from rigdesign.diagnosis.document.document import diagnosis_document
from rigdesign.diagnosis.document.outcome import outcome
from rigdesign.report.diagnosis_files import diagnosis_texts, write_diagnosis
from rigdesign.report.pages.diagnosis import diagnosis_page, shown_size
from tests.builders.diagnosis import CASE, Rig, result_of, story, write_set

STORIES = ("mesh loss", "run-out", "alias", "exchanged", "angle", "one point", "healthy")


def page(name: str, **keys) -> str:
    reported = outcome(story(name), **keys)
    return diagnosis_page(reported, diagnosis_document(reported))


def words(text: str) -> str:
    body = re.sub(r"<(style|svg).*?</\1>", " ", text, flags=re.DOTALL)
    return re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]+>", " ", body)))


@pytest.mark.parametrize("name", STORIES)
def test_the_page_stands_alone_and_tells_the_story_in_order(name: str) -> None:
    text = page(name)
    assert not re.search(r"""(src|href)\s*=\s*["'](?!#|data:)""", text)
    assert "<script" not in text and "@import" not in text and "url(http" not in text
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(ids) == len(set(ids))
    headings = re.findall(r'<h2 id="(\w+)"', text)
    needed = ["needed"] if name == "one point" else []
    assert headings == [
        "where",
        "sure",
        "size",
        "gap",
        "remains",
        *needed,
        "next",
        "patch",
        "sees",
        "data",
        "basis",
    ]
    for target in re.findall(r'href="#(\w+)"', text):
        assert target in ids
    assert not re.search(r"\bNone\b(?! of these)|\bnan\b|\binf\b", words(text))


def test_the_page_says_what_the_document_says() -> None:
    reported = outcome(story("mesh loss"))
    found = diagnosis_document(reported)
    text = words(diagnosis_page(reported, found))
    assert found["headline"] in text
    (parameter,) = found["named"][0]["parameters"]
    assert shown_size(parameter["value"], "", True) in text
    assert f"falls from {found['gap']['before']:.3g} to {found['gap']['after']:.3g}" in text
    assert "raw" not in text and "K" in text
    assert "rigdesign check patched" in text


def test_a_refusal_says_why() -> None:
    text = words(page("alias"))
    assert "The case is not patched: the data do not separate the members of the group" in text
    assert "No effect was named; the gap there" in text
    assert "run-out of test.wheel" in text and "--name" in text
    assert "Chosen by the user: run-out of test.wheel" in words(page("alias", pick="run_out:test.wheel"))
    assert "No operating point was held out" in words(page("one point"))


def test_a_users_words_stay_words(tmp_path: Path) -> None:
    result = result_of(write_set(tmp_path, Rig(), title="<b>$x_1$</b> & more"))
    reported = outcome(result)
    text = diagnosis_page(reported, diagnosis_document(reported))
    assert "<b>$x" not in text and "&lt;b&gt;$x_1$" in text


def test_two_runs_write_the_same_bytes(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", Rig({"single_pitch:test.pinion/5": (30e-6,)}))
    first, second = (diagnosis_texts(outcome(result_of(folder)), tmp_path / "out") for _ in range(2))
    assert first == second
    assert set(first) == {"diagnosis.json", "diagnosis.html", "case.patch.json", "patched/case.toml"}


def test_readings_left_out_are_listed(tmp_path: Path) -> None:
    def spoil(point, values):
        return {**values, "P": values["P"] + (2500.0 if point == "P04" else 0.0)}

    result = result_of(write_set(tmp_path, Rig(), spoil=spoil))
    reported = outcome(result)
    found = diagnosis_document(reported)
    (row,) = found["data"]["rejected_readings"]
    assert (row["channel"], row["point"], row["unit"]) == ("P", "P04", "W") and row["deviation"] > 5.5
    assert found["data"]["numbers"] == len(result.problem.residuals.features) - 1
    assert "rejected as outliers" in words(diagnosis_page(reported, found))


@pytest.mark.parametrize("name", STORIES)
def test_the_terminal_names_verdict_and_report(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    reported = outcome(story(name))
    print_diagnosis(reported, tmp_path)
    text = capsys.readouterr().out
    assert reported.result.diagnosis.strength in text and "diagnosis.html" in text
    assert ("patched case" in text) == (reported.case_patch is not None)
    assert ("perhaps" in text) == (bool(reported.suspects) and reported.verdict != "within_noise")
    doubted = any(one.weight == "suspect" for one in reported.result.data.findings)
    assert ("suspect " in text) == doubted


def run_command(monkeypatch: pytest.MonkeyPatch, name: str, *arguments: str) -> int:
    def instead(case, folder, *, say=lambda message: None, **keys):
        say("evaluating hypotheses")
        return story(name)

    monkeypatch.setattr(run, "diagnose_measurement", instead)
    return ending.exit_status(
        lambda: cli.app(["diagnose", str(CASE), *arguments], result_action="return_value")
    )


def test_the_command_writes_all_and_prints_one_document(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status = run_command(monkeypatch, "mesh loss", "set", "--out", str(tmp_path / "out"), "--json")
    assert status == 0
    printed = capsys.readouterr()
    document = json.loads(printed.out)
    assert document == json.loads((tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    assert "evaluating hypotheses" in printed.err
    names = sorted(path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*.*"))
    assert names == ["case.patch.json", "diagnosis.html", "diagnosis.json", "patched/case.toml"]


@pytest.mark.parametrize("name", ["alias", "one point", "exchanged", "healthy"])
def test_every_verdict_is_a_success(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, name: str) -> None:
    assert run_command(monkeypatch, name, "set", "--out", str(tmp_path)) == 0
    assert not (tmp_path / "case.patch.json").exists()


def test_a_wrong_name_is_refused_before_anything_is_computed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status = run_command(
        monkeypatch, "alias", "set", "--out", str(tmp_path / "out"), "--name", "run_out:test.pinon"
    )
    assert status == 2 and not (tmp_path / "out").exists()
    text = capsys.readouterr().err
    assert "did you mean run_out:test.pinion" in text and "evaluating" not in text


def test_an_out_that_is_a_file_is_refused_before_anything_is_computed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    assert run_command(monkeypatch, "alias", "set", "--out", str(tmp_path / "out")) == 2
    assert "evaluating" not in capsys.readouterr().err
    assert (tmp_path / "out").read_text(encoding="utf-8") == "mine"


def test_nothing_is_left_of_a_run_that_breaks(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    reported = outcome(story("mesh loss"))

    def broken(*arguments):
        raise RuntimeError("drawing")

    monkeypatch.setattr("rigdesign.report.diagnosis_files.diagnosis_page", broken)
    with pytest.raises(RuntimeError, match="drawing"):
        write_diagnosis(reported, tmp_path / "out")
    assert not (tmp_path / "out").exists()

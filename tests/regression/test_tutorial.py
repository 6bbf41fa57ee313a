"""The tutorial of the 1:1 loop: its commands are run as they are printed, and print what the pages show."""

import csv
import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from rigdesign.cli import main as cli
from rigdesign.cli.exit_status import exit_status
from tests.builders.page_files import missing_lines, shown, written_out
from tests.builders.paths import CASES, ROOT
from tests.builders.shared_runs import run_cache

PAGES = sorted((CASES / "loop_1to1" / "tutorial").glob("*.md"))


def takes_minutes(arguments: list[str]) -> bool:
    """Diagnosis and calibration with what follows from them, studies of more than three points: with the slow tests."""
    diagnosed = arguments[0] in ("diagnose", "calibrate") or "diagnosis/patched" in arguments
    return diagnosed or "--boundary" in arguments or arguments.count("--vary") > 1


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Where a reader of the tutorial stands: next to the cases."""
    place = tmp_path_factory.mktemp("reader")
    (place / "cases").symlink_to(ROOT / "cases")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(run_cache()))
        patch.setenv("COLUMNS", "80")
        patch.chdir(place)
        yield place


def run(page: Path, folder: Path, capsys: pytest.CaptureFixture[str], *, slow: bool) -> int:
    """Run the commands of a page and hold their output against it; the number that ran."""
    text = page.read_text(encoding="utf-8")
    written_out(text, folder)
    wanted = [pair for pair in shown(text) if takes_minutes(pair[0]) is slow]
    for arguments, lines in wanted:
        status = exit_status(lambda arguments=arguments: cli.run(arguments))
        printed = capsys.readouterr().out
        assert status == (1 if arguments[0] == "check" else 0), arguments  # open or fail, as the pages say
        assert missing_lines(lines, printed) == [], f"{arguments}\n{printed}"
    return len(wanted)


def test_the_pages_lead_to_each_other() -> None:
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    assert [page.name[0] for page in PAGES] == ["1", "2", "3", "4"]
    assert all(after.name in before for before, after in zip(texts, PAGES[1:], strict=False))
    readme = (CASES / "loop_1to1" / "README.md").read_text(encoding="utf-8")
    assert all(f"tutorial/{page.name}" in readme for page in PAGES)


@pytest.mark.whole_run
@pytest.mark.parametrize("page", PAGES[:3], ids=[page.stem for page in PAGES[:3]])
def test_the_commands_of_a_page_print_what_it_shows(
    page: Path, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(page, folder, capsys, slow=False) > 0


@pytest.mark.whole_run
def test_the_study_says_what_the_page_tells(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    if not (folder / "oil_temperature").is_dir():
        run(PAGES[1], folder, capsys, slow=False)
    with (folder / "oil_temperature" / "results.csv").open(encoding="utf-8") as file:
        *held, last = csv.DictReader(file)
    margins = [float(row["temperature.oil_outlet margin [K]"]) for row in (held[-1], last)]
    verdicts = [row["temperature.oil_outlet verdict"] for row in (*held, last)]
    assert verdicts[0] == "pass" and verdicts[-1] == "fail"
    assert 80.0 + 20.0 * margins[0] / (margins[0] - margins[1]) == pytest.approx(97.7, abs=0.3)
    assert margins == pytest.approx([18.16, -2.40], rel=0.02)


@pytest.mark.slow
def test_the_limit_and_the_map_are_those_of_the_page(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(PAGES[1], folder, capsys, slow=True) == 2


@pytest.mark.slow
def test_the_diagnosis_ends_as_the_page_tells(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.rmtree(folder / "diagnosis", ignore_errors=True)
    assert run(PAGES[2], folder, capsys, slow=True) == 1
    found = json.loads((folder / "diagnosis" / "diagnosis.json").read_text(encoding="utf-8"))
    assert found["verdict"] == "alias_group" and found["named"] == []
    pairs = [set(entry["effects"]) for entry in found["aliases"]]
    assert {"run_out:test.pinion", "run_out:test.wheel"} in pairs


@pytest.mark.slow
def test_a_rig_of_ones_own_is_calibrated_diagnosed_and_checked(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(folder / "diagnosis", ignore_errors=True)
    assert run(PAGES[3], folder, capsys, slow=True) == 3
    found = json.loads((folder / "diagnosis" / "diagnosis.json").read_text(encoding="utf-8"))
    assert [row["effect"] for row in found["named"]] == ["leak_warm_cold:test"]
    assert found["strength"] == "proven" and found["gap"]["shrunk"]

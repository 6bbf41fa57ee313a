"""README, from a spreadsheet to a diagnosis in ten lines: its files and commands are run as they are printed."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from nptdms import ChannelObject, TdmsWriter

from rigdesign.cli.main import app
from tests.builders.page_files import commands, written_out
from tests.builders.paths import ROOT
from tests.builders.shared_runs import run_cache

README = (ROOT / "README.md").read_text(encoding="utf-8")
RECORDED = {"P01": (61.55, 468.0), "P02": (72.27, 2867.5), "P03": (79.12, 1799.0)}
"""Outlet temperature [degC] and power [W] of the recordings: the means of the repeats in the spreadsheet."""


def recorded(folder: Path) -> None:
    """A TDMS file a point as LabVIEW writes them: 20 s with noise."""
    noise = np.random.default_rng(5).standard_normal((2, 2000))
    timing = {"wf_increment": 0.01, "wf_start_offset": 0.0}
    for point, (outlet, power) in RECORDED.items():
        with TdmsWriter(folder / f"{point}.tdms") as writer:
            writer.write_segment(
                [
                    ChannelObject(
                        "Oil", "T_out", outlet + 0.05 * noise[0], {**timing, "unit_string": "degC"}
                    ),
                    ChannelObject("Drive", "P", power + 20.0 * noise[1], {**timing, "unit_string": "W"}),
                ]
            )


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """The folder of an outsider in which all commands of the README's recipe have run."""
    folder = tmp_path_factory.mktemp("outsider")
    (folder / "cases").symlink_to(ROOT / "cases")
    written_out(README, folder)
    recorded(folder / "labview")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(run_cache()))
        patch.chdir(folder)
        for arguments in commands(README):
            opened = arguments[0] == "check"  # at quick fidelity, which leaves loads and resonances open
            assert app(arguments, result_action="return_value") == int(opened), arguments
        yield folder


def document(folder: Path, name: str):
    return json.loads((folder / name).read_text(encoding="utf-8"))


def test_it_is_ten_lines() -> None:
    [content] = re.findall(r"^```toml my_set/measurement.toml\n(.*?)^```", README, re.DOTALL | re.MULTILINE)
    first = [arguments for arguments in commands(README) if "my_set" in arguments]
    assert len(content.splitlines()) + len(first) == 10


def test_the_spreadsheet_is_compared_and_diagnosed(done: Path) -> None:
    comparison = document(done, "comparison/compare.json")
    assert comparison["measurement"]["points"] == 3
    found = document(done, "diagnosis/diagnosis.json")
    assert found["verdict"] == "within_noise" and found["named"] == []
    assert found["data"]["numbers"] == 6 and found["data"]["findings"] == []
    assert any("at least 6 operating points" in row["measurement"] for row in found["next_measurements"])
    assert (done / "diagnosis" / "diagnosis.html").stat().st_size > 20_000


def test_the_recordings_say_the_same(done: Path) -> None:
    found = document(done, "diagnosis_labview/diagnosis.json")
    assert found["verdict"] == "within_noise" and found["data"]["numbers"] == 6
    assert {finding["id"] for finding in found["data"]["findings"]} == {"no_repeats"}


def test_other_readings_are_not_passed_over(done: Path) -> None:
    """Twice the power at every point: more than any healthy rig of this case takes."""
    other = done / "other"
    other.mkdir()
    (other / "measurement.toml").write_text(
        (done / "my_set" / "measurement.toml").read_text(encoding="utf-8"), encoding="utf-8"
    )
    head, units, *rows = (done / "my_set" / "run.csv").read_text(encoding="utf-8").splitlines()
    changed = [row.rsplit(";", 1) for row in rows]
    rows = [f"{kept};{2 * int(power)}" for kept, power in changed]
    (other / "run.csv").write_text("\n".join([head, units, *rows]) + "\n", encoding="utf-8")
    assert app(["diagnose", "cases/loop_1to1", "other", "--out", "out"], result_action="return_value") == 0
    assert document(done, "out/diagnosis.json")["verdict"] != "within_noise"


def test_the_first_case_is_checked_and_studied(done: Path) -> None:
    assert document(done, "first/results.json")["case"]["name"] == "my_rig"
    rows = (done / "study" / "results.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 1 + 3 and (done / "study" / "study.html").is_file()

"""Shares of a study: together they are one study, to the byte."""

import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from rigdesign.base.errors import OutputError, UsageError
from rigdesign.base.output_folder import FileLock
from rigdesign.studies.design import StudyDesign
from rigdesign.studies.ledger import (
    FILES_LOCK,
    LOCK_NAME,
    START_LOCK,
    Ledger,
    Shard,
    parse_shard,
    read_points,
)
from tests.builders.paths import ROOT
from tests.builders.study import InProcess, run_study
from tests.builders.study_functions import CURVES, curves

VARY = ("oil.inlet=80:126:2 degC", "gear.teeth=30,40")
FILES = ("results.csv", "study.html", "study.svg")
POINTS = 48


def contents(out: Path) -> list[bytes]:
    return [(out / name).read_bytes() for name in FILES]


def run_share(out: Path, shard: Shard | None, **execution):
    return run_study(CURVES, VARY, out, run=curves, executor=InProcess(), shard=shard, **execution)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    out = tmp_path_factory.mktemp("whole")
    run_share(out, None)
    return contents(out)


@pytest.mark.parametrize("order", [(1, 2, 3), (3, 1, 2)])
def test_the_last_share_writes_what_one_study_writes(order, whole, tmp_path):
    outcomes = [run_share(tmp_path, Shard(number, 3)) for number in order]
    assert [outcome.completed for outcome in outcomes] == [16] * 3
    assert [outcome.missing for outcome in outcomes] == [32, 16, 0]
    assert [len(outcome.points) for outcome in outcomes] == [16, 32, 48]
    assert contents(tmp_path) == whole
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        [*FILES, *(f"ledger.{number}-of-3.sqlite" for number in (1, 2, 3))]
    )


def test_no_file_is_written_while_a_share_is_missing(tmp_path):
    run_share(tmp_path, Shard(2, 2))
    assert not set(FILES) & {path.name for path in tmp_path.iterdir()}


def test_a_study_without_shares_takes_over_theirs(whole, tmp_path):
    run_share(tmp_path, Shard(1, 3))
    run_share(tmp_path, Shard(3, 3))
    outcome = run_share(tmp_path, None)
    assert (outcome.completed, outcome.reused) == (16, 32)
    assert contents(tmp_path) == whole


def test_shares_take_over_what_is_there_and_may_be_cut_anew(whole, tmp_path):
    run_share(tmp_path, Shard(1, 2))
    outcomes = [run_share(tmp_path, Shard(number, 3)) for number in (1, 2, 3)]
    assert sum(outcome.completed for outcome in outcomes) == 24
    assert contents(tmp_path) == whole


DRIVER = """
import sys
sys.path.insert(0, {root!r})
from pathlib import Path
from rigdesign.studies.ledger import parse_shard
from tests.builders.study import run_study
from tests.builders.study_functions import CURVES, curves
if __name__ == "__main__":
    run_study(CURVES, {vary!r}, Path(sys.argv[1]), run=curves, workers=1, shard=parse_shard(sys.argv[2]))
"""


@pytest.mark.whole_run
def test_shares_that_run_at_the_same_time_in_processes_of_their_own(whole, tmp_path):
    (tmp_path / "driver.py").write_text(DRIVER.format(root=str(ROOT), vary=VARY))
    jobs = [
        subprocess.Popen([sys.executable, str(tmp_path / "driver.py"), str(tmp_path / "out"), f"{number}/2"])
        for number in (1, 2)
    ]
    assert [job.wait(timeout=120) for job in jobs] == [0, 0]
    assert contents(tmp_path / "out") == whole


def test_a_sampled_study_in_shares_has_the_same_indices(tmp_path):
    design = StudyDesign(vary=("oil.inlet=80:120 degC", "gear.teeth=20:40"), sample="sobol:8", indices=True)
    found = []
    for out, shards in (("one", [None]), ("two", [Shard(1, 2), Shard(2, 2)])):
        for shard in shards:
            outcome = run_study(
                CURVES, design, tmp_path / out, run=curves, executor=InProcess(), shard=shard, write=quiet
            )
        found.append(outcome.result)
    assert found[0].indices and found[0].indices == found[1].indices
    assert found[0].probabilities == found[1].probabilities and found[0].points == found[1].points


@pytest.mark.parametrize(
    "design",
    [
        StudyDesign(vary=("oil.inlet=80:120 degC", "gear.teeth=20:40"), tornado=True),
        StudyDesign(vary=("oil.inlet=80:120 degC", "gear.teeth=20:40"), sample="sobol:4", indices=True),
        StudyDesign(vary=("oil.inlet=80:120 degC", "gear.teeth=20:40"), sample="lhs:5"),
    ],
)
def test_every_design_is_computed_in_three_shares(design, tmp_path):
    """Nothing is concluded from a share: the first and second leave points to the others."""
    for number in (1, 2, 3):
        outcome = run_study(
            CURVES, design, tmp_path, run=curves, executor=InProcess(), shard=Shard(number, 3), write=quiet
        )
        concluded = outcome.result.swings or outcome.result.indices or outcome.result.probabilities
        assert bool(concluded) == (number == 3) == (outcome.missing == 0)


def quiet(study, out):
    """In place of the page."""


def test_a_failed_point_of_a_share_is_a_result_and_is_retried_by_its_share_alone(whole, tmp_path):
    vary = "oil.inlet=121:125:1 degC"
    first = [
        run_study(CURVES, vary, tmp_path, run=curves, executor=InProcess(), shard=Shard(number, 2))
        for number in (1, 2)
    ]
    assert first[1].missing == 0 and [point.failed for point in first[1].points].count(True) == 1
    again = [
        run_study(
            CURVES, vary, tmp_path, run=curves, executor=InProcess(), shard=Shard(number, 2), retry=True
        )
        for number in (1, 2)
    ]
    assert [outcome.completed for outcome in again] == [1, 0]


def test_a_boundary_has_no_shares(tmp_path):
    design = StudyDesign(vary=("oil.inlet=80:130 degC",), boundary=True)
    with pytest.raises(UsageError, match="chooses its points as it goes"):
        run_study(CURVES, design, tmp_path / "out", run=curves, shard=Shard(1, 2))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("text", ["1", "0/2", "3/2", "1/0", "a/b", "-1/2", "1/2/3"])
def test_shares_that_are_none(text):
    with pytest.raises(UsageError, match="write --shard 1/4"):
        parse_shard(text)


def test_two_jobs_of_one_share_and_a_study_over_running_shares_are_refused(tmp_path):
    with FileLock(tmp_path / Shard(1, 2).lock_name):
        for shard in (Shard(1, 2), None):
            with pytest.raises(OutputError, match=r"a study of process \d+ .* runs in it"):
                run_share(tmp_path, shard)
        run_share(tmp_path, Shard(2, 2))


def test_the_share_that_finds_another_writing_leaves_the_files_to_it(whole, tmp_path):
    run_share(tmp_path, Shard(1, 2))
    with FileLock(tmp_path / FILES_LOCK):
        assert run_share(tmp_path, Shard(2, 2)).missing == 0
    assert not (tmp_path / "results.csv").exists()
    run_share(tmp_path, None)
    assert contents(tmp_path) == whole


@pytest.mark.parametrize("damage", [b"", b"not a database " * 50, None])
def test_a_share_takes_nothing_from_a_ledger_it_cannot_read(damage, tmp_path):
    path = tmp_path / "ledger.1-of-2.sqlite"
    with Ledger(path) as ledger:
        ledger.store("k", fidelity="quick", case_hash="h", inputs={}, failed=False, record={"a": 1})
    assert read_points(path) == {"k": (False, {"a": 1})}
    shutil.copy(path, tmp_path / "copy")
    path.write_bytes(path.read_bytes()[:5000] if damage is None else damage)
    assert read_points(path) == {}
    assert read_points(tmp_path / "nowhere.sqlite") == {}
    assert not (tmp_path / "nowhere.sqlite").exists()


def test_a_share_beside_a_running_study_of_all_points_is_refused_and_nothing_is_lost(whole, tmp_path):
    run_share(tmp_path, Shard(1, 2))
    with (
        FileLock(tmp_path / LOCK_NAME),
        pytest.raises(OutputError, match=r"a study of process \d+ .* runs in it; wait for its end"),
    ):
        run_share(tmp_path, Shard(2, 2))
    assert not (tmp_path / Shard(2, 2).lock_name).exists()
    assert run_share(tmp_path, None).reused == POINTS // 2
    assert contents(tmp_path) == whole


def test_shares_that_start_at_the_same_moment_wait_for_each_other(tmp_path):
    start = FileLock(tmp_path / START_LOCK)
    threading.Timer(0.5, start.release).start()
    assert run_share(tmp_path, Shard(1, 2)).completed == POINTS // 2

"""How points are computed: any executor, once prepared, a defect stops, a point that fails is a result."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import pytest

from rigdesign.base import worker_pool
from rigdesign.base.errors import MissingLibraryError
from rigdesign.base.worker_pool import LostWorkersError, ProcessWorkers
from rigdesign.cli.exit_status import exit_status
from rigdesign.studies.solver import PointDefectError
from tests.builders.paths import ROOT
from tests.builders.study import InProcess, run_study
from tests.builders.study_functions import CURVES, curves, defective, prepare_curves

VARY = "oil.inlet=80:120:10 degC"


def test_a_defect_stops_the_study_and_what_was_computed_stays(tmp_path, capsys):
    with pytest.raises(PointDefectError) as stopped:
        run_study(CURVES, VARY, tmp_path, run=defective, executor=InProcess())
    assert str(stopped.value).startswith(
        "point oil.inlet = 100 degC: ZeroDivisionError: a defect; 2 of 5 points"
    )
    assert 'raise ZeroDivisionError("a defect")' in stopped.value.__notes__[0]
    assert not (tmp_path / "results.csv").exists()
    outcome = run_study(CURVES, VARY, tmp_path, run=curves, executor=InProcess())
    assert (outcome.completed, outcome.reused, outcome.failed) == (3, 2, [])


def test_a_defect_ends_a_command_with_70_and_a_file_that_shows_where(tmp_path, capsys):
    status = exit_status(lambda: run_study(CURVES, VARY, tmp_path, run=defective, executor=InProcess()))
    reported = capsys.readouterr().err
    assert status == 70 and "oil.inlet = 100 degC: ZeroDivisionError" in reported
    assert "study_functions.py" in Path(reported.rpartition(" in ")[2].strip()).read_text(encoding="utf-8")


@pytest.mark.whole_run
def test_a_defect_in_a_worker_process_shows_its_traceback_here(tmp_path):
    with pytest.raises(PointDefectError) as stopped:
        run_study(CURVES, VARY, tmp_path, run=defective, workers=1)
    assert "study_functions.py" in stopped.value.__notes__[0]


def lacks_library(case, *, fidelity):
    raise MissingLibraryError("gmsh needs libGLU; run: apt install libglu1-mesa")


def test_a_library_that_is_missing_is_no_result_of_a_point(tmp_path):
    with pytest.raises(MissingLibraryError, match="apt install libglu1-mesa"):
        run_study(CURVES, VARY, tmp_path, run=lacks_library, executor=InProcess())
    outcome = run_study(CURVES, VARY, tmp_path, run=curves, executor=InProcess())
    assert (outcome.completed, outcome.reused) == (5, 0)


def no_memory(case, *, fidelity):
    raise MemoryError


def test_a_point_without_memory_is_a_failed_point(tmp_path):
    outcome = run_study(CURVES, VARY, tmp_path, run=no_memory, executor=InProcess())
    assert len(outcome.failed) == 5 and "no memory left" in outcome.failed[0]


@pytest.mark.whole_run
@pytest.mark.parametrize(
    "make",
    [
        lambda: ThreadPoolExecutor(4),
        lambda: ProcessPoolExecutor(2, mp_context=get_context("spawn")),
    ],
)
def test_any_executor_gives_the_same_files_and_is_left_open(make, tmp_path):
    run_study(CURVES, VARY, tmp_path / "here", run=curves, executor=InProcess())
    with make() as executor:
        run_study(CURVES, VARY, tmp_path / "there", run=curves, executor=executor)
        assert executor.submit(int, "7").result() == 7
    for name in ("results.csv", "study.html", "study.svg"):
        assert (tmp_path / "here" / name).read_bytes() == (tmp_path / "there" / name).read_bytes()


class Gives(Executor):
    """An executor of which every task ends in the same way."""

    def __init__(self, end):
        self.end = end

    def submit(self, work, /, *arguments, **keywords):
        future = Future()
        self.end(future)
        return future


def cancelled(future):
    future.cancel()
    future.set_running_or_notify_cancel()


def broken(future):
    from concurrent.futures.process import BrokenProcessPool

    future.set_exception(BrokenProcessPool("a process died"))


@pytest.mark.parametrize("end", [cancelled, broken])
def test_an_executor_that_ends_is_named_with_what_is_left(end, tmp_path):
    with pytest.raises(LostWorkersError, match=r"workers of Gives ended .* 0 of 5 points are computed"):
        run_study(CURVES, VARY, tmp_path, run=curves, executor=Gives(end))


@pytest.mark.whole_run
def test_every_worker_prepares_the_case_of_the_study_once(tmp_path):
    case = replace(CURVES, folder=str(tmp_path))
    outcome = run_study(
        case, "oil.inlet=80:120:1 degC", tmp_path / "out", fidelity="quick", prepare=prepare_curves, workers=2
    )
    assert outcome.completed == 41 and outcome.failed == []
    processes = [path.name.split("-")[1] for path in tmp_path.glob("prepared-*")]
    assert 1 <= len(processes) <= 2 and len(set(processes)) == len(processes)


@pytest.mark.whole_run
def test_worker_processes_stay_from_call_to_call():
    with ProcessWorkers(1) as workers:
        processes = {
            outcome for _ in range(3) for _, outcome in workers.compute(process_number, [None, None])
        }
    assert len(processes) == 1


def process_number(task):
    return os.getpid()


UNGUARDED = """
import sys
from pathlib import Path
from tests.builders.study import run_study
from tests.builders.study_functions import CURVES, curves
def own(case, *, fidelity):
    return curves(case, fidelity=fidelity)
print("the script runs")
found = run_study(CURVES, "oil.inlet=80:120:10 degC", Path(sys.argv[1]), run={run}, workers=1, note=print)
print(found.completed, found.failed)
"""
NOTEBOOK = """
from rigdesign.base.worker_pool import ProcessWorkers
def double(number):
    return 2 * number
def computed(_):
    with ProcessWorkers(1) as workers:
        print(sum(outcome for _, outcome in workers.compute(double, [1, 2])), workers.remark)
"""
ANOTHER_POOL = """
from multiprocessing import Pool
if __name__ == "__main__":
    with Pool(1) as pool:
        pool.map(computed, [None])
"""


@pytest.mark.whole_run
@pytest.mark.parametrize(
    ("text", "ends", "noted"),
    [
        (UNGUARDED.format(run="curves"), "5 []", ""),
        (UNGUARDED.format(run="own"), "5 []", "does the script call this below if __name__"),
        (NOTEBOOK + "computed(None)", "6 ", "Can't get attribute 'double'"),
        (NOTEBOOK + ANOTHER_POOL, "6 ", "a pool that allows it none of its own"),
    ],
    ids=["unguarded script", "function of an unguarded script", "function of a notebook", "in another pool"],
)
def test_where_workers_cannot_compute_this_process_does(text, ends, noted, tmp_path):
    """Before, every point failed for an invented reason, in the ledger for ever."""
    (tmp_path / "script.py").write_text(text, encoding="utf-8")
    command = ["-c", text] if text.endswith("computed(None)") else [str(tmp_path / "script.py")]
    done = subprocess.run(
        [sys.executable, *command, str(tmp_path / "out")], env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, check=True, timeout=60,
    )  # fmt: skip
    assert done.stderr == "" and done.stdout.splitlines()[-1].startswith(ends)
    assert noted in done.stdout
    assert ("all is computed in this process, one after the other" in done.stdout) == bool(noted)
    assert noted or done.stdout.count("the script runs") == 1


def test_a_machine_without_room_for_processes_computes_in_this_one(monkeypatch):
    def refused(*arguments):
        raise BlockingIOError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(ProcessPoolExecutor, "submit", refused)
    with ProcessWorkers(2) as workers:
        assert dict(workers.compute(process_number, [None, None])) == dict.fromkeys(range(2), os.getpid())
        assert "Resource temporarily unavailable" in workers.remark


@pytest.mark.whole_run
def test_a_process_that_dies_while_it_waits_is_replaced():
    with ProcessWorkers(1) as workers:
        ((_, first),) = workers.compute(process_number, [None])
        assert first != os.getpid(), workers.remark
        os.kill(first, signal.SIGKILL)
        time.sleep(0.5)
        workers.open(process_number, [None])
        ((_, second),) = workers.compute(process_number, [None])
    assert second not in (first, os.getpid()) and not workers.remark


def dies(task):
    os._exit(9)


@pytest.mark.whole_run
def test_processes_that_no_longer_start_make_no_result(monkeypatch):
    """A task whose process died is only to blame if the next one would start."""
    with ProcessWorkers(1) as workers:
        workers.open(dies, [None])
        assert not workers.remark  # else this process would compute it, and die
        monkeypatch.setattr(worker_pool, "_ProcessPool", no_pool)
        with pytest.raises(LostWorkersError, match="no room"):
            list(workers.compute(dies, [None]))


def no_pool(count):
    raise OSError("no room")


def test_every_finished_point_is_counted(tmp_path):
    counts = []
    run_study(
        CURVES, VARY, tmp_path, run=curves, executor=InProcess(), count=lambda *told: counts.append(told)
    )
    assert [(done, whole) for done, whole, _ in counts] == [(number, 5) for number in range(1, 6)]
    assert counts[0][2] == "inlet 80 degC: fail"


def test_a_study_of_names_is_a_grid(tmp_path):
    run_study(CURVES, "oil.name=FVA 3,MIL-PRF-23699", tmp_path, run=curves, executor=InProcess())
    with (tmp_path / "results.csv").open(encoding="utf-8") as table:
        assert [row["oil.name"] for row in csv.DictReader(table)] == ["FVA 3", "MIL-PRF-23699"]


@pytest.mark.whole_run
def test_what_is_finished_when_another_process_dies_is_not_computed_again(tmp_path):
    """In a process of its own, as a study is."""
    subprocess.run([sys.executable, "-m", "tests.builders.dying_task", str(tmp_path)], check=True, cwd=ROOT)
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert sorted(found, key=lambda row: row[0]) == [[0, 0], [1, None], [2, 2]]
    assert len(list(tmp_path.glob("2-*"))) == 1
    assert len(list(tmp_path.glob("1-*"))) == 2


class OtherVersion(InProcess):
    """A worker of another version of the tool from the third point on."""

    count = 0

    def submit(self, work, /, *arguments, **keywords):
        future, self.count = super().submit(work, *arguments, **keywords), self.count + 1
        if self.count > 2:
            other = Future()
            other.set_result(replace(future.result(), version="0.0.9"))
            return other
        return future


def test_a_point_of_another_version_is_refused_and_those_before_stay(tmp_path):
    with pytest.raises(LostWorkersError, match=r"has rigdesign 0\.0\.9, .* 2 of 5 points are computed"):
        run_study(CURVES, VARY, tmp_path, run=curves, executor=OtherVersion())
    outcome = run_study(CURVES, VARY, tmp_path, run=curves, executor=InProcess())
    assert (outcome.completed, outcome.reused) == (3, 2)

"""Studies on a dask scheduler with workers on loopback: the same files, whatever becomes of the workers."""

import os
import re
import signal
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from rigdesign import api
from rigdesign.base import cluster as base_cluster
from rigdesign.base import worker_pool
from rigdesign.base.cluster import ClusterWorkers
from rigdesign.base.errors import MissingLibraryError, UsageError
from rigdesign.base.version import __version__
from rigdesign.base.worker_pool import LostWorkersError
from rigdesign.case import load_case
from rigdesign.studies.run import Execution
from tests.builders.commands import SMALL
from tests.builders.dask_cluster import NO_RIGDESIGN, OTHER_VERSION, cluster
from tests.builders.study import InProcess, run_study
from tests.builders.study_functions import CURVES, curves, deadly, slow

distributed = pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.whole_run,
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]

VARY = "oil.inlet=80:120:4 degC"
FILES = ("results.csv", "study.html", "study.svg")


def same_files(one: Path, other: Path) -> bool:
    return all((one / name).read_bytes() == (other / name).read_bytes() for name in FILES)


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory):
    with cluster(tmp_path_factory.mktemp("dask")) as running:
        yield running


@pytest.fixture
def dask(scheduler):
    """A scheduler without workers."""
    yield scheduler
    scheduler.stop_workers()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    out = tmp_path_factory.mktemp("undisturbed")
    run_study(CURVES, VARY, out, run=curves, executor=InProcess())
    return out


def processes(folder: Path, what: str) -> list[int]:
    """Process of every point that was begun, or ended."""
    return [int(path.name.split("-")[1]) for path in folder.glob(f"{what}-*")]


def amid_a_point(folder: Path, process: int) -> bool:
    ended = processes(folder, "ended").count(process)
    return processes(folder, "begun").count(process) > ended >= 1


def test_a_worker_killed_amid_its_point_costs_nothing(dask, undisturbed, tmp_path):
    trace = tmp_path / "trace"
    trace.mkdir()
    workers = [dask.add_worker("--no-nanny"), dask.add_worker("--no-nanny")]

    dask.await_workers()

    def kill():
        while not amid_a_point(trace, workers[0].pid):
            time.sleep(0.01)
        workers[0].send_signal(signal.SIGKILL)

    threading.Thread(target=kill, daemon=True).start()
    outcome = run_study(
        replace(CURVES, folder=str(trace)), VARY, tmp_path / "out", run=slow, workers=dask.address
    )
    assert workers[0].wait(timeout=20) == -signal.SIGKILL
    assert (outcome.completed, outcome.failed) == (11, [])
    assert set(processes(trace, "begun")) == {worker.pid for worker in workers}
    # one was cut short; a point whose result died with its worker is computed once more as well
    assert len(processes(trace, "begun")) == len(processes(trace, "ended")) + 1
    assert 12 <= len(processes(trace, "begun")) <= 13
    assert same_files(tmp_path / "out", undisturbed)


@pytest.mark.slow
def test_a_point_that_kills_every_worker_is_a_failed_point(dask, tmp_path):
    dask.add_worker()
    outcome = run_study(CURVES, "oil.inlet=90:110:10 degC", tmp_path, run=deadly, workers=dask.address)
    assert [point.failed for point in outcome.points] == [False, True, False]
    assert "the worker process died" in outcome.failed[0]
    with distributed.Client(dask.address, set_as_default=False) as client:
        again = run_study(CURVES, VARY, tmp_path / "given", run=deadly, executor=client.get_executor())
    assert [point.values["oil.inlet"] for point in again.points if point.failed] == ["100 degC"]


def test_a_study_whose_workers_are_all_gone_ends(dask, tmp_path, monkeypatch):
    monkeypatch.setattr(worker_pool, "LOOK_AFTER", 0.5)
    monkeypatch.setattr(base_cluster, "DESERTED_AFTER", 2.0)
    dask.add_worker("--no-nanny")
    with pytest.raises(
        LostWorkersError, match=r"has had no worker for 2 s; start some .* [01] of 3 points are computed"
    ):
        run_study(CURVES, "oil.inlet=90:110:10 degC", tmp_path, run=deadly, workers=dask.address)


def test_a_worker_of_several_threads_computes_one_point_at_a_time_and_says_so(dask, tmp_path):
    trace, notes = tmp_path / "trace", []
    trace.mkdir()
    dask.add_worker("--no-nanny", "--nthreads", "3")
    case = replace(CURVES, folder=str(trace))
    run_study(
        case, "oil.inlet=80:95:5 degC", tmp_path / "out", run=slow, workers=dask.address, note=notes.append
    )
    times = sorted((int(path.name.split("-")[2]), path.name[:5]) for path in trace.iterdir())
    assert [what for _, what in times] == ["begun", "ended"] * 4
    assert len(notes) == 1 and "--nthreads 1" in notes[0] and "1 of 1 workers" in notes[0]


@pytest.mark.parametrize(
    ("before", "named"), [(OTHER_VERSION, "has rigdesign 0.0.9"), (NO_RIGDESIGN, "has no rigdesign")]
)
def test_a_worker_that_would_compute_something_else_is_refused(dask, before, named, tmp_path):
    dask.add_worker("--no-nanny", before=before)
    with pytest.raises(UsageError) as refused:
        run_study(CURVES, VARY, tmp_path, run=curves, workers=dask.address)
    assert re.match(r"worker tcp://127\.0\.0\.1:\d+ ", str(refused.value)) and named in str(refused.value)
    assert f"install 'rigdesign[cluster]=={__version__}' there" in str(refused.value)


def test_a_scheduler_of_another_version_is_refused(tmp_path):
    with cluster(tmp_path, before=OTHER_VERSION) as other:
        other.add_worker("--no-nanny")
        with pytest.raises(UsageError, match=rf"scheduler {other.address} has rigdesign 0.0.9"):
            run_study(CURVES, VARY, tmp_path / "out", run=curves, workers=other.address)


def test_a_scheduler_without_workers_says_how_to_start_one(dask, tmp_path, monkeypatch):
    monkeypatch.setattr(base_cluster, "REACHED_WITHIN", 2.0)
    with pytest.raises(UsageError, match=f"'dask worker {dask.address} --nthreads 1'"):
        run_study(CURVES, VARY, tmp_path, run=curves, workers=dask.address)


def test_a_scheduler_that_is_not_there_is_named_soon_and_what_was_computed_stays(tmp_path):
    run_study(CURVES, "oil.inlet=80 degC,84 degC,88 degC", tmp_path, run=curves, executor=InProcess())
    began = time.monotonic()
    with pytest.raises(UsageError, match=r"no dask scheduler answers at tcp://127\.0\.0\.1:9 .*--workers 4"):
        run_study(CURVES, VARY, tmp_path, run=curves, workers="tcp://127.0.0.1:9")
    assert time.monotonic() - began < 20
    outcome = run_study(CURVES, VARY, tmp_path, run=curves, executor=InProcess())
    assert (outcome.completed, outcome.reused) == (8, 3)


def test_a_finished_study_needs_no_scheduler(undisturbed, tmp_path):
    outcome = run_study(CURVES, VARY, undisturbed, run=curves, workers="tcp://127.0.0.1:9")
    assert (outcome.completed, outcome.reused) == (0, 11)


def test_a_scheduler_lost_amid_a_study_ends_it_and_the_points_stay(tmp_path, monkeypatch):
    monkeypatch.setattr(worker_pool, "LOOK_AFTER", 1.0)
    monkeypatch.setattr(base_cluster, "SILENT_AFTER", 5.0)
    (tmp_path / "dask").mkdir()
    (tmp_path / "trace").mkdir()
    out = tmp_path / "out"
    with cluster(tmp_path / "dask") as lost:
        lost.add_worker("--no-nanny")

        def kill():
            while len(list((tmp_path / "trace").glob("ended-*"))) < 3:
                time.sleep(0.01)
            os.kill(lost.scheduler.pid, signal.SIGKILL)

        threading.Thread(target=kill, daemon=True).start()
        case = replace(CURVES, folder=str(tmp_path / "trace"))
        with pytest.raises(LostWorkersError, match="; the same command computes the other") as stopped:
            run_study(case, VARY, out, run=slow, workers=lost.address)
    assert lost.address in str(stopped.value)
    stored = int(re.search(r"(\d+) of 11 points are computed", str(stopped.value))[1])
    outcome = run_study(CURVES, VARY, out, run=curves, executor=InProcess())
    assert 1 <= stored < 11 and outcome.reused == stored


@pytest.mark.slow
def test_a_real_case_on_a_cluster_equals_worker_processes_to_the_byte(dask, write, tmp_path):
    case = load_case(write(SMALL))
    vary = [
        "gearboxes.test.oil.inlet_temperature=90 degC,120 degC",
        "gearboxes.test.oil.flow=3:7:2 l/min",
    ]
    for name, workers in (("here", 2), ("there", dask.address)):
        if name == "there":
            dask.add_worker("--no-nanny")
            dask.add_worker("--no-nanny", "--nthreads", "2")
        outcome = api.study(
            case, vary, tmp_path / name, fidelity="quick", execution=Execution(workers=workers)
        )
        assert (outcome.completed, outcome.failed) == (6, [])
    assert same_files(tmp_path / "here", tmp_path / "there")
    values = {tuple(check["value"] for check in point.record["checks"]) for point in outcome.points}
    assert len(values) > 1


@pytest.mark.parametrize("text", ["four", "host:8786", "http://host:8786", "tcp://host", "-"])
def test_workers_that_are_neither_a_number_nor_an_address(text):
    with pytest.raises(UsageError, match="write --workers 4 or --workers tcp://host:8786"):
        ClusterWorkers(text)


def test_without_dask_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(MissingLibraryError, match=r"pip install 'rigdesign\[cluster\]'"):
        ClusterWorkers("tcp://127.0.0.1:8786")

"""Works in forked copies: the same results, the same errors, nothing left running."""

import os
import signal
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base import parallel
from rigdesign.base.output_folder import FileLock
from rigdesign.base.parallel import BackgroundTasks

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")


def waves(n: int) -> np.ndarray:
    """Some megabytes, far more than a pipe holds."""
    return np.sin(np.arange(n) * 0.1)


@pytest.mark.parametrize("count", [1, 2])
def test_results_come_in_order_and_are_those_computed_here(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parallel, "cores", lambda: count)
    with BackgroundTasks([partial(waves, 400_000), os.getpid, partial(waves, 3)]) as works:
        first, process, last = works.results()
    assert np.array_equal(first, waves(400_000)) and np.array_equal(last, waves(3))
    assert (process == os.getpid()) == (count == 1 or not hasattr(os, "fork"))


class TwoPartError(RuntimeError):
    """An error that cannot be sent: it takes two arguments and passes on one."""

    def __init__(self, message: str, history: tuple[float, ...]) -> None:
        super().__init__(message)
        self.history = history


def fails() -> None:
    raise TwoPartError("no result", (1.0, 0.5))


@pytest.mark.parametrize("count", [1, 2])
def test_an_error_of_a_work_is_raised_here_in_full(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "cores", lambda: count)
    with pytest.raises(TwoPartError, match="no result") as caught, BackgroundTasks([fails]) as works:
        works.results()
    assert caught.value.history == (1.0, 0.5)


@needs_fork
def test_a_copy_that_dies_is_replaced_by_work_done_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "cores", lambda: 2)
    here = os.getpid()

    def dies_elsewhere() -> int:
        if os.getpid() != here:
            os._exit(9)
        return 7

    with BackgroundTasks([dies_elsewhere]) as works:
        assert works.results() == [7]


@needs_fork
def test_leaving_early_ends_the_copies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "cores", lambda: 2)
    trace = tmp_path / "late"

    def late() -> None:
        time.sleep(1.5)
        trace.touch()

    began = time.perf_counter()
    with pytest.raises(KeyError), BackgroundTasks([late]):
        raise KeyError
    assert time.perf_counter() - began < 1.4
    time.sleep(1.6)
    assert not trace.exists()


def open_files() -> list[str]:
    return [str(path.readlink()) for path in Path("/proc/self/fd").iterdir() if path.is_symlink()]


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="this system does not say what is open")
def test_a_copy_holds_no_lock_of_its_parent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "cores", lambda: 2)
    path = tmp_path / "lock"
    with FileLock(path), BackgroundTasks([open_files, open_files]) as works:
        assert str(path) in open_files()
        assert all(str(path) not in files for files in works.results())


@needs_fork
def test_copies_work_where_the_system_reaps_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """A parent that ignores SIGCHLD hands that on; nobody can wait for a copy then."""
    monkeypatch.setattr(parallel, "cores", lambda: 2)
    before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    try:
        with BackgroundTasks([os.getpid, os.getpid]) as works:
            assert os.getpid() not in works.results()
        with BackgroundTasks([partial(time.sleep, 9.0)]):
            pass
    finally:
        signal.signal(signal.SIGCHLD, before)


@needs_fork
def test_a_machine_that_allows_no_more_processes_leaves_the_work_here(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refused() -> int:
        raise BlockingIOError("Resource temporarily unavailable")

    monkeypatch.setattr(parallel, "cores", lambda: 2)
    monkeypatch.setattr(os, "fork", refused)
    with BackgroundTasks([os.getpid, os.getpid]) as works:
        assert works.results() == [os.getpid()] * 2

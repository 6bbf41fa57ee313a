"""Works in forked copies: the same results, the same errors, nothing left running."""

import os
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base import parallel
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

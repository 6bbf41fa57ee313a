"""Worker processes of a study: one thread each, none outlives its parent, a dying one costs one point."""

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.connection import wait
from typing import TypeVar

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "BLIS_NUM_THREADS"),
    "1",
)


def compute_all(
    work: Callable[[Task], Outcome], tasks: Sequence[Task], workers: int
) -> Iterator[tuple[int, Outcome | None]]:
    """Compute every task in a pool of processes and give (index, outcome) as they finish.

    The outcome is None for a task whose process died (killed, out of memory, crash in a compiled library).
    Tasks start in their order, so one of the first ``workers`` unsettled ones did it: they are computed again
    alone, one by one, and the pool goes on with the rest.
    ``work`` and the tasks must be picklable; ``work`` must not raise.
    """
    with _one_thread_each():
        unsettled = list(range(len(tasks)))
        while unsettled:
            try:
                for index, outcome in _pool(work, tasks, tuple(unsettled), workers):
                    unsettled.remove(index)
                    yield index, outcome
            except BrokenProcessPool:
                under_way, unsettled = unsettled[:workers], unsettled[workers:]
                for index in under_way:
                    yield index, _alone(work, tasks, index)


def _alone(work: Callable[[Task], Outcome], tasks: Sequence[Task], index: int) -> Outcome | None:
    try:
        return next(outcome for _, outcome in _pool(work, tasks, [index], 1))
    except BrokenProcessPool:
        return None


def _pool(
    work: Callable[[Task], Outcome], tasks: Sequence[Task], indices: Sequence[int], workers: int
) -> Iterator[tuple[int, Outcome]]:
    others = set(active_children())
    count = max(1, min(workers, len(indices)))
    pool = ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=_begin_worker)
    try:
        futures: dict[Future[Outcome], int] = {pool.submit(work, tasks[index]): index for index in indices}
        for future in as_completed(futures):
            yield futures[future], future.result()
        pool.shutdown()
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in set(active_children()) - others:
            process.terminate()
        raise


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Environment that the workers inherit: they read it when they import numpy and numba."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _begin_worker() -> None:
    """Leave interrupts to the parent, and end when it ends, even by SIGKILL."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)

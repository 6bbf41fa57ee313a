"""Worker processes of a study: one thread each, none outlives its parent, a dying one costs one point."""

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from typing import TypeVar

from rigdesign.base.errors import UsageError

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "BLIS_NUM_THREADS"),
    "1",
)


def worker_count(workers: int | None) -> int:
    """The number of workers asked for, or one for each core this process may use.

    Raises
    ------
    UsageError
        A number below 1.
    """
    if workers is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if workers < 1:
        raise UsageError(f"workers = {workers}: at least 1 is needed; leave --workers out for one per core")
    return workers


def compute_all(
    work: Callable[[Task], Outcome], tasks: Sequence[Task], workers: int
) -> Iterator[tuple[int, Outcome | None]]:
    """Compute every task in a pool of processes and give (index, outcome) as they finish.

    The outcome is None for a task whose process died (killed, out of memory, crash in a compiled library).
    Tasks start in their order, so one of the first ``workers`` unfinished ones did it: they are computed again
    alone, one by one, and the pool goes on with the rest.
    ``work`` and the tasks must be picklable; ``work`` must not raise.
    """
    with _one_thread_each():
        unfinished = list(range(len(tasks)))
        while unfinished:
            try:
                for index, outcome in _pool(work, tasks, tuple(unfinished), workers):
                    unfinished.remove(index)
                    yield index, outcome
            except BrokenProcessPool:
                under_way, unfinished = unfinished[:workers], unfinished[workers:]
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
    """Compute in fresh processes; they end when their lifeline closes, so none outlives a pool left early."""
    context = get_context("spawn")
    end_of_workers, end_of_parent = context.Pipe(duplex=False)
    pool = ProcessPoolExecutor(
        max(1, min(workers, len(indices))),
        mp_context=context,
        initializer=_begin_worker,
        initargs=(end_of_workers,),
    )
    try:
        with _interrupts_held():
            futures: dict[Future[Outcome], int] = {
                pool.submit(work, tasks[index]): index for index in indices
            }
        for future in as_completed(futures):
            yield futures[future], future.result()
        pool.shutdown()
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    finally:
        end_of_parent.close()
        end_of_workers.close()


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Interrupts wait, and processes started meanwhile never see one: they would print a traceback while they load.

    The mask is for the processes, which inherit it. Here it holds for one thread only: another one, of a linear
    algebra library, may take the signal, and Python then runs its handler in the main thread all the same.
    """
    if not hasattr(signal, "pthread_sigmask") or threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda number, frame: held.append(number))
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        signal.signal(signal.SIGINT, signal.SIG_DFL if handler is None else handler)
        if held:
            signal.raise_signal(signal.SIGINT)


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


def _begin_worker(lifeline: Connection) -> None:
    """Leave interrupts to the parent, and end when the lifeline does: closed, or its holder dead by SIGKILL."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with, args=(lifeline,), daemon=True).start()


def _end_with(lifeline: Connection) -> None:
    wait([lifeline])
    os._exit(1)

"""Work on other cores and machines, through any `concurrent.futures.Executor`.

The pool of this module: processes of one thread each, none outlives its parent, a dying one costs one task. Where they
cannot start or cannot load what they are to compute, it is computed in this process.
"""

import os
import pickle
import sys
from collections.abc import Callable, Collection, Generator, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager, nullcontext
from itertools import islice
from multiprocessing import current_process, get_context
from types import ModuleType, TracebackType
from typing import Self, TypeVar

from rigdesign.base.errors import UsageError
from rigdesign.base.parallel import BLAS_THREADS, begin_child, granted_cores, stops_held

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")

ONE_THREAD = dict.fromkeys((*BLAS_THREADS, "NUMBA_NUM_THREADS"), "1")
IN_FLIGHT = 256
"""Tasks handed to an executor and not finished: enough for its workers, little in the memory of a scheduler."""
DIED = "the worker process died; look for a lack of memory"
"""Said of a task whose outcome is None."""
LOOK_AFTER = 5.0
"""Time without a finished task after which the executor is looked at [s]."""


class LostWorkersError(UsageError):
    """Workers that are gone, all of them, before the work is done."""


def worker_count(workers: int | None) -> int:
    """The number of workers asked for, or one for each core this process may use.

    Raises
    ------
    UsageError
        A number below 1.
    """
    if workers is None:
        return granted_cores()
    if workers < 1:
        raise UsageError(f"workers = {workers}: at least 1 is needed; leave --workers out for one per core")
    return workers


class _NoWorkersError(LostWorkersError):
    """Processes of this machine that do not start, or cannot load what they are to compute."""


class Workers:
    """Computes tasks on an executor. A context manager.

    Parameters
    ----------
    executor : any; it is not shut down here
    """

    def __init__(self, executor: Executor) -> None:
        self._executor = executor
        self._lost = _lost_worker(executor)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close(at_once=kind is not None)

    def __str__(self) -> str:
        return f"workers of {type(self._executor).__name__}"

    def open(self, work: Callable[[Task], Outcome], tasks: Sequence[Task]) -> None:
        """Reach the workers for these tasks; called before they are computed."""

    @property
    def remark(self) -> str:
        """What the user should know of the workers; empty if nothing."""
        return ""

    def close(self, *, at_once: bool = False) -> None:
        """End what this object started; ``at_once``: without waiting for what is being computed."""

    def compute(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task]
    ) -> Generator[tuple[int, Outcome | None], None, None]:
        """Compute every task and give (index, outcome) as they finish; None for a task whose worker died.

        A cluster suspects all tasks that a dying worker held: they are computed again at the end, one at a time.
        ``work`` and the tasks must be picklable; ``work`` must not raise.

        Raises
        ------
        LostWorkersError
            If the executor ends before the work is done.
        """
        suspected = []
        try:
            for index, outcome in self._submitted(self._executor, work, tasks, range(len(tasks))):
                if outcome is None:
                    suspected.append(index)
                else:
                    yield index, outcome
            for index in suspected:
                yield from self._submitted(self._executor, work, tasks, [index])
        except (BrokenExecutor, CancelledError) as error:
            raise LostWorkersError(
                f"{self} ended before the work was done ({type(error).__name__}: {error}); start them again"
            ) from error

    def _submitted(
        self,
        executor: Executor,
        work: Callable[[Task], Outcome],
        tasks: Sequence[Task],
        indices: Sequence[int],
    ) -> Generator[tuple[int, Outcome | None], None, None]:
        """The tasks of ``indices`` in their order, never more than `IN_FLIGHT` of them handed over."""
        waiting = iter(indices)
        pending: dict[Future[Outcome], int] = {}
        try:
            while True:
                with self._starting():
                    for index in islice(waiting, IN_FLIGHT - len(pending)):
                        pending[executor.submit(work, tasks[index])] = index
                if not pending:
                    return
                done, _ = wait(pending, LOOK_AFTER, FIRST_COMPLETED)
                if not done:
                    self._look()
                # what is finished goes first: a broken pool raises for the others
                for future in sorted(
                    done, key=lambda future: (future.exception() is not None, pending[future])
                ):
                    yield pending.pop(future), self._outcome(future)
        finally:
            self._withdraw(pending)

    def _withdraw(self, pending: Collection[Future[Outcome]]) -> None:
        """Take back tasks whose outcome nobody waits for any more."""
        for future in pending:
            future.cancel()

    def _outcome(self, future: Future[Outcome]) -> Outcome | None:
        try:
            return future.result()
        except self._lost:
            return None

    def _starting(self) -> AbstractContextManager[None]:
        """Holds while tasks are handed over."""
        return nullcontext()

    def _look(self) -> None:
        """Raise if the workers are gone; called when nothing has finished for a while."""


def _lost_worker(executor: Executor) -> tuple[type[BaseException], ...]:
    """What a future of an executor raises whose worker died again and again, where the others go on."""
    if not type(executor).__module__.startswith("distributed."):
        return ()
    from distributed import KilledWorker

    return (KilledWorker,)


class ProcessWorkers(Workers):
    """Processes on this machine, one thread each, started when they are needed and kept from call to call.

    They prove that they start and load the tasks before they get one; where they do not, this process computes.
    Tasks start in their order, so when a process dies (killed, out of memory, crash in a compiled library) one of
    the first ``count`` unfinished ones did it: they are computed again alone, one by one, and new processes go on
    with the rest.
    """

    _lost = ()

    def __init__(self, count: int) -> None:
        if getattr(current_process(), "_inheriting", False):
            sys.exit(1)  # in a worker that runs the user's script to load a task, which leads here once more
        self.size = count
        self._pool: _ProcessPool | None = None
        self._refused = ""

    def __str__(self) -> str:
        return f"{self.size} worker process{'es' if self.size > 1 else ''}"

    @property
    def remark(self) -> str:
        """Why this process computes, if it does."""
        return self._refused and f"{self._refused}; all is computed in this process, one after the other"

    def open(self, work: Callable[[Task], Outcome], tasks: Sequence[Task]) -> None:
        """Start the processes and let each load a task."""
        try:
            self._pool, self._refused = self._proven(self._pool, self.size, work, tasks[0]), ""
        except _NoWorkersError as error:
            self._pool, self._refused = None, str(error)

    def close(self, *, at_once: bool = False) -> None:
        """End the processes."""
        if self._pool is not None:
            self._pool.end(at_once=at_once)
            self._pool = None

    def compute(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task]
    ) -> Generator[tuple[int, Outcome | None], None, None]:
        """As of `Workers`; the outcome is None only for a task that kills a process of its own.

        Raises
        ------
        LostWorkersError
            If processes that could start cannot any more.
        """
        unfinished = list(range(len(tasks)))
        if unfinished and self._pool is None:
            self.open(work, tasks)
        if self._refused:
            yield from ((index, work(task)) for index, task in enumerate(tasks))
            return
        while unfinished:
            self._pool = self._pool or self._proven(None, self.size, work, tasks[0])
            try:
                for index, outcome in self._submitted(self._pool.executor, work, tasks, tuple(unfinished)):
                    unfinished.remove(index)
                    yield index, outcome
            except BrokenProcessPool:
                self.close(at_once=True)
                under_way, unfinished = unfinished[: self.size], unfinished[self.size :]
                for index in under_way:
                    yield index, self._alone(work, tasks, index)

    def _proven(
        self, pool: "_ProcessPool | None", count: int, work: Callable[[Task], Outcome], task: Task
    ) -> "_ProcessPool":
        """The pool, or a new one, after an empty task for each of its processes that loads ``work`` and ``task``."""
        if current_process().daemon:
            raise _NoWorkersError("this process is a worker of a pool that allows it none of its own")
        try:
            sent = pickle.dumps((work, task))
        except Exception as error:  # whatever the classes of the user raise
            raise _NoWorkersError(f"worker processes cannot compute this ({error})") from error
        started = pool
        try:
            started = started or _ProcessPool(count)
            with self._starting(), nullcontext() if b"__main__" in sent else _script_hidden():
                loading = [started.executor.submit(_fault, sent) for _ in range(count)]
            fault = next(filter(None, [future.result() for future in loading]), "")
            if not fault:
                proven, started = started, None
                return proven
        except BrokenProcessPool:
            if pool is not None:  # a process died while nothing was computed
                return self._proven(None, count, work, task)
            fault = "they end while they start; does the script call this below if __name__ == '__main__'?"
        except (OSError, ImportError, NotImplementedError) as error:  # no process, semaphore or memory left
            fault = str(error)
        finally:
            if started is not None:
                started.end(at_once=True)
        raise _NoWorkersError(f"worker processes cannot compute this ({fault})")

    def _withdraw(self, pending: Collection[Future[Outcome]]) -> None:
        """End the processes with their tasks.

        A future cancelled here while its process dies raises in the thread of the pool, which then ends nothing.
        """
        if pending:
            self.close(at_once=True)

    def _alone(self, work: Callable[[Task], Outcome], tasks: Sequence[Task], index: int) -> Outcome | None:
        pool = self._proven(None, 1, work, tasks[index])
        try:
            return next(outcome for _, outcome in self._submitted(pool.executor, work, tasks, [index]))
        except BrokenProcessPool:
            return None
        finally:
            pool.end(at_once=True)

    @contextmanager
    def _starting(self) -> Iterator[None]:
        with _one_thread_each(), stops_held():
            yield


class _ProcessPool:
    """Fresh processes; they end when their lifeline closes, so none outlives a pool left early."""

    def __init__(self, count: int) -> None:
        context = get_context("spawn")
        self._end_of_workers, self._end_of_parent = context.Pipe(duplex=False)
        self.executor = ProcessPoolExecutor(
            count, mp_context=context, initializer=begin_child, initargs=(self._end_of_workers,)
        )

    def end(self, *, at_once: bool) -> None:
        """Stop the processes and wait for their end; ``at_once``: what they compute is lost.

        An interrupt waits until it is done.
        """
        with stops_held():
            if not at_once:
                self.executor.shutdown()
            for process in dict(self.executor._processes or {}).values():
                process.kill()  # compiled code would not let it see the end of the lifeline
            self._end_of_parent.close()
            self._end_of_workers.close()
            self.executor.shutdown(cancel_futures=True)


def compute_all(
    work: Callable[[Task], Outcome], tasks: Sequence[Task], workers: int, remark: Callable[[str], None]
) -> Generator[tuple[int, Outcome | None], None, None]:
    """Compute every task in processes of this machine, as `ProcessWorkers.compute`; ``remark``: see `Workers`."""
    with ProcessWorkers(min(workers, max(1, len(tasks)))) as pool:
        if tasks:
            pool.open(work, tasks)
            if pool.remark:
                remark(pool.remark)
        yield from pool.compute(work, tasks)


def _fault(sent: bytes) -> str:
    """In a worker: why it cannot load work and task; empty if it can."""
    try:
        pickle.loads(sent)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


@contextmanager
def _script_hidden() -> Iterator[None]:
    """Processes started meanwhile do not run the user's script again, of which they need nothing."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


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

"""Work on the other cores: computations that need nothing of each other, in a forked copy of this process a core.

A copy starts with everything that was computed before, so nothing is packed up but the result, and it computes the
same bits as this process would. Where there is no fork or no core to spare, and where a copy fails, the work is
done here when its result is asked for, and raises here what it raises. Only work without compiled threads may be
given away: a copy has none of the threads of its parent.
"""

import os
import pickle
import signal
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import parent_process
from typing import BinaryIO, Generic, Self, TypeVar

T = TypeVar("T")


_taken = False
"""Whether the other cores have work of their own, see `one_core`."""


@contextmanager
def one_core() -> Iterator[None]:
    """For a point of a study in a process that is no child of ours, such as a worker of a cluster: no copies."""
    global _taken
    before, _taken = _taken, True
    try:
        yield
    finally:
        _taken = before


def granted_cores() -> int:
    """Cores that the machine grants this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def cores() -> int:
    """Cores this process may use for copies; one in a worker process, whose pool already uses the others."""
    if _taken or parent_process() is not None or not hasattr(os, "fork"):
        return 1
    return granted_cores()


@dataclass(frozen=True)
class _Copy:
    process: int
    pipe: BinaryIO


class BackgroundTasks(Generic[T]):
    """Starts the works, a share of them on each core; `results` waits for them, `end` stops what still runs."""

    def __init__(self, works: Sequence[Callable[[], T]]) -> None:
        self._works = tuple(works)
        count = min(cores(), len(self._works))
        shares = [self._works[number::count] for number in range(count)] if cores() > 1 else []
        self._copies = [_fork(share) for share in shares]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    @property
    def running(self) -> bool:
        """Whether other cores are computing; not after `results`."""
        return bool(self._copies)

    def end(self) -> None:
        """Stop the copies that are left."""
        for copy in self._copies:
            copy.pipe.close()
            with suppress(ProcessLookupError):
                os.kill(copy.process, signal.SIGKILL)
            os.waitpid(copy.process, 0)
        self._copies = []

    def results(self) -> list[T]:
        """Results in the order of the works; raises what a work raises."""
        if not self._copies:
            return [work() for work in self._works]
        count = len(self._copies)
        shares = [self._received(self._works[number::count]) for number in range(count)]
        return [shares[place % count][place // count] for place in range(len(self._works))]

    def _received(self, works: Sequence[Callable[[], T]]) -> list[T]:
        """What the first of the remaining copies sends; done here if that is nothing."""
        copy = self._copies[0]
        with copy.pipe:
            sent = copy.pipe.read()
        _, status = os.waitpid(copy.process, 0)
        del self._copies[0]
        if status != 0:
            return [work() for work in works]
        results: list[T] = pickle.loads(sent)
        return results


def _fork(works: Sequence[Callable[[], object]]) -> _Copy:
    reading, writing = os.pipe()
    with warnings.catch_warnings():
        # Python 3.12 warns of the threads of compiled libraries, which the works do not use
        warnings.simplefilter("ignore", DeprecationWarning)
        process = os.fork()
    if process:
        os.close(writing)
        return _Copy(process, os.fdopen(reading, "rb"))
    status = 1
    try:
        os.close(reading)
        sent = pickle.dumps([work() for work in works], protocol=pickle.HIGHEST_PROTOCOL)
        with os.fdopen(writing, "wb") as pipe:
            pipe.write(sent)
        status = 0
    finally:
        # what went wrong shows when the parent does the work again
        os._exit(status)

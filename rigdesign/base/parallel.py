"""Work on the other cores: computations that need nothing of each other, in a forked copy of this process a core.

A copy starts with everything that was computed before, so nothing is packed up but the result, and it computes the
same bits as this process would. Where there is no fork or no core to spare, and where a copy fails, the work is
done here when its result is asked for, and raises here what it raises. Only work without compiled threads may be
given away: a copy has none of the threads of its parent. No copy outlives its parent, however that ends.
"""

import ctypes
import os
import pickle
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import connection, parent_process
from multiprocessing.connection import Connection
from typing import BinaryIO, Generic, NoReturn, Self, TypeVar

T = TypeVar("T")

STOPS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)  # Windows knows no hang-up
"""Signals that ask a command to end."""
BLAS_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS")
"""Environment variables of the threads of linear algebra, read when numpy loads."""
LENGTH = 8
"""Bytes of the length that a copy sends before its results: a copy that dies may have sent a part."""
_PR_SET_PDEATHSIG = 1

_taken = False
"""Whether the other cores have work of their own, see `one_core`."""
_lifeline: tuple[int, int] | None = None
"""Pipe to which nobody writes: it closes in the copies of this process when this process ends."""


def one_blas_thread() -> dict[str, str]:
    """Environment for a process of our own before numpy loads; empty where the user has said how many threads.

    The matrices are small: more threads wait for each other. In a process of the user each call limits them instead.
    """
    return {} if any(name in os.environ for name in BLAS_THREADS) else dict.fromkeys(BLAS_THREADS, "1")


@contextmanager
def one_core() -> Iterator[None]:
    """No copies: for a point of a study in a process that is no child of ours, such as a worker of a cluster, and while
    the other cores are at a long work of this one."""
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
        self._copies = _forked(shares)

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
        _stop(self._copies)
        self._copies = []

    def results(self) -> list[T]:
        """Results in the order of the works; raises what a work raises."""
        if not self._copies:
            return [work() for work in self._works]
        count = len(self._copies)
        shares = [self._received(self._works[number::count]) for number in range(count)]
        return [shares[place % count][place // count] for place in range(len(self._works))]

    def _received(self, works: Sequence[Callable[[], T]]) -> list[T]:
        """What the first of the remaining copies sends; done here if that is not all."""
        copy = self._copies[0]
        with copy.pipe:
            sent = copy.pipe.read()
        _reap(copy)
        del self._copies[0]
        if int.from_bytes(sent[:LENGTH]) != len(sent) - LENGTH:
            return [work() for work in works]
        results: list[T] = pickle.loads(sent[LENGTH:])
        return results


def _stop(copies: Sequence[_Copy]) -> None:
    for copy in copies:
        copy.pipe.close()
        with suppress(ProcessLookupError):
            os.kill(copy.process, signal.SIGKILL)
        _reap(copy)


def _reap(copy: _Copy) -> None:
    """Wait for the end of a copy; where SIGCHLD is ignored, the system has done it already."""
    with suppress(ChildProcessError):
        os.waitpid(copy.process, 0)


def _forked(shares: Sequence[Sequence[Callable[[], object]]]) -> list[_Copy]:
    """A copy for each share, or none where the machine allows no more processes."""
    copies: list[_Copy] = []
    try:
        copies.extend(map(_fork, shares))
    except OSError:
        _stop(copies)
        return []
    return copies


def _fork(works: Sequence[Callable[[], object]]) -> _Copy:
    global _lifeline
    _lifeline = _lifeline or os.pipe()
    reading, writing = os.pipe()
    with warnings.catch_warnings(), stops_held():
        # Python 3.12 warns of the threads of compiled libraries, which the works do not use
        warnings.simplefilter("ignore", DeprecationWarning)
        process = os.fork()
        if process == 0:
            _compute_copy(works, reading, writing)
    os.close(writing)
    return _Copy(process, os.fdopen(reading, "rb"))


def _compute_copy(works: Sequence[Callable[[], object]], reading: int, writing: int) -> NoReturn:
    """What a copy does: compute, send, end; what went wrong shows when the parent does the work again."""
    global _lifeline
    status = 1
    try:
        assert _lifeline is not None
        (watched, write_end), _lifeline = _lifeline, None
        os.close(write_end)
        os.close(reading)
        begin_child(watched)
        sent = pickle.dumps([work() for work in works], protocol=pickle.HIGHEST_PROTOCOL)
        with os.fdopen(writing, "wb") as pipe:
            pipe.write(len(sent).to_bytes(LENGTH) + sent)
        status = 0
    finally:
        os._exit(status)


def begin_child(lifeline: Connection | int) -> None:
    """In a process that works for another one: leave Ctrl-C to the parent and end with it, even when it is killed.

    lifeline : end of a pipe whose other end only the parent holds; Linux needs no look at it
    """
    leave_interrupts()
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPS)
    if sys.platform == "linux":  # also while compiled code lets no thread of Python run
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    threading.Thread(target=_end_with, args=(lifeline,), daemon=True).start()


def leave_interrupts() -> None:
    """Ignore Ctrl-C from here on; the other signals that end a command do it at once."""
    for number in STOPS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, signal.SIG_IGN if number == signal.SIGINT else signal.SIG_DFL)


def _end_with(lifeline: Connection | int) -> None:
    connection.wait([lifeline])
    os._exit(1)


@contextmanager
def stops_held() -> Iterator[None]:
    """Signals that end a command wait; processes started meanwhile do not see them before they are ready.

    The mask is for the processes, which inherit it. Here it holds for one thread only: another one, of a linear
    algebra library, may take the signal, and Python then runs its handler in the main thread all the same.
    """
    if not hasattr(signal, "pthread_sigmask") or threading.current_thread() is not threading.main_thread():
        yield
        return
    signals: list[int] = []
    handlers = {number: signal.getsignal(number) for number in STOPS}
    for number, handler in handlers.items():
        if handler != signal.SIG_IGN:
            signal.signal(number, lambda number, frame: signals.append(number))
    before = signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        for number, handler in handlers.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
        for number in signals[:1]:
            signal.raise_signal(number)

"""Workers of a dask cluster, by the address of its scheduler: reached, asked what they are, used as an executor."""

import logging
import re
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from rigdesign.base.errors import MissingLibraryError, UsageError, shortened
from rigdesign.base.version import __version__
from rigdesign.base.worker_pool import LostWorkersError, Outcome, Task, Workers

if TYPE_CHECKING:
    from concurrent.futures import Future

    from distributed import Client

ADDRESS = re.compile(r"(tcp|tls|ws|wss|ucx)://\S+:\d+")
EXAMPLE = "tcp://host:8786"
REACHED_WITHIN = 8.0
"""Time a scheduler has to answer, and then to have a worker [s]."""
SILENT_AFTER = 30.0
"""Time a scheduler in use has to answer before it counts as lost [s]."""
LOGGERS = ("distributed", "tornado.application")
"""Report what dask retries on its own; what matters of it is raised."""
DESERTED_AFTER = 120.0
"""Time without any worker after which nobody is expected to come [s]."""
ASKED_VERSION = (
    "__import__('importlib').import_module('rigdesign.base.version').__version__ "
    "if __import__('importlib.util').util.find_spec('rigdesign') else ''"
)
"""What a process evaluates to say which rigdesign it has: it must not need rigdesign to read the question."""


class ClusterWorkers(Workers):
    """The workers of a dask scheduler; they may come and go, a task whose worker dies is given to another one.

    Parameters
    ----------
    address : of the scheduler, ``tcp://host:8786``

    Raises
    ------
    UsageError
        A text that is no address.
    MissingLibraryError
        If dask is not installed.
    """

    def __init__(self, address: str) -> None:
        if not ADDRESS.fullmatch(address):
            raise UsageError(
                f"--workers {shortened(address)}: neither a number of processes nor the address of a scheduler; "
                f"write --workers 4 or --workers {EXAMPLE}"
            )
        try:
            import distributed  # noqa: F401
        except ImportError as error:
            raise MissingLibraryError(
                f"--workers {address}: the workers of a cluster need dask; run: pip install 'rigdesign[cluster]'"
            ) from error
        self._address = address
        self._client: Client | None = None
        self._threads: Mapping[str, int] = {}
        self._deserted: float | None = None
        self._levels = {logger: logger.level for logger in map(logging.getLogger, LOGGERS)}

    def __str__(self) -> str:
        return f"workers of {self._address}"

    def open(self, work: Callable[[Task], Outcome], tasks: Sequence[Task]) -> None:
        """Reach the scheduler and ask its workers what they are.

        Raises
        ------
        UsageError
            A scheduler that does not answer, one without workers, a scheduler or worker with another version of
            rigdesign or with none.
        """
        if self._client is None:
            for logger in self._levels:
                logger.setLevel(logging.CRITICAL)
            self._client = _connected(self._address)
            _check(self._client, self._address)
            self._threads = self._client.nthreads()
            super().__init__(self._client.get_executor(pure=False))

    @property
    def remark(self) -> str:
        """Workers that cannot use their threads."""
        several = [address for address, threads in self._threads.items() if threads > 1]
        if not several:
            return ""
        return (
            f"{len(several)} of {len(self._threads)} workers have more than one thread ({several[0]}: "
            f"{self._threads[several[0]]}), and a worker computes one point at a time; start them with "
            "--nworkers CORES --nthreads 1"
        )

    def close(self, *, at_once: bool = False) -> None:
        """Leave the cluster, which goes on without us; tasks handed over are withdrawn."""
        if self._client is not None:
            with suppress(Exception):
                self._client.close(timeout=1.0 if at_once else 5.0)
        if not at_once:  # else tasks that are withdrawn still report
            for logger, level in self._levels.items():
                logger.setLevel(level)

    def _outcome(self, future: "Future[Outcome]") -> Outcome | None:
        """As of `Workers`; a task that cannot be loaded met a worker that joined with another rigdesign, or none."""
        try:
            return super()._outcome(future)
        except (ImportError, AttributeError) as error:
            raise LostWorkersError(
                f"a worker of {self._address} that joined after the start cannot load the task "
                f"({_first_line(error)}); install 'rigdesign[cluster]=={__version__}' there and start it again"
            ) from error

    def _look(self) -> None:
        """Ask the scheduler for a sign of life, and for its workers."""
        assert self._client is not None
        try:
            if self._client.status != "running":
                raise OSError(f"the connection is {self._client.status}")
            scheduler = self._client.sync(self._client.scheduler.identity, callback_timeout=SILENT_AFTER)
        except Exception as error:
            raise LostWorkersError(
                f"scheduler {self._address} is lost ({error or type(error).__name__}); start it again with its workers"
            ) from error
        if scheduler["workers"]:
            self._deserted = None
            return
        self._deserted = self._deserted or time.monotonic()
        if time.monotonic() - self._deserted > DESERTED_AFTER:
            raise LostWorkersError(
                f"scheduler {self._address} has had no worker for {DESERTED_AFTER:g} s; start some with 'dask worker "
                f"{self._address} --nthreads 1'"
            )


def _connected(address: str) -> "Client":
    from distributed import Client

    try:
        return Client(address, timeout=REACHED_WITHIN, set_as_default=False)
    except Exception as error:  # of the network, or of a service there that speaks something else
        raise UsageError(
            f"no dask scheduler answers at {address} within {REACHED_WITHIN:g} s ({_first_line(error)}); start it "
            "with 'dask scheduler', or compute here with --workers 4"
        ) from error


def _check(client: "Client", address: str) -> None:
    """Raise for a cluster that cannot compute the points that this process would compute."""
    try:
        client.wait_for_workers(1, timeout=REACHED_WITHIN)
    except TimeoutError as error:
        raise UsageError(
            f"scheduler {address} has no workers; start some with 'dask worker {address} --nthreads 1'"
        ) from error
    _require("scheduler", {address: client.run_on_scheduler(eval, ASKED_VERSION)})
    _require("worker", client.run(eval, ASKED_VERSION, on_error="return"))


def _require(role: str, versions: Mapping[str, object]) -> None:
    other = {address: version for address, version in versions.items() if version != __version__}
    if not other:
        return
    address, version = next(iter(other.items()))
    if isinstance(version, BaseException):
        finding = f"cannot say which rigdesign it has ({_first_line(version)})"
    else:
        finding = f"has rigdesign {version}" if version else "has no rigdesign"
    more = f" (and {len(other) - 1} more)" if len(other) > 1 else ""
    raise UsageError(
        f"{role} {address}{more} {finding}, this study is of rigdesign {__version__}; install "
        f"'rigdesign[cluster]=={__version__}' there and start it again"
    )


def _first_line(error: BaseException) -> str:
    return shortened(str(error).partition("\n")[0] or type(error).__name__)

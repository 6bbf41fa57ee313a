"""How a command ends: errors as messages and exit status, what an interrupt or a failed run leaves."""

import math
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType

from cyclopts import CycloptsError

from rigdesign.base.parallel import STOPS
from rigdesign.base.version import __version__

NOTHING_KEPT = "nothing was written; the same command starts again from the beginning"
SIMULATIONS_KEPT = (
    "no report was written; finished simulations are stored, the same command goes on from there"
)

PIPE = 13
"""Number of SIGPIPE, which Windows does not name."""
CLEAN_UP = 10.0
"""Time after an interrupt in which others are ignored [s]."""


class Stopped(KeyboardInterrupt):
    """A signal that ends a command: Ctrl-C, the end of a session or job (SIGTERM), of a terminal (SIGHUP)."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


def first_stop_counts() -> None:
    """End at a signal of `STOPS`, and ignore others within `CLEAN_UP`: a second Ctrl-C would cut the clean-up short.

    Those that a process was started to ignore, by a shell in its background or by nohup, are left so.
    """
    counted = -math.inf

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal counted
        now = time.monotonic()
        if now - counted >= CLEAN_UP:
            counted = now
            raise Stopped(number)

    for number in STOPS:
        if signal.getsignal(number) in (signal.default_int_handler, signal.SIG_DFL):
            signal.signal(number, stop)


@contextmanager
def interrupted(remains: str) -> Iterator[None]:
    """Say what an interrupt leaves and how to go on."""
    try:
        yield
    except KeyboardInterrupt as stop:
        stop.add_note(remains)
        raise


@contextmanager
def failure_kept(out: Path | None) -> Iterator[None]:
    """Write what a run without convergence leaves, and say where it is."""
    from rigdesign.base.errors import NotConvergedError

    try:
        yield
    except NotConvergedError as error:
        from rigdesign.report.results_json import write_failure

        file = None if out is None else write_failure(error, out)
        if file is not None:
            error.args = (f"{error}; its history is in {file}", *error.args[1:])
        raise


def exit_status(command: Callable[[], object]) -> int:
    """Run a command and turn the tool's errors into messages and exit status."""
    from rigdesign.base.errors import WIDEST_PLACE, RigdesignError, shortened
    from rigdesign.base.system import memory_shortage

    try:
        status = command()
        sys.stdout.flush()
    except CycloptsError as error:
        return _told(shortened(str(error), WIDEST_PLACE), 2)
    except RigdesignError as error:
        return _told(str(error), error.exit_code)
    except BrokenPipeError:  # as a tool that does not ignore SIGPIPE: the reader has had enough
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except OSError:
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        return 128 + PIPE
    except KeyboardInterrupt as stop:
        number = getattr(stop, "number", signal.SIGINT)
        by = "" if number == signal.SIGINT else f" by {signal.Signals(number).name}"
        return _told("; ".join([f"interrupted{by}", *getattr(stop, "__notes__", [])]), 128 + number)
    except Exception as error:
        shortage = memory_shortage(error)
        return _told(shortage, 4) if shortage else _told(_defect(error), 70)
    return status if isinstance(status, int) else 0


def _told(message: str, status: int) -> int:
    with suppress(OSError):  # of a terminal that is gone
        print(f"rigdesign: {message}", file=sys.stderr)
    return status


def _defect(error: Exception) -> str:
    """One line on an error that nobody raised on purpose; its traceback goes to a file."""
    import platform
    import tempfile
    import traceback

    from rigdesign.base.errors import WIDEST_PLACE, shortened

    text = (
        f"rigdesign {__version__}, Python {platform.python_version()}, {platform.platform()}\n"
        f"{sys.argv!r}\n\n{''.join(traceback.format_exception(error))}"
    )
    what = shortened(f"{type(error).__name__}: {error}".replace("\n", " "), WIDEST_PLACE)
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="rigdesign-defect-", suffix=".txt", delete=False, encoding="utf-8"
        ) as file:
            file.write(text)
    except OSError:
        return f"internal error, a defect of rigdesign and not of your files: {what}\n{text}"
    return (
        f"internal error, a defect of rigdesign and not of your files: {what}; "
        f"please report it with the traceback in {file.name}"
    )

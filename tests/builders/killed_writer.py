"""Writes results, or runs a study, in children that are killed or refused a file at a given step.

    python -m tests.builders.killed_writer kill|full OUT STEP...   one child per step, each in OUT/STEP; prints a list

A step is a call that opens a file for writing, makes a folder or renames below the output folder.
"""

import errno
import json
import os
import signal
import sys
from pathlib import Path

from rigdesign.base.errors import OutputError
from rigdesign.report.writing import write_results
from tests.builders.report import small_result

EVENTS = ("open", "os.mkdir", "os.rename", "os.remove")
REFUSED, WRITTEN = 3, 0


def watch(out: Path, step: int, mode: str) -> None:
    """End this process, or refuse a file, at the ``step``-th change below ``out``."""
    seen = 0

    def hook(event: str, arguments: tuple[object, ...]) -> None:
        nonlocal seen
        if event not in EVENTS or not str(arguments[0]).startswith(str(out)):
            return
        if event == "open" and not int(str(arguments[2])) & (os.O_WRONLY | os.O_RDWR):
            return
        seen += 1
        if seen == step and mode == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if seen == step and event != "os.remove":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    sys.addaudithook(hook)


def attempt(out: Path, step: int, mode: str) -> int:
    """Write in a child; its exit status, negative when it was killed."""
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    status = 99
    try:
        watch(out, step, mode)
        write_results(small_result(), out)
        status = WRITTEN
    except OutputError as error:
        assert "No space left" in str(error)
        status = REFUSED
    finally:
        os._exit(status)


if __name__ == "__main__":
    mode, folder, *steps = sys.argv[1:]
    write_results(small_result(), Path(folder) / "whole")
    print(json.dumps([attempt(Path(folder) / step, int(step), mode) for step in steps]))

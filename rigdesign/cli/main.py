"""The command line, `rigdesign COMMAND`.

Commands: check, report, study, compare, diagnose, calibrate, diff, validate, explain, list, new, import, mesh,
    schema, doctor, completion; ``--verbose`` and ``--quiet`` go with each.

Exit status: 0 all checks pass (study: complete; compare, diagnose, calibrate: any verdict; diff: both can be read;
report: the result can be read; validate: no gate missed), 1 a check fails or is open, or a gate is missed, 2 usage or
case error, 3 no convergence, 4 a system library or memory is missing, 5 measured data cannot be used, 70 a defect of
the tool, 128 + n stopped by signal n (130: Ctrl-C) or by a reader that has closed the output (141).
Heavy imports happen inside the commands, so that `--help` answers at once.
"""

import os
import signal
import sys

from rigdesign.base.parallel import leave_interrupts, one_blas_thread
from rigdesign.cli.application import app, run
from rigdesign.cli.commands import (
    check,
    compare,
    diagnose,
    diff,
    doctor,
    explain,
    import_rexs,
    mesh,
    new,
    study,
    validate,
)
from rigdesign.cli.exit_status import exit_status, first_stop_counts
from rigdesign.cli.terminal.console import plain_streams

__all__ = [
    "app",
    "check",
    "compare",
    "diagnose",
    "diff",
    "doctor",
    "explain",
    "import_rexs",
    "main",
    "mesh",
    "new",
    "run",
    "study",
    "validate",
]


def main() -> None:
    """Entry point of the `rigdesign` command."""
    os.environ.update(one_blas_thread())
    plain_streams()
    first_stop_counts()
    if hasattr(signal, "SIGCHLD"):
        signal.signal(
            signal.SIGCHLD, signal.SIG_DFL
        )  # ignored by some parents: nobody could wait for a process then
    status = exit_status(lambda: run(sys.argv[1:]))
    leave_interrupts()  # the status stands; worker processes are waited for
    if (
        status > 128
    ):  # told to end: what is to be closed is closed, the rest of the memory takes seconds to take apart
        os._exit(status)
    sys.exit(status)

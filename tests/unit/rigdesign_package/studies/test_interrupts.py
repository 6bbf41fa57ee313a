"""A command that is told to end: as after one Ctrl-C, whatever the signal, and no process is left."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rigdesign.base.output_folder import FileLock
from rigdesign.base.parallel import STOPS
from rigdesign.cli import exit_status as ending
from rigdesign.studies.ledger import LEDGER_NAME, LOCK_NAME, read_points
from tests.builders.paths import ROOT

DRIVER = """
import sys
sys.path.insert(0, {root!r})
from dataclasses import replace
from pathlib import Path
from rigdesign.cli import main as command
from tests.builders.study import run_study
from tests.builders.study_functions import CURVES, slow
if __name__ == "__main__":
    out = Path(sys.argv[1])
    case = replace(CURVES, folder=str(out / "trace"))
    command.run = lambda arguments: run_study(case, "oil.inlet=80:160:1 degC", out / "study", run=slow, workers=2)
    command.main()
"""


AT_WORK = """
import ctypes, faulthandler, os, signal, sys, time
sys.path.insert(0, {root!r})
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from rigdesign.base import parallel
from rigdesign.base.output_folder import FileLock
from rigdesign.base.parallel import STOPS
from rigdesign.base.worker_pool import ProcessWorkers
from rigdesign.cli import main as command

def compiled(folder):
    (folder / f"begun-{{os.getpid()}}").touch()
    ctypes.PyDLL(None).sleep(60)  # no other thread of Python runs meanwhile

def interpreted(folder):
    (folder / f"begun-{{os.getpid()}}").touch()
    time.sleep(60)

def works(_):
    folder, system = Path(sys.argv[1]), sys.argv[2]
    parallel.cores = lambda: 2
    parallel.sys = SimpleNamespace(platform=system)
    work = partial(compiled if system == "linux" else interpreted, folder)
    with FileLock(folder / "lock"), parallel.BackgroundTasks([work, work]), ProcessWorkers(2) as pool:
        list(pool.compute(compiled, [folder, folder]))

if __name__ == "__main__":
    faulthandler.register(signal.SIGUSR2)  # says where a command is that does not end
    command.run = works
    command.main()
"""


def begun(folder: Path, count: int) -> bool:
    return len(list(folder.glob("ended-*"))) >= count


def started(command: list[str]) -> subprocess.Popen[str]:
    """In a session of its own, as from a terminal: a test run in the background or under nohup hands on that it ignores
    Ctrl-C or the end of its terminal."""
    return subprocess.Popen(
        [sys.executable, *command], stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=lambda: [signal.signal(number, signal.SIG_DFL) for number in STOPS],
    )  # fmt: skip


def living(group: int) -> list[str]:
    """Processes of a group that are not dead and only unread by their parent."""
    rows = subprocess.run(
        ["ps", "-eo", "pgid=,stat=,args="], capture_output=True, text=True, check=True
    ).stdout
    found = [row.split(maxsplit=2) for row in rows.splitlines()]
    return [row[2] for row in found if row[0] == str(group) and not row[1].startswith("Z")]


@pytest.mark.whole_run
@pytest.mark.parametrize(
    "longest", [0.05, *(pytest.param(seconds, marks=pytest.mark.slow) for seconds in (0.002, 0.3))]
)
def test_two_interrupts_at_any_distance_end_a_study_as_one(longest: float, tmp_path: Path) -> None:
    """To the whole process group, as a terminal sends them; before, two of three such pairs left a traceback."""
    (tmp_path / "trace").mkdir()
    (tmp_path / "driver.py").write_text(DRIVER.format(root=str(ROOT)), encoding="utf-8")
    chosen = random.Random(longest)
    study = started([str(tmp_path / "driver.py"), str(tmp_path)])
    try:
        until = time.monotonic() + 60.0
        while not begun(tmp_path / "trace", 3) and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(chosen.uniform(0.0, 0.3))
        os.killpg(study.pid, signal.SIGINT)
        time.sleep(chosen.uniform(0.3, 1.0) * longest)
        if study.poll() is None:
            os.killpg(study.pid, signal.SIGINT)
        _, reported = study.communicate(timeout=30)
        assert study.returncode == 130
        assert reported.startswith("rigdesign: interrupted; ") and reported.count("\n") == 1, reported
        assert "the same command computes the other" in reported
        until = time.monotonic() + 5.0
        while living(study.pid) and time.monotonic() < until:
            time.sleep(0.05)
        assert living(study.pid) == []
    finally:
        if living(study.pid):
            os.killpg(study.pid, signal.SIGKILL)
    out = tmp_path / "study"
    stored = len(read_points(out / LEDGER_NAME))
    assert stored >= 1 and f"interrupted; {stored} of 81 points" in reported
    assert not (out / LOCK_NAME).exists()


@pytest.mark.parametrize(
    ("number", "system", "status", "said"),
    [
        ("SIGTERM", "linux", 143, "rigdesign: interrupted by SIGTERM"),
        ("SIGHUP", "linux", 129, "rigdesign: interrupted by SIGHUP"),
        ("SIGKILL", "linux", -9, ""),
        ("SIGKILL", "one without prctl", -9, ""),
    ],
)
@pytest.mark.skipif(sys.platform != "linux", reason="the signal that follows a dead parent is Linux's own")
def test_no_process_outlives_a_command(
    number: str, system: str, status: int, said: str, tmp_path: Path
) -> None:
    """Copies and worker processes in compiled code; the signal reaches the command alone."""
    (tmp_path / "driver.py").write_text(AT_WORK.format(root=str(ROOT)), encoding="utf-8")
    command = started([str(tmp_path / "driver.py"), str(tmp_path), system])
    try:
        until = time.monotonic() + 60.0
        while len(list(tmp_path.glob("begun-*"))) < 4 and time.monotonic() < until:
            time.sleep(0.01)
        command.send_signal(getattr(signal, number))
        try:
            _, reported = command.communicate(timeout=30)
        except subprocess.TimeoutExpired:
            left = living(command.pid)
            command.send_signal(signal.SIGUSR2)
            time.sleep(0.5)
            os.killpg(command.pid, signal.SIGKILL)
            pytest.fail(f"{command.poll()} {left} {command.communicate()[1]}")
        assert command.returncode == status
        assert reported.strip() == said or number == "SIGKILL"  # Python counts what a killed process leaves
        until = time.monotonic() + 1.0
        while living(command.pid) and time.monotonic() < until:
            time.sleep(0.05)
        assert living(command.pid) == []
    finally:
        if living(command.pid):
            os.killpg(command.pid, signal.SIGKILL)
    FileLock(tmp_path / "lock").release()


def test_a_later_interrupt_counts_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that a library has swallowed must not leave a command that nobody can stop."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        ending.first_stop_counts()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        monkeypatch.setattr(ending, "CLEAN_UP", 0.0)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_command_in_the_background_stays_without_interrupts() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        ending.first_stop_counts()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)

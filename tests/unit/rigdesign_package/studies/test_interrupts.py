"""Ctrl-C twice in a running study: it ends as after one, and no process is left."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rigdesign.cli import ending
from rigdesign.studies.ledger import read_points
from rigdesign.studies.shards import LEDGER_NAME, LOCK_NAME
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


def begun(folder: Path, count: int) -> bool:
    return len(list(folder.glob("ended-*"))) >= count


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
    study = subprocess.Popen(
        [sys.executable, str(tmp_path / "driver.py"), str(tmp_path)],
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
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


def test_a_later_interrupt_counts_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that a library has swallowed must not leave a command that nobody can stop."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        ending.first_interrupt_counts()
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
        ending.first_interrupt_counts()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)

"""The clock of a running command and its estimate of what is left."""

import json
import os
import pty
import re
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rigdesign.cli.terminal import progress as module
from rigdesign.cli.terminal.console import Verbosity, verbosity
from rigdesign.cli.terminal.progress import (
    FIRST_RUN,
    MOST_RUNS,
    Progress,
    StepTimes,
    duration_text,
    remaining_points,
    step_times,
)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


class Clock:
    """A clock that stands still until it is moved."""

    def __init__(self) -> None:
        self.now = 1000.0

    def perf_counter(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    found = Clock()
    monkeypatch.setattr(module, "time", found)
    return found


@pytest.fixture
def saying() -> Iterator[None]:
    token = verbosity.set("normal")
    yield
    verbosity.reset(token)


# ---------------------------------------------------------------------------- estimates


def test_what_is_left_follows_from_the_last_run_at_the_pace_of_this_one() -> None:
    times = StepTimes(key="a", last={"build": 0.0, "couple": 10.0, "assemble": 30.0, "end": 40.0})
    times.begin("build", 0.0)
    assert times.remaining(0.0) == 40.0 and times.remaining(4.0) == 36.0
    times.begin("couple", 20.0)
    assert times.remaining(20.0) == pytest.approx(2.0 * 30.0)
    assert times.remaining(50.0) == pytest.approx(30.0)
    assert times.remaining(500.0) == 0.0


def test_a_step_that_the_last_run_did_not_have_changes_nothing() -> None:
    times = StepTimes(key="a", last={"build": 0.0, "end": 40.0})
    times.begin("build", 0.0)
    times.begin("meshed test: 999 nodes", 3.0)
    assert times.remaining(10.0) == 30.0


def test_nothing_is_said_without_a_last_run() -> None:
    times = step_times("unknown")
    times.begin("build", 0.0)
    assert times.first_run and times.remaining(3.0) is None


def test_steps_are_kept_for_the_next_run_of_the_same_kind() -> None:
    times = step_times("a quick")
    times.begin("build", 0.0)
    times.begin("couple", 2.5)
    times.keep(7.0)
    assert step_times("a quick").last == {"build": 0.0, "couple": 2.5, "end": 7.0}
    assert step_times("a standard").first_run


def test_few_runs_are_kept_and_the_oldest_go_first(cache: Path) -> None:
    for number in range(MOST_RUNS + 3):
        times = step_times(f"run {number}")
        times.begin("build", 0.0)
        times.keep(1.0)
    kept = json.loads((cache / "step_times.json").read_text(encoding="utf-8"))
    assert list(kept) == [f"run {number}" for number in range(3, MOST_RUNS + 3)]


@pytest.mark.parametrize("text", ["", "{", "[1, 2]", '{"a": 3}', '{"a": {"end": "soon"}}'])
def test_a_damaged_file_is_a_first_run(text: str, cache: Path) -> None:
    cache.mkdir()
    (cache / "step_times.json").write_text(text, encoding="utf-8")
    assert step_times("a").first_run


def test_a_folder_that_cannot_be_written_is_left_alone(cache: Path) -> None:
    cache.write_text("a file", encoding="utf-8")
    times = step_times("a")
    times.begin("build", 0.0)
    times.keep(1.0)
    assert cache.read_text(encoding="utf-8") == "a file"


def test_points_take_the_mean_of_those_done() -> None:
    assert remaining_points(10, 40, 20.0) == 60.0
    assert remaining_points(0, 40, 20.0) == 0.0


@pytest.mark.parametrize(
    ("seconds", "text"), [(3.4, "3 s"), (42.0, "40 s"), (200.0, "3 min"), (9000.0, "2.5 h")]
)
def test_an_estimate_has_no_more_digits_than_it_is_worth(seconds: float, text: str) -> None:
    assert duration_text(seconds) == text


# ---------------------------------------------------------------------------- lines


def run_twice(clock: Clock) -> None:
    for _ in range(2):
        with Progress(step_times("case quick")) as progress:
            progress("building")
            clock.now += 10.0
            progress("coupling")
            clock.now += 30.0


@pytest.mark.usefixtures("saying")
def test_lines_say_what_is_left_from_the_second_run_on(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    run_twice(clock)
    assert capsys.readouterr().err.splitlines() == [
        f"   0.0 s  building ({FIRST_RUN})",
        "  10.0 s  coupling",
        "   0.0 s  building (about 40 s left)",
        "  10.0 s  coupling (about 30 s left)",
    ]


@pytest.mark.usefixtures("saying")
def test_counted_points_say_what_is_left(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    with Progress() as progress:
        progress("points")
        for done in range(1, 21):
            clock.now += 3.0
            progress.count(done, 20, f"point {done}")
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 + 10
    assert lines[5] == "  30.0 s  10 of 20, last point 10 (about 30 s left)"
    assert lines[-1] == "  60.0 s  20 of 20, last point 20"


@pytest.mark.usefixtures("saying")
def test_the_start_of_the_workers_does_not_count_as_points(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two workers start for 60 s and give a point each, then two every 4 s."""
    with Progress(parallel=2) as progress:
        progress("points")
        clock.now += 56.0
        for done in range(1, 21):
            clock.now += 4.0 if done % 2 else 0.0
            progress.count(done, 20, f"point {done}")
    lines = capsys.readouterr().err.splitlines()
    assert lines[1] == "  60.0 s  2 of 20, last point 2"
    assert lines[5] == "  76.0 s  10 of 20, last point 10 (about 20 s left)"


def test_a_run_that_fails_keeps_no_times() -> None:
    with pytest.raises(ValueError), Progress(step_times("case")) as progress:
        progress("building")
        raise ValueError
    assert step_times("case").first_run


@pytest.mark.parametrize(("said", "number"), [("quiet", 0), ("normal", 2), ("verbose", 4)])
def test_how_much_is_said(
    said: Verbosity, number: int, clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    token = verbosity.set(said)
    try:
        with Progress() as progress:
            clock.now += 1.0
            progress("building")
            clock.now += 2.0
            progress("coupling")
            clock.now += 4.0
    finally:
        verbosity.reset(token)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == number
    if said == "verbose":
        assert lines[1] == "    2.00 s  building" and lines[3] == "    4.00 s  coupling"


TICKING = """
import time
from rigdesign.cli.terminal.progress import Progress
with Progress() as progress:
    progress("a long step")
    time.sleep(1.6)
"""


def test_the_clock_of_a_terminal_ticks_while_a_step_runs() -> None:
    """One step of 1.6 s in a pseudo terminal: the seconds advance although nothing is reported."""
    import subprocess

    primary, secondary = pty.openpty()
    chunks: list[bytes] = []

    def read() -> None:
        try:
            while chunk := os.read(primary, 4096):
                chunks.append(chunk)
        except OSError:
            return

    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "80"}
    subprocess.run([sys.executable, "-c", TICKING], stderr=secondary, env=environment, check=True)
    os.close(secondary)
    reader.join(timeout=5.0)
    os.close(primary)
    seen = b"".join(chunks).decode()
    clocks = {float(found) for found in re.findall(r"(\d+\.\d) s(?: |\x1b)", seen)}
    assert "a long step" in seen and len(clocks) >= 4 and max(clocks) > 1.0

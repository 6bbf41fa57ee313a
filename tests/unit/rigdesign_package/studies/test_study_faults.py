"""What happens to a study besides its points: damaged ledgers, a second study, a killed one, an interrupt."""

import json
import os
import random
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from rigdesign.base import worker_pool
from rigdesign.base.errors import OutputError
from rigdesign.base.output_folder import FileLock, HeldError, staged
from rigdesign.studies.ledger import LEDGER_NAME, LOCK_NAME
from tests.builders.ledger_damage import (
    DAMAGE,
    POINTS,
    ROWS,
    copy_ledger,
    harm_file,
    harm_rows,
    resumed,
    write_ledger,
)
from tests.builders.paths import ROOT
from tests.builders.study import VARIED, ExampleCase, InProcess, run_example, run_study


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ledger") / "l.sqlite"
    write_ledger(path)
    return path


def copied(sound: Path, folder: Path) -> Path:
    copy_ledger(sound, folder / "l.sqlite")
    return folder / "l.sqlite"


def test_a_sound_ledger_of_a_killed_study_loses_nothing(sound: Path, tmp_path: Path) -> None:
    assert resumed(copied(sound, tmp_path)) == (POINTS, "")


@pytest.mark.parametrize("kind", ROWS)
def test_rows_that_are_not_as_written_are_set_aside_and_said_once(
    kind: str, sound: Path, tmp_path: Path
) -> None:
    path = copied(sound, tmp_path)
    harm_rows(path, ROWS[kind])
    kept, reported = resumed(path)
    lost = {"a column less": POINTS, "another table": POINTS, "another schema": 0, "an earlier format": 0}
    assert kept == POINTS - lost.get(kind, 1)
    assert ("is of format 1" if kind == "an earlier format" else "is damaged") in reported
    assert "l.sqlite.damaged-1" in reported and f"{kept} points" in reported
    assert (tmp_path / "l.sqlite.damaged-1").exists()


@pytest.mark.parametrize("kind", DAMAGE)
def test_damaged_files_are_never_believed_and_never_stop_a_study(
    kind: str, sound: Path, tmp_path: Path
) -> None:
    for seed in range(4):
        folder = tmp_path / str(seed)
        folder.mkdir()
        path = copied(sound, folder)
        harm_file(path, kind, random.Random(f"{kind} {seed}"))
        kept, reported = resumed(path)
        assert kept == POINTS or reported


def test_a_file_that_is_no_ledger_is_kept_under_another_name(tmp_path: Path) -> None:
    path = tmp_path / "l.sqlite"
    path.write_text("not a database " * 50, encoding="utf-8")
    kept, reported = resumed(path)
    assert kept == 0 and "not a database" in reported
    assert (tmp_path / "l.sqlite.damaged-1").read_text(encoding="utf-8") == "not a database " * 50
    path.write_text("again", encoding="utf-8")
    resumed(path)
    assert (tmp_path / "l.sqlite.damaged-2").read_text(encoding="utf-8") == "again"


def test_a_study_on_a_damaged_ledger_computes_the_damaged_point_again(tmp_path: Path) -> None:
    case = ExampleCase(log=str(tmp_path / "log"))
    out = tmp_path / "out"
    run_study(case, VARIED, out, run=run_example, executor=InProcess())
    before = (out / "results.csv").read_bytes()
    harm_rows(out / LEDGER_NAME, "UPDATE points SET record = substr(record, 1, 99) WHERE rowid = 2")
    notes: list[str] = []
    again = run_study(case, VARIED, out, run=run_example, executor=InProcess(), note=notes.append)
    assert (again.completed, again.reused) == (1, 2)
    assert (out / "results.csv").read_bytes() == before
    assert len(notes) == 1 and "2 points read from it are used" in notes[0]
    run_study(case, VARIED, out, run=run_example, executor=InProcess(), note=notes.append)
    assert len(notes) == 1


# ---------------------------------------------------------------------------- one study in a folder

HOLDER = """
import sys, time
sys.path.insert(0, {root!r})
from pathlib import Path
from rigdesign.base.output_folder import FileLock
lock = FileLock(Path(sys.argv[1]))
print("held", flush=True)
time.sleep(60)
"""


def holder(path: Path) -> subprocess.Popen[str]:
    """Another process that holds the lock file ``path``."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER.format(root=str(ROOT)), str(path)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None and process.stdout.readline() == "held\n"
    return process


def test_a_second_study_in_a_folder_is_refused_by_the_name_of_the_first(tmp_path: Path) -> None:
    case = ExampleCase(log=str(tmp_path / "log"))
    with holder(tmp_path / LOCK_NAME) as other:
        try:
            with pytest.raises(OutputError, match=rf"process {other.pid} on \S+ since 20\d\d-") as refused:
                run_study(case, VARIED, tmp_path, run=run_example, executor=InProcess())
        finally:
            other.kill()
    assert refused.value.exit_code == 2 and "--out" in str(refused.value)
    assert not (tmp_path / "log").exists()


def test_the_lock_of_a_dead_process_is_taken_over_and_removed_at_the_end(tmp_path: Path) -> None:
    with holder(tmp_path / LOCK_NAME) as other:
        other.send_signal(signal.SIGKILL)
    assert json.loads((tmp_path / LOCK_NAME).read_text())["pid"] == other.pid
    outcome = run_study(
        ExampleCase(log=str(tmp_path / "log")), VARIED, tmp_path, run=run_example, executor=InProcess()
    )
    assert outcome.completed == 3
    assert not (tmp_path / LOCK_NAME).exists()


def test_a_lock_released_while_another_waits_is_not_held_twice(tmp_path: Path) -> None:
    """The file that the second opened was removed by the first: locking it would lock nothing."""
    path = tmp_path / "lock"
    first = FileLock(path)
    with pytest.raises(HeldError):
        FileLock(path)
    first.release()
    with FileLock(path), pytest.raises(HeldError) as held:
        FileLock(path)
    assert held.value.owner is not None and held.value.owner.pid == os.getpid()
    assert not path.exists()


# ---------------------------------------------------------------------------- what a killed run leaves

WRITER = """
import sys, time
sys.path.insert(0, {root!r})
from pathlib import Path
from rigdesign.base.output_folder import staged
with staged(Path(sys.argv[1])) as scratch:
    (scratch / "results.json").write_text("half")
    print("writing", flush=True)
    time.sleep(60)
"""


def test_staging_folders_of_the_dead_go_and_those_of_the_living_stay(tmp_path: Path) -> None:
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", WRITER.format(root=str(ROOT)), str(tmp_path)],
            stdout=subprocess.PIPE, text=True,
        )
        for _ in range(2)
    ]  # fmt: skip
    try:
        for process in processes:
            assert process.stdout is not None and process.stdout.readline() == "writing\n"
        earlier = tmp_path / ".rigdesign-writing-of-an-earlier-version"
        earlier.mkdir()
        (earlier / "results.json").write_text("{}")
        processes[0].kill()
        processes[0].wait()
        assert len(list(tmp_path.glob(".rigdesign-writing-*"))) == 3
        with staged(tmp_path) as scratch:
            (scratch / "mine").write_text("x")
        left = list(tmp_path.glob(".rigdesign-writing-*"))
        assert len(left) == 1
        owner = json.loads((left[0] / "owner").read_text())
        assert owner["pid"] == processes[1].pid
    finally:
        for process in processes:
            process.kill()
            process.communicate()
    with staged(tmp_path):
        pass
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine"]


# ---------------------------------------------------------------------------- interrupt


def test_an_interrupt_says_what_is_stored_and_how_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Stopped(InProcess):
        def submit(self, work, /, *arguments, **keywords):  # type: ignore[no-untyped-def]
            if (tmp_path / "log").exists():
                raise KeyboardInterrupt
            return super().submit(work, *arguments, **keywords)

    monkeypatch.setattr(worker_pool, "IN_FLIGHT", 1)
    with pytest.raises(KeyboardInterrupt) as stop:
        run_study(
            ExampleCase(log=str(tmp_path / "log")), VARIED, tmp_path, run=run_example, executor=Stopped()
        )
    (note,) = stop.value.__notes__
    assert note == (
        f"1 of 3 points are computed ({tmp_path / LEDGER_NAME}); the same command computes the other 2"
    )
    assert not (tmp_path / LOCK_NAME).exists()

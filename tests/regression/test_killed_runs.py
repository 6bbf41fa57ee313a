"""Commands killed at random instants and disks of every size: whole files only, and the next run completes.

pytest -m slow -s tests/regression/test_killed_runs.py      prints the counts
"""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest

from rigdesign.base.errors import OutputError
from rigdesign.report.writing import write_results
from tests.builders.commands import SMALL
from tests.builders.output import attempts, held_against, published
from tests.builders.paths import ROOT
from tests.builders.report import small_result
from tests.builders.study import DRIVER, POINTS, _events, _stored

CHECKS, STUDIES = 20, 25
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}
CHECK = "from rigdesign.cli.main import main; main()"


def ended(command: list[str], seconds: float | None) -> int:
    """Exit status of a command that is killed after ``seconds``, with all it started."""
    process = subprocess.Popen(
        command, env=os.environ | ONE_THREAD, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return process.wait()


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["kill", "full"])
def test_every_step_of_writing(mode: str, tmp_path: Path) -> None:
    steps = tuple(range(1, 46))
    counts = Counter(attempts(mode, tmp_path, steps))
    whole = published(tmp_path / "whole")
    for step in steps:
        counts["published a part"] += 0 < len(published(tmp_path / str(step))) < len(whole)
        held_against(tmp_path / str(step), whole)
    print(f"\n{mode} at each of {len(steps)} steps: {dict(counts)}")


@pytest.mark.slow
def test_check_killed_at_random_instants(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(SMALL, encoding="utf-8")
    command = [sys.executable, "-c", CHECK, "check", str(tmp_path), "--fidelity", "quick", "--out"]
    began = time.monotonic()
    assert ended([*command, str(tmp_path / "whole")], None) == 0
    whole, needed = published(tmp_path / "whole"), time.monotonic() - began
    choice, out, counts = random.Random(15), tmp_path / "out", Counter[str]()
    for _ in range(CHECKS):
        shutil.rmtree(out, ignore_errors=True)
        status = ended([*command, str(out)], choice.uniform(0.5, 1.1) * needed)
        found = published(out) if out.exists() else {}
        counts["killed" if status < 0 else "complete"] += 1
        counts["left nothing"] += not found
        counts["left a staging folder"] += out.exists() and bool(list(out.glob(".rigdesign-*")))
        assert found.keys() <= whole.keys()
        assert "results.json" not in found or found.keys() == whole.keys()
        for name, content in found.items():
            if name.endswith(".json"):
                json.loads(content)
            assert len(content) > 0.9 * len(whole[name])
    assert ended([*command, str(out)], None) == 0
    assert published(out).keys() == whole.keys() and not list(out.glob(".rigdesign-*"))
    print(f"\ncheck, {needed:.1f} s undisturbed: {dict(counts)}")


@pytest.mark.slow
def test_study_killed_at_random_instants_again_and_again(tmp_path: Path) -> None:
    """The same study is killed until it is complete; no point that was stored is computed again."""
    script = tmp_path / "driver.py"
    script.write_text(DRIVER.format(root=str(ROOT), values="oil.inlet=90:118:2 degC"), encoding="utf-8")
    began = time.monotonic()
    assert ended([sys.executable, str(script), str(tmp_path / "whole")], None) == 0
    needed = time.monotonic() - began
    whole, choice, counts = published(tmp_path / "whole"), random.Random(16), Counter[str]()
    for number in range(STUDIES):
        out = tmp_path / f"s{number}"
        stored, status = 0, -1
        while status != 0:
            begun = _events(tmp_path / f"{out.name}.log", "begin")
            status = ended([sys.executable, str(script), str(out)], choice.uniform(0.3, 1.1) * needed)
            now = _stored(out)
            assert now >= stored
            counts["killed" if status else "complete"] += 1
            counts["points computed twice"] += max(
                0, _events(tmp_path / f"{out.name}.log", "begin") - begun - (POINTS - stored)
            )
            stored = now
        found = published(out)
        found.pop("ledger.sqlite", None)
        assert found == {name: content for name, content in whole.items() if name != "ledger.sqlite"}
        assert not list(out.glob(".rigdesign-*"))
    print(f"\nstudy, {needed:.1f} s undisturbed: {dict(counts)}")


@pytest.mark.slow
def test_disks_of_every_size(tmp_path: Path) -> None:
    """A small file system in memory, where this machine lets us mount one."""
    write_results(small_result(), tmp_path / "whole")
    whole, disk, counts = published(tmp_path / "whole"), tmp_path / "disk", Counter[str]()
    disk.mkdir()
    room = sum(map(len, whole.values())) // 1024
    for kilobytes in (4, 16, 32, 64, *(room * share // 16 for share in range(2, 24))):
        mount = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(disk)]
        if subprocess.run(mount, capture_output=True).returncode:
            pytest.skip("no right to mount a file system")
        try:
            write_results(small_result(), disk / "out")
            counts["complete"] += 1
            assert published(disk / "out") == whole
        except OutputError:
            counts["refused"] += 1
            assert not (disk / "out").exists() or published(disk / "out") == {}
            assert not list((disk / "out").glob(".rigdesign-*"))
        finally:
            subprocess.run(["umount", str(disk)], check=True)
    assert counts["complete"] and counts["refused"]
    print(f"\ndisks of {len(whole)} files, {room} kB: {dict(counts)}")

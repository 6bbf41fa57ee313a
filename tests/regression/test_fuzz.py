"""Fuzz runs: whatever a case file says, the tool ends in time, with the right status and whole files.

A part runs in CI; the counts of the README come from the slow tests:

    pytest -m slow -s tests/regression/test_fuzz.py
"""

import json
import signal
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import pytest

from rigdesign.base.errors import RigdesignError
from rigdesign.case import load_case
from rigdesign.report.writing import write_results
from rigdesign.results.check import status
from rigdesign.run.main import run_case
from tests.builders.fuzz import broken_texts, shortened
from tests.builders.mutant import mutations
from tests.builders.twisting import OWN_EVERY, twisting_case

LOADS, MANY_LOADS = 300, 10_000
LOAD_TIME, RUN_TIME = 5.0, 300.0
"""Longest time of a load and of a run [s]; what takes longer counts as a hang."""
NAMES = ("uhcf_prototype", "uhcf_main", "loop_1to1", "loop_hunting")
MANY_RUNS = 300
HOTTEST = 400.0
"""A gearbox above this temperature [degC] cannot pass."""


class HangError(Exception):
    """A run took longer than it may."""


@contextmanager
def in_time(seconds: float) -> Iterator[None]:
    def over(*_: object) -> None:
        raise HangError(f"longer than {seconds:g} s")

    before = signal.signal(signal.SIGALRM, over)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def load_outcome(text: str, folder: Path) -> str:
    """``loaded`` or ``refused``; what is no error of the tool's own tree is named with its first line.

    ``folder`` stands in the place of the case's own, so that ``extends`` finds its base.
    """
    file = folder / "fuzz.toml"
    file.write_bytes(text.encode("utf-8", "replace"))
    try:
        with in_time(LOAD_TIME):
            load_case(file)
    except RigdesignError as error:
        length = len(str(error))
        return "refused" if 20 < length < 20_000 else f"refused in {length} characters"
    except Exception as error:
        return f"defect: {type(error).__name__}: {str(error)[:80]}"
    return "loaded"


def loads(seed: int, count: int, tmp_path: Path) -> Counter[str]:
    """Ends of ``count`` broken files, counted."""
    found: Counter[str] = Counter()
    for _, file, text in islice(broken_texts(seed), count):
        folder = tmp_path / file.parent.name
        if not folder.exists():
            folder.mkdir()
            for own in file.parent.glob("*.toml"):
                (folder / own.name).write_bytes(own.read_bytes())
        found[load_outcome(text, folder)] += 1
    return found


def test_broken_case_files_are_refused_in_words(tmp_path: Path) -> None:
    found = loads(15, LOADS, tmp_path)
    assert set(found) == {"loaded", "refused"}
    assert found["refused"] > LOADS / 2


@pytest.mark.slow
def test_ten_thousand_broken_case_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    started = time.perf_counter()
    found = loads(2026, MANY_LOADS, tmp_path)
    with capsys.disabled():
        print(f"\n{MANY_LOADS} broken case files: {dict(found)}, {time.perf_counter() - started:.0f} s")
    assert set(found) == {"loaded", "refused"}


@dataclass(frozen=True)
class Run:
    """What became of a run of a changed case."""

    case: str
    path: str
    value: object
    end: str
    seconds: float


def run_outcome(name: str, path: str, value: object, out: Path, *, own: bool) -> Run:
    """Load, run and write one changed case as `rigdesign check --out` does; own : its own shafts and teeth."""
    started = time.perf_counter()
    where = (name, path, value)
    try:
        with in_time(RUN_TIME):
            base = shortened(name) if own else twisting_case(shortened(name))
            result = run_case(base.with_value(path, value), fidelity="quick")
            write_results(result, out)
    except RigdesignError as error:
        assert len(str(error).split()) > 4, where
        assert not out.exists() or not any(out.iterdir()), where
        return Run(name, path, value, type(error).__name__, time.perf_counter() - started)
    document = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert {"results.json", "report.html", "junit.xml"} <= {entry.name for entry in out.iterdir()}
    assert not list(out.parent.glob(".rigdesign-writing*"))
    _plausible(document, name, path, value)
    return Run(name, path, value, document["verdict"], time.perf_counter() - started)


def _plausible(document: dict[str, object], name: str, path: str, value: object) -> None:
    """No pass with a number nobody can believe."""
    where = (name, path, value)
    checks, thermal = document["checks"], document["thermal"]
    assert isinstance(checks, list) and isinstance(thermal, list)
    for check in checks:
        if check["verdict"] == "pass":
            assert check["value"] is not None and check["distance"] is not None, (*where, check["id"])
            assert check["distance"] >= 0.0, (*where, check["id"])
    statuses = {status(check["verdict"], check["flags"]) for check in checks}
    worst = "fail" if "fail" in statuses else "open" if "open" in statuses else "pass"
    assert document["verdict"] == worst, where
    if document["verdict"] == "pass":
        assert all(row["max_temperature_degC"] < HOTTEST for row in thermal), where


def runs(count: int, seed: int, tmp_path: Path) -> list[Run]:
    found = []
    for name in NAMES:
        for number, (path, value) in enumerate(islice(mutations(shortened(name), seed), count)):
            own = number % OWN_EVERY == 0
            found.append(run_outcome(name, path, value, tmp_path / f"{name}_{number}", own=own))
    return found


@pytest.mark.slow
def test_three_hundred_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = runs(MANY_RUNS // len(NAMES), 2026, tmp_path)
    seconds = sorted(run.seconds for run in found)
    with capsys.disabled():
        print(f"\n{len(found)} runs: {dict(Counter(run.end for run in found))}")
        print(f"median {seconds[len(seconds) // 2]:.1f} s, longest {seconds[-1]:.1f} s")

"""One mutant in a copy of the project: the tests that run its lines, until one of them fails."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tests.mutation.reach import is_kernel, measured, nearest, runs
from tests.mutation.sample import ROOT, Mutant

COPIED = ("rigdesign", "thermal", "dynamics", "tests", "cases", "pyproject.toml", "README.md", "CHANGELOG.md")
COMPILATION, PATIENCE = 120.0, 4.0
"""A test file may take so many seconds to compile, and so many times its own, before it counts as endless."""

Outcome = Literal["killed", "endless", "survived", "not reached", "undecided"]
"""``undecided``: alive when the limits of the search were met."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """What became of a mutant."""

    mutant: str
    module: str
    change: str
    outcome: Outcome
    by: str
    """First test that failed."""
    files: int
    """Test files that were run against it."""
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Limits:
    """How far the search goes: test files asked by their distance, seconds of tests run."""

    files: int
    seconds: float


@contextmanager
def copied_project() -> Iterator[Path]:
    """A copy of the project that may be changed, with compiled kernels of its own."""
    with tempfile.TemporaryDirectory(prefix="rigdesign-mutation-") as folder:
        for name in COPIED:
            part = ROOT / name
            if part.is_dir():
                shutil.copytree(part, Path(folder) / name, ignore=shutil.ignore_patterns("__pycache__"))
            elif part.is_file():
                shutil.copy2(part, Path(folder) / name)
        yield Path(folder)


def tried(mutant: Mutant, project: Path, work: Path, limits: Limits) -> Trial:
    """Run the test files that reach a mutant, nearest first, until one fails.

    work : folder with what the test files run
    """
    started = time.perf_counter()
    outcome: Outcome = "not reached"
    by, run, spent = "", 0, 0.0
    near = nearest(mutant.module)
    with _changed(mutant, project) as cache:
        for file in near[: limits.files or None]:
            reach = measured(file, work)
            if not reach.passed or not runs(reach, mutant.module, mutant.lines):
                continue
            run, spent = run + 1, spent + reach.seconds
            outcome, by = _test(project, cache, file, reach.seconds)
            if outcome != "survived" or spent > limits.seconds:
                break
    if outcome in ("survived", "not reached") and (spent > limits.seconds or 0 < limits.files < len(near)):
        outcome = "undecided"
    return Trial(
        mutant=mutant.name, module=mutant.module, change=mutant.change(), outcome=outcome, by=by, files=run,
        seconds=round(time.perf_counter() - started, 1),
    )  # fmt: skip


@contextmanager
def _changed(mutant: Mutant, project: Path) -> Iterator[Path]:
    """The copy with the mutant in it; gives the folder for compiled kernels."""
    path = project / mutant.module
    times, kernel = path.stat(), is_kernel(mutant.module)
    cache = Path(tempfile.mkdtemp(dir=project)) if kernel else project / "compiled"
    before = path.read_text(encoding="utf-8")
    try:
        _replace(path, mutant.code())
        yield cache
    finally:
        _replace(path, before)
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        if kernel:
            shutil.rmtree(cache)


def _replace(path: Path, text: str) -> None:
    """Write a module and forget its bytecode, which Python tells apart by size and second only."""
    path.write_text(text, encoding="utf-8")
    for compiled in (path.parent / "__pycache__").glob(f"{path.stem}.*"):
        compiled.unlink()


def _test(project: Path, cache: Path, file: str, seconds: float) -> tuple[Outcome, str]:
    """Run one test file against the copy; ``seconds`` it takes without a mutant."""
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(filter(None, (str(project), os.environ.get("PYTHONPATH")))),
        "NUMBA_CACHE_DIR": str(cache), "NUMBA_DISABLE_JIT": "0", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
    }  # fmt: skip
    process = subprocess.Popen(
        [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", file],
        cwd=project, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        start_new_session=True,
    )  # fmt: skip
    try:
        output, _ = process.communicate(timeout=COMPILATION + PATIENCE * seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return "endless", file
    if process.returncode == 0:
        return "survived", ""
    failed = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return "killed", failed[0].split(" - ")[0].split(" ", 1)[-1] if failed else output[-200:]

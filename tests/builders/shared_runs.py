"""What several test files need and only one process of a test run computes: whole runs, and the tool's cache folder.

The test run makes a folder for both (`tests/conftest.py`); the processes of pytest-xdist inherit it. A result computed
by one of them is read by the others, which wait for it meanwhile.
"""

import fcntl
import os
import pickle
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from rigdesign import load_case
from rigdesign.results.result import RunResult
from rigdesign.run.main import run_case
from rigdesign.studies.verdict_sensitivity import with_flips
from tests.builders.paths import CASES
from tests.builders.recorded_reads import recorded_run
from thermal.fe.kernel_cache import cache_folder

VARIABLE = "RIGDESIGN_TEST_RUN_FOLDER"
"""Environment variable with the folder of the test run."""
T = TypeVar("T")


def open_folder() -> None:
    """Make the folder of the test run, with a cache of the tool in it.

    Libraries of the diagnosis are made anew in every test run. Influence numbers are those of the cache given or of
    the user: their files are named after all they follow from.
    """
    folder = Path(tempfile.mkdtemp(prefix="rigdesign-tests-"))
    stored = cache_folder() / "influence"
    stored.mkdir(parents=True, exist_ok=True)
    (folder / "cache").mkdir()
    (folder / "cache" / "influence").symlink_to(stored)
    os.environ[VARIABLE] = str(folder)


def close_folder() -> None:
    """Remove the folder of the test run; influence numbers stay."""
    shutil.rmtree(os.environ.pop(VARIABLE), ignore_errors=True)


def run_cache() -> Path:
    """The cache folder that all processes of this test run use."""
    return Path(os.environ[VARIABLE]) / "cache"


def shared(name: str, make: Callable[[], T]) -> T:
    """What ``make`` returns, computed once in a test run."""
    file = Path(os.environ[VARIABLE]) / f"{name}.pickle"
    with file.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not file.exists():
            part = file.with_suffix(".part")
            part.write_bytes(pickle.dumps(make()))
            part.replace(file)
        found: T = pickle.loads(file.read_bytes())
        return found


def shipped_run(name: str) -> RunResult:
    """A shipped case as `rigdesign check` computes it at its default fidelity; of another of its files
    (``uhcf_main/fitted.toml``) without the inputs that would turn its verdict."""
    follow_ups = {} if "/" in name else {"flips": with_flips}
    return shared(
        f"{name.replace('/', '-')}-shipped",
        lambda: run_case(load_case(CASES / name), "standard", follow_ups=follow_ups),
    )


def quick_run(name: str, file: str = "case.toml") -> RunResult:
    """A shipped case at quick fidelity, without the inputs that would turn its verdict."""
    return quick_run_and_idle(name, file)[0]


def quick_run_and_idle(name: str, file: str = "case.toml") -> tuple[RunResult, tuple[str, ...]]:
    """The same, and the numbers stated by the case that the run did not read."""
    return shared(
        f"{name}-{Path(file).stem}-quick", lambda: recorded_run(load_case(CASES / name / file), "quick")
    )

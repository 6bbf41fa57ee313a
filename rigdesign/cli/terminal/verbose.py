"""What ``--verbose`` adds, on stderr: iterations of the solvers, times of the parts, what the caches gave.

Without it one line on caches that will not last.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verbosity
from thermal.fe.kernel_cache import GIVEN, cache_folder, user_folder

if TYPE_CHECKING:
    from rigdesign.results.result import RunResult

KERNELS = ("dynamics.kernels.", "thermal.fe.")
"""Packages whose compiled functions are cached by numba."""


def print_run(result: "RunResult") -> None:
    """Iterations and last residuals of every held stage, seconds of every part; nothing unless asked for."""
    if verbosity.get() != "verbose":
        return
    console = new_console(stderr=True)
    for history in result.coupling:
        last = ", ".join(f"{key} {value:.2g}" for key, value in history.residuals[-1].items())
        console.print(Text(f"stage {history.stage}: {history.iterations} iterations, last residuals {last}"))
    parts = ", ".join(f"{part} {seconds:.2f} s" for part, seconds in result.timings_s.items())
    console.print(Text(f"parts of the run: {parts}"))


@contextmanager
def cache_use() -> Iterator[None]:
    """Around a command: that its caches do not last, if so; when asked for, what it found and wrote there."""
    folder, lasting = cache_folder(), user_folder()
    if folder != lasting and not os.environ.get(GIVEN):
        why = f"{lasting} cannot be written" if lasting else "this user has no home"
        new_console(stderr=True).print(
            Text(f"note: caches are in {folder}, as {why}; set {GIVEN} to a folder that lasts"),
            soft_wrap=True,
        )
        os.environ.setdefault("MPLCONFIGDIR", str(folder / "matplotlib"))
    if verbosity.get() != "verbose":
        yield
        return
    before = _files(folder)
    try:
        yield
    finally:
        after = _files(folder)
        written = sum(after[file] != before.get(file) for file in after)
        console = new_console(stderr=True)
        console.print(Text(f"cache {folder}: {len(before)} files before, {written} written by this command"))
        loaded, compiled = _kernels()
        if loaded or compiled:
            console.print(Text(f"compiled kernels: {loaded} loaded from numba's cache, {compiled} compiled"))


def _files(folder: Path) -> dict[Path, int]:
    """Files below a folder with the times of their last change [ns]."""
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


def _kernels() -> tuple[int, int]:
    """Signatures of the kernels of this process that came from numba's cache, and that were compiled."""
    loaded = compiled = 0
    for name, module in list(sys.modules.items()):
        if name.startswith(KERNELS):
            for value in list(vars(module).values()):
                stats = None if isinstance(value, type) else getattr(value, "stats", None)
                if stats is not None and value.__module__ == name:
                    loaded += sum(stats.cache_hits.values())
                    compiled += sum(stats.cache_misses.values())
    return loaded, compiled

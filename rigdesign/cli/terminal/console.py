"""The console of all commands, and how much they say."""

import codecs
import io
import os
import sys
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from rigdesign.base.errors import without_layout
from thermal.fe.kernel_cache import GIVEN, cache_folder, user_folder

if TYPE_CHECKING:
    from rigdesign.base.system import MachineFinding
    from rigdesign.cli.mesh_export import ExportedFile
    from rigdesign.measurement.comparison.compare import Comparison
    from rigdesign.results.result import RunResult

Verbosity = Literal["quiet", "normal", "verbose"]
"""quiet: errors and the verdict line; normal; verbose: every step with its time, iterations, cache use."""

verbosity: ContextVar[Verbosity] = ContextVar("verbosity", default="normal")
"""Of the command that runs, from ``--quiet`` and ``--verbose``."""


def new_console(*, stderr: bool = False, wrap: bool = False, width: int | None = None) -> Console:
    """A console that prints every text as it is: brackets and colons of a title are no markup.

    With ``--quiet`` it prints nothing; `verdict_console` does.
    """
    return _console(stderr=stderr, wrap=wrap, width=width, quiet=verbosity.get() == "quiet")


def verdict_console() -> Console:
    """The console of the one line that ``--quiet`` leaves."""
    return _console(stderr=False, wrap=False, width=None, quiet=False)


class _Console(Console):
    """A console in whose lines no text of others turns the direction of the rest."""

    def on_broken_pipe(self) -> None:
        """Leave it to the command, whose status rich would make that of a failing check."""
        raise

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        for segment in super().render(renderable, options):
            yield segment._replace(text=without_layout(segment.text))


def _console(*, stderr: bool, wrap: bool, width: int | None, quiet: bool) -> Console:
    return _Console(
        stderr=stderr,
        markup=False,
        emoji=False,
        highlight=False,
        soft_wrap=not wrap,
        width=width,
        quiet=quiet,
    )


NARROWEST = 30
"""Columns of a text beside its head, however narrow the terminal is."""


def hanging(console: Console, head: Text, text: str) -> None:
    """Print a head and a text whose further lines stand under its first one; nothing for an empty text."""
    for line in textwrap.wrap(text, max(NARROWEST, console.width - head.cell_len)):
        console.print(head + Text(line), soft_wrap=True)
        head = Text(" " * head.cell_len)


PLAIN = {
    "°": "deg", "²": "2", "³": "3", "µ": "u", "…": "...", "≤": "<=", "≥": ">=", "–": "-", "−": "-", "×": "x",
    "\u202f": " ", "\u00a0": " ", "→": "->", "“": '"', "”": '"', "’": "'", "α": "alpha", "β": "beta",
    "γ": "gamma", "ε": "epsilon", "σ": "sigma", "ρ": "rho", "φ": "phi",
    "⁰": "0", "¹": "1", "⁴": "4", "⁵": "5", "⁶": "6", "⁷": "7", "⁸": "8", "⁹": "9", "⁻": "-",
}  # fmt: skip
"""Signs of units and numbers in a stream whose encoding has none."""

EXPONENTS = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
"""After a digit they are the power of it, after a letter a part of a unit."""


def plain_streams() -> None:
    """Let streams whose encoding lacks a sign of a unit print words for it instead of ending in an error."""
    codecs.register_error("rigdesign.plain", _plain)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and not stream.encoding.lower().startswith("utf"):
            stream.reconfigure(errors="rigdesign.plain")


def _plain(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    signs = error.object[error.start : error.end]
    exponent = signs[0] in EXPONENTS and error.object[error.start - 1 : error.start].isdigit()
    return ("^" if exponent else "") + "".join(PLAIN.get(sign, "?") for sign in signs), error.end


# What a machine has, and the meshes that were written.


def print_findings(findings: Sequence["MachineFinding"]) -> None:
    """The lines of `rigdesign doctor`."""
    console = new_console()
    for finding in findings:
        mark = Text("ok      ", "green") if finding.ok else Text("missing ", "bold red")
        console.print(mark + Text(f"{finding.subject:12s} {finding.text}"))


def print_meshes(written: Sequence["ExportedFile"]) -> None:
    """Every file that was written, and what to do with it."""
    console = new_console()
    for done in written:
        console.print(f"{done.file}: {done.remark}")


# Measured data against the simulation.


def print_comparison(comparison: "Comparison", out: Path | None) -> None:
    """The verdict, what the data checks say, and where the pages are."""
    from rigdesign.measurement.comparison.compare import headline

    console = new_console()
    verdict_console().print(Text(headline(comparison), "bold"))
    for finding in comparison.findings:
        style = {"dropped": "red", "suspect": "yellow"}.get(finding.weight, "dim")
        console.print(Text(f"{finding.weight:8s}", style) + Text(finding.text))
    if out is not None:
        console.print(f"{out / 'compare.html'}")


# What ``--verbose`` adds, on stderr: iterations of the solvers, times of the parts, what the caches gave.
#
# Without it one line on caches that will not last.

KERNELS = ("dynamics.kernels.", "thermal.fe.")
"""Packages whose compiled functions are cached by numba."""


def print_run(result: "RunResult") -> None:
    """Iterations and last residuals of every held stage, seconds of every part; nothing unless asked for."""
    if verbosity.get() != "verbose":
        return
    from rigdesign.results.quantity import row

    console = new_console(stderr=True)
    for history in result.coupling:
        last = ", ".join(f"{key} {value:.2g}" for key, value in row(history.residuals[-1]).items())
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

"""The console of all commands, and how much they say."""

import codecs
import io
import sys
import textwrap
from collections.abc import Iterable, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from rigdesign.base.errors import without_layout

if TYPE_CHECKING:
    from rigdesign.base.system import MachineFinding
    from rigdesign.cli.mesh_export import ExportedFile
    from rigdesign.measurement.comparison.compare import Comparison

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

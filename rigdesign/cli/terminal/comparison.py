"""Measured data against the simulation."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verdict_console

if TYPE_CHECKING:
    from rigdesign.measurement.comparison.compare import Comparison


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

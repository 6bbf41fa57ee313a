"""The outcome of a study."""

from pathlib import Path
from typing import Any

from rich.text import Text

from rigdesign.cli.terminal.console import new_console


def print_study(outcome: Any, out: Path) -> None:
    """One line per point that failed, then where the table is."""
    console = new_console(wrap=True)
    for point in outcome.failed:
        console.print(Text("failed: ", "bold red") + Text(point))
    console.print(f"{outcome.completed} points computed, {outcome.reused} found done: {out / 'results.csv'}")

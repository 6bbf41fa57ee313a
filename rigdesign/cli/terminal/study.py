"""The outcome of a study."""

from pathlib import Path
from typing import Any

from rich.text import Text

from rigdesign.cli.terminal.console import new_console
from rigdesign.studies.selection import CheckSelection

MOST_FAILED = 10
"""Points without result that are named; results.csv has all."""


def print_study(outcome: Any, out: Path, selection: CheckSelection | None = None) -> None:
    """The answer in sentences, one line per point that failed, then where page and table are."""
    from rigdesign.report.margins.answer import study_answer

    console = new_console(wrap=True)
    found = getattr(outcome, "result", None)
    crossings = () if found is None else found.crossings
    for sentence in study_answer(outcome.points, selection or CheckSelection(), crossings).sentences:
        console.print(Text(sentence, "bold"))
    for point in outcome.failed[:MOST_FAILED]:
        console.print(Text("failed: ", "bold red") + Text(point))
    if len(outcome.failed) > MOST_FAILED:
        console.print(f"{len(outcome.failed) - MOST_FAILED} more points failed: see results.csv")
    console.print(f"{outcome.completed} points computed, {outcome.reused} found done")
    console.print(str(out / "study.html"), soft_wrap=True)
    console.print(str(out / "results.csv"), soft_wrap=True)

"""The outcome of a study."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verbosity, verdict_console

if TYPE_CHECKING:
    from rigdesign.studies.result import PassProbability, StudyResult
    from rigdesign.studies.run import StudyOutcome

MOST_FAILED = 5
"""Points without result that are named; results.csv has all."""
MOST_SLICES = 10
"""Values of a second input at which the range of the first is printed; the page has all."""
OTHER_TABLES = ("results.parquet", "results.xlsx")
LEAST_LIKELY = 5
"""Checks whose probability is printed, the lowest first."""


def print_study(outcome: "StudyOutcome", out: Path) -> None:
    """The answer in sentences, what failed, then where page and table are."""
    from rigdesign.report.margins.passing_range import influence_lines, slices, study_answer
    from rigdesign.report.numbers import counted

    found = outcome.result
    answer = study_answer(found)
    if verbosity.get() == "quiet":
        verdict_console().print(" ".join(answer.sentences))
        return
    console = new_console(wrap=True)
    for sentence in answer.sentences:
        console.print(Text(sentence, "bold"))
    ranges = slices(found.points, answer) if found.design == "grid" else None
    if ranges is not None:
        for text, sentence in ranges.rows[:MOST_SLICES]:
            console.print(f"  {ranges.over.name} {text}: {sentence}")
    for line in _probabilities(found):
        console.print(line)
    for line in influence_lines(found, answer):
        console.print(line)
    for warning in found.warnings:
        console.print(Text("warning: ", "yellow") + Text(warning.text))
    failed = outcome.failed
    for point in failed[:MOST_FAILED]:
        console.print(Text("failed: ", "bold red") + Text(point))
    if len(failed) > MOST_FAILED:
        console.print(f"{counted(len(failed) - MOST_FAILED, 'more point')} failed: see results.csv")
    console.print(f"{counted(outcome.completed, 'point')} computed, {outcome.reused} found done")
    others = [name for name in OTHER_TABLES if (out / name).is_file()]
    for name in ("study.html", "results.csv", *others):
        console.print(str(out / name), soft_wrap=True)


def _probabilities(found: "StudyResult") -> list[str]:
    """That all checks hold, then the checks least likely to hold; none of a design without samples."""
    titles = {
        check["id"]: check["title"] for point in found.points for check in point.record.get("checks", ())
    }
    lowest = sorted(found.probabilities, key=lambda row: row.probability)[:LEAST_LIKELY]
    lines = [] if found.all_hold is None else [f"All checks hold: {_share(found.all_hold)}"]
    return lines + [
        f"  {titles.get(row.check, row.check)}: {_share(row)}" for row in lowest if row.probability < 1.0
    ]


def _share(row: "PassProbability") -> str:
    low, share, high = (f"{100 * value:.3g}" for value in (row.low, row.probability, row.high))
    return f"{share} % of {row.samples} samples (95 %: {low} to {high} %)"

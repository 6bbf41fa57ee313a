"""What every input does to the checks, in lines for the terminal: Sobol indices and margins at the ends of an input."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TypeVar

from rigdesign.report.margins.answer import StudyAnswer
from rigdesign.report.margins.axis import input_name
from rigdesign.report.numbers import number_text
from rigdesign.studies.result import SobolIndex, StudyResult, Swing

MOST_CHECKS = 3
"""Checks with a line, the nearest to their limits first."""
MOST_INPUTS = 3
"""Inputs in a line, the strongest first."""

Influence = TypeVar("Influence", SobolIndex, Swing)


def by_check(answer: StudyAnswer, records: Iterable[Influence]) -> Iterator[tuple[str, list[Influence]]]:
    """Title and records of every selected check, the nearest to its limit first; what always fails comes last."""
    found: dict[str, list[Influence]] = {}
    for record in records:
        found.setdefault(record.check, []).append(record)
    for table in (answer.rest, answer.always):
        for column in table.nearest_first():
            check = table.checks[column]
            if check.id in found:
                yield check.title, found[check.id]


def influence_lines(study: StudyResult, answer: StudyAnswer) -> list[str]:
    """Headings and lines of the indices and of the ends of the inputs; none of a design without them."""
    lines = []
    indices = list(islice(by_check(answer, study.indices), MOST_CHECKS))
    if indices:
        lines.append("Total Sobol index of every input, with its 95 % interval:")
        lines += [f"  {title}: {_shares(chosen)}" for title, chosen in indices]
    swings = [(title, _ends(chosen)) for title, chosen in by_check(answer, study.swings)]
    moved = [(title, text) for title, text in swings if text][:MOST_CHECKS]
    if moved:
        lines.append("Margin at the lower and at the upper end of every input, the others as stated:")
        lines += [f"  {title}: {text}" for title, text in moved]
    return lines


def _shares(indices: Sequence[SobolIndex]) -> str:
    ordered = sorted(indices, key=lambda index: -index.total)[:MOST_INPUTS]
    return ", ".join(
        f"{input_name(index.path)} {index.total:.2f} ({index.total_interval[0]:.2f} to {index.total_interval[1]:.2f})"
        for index in ordered
    )


def _ends(swings: Sequence[Swing]) -> str:
    """Margins [%] at both ends of the inputs that move the check; empty where none does."""
    found = []
    for swing in swings:
        low, high = swing.distance_low, swing.distance_high
        if low is not None and high is not None and not swing.distance_stated == low == high:
            ends = (number_text(100.0 * end, 3) for end in (low, high))
            found.append((abs(high - low), f"{input_name(swing.path)} {' and '.join(ends)} %"))
    return ", ".join(text for _, text in sorted(found, key=lambda item: -item[0])[:MOST_INPUTS])

"""Two results against each other."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from textwrap import fill, wrap
from typing import TYPE_CHECKING, TypeVar

from rich.console import Console
from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verbosity, verdict_console
from rigdesign.report.numbers import change_text, limit_change_text, number_text, quantity_text

if TYPE_CHECKING:
    from rigdesign.studies.difference import CheckChange, QuantityChange, ResultsDifference, TextChanges
    from rigdesign.studies.stored_results import CheckedResults, InputChange

WIDTH = 80
"""Columns of a line at most."""
SHOWN = {"flipped": 4, "inputs": 6, "checks": 5, "results": 6, "texts": 2}
"""Entries of a part without --all."""
DISTANCE = "distance to the limit"
STYLES = {"fail": "bold red", "open": "magenta", "advisory": "yellow", "pass": "green"}

T = TypeVar("T")


def print_difference(difference: "ResultsDifference", out: Path | None, *, everything: bool = False) -> None:
    """Verdicts that flipped, inputs that changed, results that moved, assumptions and warnings that came and went.

    everything : all lines instead of the first of each part
    """
    from rigdesign.studies.difference import headline

    if verbosity.get() == "quiet":
        verdict_console().print(headline(difference))
        return
    console = new_console()
    width = min(WIDTH, console.width)

    def part(
        title: str, rows: Sequence[T], lines: Callable[[T], Iterable[Text]], key: str, of: str = ""
    ) -> None:
        if not rows:
            return
        heading = Text(f"{title} ({len(rows)})", "bold")
        console.print(_line(heading, "", of, width) if of else heading)
        shown = rows if everything else rows[: SHOWN[key]]
        for row in shown:
            for text in lines(row):
                text.truncate(width, overflow="ellipsis")
                console.print(text)
        if len(rows) > len(shown):
            console.print(Text(f"  … {len(rows) - len(shown)} more", "dim"))

    for name, results in (("A", difference.a), ("B", difference.b)):
        console.print(_source(name, results, width))
    for line in wrap(headline(difference), width):
        console.print(Text(line, "bold"))
    for notice in difference.notices:
        _wrapped(console, f"note: {notice}", width)
    failing = difference.checks_that("newly failing")
    part("now failing, not applicable before", failing, lambda row: _new_fail(row, width), "flipped")
    part("verdicts flipped", difference.flipped, lambda row: _flip(row, width), "flipped", DISTANCE)
    part("inputs changed", difference.inputs, lambda row: [_input(row, width)], "inputs")
    now, no_longer = difference.checks_that("now applicable"), difference.checks_that("no longer applicable")
    part("checks now applicable", now, lambda row: [_one_sided(row, width)], "checks")
    part("checks no longer applicable", no_longer, lambda row: [_one_sided(row, width)], "checks")
    moved = difference.checks_that("moved")
    part("other checks moved", moved, lambda row: [_moved(row, width)], "checks", DISTANCE)
    for name, single in (("A", difference.checks_that("removed")), ("B", difference.checks_that("added"))):
        part(f"checks in {name} only", single, lambda row: [_one_sided(row, width)], "checks")
    largest = _largest(difference.quantities)
    part("other results moved", largest, lambda row: [_quantity(row, width)], "results")
    for name, texts in (("assumptions", difference.assumptions), ("warnings", difference.warnings),
                        ("not modelled", difference.not_modelled)):  # fmt: skip
        part(f"{name} added or gone", _signed(texts), lambda row: [Text(f"  {row}")], "texts")
    if out is not None:
        console.print(str(out / "diff.html"))


def _source(name: str, results: "CheckedResults", width: int) -> Text:
    facts = f"  {results.name}, {results.fidelity}, {results.verdict}"
    return (
        Text(f"{name} ", "bold")
        + Text(_short_path(results.path, width - 2 - len(facts)))
        + Text(facts, "dim")
    )


def _short_path(path: Path, room: int) -> str:
    """The end of a path that is too long; the folder says which result it is."""
    text = str(path.parent if path.name == "results.json" else path)
    return text if len(text) <= room else f"…{text[-max(room - 1, 8) :]}"


def _flip(row: "CheckChange", width: int) -> Iterator[Text]:
    """Verdicts and distance; below what the numbers are, and why the new verdict is no pass."""
    assert row.before is not None and row.after is not None
    verdicts = Text("  ") + Text(row.before.verdict, STYLES[row.before.verdict]) + Text(" → ")
    verdicts += Text(row.after.verdict, STYLES[row.after.verdict])
    yield _line(verdicts, row.id, _distances(row), width)
    below = " " * (verdicts.cell_len + 2)
    yield from _below(row, _values(row), below, width)


def _below(row: "CheckChange", value: str, below: str, width: int) -> Iterator[Text]:
    """What the numbers of a check are, and why it does not pass now."""
    assert row.after is not None
    limit, text = limit_change_text(row), f"{below}{row.known.title}: {value}"
    limit = "" if limit == "–" else f"limit {limit}"
    if limit and len(text) + len(limit) + 2 <= width:
        text, limit = f"{text}, {limit}", ""
    yield Text(text)
    if limit:
        yield Text(below + limit)
    if row.after.verdict != "pass":
        yield Text(below + row.after.reason, "dim")


def _new_fail(row: "CheckChange", width: int) -> Iterator[Text]:
    """A check that fails and did not apply before."""
    yield _one_sided(row, width)
    yield from _below(row, quantity_text(row.known.value, row.known.unit), "    ", width)


def _moved(row: "CheckChange", width: int) -> Text:
    return _line(Text("  "), row.id, _distances(row), width)


def _one_sided(row: "CheckChange", width: int) -> Text:
    """A check that has numbers in one result only."""
    side = row.before if row.change in ("no longer applicable", "removed") else row.after
    assert side is not None
    distance = "" if side.distance is None else f", distance {number_text(100.0 * side.distance, 3)} %"
    return _line(Text("  "), row.id, f"{side.verdict}{distance}", width)


def _distances(row: "CheckChange") -> str:
    """Distance to the limit in as many digits as show that it moved."""
    before, after = (
        None if side is None or side.distance is None else 100.0 * side.distance
        for side in (row.before, row.after)
    )
    return change_text(before, after, "%")


def _values(row: "CheckChange") -> str:
    before, after = (None if side is None else side.value for side in (row.before, row.after))
    return change_text(before, after, row.known.unit)


def _input(row: "InputChange", width: int) -> Text:
    if row.change == "basis":
        return _line(Text("  source"), row.path, "value unchanged", width)
    before, after = ("none" if side is None else side.value for side in (row.before, row.after))
    return _line(Text("  "), row.path, f"{_clipped(before)} → {_clipped(after)}", width)


def _quantity(row: "QuantityChange", width: int) -> Text:
    name = f"{row.quantity}, {row.place}"
    if row.after is None:
        return _line(Text("  "), name, f"{quantity_text(row.before, row.unit)} → –", width)
    return _line(Text("  "), name, change_text(row.before, row.after, row.unit), width)


def _largest(rows: "Sequence[QuantityChange]") -> "list[QuantityChange]":
    """Of every kind of quantity the one that moved most, then the others."""
    first: dict[str, QuantityChange] = {}
    for row in rows:
        first.setdefault(row.quantity, row)
    return [*first.values(), *(row for row in rows if first[row.quantity] is not row)]


def _signed(texts: "TextChanges") -> list[str]:
    return [*(f"+ {text}" for text in texts.added), *(f"− {text}" for text in texts.gone)]


def _line(head: Text, name: str, end: str, width: int) -> Text:
    """Head, name and numbers in one line: the name gives way."""
    room = width - len(head.plain) - len(end) - 4
    shown = name if len(name) <= room else f"{name[: max(room - 1, 0)]}…"
    return head + Text("  " + shown.ljust(max(room, 0)) + "  ") + Text(end)


def _clipped(text: str, most: int = 22) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"


def _wrapped(console: Console, text: str, width: int) -> None:
    console.print(Text(fill(text, width, subsequent_indent="      "), "yellow"))

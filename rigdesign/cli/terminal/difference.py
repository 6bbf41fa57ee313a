"""Two results against each other."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from rich.console import Console
from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verbosity, verdict_console
from rigdesign.report.numbers import number_text, quantity_text, unit_text

if TYPE_CHECKING:
    from rigdesign.difference.document import ResultsDifference, TextChanges
    from rigdesign.difference.inputs import InputChange
    from rigdesign.difference.reading import CheckedResults
    from rigdesign.difference.results import CheckChange, QuantityChange

WIDTH = 80
"""Columns of a line at most."""
SHOWN = {"flipped": 8, "inputs": 6, "checks": 5, "results": 6, "texts": 2}
"""Lines of a part without --all."""
STYLES = {"fail": "bold red", "warn": "yellow", "pass": "green"}

T = TypeVar("T")


def print_difference(difference: "ResultsDifference", out: Path | None, *, everything: bool = False) -> None:
    """Verdicts that flipped, inputs that changed, results that moved, assumptions and warnings that came and went.

    everything : all lines instead of the first of each part
    """
    from rigdesign.difference.document import headline

    if verbosity.get() == "quiet":
        verdict_console().print(headline(difference))
        return
    console = new_console()
    width = min(WIDTH, console.width)

    def part(title: str, rows: Sequence[T], line: Callable[[T], Text], key: str) -> None:
        if not rows:
            return
        console.print(Text(f"{title} ({len(rows)})", "bold"))
        shown = rows if everything else rows[: SHOWN[key]]
        for row in shown:
            text = line(row)
            text.truncate(width, overflow="ellipsis")
            console.print(text)
        if len(rows) > len(shown):
            console.print(Text(f"  … {len(rows) - len(shown)} more", "dim"))

    for name, results in (("A", difference.a), ("B", difference.b)):
        console.print(_source(name, results, width))
    console.print(_cut(headline(difference), width, "bold"))
    for notice in difference.notices:
        _wrapped(console, f"note: {notice}", width)
    part("verdicts flipped", difference.flipped, lambda row: _flip(row, width), "flipped")
    part("inputs changed", difference.inputs, lambda row: _input(row, width), "inputs")
    rest = [row for row in difference.checks if row.change != "flipped"]
    part("checks moved, by change of utilisation", rest, lambda row: _check(row, width), "checks")
    part("other results moved", _largest(difference.quantities), lambda row: _quantity(row, width), "results")
    for name, texts in (("assumption", difference.assumptions), ("warning", difference.warnings),
                        ("not modelled", difference.not_modelled)):  # fmt: skip
        part(f"{name}, added or gone", _signed(texts), lambda row: Text(f"  {row}"), "texts")
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


def _flip(row: "CheckChange", width: int) -> Text:
    assert row.before is not None and row.after is not None
    verdicts = Text("  ") + Text(row.before.verdict, STYLES.get(row.before.verdict, "dim")) + Text(" → ")
    verdicts += Text(row.after.verdict, STYLES.get(row.after.verdict, "dim"))
    return _line(verdicts, row.known.title, _utilisations(row), width)


def _check(row: "CheckChange", width: int) -> Text:
    if row.change in ("added", "removed"):
        return _line(Text(f"  {row.change}"), row.known.title, row.known.verdict, width)
    change = row.utilisation_change
    first = "      " if change is None else f"{100 * change:+6.1f}".replace("-", "\u2212")
    return _line(Text(f"  {first} %"), row.known.title, _utilisations(row), width)


def _utilisations(row: "CheckChange") -> str:
    before, after = (None if side is None else side.utilisation for side in (row.before, row.after))
    return f"{number_text(before, 3)} → {number_text(after, 3)}"


def _input(row: "InputChange", width: int) -> Text:
    if row.change == "basis":
        return _line(Text("  source"), row.path, "value unchanged", width)
    before, after = ("none" if side is None else side.value for side in (row.before, row.after))
    return _line(Text("  "), row.path, f"{_clipped(before)} → {_clipped(after)}", width)


def _quantity(row: "QuantityChange", width: int) -> Text:
    after = quantity_text(row.after, row.unit)
    before = (
        number_text(row.before)
        if row.after is not None
        else f"{number_text(row.before)} {unit_text(row.unit)}"
    )
    return _line(Text("  "), f"{row.quantity}, {row.place}", f"{before} → {after}", width)


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


def _cut(text: str, width: int, style: str) -> Text:
    found = Text(text, style)
    found.truncate(width, overflow="ellipsis")
    return found


def _wrapped(console: Console, text: str, width: int) -> None:
    from textwrap import fill

    console.print(Text(fill(text, width, subsequent_indent="      "), "yellow"))

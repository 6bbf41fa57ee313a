"""Published numbers against ours."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import new_console

if TYPE_CHECKING:
    from rigdesign.validation import ValidationRow

VALIDATION_STYLES = {
    "gate held": "green", "goal met": "green", "goal missed": "yellow", "gate missed": "bold red",
    "not modelled": "dim",
}  # fmt: skip

WIDEST = 100
"""Columns of the table at most: a name far from its numbers is hard to follow."""
NUMBER_WIDTHS = (12, 17, 9)
"""Columns of published and computed number and of the deviation."""


def print_validation(rows: Sequence["ValidationRow"]) -> None:
    """Table of published and computed numbers, their assumptions and the headline."""
    console = new_console(wrap=True)
    console.print(Text("published numbers against ours", "bold"))
    console.print(_table(rows, min(console.width, WIDEST)))
    for assumptions, names in _by_assumptions(rows).items():
        console.print(Text(f"{', '.join(names)}: ", "bold") + Text(assumptions))
    _print_headline(console, rows)


def _table(rows: Sequence["ValidationRow"], width: int) -> Table:
    """Two lines a row: id, basis and verdict; quantity and numbers. Words in place of a number join the quantity."""
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), width=width, header_style="dim")
    table.add_column("id\n  quantity", ratio=1)
    for heading, columns in zip(("basis\npublished", "verdict\ncomputed", "\ndeviation"), NUMBER_WIDTHS):
        table.add_column(heading, justify="right", width=columns)
    for row in rows:
        verdict = Text(row.verdict, VALIDATION_STYLES.get(row.verdict, ""))
        table.add_row(Text(row.id, "bold"), Text(row.basis), verdict, "")
        short = len(row.published_text) <= NUMBER_WIDTHS[0]
        quantity = row.quantity if short else f"{row.quantity}; published: {row.published_text}"
        computed = f"{row.computed_text} {'' if row.unit == '1' else row.unit}".rstrip()
        deviation = "" if row.deviation is None else f"{round(100 * row.deviation, 2) + 0.0:+.2f} %"
        published = row.published_text if short else ""
        table.add_row(Padding(Text(quantity), (0, 0, 0, 2)), *map(Text, (published, computed, deviation)))
    return table


def _print_headline(console: Console, rows: Sequence["ValidationRow"]) -> None:
    """Predicted rows first, gates and goals by basis apart from them, then every row that misses its limit."""
    from rigdesign.validation import headline

    count = headline(rows)
    console.print(
        Text(
            f"predicted rows within their goal: {count['predicted_met']} of {count['predicted_with_goal']}",
            "bold",
        )
    )
    for kind, good in (("gates", "held"), ("goals", "met")):
        by_basis = "; ".join(
            f"{basis} {found[good]} {good}, {found['missed']} missed" for basis, found in count[kind].items()
        )
        console.print(
            f"{kind}: {count[f'{kind}_{good}']} {good}, {count[f'{kind}_missed']} missed"
            + (f" ({by_basis})" if by_basis else "")
        )
    console.print(f"not modelled: {count['not_modelled']} of {count['rows']} rows")
    for row in rows:
        if row.verdict in ("gate missed", "goal missed"):
            console.print(Text(_missed(row), VALIDATION_STYLES[row.verdict]))


def _missed(row: "ValidationRow") -> str:
    limit = ""
    if row.tolerance is not None and row.deviation is not None:
        limit = f": {100.0 * row.deviation:+.2f} %, allowed {100.0 * row.tolerance:.3g} %"
    elif row.window is not None:
        limit = f", allowed {row.window[0]:.6g} to {row.window[1]:.6g}"
    unit = "" if row.unit == "1" else f" {row.unit}"
    numbers = f"{row.computed_text}{unit} against {row.published_text}"
    return f"{row.verdict}: {row.id}, {row.quantity}, {numbers}{limit}"


def _by_assumptions(rows: Sequence["ValidationRow"]) -> dict[str, list[str]]:
    """Ids of the rows that depend on the same words."""
    found: dict[str, list[str]] = {}
    for row in rows:
        if row.assumptions:
            found.setdefault(row.assumptions, []).append(row.id)
    return found

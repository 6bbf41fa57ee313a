"""Published numbers against ours."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import new_console

if TYPE_CHECKING:
    from rigdesign.validation import ValidationRow

VALIDATION_STYLES = {
    "gate held": "green", "goal met": "green", "goal missed": "yellow", "gate missed": "bold red",
    "not modelled": "dim",
}  # fmt: skip

FILE_WIDTH = 200
"""Columns of the validation table where the output is no terminal."""


def print_validation(rows: Sequence["ValidationRow"]) -> None:
    """Table of published and computed numbers, their assumptions and the headline."""
    console = new_console(wrap=True)
    if not console.is_terminal:
        console = new_console(wrap=True, width=FILE_WIDTH)
    table = Table(title="published numbers against ours", title_justify="left", pad_edge=False)
    for heading, justify in (
        ("id", "left"), ("quantity", "left"), ("published", "right"), ("computed", "right"), ("unit", "left"),
        ("deviation", "right"), ("verdict", "left"), ("basis", "left"),
    ):  # fmt: skip
        table.add_column(heading, justify=justify)  # type: ignore[arg-type]
    for row in rows:
        deviation = "" if row.deviation is None else f"{100 * row.deviation:+.2f} %"
        cells = (row.id, row.quantity, row.published_text, row.computed_text, row.unit, deviation)
        style = VALIDATION_STYLES.get(row.verdict, "")
        table.add_row(*map(Text, cells), Text(row.verdict, style), Text(row.basis))
    console.print(table)
    for assumptions, names in _by_assumptions(rows).items():
        console.print(Text(f"{', '.join(names)}: ", "bold") + Text(assumptions))
    _print_headline(console, rows)


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

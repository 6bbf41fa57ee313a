"""The checks of a run."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import new_console
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from rigdesign.results.ranges import RangesResult

STYLES = {"pass": "green", "warn": "yellow", "fail": "bold red", "not applicable": "dim"}


def print_checks(result: RunResult, out: Path | None) -> None:
    """Checks grouped as in the report, failing ones explained, then the verdict."""
    console = new_console(wrap=True)
    table = Table(title=f"{result.case['title']}  ({result.fidelity})", title_justify="left", pad_edge=False)
    for heading, justify in (
        ("check", "left"), ("value", "right"), ("limit", "right"), ("margin", "right"), ("used", "right"),
        ("verdict", "left"),
    ):  # fmt: skip
        table.add_column(heading, justify=justify)  # type: ignore[arg-type]
    group = None
    for check in result.checks:
        if check.group != group:
            group = check.group
            table.add_section()
        table.add_row(*_check_cells(check))
    console.print(table)
    for check in result.checks:
        if check.verdict in ("fail", "warn"):
            console.print(
                Text(f"{check.verdict}: ", STYLES[check.verdict]) + Text(f"{check.title}: {check.reason}")
            )
    for record in result.warnings:
        console.print(Text(f"note {record.id}: ", "yellow") + Text(record.text))
    if result.ranges is not None:
        _print_ranges(console, result.ranges)
    console.print(Text("verdict: ") + Text(result.verdict, STYLES[result.verdict]))
    if out is not None:
        console.print(f"report: {out / 'report.html'}")


def _print_ranges(console: Console, ranges: "RangesResult") -> None:
    """How far the ranges of the assumed inputs reach, and the ends that have no result."""
    console.print(Text("ranges: ", "bold") + Text(ranges.method))
    hottest = ranges.max_temperature
    if hottest is not None:
        console.print(
            f"highest temperature over the ranges: {hottest.low_degC:.1f} to {hottest.high_degC:.1f} degC, stated "
            f"{hottest.stated_degC:.1f} degC"
        )
    for entry in ranges.inputs:
        for value, error in ((entry.low, entry.low_error), (entry.high, entry.high_error)):
            if error is not None:
                console.print(Text("no result: ", "yellow") + Text(f"{entry.path} = {value}: {error}"))


def _check_cells(check: Check) -> tuple[Text, ...]:
    limit = _number(check.limit)
    if check.upper_limit is not None:
        limit = f"{limit} … {_number(check.upper_limit)}"
    used = "" if check.utilisation is None else f"{100 * check.utilisation:.0f} %"
    margin = "" if check.margin is None else f"{_number(check.margin)} {check.unit}"
    value = "" if check.value is None else f"{_number(check.value)} {check.unit}"
    cells = (check.title, value, f"{check.comparison} {limit}" if limit else "", margin, used)
    return (*map(Text, cells), Text(check.verdict, STYLES[check.verdict]))


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"

"""What the commands show in a terminal: progress on stderr, tables on stdout."""

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from rigdesign.results.check import Check
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from rigdesign.base.system import MachineFinding
    from rigdesign.diagnosis.document.outcome import Outcome
    from rigdesign.diagnosis.run import Calibrated
    from rigdesign.measurement.comparison.compare import Comparison
    from rigdesign.results.ranges import RangesResult
    from rigdesign.validation import ValidationRow

STYLES = {"pass": "green", "warn": "yellow", "fail": "bold red", "not applicable": "dim"}

VALIDATION_STYLES = {
    "gate held": "green", "goal met": "green", "goal missed": "yellow", "gate missed": "bold red",
    "not modelled": "dim",
}  # fmt: skip
FILE_WIDTH = 200
"""Columns of the validation table where the output is no terminal."""


def _console(*, stderr: bool = False, wrap: bool = False, width: int | None = None) -> Console:
    """A console that prints every text as it is: brackets and colons of a title are no markup."""
    return Console(stderr=stderr, markup=False, emoji=False, highlight=False, soft_wrap=not wrap, width=width)


class Progress:
    """Says what is being computed: a spinner in a terminal, plain lines elsewhere."""

    def __init__(self) -> None:
        self._console = _console(stderr=True)
        self._status = self._console.status("starting") if self._console.is_terminal else None
        self._started = time.perf_counter()

    def __enter__(self) -> "Progress":
        if self._status is not None:
            self._status.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._status is not None:
            self._status.stop()

    def count(self, done: int, whole: int, last: str) -> None:
        """Show how many of many are done as a bar; a line for every tenth where the output is no terminal."""
        if self._status is not None:
            row = Table.grid(padding=(0, 1))
            row.add_row(self._elapsed(), ProgressBar(whole, done, width=30), f"{done} of {whole}", Text(last))
            self._status.update(row)
        elif done == whole or 10 * done // whole > 10 * (done - 1) // whole:
            self(f"{done} of {whole}, last {last}")

    def _elapsed(self) -> str:
        return f"{time.perf_counter() - self._started:6.1f} s"

    def note(self, message: str) -> None:
        """Show ``message`` so that it stays."""
        self._console.print(Text("note: ", "yellow") + Text(message), soft_wrap=True)

    def __call__(self, message: str) -> None:
        """Show ``message`` with the seconds since the start."""
        text = f"{self._elapsed()}  {message}"
        if self._status is not None:
            self._status.update(Text(text))
        else:
            print(text, file=sys.stderr, flush=True)


def print_checks(result: RunResult, out: Path | None) -> None:
    """Checks grouped as in the report, failing ones explained, then the verdict."""
    console = _console(wrap=True)
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


def print_study(outcome: Any, out: Path) -> None:
    """One line per point that failed, then where the table is."""
    console = _console(wrap=True)
    for point in outcome.failed:
        console.print(Text("failed: ", "bold red") + Text(point))
    console.print(f"{outcome.completed} points computed, {outcome.reused} found done: {out / 'results.csv'}")


def print_comparison(comparison: "Comparison", out: Path | None) -> None:
    """The verdict, what the data checks say, and where the pages are."""
    from rigdesign.measurement.comparison.compare import headline

    console = _console()
    console.print(Text(headline(comparison), "bold"))
    for finding in comparison.findings:
        style = {"dropped": "red", "suspect": "yellow"}.get(finding.weight, "dim")
        console.print(Text(f"{finding.weight:8s}", style) + Text(finding.text))
    if out is not None:
        console.print(f"{out / 'compare.html'}")


def print_meshes(written: Sequence[tuple[str, Path, int]]) -> None:
    """Every mesh that was written, and the lines that make a case read it."""
    console = _console()
    for name, file, nodes in written:
        console.print(f'{file}: {nodes} nodes; [gearboxes.{name}.housing] mesh_file = "{file.name}" reads it')


DIAGNOSIS_STYLES = {"named": "bold green", "within_noise": "green", "input_error_suspected": "bold red"}


def print_constants(found: "Calibrated", out: Path) -> None:
    """Every constant that a healthy set narrows: its value, its interval, and what it was known to before."""
    console = _console()
    entries = found.constants.entries
    if not entries:
        console.print("no constant of the case is known better from this set than before")
    for entry in entries:
        parameter = entry.effect.parameters[0]
        low, high = (
            parameter.value(entry.coordinate + sign * 1.96 * entry.deviation) for sign in (-1.0, 1.0)
        )
        value = f"{parameter.value(entry.coordinate):.4g} ({low:.4g} to {high:.4g}) {parameter.unit}".rstrip()
        narrowed = f"{entry.deviation / entry.before:.0%} of the spread before"
        console.print(Text(f"{entry.effect.title}: {parameter.name} {value}, {narrowed}"))
    console.print(Text(f"calibrated case: {out / 'calibrated' / 'case.toml'}"))


MOST_DOUBTS = 4
"""Suspected input errors that are printed."""


def print_diagnosis(outcome: "Outcome", out: Path) -> None:
    """Verdict, where, what and how big, the gap, what remains, what next, and where the files are."""
    from rigdesign.diagnosis.decision.naming import formatted
    from rigdesign.diagnosis.document.advice import VERDICTS, certainty, headline, steps
    from rigdesign.diagnosis.document.document import sentences

    console = _console()
    found, measurement = outcome.result.diagnosis, outcome.result.measurement
    style = DIAGNOSIS_STYLES.get(outcome.verdict, "bold yellow")
    console.print(Text(VERDICTS[outcome.verdict], style) + Text(f" ({found.strength})", "dim"))
    console.print(Text(headline(outcome)))
    console.print(Text(certainty(outcome), "dim"))
    for text in sentences(outcome.before, measurement)[:3]:
        console.print(Text("where     ", "bold") + Text(text))
    for one in outcome.named:
        sizes = "; ".join(formatted(value) for value in one.shown)
        console.print(Text("effect    ", "bold") + Text(f"{one.explanation}: {sizes}, 95 % interval"))
    for suspect in () if outcome.verdict == "within_noise" else outcome.suspects:
        share = f"{100.0 * suspect.inclusion:.0f} %"
        size = "" if suspect.size is None else f"; alone {formatted(suspect.size.shown[0])}"
        console.print(Text("perhaps   ", "bold") + Text(f"{suspect.name}: posterior {share}{size}"))
    doubts = [one.text for one in outcome.result.data.findings if one.weight == "suspect"]
    for text in doubts[:MOST_DOUBTS]:
        console.print(Text("suspect   ", "bold yellow") + Text(text))
    if len(doubts) > MOST_DOUBTS:
        console.print(Text(f"          {len(doubts) - MOST_DOUBTS} more in the report", "dim"))
    for refusal in found.refused:
        against = "bold red" if refusal.gap is not None and refusal.gap.grown else ""
        console.print(Text("not named ", "bold") + Text(f"{refusal.name}: {refusal.reason}", against))
    if outcome.gap is not None and outcome.in_model:
        text = (
            f"{outcome.gap.before:.2f} -> {outcome.gap.after:.2f} standard deviations on points the fit never saw "
            f"({', '.join(outcome.gap.points)}), a healthy rig has 1"
        )
        console.print(Text("gap       ", "bold") + Text(text, "bold red" if outcome.gap.grown else ""))
    left = sentences(outcome.after, measurement) if outcome.named else []
    for text in left[:3]:
        console.print(Text("remains   ", "bold") + Text(text))
    for step in steps(outcome)[:5]:
        console.print(Text("next      ", "bold") + Text(f"{step.text}: {step.why}"))
    if outcome.case_patch is not None:
        console.print(f"patched case: {out / 'patched' / 'case.toml'}")
    else:
        console.print(f"case not patched: {outcome.refused}")
    console.print(f"report: {out / 'diagnosis.html'}")


def print_findings(findings: Sequence["MachineFinding"]) -> None:
    """The lines of `rigdesign doctor`."""
    console = _console()
    for finding in findings:
        mark = Text("ok      ", "green") if finding.ok else Text("missing ", "bold red")
        console.print(mark + Text(f"{finding.subject:12s} {finding.text}"))


def print_validation(rows: Sequence["ValidationRow"]) -> None:
    """Table of published and computed numbers, their assumptions and the headline."""
    console = _console(wrap=True)
    if not console.is_terminal:
        console = _console(wrap=True, width=FILE_WIDTH)
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

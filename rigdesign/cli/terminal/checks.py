"""The checks of a run: what decides on one screen, or all of them."""

import re
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from rigdesign.base.errors import one_line
from rigdesign.checks.rules import CLOSE
from rigdesign.cli.terminal.console import NARROWEST, hanging, new_console, verbosity, verdict_console
from rigdesign.report.numbers import limit_text, margin_text, percent_text, quantity_text, value_text
from rigdesign.report.views import sorted_checks
from rigdesign.results.check import Check, Flag
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from rigdesign.results.ranges import RangesResult

STYLES = {
    "pass": "green",
    "open": "magenta",
    "fail": "bold red",
    "advisory": "yellow",
    "not applicable": "dim",
}
MOST_GROUPS = 5
"""Groups of open checks and of flags that are printed; failing checks are printed whatever their number."""
NEAREST = 5
"""Checks of the table of margins."""
MOST_FAILED_ENDS = 3
"""Ends of ranges without a result that are printed."""


def print_checks(result: RunResult, out: Path | None, *, everything: bool = False) -> None:
    """What decides: verdict, failing checks, open ones and flags by reason, nearest margins, counts; or everything."""
    if verbosity.get() == "quiet":
        _print_verdict(verdict_console(), result)
        return
    console = new_console(wrap=True)
    console.print(Text(f"{one_line(result.case['title'])}  ({result.fidelity})", "bold"))
    _print_verdict(console, result)
    if everything:
        _print_all(console, result)
    else:
        _print_summary(console, result)
    if result.ranges is not None:
        _print_ranges(console, result.ranges, everything=everything)
    if out is not None:
        printed = [out / "report.pdf"] if (out / "report.pdf").is_file() else []
        console.print(f"report: {', '.join(map(str, [out / 'report.html', *printed]))}")


def _print_verdict(console: Console, result: RunResult) -> None:
    counts = ", ".join(f"{number} {status}" for status, number in result.counts.items() if number)
    console.print(Text("verdict: ") + Text(result.verdict, STYLES[result.verdict]) + Text(f" ({counts})"))


def _print_summary(console: Console, result: RunResult) -> None:
    for check in sorted_checks(result.checks):
        if check.status == "fail":
            against = f"{value_text(check)}, limit {limit_text(check)}"
            hanging(console, Text("fail: ", STYLES["fail"]), f"{check.title}: {against}")
            hanging(console, Text(" " * 6), check.reason.partition("; ")[0])
    unusual = [record.text for record in result.warnings if record.id == "unusual_input"]
    for text in unusual[:MOST_GROUPS]:
        hanging(console, Text("unusual: ", "yellow"), text)
    if len(unusual) > MOST_GROUPS:
        console.print(f"         {len(unusual) - MOST_GROUPS} more unusual inputs: --all")
    _print_reasons(console, result.checks)
    _print_nearest(console, result.checks)
    _print_not_applicable(console, result.checks)
    if result.warnings:
        kinds = Counter(record.id for record in result.warnings)
        listed = ", ".join(f"{number} {kind}" for kind, number in kinds.most_common())
        hanging(console, Text("notes: "), f"{listed}; --all prints them and every check")


def _print_reasons(console: Console, checks: Iterable[Check]) -> None:
    """Why checks are open, which limits are advisory and missed, what is close or in doubt."""
    groups = reason_groups(checks)
    for group in groups[:MOST_GROUPS]:
        hanging(console, Text(f"{group.head}: ", STYLES.get(group.head, "yellow")), group.text)
    if len(groups) > MOST_GROUPS:
        console.print(f"      {len(groups) - MOST_GROUPS} more reasons: --all")


def _print_nearest(console: Console, checks: Sequence[Check]) -> None:
    """The checks that hold with the least left; those that hold by definition predict nothing and are left out."""
    held = [
        c
        for c in sorted_checks(checks)
        if c.distance is not None and c.status in ("pass", "open") and not c.missed
    ]
    stated = sum(check.by_definition for check in held)
    predicted = [check for check in held if not check.by_definition]
    nearest = sorted(predicted, key=lambda check: check.distance or 0.0)[:NEAREST]
    if not nearest:
        return
    table = _table("nearest margins", "distance")
    for check in nearest:
        value, limit, _, distance = map(Text, _numbers(check))
        table.add_row(Text(check.id), value, limit, distance)
    console.print(table)
    if stated:
        number = "1 check" if stated == 1 else f"{stated} checks"
        console.print(f"{number} of one input against another: not in this list")


def _print_not_applicable(console: Console, checks: Iterable[Check]) -> None:
    reasons = Counter(check.reason for check in checks if check.verdict == "not applicable")
    for reason, number in reasons.most_common(2):
        hanging(console, Text(f"{number} not applicable: ", STYLES["not applicable"]), reason)
    if len(reasons) > 2:
        rest = sum(number for _, number in reasons.most_common()[2:])
        console.print(Text(f"{rest} not applicable for other reasons", STYLES["not applicable"]))


def _table(first: str, *further: str) -> Table:
    """A table of checks: what, value, limit, and further numbers."""
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column(first, overflow="fold")
    for heading in ("value", "limit", *further):
        table.add_column(heading, justify="right")
    return table


def _numbers(check: Check) -> tuple[str, str, str, str]:
    """Value, limit and margin in their units, distance."""
    distance = "" if check.distance is None else percent_text(check.distance)
    value = "" if check.value is None else value_text(check)
    limit = "" if check.limit is None else limit_text(check)
    return value, limit, "" if check.margin is None else margin_text(check), distance


def _print_all(console: Console, result: RunResult) -> None:
    """Checks grouped as in the report, the reason of each that does not simply pass, every note; all by their ids."""
    _print_every_check(console, [check for check in result.checks if check.verdict != "not applicable"])
    for check in result.checks:
        if check.status != "pass" or check.flags:
            flags = [flag for flag in check.flags if flag != "advisory"]
            head = ", ".join([check.status, *flags] if check.status != "pass" else flags)
            hanging(console, Text(f"{head}: ", STYLES[check.status]), f"{check.id}: {check.reason}")
    for record in result.warnings:
        hanging(console, Text(f"note {record.id}: ", "yellow"), record.text)


def _print_every_check(console: Console, checks: Sequence[Check]) -> None:
    """Two lines a check: id, margin, distance and verdict; title, value and limit."""
    rows = [_numbers(check) for check in checks]
    values, limits, margins, _ = (
        max(map(cell_len, column)) for column in zip(("value", "limit", "margin", "distance"), *rows)
    )

    def first_line(identity: str, margin: str, distance: str, verdict: Text) -> None:
        numbers = f"{margin:>{margins}}  {distance:>8}  "
        room = console.width - len(numbers) - len("verdict")
        console.print(Text(f"{identity:{room}}{numbers}") + verdict, soft_wrap=True)

    def second_line(title: str, value: str, limit: str) -> None:
        numbers = f"{value:>{values}}  {limit:>{limits}}"
        room = max(NARROWEST, console.width - len(numbers) - 4)
        start, *rest = textwrap.wrap(title, room)
        for text in (f"  {start:{room}}  {numbers}", *(f"  {part}" for part in rest)):
            console.print(Text(text), soft_wrap=True)

    first_line("check", "margin", "distance", Text("verdict"))
    second_line("title", "value", "limit")
    group = None
    for check, (value, limit, margin, distance) in zip(checks, rows):
        if check.group != group:
            group = check.group
            console.print(Text(group, "bold"))
        first_line(check.id, margin, distance, Text(check.status, STYLES[check.status]))
        second_line(check.title, value, limit)


def _print_ranges(console: Console, ranges: "RangesResult", *, everything: bool) -> None:
    """How far the ranges of the assumed inputs reach, and the ends that have no result."""
    if everything:
        console.print(Text("ranges: ", "bold") + Text(ranges.method))
    hottest = ranges.max_temperature
    if hottest is not None:
        low, high, stated = (
            quantity_text(value, "degC")
            for value in (
                round(hottest.low_degC, 1),
                round(hottest.high_degC, 1),
                round(hottest.stated_degC, 1),
            )
        )
        console.print(f"highest temperature over the ranges: {low} to {high}, stated {stated}")
    failed = [
        f"{entry.path} = {value}: {error}"
        for entry in ranges.inputs
        for value, error in ((entry.low, entry.low_error), (entry.high, entry.high_error))
        if error is not None
    ]
    for text in failed if everything else failed[:MOST_FAILED_ENDS]:
        console.print(Text("no result: ", "yellow") + Text(text))
    if not everything and len(failed) > MOST_FAILED_ENDS:
        console.print(f"no result at {len(failed) - MOST_FAILED_ENDS} more ends: --all")


# Why checks are open, advisory, close or in doubt, by reason: most of them share a few.

OF_GEARBOX = re.compile(r"\bgearbox (\w+)\b")
DECIDED = "decided by assumption "
"""How the doubt of a check begins that does not hold over a range."""


NO_HOUSING, UNEXPANDED = "it has no housing", "its housing is not expanded"
"""Two reasons of one gearbox, of which the first holds the second."""


@dataclass(frozen=True)
class ReasonGroup:
    """Checks that are open, or carry a flag, for one reason."""

    head: str
    """``open``, ``advisory``, ``close`` or ``doubt``."""

    reason: str
    """With the verb in the number of the checks: ``leave out …``."""
    checks: tuple[Check, ...]

    @property
    def text(self) -> str:
        """The checks and the reason: a number of checks, or the id of the only one."""
        who = self.checks[0].id if len(self.checks) == 1 else f"{len(self.checks)} checks"
        return f"{who}{' ' if self.reason.startswith(VERBS) else ': '}{self.reason}"


@dataclass(frozen=True)
class _Cause:
    """One cause.

    kind : advisory, close, error, decided, gearbox, left out, open or doubt
    scope : what the checks of a group have in common beyond the kind: a gearbox, a reason
    what, why : what a value leaves out, and why
    """

    kind: str
    scope: str = ""
    what: str = ""
    why: str = ""


WORDS = {
    "advisory": ("misses a limit that does not bind", "miss limits that do not bind"),
    "close": (
        f"has less than {100 * CLOSE:.0f} % of its limit left",
        f"have less than {100 * CLOSE:.0f} % of their limits left",
    ),
    "error": ("has a margin below the error of its value", "have margins below the errors of their values"),
}
"""Causes without further words, of one check and of several."""
VERBS = ("leave", "has ", "have ", "miss", "is ", "are ")
"""Beginnings of reasons that follow their subject."""
FLAGS: tuple[Flag, ...] = get_args(Flag)
"""Causes that are flags; all others make a check open."""


def reason_groups(checks: Iterable[Check]) -> list[ReasonGroup]:
    """The checks that do not simply pass or fail by cause, open ones first, then the largest group; a check with
    several causes is in several groups."""
    found: dict[tuple[str, str], list[tuple[_Cause, Check]]] = {}
    for check in checks:
        for cause in _causes(check):
            found.setdefault((cause.kind, cause.scope), []).append((cause, check))
    together: dict[tuple[object, ...], list[_Cause]] = {}
    members: dict[tuple[object, ...], tuple[Check, ...]] = {}
    for (kind, scope), entries in found.items():
        own = {check.id: check for _, check in entries}
        key = (kind, *own) if kind == "gearbox" else (kind, scope)
        together.setdefault(key, []).extend(cause for cause, _ in entries)
        members[key] = tuple(own.values())
    groups = [
        ReasonGroup(
            head=kind if (kind := causes[0].kind) in FLAGS else "open",
            reason=_reason(causes, len(members[key])),
            checks=members[key],
        )
        for key, causes in together.items()
    ]
    return sorted(groups, key=lambda group: (group.head != "open", -len(group.checks)))


def _causes(check: Check) -> Iterator[_Cause]:
    """Of its flags, and why it is open, from its record; the words of its reason where nothing else tells."""
    for flag in check.flags:
        yield _Cause(flag, check.reason if flag == "doubt" else "", why=check.reason.rpartition("; ")[2])
    if check.verdict != "open":
        return
    causes = []
    error = check.error
    if error is not None and check.margin is not None and abs(check.margin) < error:
        causes.append(_Cause("error"))
    doubts = [part for part in check.reason.split("; ") if part.startswith(DECIDED)]
    causes += [_Cause("decided", part, why=part) for part in doubts]
    for text in check.left_out:
        what, _, why = text.rpartition(": ")
        box = OF_GEARBOX.search(what)
        kind, scope = ("gearbox", box[1]) if box is not None else ("left out", why if what else text)
        causes.append(_Cause(kind, scope, what or text, why if what else ""))
    yield from causes or [_Cause("open", check.reason, why=check.reason.rpartition("; ")[2])]


def _reason(causes: list[_Cause], number: int) -> str:
    """Words for causes of one kind, with the verb for a number of checks."""
    kind = causes[0].kind
    if kind in WORDS:
        return WORDS[kind][number > 1]
    if kind == "decided":
        return f"{'are' if number > 1 else 'is'} {causes[0].why}"
    if kind in ("open", "doubt"):
        return causes[0].why
    whats = list(dict.fromkeys(cause.what for cause in causes))
    whys = list(dict.fromkeys(cause.why for cause in causes if cause.why))
    if NO_HOUSING in whys and UNEXPANDED in whys:
        whys.remove(UNEXPANDED)
    what = whats[0] if len(whats) == 1 else f"{whats[0]} and {len(whats) - 1} more"
    if kind == "gearbox" and len(whats) > 1:
        what = "effects in gearbox " + " and ".join(dict.fromkeys(cause.scope for cause in causes))
    return f"leave{'' if number > 1 else 's'} out {': '.join([what, '; '.join(whys)] if whys else [what])}"

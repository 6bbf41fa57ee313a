"""A case, a key or a check explained."""

import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import hanging, new_console
from rigdesign.explanation.built_in import BuiltIn
from rigdesign.explanation.check import CheckExplanation
from rigdesign.explanation.keys import KeyEntry, PathExplanation, StatedValue
from rigdesign.explanation.overview import Overview
from rigdesign.report.numbers import (
    cell_text,
    heading_text,
    number_text,
    percent_text,
    quantity_text,
    unit_text,
)

HEAD = 11
"""Columns of the word before an answer."""
MOST_IDS = 24
"""Ids of checks that are listed; beyond that those that are not are fewer to read."""
MOST_INPUTS = 12
"""Inputs of a check that are listed one by one."""
COMPARISONS = {"<=": "at most", ">=": "at least", "within": "within"}


def print_overview(seen: Overview, case: Path) -> None:
    """Parts, schedule, inputs by where they come from, checks, and what to do next."""
    console = new_console(wrap=True)
    console.print(Text(f"{seen.title}  ({seen.name})", "bold"))
    for name, text in seen.gearboxes.items():
        _answer(console, "gearbox", f"{name}: {text}")
    _answer(console, "drivetrain", seen.drivetrain or "none: losses are given, no loads are computed")
    table = _table("stage", "ends at", "torque", "takes", "")
    for stage in seen.stages:
        held = "held" if stage.held else ""
        table.add_row(
            *map(Text, (f"{stage.name} ({stage.kind})", stage.speed, stage.torque, stage.duration, held))
        )
    console.print(table)
    counts = ", ".join(f"{number} {basis}" for basis, number in seen.inputs.items())
    _answer(console, "inputs", f"{sum(seen.inputs.values())}: {counts}; {seen.ranged} assumed with a range")
    for text in seen.unusual:
        _answer(console, "unusual", text)
    groups = ", ".join(f"{group} {len(found)}" for group, found in seen.checks.items())
    unlimited = f"; {len(seen.unlimited)} more without a limit in this case" if seen.unlimited else ""
    _answer(
        console, "checks", f"{sum(map(len, seen.checks.values()))}: {groups}{unlimited}; --json lists them"
    )
    for command in (
        f"rigdesign check {case} --fidelity quick --out results",
        f"rigdesign explain {case} PATH, e.g. {_example(seen)}.oil.inlet_temperature",
        f"rigdesign explain {case} --check {next(iter(seen.checks.values()))[0]}" if seen.checks else "",
        "rigdesign list limits" if seen.unlimited else "",
    ):
        if command:
            _answer(console, "next", command)


def print_built_in(found: BuiltIn) -> None:
    """A table of the rows, then where their numbers come from; of limits what each is for."""
    console = new_console(wrap=True)
    columns = [key for key in found.rows[0] if key not in ("source", "checks", "filled_in")]
    if found.kind == "limits":
        for row in found.rows:
            span = f" ({row['range']})" if row["range"] else ""
            default = f"default {row['default']}{span}: " if row["filled_in"] else ""
            checks = f"; checks {', '.join(row['checks'])}" if row["checks"] else ""
            console.print(Text(row["name"], "bold") + Text(f"  {row['holds']}", "dim"))
            hanging(console, Text("  "), f"{default}{row['source']}{checks}")
    else:
        table = Table(box=None, pad_edge=False, header_style="dim")
        for key in columns:
            number = isinstance(found.rows[0][key], float) or key.endswith(("MPa", "stage"))
            table.add_column(
                Text(heading_text(key)),
                justify="right" if number else "left",
                overflow="fold",
                no_wrap=key == "name",
            )
        for row in found.rows:
            table.add_row(*(Text(cell_text(row[key])) for key in columns))
        console.print(table)
        sources: dict[str, list[str]] = {}
        for row in found.rows:
            sources.setdefault(row["source"], []).append(row["name"])
        for source, names in sources.items():
            of = "" if len(sources) == 1 else f"{', '.join(names)}: "
            hanging(console, Text("source: ", "dim"), of + source)
    hanging(console, Text("use: ", "dim"), found.note)


def print_path(found: PathExplanation) -> None:
    """What a key is, its value and where that comes from, which checks depend on it."""
    console = new_console(wrap=True)
    console.print(Text(found.asked, "bold"))
    _answer(console, "is", _plain(found.key.description))
    if found.key.variant:
        _answer(console, "where", found.key.variant)
    if found.key.table:
        _print_keys(console, found)
        return
    _answer(console, "holds", _holds(found.key))
    _answer(console, "default", found.key.default_text)
    for value in found.values:
        place = f"{value.path}: " if len(found.values) > 1 else ""
        _answer(console, "value", f"{place}{_value(value)}")
    for text in found.unusual:
        _answer(console, "unusual", text)
    if found.influences:
        _answer(console, "moves", ", ".join(found.influences))
    _answer(console, "checks", _checks(found.checks, found.all_checks))


def print_check(found: CheckExplanation, case: Path) -> None:
    """Rule, limit, procedure, source, what it needs, its inputs."""
    console = new_console(wrap=True)
    console.print(Text(f"{found.id}: {found.title}", "bold"))
    _answer(console, "rule", f"{COMPARISONS[found.comparison]} {_limits(found)}")
    _answer(console, "value", found.procedure)
    _answer(console, "source", found.source)
    if found.needs:
        _answer(console, "needs", ", ".join(found.needs))
    if not found.applicable:
        _answer(console, "so", "the check does not apply to this case")
    done = found.finished
    if done is not None:
        distance = "" if done.distance is None else f", distance {percent_text(done.distance)}"
        margin = (
            "" if done.margin is None else f", margin {quantity_text(done.margin, _difference(done.unit))}"
        )
        _answer(
            console,
            "result",
            f"{done.verdict}: {quantity_text(done.value, done.unit)}{margin}{distance}; {done.reason}",
        )
        if not done.same_case:
            _answer(console, "note", f"{done.folder} holds results of another state of the case")
        if not done.ranged:
            _answer(console, "note", f"{done.folder} holds no ranges")
    if found.ranked:
        _print_ranking(console, found)
    else:
        _print_inputs(console, found, case)


def _answer(console: Console, head: str, text: str) -> None:
    hanging(console, Text(f"{head:{HEAD}s}", "bold" if head else ""), text)


def _plain(description: str) -> str:
    return description.replace("``", "")


def _holds(key: KeyEntry) -> str:
    """Kind, units and bounds of a key."""
    accepted = f" in {', '.join(key.units)}" if key.units else ""
    return f"{key.kind}{accepted}{f'; {key.bounds}' if key.bounds else ''}"


def _value(value: StatedValue) -> str:
    """A value with where it comes from."""
    if value.basis == "left out":
        return "left out"
    said = f"{value.basis}: {value.reason}" if value.reason else value.basis
    words = "stated by the case" if value.basis == "stated" else said
    limits = "" if value.range is None else f"; range {value.range[0]} to {value.range[1]}"
    return f"{value.value} ({words}{limits})"


def _checks(ids: Sequence[str], whole: int) -> str:
    if not ids:
        return "none depends on it"
    if len(ids) == whole:
        return f"all {whole} depend on it"
    if len(ids) > MOST_IDS:
        groups = ", ".join(dict.fromkeys(one.partition(".")[0] for one in ids))
        return f"{len(ids)} of {whole} depend on it, of {groups}; --json lists them"
    return f"{len(ids)} of {whole} depend on it: {', '.join(ids)}"


def _print_keys(console: Console, found: PathExplanation) -> None:
    """Keys of a table with their values in this case."""
    table = _table("key", "value", "what it is")
    table.columns[1].justify = "left"
    table.columns[2].justify = "left"
    for value in found.keys:
        name = value.path.rpartition(".")[2]
        shown = "table" if value.table else value.value or "left out"
        shown = textwrap.shorten(shown, 24, placeholder="...")
        first = _plain(value.description).partition(". ")[0]
        sign = " *" if value.basis == "assumed" else " +" if _by_the_tool(value) else ""
        table.add_row(Text(name), Text(shown + sign), Text(first))
    console.print(table)
    if any(value.basis == "assumed" for value in found.keys):
        console.print("* assumed")
    if any(map(_by_the_tool, found.keys)):
        console.print("+ default of the tool for this case; ask for the key to see its reason and range")


def _by_the_tool(value: StatedValue) -> bool:
    """Whether the tool has worked out a value that the case leaves out."""
    return value.basis == "default" and bool(value.reason)


def _limits(found: CheckExplanation) -> str:
    stated = [limit for limit in found.limits if limit.value]
    keys = ", ".join(limit.path for limit in found.limits)
    if not stated:
        return f"{keys}: the case states no limit"
    return f"{' to '.join(limit.value for limit in stated)} ({keys}); shown in {unit_text(found.unit)}"


def _difference(unit: str) -> str:
    return "K" if unit == "degC" else unit


def _print_ranking(console: Console, found: CheckExplanation) -> None:
    """The inputs with a range, those that move the margin most first."""
    moving = [one for one in found.inputs if one.shift]
    unit = unit_text(_difference(found.unit))
    for one in moving[:MOST_INPUTS]:
        low, high = (number_text(margin, 3) for margin in one.margins or (None, None))
        ends = "" if one.range is None else f" = {one.range[0]} to {one.range[1]}"
        _answer(console, "moved by", f"{one.path}{ends}: margin {low} to {high} {unit}".rstrip(" -"))
    if len(moving) > MOST_INPUTS:
        _answer(console, "", f"{len(moving) - MOST_INPUTS} more with a range move it less; --json lists them")
    if not moving:
        _answer(console, "moved by", "no input over its range")
    _answer(console, "not ranked", "inputs without a range; without --results they are listed by table")


def _print_inputs(console: Console, found: CheckExplanation, case: Path) -> None:
    """The inputs by their tables, the assumed ones first; none is said to matter more."""
    _answer(
        console,
        "ranking",
        "none without --ranges. To rank the inputs by how far their ranges move the margin:",
    )
    for command in (
        f"rigdesign check {case} --ranges --out DIR",
        f"rigdesign explain {case} --check {found.id} --results DIR",
    ):
        _answer(console, "", command)
    for title, assumed in (("assumed inputs", True), ("other inputs", False)):
        tables = _by_table(one.key for one in found.inputs if one.assumed is assumed)
        if tables:
            console.print(Text(f"{title}; * stands for any name", "bold"))
        for table, names in tables.items():
            hanging(console, Text(f"  {table}: "), ", ".join(names))


def _by_table(keys: Iterable[str]) -> dict[str, list[str]]:
    """Names of keys, each once, by the table that they share."""
    tables: dict[str, list[str]] = {}
    for key in dict.fromkeys(keys):
        table, _, name = key.rpartition(".")
        tables.setdefault(table, []).append(name)
    return tables


def _table(first: str, *further: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column(first, overflow="fold")
    for heading in further:
        table.add_column(heading, justify="right")
    return table


def _example(seen: Overview) -> str:
    return f"gearboxes.{next(iter(seen.gearboxes))}"

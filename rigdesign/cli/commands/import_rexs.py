"""`rigdesign import`: a case from a REXS file."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rigdesign.cli.application import OutFolder, app
from rigdesign.cli.terminal.console import new_console

if TYPE_CHECKING:
    from rigdesign.rexs.attribute_log import ListedAttribute
    from rigdesign.rexs.write_case import ImportedCase
WIDEST = 36
"""Characters of a value in a column; the case has it in full."""


@app.command(name="import")
def import_rexs(file: Path, /, *, out: OutFolder, stage: int | None = None) -> int:
    """Write a case from a REXS file (.rexs, .rexsj, .rexsz): one stage becomes the test gearbox.

    What the file does not state is a default of the tool, marked as an assumption; what the user has to give stands in
    the case as a comment with an example.

    Parameters
    ----------
    file
        REXS file, version 1.0 to 2.0.
    out
        Folder of the case; a case in it is not overwritten.
    stage
        Number of the stage, where the file has several.
    """
    from rigdesign.rexs.write_case import import_case

    console = new_console()
    for line in _report(import_case(file, out, stage)):
        console.print(line)
    return 0


def _report(result: "ImportedCase") -> Iterator[str]:
    yield str(result.path)
    yield f"\nmapped: {len(result.stated)} keys from {len(result.mapped)} attributes"
    yield from _aligned(
        [(place, entry.value, entry.text.partition(": ")[2]) for place, entry in result.stated]
    )
    yield f"\nlisted, not mapped: {len(result.listed)} attributes"
    yield from _grouped(result.listed)
    yield f"\nmissing in the file, assumed: {len(result.assumed)}"
    yield from _aligned([(item.path, item.value, item.reason) for item in result.assumed])
    if result.defaults:
        yield f"  and {result.defaults} defaults of drivetrain, schedule, limits and solvers, in the report of a check"
    if result.left_out:
        yield f"\nleft out, no part of the case: {len(result.left_out)}"
        yield from (f"  {line}" for line in result.left_out)
    if result.needed:
        yield f"\nmissing in the file, to be given by you before the case loads: {len(result.needed)}"
        yield from (f"  {line}" for line in result.needed)
    else:
        yield "\nnothing more is needed: the case loads. A housing, as suggested in it, adds the temperature field."


def _aligned(rows: Sequence[tuple[str, str, str]]) -> Iterator[str]:
    rows = [
        (path, value if len(value) <= WIDEST else f"{value[: WIDEST - 3]}...", text)
        for path, value, text in rows
    ]
    widths = [max((len(row[column]) for row in rows), default=0) for column in (0, 1)]
    for path, value, text in rows:
        yield f"  {path:<{widths[0]}}  {value:<{widths[1]}}  {text}"


def _grouped(listed: "Sequence[ListedAttribute]") -> Iterator[str]:
    """One line for each type of component and reason, with its attributes."""
    groups: dict[tuple[str, str], dict[str, None]] = {}
    for item in listed:
        groups.setdefault((item.type, item.reason), {})[item.attribute] = None
    for (kind, reason), attributes in sorted(groups.items()):
        yield f"  {kind}: {', '.join(attributes)}: {reason}"

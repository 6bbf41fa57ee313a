"""A rig calibrated by its healthy sets, and the constants of a calibrated case."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verdict_console

if TYPE_CHECKING:
    from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration
    from rigdesign.diagnosis.rig_calibration.leave_one_out import LeftOut
    from rigdesign.diagnosis.run import Calibrated


def print_rig_calibration(found: "RigCalibration", out: Path) -> None:
    """Values that moved, every set diagnosed with the others, what the sets say of each other, where the files are."""
    from rigdesign.diagnosis.document.advice import VERDICTS
    from rigdesign.diagnosis.rig_calibration.document import advice

    console, texts = new_console(), advice(found)
    headline = "check the healthy sets" if texts else "the healthy sets look alike"
    verdict_console().print(Text(headline, "bold yellow" if texts else "bold green"))
    for text in texts:
        console.print(Text(text, "bold yellow"))
    console.print(_left_out(found.left_out, VERDICTS))
    console.print(_values(found))
    console.print(Text(f"calibration: {out / 'calibration.json'}, used by rigdesign diagnose --calibration"))
    console.print(f"report: {out / 'calibration.html'}")


def _left_out(rows: "tuple[LeftOut, ...]", verdicts: dict[str, str]) -> Table:
    table = _table("set", "baseline", "calibration", "verdict", numbers=("numbers", "chi2/number", "shipped"))
    for row in rows:
        by = f"{len(row.calibrated_by)} others" if row.calibrated_by else "shipped"
        verdict = verdicts[row.verdict] + (f": {', '.join(row.named)}" if row.named else "")
        table.add_row(
            Text(row.name), Text(row.baseline or "none"), by,
            Text(verdict, "bold yellow" if row.alarm else ""), str(row.numbers), f"{row.chi_square:.2f}",
            f"{row.before:.2f}",
        )  # fmt: skip
    return table


def _values(found: "RigCalibration") -> Table:
    """Values that a diagnosis takes otherwise than shipped."""
    table = _table("value", "kind", numbers=("used", "found", "shipped"))
    for one in found.fit.estimates:
        if abs(one.used - one.shipped) > 1e-3 * one.shipped:
            table.add_row(
                Text(one.name), one.kind, f"{one.used:.3g}", f"{one.fitted:.3g}", f"{one.shipped:.3g}"
            )
    return table


def _table(*words: str, numbers: tuple[str, ...]) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    for heading in words:
        table.add_column(heading, overflow="fold")
    for heading in numbers:
        table.add_column(heading, justify="right")
    return table


def print_constants(found: "Calibrated", out: Path) -> None:
    """Every constant that a healthy set narrows: its value, its interval, and what it was known to before."""
    console = new_console()
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

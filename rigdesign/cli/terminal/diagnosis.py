"""A diagnosis."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verdict_console

if TYPE_CHECKING:
    from rigdesign.diagnosis.decision.defaults import Origin
    from rigdesign.diagnosis.document.outcome import Outcome
    from rigdesign.diagnosis.rig_calibration.healthy_sets import LeftOut, RigCalibration
    from rigdesign.diagnosis.run import Calibrated

DIAGNOSIS_STYLES = {"named": "bold green", "within_noise": "green", "input_error_suspected": "bold red"}

MOST_DOUBTS = 4
"""Suspected input errors that are printed."""
MOST_NEEDED = 8
"""Causes that are printed with the size they would need, where the data are too few."""


def print_diagnosis(outcome: "Outcome", out: Path) -> None:
    """Verdict, where, what and how big, the gap, what remains, what next, and where the files are."""
    from rigdesign.diagnosis.decision.naming import formatted
    from rigdesign.diagnosis.document.advice import VERDICTS, certainty, headline, steps
    from rigdesign.diagnosis.document.document import sentences
    from rigdesign.diagnosis.document.outcome import BEYOND, WITHIN, required_rows

    console = new_console()
    found, measurement = outcome.result.diagnosis, outcome.result.measurement
    style = DIAGNOSIS_STYLES.get(outcome.verdict, "bold yellow")
    verdict_console().print(Text(VERDICTS[outcome.verdict], style) + Text(f" ({found.strength})", "dim"))
    console.print(Text(headline(outcome)))
    console.print(Text(certainty(outcome), "dim"))
    for text in sentences(outcome.before, measurement)[:3]:
        console.print(Text("where     ", "bold") + Text(text))
    for one in outcome.named:
        sizes = "; ".join(formatted(value) for value in one.shown)
        console.print(Text("effect    ", "bold") + Text(f"{one.explanation}: {sizes}, 95 % interval"))
    if outcome.suspected is not None:
        sizes = "; ".join(formatted(value) for value in outcome.suspected.shown)
        text = f"{outcome.suspected.explanation}: {sizes}, 95 % interval"
        console.print(Text("suspected ", "bold yellow") + Text(text))
    shown = () if outcome.verdict == "within_noise" else outcome.suspects
    for suspect in shown[1:] if outcome.suspected is not None else shown:
        share = f"{100.0 * suspect.inclusion:.0f} %"
        size = "" if suspect.size is None else f"; alone {formatted(suspect.size.shown[0])}"
        name = suspect.title if suspect.size is None else suspect.name
        console.print(Text("perhaps   ", "bold") + Text(f"{name}: posterior {share}{size}"))
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
    left = sentences(outcome.after, measurement) if outcome.in_model else []
    for text in left[:3]:
        console.print(Text("remains   ", "bold") + Text(text))
    needed = [one for one in required_rows(outcome) if one.verdict in (WITHIN, BEYOND) and one.size]
    for row in needed[:MOST_NEEDED]:
        text = f"{row.title}: {row.size} would explain it ({row.verdict})"
        console.print(Text("needed    ", "bold") + Text(text))
    for step in steps(outcome)[:5]:
        console.print(Text("next      ", "bold") + Text(f"{step.text}: {step.why}"))
    console.print(Text(calibration_line(outcome.result.calibration.origin), "dim"))
    if outcome.case_patch is not None:
        console.print(f"patched case: {out / 'patched' / 'case.toml'}")
    else:
        console.print(f"case not patched: {outcome.refused}")
    if outcome.offered is not None:
        console.print(f"case with the suspected effect, to be tried: {out / 'suspected' / 'case.toml'}")
    console.print(f"report: {out / 'diagnosis.html'}")


def calibration_line(origin: "Origin") -> str:
    """Which calibration a diagnosis used."""
    if origin.kind == "shipped":
        return "calibration: shipped values, no healthy sets of this rig"
    odd = f"; {', '.join(origin.odd)} did not look like the others" if origin.odd else ""
    return f"calibration: {len(origin.sets)} healthy sets of this rig, {origin.path}{odd}"


# A rig calibrated by its healthy sets, and the constants of a calibrated case.


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

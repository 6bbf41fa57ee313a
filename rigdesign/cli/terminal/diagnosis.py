"""A diagnosis, and the constants of a calibrated case."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verdict_console

if TYPE_CHECKING:
    from rigdesign.diagnosis.document.outcome import Outcome
    from rigdesign.diagnosis.run import Calibrated

DIAGNOSIS_STYLES = {"named": "bold green", "within_noise": "green", "input_error_suspected": "bold red"}

MOST_DOUBTS = 4
"""Suspected input errors that are printed."""


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


def print_diagnosis(outcome: "Outcome", out: Path) -> None:
    """Verdict, where, what and how big, the gap, what remains, what next, and where the files are."""
    from rigdesign.diagnosis.decision.naming import formatted
    from rigdesign.diagnosis.document.advice import VERDICTS, certainty, headline, steps
    from rigdesign.diagnosis.document.document import sentences

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
    for step in steps(outcome)[:5]:
        console.print(Text("next      ", "bold") + Text(f"{step.text}: {step.why}"))
    if outcome.case_patch is not None:
        console.print(f"patched case: {out / 'patched' / 'case.toml'}")
    else:
        console.print(f"case not patched: {outcome.refused}")
    if outcome.offered is not None:
        console.print(f"case with the suspected effect, to be tried: {out / 'suspected' / 'case.toml'}")
    console.print(f"report: {out / 'diagnosis.html'}")

"""A diagnosis."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console, verdict_console

if TYPE_CHECKING:
    from rigdesign.diagnosis.decision.defaults import Origin
    from rigdesign.diagnosis.document.outcome import Outcome

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
    from rigdesign.diagnosis.document.required import BEYOND, WITHIN, required_rows

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

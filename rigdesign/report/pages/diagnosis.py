"""diagnosis.html: a diagnosis as a story, one self-contained page."""

import re
from typing import TYPE_CHECKING, Any

from rigdesign.diagnosis.decision.naming import display_scale
from rigdesign.diagnosis.document.advice import VERDICTS
from rigdesign.diagnosis.document.document import leading_sentences, sentences
from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration
from rigdesign.diagnosis.rig_calibration.meanings import meanings
from rigdesign.report.figures.drawing import NumberedFigures, drawing_style
from rigdesign.report.numbers import number_text, unit_text

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure

BANNERS = {"named": "pass", "within_noise": "pass", "input_error_suspected": "fail"}
"""Verdict -> colour of the banner; the others are amber."""
CHANNELS_SHOWN = 12
"""Channels of the table of gaps."""


def diagnosis_page(outcome: Outcome, document: dict[str, Any]) -> str:
    """The page as one HTML document; two calls give the same text."""
    from rigdesign.report.figures import diagnosis as figures
    from rigdesign.report.pages.report import environment

    numbered = NumberedFigures()

    def draw(figure: "Figure | None", description: str) -> "Markup | None":
        return None if figure is None else numbered(figure, description)

    measurement = outcome.result.measurement
    with drawing_style():
        context = {
            "document": document,
            "case": outcome.result.case,
            "verdict_words": VERDICTS[outcome.verdict],
            "banner": BANNERS.get(outcome.verdict, "advisory"),
            "where": sentences(outcome.before, measurement),
            "leading": leading_sentences(outcome),
            "in_question": outcome.in_question[0],
            "channels_shown": CHANNELS_SHOWN,
            "shown": shown_value,
            "size": shown_size,
            "map": draw(
                figures.residual_maps(outcome), "Residuals by channel and operating point, before and after"
            ),
            "readings": draw(
                figures.with_and_without(outcome), "Measured against simulated, without and with the effect"
            ),
            "likeness": lambda value: "–" if value is None else f"{value:.2f}",
            "posterior": draw(
                figures.posterior_bars(document["alternatives"]), "Posterior of the best explanations"
            ),
            "detectability": draw(
                figures.detectability_figure(document["detectability"]), "Detectable and isolable sizes"
            ),
        }
    return environment().get_template("diagnosis.html.j2").render(context)


def shown_value(parameter: dict[str, Any]) -> str:
    """Value of a parameter in the unit an engineer reads."""
    return shown_size(parameter["value"], parameter["unit"], parameter["factor"])


def shown_size(value: float | None, unit: str | None, factor: bool) -> str:
    """A size; a factor as such, a share in percent; a dash for none."""
    if value is None or unit is None:
        return "–"
    scale, name = display_scale(unit, factor)
    text = number_text(scale * value, 3)
    return f"× {text}" if factor else f"{text} {unit_text(name)}".rstrip()


# calibration.html: what healthy sets of a rig changed of the shipped values, and what they say of each other.


def rig_calibration_page(calibrated: RigCalibration, document: dict[str, Any]) -> str:
    """The page as one HTML document; two calls give the same text."""
    from rigdesign.report.pages.report import environment

    context = {"document": document, "case": calibrated.case, "verdicts": VERDICTS, "meaning": meaning}
    return environment().get_template("rig_calibration.html.j2").render(context)


def meaning(name: str) -> str:
    """What a value of a calibration is, in words."""
    group, _, key = name.partition(".")
    if group == "channels":
        return f"Shift of all numbers of {key} together from set to set, over their level."
    return re.sub(r" \(`[^`]*`\)", "", meanings()[name])

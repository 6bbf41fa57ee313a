"""calibration.html: what healthy sets of a rig changed of the shipped values, and what they say of each other."""

import re
from typing import Any

from rigdesign.diagnosis.constants_page import meanings
from rigdesign.diagnosis.document.advice import VERDICTS
from rigdesign.diagnosis.rig_calibration.healthy_sets import RigCalibration


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

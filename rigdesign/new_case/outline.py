"""The numbers a new case is made of: what they are called, what they hold, and whether they agree with each other."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal

from rigdesign.base import units
from rigdesign.base.errors import UsageError

MOST_SHIFT = 1.5
"""Sum of the profile shifts, in modules, beyond which a centre distance belongs to other gears."""


@dataclass(frozen=True)
class Question:
    """One number of a new case.

    key : field of `Outline`; kind : kind of the quantity, empty for anything else
    asked : what a user is asked; example : what may be answered; required : nothing stands for it when left out
    """

    key: str
    kind: str
    asked: str
    example: str
    required: bool = True

    @property
    def flag(self) -> str:
        """Option of the command line."""
        return f"--{self.key.replace('_', '-')}"


QUESTIONS = (
    Question("teeth", "", "teeth of pinion and wheel", "16,24"),
    Question("module", "length", "normal module", "4.5 mm"),
    Question("centre_distance", "length", "centre distance", "91.5 mm"),
    Question("face_width", "length", "face width of the test gears", "14 mm"),
    Question("torque", "torque", "test torque at the pinion", "300 N m"),
    Question("speed", "speed", "test speed of the pinion", "2250 rpm"),
    Question("bearings", "", "journal diameter of plain bearings, or designation of rolling bearings", "40 mm"),
    Question("oil", "", "oil, by its built-in name", "FVA 3A"),
    Question("oil_temperature", "temperature", "temperature of the oil at the inlet, or of the sump", "60 degC"),
    Question("lubrication", "", "jet or dip", "jet", required=False),
    Question("box", "", "outer length x width x height of the test gearbox", "200 x 280 x 220 mm", required=False),
    Question("profile_shift", "", "profile shift of the pinion; equal for both gears when left out", "0.18", False),
    Question("name", "", "short name of the case", "my_rig", required=False),
)  # fmt: skip
FLAGS = {question.key: question.flag for question in QUESTIONS}


@dataclass(frozen=True, kw_only=True)
class Outline:
    """A back-to-back rig of two gearboxes with the same gears, in the words of a case file.

    teeth : of pinion and wheel; box : outer length, width and height [m], None for a case without temperature field
    bearings : a journal diameter (``40 mm``) or the designation of a rolling bearing (``NU 406``)
    """

    name: str
    teeth: tuple[int, int]
    module: str
    centre_distance: str
    face_width: str
    torque: str
    speed: str
    bearings: str
    oil: str
    oil_temperature: str
    lubrication: Literal["jet", "dip"] = "jet"
    box: tuple[float, float, float] | None = None
    profile_shift: float | None = None

    @property
    def journal(self) -> bool:
        """Whether the bearings are plain ones, given by a diameter."""
        return units.kind_of(self.bearings) == "length"

    @property
    def bearing_width(self) -> float:
        """Width of a bearing [m]: of a plain one three quarters of its diameter."""
        if self.journal:
            return 0.75 * units.parse(self.bearings, "length")
        from dynamics.bearing.rolling_catalogue import catalogue_bearing

        return catalogue_bearing(self.bearings).width


def locating_sister(designation: str) -> str:
    """Bearing of the same size that holds its shaft, for one that does not (NU, N): NJ. Empty for any other."""
    from dynamics.bearing.protocol import BearingError
    from dynamics.bearing.rolling_catalogue import catalogue_bearing

    if catalogue_bearing(designation).locating:
        return ""
    try:
        return catalogue_bearing(re.sub(r"^NU?", "NJ", designation.strip().upper())).designation
    except BearingError:
        return ""


def outline_from(answers: Mapping[str, str]) -> Outline:
    """The outline that answers by key make; keys without an answer are absent.

    Raises
    ------
    UsageError
        With everything that is missing, cannot be read or contradicts something else, each by its flag.
    """
    missing = [question for question in QUESTIONS if question.required and question.key not in answers]
    faults = [f'{one.flag} is missing: {one.asked}; add e.g. {one.flag} "{one.example}"' for one in missing]
    values: dict[str, Any] = {}
    for question in QUESTIONS:
        if question.key in answers:
            try:
                values[question.key] = _read(question, answers[question.key].strip())
            except units.QuantityError as error:
                faults.append(f'{question.flag} "{answers[question.key]}": {error}')
    if not faults:
        known = {field.name for field in fields(Outline)}
        outline = Outline(
            **{"name": "my_rig", **{key: value for key, value in values.items() if key in known}}
        )
        faults = list(_contradictions(outline))
        if not faults:
            return outline
    raise UsageError("no case was written:\n  " + "\n  ".join(faults))


def _read(question: Question, text: str) -> Any:
    """One answer: a quantity stays as written, anything else is read."""
    if question.kind:
        if not units.parse(text, question.kind, question.example) > 0.0:
            raise units.QuantityError("is not above 0", f"write e.g. {question.example}")
        return text
    if question.key == "teeth":
        found = re.fullmatch(r"(\d{1,4})\s*[,/x:]\s*(\d{1,4})", text)
        if found is None:
            raise units.QuantityError("no two tooth numbers", f"write e.g. {question.example}")
        return int(found[1]), int(found[2])
    if question.key == "lubrication" and text not in ("jet", "dip"):
        raise units.QuantityError("no kind of lubrication of the gears", "write jet or dip")
    if question.key == "name" and not re.fullmatch(r"[a-z][a-z0-9_]{0,59}", text):
        raise units.QuantityError(
            "no name", "write lower-case letters, digits and underscores, starting with a letter"
        )
    if question.key == "profile_shift":
        return _number(text, question)
    if question.key == "box":
        return _box(text, question)
    if not text:
        raise units.QuantityError("is empty", f"write e.g. {question.example}")
    if question.key == "bearings" and units.kind_of(text) != "length":
        _check_designation(text)
    return text


def _check_designation(text: str) -> None:
    from dynamics.bearing.protocol import BearingError
    from dynamics.bearing.rolling_catalogue import catalogue_bearing

    try:
        catalogue_bearing(text)
    except BearingError as error:
        problem = str(error).partition(": ")[2].partition("; ")[0]
        raise units.QuantityError(
            f"neither a diameter nor a designation, {problem}", "write e.g. 40 mm or NU 208"
        ) from None


def _number(text: str, question: Question) -> float:
    try:
        return float(text)
    except ValueError:
        raise units.QuantityError("no number", f"write e.g. {question.example}") from None


def _box(text: str, question: Question) -> tuple[float, ...]:
    unit = re.search(r"[a-z]+$", text)
    sides = re.split(r"\s*x\s*", text.removesuffix(unit[0]).strip() if unit else text)
    if unit is None or len(sides) != 3:
        raise units.QuantityError("no three sides with a unit", f"write e.g. {question.example}")
    return tuple(units.parse(f"{side.strip()} {unit[0]}", "length") for side in sides)


def _contradictions(outline: Outline) -> Iterator[str]:
    """Numbers that cannot all be right, before any file is written."""
    module, distance = (units.parse(text, "length") for text in (outline.module, outline.centre_distance))
    first, second = outline.teeth
    if first > second:
        yield f"--teeth {first},{second}: the pinion has more teeth than the wheel; write the smaller number first"
    reference = 0.5 * module * (first + second)
    shift = (distance - reference) / module
    if abs(shift) > MOST_SHIFT:
        yield (
            f'--centre-distance "{outline.centre_distance}" does not fit --module "{outline.module}" and --teeth '
            f"{first},{second}: their reference centre distance is {1e3 * reference:.5g} mm, profile shifts make up "
            f"for {MOST_SHIFT:g} modules; correct one of the three"
        )
    if outline.box is not None:
        width = outline.box[1]
        needed = distance + 0.5 * module * (first + second) + 2.0 * module
        if width <= needed:
            yield (
                f"--box: a width of {1e3 * width:.5g} mm does not hold both gears, which take {1e3 * needed:.5g} mm; "
                "write outer length x width x height, the width across the shafts"
            )
    if outline.journal and units.parse(outline.bearings, "length") >= module * (first - 2.5):
        root = 1e3 * module * (first - 2.5)
        yield (
            f'--bearings "{outline.bearings}": the shaft would not leave the root circle of the pinion, {root:.4g} mm; '
            "write a smaller diameter"
        )
    if math.isclose(units.parse(outline.face_width, "length"), 0.0):
        yield f'--face-width "{outline.face_width}": is zero; write e.g. 14 mm'

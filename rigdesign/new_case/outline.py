"""The numbers a new case is made of: what they are called, what they hold, and whether they agree with each other."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from rigdesign.base import units
from rigdesign.base.errors import UsageError
from rigdesign.case.defaults.housings import SEAL_WIDTH

MOST_SHIFT = 1.5
"""Sum of the profile shifts, in modules, beyond which a centre distance belongs to other gears."""


@dataclass(frozen=True)
class Question:
    """One number of a new case.

    key : field of `Outline`; kind : kind of the quantity, empty for anything else
    asked : what a user is asked; example : a possible answer; required : there is no default for it
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


@dataclass(frozen=True)
class AnswerFault:
    """What is wrong with answers: keys of the questions one of which has to be answered otherwise, and one sentence."""

    keys: tuple[str, ...]
    text: str


class AnswersError(UsageError):
    """Answers that no case can be made of, with every fault found."""

    def __init__(self, faults: Sequence[AnswerFault]) -> None:
        super().__init__(
            "\n  ".join(["no case was written:", *dict.fromkeys(fault.text for fault in faults)])
        )
        self.faults = tuple(faults)

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the questions that have to be answered again, in the order of `QUESTIONS`."""
        named = {key for fault in self.faults for key in fault.keys}
        return tuple(question.key for question in QUESTIONS if question.key in named)


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
        from dynamics.rotor.rolling_catalogue import catalogue_bearing

        return catalogue_bearing(self.bearings).width

    @property
    def inner_length(self) -> float | None:
        """Length of the box between its end walls, which hold bearings and seals [m]; None without a box."""
        return None if self.box is None else self.box[0] - 2.0 * (self.bearing_width + SEAL_WIDTH)


def locating_sister(designation: str) -> str:
    """Bearing of the same size that holds its shaft, for one that does not (NU, N): NJ. Empty for any other."""
    from dynamics.rotor.bearing import BearingError
    from dynamics.rotor.rolling_catalogue import catalogue_bearing

    if catalogue_bearing(designation).carries_axial_load:
        return ""
    try:
        return catalogue_bearing(re.sub(r"^NU?", "NJ", designation.strip().upper())).designation
    except BearingError:
        return ""


def outline_from(answers: Mapping[str, str]) -> Outline:
    """The outline that answers by key make; keys without an answer are absent.

    Raises
    ------
    AnswersError
        With everything that is missing, cannot be read or contradicts something else, each by its flag.
    """
    faults, values = [], {}
    for question in QUESTIONS:
        answer = answers.get(question.key)
        if answer is not None:
            try:
                values[question.key] = read_answer(question, answer)
            except units.QuantityError as error:
                faults.append(AnswerFault((question.key,), f'{question.flag} "{answer}": {error}'))
        elif question.required:
            text = (
                f'{question.flag} is missing: {question.asked}; add e.g. {question.flag} "{question.example}"'
            )
            faults.append(AnswerFault((question.key,), text))
    if faults:
        raise AnswersError(faults)
    outline = Outline(**{"name": "my_rig", **values})
    if contradictions := list(_contradictions(outline)):
        raise AnswersError(contradictions)
    return outline


def read_answer(question: Question, answer: str) -> Any:
    """One answer as a field of `Outline`: a quantity stays as written, anything else is read.

    Raises
    ------
    QuantityError
        An answer that cannot be read or lies outside its limits, with the remedy.
    """
    text = answer.strip()
    if not text:
        raise units.QuantityError("is empty", f"write e.g. {question.example}")
    if question.kind and not units.parse(text, question.kind, question.example) > 0.0:
        raise units.QuantityError("is not above 0", f"write e.g. {question.example}")
    read = _READERS.get(question.key)
    return text if read is None else read(text, question)


def _teeth(text: str, question: Question) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,4})\s*[,/x:]\s*(\d{1,4})", text)
    if found is None:
        raise units.QuantityError("no two tooth numbers", f"write e.g. {question.example}")
    return int(found[1]), int(found[2])


def _bearing(text: str, question: Question) -> str:
    if units.kind_of(text) == "length":
        if not units.parse(text, "length") > 0.0:
            raise units.QuantityError("a diameter that is not above 0", f"write e.g. {question.example}")
    else:
        _check_designation(text)
    return text


def _oil(text: str, question: Question) -> str:
    from rigdesign.properties.oil import OILS

    if text not in OILS:
        raise units.QuantityError("no built-in oil", f"write one of {', '.join(OILS)}")
    return text


def _lubrication(text: str, question: Question) -> str:
    if text not in ("jet", "dip"):
        raise units.QuantityError("no kind of lubrication of the gears", "write jet or dip")
    return text


def _name(text: str, question: Question) -> str:
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,59}", text):
        remedy = "write at most 60 lower-case letters, digits and underscores, starting with a letter"
        raise units.QuantityError("no name", remedy)
    return text


def _check_designation(text: str) -> None:
    from dynamics.rotor.bearing import BearingError
    from dynamics.rotor.rolling_catalogue import catalogue_bearing

    try:
        catalogue_bearing(text)
    except BearingError as error:
        problem = str(error).partition(": ")[2].partition("; ")[0]
        raise units.QuantityError(
            f"neither a diameter nor a designation, {problem}", "write e.g. 40 mm or NU 208"
        ) from None


def _profile_shift(text: str, question: Question) -> float:
    try:
        shift = float(text)
    except ValueError:
        raise units.QuantityError("no number", f"write e.g. {question.example}") from None
    if not abs(shift) <= MOST_SHIFT:
        limit = f"must lie within -{MOST_SHIFT:g} to {MOST_SHIFT:g} modules"
        raise units.QuantityError(limit, f"write e.g. {question.example}")
    return shift


def _box(text: str, question: Question) -> tuple[float, ...]:
    unit = re.search(r"[a-z]+$", text)
    sides = re.split(r"\s*[x×]\s*", text.removesuffix(unit[0]).strip() if unit else text)
    if unit is None or len(sides) != 3:
        raise units.QuantityError(
            "no three sides with one unit behind them", f"write e.g. {question.example}"
        )
    lengths = tuple(units.parse(f"{side.strip()} {unit[0]}", "length") for side in sides)
    if not min(lengths) > 0.0:
        raise units.QuantityError("a side that is not above 0", f"write e.g. {question.example}")
    return lengths


_READERS: Mapping[str, Callable[[str, Question], Any]] = {
    "teeth": _teeth,
    "bearings": _bearing,
    "oil": _oil,
    "lubrication": _lubrication,
    "box": _box,
    "profile_shift": _profile_shift,
    "name": _name,
}
"""Readers of the answers that are no quantity, by key."""


def _contradictions(outline: Outline) -> Iterator[AnswerFault]:
    """Numbers that cannot all be right, before any file is written."""
    module, distance = (units.parse(text, "length") for text in (outline.module, outline.centre_distance))
    first, second = outline.teeth
    if first > second:
        yield AnswerFault(
            ("teeth",),
            f"--teeth {first},{second}: the pinion has more teeth than the wheel; write the smaller number first",
        )
    reference = 0.5 * module * (first + second)
    if abs(distance - reference) > MOST_SHIFT * module:
        yield AnswerFault(
            ("teeth", "module", "centre_distance"),
            f'--centre-distance "{outline.centre_distance}" does not fit --module "{outline.module}" and --teeth '
            f"{first},{second}: their reference centre distance is {1e3 * reference:.5g} mm, profile shifts make up "
            f"for {MOST_SHIFT:g} modules; correct one of the three",
        )
    if outline.box is not None:
        width = outline.box[1]
        needed = distance + 0.5 * module * (first + second) + 2.0 * module
        if width <= needed:
            yield AnswerFault(
                ("box",),
                f"--box: a width of {1e3 * width:.5g} mm does not hold both gears, which take {1e3 * needed:.5g} mm; "
                "write outer length x width x height, the width across the shafts",
            )
    face, inner = units.parse(outline.face_width, "length"), outline.inner_length
    if inner is not None and inner <= face:
        least = 1e3 * (face + 2.0 * (outline.bearing_width + SEAL_WIDTH))
        yield AnswerFault(
            ("box",),
            f"--box: a length of {1e3 * (inner - face) + least:.5g} mm does not hold gears, bearings and "
            f"seals, which take {least:.5g} mm; write outer length x width x height, the length along the shafts",
        )
    root = module * (first - 2.5)
    if outline.journal and units.parse(outline.bearings, "length") >= root:
        yield AnswerFault(
            ("bearings",),
            f'--bearings "{outline.bearings}": the shaft would not leave the root circle of the pinion, '
            f"{1e3 * root:.4g} mm; write a smaller diameter",
        )

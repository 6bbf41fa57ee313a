"""Types of the leaves of a case: quantities with their kind and limits, names, shares."""

import typing
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from rigdesign.base import units
from rigdesign.base.errors import CONTROL
from rigdesign.base.units import KINDS

FAULT = "rigdesign"
"""Type of a validation error that carries its own problem and remedy."""


class Part(BaseModel):
    """A table of the case file: every key known, every value of its type, nothing changed afterwards."""

    model_config = ConfigDict(
        strict=True, frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True
    )


def fault(problem: str, remedy: str, *, impossible: bool = False) -> PydanticCustomError:
    """A validation error with a remedy, collected by the loader; ``impossible`` as in `base.errors.Fault`."""
    context = {"problem": problem, "remedy": remedy, "impossible": impossible}
    return PydanticCustomError(FAULT, "{problem}; {remedy}", context)


@dataclass(frozen=True)
class Quantity:
    """A number with a unit; the field holds it in SI.

    kind : name in `rigdesign.base.units.KINDS`
    above, at_least, at_most, below : limits, written as a user would
    example : one of the usual size, for messages; that of the kind when left out
    """

    kind: str
    above: str | None = None
    at_least: str | None = None
    at_most: str | None = None
    below: str | None = None
    example: str | None = None

    @property
    def shown_example(self) -> str:
        """What a user may write."""
        return self.example or KINDS[self.kind].example

    def parse(self, text: object) -> float:
        """SI value of ``text`` within the limits; raises a pydantic error otherwise."""
        try:
            value = units.parse(text, self.kind, self.example)
        except units.QuantityError as error:
            raise fault(error.problem, error.remedy, impossible=not error.outside) from None
        for limit, words, holds in (
            (self.above, "is not above", float.__gt__),
            (self.at_least, "is below", float.__ge__),
            (self.at_most, "is above", float.__le__),
            (self.below, "is not below", float.__lt__),
        ):
            if limit is not None and not holds(value, units.parse(limit, self.kind)):
                raise fault(
                    f"{words} {limit}",
                    f'write a value {self.bounds}, e.g. "{self.shown_example}"',
                )
        return value

    @property
    def bounds(self) -> str:
        """The limits in words."""
        named = {"above": self.above, "at least": self.at_least, "at most": self.at_most, "below": self.below}
        return " and ".join(f"{word} {limit}" for word, limit in named.items() if limit is not None)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        kind = KINDS[self.kind]
        text = f"{kind.label}, {self.bounds}" if self.bounds else kind.label
        return {
            "type": "string", "pattern": units.pattern(self.kind), "examples": [self.shown_example],
            "description": text,
        }  # fmt: skip


@dataclass(frozen=True)
class Usual:
    """The range in which a key usually lies; a value outside of it is computed and warned of, zero is never.

    low, high : texts with unit as a user writes them, or multiples of ``of``
    of : measure of the part or of the rig, one of `rigdesign.case.usual`; empty for the values themselves
    """

    low: str | float
    high: str | float
    of: str = ""

    @property
    def words(self) -> str:
        """The range in words."""
        low, high = (end if isinstance(end, str) else f"{end:g}" for end in (self.low, self.high))
        return f"{low} to {high}{f' times the {self.of}' if self.of else ''}"


Influence = Literal[
    "start torque", "ramp limits", "resonance limits", "specimen limits", "strength limits", "test time",
    "thermal history", "coupling offset", "time run", "spline friction", "gear rating", "housing", "axial play",
    "rig heat", "flank rating", "events", "gear seats",
]  # fmt: skip
"""Group of inputs that moves a part of the checks only: those of the families that name it. ``housing``: what the
temperature fields move; the teeth of the loop feel it by less than a thousandth of a limit."""
ModelPart = Literal["coupling", "curves", "time run"]
MODEL_PARTS: tuple[ModelPart, ...] = ("coupling", "curves", "time run")
Condition = Literal["bare", "film", "dry", "torsional", "drag"]
"""bare: in a gearbox without a housing; film: at a plain bearing whose coefficients are computed; dry: no machine heats
an oil circuit, which feeds gearboxes; torsional: shafts only twist; drag: films give the drag of the bearings."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """What a key moves, and the keys below it unless they say otherwise, each answer for itself.

    A key that says nothing moves every check and has everything solved again: a missing effect costs time, not truth.
    `tests/verification/test_ranges_plan` perturbs every number of a case and compares. A limit that a check names as
    its source always belongs to it.

    checks : groups by which it moves checks; empty for none
    where : what the case has to be for ``checks`` to hold
    solved : parts of the model that are solved again. Heat and oil move the response over speed and the time run
        through drag torques and the temperature of the gears (`rigdesign.studies.modified_rig`)
    through_heat : it reaches the dynamic loads through the temperatures of the gears, the drag torques and the friction
        of the teeth alone: it changes neither drivetrain nor schedule nor the teeth as drawn
    of_rig : False for an input of what is measured or shown, which no check has
    """

    checks: tuple[Influence, ...] | None = None
    where: tuple[Condition, ...] = ()
    solved: tuple[ModelPart, ...] | None = None
    through_heat: bool = False
    of_rig: bool = True


COUPLED = Effect(solved=("coupling",))
OF_HEAT = Effect(through_heat=True)
ALLOWED_MISALIGNMENT = Effect(checks=(), solved=())
"""Of a coupling by its maker: a limit beside the part."""
RESONANCE_LIMIT = Effect(checks=("resonance limits",), solved=("curves",))
SCUFFING = Effect(checks=("flank rating",), solved=())

Length = Annotated[float, Quantity("length", above="0 mm", at_most="20 m")]
Size = Annotated[float, Quantity("length", above="0 mm", at_most="20 m", example="300 mm")]
"""A measure of a housing, a plate, a shaft."""
Clearance = Annotated[float, Quantity("length", above="0 mm", at_most="20 m", example="80 um")]
"""A gap between two parts that move."""
Gap = Annotated[float, Quantity("length", at_least="0 mm", at_most="20 m")]
"""A length that may be zero."""
Play = Annotated[float, Quantity("length", at_least="0 mm", at_most="1 m", example="80 um")]
"""A clearance that may be zero."""
Offset = Annotated[float, Quantity("length", at_least="-20 m", at_most="20 m")]
"""A length with a sign."""
Deviation = Annotated[
    float, Quantity("length", at_least="-20 m", at_most="20 m", example="5 um"), Usual("0.01 um", "5 mm")
]
"""A deviation of a flank or an axis, with its sign."""
Small = Annotated[
    float, Quantity("length", at_least="0 um", at_most="1 mm", example="10 um"), Usual("0.05 um", "500 um")
]
"""A flank modification, a roughness."""
Angle = Annotated[float, Quantity("angle", at_least="-360 deg", at_most="360 deg")]
Tilt = Annotated[float, Quantity("angle", above="0 mrad", at_most="100 mrad", example="1 mrad")]
"""A small angle between axes."""
PressureAngle = Annotated[float, Quantity("angle", at_least="10 deg", at_most="35 deg")]
HelixAngle = Annotated[float, Quantity("angle", at_least="0 deg", at_most="45 deg", example="15 deg")]
Temperature = Annotated[
    float, Quantity("temperature", at_least="-60 degC", at_most="600 degC"), Usual("-60 degC", "350 degC")
]
RoomTemperature = Annotated[
    float,
    Quantity("temperature", at_least="-60 degC", at_most="600 degC", example="20 degC"),
    Usual("-45 degC", "60 degC"),
]
TemperatureDifference = Annotated[float, Quantity("temperature_difference", above="0 K", at_most="500 K")]
Torque = Annotated[float, Quantity("torque", at_least="0 N m", at_most="1000 kN m")]
Speed = Annotated[float, Quantity("speed", at_least="0 rpm", at_most="200000 rpm")]
Velocity = Annotated[float, Quantity("velocity", at_least="0 m/s", at_most="500 m/s")]
Force = Annotated[float, Quantity("force", at_least="0 N")]
Power = Annotated[float, Quantity("power", at_least="0 W")]
Stress = Annotated[
    float, Quantity("pressure", above="0 MPa", example="500 MPa"), Usual("0.5 MPa", "5000 MPa")
]
Modulus = Annotated[
    float, Quantity("pressure", at_least="0.5 GPa", at_most="1200 GPa"), Usual("30 GPa", "400 GPa")
]
Time = Annotated[float, Quantity("time", above="0 s")]
Hours = Annotated[float, Quantity("time", above="0 s", example="2 h")]
"""A time in which temperatures become steady, or a test is run."""
Frequency = Annotated[float, Quantity("frequency", above="0 Hz", at_most="10000 kHz")]
Flow = Annotated[float, Quantity("flow", at_least="0.001 l/min", at_most="100000 l/min")]
Volume = Annotated[float, Quantity("volume", above="0 l", at_most="100 m3")]
LiquidDensity = Annotated[
    float,
    Quantity("density", at_least="400 kg/m3", at_most="2500 kg/m3", example="870 kg/m3"),
    Usual("700 kg/m3", "1300 kg/m3"),
]
MistDensity = Annotated[
    float,
    Quantity("density", above="0 kg/m3", at_most="1000 kg/m3", example="5 kg/m3"),
    Usual("0.8 kg/m3", "19 kg/m3"),
]
"""Of air that carries oil."""
Density = Annotated[
    float,
    Quantity("density", at_least="100 kg/m3", at_most="25000 kg/m3", example="7850 kg/m3"),
    Usual("1000 kg/m3", "9000 kg/m3"),
]
KinematicViscosity = Annotated[
    float,
    Quantity("kinematic_viscosity", at_least="0.3 mm2/s", at_most="1e6 mm2/s"),
    Usual("1.5 mm2/s", "2000 mm2/s"),
]
PressureViscosity = Annotated[float, Quantity("pressure_viscosity", at_least="5 1/GPa", at_most="60 1/GPa")]
HeatCapacity = Annotated[
    float,
    Quantity("heat_capacity", at_least="500 J/(kg K)", at_most="10 kJ/(kg K)"),
    Usual("1400 J/(kg K)", "4300 J/(kg K)"),
]
Conductance = Annotated[float, Quantity("conductance", at_least="0 W/K", at_most="10000 kW/K")]
"""Heat that goes to something else per kelvin."""
BodyHeatCapacity = Annotated[float, Quantity("body_heat_capacity", at_least="0 J/K")]
Pressure = Annotated[float, Quantity("pressure", above="0 bar", at_most="1000 bar", example="10 bar")]
"""Of an oil pump or of a coolant."""
Conductivity = Annotated[float, Quantity("conductivity", above="0 W/(m K)", at_most="1000 W/(m K)")]
HeatTransferCoefficient = Annotated[
    float, Quantity("heat_transfer_coefficient", above="0 W/(m2 K)", at_most="1000000 W/(m2 K)")
]
ExpansionCoefficient = Annotated[
    float,
    Quantity("expansion_coefficient", at_least="0 1/K", at_most="1e-3 1/K"),
    Usual("4e-6 1/K", "30e-6 1/K"),
]
TorsionalStiffness = Annotated[float, Quantity("torsional_stiffness", above="0 N m/rad")]
TorsionalDamping = Annotated[float, Quantity("torsional_damping", at_least="0 N m s/rad")]
LinearStiffness = Annotated[float, Quantity("linear_stiffness", above="0 N/m"), Usual("1e4 N/m", "2e10 N/m")]
LinearDamping = Annotated[float, Quantity("linear_damping", at_least="0 N s/m")]
Mass = Annotated[float, Quantity("mass", above="0 kg", at_most="1000000 kg")]
Inertia = Annotated[float, Quantity("inertia", at_least="0 kg m2", at_most="100000 kg m2")]
Unbalance = Annotated[float, Quantity("unbalance", at_least="0 g mm", at_most="100 kg m")]
"""Mass times its distance from the axis."""
Slope = Annotated[float, Quantity("angle", at_least="-100 mrad", at_most="100 mrad", example="0.5 mrad")]
"""A small angle between axes, with its sign."""
Voltage = Annotated[float, Quantity("voltage", above="0 V", at_most="100 V")]
Resistance = Annotated[float, Quantity("resistance", at_least="0 ohm", at_most="100 kohm")]

Share = Annotated[float, Field(ge=0.0, le=1.0)]
"""A part of a whole, 0 to 1."""
Positive = Annotated[float, Field(gt=0.0)]
LoadStage = Annotated[float, Field(ge=1.0, le=14.0), Usual(4.0, 14.0), SCUFFING]
"""Load stage of the FZG test A/8.3/90, DIN ISO 14635-1."""
Count = Annotated[int, Field(gt=0)]
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$", max_length=60)]
"""Name of a part: lower-case letters, digits and underscores."""
LONGEST_TEXT = 2000
"""Characters of a title, a reason or a source."""


def text_fault(text: str) -> tuple[str, str] | None:
    """Problem and remedy of a text that no report can show; None for any other."""
    if len(text) > LONGEST_TEXT:
        return f"{len(text)} characters, above the limit of {LONGEST_TEXT}", "write a shorter text"
    if (found := CONTROL.search(text)) is not None:
        return f"holds the control character {found[0]!r}", "write letters, digits and signs"
    return None


def _shown(text: str) -> str:
    if (wrong := text_fault(text)) is not None:
        raise fault(*wrong)
    return text


def _one_line(text: str) -> str:
    if "\n" in text:
        raise fault("has more than one line", "write one line")
    return text


Text = Annotated[str, Field(min_length=1), AfterValidator(_shown)]
Title = Annotated[Text, AfterValidator(_one_line)]
"""A name in the report, on one line."""


# An assumption of a case as results list it.


RangeEnds = tuple[str | int | float, str | int | float]
"""Lowest and highest plausible value of an input, as written."""


@dataclass(frozen=True, kw_only=True)
class AssumptionRecord:
    """An input marked as assumed in the case file, or left out and replaced by an idealisation."""

    path: str
    value: str
    reason: str
    range: RangeEnds | None = None
    """Lowest and highest plausible value, as written."""
    decides: tuple[str, ...] = ()
    """Ids of the checks that depend on it."""


# Tables that come in kinds: the key that says which one it is, and the kind of a table that does not say.
#
#     GearOil = Annotated[Annotated[JetOil, Tag("jet")] | Annotated[DipOil, Tag("dip")], kind_from("lubrication",
# "jet")]
#
# Every kind states its own name as the only choice of that key; the usual kind has it as default.

USUAL = {"law": (), "lubrication": ("jet", "fed"), "type": ("journal",)}
"""Keys by which kinds of tables differ -> what a table is that does not state the key."""


def changes_kind(base: Mapping[str, Any], over: Mapping[str, Any]) -> bool:
    """Whether a table ``over`` another one states a kind that this one is not."""
    return any(
        key in over and over[key] != base.get(key) and not (key not in base and over[key] in usual)
        for key, usual in USUAL.items()
    )


def kind_from(key: str, usual: str) -> Discriminator:
    """Chooses the kind of a table by ``key``; ``usual`` where the table does not state it."""

    def kind(given: object) -> object:
        if isinstance(given, Mapping):
            return given.get(key, usual)
        return getattr(given, key, None)

    return Discriminator(kind)


def kind_key(models: Sequence[type[BaseModel]]) -> str:
    """The key by which tables differ: in each of them it has one choice, its own. Empty where there is none."""
    return _kind_key(tuple(models))


def kind_of(model: type[BaseModel], key: str) -> str:
    """The kind a table is, by the only choice of its key."""
    return str(typing.get_args(model.model_fields[key].annotation)[0])


def variant_of(model: type[BaseModel], models: Sequence[type[BaseModel]]) -> str:
    """How a case states that a table is this one of several kinds: ``law = radiation``."""
    key = kind_key(models)
    return f"{key} = {kind_of(model, key)}"


def of_kind(models: Sequence[type[BaseModel]], table: Mapping[str, Any]) -> list[type[BaseModel]]:
    """Of several kinds those that a table may be: the one it states, or the usual one; all where it names none."""
    key = kind_key(models)
    if len(models) < 2 or not key:
        return list(models)
    if key in table:
        return [model for model in models if kind_of(model, key) == table[key]] or list(models)
    return [model for model in models if not model.model_fields[key].is_required()] or list(models)


@cache
def _kind_key(models: tuple[type[BaseModel], ...]) -> str:
    for key in models[0].model_fields if models else ():
        fields = [model.model_fields.get(key) for model in models]
        choices = [() if field is None else _choices(field.annotation) for field in fields]
        if all(len(own) == 1 for own in choices) and len(set(choices)) == len(models):
            return key
    return ""


def _choices(annotation: Any) -> tuple[Any, ...]:
    return typing.get_args(annotation) if typing.get_origin(annotation) is typing.Literal else ()

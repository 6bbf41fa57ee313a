"""A measurement set as loaded: sensors, operating points as run, and every reading in SI."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, model_validator

from rigdesign.case import Case
from rigdesign.case.fields import (
    Angle,
    Frequency,
    Gap,
    Name,
    Offset,
    Part,
    Quantity,
    Share,
    Speed,
    Text,
    Torque,
    fault,
)
from rigdesign.measurement.quantities import SettingQuantity
from rigdesign.prediction import model as prediction
from rigdesign.prediction.model import Channel, Feature, OperatingCondition

# measurement.toml: what a user states about a measurement set; every key known, every fault at once.


def _with_unit(value: object) -> object:
    if isinstance(value, int | float) and not isinstance(value, bool):
        raise fault("a bare number without a unit", f'write a text with a unit, e.g. "{value} K"')
    return value


Label = Annotated[str, Field(pattern=r"^\S(.*\S)?$", max_length=80)]
"""Name of a column or point as the table has it."""
Spread = Annotated[Text, BeforeValidator(_with_unit)]
"""An uncertainty with its unit; which one depends on the quantity."""
Delay = Annotated[float, Quantity("time", at_least="0 s", at_most="1 s")]
SizeLimit = Annotated[float, Quantity("data_size", at_least="1 kB", at_most="1000 GB")]


class Recording(Part):
    """Raw time data of one operating point and repeat."""

    point: Label
    repeat: Annotated[int, Field(ge=1)] = 1
    file: Text
    """.tdms, .h5, .hdf5, .mf4 or .csv, in the folder of measurement.toml or below it."""
    start_turn: Annotated[float, Field(ge=0.0)] | None = None
    """Turns of the reference gear between the meeting of both teeth 0 and the angle zero of the recording:
    without it the phases of fractional orders are not known."""


class Sweep(Part):
    """A recording over which the speed changes: a run-up or a run-down under one bracing torque."""

    file: Text
    """As of a recording."""
    direction: Literal["up", "down"]
    """Which way the speed goes; the tach has to agree."""
    torque: Torque
    """Bracing torque, where the case counts it."""
    speeds: tuple[Speed, ...] = ()
    """Speeds of the reference gear at which the orders of the channels are read, each an operating point of its own."""
    turns: Annotated[int, Field(ge=2, le=1000)] = 16
    """Turns of the reference gear in a window over which an order is averaged; a line of 2/turns of an order."""
    start_turn: Annotated[float, Field(ge=0.0)] | None = None
    """As of a recording."""


class Impact(Part):
    """A recording of hammer blows on the rig at rest."""

    file: Text
    """As of a recording."""
    force: Label
    """Signal of the hammer."""
    length: Annotated[float, Quantity("time", at_least="1 ms", at_most="100 s")] | None = None
    """Time after a blow that counts; to the next blow when left out."""


class Tach(Part):
    """How the angle of the reference gear follows from a recording."""

    kind: Literal["pulses", "angle"]
    """pulses: one or more a turn; angle: an encoder's angle."""
    signal: Label
    pulses_per_turn: Annotated[int, Field(ge=1)] | None = None
    """Counted from index pulse to index pulse when left out, one without an index."""
    index: Label | None = None
    """Signal with one pulse a turn, which says where zero is; needed with several pulses a turn."""
    unit: Literal["deg", "rad", "mrad"] = "deg"
    """Of an angle."""
    wraps: bool = True
    """Whether the angle starts again at zero every turn."""
    zero: Angle = 0.0
    """Angle of the reference gear at the index pulse, or where the encoder reads zero."""

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of its signals."""
        return (self.signal,) if self.index is None else (self.signal, self.index)


class DataSection(Part):
    """Files of the set."""

    table: Text = "data.csv"
    orders: Text | None = None
    delimiter: Literal[",", ";", "\t"] = ","
    decimal: Literal[".", ","] = "."
    encoding: Literal["utf-8", "cp1252", "utf-16"] = "utf-8"
    time_unit: Literal["s", "ms", "us", "ns", "min", "h", "d"] | None = None
    """Of the time of recordings whose files do not say; seconds when left out. Files that do are held against it."""
    size_limit: SizeLimit = 200e6
    """Most bytes of each file that is named here, and most samples read from it."""
    recordings: tuple[Recording, ...] = ()
    sweeps: tuple[Sweep, ...] = ()
    impacts: tuple[Impact, ...] = ()
    tach: Tach | None = None
    """Needed for recordings of channels that are read by orders, and for sweeps; of root gauges the speed of the table
    serves without one."""

    @model_validator(mode="after")
    def _signs(self) -> "DataSection":
        if self.delimiter == self.decimal:
            raise fault(
                "delimiter and decimal are both a comma",
                'write delimiter = ";" for files with decimal commas',
            )
        return self


class Point(Part):
    """What is known of one operating point in addition to its row."""

    steady: bool = True
    """Whether temperatures were steady."""
    reassembled: bool = False
    """Put together anew since the point before."""
    tooth_offset: Mapping[Text, int] = {}
    """By mesh, ``gearbox.mesh``: teeth by which the wheel was put on further than in the case."""


class SettingColumn(Part):
    """A column that says how the points were run."""

    quantity: SettingQuantity
    place: str = ""
    """Oil stream of an inlet temperature or flow, ``gearbox.gear_oil``."""
    unit: Text
    uncertainty: Spread
    """1 sigma of one reading."""
    offset_uncertainty: Spread | None = None
    """1 sigma, systematic, the same over the set; that of a usual instrument when left out."""
    scale_uncertainty: Share | None = None
    """1 sigma, systematic, relative; that of a usual instrument when left out."""


class Transfer(Part):
    """What sensor and logger let through: a Butterworth low-pass, and a delay."""

    kind: Literal["low_pass"]
    frequency: Frequency
    poles: Annotated[int, Field(ge=1, le=8)] = 1
    delay: Delay = 0.0


class ChannelTable(Part):
    """One sensor."""

    quantity: prediction.Quantity
    place: str = ""
    """Where on the rig; see ``rigdesign.prediction.model.Channel``."""
    at: tuple[Offset, Offset, Offset] | None = None
    """Coordinates in the housing, for a temperature with the gearbox as its place."""
    direction: Text | None = None
    """Of an acceleration or shaft displacement, in the frame of the case: "y" across, "z" up, "x" along the shafts, one
    of them with a minus, or an angle from y towards z such as "45 deg"."""
    position: Gap | None = None
    """Of a shaft displacement with a shaft as its place: distance from the start of the shaft."""
    torque: Torque | None = None
    """Of a resonance speed: bracing torque of the sweeps that it is read from."""
    search_range: tuple[Text, Text] | None = None
    """Least and greatest reading that is looked for in sweeps (resonance speed) or blows (natural frequency); all of
    them when left out."""
    unit: Text
    uncertainty: Spread
    """1 sigma of one reading; of a channel with orders of its mean and of each real or imaginary part."""
    offset_uncertainty: Spread | None = None
    """1 sigma, systematic, the same over the set."""
    scale_uncertainty: Share = 0.0
    """1 sigma, systematic, relative; of a thermocouple relative to its excess over ambient."""
    calibrated: date | None = None
    orders: tuple[Annotated[float, Field(ge=0.0)], ...] | None = None
    """Per turn of the reference gear, 0 is the mean; from tooth numbers when left out. Of a resonance speed the one
    order that meets it."""
    windows: tuple[prediction.RootWindow, ...] | None = None
    """Of a root_strain: numbers of its curve that are known, each a column `<channel>.<window>`, or the column of the
    channel where it is one; all when left out."""
    transfer: Transfer | None = None
    signal: Label | None = None
    """Name in recordings, sweeps and blows; that of the channel when left out."""


ExtraPoint = Literal["operating_point", "oil_flow", "inlet_temperature", "reassembly"]
"""A further operating point, by what has to be changed for it."""
COST_ITEMS: tuple[str, ...] = (*get_args(prediction.Quantity), *get_args(ExtraPoint))
"""What a cost may be stated of: a sensor by its quantity, or a further point."""


class Doubt(Part):
    """A number of the set, or one it depends on, that contradicts another of the same source."""

    what: Text
    size: Text
    """How far the numbers are apart, with their units."""
    source: Text
    channels: tuple[Label, ...] = ()
    """Those whose readings it touches."""


class Inspection(Part):
    """What gear metrology, an alignment or a contact pattern leaves open of an effect whose value the case has."""

    uncertainty: Annotated[float, Quantity("length", above="0 um", at_most="1 mm", example="2 um")]
    """1 sigma of the measured value."""
    source: Text
    """Report or method."""


class MeasurementFile(Part):
    """Content of measurement.toml."""

    schema_version: Literal[1]
    title: Text
    baseline: Text | None = None
    """Healthy set of the same rig, a folder next to this one."""
    case: Name | None = None
    """Name of the case the set belongs to; a set of another one is suspected."""
    data: DataSection = DataSection()
    points: Mapping[Label, Point] = {}
    settings: Mapping[Label, SettingColumn] = Field(min_length=1)
    channels: Mapping[Label, ChannelTable] = Field(min_length=1)
    costs: Mapping[Text, Annotated[float, Field(gt=0.0)]] = {}
    """Of one sensor more by its quantity, and of one point more by what is changed for it, in any one unit."""
    inspections: Mapping[Text, Inspection] = {}
    """By effect, ``misalignment:test.main``: the case has the measured value, here is how well it is known."""
    doubts: tuple[Doubt, ...] = ()
    """What the writer of the set suspects of it; reported as suspected input errors."""


Weight = Literal["dropped", "suspect", "note"]
"""dropped: what is named is not used; suspect: it is used, but may be wrong; note: good to know."""


@dataclass(frozen=True, kw_only=True)
class DataFinding:
    """Something about the data that their user has to know."""

    id: str
    weight: Weight
    text: str
    """Name, value, limit, remedy."""
    channels: tuple[str, ...] = ()
    points: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class MeasuredChannel:
    """A sensor, with what is known of its errors (1 sigma, SI)."""

    channel: Channel
    unit: str
    """As in the file."""
    noise: float
    """Of one reading; of a torque or angle of its mean and of each real or imaginary part."""
    offset_sd: float = 0.0
    """Systematic, constant over the set; of a torque or angle on the mean only."""
    scale_sd: float = 0.0
    """Systematic, relative; of a thermocouple relative to its excess over ambient."""
    calibrated: date | None = None
    transfer: Transfer | None = None
    signal: str = ""
    """Name in recordings, sweeps and blows."""
    search_range: tuple[float, float] | None = None
    """Least and greatest reading that is looked for in sweeps or blows [SI]."""

    @property
    def name(self) -> str:
        """Name of the column."""
        return self.channel.name


@dataclass(frozen=True, kw_only=True)
class SettingSensor:
    """A column that says how the points were run."""

    name: str
    quantity: str
    place: str
    unit: str
    noise: float
    """1 sigma of one reading [SI; K]."""
    offset_sd: float = 0.0
    """Systematic, the same over the set [SI; K]."""
    scale_sd: float = 0.0
    """Systematic, relative."""


@dataclass(frozen=True, kw_only=True)
class MeasuredPoint:
    """One operating point: how it was run (means over its repeats)."""

    setting: OperatingCondition
    readings: Mapping[str, NDArray[np.float64]]
    """By setting column, SI: (repeats,), NaN where missing."""
    times: NDArray[np.float64] | None = None
    """(repeats,) when each was read, from any start [s], NaN where missing; None without a column of times."""
    steady: bool = True
    reassembled: bool = False
    """Put together anew since the point before."""

    @property
    def name(self) -> str:
        """Name in the table."""
        return self.setting.name

    @property
    def repeats(self) -> int:
        """Rows of the table."""
        return max((len(values) for values in self.readings.values()), default=0)


@dataclass(frozen=True, kw_only=True)
class MeasurementSet:
    """Everything a set says, checked against its case.

    readings : by feature, SI: (repeats,), NaN where a reading is missing
    findings : of the loader; those of the data checks come with ``features``
    hash : of measurement.toml and every file it names
    """

    title: str
    folder: Path
    case: Case
    baseline: Path | None
    """Folder of the healthy set."""
    channels: Mapping[str, MeasuredChannel]
    setting_sensors: Mapping[str, SettingSensor]
    points: tuple[MeasuredPoint, ...]
    readings: Mapping[Feature, NDArray[np.float64]]
    findings: tuple[DataFinding, ...] = field(default=())
    costs: Mapping[str, float] = field(default_factory=dict)
    """Of further sensors and points, as stated."""
    hash: str = ""
    inspections: Mapping[str, float] = field(default_factory=dict)
    """Effect -> standard deviation of what an inspection measured of it [m]."""

    @cached_property
    def by_channel(self) -> Mapping[str, Mapping[Feature, NDArray[np.float64]]]:
        """The readings of each channel; of one without any an empty mapping."""
        readings: dict[str, dict[Feature, NDArray[np.float64]]] = {name: {} for name in self.channels}
        for feature, values in self.readings.items():
            readings.setdefault(feature.channel, {})[feature] = values
        return readings

    @property
    def settings(self) -> tuple[OperatingCondition, ...]:
        """Operating points as run, in the order of the table."""
        return tuple(point.setting for point in self.points)

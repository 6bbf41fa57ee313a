"""A measurement set as loaded: sensors, operating points as run, and every reading in SI."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.case import Case
from rigdesign.measurement.reading.document import Transfer
from rigdesign.prediction.model import Channel, Feature, OperatingCondition

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
        found: dict[str, dict[Feature, NDArray[np.float64]]] = {name: {} for name in self.channels}
        for feature, values in self.readings.items():
            found.setdefault(feature.channel, {})[feature] = values
        return found

    @property
    def settings(self) -> tuple[OperatingCondition, ...]:
        """Operating points as run, in the order of the table."""
        return tuple(point.setting for point in self.points)

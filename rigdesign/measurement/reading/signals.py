"""Raw time data on disk: TDMS, HDF5, MDF4 and CSV as signals over one time, each with its unit."""

import logging
import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case.faults import written
from rigdesign.measurement.quantities import accepted_unit, same_worth, unit_problem
from rigdesign.measurement.reading.hdf5_samples import (
    AGAIN,
    TIME_NAMES,
    RefusedError,
    is_meant,
    read_datasets,
)
from rigdesign.measurement.reading.measurement_set import DataSection, Tach
from rigdesign.measurement.reading.table import (
    numbers,
    read_table,
    refused,
    set_file,
    time_stamp,
    time_stamps,
)

Array = NDArray[np.float64]


AXIS = "recording_time"
"""Kind of quantity of a time axis."""
FASTEST, SLOWEST = 1e-9, 1e5
"""Least and most time from sample to sample of a logger [s]."""
LONGEST = 1e11
"""Largest time of a sample [s]; seconds since 1904 are below."""
SPACING_OFF = 1e-3
"""Relative difference between the length of a time signal and that by the sampling rate that is a contradiction."""
PLACES_IN_TIME = re.compile(
    r"delay|pre_?trigger|trigger_?(time|offset|position)|start_?(time|offset|stamp)|time_?(offset|shift)|^t_?0$",
    re.I,
)
"""Attributes that say when a signal began."""
SPELLED = {"sec": "s", "second": "s", "seconds": "s", "msec": "ms", "µsec": "us", "usec": "us"}
"""Spellings of units of time in recordings."""
STEP_UNITS = ("wf_xunit_string", "dt_unit", "dt_units")
"""Attributes with the unit of wf_increment and wf_start_offset, or of dt."""
STARTS = ("wf_start_time", "start_time", "t0")
"""Attributes with the time of the first sample: a time stamp, or seconds that all signals of the file count alike."""
NO_START = np.datetime64("1904-01-01", "us")
"""What LabVIEW writes where it has no start."""


@dataclass(frozen=True)
class Signal:
    """One recorded signal.

    time : (n,) [s], increasing; values : (n,), NaN where missing; unit : as in the file, may be empty
    """

    time: Array
    values: Array
    unit: str = ""


class Signals(dict[str, Signal]):
    """Signals of a file by the names they were asked for; ``names``: of all that the file holds."""

    names: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class _Column:
    """A signal as its file has it.

    name : ``group/signal``; attributes : that its file says of it; time : (n,) signal of times of its group, numbers in
    ``time_unit`` or time stamps (datetime64)
    """

    name: str
    samples: NDArray[Any]
    unit: str
    attributes: Mapping[str, Any] = field(default_factory=dict)
    time: NDArray[Any] | None = None
    time_unit: str = ""


@dataclass(frozen=True, kw_only=True)
class _Axis:
    """Time of a signal [s] from its ``start``, maybe unknown; ``marks``: attributes that place it otherwise."""

    time: Array
    start: np.datetime64 | None = None
    marks: Mapping[str, Any] = field(default_factory=dict)


_Read = tuple[tuple[str, ...], list[_Column]]
"""Names of all signals of a file, and those that go by a wanted name."""


def read_signals(
    folder: Path, name: str, data: DataSection, wanted: Iterable[str], timed: Collection[str] | None = None
) -> Signals:
    """Those of the wanted signals that a file holds, in one time; nothing else of the file is read.

    Parameters
    ----------
    wanted : ``group/signal``, or the signal alone where one group has it
    timed : those of them that are set against each other in time; all when left out

    Raises
    ------
    MeasurementError
        No file of the set (`rigdesign.measurement.reading.table.set_file`), an unknown kind of file, content that
        cannot be read, fewer samples than its header states, more than ``data.size_limit``. Of a wanted signal: two of
        its name, no numbers, no time, time in no unit of time or in another one than ``data.time_unit``, a start
        relative to the others that is not known.
    """
    readers: dict[str, Callable[[Path, str, DataSection, Collection[str]], _Read]] = {
        ".tdms": _tdms, ".h5": _hdf5, ".hdf5": _hdf5, ".mf4": _mdf, ".csv": _csv,
    }  # fmt: skip
    kind = Path(name.replace("\0", "")).suffix.lower()
    reader = readers.get(kind)
    if reader is None:
        raise refused(name, f"unknown kind of file {kind!r}", f"write one of {', '.join(readers)}")
    path = set_file(folder, name, data.size_limit)
    wanted = tuple(dict.fromkeys(wanted))
    try:
        with np.errstate(all="ignore"):
            names, columns = reader(path, name, data, wanted)
            signals = _placed(name, columns, wanted, timed, data)
    except MeasurementError:
        raise
    except Exception as error:  # readers of binary files raise whatever a damaged byte leads them to
        said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise refused(name, f"cannot be read or was cut off ({said})", AGAIN) from None
    if not names:
        raise refused(name, "holds no signal", "export it again with its channels")
    signals.names = names
    return signals


def _placed(
    file: str,
    columns: Sequence[_Column],
    wanted: Iterable[str],
    timed: Collection[str] | None,
    data: DataSection,
) -> Signals:
    """The wanted signals, those of ``timed`` in the time of the first of them."""
    faults: list[Fault] = []
    chosen: dict[str, tuple[_Column, _Axis]] = {}
    for signal in wanted:
        try:
            column = _meant(file, signal, columns)
            if column is not None:
                chosen[signal] = column, _axis(f"{file}, {signal}", column, data)
        except MeasurementError as error:
            faults += error.faults
    related = {signal: axis for signal, (_, axis) in chosen.items() if timed is None or signal in timed}
    faults += _apart(file, related)
    if faults:
        raise MeasurementError(faults)
    signals = Signals()
    first = min((axis.start for axis in related.values() if axis.start is not None), default=None)
    for signal, (column, axis) in chosen.items():
        time = axis.time
        if first is not None and signal in related:
            time = time + (axis.start - first) / np.timedelta64(1, "s")
        signals[signal] = Signal(time, np.asarray(column.samples, dtype=float), column.unit)
    return signals


def _meant(file: str, wanted: str, columns: Iterable[_Column]) -> _Column | None:
    """The column that goes by a name; None where there is none."""
    meant = [column for column in columns if is_meant(column.name, wanted)]
    exact = [column for column in meant if column.name == wanted]
    meant = exact or meant
    if len(meant) > 1:
        names = " and ".join(column.name for column in meant)
        remedy = f'write the one that is meant in full, e.g. "{meant[-1].name}"'
        remedy = "give groups or signals other names" if exact else remedy
        raise refused(f"{file}, {wanted}", f"{len(meant)} signals have this name: {names}", remedy)
    return meant[0] if meant else None


def _axis(place: str, column: _Column, data: DataSection) -> _Axis:
    """Time of a signal, by its group's signal of times or by its sampling rate."""
    count = len(column.samples)
    if column.samples.dtype.kind not in "fiub" or column.samples.ndim != 1:
        raise refused(place, f"holds {column.samples.dtype}, no numbers over time", "export it as numbers")
    if count < 2:
        raise refused(place, f"holds {count} samples", "name a signal over time")
    known, start = column.attributes, None
    marks = {key: value for key, value in known.items() if PLACES_IN_TIME.search(key)}
    step = _step(place, known, data)
    time = column.time if column.time is not None and len(column.time) == count else None
    if time is not None and time.dtype.kind == "M":
        start, time = time[0], (time - time[0]) / np.timedelta64(1, "s")
    elif time is not None:
        time = np.asarray(time, dtype=float) * _unit_of_time(place, column.time_unit, data)
    if step is not None and time is not None and abs((count - 1) * step / np.ptp(time) - 1.0) > SPACING_OFF:
        raise refused(
            place, f"lasts {(count - 1) * step:g} s by its sampling rate, {np.ptp(time):g} s by its signal of times",
            "correct the wrong one or its unit",
        )  # fmt: skip
    if time is None and step is not None:
        offset = _number(place, "wf_start_offset", marks.pop("wf_start_offset", 0.0))
        time = offset * _unit_of_time(place, _step_unit(known), data) + step * np.arange(count)
        for key in STARTS:
            if (stamp := _start(marks.get(key))) is not None:
                del marks[key]
                start = None if stamp == NO_START else stamp
    if time is None:
        raise refused(
            place, "neither a sampling rate nor a signal 'time' of the same length",
            "export it with wf_increment (TDMS), the attribute sample_rate (HDF5) or a signal 'time'",
        )  # fmt: skip
    if not np.all(np.diff(time) > 0.0):
        raise refused(place, "its time does not increase", "export it with a sampling rate or time")
    if not np.abs(time[[0, -1]]).max() <= LONGEST:
        raise refused(
            place, f"its time reaches {time[-1]:.3g} s", "correct its time, or state data.time_unit"
        )
    return _Axis(time=np.asarray(time, dtype=float), start=start, marks=marks)


def _step(place: str, known: Mapping[str, Any], data: DataSection) -> float | None:
    """Time from sample to sample [s] by the attributes of a signal; None where they do not say."""
    for key in ("wf_increment", "dt"):
        if key in known and (step := _number(place, key, known[key])) > 0.0:
            step *= _unit_of_time(place, _step_unit(known), data)
            if not FASTEST <= step <= SLOWEST:
                remedy = f"write {FASTEST:g} to {SLOWEST:g} s"
                raise refused(place, f"{step:g} s from sample to sample", remedy)
            return step
    if "sample_rate" not in known:
        return None
    rate, unit = _number(place, "sample_rate", known["sample_rate"]), str(known.get("sample_rate_unit", "Hz"))
    spelled = accepted_unit(unit, "frequency")
    if spelled is None:
        raise refused(
            place, f'sample_rate_unit = "{unit}" {unit_problem(unit, "frequency")}', "write Hz or kHz"
        )
    rate *= units.worth("frequency", spelled)[0]
    if not 1.0 / SLOWEST <= rate <= 1.0 / FASTEST:
        limits = f"{1.0 / SLOWEST:g} to {1.0 / FASTEST:g} Hz"
        raise refused(place, f"sample_rate = {rate:g}, outside {limits}", "correct the attribute")
    return 1.0 / rate


def _step_unit(known: Mapping[str, Any]) -> str:
    return next((str(known[key]) for key in STEP_UNITS if key in known), "")


def _number(place: str, key: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise refused(place, f"{key} = {written(str(value))} is no number", "correct the attribute") from None


def _unit_of_time(place: str, said: str, data: DataSection) -> float:
    """Worth [s] of the unit of a time axis: of the file, else as declared, else seconds."""
    plain = said.strip().strip("[]()")
    unit = accepted_unit(SPELLED.get(plain.lower(), plain) or data.time_unit or "s", AXIS)
    if unit is None and (unit := data.time_unit) is None:
        problem = f"unit {written(said)} of its time {unit_problem(plain, AXIS)}"
        raise refused(place, problem, "correct it, or state data.time_unit if the file is right")
    if plain and data.time_unit is not None and not same_worth(unit, data.time_unit, AXIS):
        problem = f'its time is in "{plain}", data.time_unit says "{data.time_unit}"'
        raise refused(place, problem, "correct what is wrong")
    return units.worth(AXIS, unit)[0]


def _apart(file: str, axes: Mapping[str, _Axis]) -> Iterator[Fault]:
    """Signals that cannot be placed against each other in time."""
    with_start = [name for name, axis in axes.items() if axis.start is not None]
    without = [name for name, axis in axes.items() if axis.start is None]
    if with_start and without:
        yield Fault(
            f"{file}, {without[0]}", "", f"has no start, {with_start[0]} has one",
            "export both with their start (wf_start_time), or both without where they began together",
        )  # fmt: skip
    for key in sorted({key for axis in axes.values() for key in axis.marks}):
        said = {name: axis.marks.get(key) for name, axis in axes.items()}
        if len(set(said.values())) > 1:
            shown = ", ".join(f"{value} at {name}" for name, value in said.items())
            yield Fault(
                f"{file}, {key}", shown, "signals that began apart, by an attribute that is not read",
                "export them with a signal 'time' or wf_start_time each",
            )  # fmt: skip


def _start(said: Any) -> "np.datetime64 | None":
    """Start by an attribute: a time stamp, or seconds that all signals of a file count alike; None for all else."""
    if isinstance(said, np.datetime64) and not np.isnat(said):
        return np.datetime64(str(said), "us")
    if isinstance(said, int | float) and abs(said) <= LONGEST:
        return np.datetime64(round(1e6 * said), "us")
    return time_stamp(said) if isinstance(said, str) else None


def _tdms(path: Path, name: str, data: DataSection, wanted: Collection[str]) -> _Read:
    from nptdms import TdmsFile
    from nptdms.log import log_manager

    log_manager.set_level(logging.ERROR)
    columns: list[_Column] = []
    names: list[str] = []
    with path.open("rb") as stream, TdmsFile.open(stream) as file:
        channels = [channel for group in file.groups() for channel in group.channels()]
        stated = sum(len(channel) for channel in channels)
        size = path.stat().st_size
        if stated > size:
            raise refused(name, f"its header states {stated} samples, the file has {size} bytes", AGAIN)
        if file.file_status.incomplete_final_segment:
            lengths = (file.file_status.channel_statuses or {}).items()
            short = [f"{path} {status.read_length} of {status.expected_length}" for path, status in lengths]
            raise refused(
                name,
                f"is shorter than its header states, samples of the last segment: {', '.join(short)}",
                AGAIN,
            )
        for group in file.groups():
            time = next((channel for channel in group.channels() if channel.name in TIME_NAMES), None)
            for channel in group.channels():
                names.append(f"{group.name}/{channel.name}")
                if channel is time or not any(is_meant(names[-1], signal) for signal in wanted):
                    continue
                attributes = {**group.properties, **channel.properties}
                columns.append(
                    _Column(
                        name=names[-1], samples=np.asarray(channel[:]), attributes=attributes,
                        unit=str(channel.properties.get("unit_string", "")),
                        time=None if time is None else np.asarray(time[:]),
                        time_unit="" if time is None else str(time.properties.get("unit_string", "")),
                    )
                )  # fmt: skip
    return tuple(names), columns


def _hdf5(path: Path, name: str, data: DataSection, wanted: Collection[str]) -> _Read:
    try:
        names, datasets = read_datasets(path, data.size_limit, wanted)
    except RefusedError as error:
        raise refused(
            f"{name}, {error.place}" if error.place else name, error.problem, error.remedy
        ) from None
    arrays = {dataset.name: np.frombuffer(dataset.samples, dtype=dataset.dtype) for dataset in datasets}
    said = {
        dataset.name: str(dataset.attributes.get("units", dataset.attributes.get("unit", "")))
        for dataset in datasets
    }
    return names, [
        _Column(
            name=dataset.name, samples=arrays[dataset.name], unit=said[dataset.name], attributes=dataset.attributes,
            time=arrays.get(dataset.time), time_unit=said.get(dataset.time, ""),
        )
        for dataset in datasets if dataset.name.rpartition("/")[2] not in TIME_NAMES
    ]  # fmt: skip


MASTERS = (2, 3)
"""Types of channels of MDF4 that the others of their group are recorded over; of those over time the second is 1."""


def _mdf(path: Path, name: str, data: DataSection, wanted: Collection[str]) -> _Read:
    try:
        from asammdf import MDF
    except ImportError:
        raise refused(
            name, "MDF4 needs asammdf, which is not installed", "pip install rigdesign[mdf]"
        ) from None

    columns: list[_Column] = []
    names: list[str] = []
    with MDF(path) as file:
        for group, entry in enumerate(file.groups):
            label = entry.channel_group.acq_name or entry.channel_group.comment or f"group {group}"
            master = next((channel for channel in entry.channels if channel.channel_type in MASTERS), None)
            for index, channel in enumerate(entry.channels):
                if channel is master:
                    continue
                names.append(f"{label}/{channel.name}")
                if not any(is_meant(names[-1], asked) for asked in wanted):
                    continue
                if master is None or master.sync_type != 1:
                    raise refused(
                        f"{name}, {names[-1]}", "is not recorded over time", "export it with its time"
                    )
                signal = file.get(group=group, index=index)
                time = np.asarray(signal.timestamps)  # of all groups from the start of the measurement
                columns.append(
                    _Column(
                        name=names[-1], samples=np.asarray(signal.samples), unit=signal.unit or "", time=time,
                        time_unit=master.unit or "",
                    )
                )  # fmt: skip
    return tuple(names), columns


def _csv(path: Path, name: str, data: DataSection, wanted: Collection[str]) -> _Read:
    table = read_table(path.parent, path.name, data, with_units=True)
    if table.cut:
        raise refused(f"{name} {table.cut}", "the recording was cut off", AGAIN)
    key = next((time for time in TIME_NAMES if time in table.places), None)
    if key is None:
        raise refused(name, "no column 'time'", "add the time of each row, with its unit")
    names = tuple(column for column in table.names if column != key)
    time: NDArray[Any] | None = time_stamps(table.column(key))
    faults: list[Fault] = []
    if time is None:
        times, faults = numbers(table, key, data.decimal)
        time = np.array(times)
    columns: list[_Column] = []
    for column in names:
        if any(is_meant(column, signal) for signal in wanted):
            values, wrong = numbers(table, column, data.decimal)
            faults += wrong
            unit = table.unit(column).strip("[]()")
            columns.append(
                _Column(
                    name=column, samples=np.array(values), unit=unit, time=time, time_unit=table.unit(key)
                )
            )
    if faults:
        raise MeasurementError(faults)
    return names, columns


# The angle of the reference gear over time, from pulses or an encoder; lost pulses are found and filled.

HYSTERESIS = 0.2
"""Half width of the band about the middle of a pulse, as a share of its height, that noise must not cross."""
NEIGHBOURS = 9
"""Intervals whose median a lost or surplus pulse is found by."""
MOST_LOST = 0.05
"""Share of lost and surplus pulses from which a recording cannot be used."""
ENCODER_STEPS = 64
"""Points per turn at which an encoder's angle is kept."""


class TachError(ValueError):
    """A tach signal that gives no angle; the message says why and what to do."""


@dataclass(frozen=True)
class TurnAngle:
    """Angle of the reference gear at points in time, increasing.

    absolute : whether full turns are counted from where both teeth 0 met; else the angle is known but for whole turns
    lost : pulses that were missing and filled; surplus : pulses that were too many and left out
    """

    time: Array
    angle: Array
    absolute: bool
    lost: int = 0
    surplus: int = 0

    @property
    def turns(self) -> float:
        """Turns between first and last point."""
        return float(self.angle[-1] - self.angle[0]) / (2.0 * math.pi)

    @property
    def speed(self) -> float:
        """Mean speed [rad/s]."""
        return float((self.angle[-1] - self.angle[0]) / (self.time[-1] - self.time[0]))

    def at(self, time: Array) -> Array:
        """Angle at points in time [rad], NaN outside; a monotone cubic through the known ones."""
        from scipy.interpolate import PchipInterpolator

        return np.asarray(PchipInterpolator(self.time, self.angle, extrapolate=False)(time))


def turn_angle(tach: Tach, signals: Signals, start_turn: float | None) -> TurnAngle:
    """Angle of the reference gear.

    Parameters
    ----------
    start_turn : turns since both teeth 0 met at the first angle zero of the recording, where known

    Raises
    ------
    TachError
        A signal is missing or dead, has too few pulses, loses too many, runs backwards.
    """
    signal = _named(signals, tach.signal)
    if tach.kind == "angle":
        return _encoder(tach, signal, start_turn)
    edges = rising_edges(signal)
    counts, kept, lost, surplus = pulse_counts(edges)
    if lost + surplus > MOST_LOST * len(edges):
        raise TachError(
            f"{tach.signal}: {lost} pulses lost and {surplus} too many of {len(edges)}, above {MOST_LOST:.0%}; "
            "look at sensor, gap and trigger level"
        )
    marks = None if tach.index is None else rising_edges(_named(signals, tach.index))
    pulses = _pulses_per_turn(tach, counts, kept, marks)
    turn = TurnAngle(kept, 2.0 * math.pi * counts / pulses, start_turn is not None, lost, surplus)
    if pulses > 1:
        turn = _indexed(tach, turn, marks)
    whole = 0.0 if start_turn is None else 2.0 * math.pi * start_turn
    return TurnAngle(turn.time, turn.angle + tach.zero + whole, turn.absolute, lost, surplus)


def rising_edges(signal: Signal) -> Array:
    """Times at which a pulse signal rises through its middle, between samples by straight lines."""
    finite = np.isfinite(signal.values)
    time, values = signal.time[finite], signal.values[finite]
    if not values.size:
        raise TachError("no sample of the tach is a number; look at its cable")
    low, high = np.quantile(values, (0.005, 0.995))
    if not high > low:
        low, high = float(values.min()), float(values.max())
    if not high > low:
        raise TachError("the tach signal never changes; look at sensor and cable")
    middle, band = 0.5 * (low + high), HYSTERESIS * (high - low)
    state = np.where(values > middle + band, 1, np.where(values < middle - band, -1, 0))
    firm = np.flatnonzero(state)
    rises = firm[1:][(state[firm[1:]] == 1) & (state[firm[:-1]] == -1)]
    crossings = np.flatnonzero((values[:-1] < middle) & (values[1:] >= middle))
    last = crossings[np.searchsorted(crossings, rises - 1, side="right") - 1]
    share = (middle - values[last]) / (values[last + 1] - values[last])
    return np.asarray(time[last] + share * (time[last + 1] - time[last]))


def pulse_counts(edges: Array) -> tuple[Array, Array, int, int]:
    """Number of each pulse counted from the first, times kept, pulses lost, pulses too many.

    An interval of about n times the median of its neighbours stands for n; one below half of it ends with a
    surplus pulse.
    """
    if len(edges) < 4:
        raise TachError(
            f"{len(edges)} tach pulses, at least 4 are needed; record longer or look at the trigger level"
        )
    kept, surplus = list(edges), 0
    short = True
    while short and len(kept) >= 4:
        steps = np.diff(kept)
        usual = _running_median(steps)
        below = np.flatnonzero(steps < 0.5 * usual)
        short = below.size > 0
        if short:
            del kept[int(below[0]) + 1]
            surplus += 1
        if surplus > MOST_LOST * len(edges):
            break
    steps = np.diff(kept)
    strides = np.maximum(np.rint(steps / _running_median(steps)), 1.0)
    counts = np.concatenate([[0.0], np.cumsum(strides)])
    return counts, np.asarray(kept), int(counts[-1]) + 1 - len(kept), surplus


def _running_median(values: Array) -> Array:
    half = NEIGHBOURS // 2
    padded = np.pad(values, half, mode="reflect" if len(values) > half else "edge")
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(padded, NEIGHBOURS), axis=1))


def _pulses_per_turn(tach: Tach, counts: Array, kept: Array, marks: Array | None) -> int:
    """As stated, which the pulses from one index pulse to the next have to confirm, or as these count them."""
    passed = np.empty(0) if marks is None else np.interp(marks, kept, counts, np.nan, np.nan)
    steps = np.diff(passed[np.isfinite(passed)])
    counted = round(float(np.median(steps))) if steps.size else None
    stated = tach.pulses_per_turn
    if stated is not None and counted not in (None, stated):
        raise TachError(
            f"{tach.index} comes every {counted} pulses of {tach.signal}, data.tach.pulses_per_turn says {stated}; "
            "correct the key, or look at both sensors"
        )
    if stated is None and marks is not None and counted is None:
        raise TachError(
            f"{tach.index}: fewer than two index pulses within the tach pulses; state pulses_per_turn"
        )
    return stated or counted or 1


def _indexed(tach: Tach, turn: TurnAngle, marks: Array | None) -> TurnAngle:
    """Zero of the angle at the index pulse."""
    if marks is None:
        raise TachError(
            f"{tach.pulses_per_turn} pulses a turn say nothing of where zero is; name data.tach.index, a signal with "
            "one pulse a turn"
        )
    marks = turn.at(marks)
    marks = marks[np.isfinite(marks)]
    if not marks.size:
        raise TachError(f"{tach.index}: no index pulse within the tach pulses; look at its cable")
    zero = float(np.angle(np.mean(np.exp(1j * marks))))
    first = marks[0] - zero
    shift = zero + 2.0 * math.pi * round(first / (2.0 * math.pi))
    return TurnAngle(turn.time, turn.angle - shift, turn.absolute)


def _encoder(tach: Tach, signal: Signal, start_turn: float | None) -> TurnAngle:
    scale = {"deg": math.pi / 180.0, "rad": 1.0, "mrad": 1e-3}[tach.unit]
    finite = np.isfinite(signal.values)
    time, angle = signal.time[finite], scale * signal.values[finite]
    if angle.size < 2 or np.ptp(angle) == 0.0:
        raise TachError(f"{tach.signal}: the angle never changes; look at the encoder")
    if tach.wraps:
        angle = np.unwrap(angle)
        angle = angle - 2.0 * math.pi * math.floor(angle[0] / (2.0 * math.pi))
    if angle[-1] <= angle[0]:
        raise TachError(
            f"{tach.signal}: the angle runs backwards; exchange the tracks of the encoder or turn its sign"
        )
    grid = np.arange(angle[0], angle[-1], 2.0 * math.pi / ENCODER_STEPS)
    rising = np.maximum.accumulate(angle)
    first = np.concatenate([[True], np.diff(rising) > 0.0])
    whole = 2.0 * math.pi * start_turn if start_turn is not None and tach.wraps else 0.0
    moment = np.interp(grid, rising[first], time[first])
    inside = np.concatenate([[True], np.diff(moment) > 0.0])
    known = not tach.wraps or start_turn is not None
    return TurnAngle(moment[inside], grid[inside] + tach.zero + whole, known)


def _named(signals: Signals, name: str) -> Signal:
    if name not in signals:
        raise TachError(f"no signal {name} in the recording; it has {', '.join(signals.names)}")
    return signals[name]

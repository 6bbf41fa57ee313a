"""Raw time data on disk: TDMS, HDF5, MDF4 and CSV as signals over time, each with its unit."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.measurement.reading.document import DataSection
from rigdesign.measurement.reading.files import refused, set_file
from rigdesign.measurement.reading.hdf5_samples import AGAIN, RefusedError, read_datasets
from rigdesign.measurement.reading.table import MOST_FAULTS, numbers, read_table

Array = NDArray[np.float64]
TIME_NAMES = ("time", "Time", "t", "Zeit")
"""Signals that hold the time [s] of the others."""
FASTEST, SLOWEST = 1e-9, 1e5
"""Least and most time from sample to sample of a logger [s]."""
LONGEST = 1e11
"""Largest time of a sample [s]; seconds since 1904 are below."""


@dataclass(frozen=True)
class Signal:
    """One recorded signal.

    time : (n,) [s], increasing; values : (n,), NaN where missing; unit : as in the file, may be empty
    """

    time: Array
    values: Array
    unit: str = ""


Signals = Mapping[str, Signal]


def read_signals(folder: Path, name: str, data: DataSection) -> Signals:
    """All signals of a file by name; where names repeat in groups, by ``group/name``, too.

    Raises
    ------
    MeasurementError
        No file of the set (`rigdesign.measurement.reading.files.set_file`), an unknown kind of file, content that
        cannot be read, fewer samples than its header states, more than ``data.size_limit``, no time.
    """
    readers: dict[str, Callable[[Path, str, DataSection], Signals]] = {
        ".tdms": _tdms, ".h5": _hdf5, ".hdf5": _hdf5, ".mf4": _mdf, ".csv": _csv,
    }  # fmt: skip
    kind = Path(name.replace("\0", "")).suffix.lower()
    reader = readers.get(kind)
    if reader is None:
        raise refused(name, f"unknown kind of file {kind!r}", f"write one of {', '.join(readers)}")
    path = set_file(folder, name, data.size_limit)
    try:
        with np.errstate(all="ignore"):
            signals = reader(path, name, data)
    except MeasurementError:
        raise
    except Exception as error:  # readers of binary files raise whatever a damaged byte leads them to
        said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise refused(name, f"cannot be read or was cut off ({said})", AGAIN) from None
    if not signals:
        raise refused(name, "holds no signal", "export it again with its channels")
    for key, signal in signals.items():
        if len(signal.time) < 2 or not np.all(np.diff(signal.time) > 0.0):
            raise refused(
                f"{name}, {key}", "its time does not increase", "export it with a sampling rate or time"
            )
        if not np.abs(signal.time[[0, -1]]).max() <= LONGEST:
            raise refused(f"{name}, {key}", f"its time reaches {signal.time[-1]:.3g} s", "correct its time")
    return signals


def _tdms(path: Path, name: str, data: DataSection) -> Signals:
    from nptdms import TdmsFile
    from nptdms.log import log_manager

    log_manager.set_level(logging.ERROR)
    found: dict[str, Signal] = {}
    with path.open("rb") as stream, TdmsFile.open(stream) as file:
        channels = [channel for group in file.groups() for channel in group.channels()]
        stated = sum(len(channel) for channel in channels)
        size = path.stat().st_size
        if stated > size:
            raise refused(name, f"its header states {stated} samples, the file has {size} bytes", AGAIN)
        if file.file_status.incomplete_final_segment:
            lengths = (file.file_status.channel_statuses or {}).items()
            short = [f"{path} {one.read_length} of {one.expected_length}" for path, one in lengths]
            raise refused(
                name,
                f"is shorter than its header states, samples of the last segment: {', '.join(short)}",
                AGAIN,
            )
        for group in file.groups():
            times = {c.name: np.asarray(c[:], dtype=float) for c in group.channels() if c.name in TIME_NAMES}
            time = next(iter(times.values()), None)
            for channel in group.channels():
                if channel.name in TIME_NAMES or channel.dtype.kind not in "fiu":
                    continue
                values = np.asarray(channel[:], dtype=float)
                step = channel.properties.get("wf_increment")
                start = float(channel.properties.get("wf_start_offset", 0.0))
                own = _time(f"{name}, {channel.name}", len(values), step, start, time)
                signal = Signal(own, values, str(channel.properties.get("unit_string", "")))
                found[f"{group.name}/{channel.name}"] = signal
                found.setdefault(channel.name, signal)
    return found


def _hdf5(path: Path, name: str, data: DataSection) -> Signals:
    try:
        datasets = read_datasets(path, data.size_limit)
    except RefusedError as error:
        raise refused(
            f"{name}, {error.place}" if error.place else name, error.problem, error.remedy
        ) from None
    arrays = {one.name: np.frombuffer(one.samples, dtype=float) for one in datasets}
    found: dict[str, Signal] = {}
    for one in datasets:
        group, _, short = one.name.rpartition("/")
        if short in TIME_NAMES:
            continue
        times = (arrays.get(f"{group}/{time}" if group else time) for time in TIME_NAMES)
        time = next((values for values in times if values is not None), None)
        step = one.step
        if step is None and one.rate is not None:
            step = _step(f"{name}, {one.name}", one.rate)
        own = _time(f"{name}, {one.name}", len(arrays[one.name]), step, 0.0, time)
        found[one.name] = Signal(own, arrays[one.name], one.unit)
        found.setdefault(short, found[one.name])
    return found


def _step(at: str, rate: float) -> float:
    """Time from sample to sample [s] of a sampling rate [Hz]."""
    if not 1.0 / SLOWEST <= rate <= 1.0 / FASTEST:
        raise refused(
            at,
            f"sample_rate = {rate:g}, outside {1.0 / SLOWEST:g} to {1.0 / FASTEST:g} Hz",
            "correct the attribute",
        )
    return 1.0 / rate


def _mdf(path: Path, name: str, data: DataSection) -> Signals:
    try:
        from asammdf import MDF
    except ImportError:
        raise refused(
            name, "MDF4 needs asammdf, which is not installed", "pip install rigdesign[mdf]"
        ) from None

    found: dict[str, Signal] = {}
    with MDF(path) as file:
        for signal in file.iter_channels():
            if signal.samples.dtype.kind in "fiu" and signal.samples.ndim == 1:
                time = np.asarray(signal.timestamps, dtype=float)
                found.setdefault(
                    signal.name, Signal(time, np.asarray(signal.samples, dtype=float), signal.unit or "")
                )
    return found


def _csv(path: Path, name: str, data: DataSection) -> Signals:
    table = read_table(path.parent, path.name, data, with_units=True)
    if table.cut:
        raise refused(f"{name} {table.cut}", "the recording was cut off", AGAIN)
    key = next((time for time in TIME_NAMES if time in table.places), None)
    if key is None:
        raise refused(name, "no column 'time'", "add the time of each row in seconds")
    columns: dict[str, Array] = {}
    faults: list[Fault] = []
    for column in table.names:
        values, wrong = numbers(table, column, data.decimal)
        columns[column] = np.array(values)
        faults += wrong
    if faults:
        raise MeasurementError(faults[:MOST_FAULTS])
    return {
        column: Signal(columns[key], values, table.unit(column).strip("[]()"))
        for column, values in columns.items()
        if column != key
    }


def _time(at: str, count: int, step: Any, start: float, time: Array | None) -> Array:
    if step is not None and float(step) > 0.0:
        if not FASTEST <= float(step) <= SLOWEST:
            raise refused(
                at, f"{float(step):g} s from sample to sample", f"write {FASTEST:g} to {SLOWEST:g} s"
            )
        return np.asarray(start + float(step) * np.arange(count), dtype=float)
    if time is not None and len(time) == count:
        return np.asarray(time, dtype=float)
    raise refused(
        at, "neither a sampling rate nor a signal 'time' of the same length",
        "export it with wf_increment (TDMS), the attribute sample_rate (HDF5) or a signal 'time'",
    )  # fmt: skip

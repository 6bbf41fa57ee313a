"""Raw time data on disk: TDMS, HDF5, MDF4 and CSV as signals over time, each with its unit."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.errors import Fault, MeasurementError
from rigdesign.measurement.document import Data
from rigdesign.measurement.table import number, read_table

Array = NDArray[np.float64]
TIME_NAMES = ("time", "Time", "t", "Zeit")
"""Signals that hold the time [s] of the others."""


@dataclass(frozen=True)
class Signal:
    """One recorded signal.

    time : (n,) [s], increasing; values : (n,), NaN where missing; unit : as in the file, may be empty
    """

    time: Array
    values: Array
    unit: str = ""


Signals = Mapping[str, Signal]


def read_signals(folder: Path, name: str, data: Data) -> Signals:
    """All signals of a file by name; where names repeat in groups, by ``group/name``, too.

    Raises
    ------
    MeasurementError
        No such file, an unknown kind of file, content that cannot be read, no time.
    """
    path = folder / name
    readers: dict[str, Callable[[Path, Data], Signals]] = {
        ".tdms": _tdms, ".h5": _hdf5, ".hdf5": _hdf5, ".mf4": _mdf, ".csv": _csv,
    }  # fmt: skip
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise _fault(name, f"unknown kind of file {path.suffix!r}", f"write one of {', '.join(readers)}")
    if not path.is_file():
        raise _fault(name, "no such file", "correct data.recordings or add the file")
    try:
        signals = reader(path, data)
    except MeasurementError:
        raise
    except (OSError, ValueError, KeyError, IndexError, EOFError) as error:
        raise _fault(name, f"cannot be read or was cut off ({error})", "record or export it again") from None
    if not signals:
        raise _fault(name, "holds no signal", "export it again with its channels")
    for key, signal in signals.items():
        if len(signal.time) < 2 or not np.all(np.diff(signal.time) > 0.0):
            raise _fault(
                f"{name}, {key}", "its time does not increase", "export it with a sampling rate or time"
            )
    return signals


def _fault(path: str, problem: str, remedy: str) -> MeasurementError:
    return MeasurementError([Fault(path, "", problem, remedy)])


def _tdms(path: Path, data: Data) -> Signals:
    from nptdms import TdmsFile

    found: dict[str, Signal] = {}
    with TdmsFile.open(path) as file:
        for group in file.groups():
            times = {c.name: np.asarray(c[:], dtype=float) for c in group.channels() if c.name in TIME_NAMES}
            time = next(iter(times.values()), None)
            for channel in group.channels():
                if channel.name in TIME_NAMES or channel.dtype.kind not in "fiu":
                    continue
                values = np.asarray(channel[:], dtype=float)
                step = channel.properties.get("wf_increment")
                start = float(channel.properties.get("wf_start_offset", 0.0))
                own = _time(path.name, channel.name, len(values), step, start, time)
                signal = Signal(own, values, str(channel.properties.get("unit_string", "")))
                found[f"{group.name}/{channel.name}"] = signal
                found.setdefault(channel.name, signal)
    return found


def _hdf5(path: Path, data: Data) -> Signals:
    import h5py

    found: dict[str, Signal] = {}
    with h5py.File(path, "r") as file:
        names: list[str] = []
        file.visit(lambda name: names.append(name) if isinstance(file[name], h5py.Dataset) else None)
        for name in names:
            dataset, short = file[name], name.rpartition("/")[2]
            if dataset.ndim != 1 or dataset.dtype.kind not in "fiu" or short in TIME_NAMES:
                continue
            group = dataset.parent
            time = next((np.asarray(group[t], dtype=float) for t in TIME_NAMES if t in group), None)
            rate = dataset.attrs.get("sample_rate", file.attrs.get("sample_rate"))
            step = dataset.attrs.get("dt", None if rate is None else 1.0 / float(rate))
            values = np.asarray(dataset, dtype=float)
            own = _time(path.name, name, len(values), step, 0.0, time)
            unit = dataset.attrs.get("units", dataset.attrs.get("unit", ""))
            signal = Signal(own, values, unit.decode() if isinstance(unit, bytes) else str(unit))
            found[name] = signal
            found.setdefault(short, signal)
    return found


def _mdf(path: Path, data: Data) -> Signals:
    try:
        from asammdf import MDF
    except ImportError:
        raise _fault(
            path.name, "MDF4 needs asammdf, which is not installed", "pip install rigdesign[mdf]"
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


def _csv(path: Path, data: Data) -> Signals:
    table = read_table(path.parent, path.name, data, with_units=True)
    key = next((name for name in TIME_NAMES if name in table.names), None)
    if key is None:
        raise _fault(path.name, "no column 'time'", "add the time of each row in seconds")
    columns: dict[str, Array] = {}
    for name in table.names:
        try:
            columns[name] = np.array([number(cell, data.decimal) for cell in table.column(name)])
        except ValueError as error:
            raise _fault(f"{path.name}, {name}", str(error), "write numbers or leave cells empty") from None
    return {
        name: Signal(columns[key], values, unit.strip("[]()"))
        for (name, values), unit in zip(columns.items(), table.units)
        if name != key
    }


def _time(file: str, name: str, count: int, step: Any, start: float, time: Array | None) -> Array:
    if step is not None and float(step) > 0.0:
        return np.asarray(start + float(step) * np.arange(count), dtype=float)
    if time is not None and len(time) == count:
        return np.asarray(time, dtype=float)
    raise _fault(
        f"{file}, {name}", "neither a sampling rate nor a signal 'time' of the same length",
        "export it with wf_increment (TDMS), the attribute sample_rate (HDF5) or a signal 'time'",
    )  # fmt: skip

"""A measurement set of raw recordings for tests: torque, tach and an oil that warms up, in any kind of file."""

import math
from pathlib import Path

import h5py
import numpy as np
from nptdms import ChannelObject, TdmsWriter

from tests.builders.measurement import replaced

RATE = 1000.0
SECONDS = 3.0
HEAD = """\
schema_version = 1
title = "recorded"
case = "loop_1to1"

[data]
tach = { kind = "pulses", signal = "Tach" }

[[data.recordings]]
point = "P01"
repeat = 1
file = "P01_1.KIND"

[[data.recordings]]
point = "P01"
repeat = 2
file = "P01_2.KIND"

[settings.n]
quantity = "speed"
unit = "rpm"
uncertainty = "1 rpm"

[settings.M]
quantity = "torque"
unit = "N m"
uncertainty = "0.5 N m"

[channels.M_wheel]
quantity = "torque"
place = "wheel_side"
unit = "N m"
uncertainty = "0.05 N m"
orders = [0, 1, 2]

[channels.T_out]
quantity = "oil_outlet_temperature"
place = "test.gear_oil"
unit = "degC"
uncertainty = "0.1 K"
"""
ROWS = "point,repeat,n,M\n,,rpm,N m\nP01,1,1500,100\nP01,2,1500,100\n"
UNITS = {"M_wheel": "N m", "Tach": "V", "T_out": "degC"}


def signals(repeat: int = 1) -> dict[str, np.ndarray]:
    """25 turns a second, the oil 15 K warmer at the end than at the start."""
    time = np.arange(int(RATE * SECONDS)) / RATE
    phi = 2.0 * math.pi * 25.0 * time
    shift = 0.01 * repeat
    return {
        "M_wheel": 100.0 + shift + 0.6 * np.cos(phi) + 0.1 * np.sin(2.0 * phi),
        "Tach": np.tanh(20.0 * np.sin(phi - 0.2)),
        "T_out": 60.0 + shift + 5.0 * time,
    }


def write_recording(
    path: Path, recorded: dict[str, np.ndarray], units: dict[str, str] = UNITS, rate: float = RATE
) -> None:
    """A file of the kind that its name ends with."""
    {".tdms": _tdms, ".h5": _hdf5, ".csv": _csv}[path.suffix](path, recorded, units, rate)


def write_recorded_set(folder: Path, kind: str) -> Path:
    """One operating point, two repeats; ``kind`` is tdms, h5 or csv."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "measurement.toml").write_text(HEAD, encoding="utf-8")
    replaced(folder, "measurement.toml", "KIND", kind)
    (folder / "data.csv").write_text(ROWS, encoding="utf-8")
    for repeat in (1, 2):
        write_recording(folder / f"P01_{repeat}.{kind}", signals(repeat))
    return folder


def _tdms(path: Path, recorded: dict[str, np.ndarray], units: dict[str, str], rate: float) -> None:
    timing = {"wf_increment": 1.0 / rate, "wf_start_offset": 0.0}
    channels = [
        ChannelObject("Dev1", name, values, properties={**timing, "unit_string": units[name]})
        for name, values in recorded.items()
    ]
    with TdmsWriter(path) as writer:
        writer.write_segment(channels)


def _hdf5(path: Path, recorded: dict[str, np.ndarray], units: dict[str, str], rate: float) -> None:
    with h5py.File(path, "w") as file:
        file.attrs["sample_rate"] = rate
        for name, values in recorded.items():
            file[name] = values
            file[name].attrs["units"] = units[name]


def _csv(path: Path, recorded: dict[str, np.ndarray], units: dict[str, str], rate: float) -> None:
    rows = [",".join(["time", *recorded]), ",".join(["s", *(units[name] for name in recorded)])]
    columns = [np.arange(len(next(iter(recorded.values())))) / rate, *recorded.values()]
    rows += [",".join(f"{value:.10g}" for value in row) for row in zip(*columns)]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")

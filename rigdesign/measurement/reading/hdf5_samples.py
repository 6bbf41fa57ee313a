"""Samples of an HDF5 file, read in a process of its own: a damaged file may crash the library that reads it.

Run as ``python -P hdf5_samples.py FILE LIMIT NAME…`` it writes a line of JSON, the names of all datasets and what is
known of those that are wanted, and then the samples of these one after the other. What is wrong with the file goes to
stderr as JSON with status 3, what the library says as text with status 1. Nothing of rigdesign is imported in that
process.
"""

import json
import subprocess
import sys
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

PATIENCE = 300.0
"""Longest time that a file takes to be read [s]; a damaged one may keep the library busy for ever."""
REFUSED = 3
"""Status of the process where the file is refused."""
AGAIN = "record or export it again"
TIME_NAMES = ("time", "Time", "t", "Zeit")
"""Signals that hold the time of the others of their group."""
SPACED = ("dt", "sample_rate")
"""Attributes that say how far samples are apart."""


class Dataset(NamedTuple):
    """One dataset of numbers, of a table one column of it.

    attributes : single numbers and texts of its own, of its group and of the file, the nearest first
    time : name of the dataset that holds its time, itself among those read; empty without one
    """

    name: str
    attributes: dict[str, Any]
    time: str
    dtype: str
    samples: bytes


class RefusedError(ValueError):
    """A file that can be read but not used.

    place : dataset or attribute, empty for the file as a whole
    """

    def __init__(self, place: str, problem: str, remedy: str) -> None:
        super().__init__(place, problem, remedy)
        self.place, self.problem, self.remedy = place, problem, remedy


def is_meant(name: str, wanted: str) -> bool:
    """Whether a signal, ``group/channel``, goes by a name: in full, or without groups before it."""
    return name == wanted or name.endswith(f"/{wanted}")


def read_datasets(path: Path, limit: float, wanted: Collection[str]) -> tuple[tuple[str, ...], list[Dataset]]:
    """Names of all datasets, and those that go by one of the names ``wanted``, each with that of its time.

    limit : most samples

    Raises
    ------
    RefusedError
        Too many samples, fewer than a shape states, samples in another file, no numbers, two dimensions.
    OSError
        Whatever the library says of the file, or that it crashed or took too long on it.
    """
    command = [sys.executable, "-P", __file__, str(path), repr(limit), *wanted]
    try:
        done = subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise OSError(f"it cannot be read within {PATIENCE:g} s") from None
    if done.returncode == REFUSED:
        raise RefusedError(*json.loads(done.stderr))
    if done.returncode < 0:
        raise OSError(f"the HDF5 library crashed on it, signal {-done.returncode}")
    if done.returncode:
        raise OSError(done.stderr.decode(errors="replace").strip()[-300:] or f"status {done.returncode}")
    head, _, samples = done.stdout.partition(b"\n")
    names, rows = json.loads(head)
    datasets, start = [], 0
    for name, attributes, time, dtype, size in rows:
        datasets.append(Dataset(name, attributes, time, dtype, samples[start : start + size]))
        start += size
    return tuple(names), datasets


def write_datasets(path: str, limit: float, wanted: Collection[str]) -> None:
    """The work of the other process: head and samples to stdout."""
    import h5py

    with h5py.File(path, "r") as file:
        datasets = dict(_columns(file))
        times = {}
        for name in datasets:
            if any(is_meant(name, signal) for signal in wanted):
                group = name.rpartition("/")[0]
                near = (f"{group}/{time}" if group else time for time in TIME_NAMES)
                times[name] = next((time for time in near if time in datasets), "")
        chosen = dict.fromkeys([*times, *filter(None, times.values())])
        stated = sum(datasets[name][0].size for name in chosen)
        if stated > limit:
            remedy = "raise data.size_limit if that is meant"
            raise RefusedError("", f"holds {stated} samples, data.size_limit is {limit:.0f}", remedy)
        arrays = {name: _samples(name, *datasets[name], is_time=name not in times) for name in chosen}
        rows = [
            (name, _attributes(datasets[name][0]), times.get(name, ""), array.dtype.str, array.nbytes)
            for name, array in arrays.items()
        ]
        sys.stdout.buffer.write(json.dumps([list(datasets), rows]).encode() + b"\n")
        for array in arrays.values():
            sys.stdout.buffer.write(array.tobytes())


def _columns(file: Any) -> Iterator[tuple[str, tuple[Any, str]]]:
    """All datasets, those of named columns by column: name, dataset and column."""
    import h5py

    names: list[str] = []
    file.visit(lambda key: names.append(key) if isinstance(file[key], h5py.Dataset) else None)
    for key in names:
        columns = file[key].dtype.names or ("",)
        yield from ((f"{key}/{column}" if column else key, (file[key], column)) for column in columns)


def _samples(place: str, dataset: Any, column: str, *, is_time: bool) -> Any:
    """(n,) numbers as float64, time stamps as datetime64[ns]."""
    import numpy as np

    if max(dataset.shape, default=1) < dataset.size:
        shape = " x ".join(str(length) for length in dataset.shape)
        raise RefusedError(
            place, f"has the shape {shape}, a signal has one dimension", "export each signal as a dataset"
        )
    _check_stored(place, dataset)
    stored = np.ravel(dataset[()])
    values = stored[column] if column else stored
    if values.dtype.kind in "fiub":
        return np.asarray(values, dtype=float)
    if is_time and values.dtype.kind in "OSU":
        texts = [cell.decode() if isinstance(cell, bytes) else str(cell) for cell in values]
        return np.array([text.removesuffix("Z") for text in texts], dtype="datetime64[ns]")
    raise RefusedError(place, f"holds {values.dtype}, no numbers", "export it as numbers")


def _attributes(dataset: Any) -> dict[str, Any]:
    """Single numbers and texts that are said of a dataset, by itself, its group or the file."""
    import numpy as np

    attributes: dict[str, Any] = {}
    for level in (dataset.file.attrs, dataset.parent.attrs, dataset.attrs):
        if any(key in level for key in SPACED):
            attributes = {key: value for key, value in attributes.items() if key not in SPACED}
        for key, value in level.items():
            single = np.ravel(value)
            if single.size == 1:
                plain = single[0].item() if hasattr(single[0], "item") else single[0]
                attributes[key] = plain.decode(errors="replace") if isinstance(plain, bytes) else plain
    return {key: value for key, value in attributes.items() if isinstance(value, str | int | float)}


def _check_stored(place: str, dataset: Any) -> None:
    """All samples that the shape of a dataset states are in this file."""
    import numpy as np

    if dataset.is_virtual or dataset.external:
        raise RefusedError(place, "its samples lie in another file", "export it into one file")
    if dataset.chunks is None:
        stored = dataset.id.get_storage_size() // dataset.dtype.itemsize
    else:
        stored = min(dataset.id.get_num_chunks() * int(np.prod(dataset.chunks)), dataset.size)
    if stored < dataset.size:
        raise RefusedError(place, f"holds {stored} samples, its shape states {dataset.size}", AGAIN)


def main() -> int:
    """Read the file of the command line; the status of the process."""
    try:
        write_datasets(sys.argv[1], float(sys.argv[2]), sys.argv[3:])
    except RefusedError as error:
        sys.stderr.write(json.dumps(error.args))
        return REFUSED
    except Exception as error:  # whatever a damaged byte leads the library to
        sys.stderr.write(f"{type(error).__name__}: {error}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

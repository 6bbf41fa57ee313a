"""Samples of an HDF5 file, read in a process of its own: a damaged file may crash the library that reads it.

Run as ``python -P hdf5_samples.py FILE LIMIT`` it writes a line of JSON, the datasets with their names, units, sampling
rates and counts, and then their samples one after the other (float64). What is wrong with the file goes to stderr
as JSON with status 3, what the library says as text with status 1. Nothing of rigdesign is imported in that process.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

PATIENCE = 300.0
"""Longest time that a file takes to be read [s]; a damaged one may keep the library busy for ever."""
REFUSED = 3
"""Status of the process where the file is refused."""
AGAIN = "record or export it again"


class Dataset(NamedTuple):
    """One dataset of numbers; ``step`` and ``rate`` as its attributes say, None where they do not."""

    name: str
    unit: str
    step: float | None
    rate: float | None
    samples: bytes


class RefusedError(ValueError):
    """A file that can be read but not used.

    place : dataset or attribute, empty for the file as a whole
    """

    def __init__(self, place: str, problem: str, remedy: str) -> None:
        super().__init__(place, problem, remedy)
        self.place, self.problem, self.remedy = place, problem, remedy


def read_datasets(path: Path, limit: float) -> list[Dataset]:
    """All datasets of one dimension with numbers; ``limit``: most samples.

    Raises
    ------
    RefusedError
        Too many samples, fewer than a shape states, samples in another file.
    OSError
        Whatever the library says of the file, or that it crashed or took too long on it.
    """
    command = [sys.executable, "-P", __file__, str(path), repr(limit)]
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
    found, start = [], 0
    for name, unit, step, rate, count in json.loads(head):
        found.append(Dataset(name, unit, step, rate, samples[start : start + 8 * count]))
        start += 8 * count
    return found


def write_datasets(path: str, limit: float) -> None:
    """The work of the other process: head and samples to stdout."""
    import h5py
    import numpy as np

    with h5py.File(path, "r") as file:
        names: list[str] = []
        file.visit(lambda key: names.append(key) if isinstance(file[key], h5py.Dataset) else None)
        chosen = [key for key in names if file[key].ndim == 1 and file[key].dtype.kind in "fiu"]
        stated = sum(file[key].size for key in chosen)
        if stated > limit:
            remedy = "raise data.size_limit if that is meant"
            raise RefusedError("", f"holds {stated} samples, data.size_limit is {limit:.0f}", remedy)
        head = []
        for key in chosen:
            _check_stored(key, file[key])
            own, common = file[key].attrs, file.attrs
            unit = own.get("units", own.get("unit", ""))
            text = unit.decode() if isinstance(unit, bytes) else str(unit)
            step, rate = own.get("dt"), own.get("sample_rate", common.get("sample_rate"))
            numbers = (None if value is None else float(value) for value in (step, rate))
            head.append((key, text, *numbers, file[key].size))
        sys.stdout.buffer.write(json.dumps(head).encode() + b"\n")
        for key in chosen:
            sys.stdout.buffer.write(np.asarray(file[key], dtype=float).tobytes())


def _check_stored(place: str, dataset: Any) -> None:
    """All samples that the shape of a dataset states are in this file."""
    if dataset.is_virtual or dataset.external:
        raise RefusedError(place, "its samples lie in another file", "export it into one file")
    if dataset.chunks is None:
        stored = dataset.id.get_storage_size() // dataset.dtype.itemsize
    else:
        stored = min(dataset.id.get_num_chunks() * dataset.chunks[0], dataset.size)
    if stored < dataset.size:
        raise RefusedError(place, f"holds {stored} samples, its shape states {dataset.size}", AGAIN)


def main() -> int:
    """Read the file of the command line; the status of the process."""
    try:
        write_datasets(sys.argv[1], float(sys.argv[2]))
    except RefusedError as error:
        sys.stderr.write(json.dumps(error.args))
        return REFUSED
    except Exception as error:  # whatever a damaged byte leads the library to
        sys.stderr.write(f"{type(error).__name__}: {error}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

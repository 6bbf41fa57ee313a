"""Damaged measurement sets: refused with the file named, reported as a finding, or unharmed; never a crash."""

import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.measurement import Data, features, load_measurement
from tests.builders.corruption import Damage, damages
from tests.builders.measurement import write_set
from tests.builders.paths import CASES
from tests.builders.recording import write_recorded_set

SOME, MANY = 24, 400
SOME_HDF5, MANY_HDF5 = 6, 150
"""Of HDF5 files, each of which is read in a process of its own."""
MOST_UNSEEN = 12.0
"""By how many standard deviations of a mean one of two repeats may move it before it is told: 8 of its distance from
their median are 8 of the mean, where the scatter is as declared; where it is less, more."""
LONGEST = 60.0
"""A damaged file must not take longer to be refused [s]."""
SETS = {
    "data.csv": ("uhcf_prototype", None),
    "orders.csv": ("uhcf_prototype", None),
    "measurement.toml": ("uhcf_prototype", None),
    "P01_1.csv": ("loop_1to1", "csv"),
    "P01_1.tdms": ("loop_1to1", "tdms"),
    "P01_1.h5": ("loop_1to1", "h5"),
}
"""File that is damaged -> case, kind of the recordings."""
BINARY = ("P01_1.tdms", "P01_1.h5")
HEAD = 1500
"""Bytes of a binary file that hold what it says of its samples."""


class Trial:
    """One file of a set, damaged again and again."""

    def __init__(self, folder: Path, name: str) -> None:
        case, kind = SETS[name]
        self._case = load_case(CASES / case)
        self._folder = write_set(folder) if kind is None else write_recorded_set(folder, kind)
        self._file = folder / name
        self.whole = self._file.read_bytes()
        self._clean = self._read()

    def outcome(self, damage: Damage) -> str:
        """What becomes of the set.

        refused, reported or unharmed; shorter: cut at the end of a row, which is another, shorter file; another
        reading: the numbers differ by less than one of two repeats may; wrong: by more; or the name of an exception.
        """
        self._file.write_bytes(damage.content)
        started = time.perf_counter()
        try:
            data = self._read()
        except MeasurementError as error:
            data = None
            found = "refused" if self._named(str(error)) else f"refused without a place: {error}"
        except Exception as error:  # counted, whatever it is
            return f"crash: {type(error).__name__}"
        if time.perf_counter() - started > LONGEST:
            return "too slow"
        if data is None:
            return found
        row_end = damage.cut and self._file.suffix == ".csv" and damage.content.endswith(b"\n")
        found = self._against_clean(data)
        return "shorter" if row_end and found in ("another reading", "wrong") else found

    def _read(self) -> Data:
        return features(load_measurement(self._folder, self._case))

    def _named(self, message: str) -> bool:
        return self._file.name in message or "measurement.toml" in message

    def _against_clean(self, data: Data) -> str:
        if {one.text for one in data.findings} - {one.text for one in self._clean.findings}:
            return "reported"
        if data.features != self._clean.features or not np.array_equal(data.usable, self._clean.usable):
            return "wrong"
        used = data.usable
        if all(
            np.array_equal(getattr(data, key)[used], getattr(self._clean, key)[used])
            for key in ("values", "noise")
        ):
            return "unharmed"
        steps = np.abs(data.values - self._clean.values)[used] / self._clean.noise[used]
        return "another reading" if steps.max() < MOST_UNSEEN else "wrong"


def counts(folder: Path, name: str, count: int, head: int | None = None) -> tuple[Counter[str], Counter[str]]:
    """Outcomes of flipped and replaced bytes, and of cut ends; of the first ``head`` bytes alone where given."""
    trial = Trial(folder, name)
    flipped: Counter[str] = Counter()
    cut: Counter[str] = Counter()
    for damage in damages(trial.whole, count, seed=15, head=head):
        (cut if damage.cut else flipped)[trial.outcome(damage)] += 1
    return flipped, cut


def some(name: str) -> int:
    """Damages that a unit test tries."""
    return SOME_HDF5 if name.endswith(".h5") else SOME


def many(name: str) -> int:
    """Damages that a slow test tries."""
    return MANY_HDF5 if name.endswith(".h5") else MANY


def assert_safe(flipped: Counter[str], cut: Counter[str]) -> None:
    """A changed digit may pass as another reading; nothing else may, and a cut never."""
    assert set(flipped) <= {"refused", "reported", "unharmed", "another reading"}
    assert set(cut) <= {"refused", "reported", "unharmed", "shorter"}


@pytest.mark.parametrize("name", SETS)
def test_a_damaged_file_is_refused_or_reported(tmp_path: Path, name: str) -> None:
    assert_safe(*counts(tmp_path, name, some(name)))


@pytest.mark.slow
@pytest.mark.parametrize("name", SETS)
def test_many_damaged_files_are_refused_or_reported(tmp_path: Path, name: str) -> None:
    with bounded_memory():
        flipped, cut = counts(tmp_path, name, many(name))
    print(f"\n{name}: flipped {dict(flipped)}, cut {dict(cut)}")
    assert_safe(flipped, cut)


@pytest.mark.parametrize("name", BINARY)
def test_a_damaged_header_is_refused_or_reported(tmp_path: Path, name: str) -> None:
    flipped, cut = counts(tmp_path, name, some(name), HEAD)
    assert_safe(flipped, cut)
    assert set(cut) == {"refused"}


@pytest.mark.slow
@pytest.mark.parametrize("name", BINARY)
def test_many_damaged_headers_are_refused_or_reported(tmp_path: Path, name: str) -> None:
    with bounded_memory():
        flipped, cut = counts(tmp_path, name, many(name), HEAD)
    print(f"\n{name}, first {HEAD} bytes: flipped {dict(flipped)}, cut {dict(cut)}")
    assert_safe(flipped, cut)


@contextmanager
def bounded_memory(growth_MB: float = 400.0) -> Iterator[None]:
    """The largest memory of the process does not grow by more."""
    resource = pytest.importorskip("resource")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024.0 < growth_MB

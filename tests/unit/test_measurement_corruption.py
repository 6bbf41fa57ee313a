"""Damaged measurement sets: refused with the file named, reported as a finding, or unharmed; never a crash."""

import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.errors import MeasurementError
from rigdesign.measurement import Data, features, load_measurement
from tests.corruption_example import Damage, damages
from tests.measurement_example import write_set
from tests.recording_example import write_recorded_set

CASES = Path(__file__).parents[2] / "cases"
SOME = 24
MANY = 400
LONGEST = 5.0
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
        """What becomes of the set: refused, reported, unharmed, silent, or the name of an exception."""
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
        return found if data is None else self._against_clean(data)

    def _read(self) -> Data:
        return features(load_measurement(self._folder, self._case))

    def _named(self, message: str) -> bool:
        return self._file.name in message or "measurement.toml" in message

    def _against_clean(self, data: Data) -> str:
        if {one.text for one in data.findings} - {one.text for one in self._clean.findings}:
            return "reported"
        same = data.features == self._clean.features and all(
            np.array_equal(getattr(data, key), getattr(self._clean, key), equal_nan=True)
            for key in ("values", "noise", "usable")
        )
        return "unharmed" if same else "silent"


def counts(folder: Path, name: str, count: int) -> tuple[Counter[str], Counter[str]]:
    """Outcomes of flipped and replaced bytes, and of cut ends."""
    trial = Trial(folder, name)
    flipped: Counter[str] = Counter()
    cut: Counter[str] = Counter()
    for damage in damages(trial.whole, count, seed=15):
        (cut if damage.cut else flipped)[trial.outcome(damage)] += 1
    return flipped, cut


def assert_safe(flipped: Counter[str], cut: Counter[str]) -> None:
    """A changed digit may pass as another reading; nothing else may, and a cut never."""
    assert set(flipped) <= {"refused", "reported", "unharmed", "silent"}
    assert set(cut) <= {"refused", "reported", "unharmed"}


@pytest.mark.parametrize("name", SETS)
def test_a_damaged_file_is_refused_or_reported(tmp_path: Path, name: str) -> None:
    assert_safe(*counts(tmp_path, name, SOME))


@pytest.mark.slow
@pytest.mark.parametrize("name", SETS)
def test_many_damaged_files_are_refused_or_reported(tmp_path: Path, name: str) -> None:
    with bounded_memory():
        flipped, cut = counts(tmp_path, name, MANY)
    print(f"\n{name}: flipped {dict(flipped)}, cut {dict(cut)}")
    assert_safe(flipped, cut)


@contextmanager
def bounded_memory(growth_MB: float = 400.0) -> Iterator[None]:
    """The largest memory of the process does not grow by more."""
    resource = pytest.importorskip("resource")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024.0 < growth_MB

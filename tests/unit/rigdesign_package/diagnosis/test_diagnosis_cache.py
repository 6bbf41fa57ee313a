"""Libraries on disk: damage is recognised, set aside and told once; what is whole is used again."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from rigdesign.diagnosis.library import cache
from rigdesign.diagnosis.library.cache import Parts, library_of, stored_library
from rigdesign.diagnosis.library.library import Library
from rigdesign.prediction import OWN_MODEL, TORSIONAL
from tests.builders.corruption import damages
from tests.builders.diagnosis import story, the_case

SOME = 30
MANY = 600


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path))
    return tmp_path


def library() -> Library:
    return story("mesh loss").problem.baseline.library


class Rig:
    """Asks for the library of a rig, counts how often it is built and keeps what is said."""

    def __init__(self) -> None:
        self.library = library()
        self.built = 0
        self.said: list[str] = []

    def __call__(self) -> Library:
        return library_of(
            the_case(), self.library.settings, self.library.channels, (), self._build, self.said.append
        )

    def _build(self) -> Library:
        self.built += 1
        return self.library


def the_file(folder: Path) -> Path:
    (file,) = folder.rglob("*.pickle")
    return file


def test_a_whole_library_is_used_again(folder: Path) -> None:
    rig = Rig()
    first, second = rig(), rig()
    assert rig.built == 1 and not rig.said
    np.testing.assert_array_equal(first.base, second.base)


def counted(folder: Path, count: int) -> dict[str, int]:
    """What becomes of damaged libraries: built again and told, or not."""
    rig = Rig()
    rig()
    file = the_file(folder)
    whole, name = file.read_bytes(), file.name
    outcomes = {"built again, told once": 0, "accepted": 0, "crash": 0, "other": 0}
    for damage in damages(whole, count, seed=15):
        for left in folder.rglob("*.pickle*"):
            left.unlink()
        (file.parent / name).write_bytes(damage.content)
        rig.built, rig.said = 0, []
        try:
            rig(), rig()
        except Exception:  # counted, whatever it is
            outcomes["crash"] += 1
            continue
        aside = list(folder.rglob("*.damaged"))
        reported = rig.built == 1 and len(rig.said) == 1 and name in rig.said[0] and len(aside) == 1
        outcomes["built again, told once" if reported else "accepted" if not rig.built else "other"] += 1
    return outcomes


def test_damage_is_recognised_set_aside_and_told_once(folder: Path) -> None:
    outcomes = counted(folder, SOME)
    assert outcomes == {"built again, told once": SOME, "accepted": 0, "crash": 0, "other": 0}


@pytest.mark.slow
def test_damage_of_many_kinds_is_recognised(folder: Path) -> None:
    outcomes = counted(folder, MANY)
    print(outcomes)
    assert outcomes == {"built again, told once": MANY, "accepted": 0, "crash": 0, "other": 0}


def test_what_is_no_file_or_no_library_is_set_aside(folder: Path) -> None:
    rig = Rig()
    rig()
    home = the_file(folder).parent
    (home / "folder.pickle").mkdir()
    said: list[str] = []
    for _ in range(2):
        found = stored_library(the_case(), rig.library.settings, rig.library.channels, (), said.append)
        assert found is not None
    assert len(said) == 1 and "folder.pickle" in said[0]
    the_file(folder).unlink()
    Parts(home).keep({"an effect": None})
    rig()
    assert rig.built == 2 and len(rig.said) == 1


def test_a_damaged_part_is_computed_again(tmp_path: Path) -> None:
    parts = Parts(tmp_path / "parts")
    parts.keep({"first": None})
    parts.keep({"second": None})
    assert set(parts.known()) == {"first", "second"}
    file = min((tmp_path / "parts").glob("*.pickle"))
    lost = set(pickle.loads(file.read_bytes()))
    file.write_bytes(file.read_bytes()[:-1])
    said: list[str] = []
    assert set(parts.known(said.append)) == {"first", "second"} - lost
    assert set(parts.known(said.append)) == {"first", "second"} - lost and len(said) == 1


def test_nothing_is_left_where_a_library_cannot_be_stored(folder: Path, monkeypatch) -> None:
    def full(self: Path, target: Path) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    rig = Rig()
    assert rig().channels and rig.built == 1
    assert not [left for left in folder.rglob("*") if left.is_file()]


def test_what_another_model_of_the_circuit_made_is_another_library(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = Rig()
    rig()
    monkeypatch.setattr(cache, "measured_against", lambda channels: TORSIONAL)
    rig()
    assert rig.built == 2
    plan = the_case(), rig.library.settings, rig.library.channels, ()
    assert Parts.of(*plan, TORSIONAL).folder != Parts.of(*plan, OWN_MODEL).folder

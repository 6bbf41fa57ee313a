"""Libraries on disk: damage is recognised, set aside and told once; what is whole is used again."""

import io
import os
import pickle
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from rigdesign.diagnosis.library import cache
from rigdesign.diagnosis.library.cache import Parts, library_of
from rigdesign.diagnosis.library.library import Library
from rigdesign.prediction import OWN_MODEL, TORSIONAL
from rigdesign.rig import tooth_influence as influence_store
from rigdesign.rig.tooth_influence import InfluenceStore
from tests.builders.corruption import damages
from tests.builders.diagnosis import story, the_case
from tests.builders.influence import invented_numbers, small_model

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
    (file,) = folder.rglob("*.npz")
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
        for left in folder.rglob("*.npz*"):
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


def test_a_library_of_another_kind_is_not_used(folder: Path) -> None:
    rig = Rig()
    rig()
    home = the_file(folder).parent
    (home / "folder.npz").mkdir()
    rig()
    assert rig.built == 1 and not rig.said
    next(file for file in home.glob("*.npz") if file.is_file()).unlink()
    Parts(home).keep({"an effect": None})
    rig()
    assert rig.built == 2 and not rig.said


class Planted:
    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (Path(os.environ["RIGDESIGN_CACHE_DIR"]) / "code of others ran",)


@pytest.mark.parametrize("form", ["pickle", "archive"])
def test_nothing_in_a_shared_cache_is_run(form: str, folder: Path) -> None:
    """A file named after its own content, whose content names a function to call."""
    rig = Rig()
    rig()
    stream = io.BytesIO()
    if form == "pickle":
        pickle.dump(Planted(), stream)
    else:
        np.savez(stream, allow_pickle=True, index=np.array([Planted()], dtype=object))
    content = stream.getvalue()
    the_file(folder).with_name(cache._name(content)).write_bytes(content)
    rig()
    assert len(rig.said) == 1 and "is damaged" in rig.said[0]
    assert not (folder / "code of others ran").exists()


def test_a_stored_library_is_the_one_that_was_built(folder: Path) -> None:
    """To the last bit: numbers, names and orders."""
    again = cache._unpacked(cache._packed(library()))
    assert isinstance(again, Library)
    for field in fields(Library):
        first, second = getattr(library(), field.name), getattr(again, field.name)
        if field.name == "responses":
            assert list(first) == list(second)
            for name in first:
                np.testing.assert_array_equal(first[name].coordinates, second[name].coordinates)
                np.testing.assert_array_equal(first[name].answers, second[name].answers)
        else:
            np.testing.assert_equal(second, first)


def test_those_who_share_a_cache_can_read_it(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(influence_store, "influence_numbers", lambda model: invented_numbers(seed=1))
    before = os.umask(0o022)
    try:
        rig = Rig()
        rig()
        InfluenceStore(folder).numbers(small_model())
    finally:
        os.umask(before)
    files = [file for file in folder.rglob("*") if file.is_file()]
    assert len(files) == 2 and {file.stat().st_mode & 0o777 for file in files} == {0o644}

    def forbidden(file: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(file))

    monkeypatch.setattr(Path, "read_bytes", forbidden)
    rig()
    InfluenceStore(folder).stored(small_model(), rig.said.append)
    assert [("cannot be read (Permission denied)" in said, "damaged" in said) for said in rig.said] == [
        (True, False)
    ] * 2
    assert not list(folder.rglob("*.damaged"))


def test_a_damaged_part_is_computed_again(tmp_path: Path) -> None:
    parts = Parts(tmp_path / "parts")
    parts.keep({"first": None})
    parts.keep({"second": None})
    assert set(parts.known()) == {"first", "second"}
    file = min((tmp_path / "parts").glob("*.npz"))
    lost = set(cache._unpacked(file.read_bytes()))
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

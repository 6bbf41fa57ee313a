"""Influence numbers on disk: built once per cold gear, rebuilt from anything that is not whole."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dynamics.tooth.influence_numbers import GearBody
from rigdesign.base import parallel
from rigdesign.base.output_folder import FileLock
from rigdesign.rig import tooth_influence as influence_store
from rigdesign.rig.tooth_influence import InfluenceStore, ToothInfluence, gear_model, identity
from tests.builders.influence import invented_numbers, small_model
from tests.builders.p2_gears import ALLOWANCES, helical_pair, spur_pair

MODEL = small_model()
WHEEL = small_model(body=GearBody(bore_radius=16e-3))


@pytest.fixture
def built(monkeypatch):
    """Models that were built, in turn; the numbers are invented, another set for every build."""
    models = []

    def build(model):
        models.append(model)
        return invented_numbers(seed=len(models))

    monkeypatch.setattr(influence_store, "influence_numbers", build)
    return models


def same(first, second):
    blocks = [
        (first.profile, second.profile), (first.face, second.face), (first.axis_depth, second.axis_depth),
        (first.local_excess, second.local_excess), (first.body, second.body),
        *((getattr(first.fillet, name), getattr(second.fillet, name)) for name in ("point", "arc", "tangent")),
        *((first.deflection[k], second.deflection[k]) for k in first.deflection),
        *((first.stress[k], second.stress[k]) for k in first.stress),
    ]  # fmt: skip
    assert sorted(first.deflection) == sorted(second.deflection)
    assert sorted(first.stress) == sorted(second.stress)
    assert (first.asymmetry, first.n_nodes) == (second.asymmetry, second.n_nodes)
    return all(np.array_equal(one, other) for one, other in blocks)


def test_second_call_reads_what_the_first_stored(tmp_path: Path, built):
    said: list[str] = []
    first = InfluenceStore(tmp_path).numbers(MODEL, said.append)
    assert len(said) == 1 and "28 teeth, module 4 mm" in said[0]
    again = InfluenceStore(tmp_path).numbers(MODEL, said.append)
    assert len(built) == 1 and len(said) == 1
    assert same(first, again)
    assert [file.suffix for file in tmp_path.iterdir()] == [".influence"]


def test_a_gear_that_another_process_computes_is_waited_for(tmp_path: Path, built, monkeypatch):
    """The other one stores its numbers while this one waits; nothing is computed twice, and no lock is left."""
    store = InfluenceStore(tmp_path)
    other = FileLock(store.file(MODEL).with_suffix(".lock"))
    assert store.in_progress(MODEL) and not store.in_progress(WHEEL)

    def other_ends(_: float) -> None:
        influence_store._write(store.file(MODEL), identity(MODEL), invented_numbers(seed=7))
        other.release()

    monkeypatch.setattr(influence_store.time, "sleep", other_ends)
    assert same(store.compute(MODEL), invented_numbers(seed=7))
    assert built == [] and not store.in_progress(MODEL)
    assert [file.suffix for file in tmp_path.iterdir()] == [".influence"]


def test_a_lock_file_of_a_killed_process_holds_up_nobody(tmp_path: Path, built):
    store = InfluenceStore(tmp_path)
    store.file(MODEL).with_suffix(".lock").write_text('{"host": "gone", "pid": 1, "since": ""}')
    assert not store.in_progress(MODEL)
    store.compute(MODEL)
    assert built == [MODEL]


def test_gears_that_another_process_computes_come_last(tmp_path: Path, built, monkeypatch):
    monkeypatch.setattr(parallel, "cores", lambda: 1)
    influence = ToothInfluence(InfluenceStore(tmp_path))
    pinion = gear_model(helical_pair(), 0)
    lock = influence.store.file(pinion).with_suffix(".lock")
    other = FileLock(lock)
    monkeypatch.setattr(influence_store.time, "sleep", lambda _: other.release())
    influence.prepare([helical_pair()])
    assert built == [gear_model(helical_pair(), 1), pinion]


def test_another_gear_is_built_for_itself(tmp_path: Path, built):
    store = InfluenceStore(tmp_path)
    store.numbers(MODEL)
    for other in (
        WHEEL,
        replace(MODEL, face_width=20.001e-3),
        replace(MODEL, material=replace(MODEL.material, poisson=0.29)),
        replace(MODEL, form=replace(MODEL.form, protuberance=1e-5)),
    ):
        store.numbers(other)
        assert built[-1] == other
    assert len(built) == 5


def test_numbers_of_numpy_give_the_same_identity():
    numpy_made = replace(MODEL, face_width=np.float64(20e-3), n_face=np.int64(4))
    assert identity(numpy_made) == identity(MODEL)


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: content[:-1],
        lambda content: content[: len(content) // 2],
        lambda content: b"",
        lambda content: b"not an archive",
        lambda content: content + b"x",
        lambda content: (
            content[:64].swapcase() + content[64:] if content[:64].swapcase() != content[:64] else b"0"
        ),
        lambda content: content.replace(b"profile", b"profilf"),
    ],
    ids=["end", "half", "empty", "foreign", "longer", "hash", "name"],
)
def test_damaged_file_is_rebuilt_and_said(tmp_path: Path, built, damage):
    store, said = InfluenceStore(tmp_path), []
    store.numbers(MODEL)
    file = store.file(MODEL)
    file.write_bytes(damage(file.read_bytes()))
    found = store.numbers(MODEL, said.append)
    assert len(built) == 2
    assert "damaged or of another gear" in said[0] and str(file) in said[0]
    assert same(found, invented_numbers(seed=2))
    assert same(store.numbers(MODEL), found) and len(built) == 2


def test_no_flipped_bit_is_trusted(tmp_path: Path, built):
    store = InfluenceStore(tmp_path)
    store.numbers(MODEL)
    file = store.file(MODEL)
    whole = file.read_bytes()
    rng = np.random.default_rng(1)
    places = [
        *range(200),
        *rng.integers(0, len(whole), 200).tolist(),
        *range(len(whole) - 100, len(whole)),
    ]
    for place in places:
        content = bytearray(whole)
        content[place] ^= 1 << int(rng.integers(8))
        file.write_bytes(bytes(content))
        assert store.stored(MODEL) is None


def test_edited_numbers_are_not_trusted(tmp_path: Path, built):
    """A whole archive with one number changed, under the old hash."""
    store = InfluenceStore(tmp_path)
    store.numbers(MODEL)
    file = store.file(MODEL)
    edited = replace(invented_numbers(seed=1), asymmetry=0.04)
    influence_store._write(tmp_path / "other", identity(MODEL), edited)
    file.write_bytes(file.read_bytes()[:64] + (tmp_path / "other").read_bytes()[64:])
    store.numbers(MODEL)
    assert len(built) == 2


def test_file_of_another_gear_is_rebuilt(tmp_path: Path, built):
    store = InfluenceStore(tmp_path)
    store.numbers(MODEL)
    store.numbers(WHEEL)
    store.file(WHEEL).replace(store.file(MODEL))
    store.numbers(MODEL)
    assert len(built) == 3


def test_numbers_of_an_older_schema_are_not_found(tmp_path: Path, built, monkeypatch):
    store = InfluenceStore(tmp_path)
    store.numbers(MODEL)
    monkeypatch.setattr(influence_store, "SCHEMA", influence_store.SCHEMA + 1)
    store.numbers(MODEL)
    assert len(built) == 2


def test_folder_that_cannot_be_written_costs_time_only(tmp_path: Path, built):
    (tmp_path / "file").write_text("in the way")
    store = InfluenceStore(tmp_path / "file" / "influence")
    assert same(store.numbers(MODEL), invented_numbers(seed=1))
    store.numbers(MODEL)
    assert len(built) == 2


def test_folder_in_place_of_a_file_costs_time_only(tmp_path: Path, built):
    store, said = InfluenceStore(tmp_path), []
    store.file(MODEL).mkdir()
    assert same(store.numbers(MODEL, said.append), invented_numbers(seed=1))
    assert "cannot be read" in said[0]
    assert [entry.name for entry in tmp_path.iterdir()] == [store.file(MODEL).name]


def test_write_that_breaks_off_leaves_nothing(tmp_path: Path, built, monkeypatch):
    def full(self, target):
        raise OSError("no space left on device")

    monkeypatch.setattr(Path, "replace", full)
    InfluenceStore(tmp_path).numbers(MODEL)
    assert list(tmp_path.iterdir()) == []


def test_default_folder_follows_the_environment(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path))
    assert InfluenceStore.default().folder == tmp_path / "influence"


def test_ten_oil_temperatures_build_the_cold_gears_once(tmp_path: Path, built):
    """Expansion of gears and housing enters as gap and centre distance, not as another gear."""
    cold = spur_pair(thickness_allowances=ALLOWANCES["thickness_allowances"])
    for oil in np.linspace(313.15, 433.15, 10).tolist():
        centre_distance = cold.centre_distance * (1.0 + 11.5e-6 * (oil - 293.15))
        warm = cold.warm(oil + 30.0, oil + 25.0, centre_distance, speed=1200.0)
        influence = ToothInfluence(store=InfluenceStore(tmp_path))
        _, wheel = influence.of_pair(warm)
        assert same(influence.of_pair(cold)[1], wheel)
    assert len(built) == 2
    assert [model.form.gear.teeth for model in built] == [99, 102]
    assert built == [gear_model(cold, 0), gear_model(cold, 1)]


def test_pinion_counts_the_face_from_its_other_end(tmp_path: Path, built):
    influence = ToothInfluence(store=InfluenceStore(tmp_path))
    pinion, wheel = influence.of_pair(helical_pair())
    assert same(pinion, invented_numbers(seed=1).reversed_face())
    assert same(wheel, invented_numbers(seed=2))
    first, _ = influence.compliances(helical_pair())
    assert np.array_equal(first.deflection[0], pinion.deflection[0])
    assert first.axis_depth == pytest.approx(pinion.axis_depth / np.cos(helical_pair().base_helix_angle))
    assert len(built) == 2


def test_gear_of_one_piece_with_its_shaft_is_held_at_half_its_root():
    pair = spur_pair()
    assert gear_model(pair, 0).body.bore_radius == pytest.approx(0.5 * gear_model(pair, 0).form.root_radius)
    bored = spur_pair(bore_diameters=(52e-3, 0.0))
    assert gear_model(bored, 0).body.bore_radius == pytest.approx(26e-3)


def test_gears_are_prepared_once_and_kept_without_a_folder(tmp_path: Path, built, monkeypatch):
    """A folder that cannot be written: what was prepared is used all the same."""
    monkeypatch.setattr(parallel, "cores", lambda: 1)
    (tmp_path / "file").write_text("in the way")
    influence, said = ToothInfluence(store=InfluenceStore(tmp_path / "file" / "influence")), []
    influence.prepare([spur_pair()], said.append)
    assert "not yet known: 2" in said[0] and len(built) == 2
    assert [line.split(",")[0] for line in said[1:]] == ["1 of 2 gears", "2 of 2 gears"]
    influence.prepare([spur_pair()], said.append)
    influence.of_pair(spur_pair())
    assert len(said) == 3 and len(built) == 2


def test_every_gear_that_is_done_is_counted(tmp_path: Path, built):
    """Minutes in which a bar moves; before, one line stood there until all gears were done."""
    counts = []
    ToothInfluence(store=InfluenceStore(tmp_path)).prepare(
        [helical_pair()], count=lambda *told: counts.append(told)
    )
    assert [count[:2] for count in counts] == [(0, 2), (1, 2), (2, 2)]
    assert counts[2][2].startswith(f"the gear with {gear_model(helical_pair(), 1).form.gear.teeth} teeth")


def test_a_damaged_file_is_told_and_prepared_again(tmp_path: Path, built, monkeypatch):
    monkeypatch.setattr(parallel, "cores", lambda: 1)
    ToothInfluence(store=InfluenceStore(tmp_path)).prepare([spur_pair()])
    file = InfluenceStore(tmp_path).file(gear_model(spur_pair(), 0))
    file.write_bytes(file.read_bytes()[:-9])
    said = []
    ToothInfluence(store=InfluenceStore(tmp_path)).prepare([spur_pair()], said.append)
    assert "damaged" in said[0] and "not yet known: 1" in said[1] and len(built) == 3


def test_a_wider_gear_takes_numbers_over_where_it_may(tmp_path: Path, built):
    """As slices: half the force per width on twice the width, half the deflection per force."""
    pair = spur_pair()
    influence = ToothInfluence(store=InfluenceStore(tmp_path))
    narrow = influence.numbers(gear_model(pair, 0))
    wider = replace(gear_model(pair, 0), face_width=2.0 * gear_model(pair, 0).face_width)
    near = influence.for_widths_near([pair])
    found = near.numbers(wider)
    assert len(built) == 1
    assert found.face[-1] - found.face[0] == pytest.approx(wider.face_width)
    factor = wider.face_width / (narrow.face[-1] - narrow.face[0])
    assert np.allclose(found.deflection[1], narrow.deflection[1] / factor)
    assert same(near.numbers(gear_model(pair, 0)), narrow)

"""Patches of a diagnosis: they hold what was reported, the patched case loads, the user's files stay."""

import json
from copy import deepcopy
from math import cos, hypot, sin
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.case.source import read_tree
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.patch import Fitted, case_patch, patched_title, patched_values, variant_text
from rigdesign.diagnosis.document.document import diagnosis_document
from rigdesign.diagnosis.document.outcome import outcome
from rigdesign.prediction.model import changed_case
from rigdesign.report.diagnosis_files import write_diagnosis
from tests.builders.diagnosis import CASE, story, the_case

CASES = CASE.parent


def applied(tree: Any, operations: list[dict[str, Any]]) -> dict[str, Any]:
    """The tree after a JSON Patch, by the letter of RFC 6902: parents have to exist, replaced values too."""
    found = deepcopy(plain(tree))
    for operation in operations:
        *parents, last = [
            part.replace("~1", "/").replace("~0", "~") for part in operation["path"].split("/")[1:]
        ]
        node = found
        for key in parents:
            node = node[key]
        assert operation["op"] == "add" or last in node
        if "was" in operation:
            assert plain(node[last]) == operation["was"]
        node[last] = operation["value"]
    return found


def plain(node: Any) -> Any:
    """Tables and lists as JSON has them."""
    if isinstance(node, dict | MappingProxyType):
        return {key: plain(item) for key, item in node.items()}
    return [plain(item) for item in node] if isinstance(node, list | tuple) else node


def effect_of(name: str, case=None):
    return next(effect for effect in effects_of(case or the_case()) if effect.name == name)


def test_the_patched_case_holds_exactly_what_is_reported(tmp_path: Path) -> None:
    write_diagnosis(outcome(story("mesh loss")), tmp_path)
    document = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))
    (parameter,) = document["named"][0]["parameters"]
    patched = load_case(tmp_path / "patched")
    assert patched.gearboxes["test"].loss_factors.mesh == parameter["value"]
    assert the_case().gearboxes["test"].loss_factors.mesh == 1.0
    mark = next(mark for mark in patched._origin.marks if mark.path == "gearboxes.test.loss_factors.mesh")
    assert mark.range == tuple(parameter["interval_95"])
    assert mark.assumed is not None and story("mesh loss").measurement.hash[:16] in mark.assumed


def test_a_patched_run_out_is_the_reported_harmonic(tmp_path: Path) -> None:
    write_diagnosis(outcome(story("run-out")), tmp_path)
    document = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))
    values = {one["name"]: one["value"] for one in document["named"][0]["parameters"]}
    flank = load_case(tmp_path / "patched").gearboxes["reference"].gears["pinion"].flank
    assert 0.5 * flank.run_out * cos(flank.run_out_phase) == pytest.approx(
        values["eccentricity along cosine"], rel=1e-12
    )
    assert 0.5 * flank.run_out * sin(flank.run_out_phase) == pytest.approx(
        values["eccentricity along sine"], rel=1e-12
    )
    assert flank.run_out == pytest.approx(values["run-out F_r"], rel=1e-5)


def test_a_patched_tooth_is_the_reported_one(tmp_path: Path) -> None:
    write_diagnosis(outcome(story("tooth")), tmp_path)
    document = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))
    (deviation,) = document["named"][0]["parameters"]
    pitch = load_case(tmp_path / "patched").gearboxes["test"].gears["pinion"].flank.single_pitch
    expected = [0.0] * 28
    expected[5], expected[6] = deviation["value"], -deviation["value"]
    assert pitch == tuple(expected)


@pytest.mark.parametrize("name", ["mesh loss", "run-out", "tooth"])
def test_the_json_patch_makes_the_tree_of_the_variant(name: str, tmp_path: Path) -> None:
    write_diagnosis(outcome(story(name)), tmp_path)
    operations = json.loads((tmp_path / "case.patch.json").read_text(encoding="utf-8"))
    assert any(operation.get("provenance") == "fitted" for operation in operations)
    tree = applied(the_case().origin.tree, operations)
    assert tree == plain(read_tree(tmp_path / "patched" / "case.toml"))


def test_a_patch_can_be_taken_back() -> None:
    case = the_case()
    fitted = [Fitted(effect=effect_of("coupling_stiffness:wheel_side"), values=(1.3,), ends=((1.1, 1.5),))]
    operations = case_patch(case, patched_title(case, fitted), patched_values(case, fitted))
    tree = applied(case.origin.tree, operations)
    assert tree != plain(case.origin.tree)
    for operation in reversed(operations):
        *parents, last = operation["path"].split("/")[1:]
        node = tree
        for key in parents:
            node = node[key]
        if "was" in operation:
            node[last] = plain(operation["was"])
        else:
            del node[last]
    assert tree == plain(case.origin.tree)


@pytest.mark.parametrize("folder", ["loop_1to1", "uhcf_prototype"])
def test_every_effect_of_the_catalogue_survives_the_way_through_a_file(folder: str, tmp_path: Path) -> None:
    """One variant with an effect of every kind; every value is found again in the loaded case."""
    case = load_case(CASES / folder)
    kinds: dict[str, Fitted] = {}
    for effect in effects_of(case):
        values = tuple(round(p.value(0.2 * p.bounds[1]), 9) for p in effect.parameters)
        tooth = 3 if effect.any_tooth else None
        ends = tuple((value - 0.1 * abs(value), value + 0.1 * abs(value)) for value in values)
        kinds.setdefault(
            effect.kind, Fitted(effect=effect, values=values, ends=ends, tooth=tooth, reason='"quoted"')
        )
    fitted = list(kinds.values())
    found = patched_values(case, fitted)
    (tmp_path / "case.toml").write_text(variant_text(case, "all", found, tmp_path), encoding="utf-8")
    loaded = load_case(tmp_path / "case.toml")
    expected = case
    for one in fitted:
        expected = changed_case(expected, one.changes(expected))
    assert loaded.model_dump(exclude={"title"}) == expected.model_dump(exclude={"title"})
    marked = {mark.path for mark in loaded._origin.marks if mark.assumed == '"quoted"'}
    assert marked == set(found)


def test_intervals_become_ranges_of_numbers_only() -> None:
    case = the_case()
    loss = Fitted(effect=effect_of("mesh_loss:test"), values=(1.2,), ends=((1.1, 1.3),))
    assert loss.ranges(case) == {"gearboxes.test.loss_factors.mesh": (1.1, 1.3)}
    stiffness = Fitted(effect=effect_of("coupling_stiffness:wheel_side"), values=(1.2,), ends=((1.1, 1.3),))
    values = patched_values(case, [stiffness])["drivetrain.couplings.wheel_side.torsional_stiffness"]
    low, high = (float(text.split()[0]) for text in values["range"])
    assert low < float(values["value"].split()[0]) < high
    harmonic = Fitted(
        effect=effect_of("run_out:test.pinion"), values=(1e-5, 0.0), ends=((0.0, 2e-5), (0.0, 1e-6))
    )
    assert harmonic.ranges(case) == {}


def test_two_effects_on_one_gear_add_up() -> None:
    case = the_case()
    fitted = [
        Fitted(effect=effect_of("cumulative_pitch:test.pinion/2"), values=(3e-6, 4e-6)),
        Fitted(effect=effect_of("cumulative_pitch:test.pinion/3"), values=(1e-6, 0.0)),
    ]
    (value,) = patched_values(case, fitted).values()
    assert [wave["order"] for wave in value["value"]] == [2, 3]
    assert float(value["value"][0]["amplitude"].split()[0]) == pytest.approx(hypot(3e-6, 4e-6))


def test_a_value_the_case_does_not_admit_is_refused() -> None:
    with pytest.raises(CaseError):
        patched_values(the_case(), [Fitted(effect=effect_of("bypass:test"), values=(7.0,))])


def test_a_mesh_file_is_found_from_the_folder_of_the_variant(tmp_path: Path) -> None:
    case = load_case(CASES / "uhcf_prototype")
    housing = case.gearboxes["test"].housing
    assert housing is not None
    box = case.gearboxes["test"].model_copy(
        update={"housing": housing.model_copy(update={"mesh_file": "parts/box.msh"})}
    )
    other = case.model_copy(update={"gearboxes": {**case.gearboxes, "test": box}})
    other._origin = case._origin
    text = variant_text(other, "t", {}, tmp_path)
    line = next(line for line in text.splitlines() if line.startswith("mesh_file"))
    written = tmp_path / line.split('"')[1]
    assert written.resolve() == (CASES / "uhcf_prototype" / "parts" / "box.msh").resolve()


def test_the_users_files_are_not_written_to(tmp_path: Path) -> None:
    result = story("mesh loss")
    watched = [CASE / "case.toml", *(path for path in result.measurement.folder.iterdir() if path.is_file())]
    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in watched}
    write_diagnosis(outcome(result), tmp_path / "out")
    assert {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in watched} == before


def test_a_later_refusal_takes_the_earlier_patch_away(tmp_path: Path) -> None:
    write_diagnosis(outcome(story("mesh loss")), tmp_path)
    assert (tmp_path / "patched" / "case.toml").is_file()
    write_diagnosis(outcome(story("alias")), tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["diagnosis.html", "diagnosis.json"]


def test_a_pick_is_patched_and_marked_as_the_users(tmp_path: Path) -> None:
    reported = outcome(story("alias"), pick="run_out:test.wheel")
    write_diagnosis(reported, tmp_path)
    flank = load_case(tmp_path / "patched").gearboxes["test"].gears["wheel"].flank
    assert reported.picked is not None
    assert 0.5 * flank.run_out == pytest.approx(hypot(*reported.picked.values))
    assert "picked by the user" in (tmp_path / "case.patch.json").read_text(encoding="utf-8")
    assert diagnosis_document(reported)["verdict"] == "alias_group"

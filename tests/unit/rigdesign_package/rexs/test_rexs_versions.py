from dataclasses import replace

import pytest

from rigdesign.rexs.gear_unit_import import import_gear_unit
from rigdesign.rexs.model import Relation, Renaming, RexsModel, RoleReference, in_newest_names, is_read
from rigdesign.rexs.reader import parse_rexs, read_rexs
from tests.builders.rexs import SUFFIXES, changed, rexs_file

OLD_ONLY_LACKS = {"quality_grade": None, "flank_roughness": None}
"""What REXS 1.0 has no attribute for."""


@pytest.mark.parametrize(("version", "read"), [
    ("1.0", True), ("1.7", True), ("2.0", True), ("2.0.0", True), ("1.5.3", True), ("1.8", False), ("2.1", False),
    ("", False), ("2", False), ("1.0 ", False), ("11.0", False), ("1.0.99999", False),
])  # fmt: skip
def test_versions_that_are_read(version: str, read: bool) -> None:
    assert is_read(version) is read


def test_types_by_stage_and_gear() -> None:
    newest, renamed = in_newest_names(read_rexs(rexs_file("1.0")))
    assert [newest.component(number).type for number in (14, 16)] == [
        "cylindrical_stage_gear_data", "cylindrical_gear_flank",
    ]  # fmt: skip
    assert Renaming(14, "stage_gear_data", "cylindrical_stage_gear_data") in renamed
    assert Renaming(20, "dynamic_capacity", "radial_dynamic_load_rating") in renamed
    assert Renaming(20, "name", "catalogue_designation") in renamed
    assert Renaming(1, "load_duration_fraction", "operating_time_fraction") in renamed
    assert newest.component(28).attribute("name") is not None


@pytest.mark.parametrize(
    ("stage", "gear", "data", "flank"),
    [
        ("bevel_stage", "bevel_gear", "bevel_stage_gear_data", "bevel_gear_flank"),
        ("worm_stage", "worm_wheel", "worm_stage_gear_data", "worm_gear_flank"),
        ("planetary_stage", "ring_gear", "stage_gear_data", "cylindrical_gear_flank"),
    ],
)
def test_types_of_other_stages(stage: str, gear: str, data: str, flank: str) -> None:
    content = changed(
        ('type="cylindrical_stage"', f'type="{stage}"'), ('"cylindrical_gear"', f'"{gear}"'), version="1.0"
    )
    newest, _ = in_newest_names(parse_rexs(content, "unit"))
    assert (newest.component(14).type, newest.component(16).type) == (data, flank)


def test_data_of_no_stage_keep_their_type() -> None:
    model = read_rexs(rexs_file("1.0"))
    newest, _ = in_newest_names(replace(model, relations=()))
    assert newest.component(14).type == "stage_gear_data"
    assert newest.component(16).type == "flank_geometry"


def test_a_coupling_of_1_0_joins_its_sides() -> None:
    newest, _ = in_newest_names(read_rexs(rexs_file("1.0")))
    relation = newest.relations_of("side", "assembly", 24)[0]
    assert (relation.with_role("inner_part"), relation.with_role("outer_part")) == (3, 25)


def test_old_names_in_a_newer_file_and_both_names() -> None:
    old = ("operating_time_fraction", "load_duration_fraction")
    newest, renamed = in_newest_names(parse_rexs(changed(old), "unit"))
    assert {item.old for item in renamed} == {"load_duration_fraction"}
    both = (
        '<attribute id="radial_dynamic',
        '<attribute id="dynamic_capacity" unit="kN">1</attribute><attribute id="radial_dynamic',
    )
    newest, renamed = in_newest_names(parse_rexs(changed(both), "unit"))
    assert renamed == ()
    assert newest.component(20).attribute("radial_dynamic_load_rating").number() == 60.5  # type: ignore[union-attr]


def test_an_entry_of_an_enumeration() -> None:
    content = changed(("radial_roller_bearing", "radial_self-aligning_ball_bearing"), version="1.0")
    unit = import_gear_unit(parse_rexs(content, "unit")).unit
    assert unit.bearings[0].catalogue.type == "radial_self_aligning_ball_bearing"


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_both_versions_give_the_same_gear_unit(suffix: str) -> None:
    old, new = (import_gear_unit(read_rexs(rexs_file(version, suffix))).unit for version in ("1.0", "2.0"))
    assert old.gears == tuple(replace(gear, quality_grade=None, flank_roughness=None) for gear in new.gears)
    assert replace(old, gears=new.gears) == new


def test_ordered_relations_come_in_their_order() -> None:
    model = read_rexs(rexs_file())
    pairs = [(902, 2), (901, 1)]
    rows = [
        Relation(
            number,
            "ordered_assembly",
            (RoleReference(20, "assembly"), RoleReference(number - 896, "part")),
            order,
        )
        for number, order in pairs
    ]
    ordered: RexsModel = replace(model, relations=tuple(rows))
    assert [part.id for part in ordered.related("ordered_assembly", "assembly", 20, "part")] == [5, 6]

"""`rigdesign import`: a REXS file becomes a case that loads, every value with its source, nothing overwritten."""

import math
from pathlib import Path

import pytest

from dynamics.gear.pair import GearPair
from rigdesign.base.errors import CaseError, OutputError, RexsError, UsageError
from rigdesign.case import load_case
from rigdesign.coupling.flank_heat import dipped_gear
from rigdesign.rexs.case_tables import pinion_loads
from rigdesign.rexs.gear_unit_import import import_gear_unit
from rigdesign.rexs.reader import parse_rexs
from rigdesign.rexs.write_case import ImportedCase, import_case
from rigdesign.rig.model import build_rig
from tests.builders.commands import Rigdesign, rigdesign
from tests.builders.rexs import SUFFIXES, UnitText, archive_of, changed, rexs_file

__all__ = ["rigdesign"]
DESIGNATION = ('<attribute id="catalogue_designation">NJ 406</attribute>', "")
VISCOSITY = '<attribute id="viscosity_at_100_degree_celsius" unit="mm^2 / s">10.7</attribute>'


def of_changed(folder: Path, *changes: tuple[str, str]) -> ImportedCase:
    """Import of the example unit with replacements in its text."""
    file = folder / "unit.rexs"
    file.write_bytes(changed(*changes))
    return import_case(file, folder / "case")


@pytest.mark.parametrize("version", ["1.0", "2.0"])
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_every_encoding_becomes_the_same_case_that_loads(tmp_path: Path, version: str, suffix: str) -> None:
    result = import_case(rexs_file(version, suffix), tmp_path)
    assert result.needed == ()
    case = load_case(tmp_path)
    box, slave = case.gearboxes["test"], case.gearboxes["slave"]
    assert (box.gears["pinion"].teeth, box.gears["wheel"].teeth) == (16, 24)
    assert (box.gears["pinion"].profile_shift, box.gears["wheel"].profile_shift) == (0.182, 0.172)
    assert box.meshes["main"].centre_distance == pytest.approx(0.0915)
    assert {bearing.label for bearing in box.bearings.values()} == {"NJ 406"}
    assert [box.bearings[f"pinion_{side}"].position for side in ("front", "rear")] == [0.02, 0.115]
    assert box.sump is not None
    assert case.schedule.test_torque == pytest.approx(372.6)
    assert case.schedule.test_speed == pytest.approx(2250.0 * math.pi / 30.0)
    assert slave.gears["pinion"].face_width == box.gears["pinion"].face_width
    assert box.housing is None
    assert slave.housing is None


def test_tips_are_those_of_the_file(tmp_path: Path) -> None:
    """d_a = m (z + 2 x + 2) - 2 k of ISO 21771 gives the stated diameters back."""
    import_case(rexs_file(), tmp_path)
    for gear, tip in zip(load_case(tmp_path).gearboxes["test"].gears.values(), (82.46, 118.36), strict=True):
        assert gear.profile_shift is not None
        full = 4.5 * (gear.teeth + 2.0 * gear.profile_shift + 2.0)
        assert full - 2e3 * gear.tip_shortening == pytest.approx(tip, abs=1e-6)


def test_every_value_has_its_source_and_the_account_is_complete(tmp_path: Path) -> None:
    result = import_case(rexs_file(), tmp_path)
    marks = {mark.path: mark for mark in load_case(tmp_path).origin.marks}
    for path, entry in result.stated:
        source = marks[path].source
        assert source == entry.text
        assert source.startswith("fzg_2.0.rexs: ")
    assert (
        marks["gearboxes.test.gears.pinion.teeth"].source
        == "fzg_2.0.rexs: cylindrical_gear 11, number_of_teeth"
    )
    assert marks["gearboxes.test.oil.level"].assumed
    unit = import_gear_unit(parse_rexs(rexs_file().read_bytes(), "fzg"))
    assert len(result.mapped) + len(result.listed) == len(unit.mapped) + len(unit.listed)
    assert result.assumed[0].path == "gearboxes.slave"


def test_shafts_are_those_of_the_file(tmp_path: Path) -> None:
    import_case(rexs_file(), tmp_path)
    power = load_case(tmp_path).drivetrain
    assert power is not None
    for shaft in ("test_pinion", "slave_wheel"):
        assert [item.outer_diameter for item in power.shafts[shaft].sections] == pytest.approx(
            [0.03, 0.036, 0.03]
        )


def test_other_load_cases_stand_in_comments(tmp_path: Path) -> None:
    import_case(rexs_file(), tmp_path)
    assert (
        "# load case 2: 302 N m, 1500 rpm, 40 % of the time, oil 80 degC"
        in (tmp_path / "case.toml").read_text()
    )


@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_torque_at_the_pinion_is_the_same_power_from_either_side(side: str) -> None:
    """372.6 N m at 2250 rpm on the pinion are 558.9 N m at 1500 rpm on the wheel."""
    unit = import_gear_unit(parse_rexs(rexs_file().read_bytes(), "fzg")).unit
    if side == "wheel":
        from dataclasses import replace

        case = unit.operating_cases[0]
        load = replace(case.loads[0], shaft=4, torque=-372.6 * 1.5)
        case = replace(case, speeds={4: -1500.0 * math.pi / 30.0}, loads=(load,))
        unit = replace(unit, operating_cases=(case,))
    first = pinion_loads(unit, unit.meshes[:1])[0]
    assert first.torque == pytest.approx(372.6)
    assert first.speed == pytest.approx(2250.0 * math.pi / 30.0)


def test_what_is_needed_is_a_comment_with_an_example_that_loads(tmp_path: Path) -> None:
    result = of_changed(tmp_path, (VISCOSITY, ""))
    assert len(result.needed) == 1
    assert result.needed[0].startswith("gearboxes.test.oil.oil, e.g.")
    path = tmp_path / "case/case.toml"
    with pytest.raises(CaseError, match=r"gearboxes\.test\.oil\.oil"):
        load_case(path)
    path.write_text(path.read_text().replace('# oil = "FVA 3A"', 'oil = "FVA 3A"'))
    assert load_case(path).gearboxes["test"].sump is not None


def test_a_bearing_that_is_not_tabled_keeps_its_own_numbers(tmp_path: Path) -> None:
    result = of_changed(tmp_path, (">NJ 406<", ">NJ 9999<"))
    assert result.needed == ()
    bearing = load_case(tmp_path / "case").gearboxes["test"].bearings["pinion_front"]
    assert bearing.type == "rolling"
    assert (bearing.data.dynamic_rating, bearing.data.static_rating) == (60500.0, 53000.0)
    assert bearing.data.bore < bearing.data.inner_raceway < bearing.data.outer_raceway
    speeds = [item for item in result.assumed if item.path.endswith("pinion_front.catalogue.limiting_speed")]
    assert len(speeds) == 1


def test_one_bearing_holds_a_shaft_that_the_file_leaves_free(tmp_path: Path) -> None:
    """No bearing of the file takes up axial force: of each shaft the rear one is taken to, as an assumption."""
    result = of_changed(tmp_path, (">NJ 406<", ">NJ 9999<"))
    assumed = [item.path for item in result.assumed if item.path.endswith("carries_axial_load")]
    assert assumed == [
        f"gearboxes.test.bearings.{gear}_rear.catalogue.carries_axial_load" for gear in ("pinion", "wheel")
    ]
    for box in load_case(tmp_path / "case").gearboxes.values():
        assert {name for name, bearing in box.bearings.items() if bearing.locating} == {
            "pinion_rear",
            "wheel_rear",
        }


@pytest.mark.parametrize(
    ("kind", "stated"), [("radial_tapered_roller_bearing", True), ("angular_contact_ball_bearing", False)]
)
def test_only_of_a_tapered_roller_bearing_e_gives_the_contact_angle(
    tmp_path: Path, kind: str, stated: bool
) -> None:
    """e = 1.5 tan(alpha) holds for rollers; 1.14 of a ball bearing of 40 deg would give 37 deg."""
    limit = '<attribute id="catalogue_value_e" unit="none">0.37</attribute>'
    result = of_changed(
        tmp_path, (">NJ 406<", ">XY<"), (">radial_roller_bearing</attribute>", f">{kind}</attribute>{limit}")
    )
    place = "gearboxes.test.bearings.pinion_front.catalogue.contact_angle"
    assert (place in dict(result.stated)) == stated
    assert (place in {item.path for item in result.assumed}) == (not stated)
    if stated:
        assert dict(result.stated)[place].value == '"13.8563515 deg"'


def test_a_bearing_without_numbers_gets_a_tabled_one_of_its_bore(tmp_path: Path) -> None:
    loads = '<attribute id="radial_dynamic_load_rating" unit="kN">60.5</attribute>'
    result = of_changed(tmp_path, (">NJ 406<", ">XY<"), (loads, ""))
    assert result.needed == ()
    said = {item.path: item for item in result.assumed}["gearboxes.test.bearings.pinion_front.designation"]
    assert "in place of XY" in said.reason
    assert load_case(tmp_path / "case").gearboxes["test"].bearings["pinion_front"].shaft_diameter == 0.03


def test_centre_distance_follows_from_the_profile_shifts(tmp_path: Path) -> None:
    of_changed(tmp_path, ('<attribute id="center_distance" unit="mm">91.5</attribute>', ""))
    distance = load_case(tmp_path / "case").gearboxes["test"].meshes["main"].centre_distance
    assert distance == pytest.approx(0.0915, abs=5e-6)


def test_a_contradicting_profile_shift_is_left_out_and_said(tmp_path: Path) -> None:
    of_changed(tmp_path, (">0.172<", ">0.3<"))
    assert "contradicts the centre distance" in (tmp_path / "case/case.toml").read_text()
    assert load_case(tmp_path / "case").gearboxes["test"].gears["wheel"].profile_shift is None


def test_the_suggested_housing_loads(tmp_path: Path) -> None:
    import_case(rexs_file(), tmp_path)
    path = tmp_path / "case.toml"
    text = path.read_text()
    start, end = text.index("# [gearboxes.test.housing]"), text.index("# and then, in the table")
    housing = text[start:end].replace("# ", "")
    slave = 'like = "test"\n'
    path.write_text(text.replace(text[start:end], housing).replace(slave, f'{slave}remove = ["housing"]\n'))
    assert load_case(path).gearboxes["test"].housing is not None


def test_a_case_is_never_overwritten(tmp_path: Path) -> None:
    import_case(rexs_file(), tmp_path)
    before = (tmp_path / "case.toml").read_bytes()
    with pytest.raises(OutputError, match="is there already"):
        import_case(rexs_file("1.0"), tmp_path)
    assert (tmp_path / "case.toml").read_bytes() == before


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"\x89PNG\r\n\x1a\n", "give a REXS file"),
        (rexs_file().read_bytes()[:3000], "line"),
        (archive_of({"unit.rexs": b"<" + b" " * 80_000_000}), "MB"),
    ],
)  # fmt: skip
def test_bad_files_write_nothing(tmp_path: Path, rigdesign: Rigdesign, content: bytes, words: str) -> None:
    file = tmp_path / "bad.rexsz"
    file.write_bytes(content)
    ended = rigdesign("import", file, "--out", tmp_path / "case")
    assert ended.status == RexsError.exit_code == 2
    assert words in ended.err
    assert not (tmp_path / "case").exists()


def test_a_stage_that_is_not_there_lists_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"--stage 2: no such stage(.|\n)*1: 16/24 teeth, module 4.5 mm"):
        import_case(rexs_file(), tmp_path / "case", 2)
    assert not (tmp_path / "case").exists()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            'id="number_of_teeth" unit="none">16<',
            'id="number_of_teeth" unit="none">many<',
            "teeth, e.g. 24",
        ),
        ('id="normal_module" unit="mm">4.5<', 'id="normal_module" unit="mm">1e300<', "normal_module"),
        ('unit="N m">372.6<', 'unit="N m">1e300<', "schedule.test_torque"),
    ],
)
def test_unusable_values_are_said_and_the_rest_is_written(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    result = of_changed(tmp_path, (old, new))
    assert any(words in line for line in result.needed)
    assert "face_width" in (tmp_path / "case/case.toml").read_text()


def test_a_file_without_a_stage_makes_no_case(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no cylindrical stage"):
        of_changed(tmp_path, ('type="cylindrical_stage"', 'type="bevel_stage"'))
    assert not (tmp_path / "case").exists()


def test_the_terminal_accounts_for_the_file(tmp_path: Path, rigdesign: Rigdesign) -> None:
    ended = rigdesign("import", rexs_file(), "--out", tmp_path / "case")
    assert ended.status == 0
    for words in (
        "mapped: ", "listed, not mapped: ", "missing in the file, assumed: ", "the slave gearbox equals",
        "nothing more is needed",
    ):  # fmt: skip
        assert words in ended.out


@pytest.mark.parametrize(("angle", "hand"), [("8.0", "right"), ("-8.0", "left")])
def test_sign_of_the_helix_angle_becomes_the_hand_of_the_pinion(
    tmp_path: Path, angle: str, hand: str
) -> None:
    name = '<attribute id="helix_angle_reference_diameter" unit="deg">'
    of_changed(tmp_path, (f"{name}0.0<", f"{name}{angle}<"))
    box = load_case(tmp_path / "case").gearboxes["test"]
    assert box.meshes["main"].helix_angle == pytest.approx(math.radians(8.0))
    assert (box.gears["pinion"].helix_hand, box.gears["wheel"].helix_hand) == (hand, None)


def of_unit(folder: Path, unit: UnitText, stage: int | None = None) -> ImportedCase:
    """Import of a unit that was put together part by part."""
    (folder / "unit.rexs").write_text(unit.text())
    return import_case(folder / "unit.rexs", folder / "case", stage)


def only(texts: tuple[str, ...], words: str) -> str:
    """The one of some texts that has these words."""
    (found,) = [text for text in texts if words in text]
    return found


@pytest.mark.parametrize(
    ("place", "loads"), [(330, (4401.0, 27287.0)), (-0.0, (24647.0, 1760.0)), (150, (11443.0, 11443.0))]
)
def test_a_gear_outside_its_bearings_stays_there(
    tmp_path: Path, place: float, loads: tuple[float, float]
) -> None:
    """F = 22886 N on bearings at 20 and 280 mm, by the lever rule."""
    result = of_unit(tmp_path, UnitText().pair(place, ((0, 360, 60),)))
    assert (result.needed, result.left_out) == ((), ())
    box = load_case(tmp_path / "case").gearboxes["test"]
    front, rear = (box.bearings[f"pinion_{side}"].position for side in ("front", "rear"))
    gear = box.gears["pinion"].position
    assert (front, gear, rear) == pytest.approx((0.02, 1e-3 * place, 0.28))
    assert front is not None
    assert rear is not None
    assert gear is not None
    force = 1000.0 / (0.0465 * math.cos(math.radians(20.0)))
    forces = [force * abs(rear - gear) / 0.26, force * abs(gear - front) / 0.26]
    assert forces == pytest.approx(loads, rel=1e-3)


def test_a_shaft_counted_from_its_rear_is_turned(tmp_path: Path) -> None:
    unit = UnitText().pair(sections=((0, 100, 60), (100, 260, 60)))
    text = unit.text()
    for shaft, axis in (("10", "0 0 1"), ("20", "0 0 -1")):
        vector = "".join(f"<c>{number}</c>" for number in axis.split())
        place = f'<attribute id="u_axis_vector" unit="none"><array>{vector}</array></attribute>'
        head = f'type="shaft" name="shaft {shaft}">'
        assert head in text
        text = text.replace(head, head + place)
    text = text.replace(">280<", ">250<")
    (tmp_path / "unit.rexs").write_text(text)
    import_case(tmp_path / "unit.rexs", tmp_path / "case")
    box = load_case(tmp_path / "case").gearboxes["test"]
    places = [box.bearings[f"wheel_{side}"].position for side in ("front", "rear")]
    assert places == pytest.approx([0.05, 0.28])
    assert box.bearings["wheel_front"].label == "NJ 212 ECP"
    assert [box.bearings[f"pinion_{side}"].position for side in ("front", "rear")] == pytest.approx(
        [0.02, 0.25]
    )


def test_a_double_helical_stage_is_one_mesh(tmp_path: Path) -> None:
    """Two stages of opposite hand between the same shafts: whole torque, no bearing that has to hold."""
    unit = UnitText()
    unit.shaft(10, rotational_speed=1500)
    unit.shaft(20)
    for shaft in (10, 20):
        unit.bearing(shaft + 2, shaft, 20, "NU 212 ECP")
        unit.bearing(shaft + 3, shaft, 280, "NU 212 ECP" if shaft == 10 else "NJ 212 ECP")
    for half, (place, helix) in enumerate(((110, 25.0), (190, -25.0))):
        unit.gear(30 + 2 * half, 10, place, helix=helix)
        unit.gear(31 + 2 * half, 20, place, teeth=62, helix=-helix)
        unit.stage(40 + half, 30 + 2 * half, 31 + 2 * half, 153.92122)
    unit.load(50, 10, 1000)
    unit.load(51, 20)
    result = of_unit(tmp_path, unit)
    assert (result.needed, result.left_out) == ((), ())
    case = load_case(tmp_path / "case")
    box, mesh = case.gearboxes["test"], case.gearboxes["test"].meshes["main"]
    assert (mesh.double_helical, mesh.sharing, box.gears["pinion"].position) == (True, 2, pytest.approx(0.15))
    assert case.schedule.test_torque == pytest.approx(1000.0)
    assert not any(bearing.locating for name, bearing in box.bearings.items() if name.startswith("pinion"))


def test_bearings_that_a_case_does_not_have_are_named(tmp_path: Path) -> None:
    """A third bearing, and one that joins both shafts."""
    unit = UnitText().pair()
    unit.bearing(14, 10, 100)
    unit.bearing(15, 10, 290, outer=20)
    result = of_unit(tmp_path, unit)
    assert "in two bearings, that of the pinion in its outermost ones, 12 and 13" in only(
        result.left_out, "bearing 14"
    )
    assert "between the shaft of the pinion and another turning part" in only(result.left_out, "bearing 15")
    text = (tmp_path / "case/case.toml").read_text()
    assert "# not in this case: bearing 14" in text
    assert "# not in this case: bearing 15" in text
    assert load_case(tmp_path / "case").gearboxes["test"].bearings["pinion_rear"].position == pytest.approx(
        0.28
    )


@pytest.mark.parametrize("kind", ["same shafts", "two wheels", "two wheels, one torque unknown"])
def test_power_that_branches_is_shared_by_statics_or_asked_for(tmp_path: Path, kind: str) -> None:
    """Two stages of equal hand between two shafts share nothing by statics; of two wheels each has its own load."""
    unit = UnitText().pair(100)
    unit.gear(32, 10, 200)
    if kind == "same shafts":
        unit.gear(33, 20, 200, teeth=62)
    else:
        unit.shaft(70)
        unit.gear(33, 70, 200, teeth=62)
        unit.load(71, 70, 1400 if kind == "two wheels" else None)
    unit.stage(41, 32, 33)
    result = of_unit(tmp_path, unit, 1)
    named = only(result.left_out, "cylindrical_stage 41")
    assert "its forces on the shaft of the pinion" in named
    if kind == "two wheels":
        assert result.needed == ()
        assert load_case(tmp_path / "case").schedule.test_torque == pytest.approx(300.0)
    else:
        needed = only(result.needed, "schedule.test_torque")
        assert "power branches" in needed
        assert ("71" in needed) == (kind != "same shafts")


def test_a_pinion_cut_into_its_shaft_is_solid(tmp_path: Path) -> None:
    """80 mm under a root circle of 85.5 mm is no bore: the gear has the inertia of the ring round its shaft."""
    of_unit(tmp_path, UnitText().pair(sections=((0, 40, 60), (40, 220, 80), (260, 40, 60))))
    case = load_case(tmp_path / "case")
    box = case.gearboxes["test"]
    assert [gear.bore_diameter for gear in box.gears.values()] == [0.0, pytest.approx(0.06)]
    assert box.seat_diameter("pinion") == pytest.approx(0.06)
    (mark,) = [mark for mark in case.origin.marks if mark.path == "gearboxes.test.gears.pinion.bore_diameter"]
    assert "cut into its shaft" in (mark.assumed or "")
    train = build_rig(case, "quick").drivetrain
    assert train is not None
    (disc,) = [gear for gear in train.gears if gear.name == "test.pinion"]
    ring = math.pi * 7850.0 * 0.05 * (0.093**4 - 0.08**4) / 32.0
    assert disc.inertia == pytest.approx(ring, rel=5e-3)
    assert disc.mass == pytest.approx(7850.0 * 0.05 * math.pi / 4.0 * (0.093**2 - 0.08**2), rel=5e-3)


def test_a_pinion_that_is_thinner_than_its_shaft_dips_with_its_teeth(tmp_path: Path) -> None:
    """17 teeth of 3 mm have a root circle of 43.5 mm, the shaft 60 mm in its bearings."""
    of_unit(tmp_path, UnitText().pair(sections=((0, 40, 60), (40, 220, 80), (260, 40, 60))))
    box = load_case(tmp_path / "case").gearboxes["test"]
    pair = GearPair.from_centre_distance(
        normal_module=3e-3,
        teeth=(17, 62),
        centre_distance=118.5e-3,
        face_widths=(50e-3, 50e-3),
        profile_shift_1=0.0,
    )
    dipped = [
        dipped_gear(box, gear, pair, index).shaft_radius for index, gear in enumerate(("pinion", "wheel"))
    ]
    assert dipped == pytest.approx([0.9 * 21.75e-3, 30e-3])

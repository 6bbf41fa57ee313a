"""Rolling bearings of a case: what they may be, and what a user is told who writes something else."""

import re
from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.base.units import parse
from rigdesign.case.geometry import housing_geometry
from tests.builders.rolling_rig import FED, GREASE, SPLASH, rolling_case

AT = "gearboxes.test.bearings.pinion_front"
NUMBERS = (
    'catalogue = { kind = "cylindrical_roller", series = "4", bore = "30 mm", outside_diameter = "90 mm", '
    'width = "23 mm", dynamic_rating = "60.5 kN", static_rating = "53 kN", limiting_speed = "11000 rpm", '
    'reference_speed = "9000 rpm", inner_raceway = "45 mm", outer_raceway = "73 mm", carries_axial_load = false, '
    "minimum_load_factor = 0.15 }"
)


def faults(folder: Path, old: str, new: str, **oils: str) -> list[str]:
    """Sentences about the case with a text replaced once."""
    path = rolling_case(folder, **oils)  # type: ignore[arg-type]
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(CaseError) as caught:
        load_case(path)
    return [str(fault) for fault in caught.value.faults]


def test_a_bearing_by_designation_knows_its_measures(tmp_path: Path) -> None:
    bearing = load_case(rolling_case(tmp_path)).gearboxes["test"].bearings["pinion_rear"]
    assert (bearing.label, bearing.width, bearing.has_film) == ("NJ 406", 0.023, False)
    assert (bearing.shaft_diameter, bearing.housing_bore) == (0.03, 0.09)


def test_a_bearing_by_its_numbers_is_that_of_its_designation(tmp_path: Path) -> None:
    path = rolling_case(tmp_path)
    tabled = load_case(path).gearboxes["test"].bearings["pinion_front"]
    path.write_text(path.read_text().replace('designation = "NU 406"', NUMBERS, 1))
    given = load_case(path).gearboxes["test"].bearings["pinion_front"]
    assert given.shaft_diameter == tabled.shaft_diameter and given.housing_bore == tabled.housing_bore
    assert given.drawn_clearance == tabled.drawn_clearance == pytest.approx(32.5e-6)


def test_each_end_of_a_shaft_takes_its_own_bearing(tmp_path: Path) -> None:
    """A small roller bearing and a large one on the pinion, a plain bearing and a ball bearing on the wheel."""
    others = {"test.pinion_front": "NU 206", "test.wheel_rear": "6306"}
    case = load_case(rolling_case(tmp_path, test_oil=FED, plain=("test.wheel_front",), others=others))
    pinion, wheel = housing_geometry(case.gearboxes["test"]).shafts
    ends = (pinion.front, pinion.rear, wheel.front, wheel.rear)
    assert [end.bore_radius for end in ends] == pytest.approx([0.031, 0.045, 0.015025, 0.036], rel=1e-12)
    assert [end.width for end in ends] == [0.016, 0.023, 0.023, 0.019]


def test_an_unknown_designation_names_the_nearest(tmp_path: Path) -> None:
    (sentence,) = faults(tmp_path, '"NU 406"', '"NU 4061"')
    assert sentence.startswith(f'{AT}.designation = "NU 4061": not among the')
    assert "NU 406" in sentence and "catalogue numbers" in sentence


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('designation = "NU 406"\n', "", "either its designation or the numbers"),
        ('designation = "NU 406"', f'designation = "NU 406"\n{NUMBERS}', "either its designation or the numbers"),
        ('designation = "NU 406"', NUMBERS.replace('series = "4"', 'series = "9"'), "no friction coefficients"),
        ('designation = "NU 406"', NUMBERS.replace('"53 kN"', '"53 N"'), "static_rating = 53 N: would need 10"),
        ('"NU 406"', '"NU 207"', "the shaft test_pinion has 30 mm there, the bore of the bearing is 35 mm"),
        ('"NJ 406"', '"NU 406"', "carries no axial load"),
        ('"NU 406"', '"NU 406"\nshaft_interference = "0.5 mm"', "two thousandths of the seat"),
        ('"NU 406"', '"NU 406"\noil_level = "95 mm"', "above the outside diameter 90 mm"),
        ('"NU 406"', '"NU 406"\nclearance_class = "C6"', "clearance_class"),
        ('"NU 406"', '"NU 406"\nseat_outside_diameter = "80 mm"', "not above the outside diameter"),
        ('"NU 406"', '"NU 406"\ndiameter = "30 mm"', "diameter"),
    ],
)  # fmt: skip
def test_bad_input_is_named(tmp_path: Path, old: str, new: str, said: str) -> None:
    sentences = faults(tmp_path, old, new)
    assert any(said in sentence and "test" in sentence for sentence in sentences), sentences


def test_grease_needs_something_that_carries_the_heat(tmp_path: Path) -> None:
    path = rolling_case(tmp_path, test_oil=GREASE)
    load_case(path)
    sentences = _said(rolling_case(tmp_path, slave_oil=GREASE))
    assert len(sentences) == 4
    assert "nothing carries the heat of bearing pinion_front" in sentences[0] and "housing" in sentences[0]
    insulated = faults(
        tmp_path,
        'bearings = { surfaces = ["bearing_bore_*", "shaft_*_journal_*"], law = "bearing_film" }',
        'bearings = { surfaces = ["bearing_bore_*", "shaft_*_journal_*"], law = "insulated" }',
        test_oil=GREASE,
    )
    assert "no bearing_film joins its seats" in insulated[0]


def _said(path: Path) -> list[str]:
    with pytest.raises(CaseError) as caught:
        load_case(path)
    return [str(fault) for fault in caught.value.faults]


def test_helical_gears_need_a_bearing_that_locates(tmp_path: Path) -> None:
    path = rolling_case(tmp_path, dip=False, test_oil=FED, slave_oil=FED)
    text = path.read_text().replace("4.5 mm", '4.35 mm", helix_angle = "15 deg')
    path.write_text(re.sub("locating = true", "locating = false", text))
    assert any("push shaft slave_pinion axially and no bearing locates it" in said for said in _said(path))


def test_a_bearing_that_pushes_its_shaft_needs_one_that_holds_it(tmp_path: Path) -> None:
    pushing = {"test.pinion_front": "7206 B"}
    load_case(rolling_case(tmp_path, others=pushing))  # beside NJ 406, which locates
    load_case(rolling_case(tmp_path, others=pushing | {"test.pinion_rear": "30206"}))
    alone = rolling_case(tmp_path, others={"test.pinion_rear": "30206"})
    (sentence,) = _said(alone)  # beside NU 406
    assert sentence.startswith(
        "gearboxes.test.bearings.pinion_rear = 30206 J2/Q: its contact angle pushes shaft"
    )
    assert "pinion_front at the other end does not hold it axially" in sentence


def test_a_plain_bearing_on_splash_is_refused_beside_rolling_ones(tmp_path: Path) -> None:
    (sentence,) = _said(
        rolling_case(tmp_path, test_oil=SPLASH, plain=("test.wheel_front", "test.wheel_rear"))
    )
    assert "plain bearing, which needs oil that is fed" in sentence


def test_fits_left_out_are_assumptions_with_a_range(tmp_path: Path) -> None:
    found = {record.path: record for record in load_case(rolling_case(tmp_path)).assumptions}
    record = found[f"{AT}.shaft_interference"]
    assert record.range is not None
    low, usual, high = (parse(text, "length") for text in (record.range[0], record.value, record.range[1]))
    assert (low, usual, high) == (0.0, pytest.approx(9e-6), pytest.approx(21e-6))

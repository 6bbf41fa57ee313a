"""A minimal case with one key wrong in turn: the fault comes first, what follows from it is said to follow."""

from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.case.defaults.fill import NOT_WORKED_OUT
from rigdesign.new_case.outline import outline_from
from rigdesign.new_case.write import plain_text

MINIMAL = plain_text(
    outline_from(
        {
            "teeth": "16,24", "module": "4.5 mm", "centre_distance": "91.5 mm", "face_width": "14 mm",
            "torque": "372.6 N m", "speed": "2250 rpm", "bearings": "NU 406", "oil": "FVA 3",
            "oil_temperature": "90 degC", "lubrication": "dip", "box": "176 x 280 x 220 mm",
        }
    )
)  # fmt: skip


def error_of(folder: Path, old: str, new: str) -> CaseError:
    assert old in MINIMAL
    file = folder / "case.toml"
    file.write_text(MINIMAL.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    return caught.value


@pytest.mark.parametrize(
    ("old", "new", "first"),
    [
        ("teeth = 16", 'teeth = "many"', 'gears.pinion.teeth = "many"'),
        ("teeth = 16", "teeth = nan", "gears.pinion.teeth = nan"),
        ("teeth = 16", "teeth = inf", "gears.pinion.teeth = inf"),
        ("teeth = 24", "", "gears.wheel.teeth: a required key is missing"),
        ('normal_module = "4.5 mm"', "normal_module = 4.5", "normal_module = 4.5: a bare number"),
        ('centre_distance = "91.5 mm"', 'centre_distance = "91.5 bar"', "unit 'bar' is one of pressure"),
        ('level = "0 mm"', "level = []", "oil.level = a list of 0"),
        ('warm_length = "116 mm"', 'warm_length = "long"', "housing.warm_length"),
        ('height = "220 mm"', "", "housing.height: a required key is missing"),
        ('test_torque = "372.6 N m"', 'test_torque = "372.6 W"', "schedule.test_torque"),
        ('test_speed = "2250 rpm"', 'test_speed = "fast"', "schedule.test_speed"),
        ('name = "my_rig"', "", "name: a required key is missing"),
    ],
)
def test_what_is_wrong_comes_before_what_follows_from_it(
    tmp_path: Path, old: str, new: str, first: str
) -> None:
    faults = error_of(tmp_path, old, new).faults
    assert first in str(faults[0])
    (followed,) = (fault for fault in faults if fault.problem.startswith(NOT_WORKED_OUT))
    assert followed == faults[-1]
    assert followed.remedy.startswith("correct the faults above first")


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("teeth = 16", "teeth = -1", "gearboxes.test.gears.pinion.teeth"),
        ('test_torque = "372.6 N m"', 'test_torque = "-372.6 N m"', "schedule.test_torque"),
    ],
)
def test_no_fault_of_a_value_that_the_file_does_not_hold(
    tmp_path: Path, old: str, new: str, place: str
) -> None:
    """Defaults of a negative torque would be negative stiffnesses; the torque alone is to be corrected."""
    faults = error_of(tmp_path, old, new).faults
    assert [fault.path for fault in faults if not fault.problem.startswith(NOT_WORKED_OUT)] == [place]


@pytest.mark.parametrize("sections", ["5", "true", '"x"'])
def test_sections_that_are_no_list_are_a_fault(tmp_path: Path, sections: str) -> None:
    faults = error_of(
        tmp_path, "[schedule]", f"[drivetrain.shafts.test_pinion]\nsections = {sections}\n[schedule]"
    ).faults
    assert faults[0].path == "drivetrain.shafts.test_pinion.sections"


def test_a_key_of_another_kind_says_which(tmp_path: Path) -> None:
    faults = error_of(tmp_path, 'lubrication = "dip"\n', "").faults
    said = {fault.path: fault.remedy for fault in faults}
    assert said["gearboxes.test.oil.level"] == "a key of lubrication = dip: state that as well, or remove it"

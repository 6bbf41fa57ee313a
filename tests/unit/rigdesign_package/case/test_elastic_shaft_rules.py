"""Shafts that bend have to be held along their axis and sideways: faults of the case, and the solver says the same."""

from pathlib import Path

import pytest

from dynamics.drivetrain.shaft import DrivetrainError
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import Case, load_case
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype" / "case.toml"
QUILLS = """
drivetrain.shafts.pinion_quill = { material = "case_hardened_steel", sections = QUILL }
drivetrain.shafts.wheel_quill = { material = "case_hardened_steel", sections = QUILL }
drivetrain.couplings.pinion_side = { shafts = ["test_pinion", "pinion_quill"], HELD }
drivetrain.couplings.wheel_side = { shafts = ["test_wheel", "wheel_quill"], NEAR }
drivetrain.couplings.pinion_far = { shafts = ["pinion_quill", "reference_pinion"], ENDS, TORSION, HELD }
drivetrain.couplings.wheel_far = { shafts = ["wheel_quill", "reference_wheel"], ENDS, FAR }
"""
"""A shaft without bearings between two couplings on either side; NEAR and FAR: what holds that of the wheels."""
HELD = 'radial_stiffness = "1e8 N/m", axial_stiffness = "1e6 N/m"'
TORSION = 'torsional_stiffness = "290e3 N m/rad", torsional_damping = "600 N m s/rad"'
UNLOCATED = """
gearboxes.reference.bearings.wheel_front = { locating = false, remove = ["axial_play"] }
gearboxes.reference.bearings.pinion_front.locating = false
"""
ONE_BEARING = 'gearboxes.reference.bearings.remove = ["wheel_rear"]'
ONE_EACH = """
gearboxes.reference.bearings.remove = ["wheel_rear"]
gearboxes.test.bearings.remove = ["wheel_rear"]
gearboxes.test.remove = ["housing"]
gearboxes.test.bearings.wheel_front.locating = true
"""


def quills(near: str, far: str) -> str:
    text = QUILLS.replace("NEAR", near).replace("FAR", far)
    for word, meant in (
        ("HELD", HELD),
        ("TORSION", TORSION),
        ("ENDS", 'ends = ["end", "start"]'),
        ("QUILL", '[{ length = "200 mm", outer_diameter = "30 mm" }]'),
    ):
        text = text.replace(word, meant)
    return text


def wheel_side(**stiffness: str) -> str:
    keys = (f'drivetrain.couplings.wheel_side.{key} = "{value}"' for key, value in stiffness.items())
    return "\n" + "\n".join(keys)


def loaded(folder: Path, text: str, model: str = "elastic") -> Case:
    """The prototype with couplings that pass no bending, and ``text`` laid over it."""
    file = folder / f"{model}.toml"
    lines = [f'extends = "{PROTOTYPE.as_posix()}"', f'drivetrain.shaft_model = "{model}"', text]
    file.write_text("\n".join(lines), encoding="utf-8")
    return load_case(file)


def faults(folder: Path, text: str) -> tuple[Fault, ...]:
    with pytest.raises(CaseError) as caught:
        loaded(folder, text)
    return caught.value.faults


def solver_says(folder: Path, text: str) -> str:
    """What the elastic rig says of the same case, read with shafts that only twist: no rule stops it."""
    rig = build_rig(loaded(folder, text, "torsional"), "quick")
    try:
        _ = rig.elastic.model
    except DrivetrainError as error:
        return str(error)
    return ""


def shafts_of(found: tuple[Fault, ...]) -> list[str]:
    return [fault.path.removeprefix("drivetrain.shafts.") for fault in found]


AXIAL, RADIAL, ANGULAR = (
    {"axial_stiffness": "1e6 N/m"},
    {"radial_stiffness": "1e8 N/m"},
    {"angular_stiffness": "1e5 N m/rad"},
)
HELD_RIGS = {
    "as shipped": "",
    "coupling to a located shaft": UNLOCATED + wheel_side(**AXIAL),
    "one bearing and a coupling": ONE_BEARING + wheel_side(**RADIAL),
    "one bearing and a coupling in angle": ONE_BEARING + wheel_side(**ANGULAR),
    "one bearing each, one stiff line": ONE_EACH + wheel_side(**RADIAL, **ANGULAR),
    "quills held at both ends": quills(HELD, f"{TORSION}, {HELD}"),
    "quill clamped at one end": quills(HELD + ', angular_stiffness = "1e5 N m/rad"', TORSION),
}
FREE_RIGS = {
    "nothing locates": (UNLOCATED, ["reference_pinion"]),
    "one bearing": (ONE_BEARING, ["reference_wheel"]),
    "quill on one coupling": (quills(HELD, TORSION), ["wheel_quill"]),
    "one bearing each, hinged": (ONE_EACH + wheel_side(**RADIAL), ["test_wheel", "reference_wheel"]),
}


@pytest.mark.parametrize("name", HELD_RIGS)
def test_a_shaft_that_is_held_is_no_fault(tmp_path: Path, name: str) -> None:
    assert loaded(tmp_path, HELD_RIGS[name]).drivetrain is not None
    assert solver_says(tmp_path, HELD_RIGS[name]) == ""


@pytest.mark.parametrize("name", FREE_RIGS)
def test_a_shaft_that_is_free_is_a_fault_and_stops_the_solver(tmp_path: Path, name: str) -> None:
    text, shafts = FREE_RIGS[name]
    (fault,) = faults(tmp_path, text)
    assert fault.path.removeprefix("drivetrain.shafts.") in shafts
    assert any(f"'{shaft}'" in solver_says(tmp_path, text) for shaft in shafts)


def test_both_are_named_where_two_shafts_float_together(tmp_path: Path) -> None:
    (fault,) = faults(tmp_path, UNLOCATED)
    assert "locates it and reference_wheel axially: 0 of" in fault.problem
    assert "gearboxes.reference.bearings.pinion_front or gearboxes" in fault.remedy
    assert "axial_stiffness at a coupling" in fault.remedy


def test_every_shaft_that_is_free_is_named_at_once(tmp_path: Path) -> None:
    found = faults(tmp_path, UNLOCATED + ONE_BEARING)
    assert shafts_of(found) == ["reference_pinion", "reference_wheel"]


@pytest.mark.parametrize("text", [UNLOCATED, ONE_BEARING])
def test_shafts_that_only_twist_need_no_hold(tmp_path: Path, text: str) -> None:
    assert loaded(tmp_path, text, "torsional").drivetrain is not None


def test_a_disc_is_no_thinner_than_a_disc(tmp_path: Path) -> None:
    text = 'drivetrain.shafts.test_pinion.discs.coupling_flange.diametral_inertia = "9.5e-5 kg m2"'
    (fault,) = faults(tmp_path, text)
    assert fault.path == "drivetrain.shafts.test_pinion.discs.coupling_flange.diametral_inertia"
    assert "half of its polar inertia" in fault.problem
    loaded(tmp_path, text.replace("9.5e-5", "9.55e-5"))


def test_stated_coefficients_have_to_be_stated(tmp_path: Path) -> None:
    text = """
    drivetrain.bearing_coefficients = "stated"
    gearboxes.test.bearings.wheel_rear.remove = ["radial_stiffness"]
    gearboxes.reference.bearings.pinion_rear.remove = ["radial_stiffness", "radial_damping"]
    """
    found = faults(tmp_path, text)
    assert [fault.path for fault in found] == [
        "gearboxes.test.bearings.wheel_rear.radial_stiffness",
        "gearboxes.reference.bearings.pinion_rear.radial_stiffness",
    ]
    assert all('"computed"' in fault.remedy for fault in found)
    loaded(tmp_path, text.replace('"stated"', '"computed"'))
    loaded(tmp_path, text, "torsional")

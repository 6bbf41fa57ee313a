"""Shafts that bend have to be held along their axis and sideways: faults of the case, and the solver says the same."""

import math
from pathlib import Path

import pytest

from dynamics.rotor.shaft import DrivetrainError
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import Case, load_case
from rigdesign.case.elastic_shafts import disc_mass
from rigdesign.case.rolling_bearing import ROLLING_DAMPING_TIME
from rigdesign.rig.model import build_rig
from tests.builders.minimal_case import MINIMAL, MINIMAL_ROLLING
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


FREE_ENDS = "".join(
    f'drivetrain.couplings.{name}_side.remove = ["radial_stiffness", "angular_stiffness"]\n'
    for name in ("pinion", "wheel")
)


def loaded(folder: Path, text: str, model: str = "elastic") -> Case:
    """The prototype with couplings that pass torque only, and ``text`` laid over it."""
    base, file = folder / "base.toml", folder / f"{model}.toml"
    base.write_text(f'extends = "{PROTOTYPE.as_posix()}"\n{FREE_ENDS}', encoding="utf-8")
    file.write_text(f'extends = "base.toml"\ndrivetrain.shaft_model = "{model}"\n{text}', encoding="utf-8")
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
    "half of a double-helical gear": (
        "gearboxes.reference.meshes.main.double_helical = false\n"
        "gearboxes.reference.bearings.pinion_front.locating = false\n",
        ["reference_pinion"],
    ),
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


def test_two_bearings_at_one_place_are_one(tmp_path: Path) -> None:
    """The message says how far they stand apart; that no two may stand at one place is a fault of its own."""
    ends = ("front", "rear")
    text = "".join(f'gearboxes.reference.bearings.wheel_{end}.position = "48.13 mm"\n' for end in ends)
    (fault,) = (one for one in faults(tmp_path, text) if one.path == "drivetrain.shafts.reference_wheel")
    assert "has 2 bearings 0 mm apart, must be above 0 mm, and can move sideways" in fault.problem


def test_both_are_named_where_two_shafts_float_together(tmp_path: Path) -> None:
    (fault,) = faults(tmp_path, UNLOCATED)
    assert "locates it and reference_wheel axially: 0 of" in fault.problem
    assert "gearboxes.reference.bearings.pinion_front or gearboxes" in fault.remedy
    assert "axial_stiffness at a coupling" in fault.remedy


def test_a_single_helical_mesh_locates_no_shaft(tmp_path: Path) -> None:
    """A helical test gear at one end, spur gears at the other: the pinion of the 1:1 loop would screw out of mesh."""
    file = tmp_path / "case.toml"
    helical = (
        'gearboxes.test.meshes.main = { helix_angle = "12 deg", remove = ["contact_ratio", "tip_cut"] }\n'
    )
    base = f'extends = "{(CASES / "loop_1to1" / "case.toml").as_posix()}"\n{helical}'
    file.write_text(base, encoding="utf-8")
    load_case(file)
    free = "gearboxes.test.bearings.pinion_rear.locating = false\n"
    file.write_text(base + free, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert [fault.path for fault in caught.value.faults] == ["drivetrain.shafts.test_pinion"]
    (fault,) = caught.value.faults
    assert "0 of the bearings do, must be 1; a single-helical mesh (test.main)" in fault.problem
    assert "locating = true at gearboxes.test.bearings.pinion_front or" in fault.remedy
    file.write_text(base + free + 'drivetrain.shaft_model = "torsional"\n', encoding="utf-8")
    with pytest.raises(
        DrivetrainError, match=r"'test_pinion' has no axial location.*single-helical mesh 'test.main'"
    ):
        _ = build_rig(load_case(file), "quick").elastic.model


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


def implied(case: Case, key: str) -> dict[str, str]:
    """Assumptions of one key that the case does not state: part -> value."""
    stated = {mark.path for mark in case.origin.marks}
    return {
        record.path.split(".")[-2]: record.value
        for record in case.assumptions
        if record.path.endswith(f".{key}") and record.path not in stated
    }


def test_what_is_left_out_is_an_assumption(tmp_path: Path) -> None:
    case = loaded(
        tmp_path,
        """
        drivetrain.shafts.test_pinion.discs.coupling_flange.remove = ["mass"]
        gearboxes.test.bearings.wheel_rear.axial_stiffness = "2e8 N/m"
        gearboxes.test.bearings.wheel_front.support_stiffness = "1e9 N/m"
        drivetrain.couplings.wheel_side.angular_stiffness = "1e3 N m/rad"
        """,
    )
    assert implied(case, "mass") == {"coupling_flange": "0.327 kg"}
    assert implied(case, "radial_stiffness") == {"pinion_side": "none"}
    located = [box.bearings[name] for box in case.gearboxes.values() for name in box.bearings]
    assert sum(bearing.locating for bearing in located) == 3
    assert list(implied(case, "axial_stiffness").values()) == ["100 N/um"] * 2
    supports = [record for record in case.assumptions if record.path.endswith("support_stiffness")]
    assert len(supports) == len(located) - 1
    assert all(record.range is None for record in supports)
    assert implied(case, "radial_damping") == {}  # films are computed


def test_shafts_that_only_twist_assume_nothing_of_bending(tmp_path: Path) -> None:
    case = loaded(tmp_path, "", "torsional")
    for key in ("mass", "radial_stiffness", "axial_stiffness", "support_stiffness"):
        assert implied(case, key) == {}


def test_shafts_that_only_twist_refuse_what_they_do_not_read(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as refused:
        loaded(
            tmp_path,
            """
            gearboxes.test.housing.bearing_seats = "elastic"
            gearboxes.reference.bearings.wheel_front.support_stiffness = "1e9 N/m"
            """,
            "torsional",
        )
    paths = {fault.path for fault in refused.value.faults}
    assert {
        "gearboxes.test.housing.bearing_seats", "gearboxes.reference.bearings.wheel_front.support_stiffness"
    } <= paths  # fmt: skip


def test_a_disc_without_a_mass_is_a_third_as_thick_as_its_radius() -> None:
    radius = 0.1
    mass = 7850.0 * math.pi * radius**2 * radius / 3.0
    assert disc_mass(0.5 * mass * radius**2) == pytest.approx(mass, rel=1e-12)


def test_rolling_bearings_take_their_damping_from_their_stiffness(tmp_path: Path) -> None:
    """As assumption where both are computed; as value of the case where the stiffness is stated."""
    file = tmp_path / "case.toml"
    file.write_text(MINIMAL_ROLLING, encoding="utf-8")
    computed = implied(load_case(file), "radial_damping")
    assert set(computed.values()) == {f"{ROLLING_DAMPING_TIME:.3g} s of the stiffness"}
    assert len(computed) == 4
    stated = MINIMAL_ROLLING.replace('"NU 406" }', '"NU 406", radial_stiffness = "4e8 N/m" }')
    file.write_text(stated + '[drivetrain]\nbearing_coefficients = "stated"\n', encoding="utf-8")
    case = load_case(file)
    assert case.gearboxes["slave"].bearings["wheel_front"].radial_damping == pytest.approx(5e3)
    assert implied(case, "radial_damping") == {}


def test_a_gearbox_without_a_housing_gets_its_locating_bearings(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    for lines, fixed in (("", True), ('[drivetrain]\nshaft_model = "torsional"\n', False)):
        file.write_text(MINIMAL + lines, encoding="utf-8")
        bearings = load_case(file).gearboxes["slave"].bearings
        assert {name for name, one in bearings.items() if one.locating} == (
            {"pinion_front", "wheel_front"} if fixed else set()
        )


def test_table_1_of_p2_is_a_variant() -> None:
    case = load_case(CASES / "uhcf_prototype" / "table_1_bearings.toml")
    assert case.drivetrain is not None
    assert case.drivetrain.bearing_coefficients == "stated"
    bearings = [one for box in case.gearboxes.values() for one in box.bearings.values()]
    assert {(one.radial_stiffness, one.radial_damping) for one in bearings} == {(1e8, 4e4)}

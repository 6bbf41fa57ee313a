"""Bad input: every kind of fault names key, value, limit and remedy, all of a file at once, exit status 2."""

from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import load_case
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype" / "case.toml"


def faults(tmp_path: Path, text: str) -> tuple[Fault, ...]:
    """Faults of the prototype with ``text`` laid over it."""
    file = tmp_path / "bad.toml"
    file.write_text(f'extends = "{PROTOTYPE.as_posix()}"\n{text}', encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert caught.value.exit_code == 2
    assert str(file) in str(caught.value)
    return caught.value.faults


BAD = [
    # unknown key, with the nearest name
    (
        'gearboxes.test.oil.flwo = "5 l/min"',
        "gearboxes.test.oil.flwo",
        "unknown key",
        "did you mean 'flow'?",
    ),
    (
        "gearboxes.test.housing.xyzzy = 1",
        "gearboxes.test.housing.xyzzy",
        "unknown key",
        "known here: warm_length",
    ),
    # missing unit, wrong dimension, unknown unit
    (
        "gearboxes.test.gears.pinion.face_width = 7",
        "gearboxes.test.gears.pinion.face_width",
        "bare number",
        'e.g. "7 mm"',
    ),
    (
        'gearboxes.test.gears.pinion.face_width = "7"',
        "gearboxes.test.gears.pinion.face_width",
        "without a unit",
        '"7 mm"',
    ),
    (
        'gearboxes.test.gears.pinion.face_width = "7 degC"',
        "gearboxes.test.gears.pinion.face_width",
        "one of temperature, not of length",
        "mm, um, cm, m, in",
    ),
    ('gearboxes.test.oil.flow = "5 gal"', "gearboxes.test.oil.flow", "not known", "l/min"),
    # numbers out of range
    (
        'gearboxes.test.gears.pinion.face_width = "-7 mm"',
        "gearboxes.test.gears.pinion.face_width",
        "is not above 0 mm",
        "above 0 mm",
    ),
    ('ambient.temperature = "2000 degC"', "ambient.temperature", "is above 600 degC", "at most 600 degC"),
    (
        'drivetrain.couplings.wheel_side.shafts = ["reference_pinion", "test_pinion"]',
        "drivetrain.couplings.wheel_side.shafts",
        "one line already",
        "line that is left",
    ),
    ("losses.squeeze_share = 0.3", "losses.squeeze_share", "less than or equal to 0.1", "at most 0.1"),
    (
        "gearboxes.test.gears.pinion.teeth = 99.5",
        "gearboxes.test.gears.pinion.teeth",
        "a number",
        "whole number",
    ),
    # choices
    ('losses.basis = "calculated"', "losses.basis", "not one of the choices", '"computed"'),
    (
        'gearboxes.test.housing.boundary.housing_air.law = "nieman_winter"',
        "gearboxes.test.housing.boundary.housing_air.law",
        "not one of the choices",
        'did you mean "niemann_winter"?',
    ),
    # structure
    ('gearboxes.test.oil = "warm"', "gearboxes.test.oil", "a text", "a table"),
    (
        "remove = ['gearboxes']",
        "gearboxes",
        "required key is missing",
        "add it: [gearboxes.NAME] with title, role, gears",
    ),
    (
        "schedule.remove = ['test_speed']",
        "schedule.test_speed",
        "required key is missing",
        'add it: "',
    ),
    (
        "gearboxes.test.remove = ['meshes']",
        "gearboxes.test.meshes",
        "required key is missing",
        "add it: [gearboxes.test.meshes.NAME] with pinion, wheel",
    ),
    (
        "gearboxes.test.bearings.pinion_front.diametral_clearance = 80",
        "gearboxes.test.bearings.pinion_front.diametral_clearance",
        "a bare number",
        'e.g. "80 um" (units: um, mm',
    ),
    (
        'gearboxes.test.bearings.pinion_front.diametral_clearance = "0 mm"',
        "gearboxes.test.bearings.pinion_front.diametral_clearance",
        "is not above 0 mm",
        'e.g. "80 um"',
    ),
    (
        'gearboxes.test.gears.pinion.flank.tip_relief = "8 N"',
        "gearboxes.test.gears.pinion.flank.tip_relief",
        "one of force, not of length",
        'such as "10 um" (units: um, mm',
    ),
    (
        "gearboxes.test.oil.remove = ['inlet_temperature']",
        "gearboxes.test.oil.inlet_temperature",
        "required key is missing",
        '"140 degC"',
    ),
    ('gearboxes.Test = { title = "x" }', "gearboxes.Test", "pattern", "lower-case"),
    # marks
    (
        'gearboxes.test.oil.flow = { value = "5 l/min", asumed = "so" }',
        "gearboxes.test.oil.flow",
        "unknown mark 'asumed'",
        "did you mean 'assumed'?",
    ),
    (
        'gearboxes.test.oil.flow = { value = "5 l/min", assumed = 3 }',
        "gearboxes.test.oil.flow",
        "mark 'assumed' is not a text",
        "reason",
    ),
    (
        'gearboxes.test.oil.flow = { value = "5 l/min", assumed = "so", range = "3 l/min" }',
        "gearboxes.test.oil.flow",
        "a range has two ends",
        "range =",
    ),
    (
        'gearboxes.test.oil.flow = { value = "5 l/min", assumed = "so", range = ["6 l/min", "8 l/min"] }',
        "gearboxes.test.oil.flow (range)",
        "does not contain the value",
        "widen",
    ),
    (
        'gearboxes.test.oil.flow = { value = "5 l/min", assumed = "so", range = ["8 l/min", "3 l/min"] }',
        "gearboxes.test.oil.flow (range)",
        "not below the second",
        "exchange",
    ),
    (
        'gearboxes.test.oil.flow = { value = "5 l/min", assumed = "so", range = ["3 mm", "8 l/min"] }',
        "gearboxes.test.oil.flow (range)",
        "one of length",
        "l/min",
    ),
    # references
    ('gearboxes.test.oil.oil = "MIL-PRF-2369"', "gearboxes.test.oil.oil", "no such oil", "MIL-PRF-23699"),
    (
        'gearboxes.test.gears.pinion.material = "case_hardend_steel"',
        "gearboxes.test.gears.pinion.material",
        "no such material",
        'did you mean "case_hardened_steel"?',
    ),
    (
        'gearboxes.test.gears.pinion.shaft = "test_pinon"',
        "gearboxes.test.gears.pinion.shaft",
        "no such shaft",
        'did you mean "test_pinion"?',
    ),
    (
        'gearboxes.test.meshes.main.wheel = "rad"',
        "gearboxes.test.meshes.main.wheel",
        "no such gear",
        "known: pinion, wheel",
    ),
    ('drivetrain.motor.shaft = "motor"', "drivetrain.motor.shaft", "no such shaft", "reference_wheel"),
    ('drivetrain.torque_at = "pinion"', "drivetrain.torque_at", "no such gear", "test.pinion"),
    (
        'drivetrain.bracing.shifted_gear = "test.pinion"',
        "drivetrain.bracing.shifted_gear",
        "helix angle is zero",
        "helical gear",
    ),
    (
        'drivetrain = { remove = ["couplings"], couplings = {}, '
        'bracing = { mode = "twist_held", remove = ["coupling"] } }',
        "drivetrain.bracing.coupling",
        "needs the coupling",
        "name a coupling",
    ),
    (
        "gearboxes.test.heat_split.seal_into_shaft = 0.9",
        "gearboxes.test.heat_split",
        "add up to 1.15",
        "at most 1",
    ),
    # gears
    (
        'gearboxes.reference.meshes.main.centre_distance = "90 mm"',
        "gearboxes.reference.meshes.main.centre_distance",
        "cannot mesh at or below",
        "near 100.388 mm",
    ),
    (
        "gearboxes.test.gears.wheel.profile_shift = 0.1",
        "gearboxes.test.meshes.main.centre_distance",
        "fixes the sum of the profile shifts at -",
        "leave wheel.profile_shift out",
    ),
    (
        'gearboxes.test.meshes.main.profile_shift_split = "equal"',
        "gearboxes.test.meshes.main",
        "fixes the sum of the profile shifts",
        "for one of the two gears or for both",
    ),
    (
        'gearboxes.test.gears.wheel.tip_shortening = "0.1 mm"',
        "gearboxes.test.meshes.main.contact_ratio",
        "also cut by tip_shortening",
        "keep",
    ),
    (
        "gearboxes.test.meshes.main.remove = ['tip_cut']",
        "gearboxes.test.meshes.main",
        "belong together",
        "tip_cut",
    ),
    (
        "gearboxes.test.gears.pinion.teeth = 120",
        "gearboxes.test.meshes.main.pinion",
        "has 120 teeth",
        "fewer teeth",
    ),
    (
        'gearboxes.test.gears.pinion.flank.single_pitch = ["1 um", "2 um"]',
        "gearboxes.test.gears.pinion.flank.single_pitch",
        "the gear has 99 teeth",
        "one entry per tooth",
    ),
    # bearings and shafts
    (
        "gearboxes.test.bearings.pinion_front.locating = true",
        "gearboxes.test.bearings.pinion_front.locating",
        "more than once",
        "one bearing per shaft",
    ),
    (
        'gearboxes.test.bearings.pinion_front.side = "rear"',
        "gearboxes.test.bearings",
        "front and one at the rear",
        "bearings",
    ),
    (
        'gearboxes.test.bearings.pinion_front.diametral_clearance = "4 mm"',
        "gearboxes.test.bearings.pinion_front.diametral_clearance",
        "a twentieth",
        "0.001",
    ),
    (
        'gearboxes.test.gears.pinion.position = "500 mm"',
        "gearboxes.test.gears.pinion.position",
        "beyond the end of the shaft at 368.7 mm",
        "lengthen",
    ),
    # schedule
    (
        'schedule.stages = [{ name = "run_down", speed = "13000 rpm" }]',
        "schedule.stages.run_down.speed",
        "does not fall in a run_down stage",
        "correct the value or the kind",
    ),
    (
        'schedule.stages = [{ name = "run_up", torque = "80 N m" }]',
        "schedule.stages.run_up.torque",
        "changes in a run_up stage",
        "speed up and nothing else",
    ),
    (
        'schedule.stages = [{ name = "half_torque", torque = "90 N m" }]',
        "schedule.stages.half_torque",
        "both torque and torque_share",
        "keep one",
    ),
    (
        'schedule.stages = [{ name = "test", held = false }]',
        "schedule.stages",
        "no stage is held",
        "held = true",
    ),
    (
        'schedule.stages = [{ name = "run_up", held = true }]',
        "schedule.stages.run_up.held",
        "only a dwell",
        "dwell",
    ),
    (
        'schedule.stages = [{ name = "test", drive_torque = "9 N m" }]',
        "schedule.stages.test.drive_torque",
        "is speed controlled",
        "run_up stage only",
    ),
    # losses
    (
        'losses.basis = "input"',
        "losses.given",
        "no loss is given",
        "losses.given",
    ),
    (
        'losses.given.x = { gearbox = "test", kind = "seal", part = "pinon", power = "3 W" }',
        "losses.given.x.part",
        "no such part with seal loss",
        'did you mean "pinion"?',
    ),
    (
        'losses.given.x = { gearbox = "test", kind = "mesh", part = "main", power = "3 W", stages = ["x"] }',
        "losses.given.x.stages",
        "no such stage",
        "known: bracing, to_transition_speed",
    ),
    (
        "gearboxes.test.gears.pinion.profile_shift = nan",
        "gearboxes.test.gears.pinion.profile_shift",
        "finite",
        "a number",
    ),
    (
        "limits.specimen.load_cycles_minimum = inf",
        "limits.specimen.load_cycles_minimum",
        "finite",
        "a number",
    ),
    (
        'materials.soft = { title = "42CrMo4", conductivity = "42 W/(m K)", expansion_coefficient = "11.5e-6 1/K", '
        'elastic_modulus = "206 GPa", poisson_ratio = 0.3, density = "7830 kg/m3", treatment = "through_hardened" }',
        "materials.soft",
        "flank_strength is missing",
        '"700 MPa"',
    ),
    ('losses.friction.law = "doleschel"', "losses.friction.doleschel", "constants of the oil", "schlenk"),
    ('losses.friction.law = "constant"', "losses.friction.coefficient", "needs its coefficient", "0.04"),
    # a computation without end
    (
        'numerics.shaft_element_length = "1 mm"',
        "numerics.shaft_element_length",
        "elements of the shafts, limit 500",
        "write at least",
    ),
    # heat that no motor gives
    (
        'losses = { bearing_drag = "constant", '
        'given.x = { gearbox = "test", kind = "windage", part = "pinion", power = "3 W" } }',
        "losses.given.x.kind",
        "heat without braking",
        "remove the given loss",
    ),
    # nothing to compute
    (
        'numerics.curve_speed_start = "0 rpm"',
        "numerics.curve_speed_start",
        "a rig at rest has no periodic response",
        "500 rpm",
    ),
    (
        'gearboxes.reference.meshes.main.helix_angle = "-18 deg"',
        "gearboxes.reference.meshes.main.helix_angle",
        "is below 0 deg",
        "at least 0 deg",
    ),
    (
        'gearboxes.reference.meshes.main.helix_angle = "50 deg"',
        "gearboxes.reference.meshes.main.helix_angle",
        "is above 45 deg",
        "at most 45 deg",
    ),
    # a shaft on one bearing
    (
        'gearboxes.reference.bearings.wheel_rear.position = "48.13 mm"',
        "gearboxes.reference.bearings.wheel_rear.position",
        "is also where wheel_front holds the shaft",
        "distance of the middle",
    ),
    # a check on a part that is not there
    (
        'limits.bought_parts.torque_flange.part = "drivetrain.couplings.wheel_sid"',
        "limits.bought_parts.torque_flange.part",
        "no such part",
        "drivetrain.couplings.wheel_side",
    ),
    (
        'limits.bought_parts.motor.limit = "20 kW"',
        "limits.bought_parts.motor",
        "one of power, not of torque",
        "180 N m",
    ),
    (
        'limits.specimen.root_stress_minimum = "2 GPa"',
        "limits.specimen",
        "not below root_stress_maximum",
        "exchange",
    ),
    # surfaces
    (
        'gearboxes.test.housing.boundary.chamber_sump.surfaces = ["chamber_flor", "chamber_floor"]',
        "gearboxes.test.housing.boundary.chamber_sump.surfaces",
        "no such surface",
        "did you mean chamber_floor",
    ),
    (
        'gearboxes.test.housing.boundary.chamber_sump.surfaces = ["chamber_*"]',
        "gearboxes.test.housing.boundary.chamber_sump.surfaces",
        "already has chamber_oil",
        "name it once",
    ),
    (
        'gearboxes.test.housing.boundary.shaft_seal.partner = "seal_hole_*_*"',
        "gearboxes.test.housing.boundary.shaft_seal.partner",
        "no such surface",
        "did you mean seal_bore",
    ),
    # housing
    (
        'gearboxes.test.housing.shafts.test_wheel.lateral_position = "60 mm"',
        "gearboxes.test.meshes.main.centre_distance",
        "109.75 mm apart",
        "lateral_position",
    ),
    (
        'gearboxes.test.housing.width = "120 mm"',
        "gearboxes.test.housing",
        "enlarge the housing",
        "measures of the housing",
    ),
    # numerics
    (
        'numerics.curve_speed_end = "400 rpm"',
        "numerics.curve_speed_start",
        "is not below",
        "exchange",
    ),
    ("numerics.internal_steps = 2", "numerics.internal_steps", "greater than or equal to 4", "at least 4"),
]


@pytest.mark.parametrize(("text", "path", "problem", "remedy"), BAD, ids=[text[:60] for text, *_ in BAD])
def test_fault_names_key_value_limit_and_remedy(
    tmp_path: Path, text: str, path: str, problem: str, remedy: str
) -> None:
    found = {fault.path: fault for fault in faults(tmp_path, text)}
    assert path in found
    assert problem in found[path].problem
    assert remedy in found[path].remedy


def test_all_faults_of_a_file_at_once(tmp_path: Path) -> None:
    found = faults(
        tmp_path,
        """
        ambient.temperature = 20
        gearboxes.test.oil.flwo = "5 l/min"
        gearboxes.reference.gears.wheel.face_width = "-40 mm"
        losses.chamber_density = { value = "5 kg/m3", assumed = "so", range = ["6 kg/m3", "7 kg/m3"] }
        """,
    )
    assert [fault.path for fault in found] == [
        "ambient.temperature",
        "gearboxes.test.oil.flwo",
        "gearboxes.reference.gears.wheel.face_width",
        "losses.chamber_density (range)",
    ]
    assert found[2].given == '"-40 mm"'


def test_message_lists_every_fault_on_its_line(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(f'extends = "{PROTOTYPE.as_posix()}"\nambient.temperature = 20\nname = "No"\n')
    with pytest.raises(CaseError) as caught:
        load_case(file)
    lines = str(caught.value).splitlines()
    assert lines[0].endswith("2 faults")
    assert (
        lines[2].strip().startswith("ambient.temperature = 20: a bare number without a unit; give it a unit")
    )


def test_truncated_file_is_named_with_its_place(tmp_path: Path) -> None:
    content = PROTOTYPE.read_bytes()
    file = tmp_path / "case.toml"
    file.write_bytes(content[: content.index(b"[gearboxes.test.oil]") + 12])
    with pytest.raises(CaseError, match=r"case\.toml.*cut off.*end of document") as caught:
        load_case(tmp_path)
    assert caught.value.exit_code == 2


def test_file_cut_between_tables_lists_what_is_missing(tmp_path: Path) -> None:
    content = PROTOTYPE.read_text(encoding="utf-8")
    (tmp_path / "case.toml").write_text(content[: content.index("[losses]")], encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path)
    missing = {fault.path for fault in caught.value.faults}
    assert {"schedule"} <= missing


def test_file_that_is_no_text(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(b'name = "\xff\xfe"\n')
    with pytest.raises(CaseError, match="UTF-8"):
        load_case(tmp_path)


def test_missing_file_and_empty_folder(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="no such file or folder"):
        load_case(tmp_path / "nowhere")
    with pytest.raises(CaseError, match=r"no case\.toml in this folder"):
        load_case(tmp_path)


@pytest.mark.parametrize("extends", ["3", '"nowhere.toml"'])
def test_extends_that_leads_nowhere(tmp_path: Path, extends: str) -> None:
    (tmp_path / "case.toml").write_text(f"extends = {extends}\n")
    with pytest.raises(CaseError, match="extends"):
        load_case(tmp_path)


def test_a_seal_sits_on_a_shaft_with_bearings_in_its_gearbox() -> None:
    """Without a housing any shaft of the drivetrain once passed, and nothing carried the seal."""
    loop = load_case(PROTOTYPE.parents[1] / "loop_1to1")
    with pytest.raises(CaseError) as caught:
        loop.with_value("gearboxes.test.seals.pinion.shaft", "reference_pinion")
    assert caught.value.faults[0].path == "gearboxes.test.seals.pinion.shaft"
    assert "test_pinion" in str(caught.value)


def test_seals_of_one_shaft_on_the_other_are_two_faults() -> None:
    """The films of a housing whose shaft has no seals are not looked for: the rules name what is missing."""
    with pytest.raises(CaseError) as caught:
        load_case(CASES / "uhcf_prototype").with_value("gearboxes.test.seals.wheel.shaft", "test_pinion")
    assert str(caught.value).count("needs one table of seals") == 2


@pytest.mark.parametrize("text", ["remove = [[[[]]]]", "remove = [{}]", "ambient.remove = [1]"])
def test_what_is_no_list_of_keys_removes_nothing(tmp_path: Path, text: str) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(f'extends = "{PROTOTYPE.as_posix()}"\n{text}\n')
    with pytest.raises(CaseError, match="not a list of inherited keys"):
        load_case(file)


def test_a_stage_whose_name_is_no_text_is_a_fault(tmp_path: Path) -> None:
    found = faults(tmp_path, "[[schedule.stages]]\nname = [[]]\nkind = 'dwell'\n")
    assert any("name" in fault.path for fault in found)


def test_losses_need_a_drivetrain_or_to_be_given(tmp_path: Path) -> None:
    text = 'remove = ["drivetrain"]\ngearboxes.remove = ["reference"]'
    found = {fault.path: fault for fault in faults(tmp_path, text)}
    assert "with a drivetrain" in found["losses.basis"].problem
    assert "[drivetrain]" in found["losses.basis"].remedy


def test_constant_drag_needs_its_value_at_every_bearing(tmp_path: Path) -> None:
    text = """
    losses.bearing_drag = "constant"
    gearboxes.test.bearings.pinion_front.remove = ["torsional_damping"]
    """
    assert [fault.path for fault in faults(tmp_path, text)] == [
        "gearboxes.test.bearings.pinion_front.torsional_damping"
    ]


@pytest.mark.parametrize(
    ("stage", "words"),
    [
        ('{ name = "rest", kind = "dwell", duration = "1 s", held = true }', "its speed is 0 rpm"),
        (
            '{ name = "up", kind = "run_up", speed = "500 rpm", duration = "1 s" }, '
            '{ name = "idle", kind = "dwell", duration = "1 s", held = true }',
            "its torque is 0 N m",
        ),
    ],
)
def test_a_held_stage_turns_under_load(tmp_path: Path, stage: str, words: str) -> None:
    found = faults(tmp_path, f"[schedule]\nremove = ['stages']\nstages = [{stage}]\n")
    assert any(fault.path.endswith(".held") and words in fault.problem for fault in found)


OIL = 'title = "o"\nkinematic_viscosity_40 = "95 mm2/s"\nkinematic_viscosity_100 = "10 mm2/s"\n'
OIL += 'density_15 = "870 kg/m3"\nheat_capacity = "2000 J/(kg K)"\nconductivity = "0.13 W/(m K)"\n'
STEEL = 'title = "m"\nconductivity = "45 W/(m K)"\nexpansion_coefficient = "11.5e-6 1/K"\nelastic_modulus = "206 GPa"\n'
STEEL += 'poisson_ratio = 0.3\ndensity = "7850 kg/m3"\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[oils.o]\n" + OIL.replace("870", "0.87"), 'oils.o.density_15 = "0.87 kg/m3": is below 400 kg/m3'),
        (
            "[oils.o]\n" + OIL.replace("2000 J", "2000 kJ"),
            'heat_capacity = "2000 kJ/(kg K)": is above 10 kJ/(kg K)',
        ),
        ("[oils.o]\n" + OIL.replace("2000 J", "2 J"), 'heat_capacity = "2 J/(kg K)": is below 500 J/(kg K)'),
        (
            "[oils.o]\n" + OIL.replace("10 mm2", "0.29 mm2"),
            'kinematic_viscosity_100 = "0.29 mm2/s": is below 0.3',
        ),
        (
            "[materials.m]\n" + STEEL.replace("206 GPa", "2100 GPa"),
            'elastic_modulus = "2100 GPa": is above 1200 GPa',
        ),
        (
            "[materials.m]\n" + STEEL.replace("206 GPa", "206 MPa"),
            'elastic_modulus = "206 MPa": is below 0.5 GPa',
        ),
        ("[materials.m]\n" + STEEL.replace("7850", "7.85"), 'density = "7.85 kg/m3": is below 100 kg/m3'),
        ('gearboxes.test.oil.flow = "1e-9 l/min"', 'test.oil.flow = "1e-9 l/min": is below 0.001 l/min'),
        (
            'gearboxes.test.gears.pinion.spline.torsional_stiffness = "1 N m/rad"',
            "pinion.spline.torsional_stiffness = 1 N m/rad: twists by 180 rad under schedule.test_torque, limit 1 rad",
        ),
        (
            'gearboxes.test.meshes.main.centre_distance = "110 mm"',
            "centre_distance = 110 mm: asks for a sum of the profile shifts of 12.1, limits -2 and 2.5: without shifts",
        ),
        (
            'gearboxes.test.bearings.pinion_rear.side = "front"',
            "shaft test_pinion needs a bearing at the front and one at the rear, has pinion_front at the front",
        ),
        (
            'schedule.test_speed = "6000 rpm"',
            "test_speed = 6000 rpm: no held stage runs at it, they have 12000 rpm",
        ),
        ('schedule.stages = [{ name = "full_torque", torque_share = 0.9 }]', "no held stage runs at it"),
        ('title = "two\\nlines"', 'title = "two\nlines": has more than one line'),
        ('title = "ab\\u202ecd"', r"holds the control character '\u202e'"),
        ("gearboxes.test.gears.pinion.teeth = " + "9" * 5000, "holds a whole number of too many digits"),
        (".".join(["a"] * 2000) + " = 1", "is nested more than 30 tables deep"),
    ],
)
def test_one_fault_where_it_is(tmp_path: Path, text: str, said: str) -> None:
    """What ended as a defect, or under the name of what follows from it."""
    file = tmp_path / "bad.toml"
    file.write_text(f'extends = "{PROTOTYPE.as_posix()}"\n{text}', encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert said in str(caught.value)
    assert len(caught.value.faults) <= 1


def test_a_byte_order_mark_is_read_over(tmp_path: Path) -> None:
    file = tmp_path / "marked.toml"
    file.write_bytes(b"\xef\xbb\xbf" + f'extends = "{PROTOTYPE.as_posix()}"\n'.encode())
    assert load_case(file).name


def test_a_message_stays_readable_with_a_thousand_faults(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    keys = "".join(f"limits.no_such_key_{number} = 1\n" for number in range(1000))
    file.write_text(f'extends = "{PROTOTYPE.as_posix()}"\n{keys}', encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert len(caught.value.faults) == 1000
    assert "1000 faults" in str(caught.value) and "and 950 more" in str(caught.value)
    assert len(str(caught.value)) < 50_000

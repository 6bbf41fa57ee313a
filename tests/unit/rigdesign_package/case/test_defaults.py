"""What a case leaves out: defaults are marked, follow the rest of the case, and never touch what is stated."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.graph import assemble
from rigdesign.base.errors import CaseError
from rigdesign.base.units import parse
from rigdesign.case import Case, load_case
from rigdesign.case.defaults.fill import rules, with_defaults
from rigdesign.case.defaults.rule import BY_THE_TOOL, Given, RawTree
from rigdesign.case.defaults.runs import _response_period
from rigdesign.case.geometry import housing_geometry
from rigdesign.case.loader import changed_together
from rigdesign.case.shipped import shipped_cases
from rigdesign.rig.model import build_rig
from tests.builders.minimal_case import MINIMAL, MOST_LINES, minimal_case
from tests.builders.paths import ROOT

STRUCTURE = ("surfaces", "name", "kind", "held", "speed", "title", "part", "quantity", "source")
"""Keys inside of a default table that say what it is about."""


@pytest.fixture(scope="module")
def minimal(tmp_path_factory: pytest.TempPathFactory) -> Case:
    return load_case(minimal_case(tmp_path_factory.mktemp("minimal")))


def _paths(tree: Any, path: str = "") -> Iterator[str]:
    if isinstance(tree, Mapping):
        for key, value in tree.items():
            yield from _paths(value, f"{path}.{key}" if path else key)
    else:
        yield path


def test_the_minimal_case_is_short() -> None:
    assert len(MINIMAL.splitlines()) <= MOST_LINES


@pytest.mark.parametrize("name", sorted(set(shipped_cases()) - {"fzg", "strain_gauge_rig"}))
def test_shipped_cases_state_everything(name: str) -> None:
    """A default in one of them would move its results with the tool; the two others are there to show the defaults."""
    for file in sorted(shipped_cases()[name].glob("*.toml")):
        case = load_case(file)
        assert case.origin.tree == case.origin.stated, file


def test_every_default_says_that_it_is_one(minimal: Case) -> None:
    """What the file does not state has a mark of the tool, names inside of default tables aside."""
    stated = set(_paths(minimal.origin.stated))
    marks = minimal.origin.mark_of
    silent = [
        row.path
        for row in minimal.inputs
        if row.path not in stated
        and row.path.rpartition(".")[2] not in STRUCTURE
        and not any(mark.basis.startswith((BY_THE_TOOL, f"assumed: {BY_THE_TOOL}")) and _covers(path, row.path)
                    for path, mark in marks.items())
    ]  # fmt: skip
    assert silent == []


def _covers(mark: str, path: str) -> bool:
    return path == mark or path.startswith(f"{mark}.")


def test_assumed_numbers_have_a_range_around_them(minimal: Case) -> None:
    """Settings of the solver, choices and sizes that others depend on have none."""
    assumed = {record.path: record for record in minimal.assumptions}
    for key in ("tooth_thinning", "quality_grade", "flank_roughness"):
        assert assumed[f"gearboxes.test.gears.pinion.{key}"].range is not None
    ratio = assumed["gearboxes.test.meshes.main.damping_ratio"]
    assert ratio.range == (0.02, 0.1)
    assert assumed["gearboxes.test.housing.boundary.rims.film_factor"].range == (0.5, 2.0)
    assert all(record.range is None for path, record in assumed.items() if path.startswith("numerics."))


def test_what_is_stated_is_never_touched(tmp_path: Path) -> None:
    more = '\n[gearboxes.test.bearing_oil]\noil = "FVA 3A"\n[ambient]\ntemperature = "31 degC"\n'
    case = load_case(minimal_case(tmp_path, more))
    filled = with_defaults(case.origin.stated)
    assert filled["ambient"] == {"temperature": "31 degC"}
    assert filled["gearboxes"]["test"]["bearing_oil"]["oil"] == "FVA 3A"
    assert with_defaults(filled) == filled


def test_defaults_follow_the_rest_of_the_case(minimal: Case) -> None:
    faster = minimal.with_value("schedule.test_speed", "3000 rpm")
    up = next(stage for stage in faster.schedule.stages if stage.name == "run_up")
    assert up.speed == pytest.approx(parse("3000 rpm", "speed"))
    assert faster.numerics.curve_speed_end == pytest.approx(1.5 * parse("3000 rpm", "speed"))
    assert minimal.gearboxes["test"].gears["pinion"].tooth_thinning == pytest.approx(0.015 * 4.5e-3)
    assert minimal.drivetrain is not None and minimal.drivetrain.motor.torque_limit == pytest.approx(
        0.1 * 372.6 * 24 / 16, rel=1e-2
    )


def test_stated_films_add_to_the_standard_ones(tmp_path: Path, minimal: Case) -> None:
    """Surfaces of a stated film leave the standard one, all others keep theirs; each can still be varied by path."""
    at = "gearboxes.test.housing.boundary"
    file = minimal_case(tmp_path)
    text = f'[{at}.wet]\nsurfaces = ["gear_test_pinion_side_*"]\nlaw = "insulated"\n'
    file.write_text(file.read_text(encoding="utf-8") + text, encoding="utf-8")
    stated = load_case(file)
    standard, found = (case.gearboxes["test"].housing.boundary for case in (minimal, stated))  # type: ignore[union-attr]
    assert set(found) == {*standard, "wet"}
    assert set(found["sides"].surfaces) == {"gear_test_wheel_side_front", "gear_test_wheel_side_rear"}
    assert any(record.path == f"{at}.rims.film_factor" for record in stated.assumptions)
    varied = stated.with_value(f"{at}.rims.film_factor", 0.5).gearboxes["test"].housing.boundary  # type: ignore[union-attr]
    assert set(varied) == set(found) and varied["rims"].film_factor == 0.5  # type: ignore[union-attr]


def test_a_pinion_may_be_cut_into_its_shaft(tmp_path: Path) -> None:
    """Its shaft is as thick in it as in the bearings; the root is that of a solid gear."""
    solid = 'gears.pinion = { bore_diameter = "0 mm",'
    file = minimal_case(tmp_path)
    file.write_text(file.read_text(encoding="utf-8").replace("gears.pinion = {", solid, 1), encoding="utf-8")
    box = load_case(file).gearboxes["test"]
    assert box.gears["pinion"].bore_diameter == 0.0 and box.seat_diameter("pinion") == pytest.approx(30e-3)
    pinion, wheel = housing_geometry(box).shafts
    assert pinion.seat_diameter == pytest.approx(30e-3) and wheel.seat_diameter == pytest.approx(30e-3)


def test_a_default_can_be_varied_by_its_path(minimal: Case) -> None:
    """Also where its whole table is left out; what is beside it stays as it was."""
    changed = changed_together(
        minimal,
        {"gearboxes.test.housing.boundary.rims.film_factor": 0.5, "schedule.stages.run_up.duration": "9 s"},
    )
    housing = changed.gearboxes["test"].housing
    assert housing is not None and housing.boundary["rims"].film_factor == 0.5  # type: ignore[union-attr]
    assert set(housing.boundary) == set(minimal.gearboxes["test"].housing.boundary)  # type: ignore[union-attr]
    assert [stage.duration for stage in changed.schedule.stages if stage.name == "run_up"] == [9.0]
    assert len(changed.schedule.stages) == len(minimal.schedule.stages)


def test_one_key_of_a_part_may_be_stated_alone(tmp_path: Path) -> None:
    """The other shafts, and the other keys of this one, stay those of the tool; a misspelt shaft stays a fault."""
    more = '\n[drivetrain.shafts.test_wheel]\nmaterial = "structural_steel"\n'
    power = load_case(minimal_case(tmp_path, more)).drivetrain
    assert power is not None and len(power.shafts) == 4
    assert power.shafts["test_wheel"].material == "structural_steel" and power.shafts["test_wheel"].sections
    with pytest.raises(CaseError, match=r"drivetrain\.shafts"):
        load_case(minimal_case(tmp_path, more.replace("test_wheel", "test_weel")))


def test_bearings_sit_in_their_walls_and_gears_between_them(minimal: Case) -> None:
    box = minimal.gearboxes["test"]
    places = [box.bearings[f"pinion_{side}"].position or 0.0 for side in ("front", "rear")]
    assert places == pytest.approx([0.0, 0.116 + 0.0225])
    assert box.gears["pinion"].position == pytest.approx(0.5 * sum(places))
    assert box.housing is not None
    walls = {name: shaft.lateral_position for name, shaft in box.housing.shafts.items()}
    assert walls == pytest.approx({"test_pinion": -0.04575, "test_wheel": 0.04575})


def test_no_limits_at_all_means_the_standard_set(minimal: Case, tmp_path: Path) -> None:
    assert minimal.limits.dynamics.dynamic_factor_maximum == 1.5
    own = "\n[limits.dynamics]\ndynamic_factor_maximum = 1.2\n"
    alone = load_case(minimal_case(tmp_path, own)).limits
    assert alone.dynamics.dynamic_factor_maximum == 1.2
    assert alone.strength.root_safety_minimum is None
    both = load_case(minimal_case(tmp_path, f"\n[limits]\nstandard_set = true\n{own}")).limits
    assert both.dynamics.dynamic_factor_maximum == 1.2 and both.strength.root_safety_minimum == 1.4


def test_a_dipping_pair_gets_its_sump(tmp_path: Path) -> None:
    text = MINIMAL.replace(
        'oil = { oil = "FVA 3", inlet_temperature = "90 degC" }',
        'oil = { lubrication = "dip", oil = "FVA 3", level = "0 mm", sump_temperature = "90 degC" }',
    )
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    case = load_case(tmp_path)
    for name, litres in (("test", 1.51), ("slave", 1.82)):
        sump = case.gearboxes[name].sump
        assert sump is not None and 1e3 * sump.volume == pytest.approx(litres, rel=0.05), name
    assert all(seals.kind == "radial_lip" for box in case.gearboxes.values() for seals in box.seals.values())


def test_losses_that_are_given_need_no_drivetrain(tmp_path: Path) -> None:
    more = (
        '\n[losses]\nbasis = "input"\n[losses.given.mesh]\ngearbox = "test"\nkind = "mesh"\npart = "main"\n'
        'power = "900 W"\n'
    )
    box = """
[gearboxes.test.housing.shafts]
test_pinion = { overhang_front = "0 mm", overhang_rear = "40 mm" }
test_wheel = { overhang_front = "0 mm", overhang_rear = "40 mm" }
"""
    assert load_case(minimal_case(tmp_path, more + box)).drivetrain is None


@pytest.mark.parametrize("seed", range(len(MINIMAL.splitlines())))
def test_any_line_may_be_missing(tmp_path: Path, seed: int) -> None:
    """A rule that misses what it needs knows no default; the fault names the key that is missing."""
    lines = MINIMAL.splitlines()
    (tmp_path / "case.toml").write_text("\n".join(lines[:seed] + lines[seed + 1 :]), encoding="utf-8")
    try:
        load_case(tmp_path)
    except CaseError as error:
        assert error.faults or "TOML" in str(error)


def test_rules_find_their_places() -> None:
    """Every path of a rule leads to a key of the schema."""
    from rigdesign.explanation.keys import case_keys, starred

    known = {starred(entry.path) for entry in case_keys()}
    known |= {path.replace(".*.*", ".*") for path in known}
    assert [rule.path for rule in rules() if rule.path not in known] == []


@pytest.mark.parametrize(
    ("without", "more", "words"),
    [
        ("", "\n[gearboxes.slave.meshes.main]\ndamping = \"1 N s/m\"\ndamping_ratio = 0.05\n", "both of damping and"),
        ("", "\n[gearboxes.third]\nlike = \"tset\"\n", 'did you mean "test"?'),
        ("", "\n[gearboxes.third]\nlike = \"fourth\"\n[gearboxes.fourth]\nlike = \"third\"\n", "is like itself"),
        ("", "\n[gearboxes.third]\nlike = 3\n", "is no name"),
        ('test_torque = "372.6 N m"\n', "", "schedule.test_torque: a required key is missing"),
        ('all_bearings = { diameter = "30 mm" }\n', "", "gearboxes.test.bearings: a required key is missing"),
        ('normal_module = "4.5 mm", ', "", "gearboxes.test.meshes.main.normal_module: a required key is missing"),
    ],
)  # fmt: skip
def test_a_minimal_case_that_contradicts_itself(tmp_path: Path, without: str, more: str, words: str) -> None:
    with pytest.raises(CaseError) as caught:
        load_case(minimal_case(tmp_path, more, without=without))
    assert words in str(caught.value)


def test_a_fault_of_equal_parts_is_said_once_where_it_was_written(tmp_path: Path) -> None:
    text = MINIMAL.replace('diameter = "30 mm"', 'diameter = "30"').replace('"91.5 mm"', '"915 um"')
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path)
    bearings = [fault.path for fault in caught.value.faults if "bearings" in fault.path and fault.given]
    assert bearings == ["gearboxes.test.all_bearings.diameter"]
    assert not any(fault.path.startswith("gearboxes.slave.gears") for fault in caught.value.faults)


def test_an_equal_gearbox_takes_over_all_but_its_own(minimal: Case) -> None:
    test, slave = minimal.gearboxes["test"], minimal.gearboxes["slave"]
    assert (test.role, slave.role) == ("specimen", "rig")
    assert slave.housing is None and slave.oil == test.oil
    assert slave.gears["wheel"].shaft == "slave_wheel" and slave.gears["wheel"].face_width == 0.040
    assert slave.gears["pinion"].profile_shift == test.gears["pinion"].profile_shift
    assert {bearing.shaft for bearing in slave.bearings.values()} == {"slave_pinion", "slave_wheel"}


def test_shafts_that_are_named_are_renamed(tmp_path: Path) -> None:
    more = '\n[gearboxes.test.seals.one]\nshaft = "test_pinion"\n[gearboxes.test.seals.two]\nshaft = "test_wheel"\n'
    seals = load_case(minimal_case(tmp_path, more)).gearboxes["slave"].seals
    assert {name: seal.shaft for name, seal in seals.items()} == {"one": "slave_pinion", "two": "slave_wheel"}


def test_the_locked_power_is_that_of_the_file(minimal: Case) -> None:
    """2250 rpm and 372.6 N m: 87.8 kW circulate; the default of the jet carries one per cent of it at 10 K."""
    power = minimal.schedule.test_speed * minimal.schedule.test_torque
    assert power == pytest.approx(87.8e3, rel=1e-3)
    jets = minimal.gearboxes["test"].jets
    assert jets is not None and math.isclose(jets.flow * 870.0 * 2000.0 * 10.0, 0.01 * power, rel_tol=0.01)


def test_one_of_the_bearings_may_differ(tmp_path: Path) -> None:
    """By its name alone, or as a bearing of another name that says where it sits."""
    more = '\n[gearboxes.test.bearings.pinion_rear]\nshell_conductance = "5000 W/(m2 K)"\n'
    more += '[gearboxes.test.bearings.end]\nshaft = "test_wheel"\nside = "rear"\nlocating = true\n'
    bearings = load_case(minimal_case(tmp_path, more)).gearboxes["test"].bearings
    assert sorted(bearings) == ["end", "pinion_front", "pinion_rear", "wheel_front"]
    assert bearings["pinion_rear"].shell_conductance == pytest.approx(5000.0)
    assert (bearings["pinion_rear"].shaft, bearings["pinion_rear"].side) == ("test_pinion", "rear")
    assert {bearing.diameter for bearing in bearings.values()} == {0.03}


def test_a_gear_in_two_meshes_splits_neither_where_it_states_its_shift(tmp_path: Path) -> None:
    """The split of a mesh is settled by the shift of either of its own gears, whatever other mesh they are in."""
    more = """
[gearboxes.test.gears.second]
teeth = 24
face_width = "14 mm"
[gearboxes.test.meshes.other]
pinion = "pinion"
wheel = "second"
normal_module = "4.5 mm"
centre_distance = "91.5 mm"
"""
    (tmp_path / "case.toml").write_text(MINIMAL + more, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path)
    assert not any("profile shifts" in fault.problem for fault in caught.value.faults)


def _loop(first: tuple[int, int], second: tuple[int, int], near: str = "pinion") -> RawTree:
    """Two gearboxes; near : gear of the second one on the shaft of the first one's wheel."""
    boxes = {
        name: {
            "gears": {
                gear: {"teeth": number, "shaft": f"{name}_{gear}"}
                for gear, number in zip(("pinion", "wheel"), teeth, strict=True)
            },
            "meshes": {"main": {"pinion": "pinion", "wheel": "wheel"}},
        }
        for name, teeth in (("test", first), ("slave", second))
    }
    couplings = {"line": {"shafts": ["test_wheel", f"slave_{near}"]}}
    return RawTree({"gearboxes": boxes, "drivetrain": {"torque_at": "test.wheel", "couplings": couplings}})


@pytest.mark.parametrize(
    ("tree", "period"),
    [
        (_loop((16, 24), (16, 24), "wheel"), None),
        (_loop((18, 18), (28, 28), "wheel"), "revolution"),
        (_loop((16, 24), (32, 48), "wheel"), "revolution"),
        # two stages: 17 * 16 / 24 teeth in a turn
        (_loop((16, 24), (17, 30)), "hunting_cycle"),
        (_loop((16, 24), (24, 30)), None),
        (RawTree({}), None),
    ],
)
def test_period_of_the_response_fits_the_tooth_numbers(tree: RawTree, period: str | None) -> None:
    found = _response_period(tree)
    assert (found.value if isinstance(found, Given) else found) == period


def test_a_loop_of_18_and_28_teeth_is_sought_over_a_revolution(tmp_path: Path) -> None:
    text = (shipped_cases()["strain_gauge_rig"] / "case.toml").read_text(encoding="utf-8")
    file = tmp_path / "case.toml"
    file.write_text("".join(row for row in text.splitlines(True) if not row.startswith("response_period")))
    case = load_case(file)
    assert case.numerics.response_period == "revolution"
    assert "pass 18, 28 teeth in a turn" in case.origin.mark_of["numerics.response_period"].basis


def test_changing_a_default_coupling_leaves_the_halves_on_the_shafts() -> None:
    case = load_case(ROOT / "cases" / "fzg")
    changed = changed_together(case, {"drivetrain.couplings.pinion_side.torsional_stiffness": "5e5 N m/rad"})
    assert case.drivetrain is not None and changed.drivetrain is not None
    assert {name: shaft.discs for name, shaft in changed.drivetrain.shafts.items()} == {
        name: shaft.discs for name, shaft in case.drivetrain.shafts.items()
    }


OF_A_SIZE = """\
schema_version = 1
name = "size"
[gearboxes.test]
oil = {{ oil = "FVA 3", inlet_temperature = "60 degC" }}
all_bearings = {{ diameter = "{shaft:.4g} mm" }}
gears.pinion = {{ teeth = {teeth[0]}, face_width = "{width} mm", bore_diameter = "{shaft:.4g} mm" }}
gears.wheel = {{ teeth = {teeth[1]}, face_width = "{width} mm" }}
meshes.main = {{ normal_module = "{module} mm", centre_distance = "{distance} mm" }}
[gearboxes.slave]
like = "test"
[schedule]
test_speed = "{speed} rpm"
test_torque = "{torque:.4g} N m"
"""


@pytest.mark.parametrize("teeth", [(20, 30), (25, 100)])
@pytest.mark.parametrize("speed", [500, 15000])
@pytest.mark.parametrize("module", [1, 4, 25])
def test_defaults_of_every_size_load_and_fit_each_other(
    tmp_path: Path, module: int, speed: int, teeth: tuple[int, int]
) -> None:
    """Places stay within their bounds, and half of the motor's torque carries the steepest part of the run-up."""
    text = OF_A_SIZE.format(
        module=module, speed=speed, teeth=teeth, width=10 * module, shaft=0.5 * module * teeth[0],
        distance=0.5 * module * sum(teeth), torque=5.0 * module**3,
    )  # fmt: skip
    (tmp_path / "case.toml").write_text(text)
    rig = build_rig(load_case(tmp_path), "quick")
    assert rig.drivetrain is not None and rig.case.drivetrain is not None
    system = assemble(rig.drivetrain)
    shafts = [name.partition("/")[0] for name in system.dofs]
    ratios = np.array([rig.shaft_speed(shaft, 1.0) for shaft in shafts]) / rig.drive_speed(1.0)
    run_up = next(stage for stage in rig.case.schedule.resolved() if stage.kind == "run_up")
    steepest = 1.875 * rig.drive_speed(run_up.speed_end) / run_up.duration
    torque = float(ratios @ system.inertia @ ratios) * steepest
    assert torque < 0.75 * rig.case.drivetrain.motor.torque_limit

"""Loading a case: values in SI, marks, variants, hash, changed values, paths."""

import pickle
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import Case, load_case
from rigdesign.case.paths import known_paths, slot_at
from rigdesign.case.provenance import MeasuredInput
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
Variant = Callable[[str], Path]


@pytest.fixture(scope="module")
def prototype() -> Case:
    return load_case(PROTOTYPE)


@pytest.fixture
def variant(tmp_path: Path) -> Variant:
    """Write a case file that extends the prototype."""

    def write(text: str) -> Path:
        file = tmp_path / "variant.toml"
        file.write_text(f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\n{text}', encoding="utf-8")
        return file

    return write


def test_folder_and_file_are_the_same_case(prototype: Case) -> None:
    assert load_case(PROTOTYPE / "case.toml").hash == prototype.hash
    assert prototype.path == PROTOTYPE / "case.toml"


def test_values_are_in_si(prototype: Case) -> None:
    test = prototype.gearboxes["test"]
    assert test.meshes["main"].centre_distance == pytest.approx(0.0995)
    assert test.oil.inlet_temperature == pytest.approx(413.15)
    assert test.oil.flow == pytest.approx(5e-3 / 60.0)
    assert prototype.schedule.test_speed == pytest.approx(1256.637061)
    assert prototype.drivetrain is not None
    assert prototype.drivetrain.couplings["pinion_side"].torsional_stiffness == 138e3
    assert prototype.limits.bought_parts["rig_power"].limit_si == 250e3


def test_case_cannot_be_changed(prototype: Case) -> None:
    with pytest.raises(ValueError, match="frozen"):
        prototype.gearboxes["test"].oil.flow = 1.0  # type: ignore[misc]


def test_stages_start_where_the_one_before_ended(prototype: Case) -> None:
    stages = prototype.schedule.resolved()
    assert (stages[0].speed_start, stages[0].torque_start) == (0.0, 0.0)
    for before, after in pairwise(stages):
        assert (after.speed_start, after.torque_start) == (before.speed_end, before.torque_end)
    half = next(stage for stage in stages if stage.name == "half_torque")
    assert half.torque_end == pytest.approx(90.0)
    assert [stage.name for stage in stages if stage.held] == ["test"]


def test_marks_are_kept_by_path(prototype: Case) -> None:
    assumed = {record.path: record for record in prototype.assumptions}
    density = assumed["losses.chamber_density"]
    assert density.value == "5 kg/m3"
    assert density.range == ("1.2 kg/m3", "20 kg/m3")
    assert "mist" in density.reason
    assert assumed["drivetrain.shafts.test_pinion.sections"].value == "5 entries"
    assert prototype.provenance("drivetrain.couplings.wheel_side.torsional_damping") == "P2, Table 1"
    assert "schedule.stages.run_up.duration" in assumed
    assert prototype.overrides == ()


def test_measured_value_is_listed_as_override(variant: Variant) -> None:
    case = load_case(
        variant(
            '[gearboxes.test.oil]\noutlet_temperature = { value = "151 degC", measured = "thermocouple 7" }'
        )
    )
    assert case.gearboxes["test"].oil.outlet_temperature == pytest.approx(424.15)
    assert case.overrides == (
        MeasuredInput(
            path="gearboxes.test.oil.outlet_temperature", value="151 degC", measured="thermocouple 7"
        ),
    )


def test_variant_is_laid_over_what_it_extends(variant: Variant, prototype: Case) -> None:
    case = load_case(
        variant(
            """
            name = "warmer_room"
            ambient.temperature = "35 degC"
            [[schedule.stages]]
            name = "run_up"
            duration = "10 s"
            """
        )
    )
    assert case.ambient.temperature == pytest.approx(308.15)
    assert case.name == "warmer_room"
    assert len(case.schedule.stages) == len(prototype.schedule.stages)
    assert {stage.name: stage.duration for stage in case.schedule.stages}["run_up"] == 10.0
    assert case.provenance("ambient.temperature") == "input of the case"
    assert case.hash != prototype.hash


def test_variant_removes_what_it_names(variant: Variant) -> None:
    case = load_case(variant('[gearboxes.reference.meshes.main]\nremove = ["contact_ratio", "tip_cut"]'))
    assert case.gearboxes["reference"].meshes["main"].contact_ratio is None
    with pytest.raises(CaseError, match=r"contact_ration.*inherited"):
        load_case(variant('[gearboxes.reference.meshes.main]\nremove = ["contact_ration"]'))


def test_another_law_replaces_the_condition(variant: Variant) -> None:
    case = load_case(
        variant(
            """
            [gearboxes.test.housing.boundary.housing_air]
            law = "iso_tr_14179_2"
            height = "280 mm"
            surfaces = ["outer_warm", "outer_cold_front", "outer_cold_rear"]
            """
        )
    )
    housing = case.gearboxes["test"].housing
    assert housing is not None
    assert housing.boundary["housing_air"].law == "iso_tr_14179_2"


def test_extends_follows_a_chain_and_refuses_a_circle(tmp_path: Path) -> None:
    (tmp_path / "b.toml").write_text(f'extends = "{PROTOTYPE.as_posix()}"\ntitle = "b"\n')
    (tmp_path / "c.toml").write_text('extends = "b.toml"\nname = "c"\n')
    case = load_case(tmp_path / "c.toml")
    assert (case.name, case.title) == ("c", "b")
    (tmp_path / "x.toml").write_text('extends = "y.toml"\n')
    (tmp_path / "y.toml").write_text('extends = "x.toml"\n')
    with pytest.raises(CaseError, match=r"extends itself.*x\.toml.*y\.toml.*x\.toml"):
        load_case(tmp_path / "x.toml")


@pytest.mark.parametrize(
    "name", ["full_addendum", "run_up_simulation", "given_losses", "chamber_radiation", "events"]
)
def test_shipped_variants_load(name: str) -> None:
    case = load_case(PROTOTYPE / f"{name}.toml")
    assert case.name != "uhcf_prototype"
    assert (case.drivetrain is None) == (name == "given_losses")
    assert (case.schedule.simulation_only is None) == (name != "run_up_simulation")


def test_hash_counts_content_not_spelling(variant: Variant, prototype: Case) -> None:
    key = "gearboxes.test.gears.pinion.face_width"

    def hash_of(value: str, source: str) -> str:
        return load_case(variant(f'{key} = {{ value = "{value}", source = "{source}" }}')).hash

    assert hash_of("0.7 cm", "P2, Figure 7") == prototype.hash
    assert hash_of("8 mm", "P2, Figure 7") != prototype.hash
    assert hash_of("7 mm", "a drawing") != prototype.hash


def test_case_survives_pickling(prototype: Case) -> None:
    copy = pickle.loads(pickle.dumps(prototype))
    assert copy.hash == prototype.hash
    assert copy.assumptions == prototype.assumptions


def test_with_value_changes_one_value_of_a_copy(prototype: Case) -> None:
    case = prototype.with_value("gearboxes.test.oil.inlet_temperature", "120 degC")
    assert case.gearboxes["test"].oil.inlet_temperature == pytest.approx(393.15)
    assert prototype.gearboxes["test"].oil.inlet_temperature == pytest.approx(413.15)
    assert case.gearboxes["reference"] == prototype.gearboxes["reference"]
    assert case.hash != prototype.hash
    assert case.path == prototype.path


def test_with_value_changes_all_parts_a_star_stands_for(prototype: Case) -> None:
    case = prototype.with_value("gearboxes.test.bearings.*.diametral_clearance", "100 um")
    changed = [bearing.diametral_clearance for bearing in case.gearboxes["test"].bearings.values()]
    assert changed == pytest.approx([100e-6] * 4)
    kept = [bearing.diametral_clearance for bearing in case.gearboxes["reference"].bearings.values()]
    assert kept == pytest.approx([80e-6] * 4)
    with pytest.raises(CaseError, match=r"bearings\.\*\.clearance: no such path"):
        prototype.with_value("gearboxes.test.bearings.*.clearance", "100 um")


def test_with_value_keeps_the_reason_of_an_assumption(prototype: Case) -> None:
    case = prototype.with_value("losses.chamber_density", "30 kg/m3")
    record = {record.path: record for record in case.assumptions}["losses.chamber_density"]
    assert (record.value, record.range) == ("30 kg/m3", None)
    assert "mist" in record.reason


@pytest.mark.parametrize(
    ("path", "value", "read"),
    [
        ("losses.squeeze_share", "0.1", lambda case: case.losses.squeeze_share == 0.1),
        ("losses.squeeze_share", 0.1, lambda case: case.losses.squeeze_share == 0.1),
        ("numerics.internal_steps", "32", lambda case: case.numerics.internal_steps == 32),
        (
            "gearboxes.test.housing.radiation_included",
            "false",
            lambda case: case.gearboxes["test"].housing.radiation_included is False,
        ),
        ("losses.friction.law", "michaelis", lambda case: case.losses.friction.law == "michaelis"),
        ("schedule.stages.run_up.duration", "9 s", lambda case: case.schedule.stages[3].duration == 9.0),
        (
            "drivetrain.shafts.test_pinion.sections.2.length",
            "64 mm",
            lambda case: case.drivetrain.shafts["test_pinion"].sections[2].length == pytest.approx(0.064),
        ),
        (
            "gearboxes.test.gears.wheel.flank.tip_relief",
            "3 um",
            lambda case: case.gearboxes["test"].gears["wheel"].flank.tip_relief == pytest.approx(3e-6),
        ),
        ("limits.oil.room_heat_maximum", "2 kW", lambda case: case.limits.oil.room_heat_maximum == 2e3),
    ],
)
def test_with_value_reads_texts_as_the_place_wants(
    prototype: Case, path: str, value: object, read: Callable[[Case], bool]
) -> None:
    assert read(prototype.with_value(path, value))


@pytest.mark.parametrize(
    ("path", "meant"),
    [
        ("gearboxes.test.oil.inlet_temprature", "gearboxes.test.oil.inlet_temperature"),
        ("oil.inlet_temperature", "gearboxes.test.oil.inlet_temperature"),
        ("schedule.stages.runup.duration", "schedule.stages.run_up.duration"),
        ("gearboxes.test.oil.inlet_temperature.value", "gearboxes.test.oil.inlet_temperature"),
        ("drivetrain.shafts.test_pinion.sections.7.length", "drivetrain.shafts.test_pinion.sections"),
    ],
)
def test_path_that_does_not_exist_names_the_nearest(prototype: Case, path: str, meant: str) -> None:
    with pytest.raises(CaseError) as caught:
        prototype.with_value(path, "120 degC")
    assert caught.value.exit_code == 2
    assert caught.value.faults[0].path == path
    assert meant in caught.value.faults[0].remedy


def test_changed_case_is_validated(prototype: Case) -> None:
    with pytest.raises(CaseError, match=r"gearboxes\.test\.oil\.flow"):
        prototype.with_value("gearboxes.test.oil.flow", "5 l")
    with pytest.raises(CaseError, match="does not rise"):
        prototype.with_value("schedule.stages.run_up.speed", "700 rpm")


def test_every_known_path_has_a_slot(prototype: Case) -> None:
    tree = prototype.model_dump()
    paths = known_paths(Case, tree)
    assert len(paths) > 500
    assert all(slot_at(Case, tree, path.split(".")) is not None for path in paths)


def test_errors_survive_pickling(prototype: Case) -> None:
    with pytest.raises(CaseError) as caught:
        prototype.with_value("nowhere", "1")
    copy = pickle.loads(pickle.dumps(caught.value))
    assert str(copy) == str(caught.value)
    assert copy.faults == caught.value.faults


@pytest.mark.parametrize(
    ("path", "least", "most"),
    [
        ("drivetrain.bracing.spline_friction_coefficient", 0.0, 1.0),
        ("drivetrain.bracing.temperature_drift", -0.02, 0.02),
        ("gearboxes.test.gears.pinion.flank.weak_tooth.stiffness", 0.0, 1.0),
        ("gearboxes.test.gears.pinion.inertia_factor", 0.1, 10.0),
        ("gearboxes.test.meshes.main.stiffness_factor", 0.1, 10.0),
        ("gearboxes.test.meshes.main.friction_factor", 0.0, 10.0),
        ("gearboxes.test.meshes.main.application_factor", 1.0, 5.0),
        ("losses.squeeze_share", 0.0, 0.1),
    ],
)
def test_a_number_may_reach_its_limits_and_not_pass_them(
    prototype: Case, path: str, least: float, most: float
) -> None:
    for inside in (least, most):
        prototype.with_value(path, inside)
    for outside in (least - 1e-3, most + 1e-3):
        with pytest.raises(CaseError, match=path):
            prototype.with_value(path, outside)


def test_who_answers_for_the_report_changes_no_result(variant: Variant, prototype: Case) -> None:
    """The table document is an input like others, and the hash leaves it out."""
    case = load_case(
        variant(
            """
            [document]
            project = "P 17"
            number = "D-1"
            author = "A. Engineer"
            checked_by = { value = "B. Other", source = "quality manual" }
            """
        )
    )
    assert case.document.author == "A. Engineer"
    assert {row.path: row.value for row in case.inputs}["document.checked_by"] == "B. Other"
    assert case.hash == prototype.hash

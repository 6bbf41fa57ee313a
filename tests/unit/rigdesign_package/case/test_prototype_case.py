"""The shipped case: what P2 prints stands in it, its parts fit together, its README lists every number."""

import importlib.util
import math
from types import ModuleType

import pytest

from dynamics.rotor.shaft import Disc, Section, Shaft, free_frequencies
from rigdesign.case import Case, load_case
from rigdesign.case.geometry import housing_geometry
from rigdesign.case.paths import known_paths
from tests.builders.paths import CASES

FOLDER = CASES / "uhcf_prototype"
TABLE_2 = {
    "test_pinion": (4022.7, 5657.2, 7776.4),
    "test_wheel": (5926.7, 9482.0, 12831.0),
    "reference_pinion": (4887.5, 7763.9, 9646.9),
    "reference_wheel": (3563.9, 5092.0, 6895.0),
}
"""Torsional frequencies [Hz], P2 Table 2."""
PRINTED = [
    # P2, Figure 7
    ("gearboxes.test.meshes.main.normal_module", 1e-3),
    ("gearboxes.reference.meshes.main.normal_module", 0.95e-3),
    ("gearboxes.reference.meshes.main.helix_angle", math.radians(18.0)),
    ("gearboxes.test.meshes.main.centre_distance", 99.5e-3),
    ("gearboxes.test.gears.pinion.face_width", 7e-3),
    ("gearboxes.test.gears.wheel.face_width", 15e-3),
    ("gearboxes.test.gears.pinion.flank.profile_crowning", 7e-6),
    ("gearboxes.test.gears.wheel.flank.lead_crowning", 0.0),
    ("gearboxes.reference.gears.wheel.flank.lead_crowning", 5e-6),
    ("schedule.test_torque", 180.0),
    # P2, Table 1
    ("drivetrain.couplings.wheel_side.torsional_stiffness", 290e3),
    ("drivetrain.couplings.wheel_side.torsional_damping", 600.0),
    ("drivetrain.couplings.pinion_side.torsional_stiffness", 138e3),
    ("drivetrain.couplings.pinion_side.torsional_damping", 300.0),
    ("gearboxes.reference.gears.wheel.spline.torsional_stiffness", 1e6),
    ("gearboxes.reference.gears.wheel.spline.torsional_damping", 1e3),
    ("gearboxes.test.bearings.wheel_rear.torsional_damping", 7e-4),
    ("gearboxes.test.bearings.wheel_rear.radial_stiffness", 1e8),
    ("gearboxes.test.bearings.wheel_rear.radial_damping", 4e4),
    ("gearboxes.reference.meshes.main.damping", 1e3),
    # P2, Figure 9 and text
    ("limits.bearing.start_torque_limit", 10.0),
    ("limits.ramp.transition_speed", 25.0 * math.pi),
    ("schedule.test_speed", 400.0 * math.pi),
    ("gearboxes.test.oil.inlet_temperature", 413.15),
    ("gearboxes.test.bearing_oil.inlet_temperature", 313.15),
    ("gearboxes.test.seals.pinion.radial_gap", 0.6e-3),
]


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(FOLDER)


@pytest.fixture(scope="module")
def list_inputs() -> ModuleType:
    spec = importlib.util.spec_from_file_location("list_inputs", FOLDER / "list_inputs.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def value_at(case: Case, path: str) -> object:
    node: object = case
    for key in path.split("."):
        node = node[key] if isinstance(node, dict) else getattr(node, key)
    return node


@pytest.mark.parametrize(("path", "value"), PRINTED)
def test_printed_number_stands_in_the_case(case: Case, path: str, value: float) -> None:
    assert value_at(case, path) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("name", TABLE_2)
def test_shafts_have_the_frequencies_of_table_2(case: Case, name: str) -> None:
    assert case.drivetrain is not None
    entry = case.drivetrain.shafts[name]
    box, gear = name.split("_")
    body = case.gearboxes[box].gears[gear]
    assert body.position is not None
    assert body.inertia is not None
    shaft = Shaft(
        name=name,
        sections=tuple(
            Section(length=section.length, outer_diameter=section.outer_diameter)
            for section in entry.sections
        ),
        discs=tuple(
            Disc(name=d, position=disc.position, inertia=disc.inertia) for d, disc in entry.discs.items()
        ),
        element_length=2e-3,
    )
    frequencies = free_frequencies(shaft, ((body.position, body.inertia),))
    assert frequencies == pytest.approx(TABLE_2[name], rel=0.02)


def test_housing_has_its_bearings_where_the_shafts_have_them(case: Case) -> None:
    box = case.gearboxes["test"]
    geometry = housing_geometry(box)
    for shaft in geometry.shafts:
        places = {
            bearing.side: bearing.position for bearing in box.bearings.values() if bearing.shaft == shaft.name
        }
        depth = sum(geometry.bearing_depths(shaft.front)) / 2.0
        assert places["front"] is not None
        assert places["rear"] is not None
        assert geometry.length - 2.0 * depth == pytest.approx(places["rear"] - places["front"], abs=1e-5)
        gear = next(gear for gear in box.gears.values() if gear.shaft == shaft.name)
        assert gear.position is not None
        middle = sum(geometry.gear_limits(shaft)) / 2.0
        assert middle - depth == pytest.approx(gear.position - places["front"], abs=1e-5)


def test_every_assumption_with_a_number_says_why(case: Case) -> None:
    assert len(case.assumptions) > 100
    assert all(len(record.reason) > 8 for record in case.assumptions)
    assert {"losses.chamber_density", "gearboxes.test.heat_split.mesh_into_gears"} <= {
        record.path for record in case.assumptions if record.range is not None
    }


def test_every_value_of_the_test_gearbox_is_sourced_or_assumed(case: Case) -> None:
    """Names, choices of model and numerics aside, no number stands without its origin."""
    marked = {mark.path for mark in case.origin.marks}
    plain = {"lateral_position", "overhang_front", "gap"}
    """Half the centre distance, a blind shaft end, and the gap stated with the seals."""

    def visit(node: object, path: str) -> list[str]:
        if isinstance(node, dict):
            if "value" in node:
                return []
            return [found for key, item in node.items() for found in visit(item, f"{path}.{key}")]
        is_number = isinstance(node, float | int) or (
            isinstance(node, str) and node.lstrip("-")[:1].isdigit()
        )
        return [path] if is_number and not isinstance(node, bool) else []

    bare = visit(case.origin.tree["gearboxes"]["test"], "gearboxes.test")
    assert {path.rpartition(".")[2] for path in bare} <= plain
    assert not marked & set(bare)


@pytest.mark.parametrize("name", ["uhcf_prototype", "uhcf_main"])
def test_readme_lists_every_number_with_its_source(name: str, list_inputs: ModuleType) -> None:
    """On failure: python cases/uhcf_prototype/list_inputs.py CASE prints the tables for README.md."""
    folder = FOLDER.parent / name
    readme = (folder / "README.md").read_text(encoding="utf-8").splitlines()
    missing = [row for row in list_inputs.tables(load_case(folder)).splitlines() if row not in readme]
    assert missing == []


def test_readme_paths_exist(case: Case) -> None:
    known = set(known_paths(Case, case.model_dump()))
    assert all(mark.path in known for mark in case.origin.marks)

"""Bought parts are held against what they see themselves, not against what the reference gear sees."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.graph import TorqueSection
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.checks.assumptions import depends
from rigdesign.checks.component_limits import checks
from rigdesign.coupling.state import OperatingPoint
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.loads import StageBracing
from rigdesign.rig.model import build_rig
from tests.builders.idler_case import idler_case
from tests.builders.loads import StatedLoads, StatedMeshLoads
from tests.builders.made_run import made_ramp
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
RPM = math.pi / 30.0
SECTIONS = (
    TorqueSection(kind="coupling", part="pinion_side"),
    TorqueSection(kind="coupling", part="wheel_side"),
    TorqueSection(kind="shaft", part="test_wheel", start=0.0, end=0.1),
)
"""Through which torque passes in a made-up time run: 1 N m, but 250 N m back in run_down and 201 N m in test."""
PEAKS = {"test": 212.0, "reference": 218.7}
"""Highest dynamic torque of each mesh at its pinion [N m]."""


def solved_rig_of(case: Case) -> SolvedRig:
    """A rig whose run is made up: 15 N m at the motor at 12,000 rpm of the first pinion."""
    rig = build_rig(case, "quick")
    meshes = {
        label: StatedMeshLoads(role="rig", torque_peak=PEAKS[label.split(".")[0]])
        for label in rig.mesh_labels.values()
    }
    drift: Any = SimpleNamespace(
        initial=SimpleNamespace(shift=-1.2e-3),
        warm=SimpleNamespace(actuator_force=600.0, friction_force=300.0, shift=1.1e-3),
    )
    made = made_ramp(rig, SECTIONS, {(0, "run_down"): (-250.0, 80.0), (2, "test"): (170.0, 201.0)})
    ramp = SimpleNamespace(
        drive_torque=np.array([15.0]), speed=np.array([12000.0 * RPM]), time=np.array([10.0]), windows=made.windows,
        sections=made.sections, cut="",
    )  # fmt: skip
    point: Any = SimpleNamespace(
        point=OperatingPoint(stage="test", speed=12000.0 * RPM, torque=180.0), setting=None,
        last=SimpleNamespace(system=None, response=None),
    )  # fmt: skip
    return SolvedRig(
        rig=rig, points=(point,), run=SimpleNamespace(ramp=ramp, points=(point,)),  # type: ignore[arg-type]
        loads=StatedLoads(meshes=meshes, bracing=(StageBracing(stage="test", drift=drift),)),
    )  # fmt: skip


def held(part: str, quantity: str, base: Case | None = None) -> Check:
    case = base or load_case(PROTOTYPE)
    entry = {
        "title": "x", "part": part, "quantity": quantity, "source": "data sheet",
        "limit": {"speed": "20000 rpm", "drive_power": "30 kW", "oil_flow": "90 l/min", "actuator_force": "2 kN",
                  "shift_travel": "2 mm", "seal_surface_velocity": "90 m/s",
                  "shaft_growth": "1 mm"}.get(quantity, "400 N m"),
    }  # fmt: skip
    changed = case.with_value("limits.bought_parts", {"x": entry})
    (check,) = checks(solved_rig_of(changed))
    return check


@pytest.mark.parametrize(
    ("part", "quantity", "value"),
    [
        ("drivetrain.motor", "speed", 12000.0 * 99 / 102),
        ("drivetrain.couplings.pinion_side", "speed", 12000.0),
        ("gearboxes.test.bearings.wheel_rear", "speed", 12000.0 * 99 / 102),
        ("gearboxes.test", "speed", 12000.0),
        ("drivetrain.motor", "drive_power", 15.0 * 12000.0 * RPM * 99 / 102),
        ("gearboxes.test", "torque_mean", 180.0),
        ("drivetrain.couplings.wheel_side", "torque_mean", 180.0 * 102 / 99),
        ("gearboxes.test.gears.wheel", "torque_mean", 180.0 * 102 / 99),
        ("gearboxes.test", "torque_peak", 212.0),
        ("gearboxes.test.meshes.main", "torque_peak", 212.0),
        ("gearboxes.test.gears.wheel", "torque_peak", 212.0 * 102 / 99),
        ("drivetrain.couplings.pinion_side", "torque_peak", 250.0),
        ("drivetrain.couplings.wheel_side", "torque_peak", 1.0),
        ("drivetrain.shafts.test_wheel", "torque_peak", 201.0),
        ("gearboxes.test", "oil_flow", 5.0 + 4 * 2.0),
        ("gearboxes.test.oil", "oil_flow", 5.0),
        ("gearboxes.reference.bearing_oil", "oil_flow", 8.0),
        ("drivetrain.bracing", "actuator_force", 900.0),
        ("drivetrain.bracing", "shift_travel", 1.2),
        ("gearboxes.test.seals.wheel", "seal_surface_velocity", 0.5 * 0.05754 * 12000.0 * RPM * 99 / 102),
        ("gearboxes.test", "seal_surface_velocity", 0.5 * 0.05754 * 12000.0 * RPM * 99 / 102),
    ],
)
def test_a_part_sees_its_own(part: str, quantity: str, value: float) -> None:
    assert held(part, quantity).value == pytest.approx(value, rel=1e-9)


def test_the_speed_of_a_lip_is_that_of_the_shaft_where_it_leaves() -> None:
    """The shaft passes the walls of the chamber in gaps, whatever seals it outside."""
    lips = load_case(PROTOTYPE).with_value("gearboxes.test.seals.wheel.kind", "radial_lip")
    shaft = next(s for s in build_rig(lips, "quick").geometries["test"].shafts if s.name == "test_wheel")
    assert shaft.overhang_diameter < shaft.seal_diameter
    check = held("gearboxes.test.seals.wheel", "seal_surface_velocity", lips)
    speed = 12000.0 * RPM * 99 / 102
    assert check.value == pytest.approx(0.5 * shaft.overhang_diameter * speed, rel=1e-9)


def test_without_a_housing_the_seal_sits_at_the_edge_of_the_bearing_on_the_shaft_of_the_drivetrain() -> None:
    """Its speed depends on the sections of that shaft and on the place of the bearing."""
    check = held("gearboxes.reference.seals.wheel", "seal_surface_velocity")
    case = load_case(PROTOTYPE).with_value(
        "limits.bought_parts",
        {"x": {"title": "x", "part": "gearboxes.reference.seals.wheel", "quantity": "seal_surface_velocity",
               "source": "data sheet", "limit": "90 m/s"}},
    )  # fmt: skip
    assert check.value is not None
    for path in (
        "drivetrain.shafts.reference_wheel.sections",
        "gearboxes.reference.bearings.wheel_front.width",
    ):
        assert depends(case, check, path)


def test_load_unit_of_a_loop_braced_by_twist_is_not_asked() -> None:
    case = load_case(PROTOTYPE).with_value("drivetrain.bracing.mode", "twist_held")
    check = held("drivetrain.bracing", "actuator_force", case)
    assert (check.verdict, check.value) == ("not applicable", None)
    assert "braced by a twist" in check.reason


def test_idler_loop(tmp_path: Path) -> None:
    case = load_case(idler_case(tmp_path, housing=False))
    left = held("drivetrain.couplings.left", "torque_mean", case)
    assert left.value == pytest.approx(180.0 * 102 / 99, rel=1e-9)
    assert held("gearboxes.test.meshes.right", "torque_peak", case).value == pytest.approx(212.0)


def test_every_mesh_and_every_bearing_takes_its_flow(tmp_path: Path) -> None:
    """Two meshes with 5 l/min each and six bearings with 2 l/min: as many oil lines as P2's rig would have."""
    case = load_case(idler_case(tmp_path, housing=False))
    assert held("gearboxes.test.oil", "oil_flow", case).value == pytest.approx(10.0)
    assert held("gearboxes.test.bearing_oil", "oil_flow", case).value == pytest.approx(12.0)
    assert held("gearboxes.test", "oil_flow", case).value == pytest.approx(22.0)


@pytest.mark.parametrize(
    ("part", "quantity"),
    [
        ("drivetrain.motor", "torque_peak"),
        ("drivetrain.couplings.wheel_side", "drive_power"),
        ("gearboxes.test", "actuator_force"),
        ("drivetrain.motor", "oil_flow"),
    ],
)
def test_a_part_without_such_a_result_is_refused(part: str, quantity: str) -> None:
    with pytest.raises(CaseError, match="the run finds none at"):
        held(part, quantity)


@pytest.mark.parametrize(
    ("part", "quantity", "stated"),
    [
        ("gearboxes.test", "speed", True),
        ("gearboxes.test", "torque_mean", True),
        ("gearboxes.test", "oil_flow", True),
        ("gearboxes.test", "torque_peak", False),
        ("drivetrain.motor", "drive_torque", False),
    ],
)
def test_what_the_schedule_commands_is_told_from_what_is_computed(
    part: str, quantity: str, stated: bool
) -> None:
    assert held(part, quantity).by_definition is stated


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"overload": "300 N m"}, "overload = 300 N m is below limit = 400 N m"),
        (
            {"part": "gearboxes.test", "overload": "600 N m"},
            "overload = 600 N m is given of gearboxes.test: it counts for couplings and shafts only",
        ),
        (
            {"part": "gearboxes.test.meshes.main", "overload": "600 N m"},
            "is given of gearboxes.test.meshes.main",
        ),
        ({"quantity": "torque_mean", "overload": "600 N m"}, "overload = 600 N m is given of torque_mean"),
        ({"given": "100 N m", "overload": "600 N m"}, "overload = 600 N m is given beside given = 100 N m"),
    ],
)
def test_an_overload_that_no_check_would_hold_is_refused(values: dict[str, str], message: str) -> None:
    case = load_case(PROTOTYPE)
    at = "limits.bought_parts.torque_flange"
    assert case.with_value(f"{at}.overload", "600 N m")
    with pytest.raises(CaseError) as error:
        case.with_values({f"{at}.{key}": value for key, value in values.items()})
    assert message in str(error.value)

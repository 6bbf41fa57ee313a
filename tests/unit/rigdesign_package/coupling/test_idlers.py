"""A rig whose pinions idle between two wheels, from the case to one pass of the coupling loop."""

import math
from functools import cache
from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.coupling.bearing_loads import bearing_loads, solve_bearings
from rigdesign.coupling.fixed_point import next_state
from rigdesign.coupling.iteration import PointProblem, initial_state, run_iteration
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.losses import mesh_losses, rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import shifted_gear
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.temperatures import boundary_conditions
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.drivetrain import loop_forces
from rigdesign.rig.model import Rig, build_rig
from tests.builders.idler_case import idler_case
from tests.builders.shaft_weight import GRAVITY, shaft_weight

TORQUE = 180.0


@cache
def rig(folder: Path, housing: bool) -> tuple[Rig, OperatingPoint, CouplingState]:
    built = build_rig(load_case(idler_case(folder, housing=housing)), "quick")
    point = held_points(built)[0]
    return built, point, initial_state(built, point)


@pytest.fixture(scope="module")
def boxed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Rig, OperatingPoint, CouplingState]:
    return rig(tmp_path_factory.mktemp("boxed"), True)


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> tuple[Rig, OperatingPoint, CouplingState]:
    return rig(tmp_path_factory.mktemp("bare"), False)


def test_torque_goes_through_the_idlers(boxed: tuple[Rig, OperatingPoint, CouplingState]) -> None:
    """Both base radii of a line balance; the reference gears of another module carry the same torque."""
    expected = {"test.left": 1.0, "test.right": -1.0, "reference.left": -1.0, "reference.right": 1.0}
    assert boxed[2].mesh_torque == pytest.approx({m: s * TORQUE for m, s in expected.items()}, rel=1e-9)


def test_tangential_forces_of_an_idler_add_and_separating_ones_cancel(
    boxed: tuple[Rig, OperatingPoint, CouplingState], bare: tuple[Rig, OperatingPoint, CouplingState]
) -> None:
    built, _, coupling_state = boxed
    pair = built.pairs["test.left"]
    tangential = TORQUE / pair.working_radii[0]
    weight = _weight(built, "test.pinion")
    loads = bearing_loads(built, coupling_state)
    both = loads["test.pinion_front"].radial + loads["test.pinion_rear"].radial
    # clockwise, the wheel it drives to the right: the teeth press the pinion upwards against its weight
    assert both == pytest.approx(2.0 * tangential - weight, rel=1e-9)
    # a wheel feels one mesh, its separating force stays
    wheel = loads["test.left_front"].radial + loads["test.left_rear"].radial
    alone = _weight(built, "test.left")
    separating = tangential * math.tan(pair.working_pressure_angle)
    assert wheel == pytest.approx(math.hypot(tangential + alone, separating), rel=2e-3)
    # without a housing the first wheel stands to the left, the second where room is: pressed downwards
    loads = bearing_loads(bare[0], bare[2])
    weight = _weight(built, "test.pinion")
    both = loads["test.pinion_front"].radial + loads["test.pinion_rear"].radial
    assert both == pytest.approx(2.0 * tangential + weight, rel=1e-9)
    y, z = loads["test.pinion_front"].force
    assert z == -loads["test.pinion_front"].radial and abs(y) < 1e-9 * -z


def test_wheels_that_both_drive_the_pinion_cancel_on_its_bearings(
    boxed: tuple[Rig, OperatingPoint, CouplingState],
) -> None:
    built, _, coupling_state = boxed
    torque = dict(coupling_state.mesh_torque) | {"test.left": 90.0, "test.right": 90.0}
    split = CouplingState(**{**vars(coupling_state), "mesh_torque": torque})
    loads = bearing_loads(built, split)
    weight = _weight(built, "test.pinion")
    assert loads["test.pinion_front"].radial + loads["test.pinion_rear"].radial == pytest.approx(
        weight, rel=1e-9
    )


def test_heat_of_both_meshes_enters_the_rim_of_the_idler_once(
    boxed: tuple[Rig, OperatingPoint, CouplingState],
) -> None:
    built, point, coupling_state = boxed
    models = mesh_models(built, point, coupling_state)
    bearings = solve_bearings(built, point, coupling_state)
    turning = rotating_losses(built, point, coupling_state, models, bearings)
    losses = [*turning, *mesh_losses(built, point, models)]
    heated = PointLosses(point=point, coupling_state=coupling_state, bearings=bearings, losses=tuple(losses))
    conditions = boundary_conditions(built, "test", heated, radiation_included=True)
    rims = {c.surface: c.power for c in conditions if getattr(c, "kind", "") == "mesh_loss"}  # type: ignore[union-attr]
    left, right = (p.into_body for p in losses if p.gearbox == "test" and p.loss.kind == "mesh")
    assert rims == pytest.approx(
        {
            "gear_test_pinion_rim": 0.5 * (left + right),
            "gear_test_left_rim": 0.5 * left,
            "gear_test_right_rim": 0.5 * right,
        }
    )
    windage = [p.part for p in losses if p.gearbox == "test" and p.loss.kind == "windage"]
    assert windage == ["pinion", "left", "right"]


def test_a_double_helical_gear_stirs_the_mist_with_both_halves(
    boxed: tuple[Rig, OperatingPoint, CouplingState],
) -> None:
    built, point, coupling_state = boxed
    single = built.case.with_value("gearboxes.reference.meshes.*.double_helical", False)
    one, two = (_windage(build_rig(case, "quick"), point, coupling_state) for case in (single, built.case))
    assert two > 1.6 * one


def _weight(built: Rig, gear: str) -> float:
    """Of a gear and its shaft [N]."""
    assert built.drivetrain is not None
    body = built.drivetrain.gear(gear)
    return shaft_weight(built, body.shaft) + GRAVITY * body.mass


def _windage(built: Rig, point: OperatingPoint, coupling_state: CouplingState) -> float:
    models = mesh_models(built, point, coupling_state)
    losses = rotating_losses(built, point, coupling_state, models, {})
    return sum(p.loss.power for p in losses if p.name == "reference.pinion" and p.loss.kind == "windage")


def test_one_iteration_hands_signed_torques_on(bare: tuple[Rig, OperatingPoint, CouplingState]) -> None:
    """Losses of the shafts between come off the torque on the way round from the motor."""
    built, point, coupling_state = bare
    done = run_iteration(PointProblem.braced(built, point), coupling_state)
    torque = next_state(built, done).mesh_torque
    assert [math.copysign(1.0, t) for t in torque.values()] == [1.0, -1.0, -1.0, 1.0]
    assert torque["test.left"] == pytest.approx(TORQUE, rel=1e-4)
    assert 5.0 < abs(torque["test.right"]) - TORQUE < 15.0


def test_an_idler_cannot_be_shifted_to_brace(boxed: tuple[Rig, OperatingPoint, CouplingState]) -> None:
    with pytest.raises(CaseError, match="in 2 meshes: an idler that is shifted only turns"):
        boxed[0].case.with_value("drivetrain.bracing.shifted_gear", "reference.pinion")


def test_a_loop_that_is_open_holds_no_torque(boxed: tuple[Rig, OperatingPoint, CouplingState]) -> None:
    built = boxed[0]
    lines = {shaft: i for i, shaft in enumerate(built.drivetrain.lines())}  # type: ignore[union-attr]
    with pytest.raises(CaseError, match="in no closed loop"):
        loop_forces(built.case, built.pairs, lines)


def test_a_shifted_wheel_turns_the_loop_at_its_own_radius(
    bare: tuple[Rig, OperatingPoint, CouplingState],
) -> None:
    """102 of the 201 teeth of its mesh are its own: so much of the centre distance is its working radius."""
    gear = shifted_gear(bare[0])
    assert gear is not None
    assert bare[0].mesh_names[gear.mesh] == "reference.right"
    assert gear.working_radius == pytest.approx(99.5e-3 * 102.0 / 201.0, rel=1e-12)

"""A spline with a loss factor: its damper follows the speed of the operating point, of shafts that twist or bend."""

from dataclasses import replace

import pytest

from dynamics.rotor.linear_system import SpeedBands
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop import solve_point
from rigdesign.coupling.loop_over_speed import loop_over_speed
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

SPLINE = "gearboxes.test.gears.pinion.spline"
ETA = 0.1


@pytest.fixture(scope="module")
def case() -> Case:
    """One spline with friction in place of its damper."""
    case = load_case(CASES / "loop_1to1")
    return case.with_values({f"{SPLINE}.torsional_damping": "0 N m s/rad", f"{SPLINE}.loss_factor": ETA})


@pytest.fixture(scope="module")
def rig(case: Case) -> Rig:
    return twisting_rig(case)


def expected(rig: Rig, speed: float) -> float:
    """eta k / omega with 28 teeth at the speed of the pinion, 1:1 [N m s/rad]."""
    gear = rig.case.gearboxes["test"].gears["pinion"]
    assert gear.spline is not None
    return ETA * gear.spline.torsional_stiffness / (28 * speed)


def test_shafts_that_twist_have_the_damper_of_every_speed(rig: Rig) -> None:
    for speed in (50.0, 400.0):
        system = rig.twisting.at(speed)
        gear, _ = system.mesh_ports[0]
        assert system.damping[gear, gear] == pytest.approx(expected(rig, speed))
        point = replace(held_points(rig)[0], speed=speed)
        assert loop_system(rig, point, initial_state(rig, point), {}) is system
    assert rig.system is rig.twisting.at(rig.case.schedule.test_speed)
    (joint,) = (one for one in rig.joints if one.name == "test.pinion")
    assert joint.damping == pytest.approx(expected(rig, rig.case.schedule.test_speed))


def test_over_speed_it_falls_from_band_to_band(rig: Rig) -> None:
    warm = solve_point(rig, held_points(rig)[0]).last
    loop = loop_over_speed(rig, warm, (100.0, 400.0), lambda speed: 1.0)
    assert isinstance(loop, SpeedBands)
    gear, _ = loop.systems[0].mesh_ports[0]
    found = [system.damping[gear, gear] for system in loop.systems]
    assert found == sorted(found, reverse=True)
    assert found[-1] == pytest.approx(expected(rig, 400.0))
    # the middle of the lowest band, a factor of sqrt(1.25) above its speed at most
    assert expected(rig, 100.0) / 1.12 < found[0] < expected(rig, 100.0)
    plain = twisting_rig(rig.case.with_value(f"{SPLINE}.loss_factor", 0.0))
    assert loop_over_speed(plain, warm, (100.0, 400.0), lambda speed: 1.0) is plain.system


def test_shafts_that_bend_have_the_same_damper(case: Case) -> None:
    """The damping of the linear system along the twist of this spline, at one speed less that at another: what does not
    depend on speed drops out."""
    stated = case.with_values(
        {
            "drivetrain.bearing_coefficients": "stated",
            **{
                f"gearboxes.{name}.bearings.{bearing}.{key}": value
                for name, box in case.gearboxes.items()
                for bearing in box.bearings
                for key, value in (("radial_stiffness", "1e8 N/m"), ("radial_damping", "1e4 N s/m"))
            },
        }
    )
    rig = build_rig(stated, "standard")
    reduced = rig.elastic.reduced
    row = reduced.rows(rig.elastic.model.joint("test.pinion", "spline").row("turn"))
    found = []
    for speed in (50.0, 400.0):
        point = replace(held_points(rig)[0], speed=speed)
        system = loop_system(rig, point, initial_state(rig, point), {})
        # gyroscopic moments take no power, bearings as stated are the same at every speed
        found.append(row @ system.coordinates.damping @ row / (row @ row) ** 2)
    assert found[0] - found[1] == pytest.approx(expected(rig, 50.0) - expected(rig, 400.0), rel=1e-9)


def test_a_damper_and_a_loss_factor_are_refused_together(case: Case) -> None:
    with pytest.raises(
        Exception, match=r"torsional_damping = 5 N m s/rad and loss_factor = 0.1 exclude each other"
    ):
        case.with_value(f"{SPLINE}.torsional_damping", "5 N m s/rad")

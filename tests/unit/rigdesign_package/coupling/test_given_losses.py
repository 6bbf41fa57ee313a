"""Losses given by place: they heat the film they belong to, and brake with their own torque over a run-up."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from rigdesign.case import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.located_loss import PlacedLoss, drag_shafts, drag_torques, given_power
from rigdesign.coupling.losses import mesh_losses, rotating_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.preloaded_loop import LoadedCircuit, brace_initial, respond
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
BEARING = """
[losses.given.front]
gearbox = "test"
kind = "bearing"
part = "pinion_front"
power = "2.2 kW"
"""


@cache
def shipped() -> Rig:
    return build_rig(load_case(PROTOTYPE), "quick")


def variant(folder: Path, body: str) -> Rig:
    file = folder / "variant.toml"
    file.write_text(
        f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\nname = "v"\ntitle = "v"\n{body}',
        encoding="utf-8",
    )
    return build_rig(load_case(file), "quick")


def losses_at(rig: Rig, speed_share: float = 1.0) -> tuple[PlacedLoss, ...]:
    """What turns at a share of the test speed, cold and without heat from the housing."""
    point = held_points(rig)[-1]
    point = replace(point, speed=speed_share * point.speed)
    coupling_state = initial_state(rig, point)
    bearings = solve_bearings(rig, point, coupling_state)
    return tuple(
        rotating_losses(rig, point, coupling_state, mesh_models(rig, point, coupling_state), bearings)
    )


def film_rise(rig: Rig, name: str) -> float:
    """Film temperature above the inlet, cold and without heat from the housing [K]."""
    point = held_points(rig)[-1]
    state = solve_bearings(rig, point, initial_state(rig, point))[name]
    return state.film_temperature - rig.case.gearboxes["test"].bearing_oil.inlet_temperature


def by_hand(rig: Rig, power: float) -> float:
    """Half of the rise of all oil fed: P / (2 rho c Q) [K]."""
    supply = rig.case.gearboxes["test"].bearing_oil
    oil = rig.oils[supply.oil]
    inlet = supply.inlet_temperature
    return 0.5 * power / (oil.density(inlet) * oil.heat_capacity(inlet) * supply.flow)


def test_given_loss_heats_its_film(tmp_path: Path) -> None:
    rig = variant(tmp_path, BEARING)
    assert film_rise(rig, "test.pinion_front") == pytest.approx(by_hand(rig, 2200.0), rel=1e-6)
    assert film_rise(rig, "test.pinion_rear") == film_rise(shipped(), "test.pinion_rear")


def test_films_of_a_case_with_given_losses_only() -> None:
    rig = build_rig(load_case(PROTOTYPE / "given_losses.toml"), "quick")
    assert film_rise(rig, "test.pinion_front") == pytest.approx(by_hand(rig, 1100.0), rel=1e-6)
    assert film_rise(rig, "test.wheel_rear") == pytest.approx(by_hand(rig, 1000.0), rel=1e-6)
    assert film_rise(rig, "reference.pinion_front") == 0.0


def test_constant_drag_heats_its_film(tmp_path: Path) -> None:
    """0.0007 N m s/rad at 12,000 rpm: 1105 W."""
    rig = variant(tmp_path, '[losses]\nbearing_drag = "constant"\n')
    assert film_rise(rig, "test.pinion_front") == pytest.approx(by_hand(rig, 1105.4), rel=1e-4)


def test_the_motor_pays_for_all_heat_where_the_drag_is_constant(tmp_path: Path) -> None:
    """Windage, jets and seals brake nothing then, so they may not heat either."""
    rig = variant(tmp_path, '[losses]\nbearing_drag = "constant"\n')
    turning = losses_at(rig)
    assert {placed.loss.kind for placed in turning} == {"bearing"}
    point = held_points(rig)[-1]
    cold = initial_state(rig, point)
    models = mesh_models(rig, point, cold)
    response = respond(rig, LoadedCircuit(point, models, {}, brace_initial(rig, point, cold), rig.system))
    lost = sum(p.loss.power for p in (*turning, *mesh_losses(rig, point, models, response)))
    paid = response.drive_torque * rig.drive_speed(point.speed)
    assert lost == pytest.approx(paid, rel=1e-4)


def test_loss_keeps_what_the_film_would_have_made(tmp_path: Path) -> None:
    (loss,) = (row for row in losses_at(variant(tmp_path, BEARING)) if row.name == "test.pinion_front")
    assert loss.given and loss.loss.power == 2200.0
    assert 500.0 < loss.loss.details["computed_power"] < 1500.0


def test_torque_of_a_given_loss_stays_over_a_run_up(tmp_path: Path) -> None:
    """Power that stays while the speed falls would brake without bound near standstill."""
    rig = variant(tmp_path, BEARING)
    full = held_points(rig)[-1].speed
    for share in (1.0, 0.5, 0.02):
        torque = drag_torques(losses_at(rig, share), rig, share * full)["test.pinion_front"]
        assert torque == pytest.approx(2200.0 / full)


def test_stage_of_a_given_loss(tmp_path: Path) -> None:
    case = variant(tmp_path, BEARING + 'stages = ["run_up"]\n').case
    point = held_points(shipped())[-1]
    assert given_power(case, point, "test", "bearing", "pinion_front") is None
    moved = replace(point, stage="run_up")
    assert given_power(case, moved, "test", "bearing", "pinion_front") == 2200.0
    assert given_power(case, moved, "test", "bearing", "pinion_rear") is None


def test_every_drag_has_a_shaft() -> None:
    assert shipped().drivetrain is not None
    shafts = drag_shafts(shipped().drivetrain)
    torques = drag_torques(losses_at(shipped()), shipped(), held_points(shipped())[-1].speed)
    assert set(torques) <= set(shafts)
    assert shafts["test.pinion"] == shafts["test.seals.pinion"] == shafts["test.pinion_rear"] == "test_pinion"

"""Who pays for the jets: the shaft for the momentum, the pump for their kinetic energy, and the oil gets both."""

import math
from dataclasses import replace

import pytest

from dynamics.errors import DynamicsNotConverged
from rigdesign.checks.law_ranges import loss_findings
from rigdesign.coupling.located_loss import PlacedLoss, drag_torques
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.loop_over_speed import stage_losses
from rigdesign.coupling.losses import oil_jets
from rigdesign.coupling.state import OperatingPoint
from rigdesign.postprocessing.housing import losses_of, stage_balance
from rigdesign.rig.model import Rig
from tests.builders.warm_prototype import base, drive_power, lost_in_all, settled


def warnings_at(rig: Rig, point: OperatingPoint, result: PointResult) -> list[str]:
    found = stage_losses(rig, point, result, dynamic=True)
    return [found.text for found in loss_findings({point.stage: found.losses})]


def jet_at(rpm: float) -> PlacedLoss:
    """The jet of the test mesh at a speed: 5 l/min at 20 m/s into the mesh."""
    rig, result = base()
    point = replace(result.point, speed=rpm * math.pi / 30.0)
    return next(loss for loss in oil_jets(rig, point, rig.pairs) if loss.gearbox == "test")


@pytest.mark.parametrize("rpm", [0.0, 750.0, 12000.0])
def test_the_oil_gets_what_shaft_and_pump_give(rpm: float) -> None:
    """Below the speed of the jet the shaft is driven, the oil still warms up: rho Q ((v - v_jet)^2 + v^2)/2."""
    rig, _ = base()
    jet = jet_at(rpm)
    density = rig.oils["MIL-PRF-23699"].density(413.15)
    speed = rpm * math.pi / 30.0 * rig.pairs["test.main"].working_radii[0]
    mass = density * 5.0 / 6e4
    assert jet.loss.power == pytest.approx(mass * speed * (speed - 20.0), rel=1e-9)
    assert jet.pumped == pytest.approx(0.5 * mass * 400.0, rel=1e-9)
    assert jet.into_oil == pytest.approx(0.5 * mass * ((speed - 20.0) ** 2 + speed**2), rel=1e-9)
    if rpm == 750.0:
        assert jet.loss.power < -4.0
        assert jet.into_oil > 9.0


def test_the_pump_brakes_no_shaft() -> None:
    rig, result = base()
    point = replace(result.point, speed=750.0 * math.pi / 30.0)
    torque = drag_torques([jet_at(750.0)], rig, point.speed)["test.pinion"]
    assert torque * point.speed == pytest.approx(jet_at(750.0).loss.power, rel=1e-12)


def test_heat_and_motor_power_close_with_the_pump_beside_the_motor() -> None:
    """Motor = losses of the shafts and joints; cooler + room = those losses + pump + heaters."""
    rig, last = settled()
    balance = stage_balance(rig, last).cooling
    assert balance.pump == pytest.approx(2 * jet_at(12000.0).pumped, rel=0.05)
    assert abs(balance.imbalance) < 2e-3 * balance.losses
    assert drive_power(rig, last) == pytest.approx(lost_in_all(last), rel=2e-3)
    taken = sum(r.into_oil + r.into_body + r.not_heat for r in losses_of("test", last.losses))
    assert taken == pytest.approx(lost_in_all(last) + balance.pump, rel=1e-12)


def test_at_standstill_only_the_pump_heats() -> None:
    """During the warm-up the jets run: half rho Q v_jet^2 a mesh and nothing else."""
    rig, result = base()
    still = stage_losses(rig, replace(result.point, speed=0.0), result, dynamic=False)
    assert {placed.loss.kind for placed in still.losses} == {"oil_acceleration"}
    assert sum(placed.into_oil for placed in still.losses if placed.gearbox == "test") == pytest.approx(
        jet_at(0.0).pumped
    )
    assert all(placed.loss.power == 0.0 for placed in still.losses)


def test_a_stage_without_a_periodic_response_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its sliding is that of the mean load then: less than that of the dynamic forces, and nobody would know."""
    rig, result = base()
    point = replace(result.point, speed=0.9 * result.point.speed)
    assert not any("no periodic response" in text for text in warnings_at(rig, point, result))

    def unsolved(*_: object) -> None:
        raise DynamicsNotConverged("no periodic response at 10,800 rpm")

    monkeypatch.setattr("rigdesign.coupling.loop_over_speed.respond", unsolved)
    for mesh in ("test.main", "reference.main"):
        assert any(
            text.startswith(f"{mesh}, stage test: no periodic response")
            for text in warnings_at(rig, point, result)
        )

"""Loss factors of a gearbox: the loss moves by its factor, the oil gets it, and the motor pays for it."""

import pytest

from dynamics.rotor.bearing import BearingError, BearingOperation, OilSupply
from dynamics.rotor.journal import JournalBearing
from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.coupling.located_loss import given_power
from rigdesign.properties.oil import FVA_3
from rigdesign.rig.drivetrain import build_drivetrain
from tests.builders.warm_prototype import (
    base,
    case_with,
    drive_power,
    lost,
    lost_in_all,
    open_share,
    outlet,
    settled,
)

pytestmark = pytest.mark.whole_run

FACTOR = 1.5
LOSSES = {
    "windage": "windage",
    "seal": "seal",
    "jet": "oil_acceleration",
    "squeeze": "squeeze",
    "mesh": "mesh",
    "bearing": "bearing",
}
"""Key of the case -> kind in the results."""


@pytest.mark.parametrize("key", LOSSES)
def test_a_factor_moves_its_loss_and_the_motor_pays(key: str) -> None:
    kind = LOSSES[key]
    (cold, before), (rig, after) = settled(), settled((f"gearboxes.test.loss_factors.{key}", FACTOR))
    ratio = lost(after, kind) / lost(before, kind)
    # films thin the oil they heat, so that they lose less than the factor says; nothing else answers as much
    assert 1.3 < ratio < FACTOR if kind == "bearing" else ratio == pytest.approx(FACTOR, rel=0.02)
    for other in set(LOSSES.values()) - {kind}:
        share = 0.02 if other != "squeeze" or kind != "mesh" else 1.0
        assert lost(after, other) == pytest.approx(lost(before, other), rel=share)
        assert lost(after, other, "reference") == pytest.approx(lost(before, other, "reference"), rel=5e-3)
    more = lost_in_all(after) - lost_in_all(before)
    paid = drive_power(rig, after) - drive_power(cold, before)
    assert paid == pytest.approx(more, rel=0.01, abs=0.5)
    assert open_share(rig, after) < 2e-3


@pytest.mark.parametrize("key, stream", [("windage", "gear_oil"), ("bearing", "bearing_oil")])
def test_the_oil_takes_it_up(key: str, stream: str) -> None:
    """dT = dP/(rho c Q), less what the walls pass on to the other oil and the room."""
    (_, before), (rig, after) = settled(), settled((f"gearboxes.test.loss_factors.{key}", FACTOR))
    box = rig.case.gearboxes["test"]
    entry, count = (box.oil, 1) if stream == "gear_oil" else (box.bearing_oil, 4)
    oil = rig.oils[entry.oil]
    mean = 0.5 * (entry.inlet_temperature + outlet(before, f"test.{stream}"))
    flow = oil.density(entry.inlet_temperature) * oil.heat_capacity(mean) * entry.flow * count
    rise = (lost(after, LOSSES[key]) - lost(before, LOSSES[key])) / flow
    warmer = outlet(after, f"test.{stream}") - outlet(before, f"test.{stream}")
    assert 0.5 * rise < warmer < rise


def test_tooth_friction_has_one_factor_for_torque_and_heat() -> None:
    (_, before), (_, after) = settled(), settled(("gearboxes.test.loss_factors.mesh", FACTOR))
    assert after.models[0].law.friction == pytest.approx(FACTOR * before.models[0].law.friction, rel=0.02)
    assert after.models[1].law.friction == pytest.approx(before.models[1].law.friction, rel=1e-3)
    assert after.models[0].friction.inputs["loss_factor"] == FACTOR
    assert "loss_factor" not in before.models[0].friction.inputs
    # squeezing is a share of the mesh loss
    assert lost(after, "squeeze") / lost(before, "squeeze") == pytest.approx(FACTOR, rel=0.02)


def test_no_friction_at_all_is_no_friction() -> None:
    _, after = settled(("gearboxes.test.loss_factors.mesh", 0.0))
    assert lost(after, "mesh") == 0.0
    assert lost(after, "mesh", "reference") > 0.0


def test_a_film_that_drags_more_heats_its_oil_more() -> None:
    bearing = JournalBearing(diameter=0.04, width=0.03, diametral_clearance=60e-6)
    oil = OilSupply(
        inlet_temperature=313.15, flow=2e-5, viscosity=FVA_3.dynamic_viscosity, density=880.0, heat_capacity=2000.0
    )  # fmt: skip

    def state(factor: float):
        return bearing.operating_state(
            BearingOperation(load=500.0, speed=500.0, oil=oil, friction_factor=factor)
        )

    one, two = state(1.0), state(2.0)
    for film, factor in ((one, 1.0), (two, 2.0)):
        assert film.power == pytest.approx(500.0 * film.drag_torque)
        assert film.outlet_temperature - 313.15 == pytest.approx(film.power / (880.0 * 2000.0 * 2e-5))
        assert film.drag_torque > factor * film.petroff_torque
    assert one.power < two.power < 2.0 * one.power
    assert two.film_temperature > one.film_temperature
    assert state(0.0).power == 0.0
    with pytest.raises(BearingError, match="friction_factor = -1"):
        state(-1.0)


def test_constant_drag_and_given_losses_follow_the_factor() -> None:
    constant = (("losses.bearing_drag", "constant"),)
    path = "gearboxes.test.loss_factors.bearing"
    rig, _ = base()
    plain, more = (case_with(changes) for changes in (constant, (*constant, (path, FACTOR))))
    drags = [
        {b.name: b.linear_drag for b in build_drivetrain(c, rig.pairs, rig.materials).bearings}
        for c in (plain, more)
    ]
    assert drags[1]["test.pinion_front"] == pytest.approx(FACTOR * drags[0]["test.pinion_front"])
    assert drags[1]["reference.pinion_front"] == drags[0]["reference.pinion_front"] > 0.0


def test_a_loss_that_the_case_gives_is_scaled_as_well() -> None:
    case = load_case("cases/uhcf_prototype/given_losses.toml")
    entry = next(iter(case.losses.given.values()))
    point = base()[1].point
    key = next(key for key, kind in LOSSES.items() if kind == entry.kind)
    twice = case.with_value(f"gearboxes.{entry.gearbox}.loss_factors.{key}", 2.0)
    powers = [given_power(c, point, entry.gearbox, entry.kind, entry.part) for c in (case, twice)]
    assert powers[0] is not None and powers[1] == pytest.approx(2.0 * powers[0])


@pytest.mark.parametrize("value", [-0.1, 10.5])
def test_a_factor_has_limits(value: float) -> None:
    with pytest.raises(CaseError, match="loss_factors"):
        case_with((("gearboxes.test.loss_factors.seal", value),))


def test_rubbing_seals_brake_their_shafts_and_heat_them() -> None:
    """0.1 N m on two shafts: 0.1 w each, in the heat split of the seals, paid by the motor."""
    (cold, before), (rig, after) = settled(), settled(("gearboxes.test.seals.*.rubbing_torque", "0.1 N m"))
    seals = rig.case.gearboxes["test"].seals.values()
    power = sum(0.1 * rig.shaft_speed(s.shaft, after.point.speed) for s in seals)
    assert lost(after, "seal") - lost(before, "seal") == pytest.approx(power, rel=1e-3)
    split = rig.case.gearboxes["test"].heat_split
    into_body = sum(p.into_body for p in after.losses if p.loss.kind == "seal")
    assert into_body == pytest.approx((split.seal_into_shaft + split.seal_into_housing) * lost(after, "seal"))
    paid = drive_power(rig, after) - drive_power(cold, before)
    assert paid == pytest.approx(lost_in_all(after) - lost_in_all(before), rel=0.01)
    assert open_share(rig, after) < 2e-3


def test_seals_rub_in_a_gearbox_without_a_housing_too() -> None:
    (_, before), (rig, after) = settled(), settled(("gearboxes.reference.seals.*.rubbing_torque", "0.1 N m"))
    assert rig.case.gearboxes["reference"].housing is None
    rubbed = [p for p in after.losses if p.loss.kind == "seal" and p.gearbox == "reference"]
    assert [p.into_body for p in rubbed] == [0.0, 0.0]
    assert lost(before, "seal", "reference") == 0.0 < lost(after, "seal", "reference")
    assert open_share(rig, after) < 2e-3

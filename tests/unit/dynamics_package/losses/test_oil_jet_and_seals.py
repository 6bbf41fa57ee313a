"""Oil acceleration by momentum; lip and gap seals."""

import math

import pytest

from dynamics.losses.loss import LossError
from dynamics.losses.oil_jet import JET_ANGLES, OilJet, oil_acceleration
from dynamics.losses.seal_loss import SealGap, gap_seal_loss, lip_seal_loss

FLOW = 5.0 / 6e4


def test_prototype_spends_270_w_on_5_litres() -> None:
    """Rig designer's figure: rho Q v^2 with 62.3 m/s and 5 l/min is about 270 W."""
    assert oil_acceleration("test/mesh", OilJet(flow=FLOW, density=850.0), 62.2).power == pytest.approx(
        274.0, rel=0.02
    )


def test_main_rig_spends_37_kw_on_130_litres() -> None:
    assert oil_acceleration("test/mesh", OilJet(flow=130 / 6e4, density=860.0), 141.0).power == pytest.approx(
        37e3, rel=0.02
    )


def test_jet_direction_decides() -> None:
    into, radial, against = (
        oil_acceleration(
            "mesh", OilJet(flow=FLOW, density=850.0, speed=20.0, angle=JET_ANGLES[name]), 62.0
        ).power
        for name in ("into_mesh", "radial", "out_of_mesh")
    )
    assert into == pytest.approx(850.0 * FLOW * 62.0 * 42.0)
    assert radial == pytest.approx(850.0 * FLOW * 62.0**2)
    assert against == pytest.approx(850.0 * FLOW * 62.0 * 82.0)


def test_fast_jet_pushes_a_slow_gear() -> None:
    assert oil_acceleration("mesh", OilJet(flow=FLOW, density=850.0, speed=20.0, angle=0.0), 10.0).power < 0.0


@pytest.mark.parametrize("direction", JET_ANGLES)
@pytest.mark.parametrize("speed", [0.0, 3.9, 20.0, 62.0])
def test_shaft_and_pump_pay_what_impact_and_walls_turn_into_heat(direction: str, speed: float) -> None:
    """rho Q |v - v_jet|^2 / 2 at the impact, by the cosine rule, and rho Q v^2 / 2 at the walls: never negative."""
    angle, jet, mass = JET_ANGLES[direction], 20.0, 850.0 * FLOW
    shaft = oil_acceleration("mesh", OilJet(flow=FLOW, density=850.0, speed=jet, angle=angle), speed).power
    heat = 0.5 * mass * (speed**2 + jet**2 - 2.0 * speed * jet * math.cos(angle)) + 0.5 * mass * speed**2
    assert shaft + OilJet(flow=FLOW, density=850.0, speed=jet).power == pytest.approx(heat, rel=1e-12)
    assert heat > 0.0


def test_oil_that_misses_costs_nothing() -> None:
    assert oil_acceleration("mesh", OilJet(flow=FLOW, density=850.0, carried_share=0.0), 62.0).power == 0.0
    with pytest.raises(LossError, match="carried share"):
        oil_acceleration("mesh", OilJet(flow=FLOW, density=850.0, carried_share=1.2), 62.0)
    with pytest.raises(LossError, match="oil flow"):
        oil_acceleration("mesh", OilJet(flow=-FLOW, density=850.0), 62.0)


def test_lip_seal_of_iso_tr_14179() -> None:
    """50 mm at 1500 rpm: 7.69e-6 50^2 1500 = 28.8 W; a lip at 62 m/s is refused by a warning."""
    loss = lip_seal_loss("seal", 0.05, 1500 * math.pi / 30)
    assert loss.power == pytest.approx(28.8, abs=0.05)
    assert loss.warnings == ()
    assert len(lip_seal_loss("seal", 0.1, 12000 * math.pi / 30).warnings) == 1
    with pytest.raises(LossError, match="seal diameter"):
        lip_seal_loss("seal", 0.0, 100.0)


def test_contactless_seal_of_p2_loses_about_a_watt() -> None:
    """R 38 mm, gap 0.6 mm, 20 mm long, air at 90 degC, 12,000 rpm: vortices, C = 0.0082, 1 W."""
    loss = gap_seal_loss(
        "seal", SealGap(radius=38e-3, gap=0.6e-3, length=20e-3), 12000 * math.pi / 30, 0.97, 2.15e-5
    )
    assert loss.details["regime"] == "vortices"
    assert loss.power == pytest.approx(1.05, abs=0.1)


def test_narrow_gap_is_couette() -> None:
    loss = gap_seal_loss("seal", SealGap(radius=20e-3, gap=0.1e-3, length=20e-3), 100.0, 870.0, 0.02)
    assert loss.details["regime"] == "laminar"
    assert loss.power == pytest.approx(2.0 * math.pi * 0.02 * 100.0**2 * 20e-3**3 * 20e-3 / 0.1e-3)


def test_vortices_never_lose_less_than_couette() -> None:
    powers = [
        gap_seal_loss("s", SealGap(radius=38e-3, gap=0.6e-3, length=20e-3), w, 0.97, 2.15e-5).power
        for w in range(20, 2000, 20)
    ]
    assert powers == sorted(powers)


@pytest.mark.parametrize("reynolds", [500.0, 1e4])
def test_laws_of_the_gap_meet(reynolds: float) -> None:
    """Bilgen and Boulos' branches join within 10 %."""
    omega = reynolds * 2.15e-5 / (0.97 * 38e-3 * 0.6e-3)
    below, above = (
        gap_seal_loss(
            "s", SealGap(radius=38e-3, gap=0.6e-3, length=20e-3), omega * factor, 0.97, 2.15e-5
        ).power
        for factor in (0.9999, 1.0001)
    )
    assert above == pytest.approx(below, rel=0.10)


def test_touching_seal_is_refused() -> None:
    with pytest.raises(LossError, match="gap"):
        gap_seal_loss("seal", SealGap(radius=38e-3, gap=0.0, length=20e-3), 100.0, 0.97, 2.15e-5)

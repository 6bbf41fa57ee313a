"""ISO/TR 14179-2 churning torque and heat balance, bulk temperature of ISO/TS 6336-22."""

import math

import pytest

from dynamics.errors import DynamicsInputError
from dynamics.standards import iso_tr_14179_2_2001 as tr14179
from dynamics.standards.iso_ts_6336_22_2018 import X_S, theta_M

STAGE = tr14179.DippedStage(h_e1=20.0, h_e2=40.0, h_C=60.0, l_h=120.0, b=20.0)


def test_churning_torque_by_hand() -> None:
    """C_Sp = (160/180)^1.5 x 1 = 0.8381; C_1 = 0.378 + 0.1024; C_2 = 0.275; at 10 m/s 0.4026 x e^0.275 N m."""
    assert tr14179.C_Sp(STAGE) == pytest.approx(0.83805, abs=1e-5)
    assert tr14179.C_1(STAGE) == pytest.approx(0.4804)
    assert tr14179.C_2(STAGE) == pytest.approx(0.275)
    assert tr14179.T_H(STAGE, 10.0) == pytest.approx(0.83805 * 0.4804 * math.exp(0.275), rel=1e-5)
    assert tr14179.T_H(STAGE._replace(h_e1=0.0, h_e2=0.0), 10.0) == 0.0


def test_hydraulic_length_of_a_square_is_its_side() -> None:
    assert tr14179.l_h(100.0**2, 400.0) == 100.0


def test_michaelis_bulk_temperature_of_fzg_gears() -> None:
    """Load stage 10, mesh loss 985 W by hand on 91.5 x 14 mm2: 90 + 42.4/1.2 = 125.3 degC, "about 126" by hand."""
    assert theta_M(90.0, 0.985, 91.5 * 14.0, "dip") == pytest.approx(125.3, abs=0.1)
    assert theta_M(90.0, 0.985, 91.5 * 14.0, "dip") == pytest.approx(126.0, abs=1.0)


def test_supply_scales_the_rise() -> None:
    rises = {supply: theta_M(0.0, 1.0, 1000.0, supply) for supply in X_S}
    assert rises["injection"] == pytest.approx(7400.0 * 1e-3**0.72)
    assert rises["dip"] == pytest.approx(rises["injection"] / 1.2)
    assert rises["submerged"] == pytest.approx(rises["injection"] / 6.0)
    assert theta_M(90.0, 0.0, 1000.0, "dip") == 90.0


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (
            (90.0, 1.0, 1000.0, "splash"),
            "oil supply = 'splash': unknown; give one of injection, dip, submerged",
        ),
        ((90.0, -1.0, 1000.0, "dip"), "P_VZP = -1 kW"),
        ((90.0, 1.0, 0.0, "dip"), "a b = 0"),
    ],
)
def test_impossible_input(arguments: tuple[float, float, float, str], told: str) -> None:
    with pytest.raises(DynamicsInputError, match=told):
        theta_M(*arguments)

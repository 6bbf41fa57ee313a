"""ISO 281, ISO 76, ISO 5753-1, Palmgren's torque and the SKF model against examples their users printed."""

import math
from itertools import pairwise

import pytest

from dynamics.errors import DynamicsInputError
from dynamics.rotor.rolling_catalogue import catalogue_bearing
from dynamics.rotor.rolling_clearance import class_clearance
from dynamics.rotor.rolling_kinds import CylindricalRoller, DeepGrooveBall
from dynamics.standards import iso76_2006, iso281_2007, iso5753_1_2009
from dynamics.standards import iso_tr_14179_2_2001 as palmgren
from dynamics.standards import skf_friction_2006 as skf


def hours(C: float, P: float, n: float, contact: iso281_2007.Contact) -> float:
    return iso281_2007.L_10(C, P, contact) * 1e6 / (60.0 * n)


def test_basic_life_of_printed_ball_bearings() -> None:
    """SKF 6000 p. 78: 6309, 10 kN, 3000 rpm, 940 h; SKF Bearing Calculator report: 4 kN, 1800 rpm, 24500 h."""
    assert hours(55.3, 10.0, 3000.0, "ball") == pytest.approx(940.0, rel=2e-3)
    assert hours(55.3, 4.0, 1800.0, "ball") == pytest.approx(24500.0, rel=2e-3)


@pytest.mark.parametrize(
    ("P", "n", "printed"),
    [(200.0, 50.0, 9136.0), (125.0, 300.0, 7295.0), (75.0, 400.0, 30030.0), (50.0, 200.0, 232040.0)],
)  # fmt: skip
def test_basic_life_of_a_printed_roller_bearing(P: float, n: float, printed: float) -> None:
    """SKF 6000 p. 81, example 5/2: C = 540 kN."""
    assert hours(540.0, P, n, "roller") == pytest.approx(printed, rel=1e-3)


@pytest.mark.parametrize(("load", "read"), [(0.107, 8.0), (0.067, 3.5), (0.0268, 1.2)])
def test_life_modification_against_printed_diagram_readings(load: float, read: float) -> None:
    """SKF 6000 pp. 78-80: kappa = 2.45, readings of the diagram of a_SKF on the scale of Explorer bearings.

    That scale is the one of ISO 281 with the fatigue load limit a quarter higher: inferred from these readings.
    """
    assert iso281_2007.a_ISO(2.45, 1.25 * load, "ball") == pytest.approx(read, rel=0.08)


def test_life_modification_by_hand() -> None:
    """Equation (33): kappa = 2, e_C C_u / P = 0.1; equation (35): kappa = 0.5, 0.2."""
    ball = 0.1 * (1.0 - (2.5671 - 1.9987 / 2.0**0.071739) ** 0.83 * 0.1 ** (1.0 / 3.0)) ** -9.3
    roller = 0.1 * (1.0 - (1.5859 - 1.2348 / 0.5**0.19087) * 0.2**0.4) ** -9.185
    assert iso281_2007.a_ISO(2.0, 0.1, "ball") == pytest.approx(ball)
    assert iso281_2007.a_ISO(0.5, 0.2, "roller") == pytest.approx(roller)


@pytest.mark.parametrize("contact", ["ball", "roller"])
def test_life_modification_is_continuous_monotone_and_bounded(contact: iso281_2007.Contact) -> None:
    assert iso281_2007.a_ISO(0.1001, 0.3, contact) == pytest.approx(0.1, rel=0.01)
    for border in (0.4, 1.0):
        below, above = (iso281_2007.a_ISO(border * (1.0 + step), 0.3, contact) for step in (-1e-9, 1e-9))
        assert below == pytest.approx(above, rel=2e-3)
    lubrication = [iso281_2007.a_ISO(0.05 * step, 0.2, contact) for step in range(1, 120)]
    assert all(low <= high for low, high in pairwise(lubrication))
    assert lubrication[0] == 0.1
    assert lubrication[-1] == iso281_2007.a_ISO(4.0, 0.2, contact)
    assert iso281_2007.a_ISO(4.0, 5.0, contact) == iso281_2007.A_ISO_MAXIMUM


def test_reference_viscosity_meets_at_1000_rpm() -> None:
    below, above = iso281_2007.nu_1(999.999, 60.0), iso281_2007.nu_1(1000.0, 60.0)
    assert below == pytest.approx(above, rel=0.025)
    assert iso281_2007.nu_1(3000.0, 72.5) == pytest.approx(4500.0 / math.sqrt(3000.0 * 72.5))
    assert iso281_2007.nu_1(0.0, 60.0) == math.inf


def test_reliability_and_contamination_reject_what_is_not_tabled() -> None:
    assert iso281_2007.a_1(0.9) == 1.0
    assert iso281_2007.a_1(0.955) == pytest.approx(0.5 * (0.64 + 0.55))
    with pytest.raises(DynamicsInputError, match=r"reliability = 0\.999"):
        iso281_2007.a_1(0.999)
    with pytest.raises(DynamicsInputError, match=r"contamination level = 'filthy'.*normal cleanliness"):
        iso281_2007.e_C("filthy", 60.0)


def test_simplified_fatigue_limit_is_near_the_catalogue() -> None:
    """6208 prints 0.80 kN, NU 208 ECP 6.7 kN."""
    assert iso281_2007.C_u(19.0, 60.0, "ball") == pytest.approx(0.80, rel=0.1)
    assert iso281_2007.C_u(53.0, 60.5, "roller") == pytest.approx(6.7, rel=0.05)
    assert iso281_2007.C_u(1.0, 400.0, "ball") == pytest.approx(0.5 / 22.0)


@pytest.mark.parametrize(
    ("D_w", "D_pw", "printed"), [(11.9, 60.0, 14.0), (17.46, 72.5, 13.0), (12.7, 70.0, 14.0)]
)
def test_static_factor_against_printed_ones(D_w: float, D_pw: float, printed: float) -> None:
    """SKF 6000 pp. 309: f_0 of 6208, 6309, 6210."""
    assert iso76_2006.f_0(D_w / D_pw) == pytest.approx(printed, abs=0.6)


def test_palmgren_torque_of_a_printed_cylindrical_roller_bearing() -> None:
    """KRW catalogue p. 62: NJ 220 E, f_0 = 2, f_1 = 0.0003, 27 mm2/s, 3600 rpm; K_L = 0.52, K_P = 0.565 of 840 W."""
    omega = 3600.0 * math.pi / 30.0
    independent = 1e-3 * palmgren.T_VL0(2.0, 27.0, 3600.0, 140.0) * omega
    dependent = 1e-3 * palmgren.T_VL1(0.0003, 30e3, 140.0) * omega
    assert independent / 840.0 == pytest.approx(0.52, abs=5e-3)
    assert dependent / 840.0 == pytest.approx(0.565, abs=5e-3)


@pytest.mark.parametrize(("nu", "printed"), [(60.0, 1423.0), (39.0, 1062.0), (26.0, 824.0), (19.0, 660.0)])
def test_palmgren_torque_of_a_printed_deep_groove_ball_bearing(nu: float, printed: float) -> None:
    """KRW catalogue p. 57: 6220 at 2200 rpm, viscosities rounded in print."""
    row = palmgren.DEEP_GROOVE_BALL["62"]
    assert palmgren.T_VL0(row.f_0, nu, 2200.0, 140.0) == pytest.approx(printed, rel=0.02)


def test_palmgren_load_dependent_torque_of_the_same_bearing() -> None:
    """6220: C_0 = 93 kN, 20 kN radial, 6 kN axial, M_1 = 1148 N mm."""
    row = palmgren.DEEP_GROOVE_BALL["62"]
    f_1 = palmgren.f_1(row, 20e3, 93e3)
    load = DeepGrooveBall().palmgren_load(catalogue_bearing("6210"), 20e3, 6e3)  # the same for all sizes
    assert palmgren.T_VL1(f_1, load, 140.0) == pytest.approx(1148.0, rel=0.01)


def test_palmgren_speed_term_has_no_step() -> None:
    low, high = (palmgren.T_VL0(2.0, 1.0, 2000.0 + step, 60.0) for step in (-1e-6, 1e-6))
    assert low == pytest.approx(high, rel=0.01)
    assert palmgren.T_VL0(2.0, 30.0, 0.0, 60.0) == 0.0


def test_skf_model_against_its_printed_example() -> None:
    """SKF 6000 pp. 104-105: 22208 E, 3500 rpm, 68 mm2/s; G_rr = 0.26, G_sl = 434 of a spherical roller bearing."""
    size = skf.Size(40.0, 80.0, 23.0)
    shear = skf.phi_ish(3500.0, 68.0, size.d_m)
    starvation = skf.phi_rs(skf.K_RS["oil_bath"], 5.5, 3500.0, 68.0, size)
    rolling = skf.M_rr(0.26, 3500.0, 68.0)
    sliding = 434.0 * skf.mu_sl(3500.0, 68.0, size.d_m, skf.MU_EHL["mineral"])
    assert shear == pytest.approx(0.85, abs=5e-3)
    assert starvation == pytest.approx(0.8, abs=0.02)
    assert rolling == pytest.approx(437.0, rel=2e-3)
    assert sliding == pytest.approx(21.7, rel=1e-3)
    drag = skf.M_drag(skf.KindConstants(K_Z=5.5, K_L=0.8), size, 0.041 * size.d_m, 3500.0)
    assert drag == pytest.approx(14.5, abs=0.05)
    assert shear * starvation * rolling + sliding + drag == pytest.approx(334.0, rel=0.01)


def test_skf_variables_by_hand() -> None:
    """Table 2a with table 3a row 62 and 3c row 2: 6208 with 2 kN and 0.5 kN axial, NU 208 with 2 kN."""
    ball = skf.deep_groove(skf.DEEP_GROOVE["62"], 60.0, 2000.0, 500.0, 19000.0)
    sine = math.sin(math.radians(24.6 * (500.0 / 19000.0) ** 0.24))
    assert ball.G_rr == pytest.approx(3.9e-7 * 60.0**1.96 * (2000.0 + 1.7 * 500.0 / sine) ** 0.54)
    assert ball.G_sl == pytest.approx(
        3.23e-3 * 60.0**-0.145 * (2000.0**5 + 36.5 * 60.0**1.5 / sine * 500.0**4) ** (1.0 / 3.0)
    )
    roller = skf.cylindrical(skf.CYLINDRICAL["2"], 60.0, 2000.0, 0.0)
    assert roller.G_rr == pytest.approx(0.2219, rel=1e-3)
    assert roller.G_sl == pytest.approx(0.0015 * 60.0 * 2000.0)


def test_skf_mixed_friction_at_both_ends() -> None:
    assert skf.mu_sl(0.0, 68.0, 60.0, 0.05) == skf.MU_BL
    assert skf.mu_sl(1e5, 68.0, 60.0, 0.05) == pytest.approx(0.05)


def test_skf_drag_grows_with_level_and_stops_when_submerged() -> None:
    size = skf.Size(40.0, 80.0, 18.0)
    for kind in (DeepGrooveBall, CylindricalRoller):
        drags = [
            skf.M_drag(kind.skf_constants, size, level, 3000.0)
            for level in (0.0, 5.0, 10.0, 30.0, 60.0, 72.0, 80.0)
        ]
        assert drags[0] == 0.0
        assert all(low < high for low, high in pairwise(drags[:6]))
        assert drags[-1] == pytest.approx(drags[-2])


def test_drag_variable_at_the_printed_points() -> None:
    assert skf.V_M(0.041, roller=True) == pytest.approx(0.3e-4)
    assert skf.V_M(2.0, roller=False) == pytest.approx(0.0012)


def test_clearance_classes_of_a_40_mm_bore() -> None:
    """NSK table 9.9 and SKF 6000 p. 513."""
    assert iso5753_1_2009.radial_internal_clearance(iso5753_1_2009.DEEP_GROOVE_BALL, 40.0, "CN") == (
        6.0,
        20.0,
    )
    assert iso5753_1_2009.radial_internal_clearance(iso5753_1_2009.CYLINDRICAL_ROLLER, 40.0, "C3") == (
        45.0,
        70.0,
    )
    assert iso5753_1_2009.radial_internal_clearance(iso5753_1_2009.CYLINDRICAL_ROLLER, 40.001, "C3") == (
        50.0,
        80.0,
    )
    with pytest.raises(DynamicsInputError, match="bore = 900 mm"):
        iso5753_1_2009.radial_internal_clearance(iso5753_1_2009.DEEP_GROOVE_BALL, 900.0, "CN")
    with pytest.raises(DynamicsInputError, match="tapered_roller has none"):
        class_clearance(catalogue_bearing("30208"), "CN")

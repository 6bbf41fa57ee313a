import itertools
from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest

from dynamics.standards import iso1328_1_2013 as flank
from dynamics.standards import iso6336_1_2006 as clause_9
from dynamics.standards import iso6336_1_2006 as iso
from dynamics.standards import iso6336_3_2006 as root

DATA = clause_9.MeshData(
    z_1=99,
    z_2=102,
    z_n1=99.0,
    z_n2=102.0,
    m_n=1.0,
    alpha_Pn=20.0,
    alpha_t=20.0,
    beta=0.0,
    x_1=0.1,
    x_2=0.0,
    h_fP1=1.25,
    h_fP2=1.25,
    b=7.0,
    d_1=99.0,
    d_b1=93.03,
    d_m1=98.75,
    d_m2=99.0,
    epsilon_alpha=1.26,
    epsilon_beta=0.0,
)
LOAD = iso.GearLoad(F_t=3636.0, n_1=2500.0)
DEVIATIONS = iso.ToothDeviations(f_pb=5.0, f_falpha=5.5, grade=5)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (12.4, 12.0),
        (12.5, 13.0),
        (10.2, 10.0),
        (9.7, 9.5),
        (5.55, 5.5),
        (5.76, 6.0),
        (4.96, 5.0),
        (3.04, 3.0),
    ],
)
def test_rounding_of_tolerances(value, expected):
    assert flank.rounded(value) == expected


def test_tolerances_of_the_test_gear_by_hand():
    got = flank.tolerances(99, 99.0, 1.0, 7.0, 5)
    assert got.f_pT == 5.5  # 0.099 + 0.4 + 5 = 5.499
    assert got.f_falphaT == 5.5  # 0.55 + 5 = 5.55
    assert got.F_pT == 18.0  # 0.198 + 5.472 + 0.7 + 12 = 18.37
    assert got.F_rT == 17.0  # 0.9 * 18.37 = 16.53
    assert got.f_HalphaT == 4.5  # 0.4 + 0.099 + 4
    assert got.f_HbetaT == 5.5  # 0.497 + 0.926 + 4 = 5.42
    assert got.f_fbetaT == 6.0  # 0.696 + 1.191 + 4 = 5.89
    assert got.warnings == ()


def test_two_grades_double_the_tolerance():
    assert flank.f_pT(1000.0, 10.0, 9) == pytest.approx(4.0 * (1.0 + 4.0 + 5.0), abs=0.5)


def test_tolerances_outside_the_scope():
    got = flank.tolerances(4, 4.0, 0.4, 3.0, 5, beta=50.0)
    assert len(got.warnings) == 5
    assert "m_n = 0.4 outside 0.5..70" in " ".join(got.warnings)
    with pytest.raises(ValueError, match=r"A = 12 must lie in 1\.\.11"):
        flank.f_pT(100.0, 1.0, 12)


def test_dynamic_factor_is_continuous_over_all_ranges():
    base = iso.dynamic_factor(DATA, LOAD, DEVIATIONS, iso.RunningIn(C_a=7.0))
    speeds = base.n_E1 * np.linspace(0.01, 2.0, 4001)
    curve = [
        iso.dynamic_factor(DATA, replace(LOAD, n_1=n), DEVIATIONS, iso.RunningIn(C_a=7.0)) for n in speeds
    ]
    factors = np.array([f.K_V for f in curve])
    jumps = {}
    for before, after in itertools.pairwise(curve):
        if before.range != after.range:
            jumps[before.range, after.range] = abs(after.K_V - before.K_V)
    assert set(jumps) == {
        ("subcritical", "main resonance"),
        ("main resonance", "intermediate"),
        ("intermediate", "supercritical"),
    }
    # the standard itself steps at N_S; the straight line joins the other two
    assert jumps["main resonance", "intermediate"] < 0.01
    assert jumps["intermediate", "supercritical"] < 0.01
    assert factors[0] == pytest.approx(1.0, abs=0.01)


def test_low_contact_ratio_takes_ten_percent_off():
    at = clause_9.stiffness(replace(DATA, epsilon_alpha=1.2), 500.0)
    below = clause_9.stiffness(replace(DATA, epsilon_alpha=1.2 - 1e-9), 500.0)
    assert below.c_gamma_alpha == pytest.approx(0.9 * at.c_gamma_alpha)
    assert "below 1.2" in below.warnings[0]


def test_low_load_exponent():
    full, low = (clause_9.stiffness(DATA, load).c_prime for load in (100.0, 6.25))
    assert low == pytest.approx(0.5 * full)


def test_web_and_rim_factor():
    assert clause_9.C_R(None, 1.0) == 1.0
    assert clause_9.C_R(1.0, 3.0) == 1.0
    assert clause_9.C_R(0.05, 0.5) == clause_9.C_R(0.2, 1.0) == pytest.approx(0.7365, abs=1e-4)


def test_young_modulus_scales_the_stiffness():
    soft = clause_9.stiffness(replace(DATA, E_1=103000.0, E_2=103000.0), 500.0)
    assert soft.c_prime == pytest.approx(0.5 * clause_9.stiffness(DATA, 500.0).c_prime)


def test_rings_are_lighter_than_discs():
    solid, ring = iso.m_red(DATA), iso.m_red(replace(DATA, q_1=0.5, q_2=0.5))
    assert ring == pytest.approx(solid * (1 - 0.5**4))


def test_run_in():
    assert iso.run_in(20.0, 3.0, "nitrided", None) == 1.5
    assert iso.run_in(60.0, 3.0, "case_hardened", None) == 3.0
    assert iso.run_in(100.0, 7.0, "through_hardened", 800.0) == pytest.approx(16.0)
    assert iso.run_in(100.0, 20.0, "through_hardened", 800.0) == pytest.approx(8.0)
    with pytest.raises(ValueError, match="sigma_Hlim"):
        iso.run_in(10.0, 3.0, "through_hardened", None)


@pytest.mark.parametrize("change", [{"F_t": 0.0}, {"n_1": -1.0}, {"K_A": -1.0}])
def test_impossible_load_is_refused(change):
    with pytest.raises(ValueError, match=next(iter(change))):
        iso.dynamic_factor(DATA, replace(LOAD, **change), DEVIATIONS)


def test_regression_range_and_speed_warnings():
    swapped = iso.dynamic_factor(replace(DATA, x_1=-0.1), LOAD, DEVIATIONS)
    assert any("below x2" in warning for warning in swapped.warnings)
    slow = iso.dynamic_factor(DATA, replace(LOAD, n_1=10.0), DEVIATIONS)
    assert any("below 3 m/s" in warning for warning in slow.warnings)
    coarse = iso.dynamic_factor(DATA, LOAD, replace(DEVIATIONS, grade=8))
    assert any("grade 8 coarser than 6" in warning for warning in coarse.warnings)
    assert (coarse.B_k, iso.dynamic_factor(DATA, LOAD, replace(DEVIATIONS, grade=6)).B_k < 1.0) == (1.0, True)
    long = iso.dynamic_factor(replace(DATA, epsilon_beta=11.0), LOAD, DEVIATIONS)
    assert any("C_v4" in warning for warning in long.warnings)
    assert long.C_v4 < 0.0
    assert iso.dynamic_factor(DATA, LOAD, DEVIATIONS).warnings == ()


def test_failed_regression_is_refused():
    with pytest.raises(ValueError, match="q'"):
        clause_9.stiffness(replace(DATA, x_1=3.0, z_n1=2.0), 500.0)


def test_helix_rim_and_deep_tooth_factors():
    assert root.Y_beta(0.5, 12.0) == pytest.approx(0.95)
    assert root.Y_beta(4.0, 40.0) == pytest.approx(0.75)
    assert root.Y_B(inf, 2.25) == 1.0
    assert root.Y_B(1.2, 1.0) == 1.0
    assert root.Y_B(0.8, 1.0) == pytest.approx(1.6 * np.log(2.242 / 0.8))
    with pytest.raises(ValueError, match="s_R / h_t"):
        root.Y_B(0.5, 1.0)
    assert (root.Y_DT(2.0, 3), root.Y_DT(2.3, 5), root.Y_DT(2.6, 3)) == (1.0, 1.0, 0.7)
    assert root.Y_DT(2.3, 3) == pytest.approx(0.8342)


def test_load_factors_for_root_stress():
    assert root.K_Fbeta(1.16, 100.0 / 18.0) == pytest.approx(
        1.16 ** ((50 / 9) ** 2 / (1 + 50 / 9 + (50 / 9) ** 2))
    )
    assert root.K_Fbeta(1.2, 1.0) == root.K_Fbeta(1.2, 3.0)
    assert root.K_Falpha(1.26, 1.26, 16.3, 4.78, 519.5) == 1.0
    assert root.K_Falpha(1.6, 1.6, 20.0, 10.0, 200.0) == pytest.approx(0.8 * (0.9 + 0.4))
    assert root.K_Falpha(1.6, 1.6, 20.0, 90.0, 200.0) == pytest.approx(1.6 / 1.15)
    assert root.K_Falpha(1.5, 3.0, 20.0, 3.0, 200.0) == pytest.approx(0.9 + 0.4 * (4 / 3) ** 0.5 * 0.3)


GEAR = root.ToothRoot(z=99, m_n=1.0, alpha_n=20.0, beta=0.0, x=0.0, h_fP=1.25, rho_fP=0.38, d_a=101.0)


def test_root_stress_factors_multiply():
    load = root.ToothLoad(F_t=1000.0, b=7.0, epsilon_alpha=1.26)
    bare = root.root_stress(GEAR, load)
    full = root.root_stress(GEAR, load, root.LoadFactors(K_A=1.1, K_V=1.2, K_Fbeta=1.3, K_Falpha=1.05))
    assert bare.sigma_F == bare.sigma_F0
    assert full.sigma_F == pytest.approx(bare.sigma_F0 * 1.1 * 1.2 * 1.3 * 1.05)
    assert bare.sigma_F0 == pytest.approx(1000.0 / 7.0 * bare.Y_F * bare.Y_S)


def test_notch_and_contact_ratio_warnings():
    sharp = replace(GEAR, z=2000, d_a=2002.0, rho_fP=0.02)
    assert "q_s" in root.root_stress(sharp, root.ToothLoad(F_t=1.0, b=1.0, epsilon_alpha=1.3)).warnings[0]
    assert (
        "2 or more" in root.root_stress(GEAR, root.ToothLoad(F_t=1.0, b=1.0, epsilon_alpha=2.01)).warnings[0]
    )


def test_mean_main_resonance_speed_by_hand():
    factor = iso.dynamic_factor(DATA, LOAD, DEVIATIONS)
    assert factor.n_E1 == pytest.approx(
        30000 / (pi * 99) * (factor.stiffness.c_gamma_alpha / factor.m_red) ** 0.5
    )
    assert pytest.approx(2500.0 / factor.n_E1) == factor.N

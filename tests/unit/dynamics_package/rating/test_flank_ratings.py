"""Pitting, scuffing and micropitting of a pair: hand figures, limits, symmetry, refusals."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.rating import flank_contact as pitting
from dynamics.rating import micropitting, scuffing
from dynamics.rating.flank_contact import ContactFactors, FlankContact, FlankLoad
from dynamics.standards import iso6336_2_2006 as iso2
from dynamics.standards import iso_ts_6336_20_2017 as ts20
from dynamics.standards import iso_ts_6336_22_2018 as ts22
from dynamics.standards.iso6336_1_2006 import RunIn

EQUAL = GearPair.from_centre_distance(
    normal_module=4e-3,
    teeth=(28, 28),
    centre_distance=112.5e-3,
    face_widths=(20e-3, 20e-3),
    profile_shift_1="equal",
)
HELICAL = GearPair.from_centre_distance(
    normal_module=2e-3, teeth=(25, 50), centre_distance=80e-3, face_widths=(30e-3, 30e-3), profile_shift_1="equal",
    helix_angle=np.radians(18.0),
)  # fmt: skip
LOAD = FlankLoad(torque=250.0, speed=150.0)
MATERIALS = pitting.FlankMaterials(strengths=(1500e6, 1500e6), cycles=(1e8, 1e8), roughness=(5e-7, 5e-7))


def viscosity(temperature: float) -> float:
    return float(0.02 * np.exp(-0.03 * (temperature - 333.15)))


STATE = scuffing.FlankFilmState(
    oil_temperature=333.15, bulk_temperature=353.15, viscosity=0.02, oil_factor=1.0, roughness=5e-7,
    thermal_contact=(13.6e3, 13.6e3),
)  # fmt: skip
OIL = micropitting.Lubricant(viscosity, 2e-8)


@pytest.mark.parametrize(
    ("cycles", "treatment", "factor"),
    [
        (1e4, "case_hardened", 1.6), (5e7, "case_hardened", 1.0), (1e10, "case_hardened", 0.85),
        (1e12, "case_hardened", 0.85), (1e5, "nitrided", 1.3), (2e6, "nitrided", 1.0), (1e6, "case_hardened", 1.3443),
    ],
)  # fmt: skip
def test_life_factor(cycles: float, treatment: RunIn, factor: float) -> None:
    """Ends and knots; between them 1.6 x 10^(ln(1/1.6)/ln 500) = 1.6 x 10^-0.07563."""
    assert iso2.Z_NT(cycles, treatment) == pytest.approx(factor, abs=1e-4)


@pytest.mark.parametrize(
    ("module", "treatment", "factor"),
    [(1.0, "case_hardened", 1.0), (20.0, "case_hardened", 0.95), (40.0, "case_hardened", 0.9), (10.0, "nitrided", 0.97),
     (40.0, "nitrided", 0.75), (20.0, "through_hardened", 1.0)],
)  # fmt: skip
def test_size_factor(module: float, treatment: RunIn, factor: float) -> None:
    assert iso2.Z_X(module, treatment) == pytest.approx(factor)


def test_work_hardening_helps_a_soft_wheel_only() -> None:
    assert iso2.Z_W(None) == 1.0
    assert (iso2.Z_W(130.0), iso2.Z_W(470.0)) == pytest.approx((1.2, 1.0))


def test_lubricant_constants_meet_at_both_ends_of_the_strengths() -> None:
    """ISO 6336-2: 0.83 below 850 and 0.91 above 1200 N/mm2."""
    assert (iso2.C_ZL(700.0), iso2.C_ZL(1500.0)) == pytest.approx((0.83, 0.91), abs=1e-4)


def test_stress_grows_with_the_root_of_the_load() -> None:
    first = pitting.pitting(EQUAL, LOAD, MATERIALS, 100e-6)[0]
    raised = replace(
        LOAD, factors=ContactFactors(application=1.2, dynamic=1.1, face_load=1.3, transverse=1.05)
    )
    second = pitting.pitting(EQUAL, raised, MATERIALS, 100e-6)[0]
    assert second.nominal == first.nominal
    assert second.stress / first.stress == pytest.approx((1.2 * 1.1 * 1.3 * 1.05) ** 0.5)
    assert second.load_safety / first.load_safety == pytest.approx(1.0 / (1.2 * 1.1 * 1.3 * 1.05))


def test_equal_gears_are_rated_alike() -> None:
    pinion, wheel = pitting.pitting(EQUAL, LOAD, MATERIALS, 100e-6)
    assert pinion.stress == pytest.approx(wheel.stress, rel=1e-12)
    found = scuffing.contact_temperature(FlankContact(EQUAL, LOAD), STATE)
    assert found.flash == pytest.approx(found.flash[::-1], rel=1e-9)
    films = micropitting.film_ratios(FlankContact(EQUAL, LOAD), STATE, OIL)
    assert films.points == ("A", "AB", "B", "C", "D", "DE", "E")
    assert films.ratio == pytest.approx(films.ratio[::-1], rel=1e-9)


def test_rough_flanks_few_cycles_and_thick_oil_move_the_strength() -> None:
    strength = pitting.pitting(EQUAL, LOAD, MATERIALS, 100e-6)[0].strength
    assert pitting.pitting(EQUAL, LOAD, MATERIALS, 320e-6)[0].strength > strength
    rough = replace(MATERIALS, roughness=(1e-6, 1e-6))
    assert pitting.pitting(EQUAL, LOAD, rough, 100e-6)[0].strength < strength
    short = replace(MATERIALS, cycles=(1e6, 1e8))
    pinion, wheel = pitting.pitting(EQUAL, LOAD, short, 100e-6)
    assert pinion.strength > wheel.strength == strength


def test_face_load_factors_of_root_and_flank_belong_together() -> None:
    """K_Fbeta = K_Hbeta^N_F; b/h = 100/19.2 of ISO/TR 6336-30 example 1 turns 1.16 into 1.128."""
    from tests.published.iso_example import example_1

    assert pitting.face_load_factor(example_1(), 1.12803) == pytest.approx(1.16, abs=5e-4)
    assert pitting.face_load_factor(EQUAL, 1.0) == 1.0


def test_load_is_shared_from_a_third_to_two_thirds_and_not_at_relieved_ends() -> None:
    """Grade 7 and better: (7 - 2)/15 = 1/3 at A, 2/3 before B, all between B and D."""
    contact = FlankContact(EQUAL, LOAD)
    at = contact.points
    s = np.array([at["A"], at["AB"], at["C"], at["E"]])
    assert contact.sharing(s) == pytest.approx([1 / 3, 0.5, 1.0, 1 / 3])
    relieved = FlankContact(EQUAL, replace(LOAD, tip_reliefs=(20e-6, 20e-6), optimum=20e-6))
    assert relieved.sharing(s) == pytest.approx([0.0, 0.5, 1.0, 0.0], abs=1e-12)
    half = FlankContact(EQUAL, replace(LOAD, tip_reliefs=(0.0, 10e-6), optimum=20e-6))
    assert half.sharing(s) == pytest.approx([1 / 6, 0.5, 1.0, 1 / 3])
    coarse = FlankContact(EQUAL, replace(LOAD, grade=9))
    assert coarse.sharing(s)[0] == pytest.approx(7 / 15)


def test_wide_helical_gears_share_evenly_with_a_third_more_at_the_ends() -> None:
    contact = FlankContact(HELICAL, LOAD)
    assert HELICAL.overlap_ratio > 1.0
    s = np.array([HELICAL.path.start, 0.0])
    assert contact.sharing(s) * HELICAL.transverse_contact_ratio == pytest.approx([1.3, 1.0])
    assert np.isfinite(scuffing.contact_temperature(contact, STATE).flash).all()


def test_no_sliding_no_flash() -> None:
    found = scuffing.contact_temperature(FlankContact(EQUAL, LOAD), STATE, np.array([0.0]))
    assert found.flash[0] == 0.0
    assert found.highest == STATE.bulk_temperature


def test_teeth_that_come_into_contact_run_hotter_without_relief() -> None:
    """The driven gear's tip enters at A when the pinion drives, at E when the wheel does."""
    short = replace(LOAD, tip_reliefs=(0.0, 0.0), optimum=30e-6)
    contact = FlankContact(EQUAL, short)
    driving, driven = (
        scuffing.contact_temperature(FlankContact(EQUAL, replace(short, pinion_drives=drives)), STATE).flash
        for drives in (True, False)
    )
    share = contact.points["E"] / EQUAL.path.length
    assert driving[0] / driven[0] == pytest.approx(1.0 + 30.0 / 50.0 * share**3)
    assert driving == pytest.approx(driven[::-1], rel=1e-9)


@pytest.mark.parametrize(
    ("other", "hotter"),
    [
        (replace(LOAD, torque=300.0), True),
        (replace(LOAD, speed=200.0), True),
        (replace(LOAD, torque=200.0), False),
    ],
)
def test_load_and_speed_heat_the_contact(other: FlankLoad, hotter: bool) -> None:
    base = scuffing.contact_temperature(FlankContact(EQUAL, LOAD), STATE).highest
    assert (scuffing.contact_temperature(FlankContact(EQUAL, other), STATE).highest > base) is hotter


def test_scuffing_temperature_by_hand() -> None:
    """80 + (0.85 + 1.4) 0.8 x 10^-0.05 x 12^2 at 10 mPa s; nitrided flanks 1.5."""
    X_L = 0.8 * 10.0**-0.05
    assert scuffing.scuffing_temperature(12.0, 0.8, 0.01) == pytest.approx(353.15 + 2.25 * X_L * 144.0)
    assert scuffing.scuffing_temperature(12.0, 0.8, 0.01, 1.5) == pytest.approx(353.15 + 2.95 * X_L * 144.0)
    found = scuffing.contact_temperature(FlankContact(EQUAL, LOAD), STATE)
    twice = STATE.oil_temperature + 2.0 * (found.highest - STATE.oil_temperature)
    assert scuffing.scuffing_safety(found, STATE, twice) == pytest.approx(2.0)


def test_film_grows_with_speed_and_falls_with_temperature() -> None:
    """U^0.7 at the pitch point, where nothing slides."""
    slow = micropitting.film_ratios(FlankContact(EQUAL, LOAD), STATE, OIL)
    fast = micropitting.film_ratios(FlankContact(EQUAL, replace(LOAD, speed=300.0)), STATE, OIL)
    at = slow.points.index("C")
    assert fast.film[at] / slow.film[at] == pytest.approx(2.0**0.7)
    hot = micropitting.film_ratios(FlankContact(EQUAL, LOAD), replace(STATE, bulk_temperature=393.15), OIL)
    assert hot.least < slow.least
    loaded = slow.points.index("D")  # carries all, as C does, and slides
    assert slow.ratio[loaded] < slow.ratio[at]


def test_pressure_viscosity_over_temperature() -> None:
    """1 + 516 (1/363 - 1/311) = 0.762 at 90 degC, 1 at 38; never below 0.05."""
    assert ts22.alpha_theta(2e-8, np.array([38.0, 90.0])) == pytest.approx([2e-8, 2e-8 * 0.76232], rel=1e-4)
    assert ts22.alpha_38(ts22.alpha_theta(2e-8, np.asarray(80.0)).item(), 80.0) == pytest.approx(2e-8)
    assert ts22.alpha_theta(1.0, np.asarray(900.0)) == 0.05


@pytest.mark.parametrize(
    ("ratio", "factor"), [(1.5, 1.0), (2.0, 1.0), (3.0, 1.282842712), (3.5, 1.3), (6.0, 1.3)]
)
def test_helical_load_factor_of_the_friction(ratio: float, factor: float) -> None:
    assert ts22.K_Bgamma(ratio) == pytest.approx(factor)


def test_what_cannot_be_rated_is_refused() -> None:
    with pytest.raises(DynamicsInputError, match="torque = 0"):
        FlankLoad(torque=0.0, speed=1.0)
    with pytest.raises(DynamicsInputError, match="below 2"):
        ts20.X_Gamma(
            np.zeros(1),
            ts20.PathParameters(A=-1.0, B=0.5, D=-0.5, E=1.0, AU=0.0),
            ts20.Sharing(epsilon_alpha=2.1, epsilon_beta=0.0, grade=5),
        )
    with pytest.raises(DynamicsInputError, match="1 to 14"):
        ts20.Theta_S(20.0, 1.0)
    with pytest.raises(DynamicsInputError, match="above the oil"):
        ts20.S_B(300.0, 90.0, 90.0)

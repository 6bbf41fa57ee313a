"""Flank ratings against ISO/TR 6336-30 example 1, the closed forms of the documents, and the FZG scuffing test."""

from math import pi

import numpy as np
import pytest

from dynamics.gear.pair import GearPair
from dynamics.rating import flank_contact as pitting
from dynamics.rating import micropitting, scuffing
from dynamics.rating.flank_contact import ContactFactors, FlankContact, FlankLoad
from dynamics.rating.iso_rating import RatingOptions, dynamic_factor
from dynamics.standards import iso_ts_6336_20_2017 as ts20
from dynamics.standards import iso_ts_6336_22_2018 as ts22
from rigdesign.properties.oil import FVA_3
from tests.published.iso_example import SPEED, TORQUE, example_1

STEEL = 13.6e3
"""B_M of gear steels [W s^0.5/(m2 K)]."""
WARM = 363.15
FZG_A = GearPair(
    normal_module=4.5e-3,
    teeth=(16, 24),
    centre_distance=91.5e-3,
    face_widths=(20e-3, 20e-3),
    profile_shifts=(0.8532, -0.50),
    tip_diameters=(88.77e-3, 112.5e-3),
)
"""Test gears of the scuffing test A/8.3/90 (DIN ISO 14635-1)."""


def fzg(torque: float) -> FlankContact:
    return FlankContact(FZG_A, FlankLoad(torque=torque, speed=2170.0 * pi / 30.0))


def oil_at_90(roughness: float = 0.4e-6) -> scuffing.FlankFilmState:
    return scuffing.FlankFilmState(
        oil_temperature=WARM,
        bulk_temperature=WARM,
        viscosity=FVA_3.dynamic_viscosity(WARM),
        oil_factor=1.0,
        roughness=roughness,
        thermal_contact=(STEEL, STEEL),
    )


@pytest.fixture(scope="module")
def example() -> tuple[pitting.Pitting, pitting.Pitting]:
    pair = example_1()
    factor = dynamic_factor(pair, TORQUE, SPEED, RatingOptions(grade=5, tip_relief=70e-6))
    sharing = pitting.transverse_load_factor(pair, factor, dynamic=factor.K_V, face_load=1.16)
    assert sharing == 1.0
    turns = SPEED * 30.0 / pi * 60.0 * 50e3
    return pitting.pitting(
        pair,
        FlankLoad(
            torque=TORQUE,
            speed=SPEED,
            factors=ContactFactors(dynamic=factor.K_V, face_load=1.16, transverse=sharing),
        ),
        pitting.FlankMaterials(
            strengths=(1500e6, 1500e6), cycles=(turns, turns * 17.0 / 103.0), roughness=(1e-6, 1e-6)
        ),
        320e-6,
    )


@pytest.mark.parametrize(
    ("symbol", "printed"),
    [
        ("Z_H", "2.39533"), ("Z_E", "189.8117"), ("Z_beta", "1.01944"), ("Z_B", "1"), ("Z_L", "1.04739"),
        ("Z_v", "0.96911"), ("Z_R", "0.96599"), ("Z_NT", "0.91"), ("Z_W", "1"), ("Z_X", "1"),
    ],
)  # fmt: skip
def test_factors_of_the_iso_example_to_their_printed_digits(
    example: tuple[pitting.Pitting, pitting.Pitting], symbol: str, printed: str
) -> None:
    pinion = example[0]
    found = (pinion.stress_factors | pinion.strength_factors)[symbol]
    assert found == pytest.approx(float(printed), abs=0.5 * 10.0 ** -len(printed.partition(".")[2]))


def test_stresses_of_the_iso_example(example: tuple[pitting.Pitting, pitting.Pitting]) -> None:
    """sigma_H and S_H are printed with K_V and K_Hbeta unrounded, which are known to three digits only."""
    pinion, wheel = example
    assert pinion.nominal == pytest.approx(1206.58207e6, rel=1e-7)
    assert (pinion.strength, wheel.strength) == pytest.approx((1338.48050e6, 1414.52551e6), rel=1e-6)
    assert wheel.strength_factors["Z_NT"] == pytest.approx(0.962, abs=5e-4)
    assert pinion.stress == pytest.approx(1301.35343e6, rel=1e-4)
    assert (pinion.safety, wheel.safety) == pytest.approx((1.02853, 1.08696), rel=1e-4)
    assert pinion.load_safety == pytest.approx(pinion.safety**2)


def test_contact_stress_is_hertz_at_the_pitch_point() -> None:
    """A spur pair without contact ratio factor: sigma_H0 / Z_epsilon is the pressure of two cylinders."""
    load = FlankLoad(torque=302.0, speed=227.0)
    rated, _ = pitting.pitting(
        FZG_A,
        load,
        pitting.FlankMaterials(strengths=(1500e6, 1500e6), cycles=(1e8, 1e8), roughness=(4e-7, 4e-7)),
        100e-6,
    )
    contact = FlankContact(FZG_A, load)
    hertz = float(contact.pressure(np.asarray(0.0), 1.0)) * rated.stress_factors["Z_epsilon"]
    # ISO refers F_t to the reference circle, the contact to the base circle: the same force
    assert rated.nominal == pytest.approx(hertz, rel=1e-12)


def closed_form(contact: FlankContact, mu: float, path: np.ndarray) -> np.ndarray:
    """Clause 10 of ISO/TR 13989-1 for cylindrical gears of one steel: mm, N/mm, m/s."""
    pair, modulus = contact.pair, 1e-6 * contact.reduced_modulus
    alpha, Gamma, u = pair.working_pressure_angle, contact.path_parameter(path), pair.gear_ratio
    X_M = modulus**0.25 * np.sqrt(1000.0) / (1e-3 * STEEL)
    first, second = 1.0 + Gamma, 1.0 - Gamma / u
    X_G = 0.51 * np.sqrt(u + 1.0) * np.abs(np.sqrt(first) - np.sqrt(second)) / (first * (u - Gamma)) ** 0.25
    X_alphabeta = 1.22 * (np.sin(alpha) * np.cos(pair.pressure_angle) * np.cos(pair.helix_angle)) ** 0.25
    X_alphabeta /= np.cos(pair.transverse_pressure_angle)
    w_Bt = 1e-3 * contact.load.torque / pair.reference_radii[0] / pair.face_width
    speed = np.sqrt(contact.pitch_line_speed) / (1e3 * pair.centre_distance) ** 0.25
    return np.asarray(mu * X_M * X_alphabeta * X_G * (contact.sharing(path) * w_Bt) ** 0.75 * speed)


@pytest.mark.parametrize("pair", [FZG_A, example_1()], ids=["spur", "helical"])
def test_flash_temperature_is_the_closed_form_for_cylindrical_gears(pair: GearPair) -> None:
    """Blok's 1.11 against the 0.51 x 1.22 of the document, digits as printed."""
    contact = FlankContact(pair, FlankLoad(torque=300.0, speed=227.0))
    path = np.linspace(0.99 * pair.path.start, 0.99 * pair.path.end, 40)
    found = scuffing.contact_temperature(contact, oil_at_90(), path)
    assert found.flash == pytest.approx(closed_form(contact, found.friction, path), rel=2e-3)


@pytest.mark.parametrize(("stage", "torque"), [(8, 239.3), (10, 372.6), (12, 534.5)])
def test_flash_temperature_of_the_scuffing_test(stage: int, torque: float) -> None:
    """Theta_S takes 1.4 X_L S^2 for the flash temperature of the test gears at their load stage."""
    state = oil_at_90()
    flash = scuffing.contact_temperature(fzg(torque), state).flash.max()
    X_L = ts20.lubricant_factor(1.0, 1e3 * state.viscosity)
    assert 1.15 < flash / (1.4 * X_L * stage**2) < 1.25


def test_local_flash_temperature_of_both_documents_agree() -> None:
    """sqrt(pi)/2 of the half-elliptic pressure against Blok's 1.11: 1.7 % apart at one friction coefficient."""
    contact, path = fzg(302.0), np.linspace(FZG_A.path.start, FZG_A.path.end, 9)
    rho, load = contact.reduced_radius(path), contact.line_load(path)
    speeds, modulus = contact.rolling_speeds(path), contact.reduced_modulus
    blok = ts20.Theta_fl(0.05, load, speeds, ts20.band_half_width(load, rho, modulus), (STEEL, STEEL))
    local = ts22.theta_fl(
        0.05, 1e-6 * contact.pressure(path), speeds, 1e3 * rho, 1e-6 * modulus, (STEEL, STEEL)
    )
    assert local / blok == pytest.approx(1.0166, abs=2e-3)


def test_film_is_that_of_dowson_and_higginson() -> None:
    """h_min/rho = 1.6 G^0.6 U^0.7 W^-0.13 of two cylinders without sliding, where S_GF is 1 (pitch point)."""
    contact, state = fzg(302.0), oil_at_90()
    oil = micropitting.Lubricant.known_at(FVA_3.dynamic_viscosity, FVA_3.pressure_viscosity, 353.15)
    found = micropitting.film_ratios(contact, state, oil)
    at = found.points.index("C")
    rho, modulus = 8.382e-3, contact.reduced_modulus
    assert float(contact.reduced_radius(np.asarray(0.0))) == pytest.approx(rho, rel=1e-4)
    share = float(contact.sharing(np.asarray(0.0)))
    assert 1 / 3 < share < 2 / 3  # C of these gears lies in double contact
    w = share * 302.0 / FZG_A.base_radii[0] / 20e-3
    sum_speed = 2.0 * 227.2418 * 13.97008e-3
    eta = FVA_3.dynamic_viscosity(WARM)
    alpha = ts22.alpha_theta(oil.pressure_viscosity, np.asarray(90.0))
    U, W, G = eta * sum_speed / (2.0 * modulus * rho), w / (modulus * rho), alpha * modulus
    assert found.film[at] == pytest.approx(1.6 * rho * G**0.6 * U**0.7 * W**-0.13, rel=1e-3)
    assert found.ratio[at] == pytest.approx(found.film[at] / 0.4e-6)

"""Film coefficients against hand calculations and published values.

Sources: P2 (Figure 11, Formulas 2 to 4); the correlations themselves, evaluated by hand with air properties
at the film temperature; ISO/TR 14179-2. Tolerances are half a unit of the last printed digit, or wider where
the hand value depends on rounded air properties.
"""

import math

import pytest

from thermal.films import convection as films

ZERO = 273.15
AMBIENT = 20.0 + ZERO
TOP_SPEED = 12_000.0 * math.pi / 30.0


def test_niemann_winter_prints_both_values_of_p2() -> None:
    """f_k = 1 and h = 0.40 m give 19.5 at 100 K and 15.09 at 45 K (P2 says about 40 K)."""
    law = films.niemann_winter(height=0.40)
    assert law(AMBIENT + 100.0, AMBIENT).value == pytest.approx(19.505, abs=5e-4)
    assert law(AMBIENT + 45.0, AMBIENT).value == pytest.approx(15.088, abs=1e-3)
    assert law(AMBIENT + 40.0, AMBIENT).value == pytest.approx(14.69, abs=5e-3)


@pytest.mark.parametrize("variant", ["turbulent", "dimensional"])
def test_recknagel_candidates_give_the_clamping_field(variant: str) -> None:
    law = films.recknagel_plate(variant)  # type: ignore[arg-type]
    assert law(AMBIENT + 100.0, AMBIENT).value == pytest.approx(6.32, abs=5e-3)


def test_recknagel_candidates_part_at_small_differences() -> None:
    """By hand, 2.0 * 25^(1/4) = 4.472 against 0.125 k Ra^(1/3) = 4.32 with air of 32.5 degC."""
    turbulent, dimensional = (
        films.recknagel_plate(variant)(AMBIENT + 25.0, AMBIENT).value
        for variant in ("turbulent", "dimensional")  # type: ignore[arg-type]
    )
    assert dimensional == pytest.approx(4.472, abs=5e-4)
    assert turbulent == pytest.approx(4.32, abs=5e-3)


def test_jungnickel_cylinder_gap_and_their_series_make_the_nut_value_of_p2() -> None:
    """r = 40 mm and s = 0.6 mm at 12,000 rpm: 152.9 and 122.9, in series 68.13; P2 prints 68."""
    cylinder = films.rotating_cylinder_jungnickel(TOP_SPEED, 0.080)
    gap = films.narrow_gap_jungnickel(TOP_SPEED, 0.040, 0.6e-3)
    assert cylinder(400.0, 300.0).value == pytest.approx(152.9, abs=0.05)
    assert gap(400.0, 300.0).value == pytest.approx(122.9, abs=0.05)
    assert films.series(cylinder, gap)(400.0, 300.0).value == pytest.approx(68.13, abs=5e-3)


def test_series_makes_the_other_values_of_p2() -> None:
    """300 behind 300 is 150; 300 behind 100, or 150 behind 150, is 75."""
    oil = films.oil_wetted()
    hundred = films.constant(100.0, "by hand")
    half = films.series(oil, oil)
    assert half(400.0, 300.0).value == pytest.approx(150.0, rel=1e-14)
    assert films.series(oil, hundred)(400.0, 300.0).value == pytest.approx(75.0, rel=1e-14)
    assert films.series(half, half)(400.0, 300.0).value == pytest.approx(75.0, rel=1e-14)


@pytest.mark.parametrize(
    ("housing_film", "ratio"), [(300.0, 4.13470), (150.0, 8.26940), (75.0, 16.53880), (19.5, 63.6108)]
)
def test_formula_4_arithmetic(housing_film: float, ratio: float) -> None:
    """1240.41 W/m2K follows from any of P2's films and the area ratio it implies."""
    assert films.formula_4(housing_film, ratio, 1.0)(300.0, 300.0).value == pytest.approx(1240.41, abs=5e-3)


def test_rotating_cylinders_at_the_test_speed() -> None:
    """80 mm in air of 90 degC: Becker 146.7, Kays/Bjorklund 141.7, Etemad 141.4; all within 8 % of 152.9."""
    wall = 90.0 + ZERO
    laws = {
        films.rotating_cylinder_becker: 146.7,
        films.rotating_cylinder_kays_bjorklund: 141.7,
        films.rotating_cylinder_etemad: 141.4,
    }
    for law, expected in laws.items():
        value = law(TOP_SPEED, 0.080)(wall, wall).value
        assert value == pytest.approx(expected, rel=1e-3)
        assert value == pytest.approx(152.9, rel=0.08)


def test_taylor_vortices_and_jungnickel_agree_on_the_seal_gap() -> None:
    """Two sources that share nothing: 124.6 (air of 90 degC) against 122.9 W/m2K, 3 % apart at most."""
    value = films.narrow_gap_taylor(TOP_SPEED, 0.040, 0.6e-3)(90.0 + ZERO, 90.0 + ZERO).value
    assert value == pytest.approx(122.9, rel=0.03)


def test_narrow_gap_below_the_onset_of_vortices_is_conduction() -> None:
    """k/s with k = 0.0263 W/mK of air at 300 K (Incropera, Table A.4)."""
    assert films.narrow_gap_taylor(10.0, 0.040, 0.6e-3)(300.0, 300.0).value == pytest.approx(
        0.0263 / 0.6e-3, rel=5e-3
    )


def test_iso_tr_14179_2() -> None:
    """By hand at h = 0.4 m: 19.7272 * 0.72422 = 14.287 at 100 K, 19.7272 * 0.56995 = 11.244 at 45 K."""
    law = films.iso_tr_14179_2_free(0.40)
    assert law(AMBIENT + 100.0, AMBIENT).value == pytest.approx(14.287, abs=1e-3)
    assert law(AMBIENT + 45.0, AMBIENT).value == pytest.approx(11.2435, abs=5e-4)


def test_free_convection_of_a_housing_is_far_below_niemann_winter() -> None:
    """Churchill/Chu on 0.4 m: 6.4 at 100 K and 5.3 at 45 K; with radiation of eps 0.6 still below 19.5."""
    law = films.vertical_plate_churchill(0.40)
    assert law(AMBIENT + 100.0, AMBIENT).value == pytest.approx(6.4, abs=0.05)
    assert law(AMBIENT + 45.0, AMBIENT).value == pytest.approx(5.3, abs=0.05)
    radiation = 0.6 * 5.670374e-8 * ((393.15**2 + 293.15**2) * (393.15 + 293.15))
    assert law(AMBIENT + 100.0, AMBIENT).value + radiation < 0.65 * 19.505


def test_horizontal_plates_on_the_field_of_p2() -> None:
    """1.6 m x 4 m, A/P = 0.571 m, 100 K: McAdams 7.59, VDI 5.60, Churchill (vertical) 6.21 W/m2K."""
    length = 1.6 * 4.0 / (2.0 * (1.6 + 4.0))
    for law, expected in (
        (films.horizontal_plate_mcadams, 7.59),
        (films.horizontal_plate_vdi, 5.60),
        (films.vertical_plate_churchill, 6.21),
    ):
        assert law(length)(AMBIENT + 100.0, AMBIENT).value == pytest.approx(expected, abs=0.01)


def test_vdi_plate_by_hand() -> None:
    """The stirred side term by term with numbers of air at 70 degC written out here, not through the air module.

    nu = 1.99e-5 m2/s, k = 0.0294 W/(m K), Pr = 0.705, beta = 1/343.15 K: Ra = 9.80665 * 100 * 0.5714^3 / (343.15 *
    nu^2) * Pr = 9.49e8; f2 = (1 + (0.322/0.705)^0.55)^(-20/11) = 0.402; Nu = 0.15 (Ra f2)^(1/3) = 108.8. With the
    exponent of the other sign it would be 1.84 times as much.
    """
    length = 1.6 * 4.0 / 11.2
    rayleigh = 9.80665 * 100.0 * length**3 / (343.15 * 1.99e-5**2) * 0.705
    factor = (1.0 + (0.322 / 0.705) ** 0.55) ** (-20.0 / 11.0)
    assert factor < 1.0
    by_hand = 0.15 * (rayleigh * factor) ** (1.0 / 3.0) * 0.0294 / length
    ours = films.horizontal_plate_vdi(length)(AMBIENT + 100.0, AMBIENT).value
    assert ours == pytest.approx(by_hand, rel=0.01)


def test_laws_of_rotating_cylinders_lie_together_at_12000_rpm_and_80_mm() -> None:
    """Air at 90 degC: Becker 146.7, Kays and Bjorklund 141.7, Etemad 141.4; Dropkin and Carmi 73/76 of Etemad."""
    speed, wall = 12000.0 * math.pi / 30.0, 90.0 + ZERO
    found = {
        law: getattr(films, f"rotating_cylinder_{law}")(speed, 0.080)(wall, wall).value
        for law in ("becker", "kays_bjorklund", "etemad", "dropkin_carmi")
    }
    assert found["becker"] == pytest.approx(146.7, abs=0.5)
    assert found["kays_bjorklund"] == pytest.approx(141.7, abs=0.5)
    assert found["etemad"] == pytest.approx(141.4, abs=0.5)
    assert found["dropkin_carmi"] == pytest.approx(73.0 / 76.0 * found["etemad"], rel=1e-12)


def test_rohsenow_plate_on_the_field_of_p2() -> None:
    """7.11 W/(m2 K) on A/P = 0.571 m at 100 K (thermal sheet b, through ht): beside McAdams' 7.59."""
    film = films.horizontal_plate_rohsenow(1.6 * 4.0 / 11.2)(AMBIENT + 100.0, AMBIENT)
    assert film.value == pytest.approx(7.11, abs=0.02)
    assert film.warnings == ()


def test_vdi_exponent_is_not_the_one_of_the_library() -> None:
    """f2 lowers the Rayleigh number; ht 1.2.0 raises it, and gets 1.84 times the coefficient in air."""
    from ht.conv_free_immersed import Nu_horizontal_plate_VDI

    from thermal.films.still import air

    gas = air(AMBIENT + 50.0)
    length = 1.6 * 4.0 / 11.2
    ours = films.horizontal_plate_vdi(length)(AMBIENT + 100.0, AMBIENT)
    theirs = Nu_horizontal_plate_VDI(gas.prandtl, ours.inputs["rayleigh"] / gas.prandtl, buoyancy=True)
    exponent = 2.0 * 20.0 / 11.0 / 3.0
    ratio = (1.0 + (0.322 / gas.prandtl) ** 0.55) ** exponent
    assert theirs * gas.conductivity / length == pytest.approx(ours.value * ratio, rel=1e-9)
    assert ratio == pytest.approx(1.84, abs=0.01)


def test_disc_mean_joins_laminar_and_turbulent() -> None:
    """By hand at 90 degC and Re = 1e6: x = 0.5, Nu = 0.36*1000*0.25 + 0.015*63096*(1 - 0.165) = 880."""
    from thermal.films.still import air

    gas = air(90.0 + ZERO)
    radius = 0.1
    speed = 1e6 * gas.kinematic_viscosity / radius**2
    film = films.rotating_disc(speed, radius)(90.0 + ZERO, 90.0 + ZERO)
    assert film.inputs["laminar_share_of_radius"] == pytest.approx(0.5)
    assert film.value * radius / gas.conductivity == pytest.approx(880.3, rel=1e-3)


def test_bearing_film_by_hand() -> None:
    """k = 0.14 W/mK over 40 um: 3500 W/m2K wall to wall, twice that from the middle of the film."""
    assert films.bearing_film(0.14, 40e-6, nusselt=1.0)(300.0, 300.0).value == pytest.approx(3500.0)
    assert films.bearing_film(0.14, 40e-6)(300.0, 300.0).value == pytest.approx(7000.0)

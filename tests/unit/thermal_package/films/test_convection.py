"""What every film law has in common: provenance, ranges, refusals, behaviour at the ends."""

import math
from collections.abc import Callable

import pytest

from thermal.films import convection as films
from thermal.films.law import FilmLaw
from thermal.films.still import AirRangeError, air

WALL, FLUID = 360.0, 293.15
LAWS: dict[str, Callable[[], FilmLaw]] = {
    "niemann_winter": lambda: films.niemann_winter(0.28),
    "recknagel_plate_turbulent": lambda: films.recknagel_plate("turbulent", length=1.0),
    "recknagel_plate_dimensional": lambda: films.recknagel_plate("dimensional"),
    "vertical_plate_churchill": lambda: films.vertical_plate_churchill(0.28),
    "horizontal_plate_mcadams": lambda: films.horizontal_plate_mcadams(0.1),
    "horizontal_plate_rohsenow": lambda: films.horizontal_plate_rohsenow(0.1),
    "horizontal_plate_vdi": lambda: films.horizontal_plate_vdi(0.1),
    "horizontal_cylinder_churchill_chu": lambda: films.horizontal_cylinder_churchill_chu(0.04),
    "iso_tr_14179_2_free": lambda: films.iso_tr_14179_2_free(0.28),
    "forced_air_plate": lambda: films.forced_air_plate(3.0, 0.4, 0.28),
    "rotating_cylinder_jungnickel": lambda: films.rotating_cylinder_jungnickel(1000.0, 0.04),
    "rotating_disc_jungnickel": lambda: films.rotating_disc_jungnickel(1000.0, 0.05),
    "narrow_gap_jungnickel": lambda: films.narrow_gap_jungnickel(1000.0, 0.02, 5e-4),
    "rotating_cylinder_becker": lambda: films.rotating_cylinder_becker(1000.0, 0.04),
    "rotating_cylinder_kays_bjorklund": lambda: films.rotating_cylinder_kays_bjorklund(1000.0, 0.04),
    "rotating_cylinder_etemad": lambda: films.rotating_cylinder_etemad(1000.0, 0.04),
    "rotating_cylinder_dropkin_carmi": lambda: films.rotating_cylinder_dropkin_carmi(1200.0, 0.05),
    "rotating_disc": lambda: films.rotating_disc(1000.0, 0.05),
    "narrow_gap_taylor": lambda: films.narrow_gap_taylor(1000.0, 0.02, 5e-4),
    "constant": lambda: films.constant(12.0, "measured"),
    "oil_wetted": films.oil_wetted,
    "bearing_film": lambda: films.bearing_film(0.14, 30e-6),
}


@pytest.mark.parametrize("name", LAWS)
def test_every_film_says_where_it_comes_from(name: str) -> None:
    film = LAWS[name]()(WALL, FLUID)
    assert film.formula == name
    assert math.isfinite(film.value)
    assert film.value > 0.0
    assert film.source
    assert film.valid_range
    assert film.inputs
    assert all(math.isfinite(number) for number in film.inputs.values())
    assert film.warnings == ()


@pytest.mark.parametrize("name", LAWS)
def test_no_film_turns_negative_or_infinite_without_a_temperature_difference(name: str) -> None:
    value = LAWS[name]()(FLUID, FLUID).value
    assert math.isfinite(value)
    assert value >= 0.0


def test_every_law_is_exported_and_covered_here() -> None:
    apart = {"FilmError", "series", "scaled", "ribbed", "formula_4"}
    exported = {"recknagel_plate" if name.startswith("recknagel_plate") else name for name in LAWS}
    assert exported | apart == set(films.__all__)


@pytest.mark.parametrize(
    "name", ["niemann_winter", "recknagel_plate_turbulent", "vertical_plate_churchill", "iso_tr_14179_2_free"]
)
def test_still_films_are_even_in_the_difference_at_one_film_temperature(name: str) -> None:
    law = LAWS[name]()
    warm, cold = law(FLUID + 30.0, FLUID).value, law(FLUID, FLUID + 30.0).value
    fluid_enters = name == "iso_tr_14179_2_free"
    assert cold == pytest.approx(warm, rel=0.03 if fluid_enters else 1e-12)


def test_a_warm_plate_facing_down_and_a_cold_one_facing_up_are_calm() -> None:
    factories = films.horizontal_plate_mcadams, films.horizontal_plate_vdi, films.horizontal_plate_rohsenow
    for factory in factories:
        stirred = factory(0.5, "up")(WALL, FLUID).value
        calm = factory(0.5, "down")(WALL, FLUID).value
        assert calm < 0.6 * stirred
        assert factory(0.5, "down")(FLUID, WALL).value == pytest.approx(stirred)
        assert factory(0.5, "up")(FLUID, WALL).value == pytest.approx(calm)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (films.niemann_winter(6.0), ("housing height = 6 m", "0.1 to 3 m")),
        (films.niemann_winter(0.3, place_factor=5.0), ("f_k = 5", "measured")),
        (films.rotating_cylinder_becker(1.0, 0.04), ("Reynolds number", "800 to 400000", "free-convection")),
        (films.rotating_cylinder_becker(1e5, 0.2), ("Reynolds number", "another law for rotating")),
        (films.rotating_cylinder_jungnickel(0.0, 0.04), ("speed = 0", "free-convection")),
        (films.rotating_disc(1e5, 0.2, density=5.0), ("Reynolds number", "another law for rotating")),
        (
            films.rotating_cylinder_dropkin_carmi(100.0, 0.04),
            ("Reynolds number", "15000 to 430000", "free-convection"),
        ),
        (films.horizontal_cylinder_churchill_chu(0.04, 10.0), ("speed = 10 rad/s", "rotating shafts")),
        (films.rotating_disc(0.1, 0.02), ("Reynolds number", "free-convection")),
        (films.narrow_gap_taylor(1000.0, 0.02, 5e-3), ("gap / radius = 0.25", "wider-gap")),
        (films.horizontal_plate_mcadams(1e-3), ("Rayleigh number", "10000 to 1e+11")),
        (films.oil_wetted(3e5), ("oil film = 3e+05", "check the unit")),
        (films.bearing_film(0.14, 30.0), ("film thickness = 30 m", "check the unit")),
        (films.bearing_film(0.14, 30e-6, 0.9), ("Nusselt number of the film = 0.9", "1 to 6")),
        (films.bearing_film(0.14, 30e-6, 6.1), ("Nusselt number of the film = 6.1", "1 to 6")),
        (films.formula_4(300.0, 4.0, 1.0), ("1200 W/(m2 K)", "use bearing_film")),
        (films.recknagel_plate("turbulent", length=0.01), ("Rayleigh number", "horizontal_plate_mcadams")),
    ],
)
def test_outside_its_range_a_film_warns_by_name_value_limit_and_remedy(
    law: FilmLaw, words: tuple[str, ...]
) -> None:
    warnings = law(WALL, FLUID).warnings
    assert len(warnings) == 1
    for word in words:
        assert word in warnings[0]


def test_a_scaled_film_keeps_its_provenance_and_says_its_factor() -> None:
    plain, scaled = films.niemann_winter(0.3), films.scaled(films.niemann_winter(0.3), 1.25)
    assert films.scaled(plain, 1.0) is plain
    one, other = plain(WALL, FLUID), scaled(WALL, FLUID)
    assert other.value == pytest.approx(1.25 * one.value)
    assert other.inputs == one.inputs | {"film_factor": 1.25}
    assert (other.formula, other.source, other.valid_range) == (one.formula, one.source, one.valid_range)
    with pytest.raises(films.FilmError, match="film factor = 0"):
        films.scaled(plain, 0.0)


def test_a_wall_colder_than_the_air_warns_for_the_housing_formula() -> None:
    film = films.niemann_winter(0.3)(FLUID - 20.0, FLUID)
    assert "below 0 K" in film.warnings[0]
    assert film.value == films.niemann_winter(0.3)(FLUID + 20.0, FLUID).value


@pytest.mark.parametrize(
    "make",
    [
        lambda: films.niemann_winter(0.0),
        lambda: films.niemann_winter(0.3, place_factor=-1.0),
        lambda: films.recknagel_plate("1/4"),  # type: ignore[arg-type]
        lambda: films.recknagel_plate(length=-1.0),
        lambda: films.vertical_plate_churchill(math.nan),
        lambda: films.horizontal_plate_vdi(1.0, "sideways"),  # type: ignore[arg-type]
        lambda: films.rotating_cylinder_becker(-1.0, 0.04),
        lambda: films.rotating_disc(math.inf, 0.04),
        lambda: films.rotating_disc(1000.0, 0.04, density=0.0),
        lambda: films.narrow_gap_jungnickel(1.0, 0.02, 0.0),
        lambda: films.constant(-5.0, "measured"),
        lambda: films.constant(5.0, "  "),
        lambda: films.formula_4(300.0, 4.0, 0.0),
        lambda: films.bearing_film(0.14, 0.0),
    ],
)
def test_impossible_inputs_are_refused_when_the_law_is_made(make: Callable[[], FilmLaw]) -> None:
    with pytest.raises(films.FilmError):
        make()


def test_refusal_names_quantity_value_limit_and_remedy() -> None:
    with pytest.raises(
        films.FilmError, match=r"gap = -0\.001 m must be greater than 0; give a positive number"
    ):
        films.narrow_gap_taylor(1.0, 0.02, -1e-3)


def test_series_keeps_inputs_sources_and_warnings_of_both() -> None:
    film = films.series(films.niemann_winter(6.0), films.formula_4(300.0, 4.0, 1.0))(WALL, FLUID)
    assert film.inputs["first.height"] == 6.0
    assert film.inputs["second.housing_area"] == 4.0
    assert film.inputs["first"] * film.inputs["second"] / (
        film.inputs["first"] + film.inputs["second"]
    ) == pytest.approx(film.value)
    assert len(film.warnings) == 2
    assert "Formula 2" in film.source
    assert "Formula 4" in film.source


def test_series_with_no_film_at_all_is_zero() -> None:
    nothing = films.constant(0.0, "vacuum")
    assert films.series(nothing, nothing)(WALL, FLUID).value == 0.0


@pytest.mark.parametrize(
    "law",
    [
        films.rotating_cylinder_jungnickel(1257.0, 0.042),
        films.rotating_disc_jungnickel(1257.0, 0.05),
        films.narrow_gap_jungnickel(1257.0, 0.021, 6e-4),
    ],
)
def test_constants_of_room_air_warn_in_a_hot_chamber(law: FilmLaw) -> None:
    assert law(330.0, 300.0).warnings == ()
    (warning,) = law(440.0, 408.0).warnings
    assert "film temperature = 424 K" in warning
    assert "283.15 to 333.15 K" in warning
    assert "air at the film temperature" in warning


def test_hot_air_cools_a_disc_less_than_room_air_and_a_gap_more() -> None:
    """At 12,000 rpm and 135 degC the fixed constants read 136 for a disc of 50 mm, 80 for a gap of 0.6 mm."""
    hot = 408.15
    disc, gap = films.rotating_disc(1257.0, 0.05), films.narrow_gap_taylor(1257.0, 0.021, 6e-4)
    assert disc(hot, hot).value == pytest.approx(83.0, rel=0.02)
    assert gap(hot, hot).value == pytest.approx(106.0, rel=0.02)
    assert films.rotating_disc_jungnickel(1257.0, 0.05)(hot, hot).value == pytest.approx(136.0, rel=0.01)
    assert films.narrow_gap_jungnickel(1257.0, 0.021, 6e-4)(hot, hot).value == pytest.approx(80.0, rel=0.02)


def test_mist_density_acts_through_the_reynolds_number() -> None:
    """Becker goes with density^(2/3); at the density of air the mist is air."""
    gas = air(0.5 * (WALL + FLUID))
    plain = films.rotating_cylinder_becker(1000.0, 0.04)(WALL, FLUID).value
    same = films.rotating_cylinder_becker(1000.0, 0.04, gas.density)(WALL, FLUID).value
    thick = films.rotating_cylinder_becker(1000.0, 0.04, 8.0 * gas.density)(WALL, FLUID)
    assert same == pytest.approx(plain, rel=1e-12)
    # Pr = mu c / k does not know the density
    assert thick.value == pytest.approx(4.0 * plain, rel=1e-12)
    assert thick.inputs["density"] == pytest.approx(8.0 * gas.density)


def test_kays_bjorklund_holds_at_standstill() -> None:
    film = films.rotating_cylinder_kays_bjorklund(0.0, 0.08)(WALL, FLUID)
    still = films.horizontal_cylinder_churchill_chu(0.08)(WALL, FLUID)
    assert film.warnings == ()
    assert film.value == pytest.approx(still.value, rel=0.3)


def test_air_at_300_k() -> None:
    """Textbook table of dry air at 1 atm and 300 K: 1.177 kg/m3, 1.85e-5 Pa s, 0.0263 W/mK, Pr 0.707."""
    gas = air(300.0)
    assert gas.density == pytest.approx(1.177, abs=1e-3)
    assert gas.viscosity == pytest.approx(1.85e-5, rel=5e-3)
    assert gas.conductivity == pytest.approx(0.0263, rel=5e-3)
    assert gas.prandtl == pytest.approx(0.708, abs=5e-3)
    assert gas.kinematic_viscosity == pytest.approx(1.57e-5, rel=1e-2)
    assert air(300.0) is gas


@pytest.mark.parametrize("temperature", [150.0, 1200.0, math.nan])
def test_air_out_of_range_is_an_error(temperature: float) -> None:
    with pytest.raises(AirRangeError, match="200 to 1000 K; check the wall"):
        air(temperature)

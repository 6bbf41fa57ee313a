"""Audits on the published numbers of P2 and on made-up fields."""

import numpy as np
import pytest

from thermal.conditions.boundary import Adiabatic, Film, Radiation
from thermal.conduction.setup import (
    assumed_difference,
    audit_conditions,
    least_radiation,
    radiation_counted_twice,
    radiation_too_small,
)
from thermal.films import convection as films
from thermal.films.law import STEFAN_BOLTZMANN, FilmLaw

AMBIENT = 293.15


def test_clamping_field_of_p2_cannot_radiate_so_little() -> None:
    """P2 prints 706 W beside 1179 W at 6.3 W/m2K and eps 0.94; at least 1005 W belong to them."""
    assert least_radiation(0.94, AMBIENT, 6.3, 1179.0) == pytest.approx(1005.0, abs=0.5)
    text = radiation_too_small(
        "field_top", convection=1179.0, radiation=706.0, emissivity=0.94, film=6.3, ambient=AMBIENT
    )
    assert text is not None
    for word in ("field_top", "706 W", "1005 W", "1.42 times"):
        assert word in text


def test_housing_of_p2_passes_the_bound() -> None:
    """Lower bound 359 W for both parts of the housing together, printed 617 W."""
    least = least_radiation(0.6, AMBIENT, 19.5, 800.0) + least_radiation(0.6, AMBIENT, 15.09, 962.0)
    assert least == pytest.approx(359.0, abs=0.5)
    warm = radiation_too_small(
        "outer_warm", convection=800.0, radiation=300.0, emissivity=0.6, film=19.5, ambient=AMBIENT
    )
    assert warm is None


def test_bound_holds_for_any_field() -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        temperature = AMBIENT + rng.uniform(-80.0, 200.0, 40)
        convection = 6.3 * float(np.mean(temperature - AMBIENT))
        radiation = 0.9 * STEFAN_BOLTZMANN * float(np.mean(temperature**4 - AMBIENT**4))
        assert radiation >= least_radiation(0.9, AMBIENT, 6.3, convection)


def test_no_convection_and_negative_radiation() -> None:
    def audit(convection: float, radiation: float) -> str | None:
        return radiation_too_small(
            "a", convection=convection, radiation=radiation, emissivity=0.9, film=6.0, ambient=AMBIENT
        )

    assert audit(0.0, 0.0) is None
    assert audit(-10.0, -9.0) is None
    text = audit(10.0, -9.0)
    assert text is not None
    assert "times" not in text


def test_assumed_difference_names_the_coefficient_it_costs() -> None:
    """Seed case: 45 K assumed in the cold section, 59 K solved; Niemann/Winter then gives 16.2, not 15.1."""
    text = assumed_difference(
        "outer_cold_front",
        assumed=45.0,
        solved=59.0,
        law=films.niemann_winter(0.4),
        fluid_temperature=AMBIENT,
    )
    assert text is not None
    for word in ("outer_cold_front", "45 K", "59 K", "16.21 instead of 15.09", "+7 %"):
        assert word in text
    assert assumed_difference("a", assumed=45.0, solved=49.0) is None
    bare = assumed_difference("a", assumed=45.0, solved=30.0)
    assert bare is not None
    assert "coefficient" not in bare


def test_field_of_p2_was_computed_for_another_difference() -> None:
    """6.3 was taken at 100 K; a mean of 29 K gives a third less."""
    text = assumed_difference(
        "field_top", assumed=100.0, solved=29.0, law=films.recknagel_plate("dimensional"),
        fluid_temperature=AMBIENT,
    )  # fmt: skip
    assert text is not None
    assert "-27 %" in text


PUBLISHED = films.constant(19.5, "P2 Figure 11", "niemann_winter_as_published", radiation_included=True)


@pytest.mark.parametrize(
    ("law", "radiating", "speaks"),
    [
        (films.niemann_winter(0.4), True, True),
        (PUBLISHED, True, True),
        (films.niemann_winter(0.4), False, False),
        (films.iso_tr_14179_2_free(0.4), True, False),
        (films.scaled(films.niemann_winter(0.4), 0.7), True, True),
    ],
)
def test_double_count(law: FilmLaw, radiating: bool, speaks: bool) -> None:
    film = law(AMBIENT + 50.0, AMBIENT)
    assert (radiation_counted_twice("outer_warm", film, radiating) is not None) is speaks


def test_double_count_in_a_list_of_conditions() -> None:
    def film(surface: str, law: FilmLaw) -> Film:
        return Film(surface=surface, kind="air", fluid_temperature=AMBIENT, law=law)

    def radiation(surface: str, emissivity: float = 0.6) -> Radiation:
        return Radiation(surface=surface, emissivity=emissivity, surroundings_temperature=AMBIENT)

    found = audit_conditions(
        [
            radiation("outer_warm"),
            film("outer_warm", films.niemann_winter(0.4)),
            film("outer_cold_front", films.niemann_winter(0.4)),
            film("outer_cold_rear", PUBLISHED),
            radiation("outer_cold_rear"),
            film("field_top", films.recknagel_plate()),
            radiation("field_top"),
            film("bare", films.niemann_winter(0.4)),
            radiation("bare", 0.0),
            Adiabatic(surface="field_bottom"),
        ]
    )
    assert [text.split(":")[0] for text in found] == ["outer_warm", "outer_cold_rear"]

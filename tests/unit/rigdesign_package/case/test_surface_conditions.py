"""Boundary conditions of the case say themselves what they need of a surface and which law they stand for there."""

from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import pytest

from rigdesign import load_case
from rigdesign.case.films import (
    BathFilm,
    NiemannWinter,
    RotatingCylinder,
    ShaftPlace,
    SurfaceFilm,
    SurfacePlace,
    SurfaceSite,
    VerticalPlate,
)
from rigdesign.case.rules.surfaces import _on_their_surfaces
from rigdesign.case.surface_conditions import (
    PRINTED_LAWS,
    BearingFilm,
    Condition,
    ConstantFilm,
    FlankFilm,
    GapExchange,
    SurfaceExchange,
    TakenFrom,
)
from tests.builders.fzg_case import fzg_case
from thermal.films import convection

WALL = SurfaceSite(surface="outer_warm", housing_height=0.28, on_shaft=False, has_teeth=False)
SHAFT = ShaftPlace(speed=1200.0, diameter=0.04, seal_gap=6e-4)


def test_every_condition_is_a_film_or_an_exchange_or_needs_no_law_of_its_own() -> None:
    union, _ = get_args(Condition)
    without = {
        kind.__name__ for kind in get_args(union) if not issubclass(kind, SurfaceFilm | SurfaceExchange)
    }
    assert without == {"FlankFilm", "BearingFilm", "ThermalRadiation", "FixedTemperature", "Insulated"}


def test_a_plate_takes_the_height_of_its_place_or_its_own() -> None:
    film = NiemannWinter(surfaces=("outer_warm",), law="niemann_winter", film_factor=0.5)
    own = film.model_copy(update={"height": 0.4})
    for entry, height in ((film, 0.28), (own, 0.4)):
        found = entry.film_law(SurfacePlace(height=0.28))(340.0, 293.15)
        assert found.value == 0.5 * convection.niemann_winter(height)(340.0, 293.15).value
        assert found.radiation_included
    assert [fault.path for fault in own.faults_on(WALL)] == ["height"]
    assert not list(film.faults_on(WALL))


def test_a_film_of_a_shaft_turns_in_mist_only_where_it_says_so() -> None:
    place = SurfacePlace(height=0.28, shaft=SHAFT, mist_density=5.0)
    dry, wet = (
        RotatingCylinder(surfaces=("s",), law="rotating_cylinder", fluid="gear_oil_mean", medium=medium)
        for medium in ("air", "mist")
    )
    assert dry.film_law(place)(340.0, 330.0).inputs["density"] < 2.0
    assert wet.film_law(place)(340.0, 330.0).inputs["density"] == 5.0
    assert [fault.path for fault in dry.faults_on(WALL)] == ["surfaces"]


@pytest.mark.parametrize(("law", "contains"), [("niemann_winter", True), ("iso_tr_14179_2", False)])
def test_a_printed_coefficient_contains_the_radiation_of_its_law(law: str, contains: bool) -> None:
    taken = TakenFrom.model_validate(
        {"temperature_difference": "100 K", "law": law, "height": "0.4 m"},
    )
    film = ConstantFilm.model_validate(
        {
            "surfaces": ("outer_warm",), "law": "constant_film", "fluid": "ambient", "taken_from": taken,
            "heat_transfer_coefficient": "19.5 W/(m2 K)",
        }
    )  # fmt: skip
    assert film.radiation_included(SurfacePlace(height=0.28)) is contains
    bare = film.model_copy(update={"taken_from": taken.model_copy(update={"height": None})})
    assert [fault.path for fault in bare.faults_on(WALL)] == ["taken_from.height"]


def test_a_printed_coefficient_may_come_from_every_law_that_needs_no_more_than_a_height() -> None:
    assert {"niemann_winter", "iso_tr_14179_2", "recknagel_plate", "vertical_plate"} == set(PRINTED_LAWS)
    assert PRINTED_LAWS["vertical_plate"] is VerticalPlate


def test_gaps_and_flanks_ask_for_seals_and_teeth() -> None:
    gap = GapExchange(surfaces=("s_*",), law="narrow_gap", partner="bore_*")
    assert gap.partner_of(("front",)) == "bore_front"
    assert [fault.path for fault in gap.faults_on(replace(WALL, on_shaft=True))] == ["gap"]
    seal = SurfaceSite(
        surface="s", housing_height=0.28, on_shaft=True, has_teeth=False, seal="pinion", seal_gap=6e-4
    )
    assert not list(gap.faults_on(seal))
    film = FlankFilm(surfaces=("outer_warm",), law="flank_film", correlation="constant")
    assert [fault.path for fault in film.faults_on(WALL)] == ["surfaces", "heat_transfer_coefficient"]


def test_walls_over_a_sump_have_the_film_of_the_standard() -> None:
    film = BathFilm.model_validate({"surfaces": ("chamber_*",), "law": "bath", "film_factor": 0.5})
    coefficient = film.film_law(SurfacePlace(height=0.28, wetted_share=0.8))(350.0, 363.15)
    assert coefficient.value == pytest.approx(0.5 * 0.8 * 200.0)
    assert "ISO/TR 14179-2" in coefficient.source
    assert (film.wetted_by, film.usual_film) == ("gear_oil_mean", False)
    assert not film.radiation_included(SurfacePlace(height=0.28))
    usual = BathFilm.model_validate({"surfaces": ("chamber_*",), "law": "bath"})
    assert usual.usual_film


def test_the_film_of_the_standard_is_an_assumption(tmp_path: Path) -> None:
    path = fzg_case(tmp_path, sumps=dict.fromkeys(("test", "slave"), ', sump_temperature = "90 degC"'))
    oiled = 'law = "constant_film", heat_transfer_coefficient = "300 W/(m2 K)", fluid = "gear_oil_mean" }'
    text = path.read_text()
    assert oiled in text
    path.write_text(text.replace(oiled, 'law = "bath" }'))
    records = {record.path: record for record in load_case(path).assumptions}
    found = records["gearboxes.test.housing.boundary.oil.film_factor"]
    assert (found.value, found.range) == ("1", ("0.5", "1.5"))


FOREIGN = {
    "bearing_film": ("outer_warm", "field_bottom", "shaft_test_pinion_warm"),
    "narrow_gap": ("outer_warm", "field_bottom"),
    "flank_film": ("outer_warm", "shaft_test_pinion_warm"),
    "horizontal_cylinder": ("outer_warm",),
}
"""Laws that take something from their surface -> surfaces that do not have it."""


@pytest.mark.parametrize(
    ("law", "surface"), [(law, surface) for law, surfaces in FOREIGN.items() for surface in surfaces]
)
def test_a_law_is_refused_on_a_surface_that_lacks_what_it_takes(law: str, surface: str) -> None:
    """Not met in the solver, where a wall has no film and a shaft away from its bearings none of its own."""
    case = load_case("cases/uhcf_prototype")
    housing = case.gearboxes["test"].housing
    assert housing is not None
    union, _ = get_args(Condition)
    kind = next(one for one in _kinds(union) if law in get_args(one.model_fields["law"].annotation))
    values: dict[str, object] = {"surfaces": (surface,), "law": law}
    if law == "narrow_gap":
        values |= {"partner": "field_top", "gap": "0.6 mm"}
    condition = kind.model_validate(values)
    other = housing.model_copy(update={"boundary": {"foreign": condition}})
    faults = list(_on_their_surfaces("at", case.gearboxes["test"], other, (surface,)))
    assert [fault.path for fault in faults] == ["at.foreign.surfaces"]


def test_bearing_films_join_bores_and_journals() -> None:
    film = BearingFilm(surfaces=("s",), law="bearing_film")
    assert not list(film.faults_on(replace(WALL, in_bearing=True)))


def _kinds(union: object) -> list[Any]:
    """Classes of a union, annotated unions in it included."""
    parts = get_args(union)
    return [kind for part in parts for kind in _kinds(part)] if parts else [union]

"""Every film of a housing has a factor: each coefficient is that many times its law, the balance stays closed."""

from typing import get_args

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import surface_conditions as laws
from rigdesign.case.films import NiemannWinter
from rigdesign.coupling.housing_context import AIR, BEARING_FILM
from rigdesign.coupling.temperatures import boundary_conditions
from tests.builders.twisting import twisting_rig
from tests.builders.warm_prototype import base, case_with, heat_by_kind, open_share, outlet, settled
from thermal.conditions.boundary import Exchange, Film
from thermal.conduction.steady import CLOSURE

pytestmark = pytest.mark.whole_run

FACTOR = 1.7


def coefficients(changes: tuple[tuple[str, object], ...] = ()) -> dict[tuple[str, str], float]:
    """(surface, kind) -> coefficient of every film and exchange at fixed temperatures."""
    rig, result = base()
    changed = twisting_rig(case_with(changes)).with_models(rig.models) if changes else rig
    found = {}
    for condition in boundary_conditions(changed, "test", result.last, radiation_included=False):
        if isinstance(condition, Film):
            found[condition.surface, condition.kind] = condition.law(350.0, 345.0).value
        elif isinstance(condition, Exchange):
            found[condition.surface_a, condition.kind] = condition.law(350.0, 345.0).value
    return found


def entries_with_films() -> list[str]:
    boundary = base()[0].case.gearboxes["test"].housing.boundary
    still = (laws.ThermalRadiation, laws.FixedTemperature, laws.Insulated)
    return [name for name, entry in boundary.items() if not isinstance(entry, still)]


def test_every_law_with_a_coefficient_has_a_factor() -> None:
    union, _ = get_args(laws.Condition)
    without = {law.__name__ for law in get_args(union) if "film_factor" not in law.model_fields}
    assert without == {"ThermalRadiation", "FixedTemperature", "Insulated"}


def test_the_factor_of_an_entry_scales_its_surfaces_alone() -> None:
    plain, seen = coefficients(), set()
    for entry in entries_with_films():
        path = f"gearboxes.test.housing.boundary.{entry}.film_factor"
        moved = coefficients(((path, FACTOR),))
        touched = {place for place in plain if moved[place] != plain[place]}
        assert touched, entry
        for place in touched:
            assert moved[place] == pytest.approx(FACTOR * plain[place], rel=1e-12)
        assert not touched & seen
        seen |= touched
    assert seen == set(plain)


def test_one_factor_for_all_room_air_and_one_for_all_bearing_films() -> None:
    plain = coefficients()
    for key, belongs in (("ambient_film_factor", AIR), ("bearing_film_factor", BEARING_FILM)):
        moved = coefficients(((f"gearboxes.test.housing.{key}", FACTOR),))
        for place, value in plain.items():
            factor = FACTOR if place[1].split(":")[0] == belongs else 1.0
            assert moved[place] == pytest.approx(factor * value, rel=1e-12)


def test_factors_multiply_and_show_as_one() -> None:
    rig, result = base()
    boundary = rig.case.gearboxes["test"].housing.boundary
    entry = next(name for name, e in boundary.items() if isinstance(e, NiemannWinter))
    changes = (
        (f"gearboxes.test.housing.boundary.{entry}.film_factor", 2.0),
        ("gearboxes.test.housing.ambient_film_factor", 0.75),
    )
    changed = twisting_rig(case_with(changes)).with_models(rig.models)
    films = boundary_conditions(changed, "test", result.last, radiation_included=True)
    shown = {
        film.law(350.0, 300.0).inputs.get("film_factor")
        for film in films
        if isinstance(film, Film) and film.law(350.0, 300.0).formula == "niemann_winter"
    }
    assert 1.5 in shown


def test_more_film_takes_more_heat_and_the_balance_stays_closed() -> None:
    (_, before), (rig, after) = settled(), settled(("gearboxes.test.housing.ambient_film_factor", 2.0))
    assert 1.3 < heat_by_kind(after)["air"] / heat_by_kind(before)["air"] < 2.0
    assert outlet(after, "test.gear_oil") < outlet(before, "test.gear_oil") - 0.05
    assert after.fields["test"].solution.balance.closure <= CLOSURE
    assert open_share(rig, after) < 2e-3


def test_a_weak_bearing_film_keeps_the_heat_in_the_oil() -> None:
    """Film temperature above that of its walls or below: what crosses shrinks with the film."""
    (_, before), (rig, after) = settled(), settled(("gearboxes.test.housing.bearing_film_factor", 0.1))
    crossed = [sum(abs(heat) for heat in last.bearing_heat.values()) for last in (before, after)]
    assert crossed[1] < 0.7 * crossed[0]
    assert open_share(rig, after) < 2e-3


@pytest.mark.parametrize("value", [0.0, 11.0])
def test_a_film_factor_has_limits(value: float) -> None:
    with pytest.raises(CaseError, match="bearing_film_factor"):
        case_with((("gearboxes.test.housing.bearing_film_factor", value),))

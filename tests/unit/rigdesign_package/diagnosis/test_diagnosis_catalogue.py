"""Register of the catalogue: an effect says what it needs of a case, everything else follows from its entry."""

from dataclasses import fields
from functools import cache

import pytest

from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import effects as families
from rigdesign.diagnosis.catalogue import effects as registry
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.effects import Effect, UncertainValue
from rigdesign.diagnosis.catalogue.not_modelled import WAITING
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from tests.builders.effects_page import effects_page
from tests.builders.paths import CASES

FAMILIES = [one for one in vars(families).values() if isinstance(one, families.Family)]


@cache
def case_of(name: str) -> Case:
    return load_case(CASES / name / "case.toml")


def oil_mist(part: registry.GearboxPart):
    value = UncertainValue(
        path=f"{part.path}.housing.ambient_film_factor", now=part.housing.ambient_film_factor,
        bounds=(0.5, 2.0), healthy=0.1,
    )  # fmt: skip
    yield value.effect(f"oil_mist:{part.name}", "oil mist in the chamber", families.FILM, "moves the housing")


@pytest.fixture
def registered(monkeypatch):
    monkeypatch.setattr(registry, "_ENTRIES", list(registry._ENTRIES))
    return registry.of_gearbox(housing=True)(oil_mist)


def test_an_effect_that_registers_itself_is_in_the_catalogue_and_on_the_page(registered):
    case = case_of("uhcf_prototype")
    (effect,) = (one for one in effects_of(case) if one.kind == "oil_mist")
    assert effect.name == "oil_mist:test"
    assert effect.changes(case, (0.0,)) == {"gearboxes.test.housing.ambient_film_factor": 1.0}
    page = effects_page([case])
    assert "| `oil_mist` |" in page
    assert page.count("`oil_mist`") == 1, "an effect with an entry waits for nothing"


def test_what_an_effect_needs_keeps_it_off_other_cases(registered):
    bare = [name for name in ("loop_1to1", "uhcf_main") if _lacks(case_of(name), "housing")]
    assert bare
    for name in bare:
        assert not [e for e in effects_of(case_of(name)) if e.kind in ("oil_mist", "ambient_film")]


def _lacks(case: Case, part: str) -> bool:
    return all(getattr(box, part) is None for box in case.gearboxes.values())


def test_every_family_has_an_amplitude_of_the_calibration():
    known = {field.name for field in fields(Amplitudes)}
    assert {family.amplitude for family in FAMILIES} <= known
    assert len({family.name for family in FAMILIES}) == len(FAMILIES)


def test_no_effect_both_waits_and_has_an_entry():
    kinds = {
        effect.kind
        for name in ("loop_1to1", "uhcf_prototype")
        for effect in effects_of(case_of(name), channels=None)
    }
    assert not kinds & {one.name for one in WAITING}


def test_an_entry_survives_the_way_to_another_core():
    import pickle

    effect: Effect = effects_of(case_of("uhcf_prototype"))[0]
    again = pickle.loads(pickle.dumps(effect))
    assert again.family == effect.family
    assert again.oscillates == effect.oscillates


def test_readings_before_steady_temperatures_are_never_named_alone_where_a_cold_part_looks_the_same():
    """A clamping field that was cooled leaves their trace: walls 13 K colder at all points."""
    (effect,) = (one for one in effects_of(case_of("uhcf_prototype")) if one.name == "not_steady")
    assert "clamping field" in effect.stands_for

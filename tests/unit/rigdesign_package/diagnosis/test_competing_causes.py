"""What a further measurement has to tell apart where nothing in the catalogue explains the data."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.decision.naming import place_of
from rigdesign.diagnosis.decision.proposals import RIVALS, compared, credible_places, leading, mass_at
from rigdesign.diagnosis.decision.workflow import Diagnosis
from rigdesign.diagnosis.document.advice import headline, steps
from rigdesign.diagnosis.document.outcome import outcome
from tests.builders.diagnosis import FRETTING, story

GEAR = "unknown: heat at body:gear"


def test_laws_of_heat_at_one_place_are_one_thing() -> None:
    assert place_of("unknown: heat unpaid at body:test.n2 ~n2") == "unknown: heat at body:test.n2"
    assert place_of("unknown: heat at body:test.n2 ~T n") == "unknown: heat at body:test.n2"
    assert place_of("unknown: order 1 of M_wheel ~T") == "unknown: order 1 of M_wheel"
    assert place_of("unknown: heat near TC05 ~T above ambient") == "unknown: heat near TC05"
    link = "unknown: conductance contact:test.a|b"
    assert place_of(link) == link and place_of("mesh_loss:test") == "mesh_loss:test"


def test_one_place_that_holds_all_the_mass_has_nothing_to_be_told_from() -> None:
    found = story("fretting").diagnosis
    assert found.decision.verdict == "unknown_located"
    (only,) = leading(found)
    assert only.things == (GEAR,) and only.unnamed and credible_places(found) == [only]
    assert mass_at(found, [GEAR]) == pytest.approx(1.0, abs=1e-3)


def divided(found: Diagnosis, masses: Mapping[str, float]) -> Diagnosis:
    """The posterior of single explanations, given by hand."""
    first, *others = found.evaluations
    nothing = dict.fromkeys(first.weights.masses, 0.0)
    weights = replace(first.weights, masses=nothing | masses)
    return replace(found, evaluations=(replace(first, weights=weights), *others))


def test_places_that_hold_the_mass_together_are_in_question_and_the_catalogue_beside_them() -> None:
    found = story("fretting").diagnosis
    bearing = "unknown: heat at film:bearing"
    two = divided(found, {f"{GEAR} constant": 0.5, f"{GEAR} ~n": 0.2, f"{bearing} constant": 0.3})
    assert (
        [one.things for one in leading(two)]
        == [(GEAR,), (bearing,)]
        == [one.things for one in credible_places(two)]
    )
    assert leading(two)[0].name == f"{GEAR} constant"
    beside = divided(found, {f"{GEAR} constant": 0.6, "mesh_loss:test": 0.4})
    assert [one.name for one in leading(beside)] == [f"{GEAR} constant", "mesh_loss:test"]
    assert credible_places(beside) == []
    refused = divided(found, {"mesh_loss:test": 1.0})
    assert (
        len(leading(refused)) == RIVALS and not leading(refused)[0].unnamed and credible_places(refused) == []
    )


def test_where_an_effect_is_named_no_cause_without_a_name_is_in_question() -> None:
    found = story("mesh loss").diagnosis
    assert leading(found)[0].name == "mesh_loss:test" and not any(one.unnamed for one in leading(found))
    assert credible_places(found) == []


def test_a_cause_without_a_name_is_foreseen_at_the_size_that_fits() -> None:
    result = story("fretting")
    found = result.diagnosis
    kept = result.problem.residuals.rows(found.kept)
    (one,) = compared(kept, found, leading(found), found.covariance.matrix)
    power = [feature.channel == "P" for feature in kept.features]
    spread = abs(float(one.rival.slopes[power][0, 0]) * one.rival.deviations[0])
    assert one.rival.answer[power] == pytest.approx(np.full(sum(power), FRETTING), abs=3.0 * spread)
    assert 0.0 < spread < 0.1 * FRETTING


def test_places_with_one_trace_are_one_rival() -> None:
    result = story("fretting")
    found = result.diagnosis
    kept = result.problem.residuals.rows(found.kept)
    (one,) = leading(found)
    there = replace(one, things=("unknown: heat at rim:gear",))
    alike = compared(kept, found, [one, there], found.covariance.matrix)
    assert [entry.leading.things for entry in alike] == [(GEAR, "unknown: heat at rim:gear")]
    bearing = divided(found, {"unknown: heat at film:bearing ~n": 1.0})
    apart = compared(kept, found, [one, *leading(bearing)], found.covariance.matrix)
    assert len(apart) == 2


def test_it_ends_in_its_place_or_in_its_name() -> None:
    found = story("fretting").diagnosis
    (gear,) = leading(found)
    assert gear.ends(found)
    assert not gear.ends(divided(found, {f"{GEAR} ~n": 0.9, "mesh_loss:test": 0.1}))
    named = replace(found, named=("mesh_loss:test",), decision=replace(found.decision, verdict="named"))
    assert not gear.ends(named)
    (loss, *_) = leading(divided(found, {"mesh_loss:test": 1.0}))
    assert loss.ends(named) and not loss.ends(found)


def test_what_fits_nothing_is_not_located() -> None:
    """Whatever holds the posterior mass among explanations of which none fits."""
    found = story("fretting").diagnosis
    misfit = replace(found, decision=replace(found.decision, outside=False))
    assert credible_places(misfit) == [] and len(leading(misfit)) > 1


def test_the_page_says_where_it_is_and_what_to_inspect() -> None:
    said = outcome(story("fretting"))
    assert "Located: power loss in gear, the same at all operating points." in headline(said)
    (first, *_) = steps(said)
    assert first.text == "inspect the rig for power loss in gear, the same at all operating points"


def test_what_takes_heat_away_is_no_power_loss() -> None:
    """As walls 13 K colder than modelled, located as a power loss in them."""
    found = outcome(story("no fretting"))
    said = "less power loss than modelled in gear, the same at all operating points"
    assert f"Located: {said}." in headline(found) and said in found.suspects[0].title


@pytest.mark.parametrize("name", ["fretting", "no fretting", "alias", "healthy", "one point"])
def test_posteriors_of_what_is_printed_side_by_side_exclude_each_other(name: str) -> None:
    """As three effects of 131 % together beside `unknown, located`."""
    said = outcome(story(name))
    assert said.suspects and sum(one.inclusion for one in said.suspects) <= 1.0 + 1e-9

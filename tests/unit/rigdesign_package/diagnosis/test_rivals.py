"""What a further measurement has to tell apart where nothing in the catalogue explains the data."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.decision.rivals import RIVALS, leading, mass_at, rivals
from rigdesign.diagnosis.decision.unmodelled_words import place_of
from tests.builders.diagnosis import FRETTING, story

GEAR = "unknown: heat at body:gear"


def test_laws_of_heat_at_one_place_are_one_thing() -> None:
    assert place_of("unknown: heat unpaid at body:test.n2 ~n2") == "unknown: heat at body:test.n2"
    assert place_of("unknown: heat at body:test.n2 ~T n") == "unknown: heat at body:test.n2"
    order = "unknown: order 1 of M_wheel ~T"
    assert place_of(order) == order and place_of("mesh_loss:test") == "mesh_loss:test"


def test_a_cause_in_no_catalogue_leads_and_is_told_from_the_catalogue_and_from_other_places() -> None:
    found = story("fretting").diagnosis
    assert found.decision.verdict == "unknown_located"
    things = [one.thing for one in leading(found)]
    assert things[0] == GEAR and len(things) == len(set(things)) == RIVALS
    assert "mesh_loss:test" in things and "unknown: heat at film:bearing" in things
    assert mass_at(found, GEAR) == pytest.approx(1.0, abs=1e-3)


def test_where_an_effect_is_named_no_cause_without_a_name_is_in_question() -> None:
    things = [one.thing for one in leading(story("mesh loss").diagnosis)]
    assert things[0] == "mesh_loss:test"
    assert not any(thing.startswith("unknown: ") for thing in things)


def test_a_cause_without_a_name_is_foreseen_at_the_size_that_fits() -> None:
    result = story("fretting")
    found = result.diagnosis
    first = leading(found)[0]
    (rival,) = rivals(result.problem.residuals.rows(found.kept), found, [first])
    power = [result.problem.residuals.features[row].channel == "P" for row in found.kept]
    spread = abs(float(rival.slopes[power][0, 0]) * rival.deviations[0])
    assert rival.answer[power] == pytest.approx(np.full(sum(power), FRETTING), abs=3.0 * spread)
    assert 0.0 < spread < 0.1 * FRETTING


def test_it_ends_in_heat_located_at_its_place_alone() -> None:
    found = story("fretting").diagnosis
    gear, *others = leading(found)
    assert gear.ends(found) and not any(one.ends(found) for one in others)
    named = replace(found, decision=replace(found.decision, verdict="named", named=("mesh_loss:test",)))
    assert not gear.ends(named)
    loss = next(one for one in others if one.thing == "mesh_loss:test")
    assert loss.ends(replace(named, named=("mesh_loss:test",)))

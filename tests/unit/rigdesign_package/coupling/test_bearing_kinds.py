"""A further kind of bearing: whoever reads the state of a bearing reads the fields that every kind has."""

from dataclasses import fields, replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest

from dynamics.bearing.protocol import Bearing, BearingOperation, BearingState
from rigdesign.checks import films, ramp
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.iteration import IterationParts, PointProblem, run_iteration
from rigdesign.coupling.losses import bearing_ratings
from tests.builders.warm_prototype import base


def unrated(bearing: Bearing, operation: BearingOperation) -> BearingState:
    """A kind that states neither specific load nor film nor transition speed; else as the bearing of the case."""
    state = bearing.operating_state(operation)
    common = {field.name: getattr(state, field.name) for field in fields(BearingState)}
    return BearingState(**common | {"specific_load": None, "minimum_film": None, "transition_speed": None})


def test_an_iteration_of_the_loop_needs_the_common_fields_alone() -> None:
    rig, result = base()
    state = result.last.coupling_state
    parts = IterationParts(bearings=partial(solve_bearings, solve=unrated))
    problem = PointProblem(rig=rig, point=result.point, initial=state, bracing=None)
    plain, other = (run_iteration(each, state) for each in (problem, replace(problem, parts=parts)))
    assert {type(film) for film in other.bearings.values()} == {BearingState}
    assert other.bearing_heat == pytest.approx(plain.bearing_heat)
    powers = [[p.loss.power for p in done.losses] for done in (plain, other)]
    assert powers[0] == powers[1]
    losses = [placed.loss for placed in other.losses if placed.loss.kind == "bearing"]
    assert losses and not any("minimum_film_um" in loss.details for loss in losses)


def test_checks_and_records_leave_out_what_a_kind_is_not_rated_by() -> None:
    rig, result = base()
    states = solve_bearings(rig, result.point, result.last.coupling_state, unrated)
    assert all(bearing_ratings(state) == {} for state in states.values())
    point = SimpleNamespace(point=result.point, last=SimpleNamespace(bearings=states))
    solved: Any = SimpleNamespace(case=rig.case, rig=rig, points=[point])
    checks = [*films.checks(solved), ramp._transition(solved)]
    assert [check.verdict for check in checks] == ["not applicable"] * 3


def test_a_journal_bearing_states_all_its_ratings() -> None:
    _, result = base()
    ratings = bearing_ratings(result.last.bearings["test.pinion_front"])
    assert set(ratings) == {"specific_load_MPa", "minimum_film_um", "transition_speed_rpm"}

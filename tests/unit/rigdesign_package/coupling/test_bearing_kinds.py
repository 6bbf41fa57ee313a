"""A further kind of bearing: whoever reads the state of a bearing reads the fields that every kind has."""

import math
from dataclasses import fields, replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.bearing import Bearing, BearingOperation, BearingState, LateralOperation, OilSupply
from dynamics.rotor.journal import JournalState, journal_lateral
from dynamics.rotor.journal_feed import FEEDS
from rigdesign.case import load_case
from rigdesign.case.bearings import JournalBearingInput
from rigdesign.case.rolling_bearing import BearingPlace
from rigdesign.checks import films, ramp
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import IterationParts, PointProblem, run_iteration
from rigdesign.coupling.losses import bearing_ratings
from tests.builders.paths import CASES
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


def test_a_limit_that_a_kind_is_not_rated_by_stays_open() -> None:
    rig, result = base()
    states = solve_bearings(rig, result.point, result.last.coupling_state, unrated)
    assert all(bearing_ratings(state) == {} for state in states.values())
    point = SimpleNamespace(point=result.point, last=SimpleNamespace(bearings=states))
    solved: Any = SimpleNamespace(case=rig.case, rig=rig, points=[point], no_clearances="")
    checks = [*films.checks(solved), ramp._transition(solved)]
    assert [check.verdict for check in checks] == ["open", "open", "not applicable"]


def test_a_journal_bearing_states_all_its_ratings() -> None:
    _, result = base()
    ratings = bearing_ratings(result.last.bearings["test.pinion_front"])
    assert set(ratings) == {"specific_load_MPa", "minimum_film_um", "transition_speed_rpm"}


def test_the_stiffness_of_a_film_is_that_of_the_feed_which_the_case_states() -> None:
    """With grooves that of Lund and Thomsen at B/D 0.5 and S 0.580, K c / W = 2.67 along the load and 1.75 across;
    without the key that of ISO 7902-1, fed at the widest gap."""
    box = load_case(CASES / "loop_1to1").gearboxes["test"]
    entry = box.bearings["pinion_front"]
    assert isinstance(entry, JournalBearingInput)
    assert entry.feed == "widest_gap"
    speed, viscosity, clearance, diameter = 300.0, 0.02, 80e-6, entry.diameter
    width = 0.5 * diameter
    load = viscosity * speed / (2.0 * math.pi) * width * diameter * (diameter / clearance) ** 2 / 0.580
    oil = OilSupply(
        inlet_temperature=333.0, flow=1e-4, viscosity=lambda _: viscosity, density=850.0, heat_capacity=2e3
    )
    found = {}
    for feed in FEEDS:
        bearing = entry.model_copy(update={"feed": feed, "width": width}).as_it_runs(
            BearingPlace(clearance=clearance, lubrication=box.bearing_oil)
        )
        state = bearing.operating_state(BearingOperation(load=load, speed=speed, oil=oil))
        assert isinstance(state, JournalState)
        assert state.film.feed == feed
        lateral = journal_lateral(state.film, LateralOperation(force=(0.0, -load), sense=1))
        found[feed] = np.diag(lateral.stiffness) * 0.5 * clearance / load
    assert found["two_axial_grooves"] == pytest.approx([1.75, 2.67], rel=0.02)
    assert np.abs(found["widest_gap"] / found["two_axial_grooves"] - 1.0).max() > 0.05

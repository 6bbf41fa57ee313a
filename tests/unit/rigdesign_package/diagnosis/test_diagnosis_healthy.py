"""The residual of a healthy rig: films and their conductances, errors of answers; and its inflation."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.catalogue.effects import FILM, Effect, Parameter
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.residual import residual_problem as problems
from rigdesign.diagnosis.residual.healthy import TREND, answer_error, healthy_columns, relative_speed
from rigdesign.diagnosis.residual.residual_problem import plain
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.evidence import Evidence, Hypothesis, evaluate_hypothesis, support
from rigdesign.prediction.model import Channel, OperatingCondition, features_of
from tests.blind.covariance_inflation import INFLATE_ABOVE, LARGEST, inflate
from tests.builders.diagnosis import DESIGN, story

SETTINGS = tuple(
    OperatingCondition(name=f"P{i}", speed=speed, torque=50.0, inlet_temperature={"test.gear_oil": 350.0})
    for i, speed in enumerate((100.0, 200.0, 400.0))
)
CHANNELS = (
    Channel(name="TC1", quantity="temperature", place="test.outer_warm"),
    Channel(name="TC2", quantity="temperature", place="test.outer_cold"),
)
LINKS = ("film:test.wall_front", "film:test.wall_rear", "film:test.bore")
RNG = np.random.default_rng(5)
BY_LINK = {name: RNG.normal(size=6) for name in LINKS}


def film(healthy=0.25):
    return Effect(
        name="film:test.wall_oil",
        title="oil on the walls",
        family=FILM,
        signature="",
        parameters=(Parameter(name="factor", unit="", low=0.3, high=3.0, source="", factor=True),),
        change=lambda case, values: {},
        healthy=healthy,
        links=("film:test.wall_*",),
    )


def library():
    whole = BY_LINK[LINKS[0]] + BY_LINK[LINKS[1]]
    answers = np.array([0.0 * whole, 0.1 * whole])
    return Library(
        channels=CHANNELS, settings=SETTINGS, features=features_of(SETTINGS, CHANNELS), base=np.full(6, 380.0),
        responses={"film:test.wall_oil": Response(coordinates=np.array([[0.0], [0.1]]), answers=answers)},
        inputs={}, links=BY_LINK, sources={}, dry_sources={}, powers={}, modes=np.zeros(0), error=0.0,
    )  # fmt: skip


def columns_of(kind):
    channels = {one.name: one for one in CHANNELS}
    found = healthy_columns(library(), (film(),), channels, frozenset(), np.ones(6))
    return [column for column in found if column.kind == kind]


def test_what_conductances_of_a_film_share_is_the_films_own():
    columns = columns_of("link")
    together = sum(np.outer(c.spread * c.values, c.spread * c.values) for c in columns)
    each = sum(np.outer(values, values) for values in BY_LINK.values())
    assert together == pytest.approx(each)
    (own,) = [column for column in columns if column.effect]
    assert own.effect == "film:test.wall_oil"
    assert own.values == pytest.approx(BY_LINK[LINKS[0]] + BY_LINK[LINKS[1]])
    assert own.spread == pytest.approx(2**-0.5)


def test_a_tested_film_leaves_nothing_that_cancels_its_straight_answer():
    """Without the film's own columns the covariance of its two conductances has no part along their sum."""
    left = [column for column in columns_of("link") if not column.effect and "wall" in column.name]
    weights = np.linalg.lstsq(
        np.stack([BY_LINK[name] for name in LINKS[:2]], axis=1),
        np.stack([column.values for column in left], axis=1),
        rcond=None,
    )[0]
    assert np.ones(2) @ weights == pytest.approx(np.zeros(2), abs=1e-12)


def test_error_of_answers_is_coherent_in_a_series_and_grows_along_the_speed():
    error = answer_error(library(), (film(healthy=0.3),))
    slope = 0.3 * (BY_LINK[LINKS[0]] + BY_LINK[LINKS[1]])
    logs = np.log([100.0, 200.0, 400.0])
    trend = TREND * (logs - logs.mean())
    names = features_of(SETTINGS, CHANNELS)
    speed = np.array([trend[int(one.setting[1])] for one in names])
    same = np.array([[one.channel == other.channel for other in names] for one in names])
    assert error == pytest.approx(np.outer(slope, slope) * same * (1.0 + np.outer(speed, speed)))
    assert not answer_error(library(), (film(healthy=0.0),)).any()


def explained(space, raw):
    whole = space.covariance.whiten(raw)
    hypothesis = Hypothesis(name="e", family="physical", parts=("e",), columns=whole[:, None], half=10.0)
    return evaluate_hypothesis(space, hypothesis)


def test_support_is_what_the_other_points_say():
    rng = np.random.default_rng(2)
    mixing = rng.normal(size=(12, 12))
    covariance = Covariance(base=np.eye(12) + mixing @ mixing.T, columns=(), amplitudes={})
    points = ["P1"] * 4 + ["P2"] * 4 + ["P3"] * 3 + [""]
    answer = rng.normal(size=12)
    space = Whitened.of(covariance, 3.0 * answer + covariance.lower @ rng.normal(size=12))
    one = explained(space, answer)
    raw = covariance.lower @ one.answer
    falls = {}
    for point in ("P1", "P2", "P3"):
        kept = [row for row, name in enumerate(points) if name != point]
        precision = np.linalg.inv(covariance.matrix[np.ix_(kept, kept)])
        before, after = space.raw[kept], (space.raw - raw)[kept]
        falls[point] = float(before @ precision @ before - after @ precision @ after)
    least, where = support(space, points, one, "e")
    assert least == pytest.approx(min(falls.values()))
    assert falls[where] == pytest.approx(least)


def test_an_explanation_of_one_point_has_no_support():
    space = Whitened.of(
        Covariance(base=np.eye(6), columns=(), amplitudes={}), np.array([9.0, 8.0, 0.1, 0, 0, 0.1])
    )
    one = explained(space, np.array([1.0, 1.0, 0.01, 0, 0, 0]))
    assert one.gain > 100.0
    least, where = support(space, ["P1", "P1", "P2", "P2", "P3", "P3"], one, "e")
    assert where == "P1" and abs(least) < 0.1


def test_parts_of_two_joined_explanations_add_up():
    joined = Evidence(
        hypothesis=Hypothesis(name="a + b", family="pair", parts=("a", "b")),
        log_bayes=0.0, coordinates=(2.0, 3.0), deviations=(1.0, 1.0), gain=1.0,
        columns=np.array([[1.0, 0.0], [0.0, 1.0]]), answer=np.array([2.5, 3.0]), joined=1,
    )  # fmt: skip
    assert joined.share_of("b") == pytest.approx([0.0, 3.0])
    assert joined.share_of("a") == pytest.approx([2.5, 0.0])


def test_an_effect_is_widened_by_what_is_missing_and_no_more(monkeypatch):
    monkeypatch.setattr(problems, "BENDING_STEPS", 0)
    residuals = story("healthy").problem.residuals
    slope = residuals.library.responses["mesh_loss:test"].sensitivity()[:, 0]
    plain_space = plain(residuals, DESIGN.amplitudes)
    white = plain_space.covariance.whiten(slope)
    size = 6.0 / float(np.linalg.norm(white))
    sets = [replace(residuals, values=residuals.values + sign * size * slope) for sign in (1.0, -1.0)]
    found = inflate(sets, DESIGN.amplitudes)
    assert set(found) == {"mesh_loss"}
    squares = []
    for one in sets:
        space = plain(one, DESIGN.amplitudes, found)
        along = space.covariance.whiten(slope)
        squares.append(float(along @ space.residual) ** 2 / float(along @ along))
    assert np.mean(squares) == pytest.approx(INFLATE_ABOVE, rel=0.01)


def test_the_healthy_rig_that_goes_furthest_counts_beside_the_mean(monkeypatch):
    monkeypatch.setattr(problems, "BENDING_STEPS", 0)
    residuals = story("healthy").problem.residuals
    still = replace(residuals, values=residuals.library.base)
    slope = residuals.library.responses["mesh_loss:test"].sensitivity()[:, 0]
    white = plain(residuals, DESIGN.amplitudes).covariance.whiten(slope)
    far = replace(still, values=still.values + 8.0 / float(np.linalg.norm(white)) * slope)
    sets = [far] + 99 * [still]
    assert 64.0 / len(sets) < INFLATE_ABOVE
    found = inflate(sets, DESIGN.amplitudes)
    space = plain(far, DESIGN.amplitudes, found)
    along = space.covariance.whiten(slope)
    assert float(along @ space.residual) ** 2 / float(along @ along) <= LARGEST * 1.01


def test_heat_without_a_name_is_widened_by_its_share_of_the_losses(monkeypatch):
    monkeypatch.setattr(problems, "BENDING_STEPS", 0)
    residuals = story("healthy").problem.residuals
    unpaid = next(one for one in residuals.directions() if one.likeness == "heat unpaid at body ~n2")
    losses = np.mean(list(residuals.library.powers.values()))
    watts = residuals.library.dry_sources["body:gear"]
    at_mean = np.exp(relative_speed(residuals.features, residuals.library.settings)) ** 2
    assert unpaid.values[:, 0] == pytest.approx(losses * watts * at_mean)
    only = residuals.inflated({unpaid.likeness: 0.1})
    assert only == pytest.approx(0.01 * np.outer(unpaid.values, unpaid.values))


def test_a_course_that_bends_is_widened_along_its_ends_too():
    residuals = story("mesh loss").problem.residuals
    response = residuals.library.responses["mesh_loss:test"]
    own = next(one for one in residuals.directions() if one.likeness == "mesh_loss")
    runs = [run for run, place in enumerate(response.coordinates[:, 0]) if place]
    assert own.values.shape[1] == 1 + len(runs)
    for column, run in enumerate(runs, start=1):
        assert own.values[:, column] * response.coordinates[run, 0] == pytest.approx(response.answers[run])

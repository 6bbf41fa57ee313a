"""Evidence and verdict on linear toys whose answer is known in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.decision.defaults import Thresholds
from rigdesign.diagnosis.decision.search import Criteria, Earlier, Explanations, evaluate
from rigdesign.diagnosis.statistics.columns import Column
from rigdesign.diagnosis.statistics.covariance import Covariance, Release, Whitened
from rigdesign.diagnosis.statistics.evidence import (
    Curve,
    Hypothesis,
    evaluate_hypothesis,
    evaluate_pair,
    graded,
    mixture_density,
    release_of,
)

N = 120
USUAL = Criteria(thresholds=Thresholds())


def toy(seed, *, own=0.0):
    """Noise one, six smooth nuisances; eight effects, the first of which spreads by itself."""
    rng = np.random.default_rng(seed)
    effects = rng.normal(size=(N, 8))
    columns = [
        Column(name=f"nuisance {i}", kind="link", values=rng.normal(size=N), spread=2.0) for i in range(6)
    ]
    if own:
        columns.append(
            Column(name="effect 0", kind="constant", values=effects[:, 0], spread=own, effect="effect 0")
        )
    return rng, effects, Covariance.of_noise(np.ones(N), columns, {})


def explanations(covariance, effects, rng, *, half=5.0):
    physical = [
        Hypothesis(
            name=f"effect {i}",
            family="physical",
            parts=(f"effect {i}",),
            columns=covariance.whiten(effects[:, [i]]),
            half=half,
            own=(f"effect {i}",),
        )
        for i in range(effects.shape[1])
    ]
    unknown = [
        Hypothesis(
            name=f"unknown: {i}",
            family="unmodelled",
            parts=(f"unknown: {i}",),
            columns=covariance.whiten(rng.normal(size=(N, 1))),
            half=1.0,
        )
        for i in range(30)
    ]
    return Explanations(physical=physical, sensor=[], unmodelled=unknown)


def draw(rng, covariance):
    return np.linalg.cholesky(covariance.matrix) @ rng.normal(size=N)


def test_release_takes_a_column_out_of_the_covariance():
    rng, _, covariance = toy(1, own=0.7)
    plain = Covariance(base=covariance.base, columns=covariance.columns[:-1], amplitudes={})
    residual = rng.normal(size=N)
    space = Whitened.of(covariance, residual)
    release = release_of(space, ["effect 0"])
    bare = Whitened.of(plain, residual)
    assert release.product(space.residual, space.residual) == pytest.approx(bare.chi_square, rel=1e-10)
    assert release.log_determinant == pytest.approx(
        plain.log_determinant - covariance.log_determinant, rel=1e-10
    )
    assert Release.of(np.zeros((N, 0))).product(residual, residual) == pytest.approx(residual @ residual)


def test_quadrature_of_a_straight_curve_equals_the_closed_form():
    rng, effects, covariance = toy(2)
    space = Whitened.of(covariance, draw(rng, covariance) + 0.4 * effects[:, 2])
    white = covariance.whiten(effects[:, 2])
    half = 2.0
    closed = Hypothesis(name="e", family="physical", parts=("e",), columns=white[:, None], half=half)
    coordinates = np.linspace(-4.0 * half, 4.0 * half, 9)
    curve = Curve(
        coordinates=coordinates, answers=coordinates[:, None] * white, bounds=(-4.0 * half, 4.0 * half)
    )
    grid, weights = graded((-4.0 * half, 4.0 * half))
    assert np.sum(weights * np.exp(mixture_density(grid, half))) == pytest.approx(1.0, abs=2e-3)
    # the same prior: a curve's spreads follow its bounds, those here are four times the half
    straight = Hypothesis(name="e", family="physical", parts=("e",), columns=white[:, None], half=4.0 * half)
    one = evaluate_hypothesis(space, straight)
    other = evaluate_hypothesis(space, Hypothesis(name="e", family="physical", parts=("e",), curve=curve))
    assert other.coordinates[0] == pytest.approx(one.coordinates[0], rel=1e-6)
    assert other.log_bayes == pytest.approx(one.log_bayes, abs=0.1)
    assert evaluate_hypothesis(space, closed).log_bayes > other.log_bayes - 2.0


def test_nothing_is_named_in_healthy_sets():
    verdicts = []
    for seed in range(60):
        rng, effects, covariance = toy(seed, own=0.3)
        found = explanations(covariance, effects, rng)
        space = Whitened.of(covariance, draw(rng, covariance))
        verdicts.append(evaluate(space, found, USUAL).decision.verdict)
    assert verdicts.count("within_noise") + verdicts.count("too_small") == 60


def test_a_clear_effect_is_named_with_its_size():
    right = 0
    for seed in range(30):
        rng, effects, covariance = toy(seed)
        found = explanations(covariance, effects, rng)
        space = Whitened.of(covariance, draw(rng, covariance) + 1.2 * effects[:, 3])
        result = evaluate(space, found, USUAL)
        right += result.decision.verdict == "named" and result.decision.named == ("effect 3",)
        best = next(one for one in result.evidence if one.hypothesis.name == "effect 3")
        assert best.coordinates[0] == pytest.approx(1.2, abs=5.0 * best.deviations[0])
    assert right == 30


def test_two_effects_are_both_named():
    right = 0
    for seed in range(20):
        rng, effects, covariance = toy(seed)
        found = explanations(covariance, effects, rng)
        residual = draw(rng, covariance) + 1.2 * effects[:, 3] - 1.5 * effects[:, 6]
        result = evaluate(Whitened.of(covariance, residual), found, USUAL)
        right += set(result.decision.named) == {"effect 3", "effect 6"}
    assert right == 20


def test_twins_end_as_an_alias_group():
    rng, effects, covariance = toy(5)
    effects[:, 4] = effects[:, 3] + 1e-4 * rng.normal(size=N)
    found = explanations(covariance, effects, rng)
    space = Whitened.of(covariance, draw(rng, covariance) + 1.5 * effects[:, 3])
    decision = evaluate(space, found, USUAL).decision
    assert decision.verdict == "alias_group"
    assert set(decision.named) == {"effect 3", "effect 4"}


def test_what_is_not_in_the_catalogue_stays_unknown():
    for seed in range(20):
        rng, effects, covariance = toy(seed)
        found = explanations(covariance, effects, rng)
        stranger = 1.5 * rng.normal(size=N)
        space = Whitened.of(covariance, draw(rng, covariance) + stranger)
        assert evaluate(space, found, USUAL).decision.verdict == "unknown_located"


def unnamed(covariance, column, family="unmodelled"):
    white = covariance.whiten(column[:, None])
    return Hypothesis(name="unknown: copy", family=family, parts=("unknown: copy",), columns=white, half=3.0)


def test_a_copy_without_a_name_does_not_hide_what_has_one():
    rng, effects, covariance = toy(6)
    found = explanations(covariance, effects, rng)
    rivals = [*found.unmodelled, unnamed(covariance, 2.0 * effects[:, 3])]
    space = Whitened.of(covariance, draw(rng, covariance) + 1.2 * effects[:, 3])
    result = evaluate(space, replace(found, unmodelled=rivals), USUAL)
    assert result.decision.named == ("effect 3",)
    assert not any("copy" in one.hypothesis.name for one in result.evidence)


def test_an_error_of_a_sensor_is_not_told_from_heat_that_looks_the_same():
    rng, effects, covariance = toy(6)
    found = explanations(covariance, effects, rng)
    reads_wrong = replace(
        found.physical[3], family="sensor", parts=("sensor_offset:T",), name="sensor_offset:T"
    )
    catalogue = [one for one in found.physical if one.name != "effect 3"]
    space = Whitened.of(covariance, draw(rng, covariance) + 1.2 * effects[:, 3])
    named = {}
    for rivals in ([], [unnamed(covariance, effects[:, 3], "local")]):
        both = Explanations(physical=catalogue, sensor=[reads_wrong], unmodelled=rivals)
        named[len(rivals)] = evaluate(space, both, USUAL).decision
    assert named[0].named == ("sensor_offset:T",)
    assert named[1].verdict == "unknown_located"


def test_two_without_a_name_are_weighed_together():
    rng, effects, covariance = toy(7)
    found = explanations(covariance, effects, rng)
    both = [one.columns[:, 0] / np.linalg.norm(one.columns) for one in found.unmodelled[:2]]
    hidden = covariance.lower @ (14.0 * both[0] + 11.0 * both[1])
    result = evaluate(Whitened.of(covariance, draw(rng, covariance) + hidden), found, USUAL)
    assert result.evidence[0].hypothesis.parts == ("unknown: 0", "unknown: 1")
    assert result.decision.verdict == "unknown_located"


def test_a_further_effect_must_explain_a_share_of_what_the_first_did():
    rng, effects, covariance = toy(8)
    found = explanations(covariance, effects, rng)
    space = Whitened.of(covariance, draw(rng, covariance) + 1.2 * effects[:, 3])
    by_point = replace(USUAL, points=[f"P{row % 6}" for row in range(N)])
    alone = evaluate(space, found, by_point)
    assert alone.decision.named == ("effect 3",)
    beside = evaluate(
        space,
        found,
        by_point,
        explained=25.0 * alone.evidence[0].gain,
    )
    assert (beside.decision.verdict, beside.decision.named) == ("too_small", ())
    assert "in addition" in beside.decision.reason


def test_in_orders_a_further_effect_must_explain_more():
    rng, effects, covariance = toy(8)
    found = explanations(covariance, effects, rng)
    space = Whitened.of(covariance, draw(rng, covariance) + 1.2 * effects[:, 3])
    by_point = replace(USUAL, points=[f"P{row % 6}" for row in range(N)])
    before = 8.0 * evaluate(space, found, USUAL).evidence[0].gain
    heat, orders = (
        evaluate(
            space,
            found,
            replace(by_point, orders=loop),
            explained=before,
        ).decision
        for loop in (frozenset[str](), frozenset({"effect 3"}))
    )
    assert heat.named == ("effect 3",)
    assert (orders.verdict, orders.named) == ("too_small", ())


@pytest.mark.parametrize(("twin", "named"), [(True, ()), (False, ("effect 4",))])
def test_a_later_look_does_not_decide_what_the_first_left_divided(twin, named):
    rng, effects, covariance = toy(9)
    if twin:
        effects[:, 6] = effects[:, 4] + 1e-4 * rng.normal(size=N)
    found = explanations(covariance, effects, rng)
    residual = draw(rng, covariance) + 2.0 * effects[:, 3] + 1.2 * effects[:, 4]
    first = evaluate(Whitened.of(covariance, residual), found, USUAL)
    assert first.decision.verdict == "named" and "effect 3" in first.decision.named
    left = replace(
        found, physical=[one for one in found.physical if one.name not in ("effect 3", "effect 6")]
    )
    after = Whitened.of(covariance, residual - 2.0 * effects[:, 3])
    assert evaluate(after, left, USUAL).decision.named == ("effect 4",)
    earlier = Earlier(look=first, named=frozenset({"effect 3"}))
    later = evaluate(after, left, USUAL, earlier=earlier).decision
    assert later.named == named
    assert twin is ("effect 4 or another one" in later.reason)


def test_a_pair_of_two_that_look_alike_gains_as_one_of_them_whatever_their_units():
    rng, effects, covariance = toy(4)
    space = Whitened.of(covariance, draw(rng, covariance) + 2.0 * effects[:, 1])

    def alone(name, factor):
        columns = covariance.whiten(factor * effects[:, [1]])
        return evaluate_hypothesis(
            space,
            Hypothesis(name=name, family="physical", parts=(name,), columns=columns, half=100.0 / factor),
        )

    first, twin, other_unit = alone("a", 1.0), alone("b", 1.0 + 1e-14), alone("c", 3e6)
    for one in (twin, other_unit):
        pair = evaluate_pair(space, first, one)
        assert pair.gain == pytest.approx(first.gain, rel=1e-8)
        assert pair.coordinates[0] == pytest.approx(0.5 * first.coordinates[0], rel=1e-6)
    apart = Hypothesis(
        name="d", family="physical", parts=("d",), columns=covariance.whiten(1e7 * effects[:, [2]]), half=1e-5
    )
    both = np.stack([effects[:, 1], effects[:, 2]], axis=1)
    white = covariance.whiten(both)
    best = np.linalg.lstsq(white, space.residual, rcond=None)[0]
    pair = evaluate_pair(space, first, evaluate_hypothesis(space, apart))
    assert pair.coordinates == pytest.approx((best[0], 1e-7 * best[1]), rel=1e-8)


def test_a_size_beyond_its_bounds_has_the_evidence_of_the_largest_one():
    """The prior of a size has tails, what is physical has none."""
    column = np.random.default_rng(8).normal(size=(30, 1))
    space = Whitened.of(Covariance(base=np.eye(30), columns=(), amplitudes={}), 50.0 * column[:, 0])
    near = Hypothesis(name="pitch", family="physical", parts=("pitch",), columns=column, half=1.0)
    other = Hypothesis(
        name="ripple", family="physical", parts=("ripple",), columns=np.eye(30)[:, :1], half=1.0
    )
    one = evaluate_hypothesis(space, near)
    assert one.coordinates == (1.0,)
    assert one.log_bayes == pytest.approx(0.5 * one.gain)
    both = evaluate_pair(space, one, evaluate_hypothesis(space, other))
    along = float(np.sign(column[0, 0]))
    assert both.coordinates == pytest.approx((1.0, along))
    assert both.log_bayes == pytest.approx(0.5 * both.gain)
    assert both.gain == pytest.approx(one.gain + 2.0 * 49.0 * abs(column[0, 0]) - 1.0)


@pytest.mark.parametrize("correlation", [0.0, 0.95, -0.95, 0.9999])
def test_beside_a_size_at_its_bound_the_other_one_is_fitted_again(correlation):
    """Of columns of length 40; both sizes are found by trying all of a grid of the second one."""
    first = np.array([40.0, 0.0, 0.0])
    second = 40.0 * np.array([correlation, np.sqrt(1.0 - correlation**2), 0.0])
    residual = 1.6 * first + 0.1 * second + np.array([0.0, 0.0, 1.0])
    space = Whitened.of(Covariance(base=np.eye(3), columns=(), amplitudes={}), residual)
    one, other = (
        evaluate_hypothesis(
            space, Hypothesis(name=name, family="physical", parts=(name,), columns=column[:, None], half=1.0)
        )
        for name, column in (("a", first), ("b", second))
    )
    both = evaluate_pair(space, one, other)
    tried = np.linspace(-1.0, 1.0, 4001)
    left = ((residual[:, None] - first[:, None] - second[:, None] * tried) ** 2).sum(axis=0)
    assert both.coordinates == pytest.approx((1.0, tried[int(np.argmin(left))]), abs=1e-3)
    assert both.gain == pytest.approx(space.chi_square - float(left.min()), abs=1e-2)
    assert both.gain >= max(one.gain, other.gain) - 1e-9


def test_two_alike_do_not_cancel_at_their_bounds():
    """Free sizes of 30 and -29 of two nearly equal columns."""
    first = np.array([40.0, 0.0])
    second = 40.0 * np.array([np.cos(0.001), np.sin(0.001)])
    space = Whitened.of(Covariance(base=np.eye(2), columns=(), amplitudes={}), 30.0 * first - 29.0 * second)
    one, other = (
        evaluate_hypothesis(
            space, Hypothesis(name=name, family="physical", parts=(name,), columns=column[:, None], half=1.0)
        )
        for name, column in (("a", first), ("b", second))
    )
    assert evaluate_pair(space, one, other).gain >= max(one.gain, other.gain) - 1e-9

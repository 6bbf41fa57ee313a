"""Parts of a diagnosis with answers known in closed form."""

import math

import numpy as np
import pytest

from rigdesign.diagnosis.catalogue.effects import LOSS, Effect, Parameter
from rigdesign.diagnosis.decision.patch import constants
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.residual.baseline import fit_amplitudes
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes, Group, group_misfit
from rigdesign.diagnosis.statistics.columns import Column, Turning
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened, reject
from rigdesign.diagnosis.statistics.detectability import aliases, detectabilities
from rigdesign.diagnosis.statistics.evidence import Curve, Hypothesis, evaluate_hypothesis, fit_together
from rigdesign.diagnosis.statistics.heldout import gap, held_out
from rigdesign.diagnosis.statistics.next_measurement import Foreseen, Proposal, Rival, ranked, smallest_set
from rigdesign.prediction.model import Channel, Feature, OperatingCondition, features_of


def plane(name, covariance, columns, half=10.0):
    return Hypothesis(
        name=name, family="physical", parts=(name,), columns=covariance.whiten(columns), half=half
    )


def test_detectable_size_of_white_noise():
    covariance = Covariance.of_noise(np.full(25, 2.0), [], {})
    space = Whitened.of(covariance, np.zeros(25))
    ones, ramp = np.ones((25, 1)), np.linspace(-1.0, 1.0, 25)[:, None]
    first, second, third = (
        plane("level", covariance, ones),
        plane("ramp", covariance, ramp),
        plane("nearly level", covariance, ones + 0.1 * ramp),
    )
    rows = {row.effect: row for row in detectabilities(space, [first, second, third], [])}
    assert rows["level"].detectable == pytest.approx(3.3 * 2.0 / 5.0)
    assert rows["level"].rival == "nearly level"
    cosine = 25.0 / math.sqrt(25.0 * (25.0 + 0.01 * float(np.sum(ramp**2))))
    assert rows["level"].correlation == pytest.approx(cosine)
    assert rows["level"].isolable == pytest.approx(4.3 * 0.4 / math.sqrt(1.0 - cosine**2))
    assert [pair[:2] for pair in aliases(space, [first, second, third])] == [("level", "nearly level")]


def test_one_wild_reading_is_rejected_and_a_wild_set_is_not():
    rng = np.random.default_rng(3)
    smooth = 5.0 * np.ones((40, 1))
    matrix = np.eye(40) + smooth @ smooth.T
    residual = np.linalg.cholesky(matrix) @ rng.normal(size=40)
    residual[17] += 9.0
    each = range(40)
    assert [outlier.place for outlier in reject(matrix, residual, each)] == [17]
    residual[:10] += 12.0 * rng.normal(size=10)
    assert reject(matrix, residual, each) == ()


def test_readings_of_one_series_that_stand_out_together_are_a_trace_and_stay():
    residual = np.zeros(40)
    residual[[4, 7, 20]] = 9.0
    series = ["a" if row < 10 else row for row in range(40)]
    assert [outlier.place for outlier in reject(np.eye(40), residual, series, most=0.1)] == [20]


def test_points_held_out_follow_from_the_hash_alone():
    points = [f"P{i:02d}" for i in range(15)]
    first = held_out(points, "a")
    assert len(first) == 3
    assert first == held_out(points, "a")
    assert len({held_out(points, seed) for seed in "abcdefgh"}) > 4
    assert held_out(points[:5], "a") == ()
    counts = [held_out(points, str(seed)).count("P03") for seed in range(400)]
    assert np.mean(counts) == pytest.approx(0.2, abs=0.06)


def test_gap_is_one_for_healthy_numbers_and_falls_with_the_answer():
    rng = np.random.default_rng(5)
    covariance = Covariance.of_noise(np.full(400, 0.5), [], {})
    healthy = 0.5 * rng.normal(size=400)
    answer = np.zeros(400)
    answer[:100] = 3.0
    answer[300:] = 1000.0
    quantities = ["temperature"] * 300 + ["motor_power"] * 100
    noise = np.where(answer > 10.0, 500.0, 0.5)
    found = gap(covariance, healthy + answer, answer, noise, quantities, ("P1",))
    assert found.after == pytest.approx(1.0, abs=0.1)
    assert found.before > 3.0
    assert found.raw_before == pytest.approx(3.0, abs=0.2)
    assert found.raw_after == pytest.approx(found.raw_floor, rel=0.2)


def test_intervals_cover_as_often_as_they_say():
    inside = 0
    columns = np.random.default_rng(1).normal(size=(60, 2))
    nuisance = Column(name="n", kind="link", values=columns @ [0.6, 0.2], spread=0.5)
    covariance = Covariance.of_noise(np.ones(60), [nuisance], {})
    lower = covariance.lower
    for seed in range(300):
        rng = np.random.default_rng(seed)
        residual = lower @ rng.normal(size=60) + columns @ [2.0, -1.0]
        space = Whitened.of(covariance, residual)
        found = [evaluate_hypothesis(space, plane(f"e{i}", covariance, columns[:, [i]])) for i in range(2)]
        fit = fit_together(space, found, {"": 0.0}, [[(-10.0, 10.0)]] * 2)
        low, high = fit.sizes[0].interval
        inside += low <= 2.0 <= high
    assert inside / 300 == pytest.approx(0.95, abs=0.035)


def test_where_an_answer_saturates_its_size_is_known_worse():
    """Answer R/(R + 1) off by a third: R = 1 answers 0.5; 0.335 and 0.665 are reached at R = 0.504 and 1.985."""
    covariance = Covariance.of_noise(np.ones(4), [], {})
    runs = np.linspace(0.0, 5.0, 60)
    direction = 1e4 * np.array([1.0, -2.0, 0.5, 1.0])
    curve = Curve(coordinates=runs, answers=(runs / (runs + 1.0))[:, None] * direction, bounds=(0.0, 5.0))
    hypothesis = Hypothesis(name="joint", family="physical", parts=("joint",), curve=curve)
    space = Whitened.of(covariance, 0.5 * direction)
    widths = {"": 0.33 / 1.96}
    (size,) = fit_together(space, [evaluate_hypothesis(space, hypothesis)], widths, [[(0.0, 5.0)]]).sizes
    assert size.coordinate == pytest.approx(1.0, abs=1e-3)
    assert size.interval == pytest.approx((0.504, 1.985), rel=0.01)
    (open_end,) = fit_together(
        space, [evaluate_hypothesis(space, hypothesis)], {"": 0.4}, [[(0.0, 5.0)]]
    ).sizes
    assert open_end.interval[1] == 5.0 and open_end.at_bound


def test_amplitudes_are_found_again():
    rng = np.random.default_rng(2)
    n, count = 50, 400
    first, second = (rng.normal(size=(n, 12)) for _ in range(2))
    true = {"link": 0.4, "channel": 0.05}
    matrix = (
        0.1**2 * np.eye(n) + true["link"] ** 2 * first @ first.T + true["channel"] ** 2 * second @ second.T
    )
    draws = np.linalg.cholesky(matrix) @ rng.normal(size=(n, count))
    group = Group(
        noise=0.1**2 * np.eye(n),
        parts={"link": first @ first.T, "channel": second @ second.T},
        residuals=draws,
    )
    found = fit_amplitudes([group], Amplitudes())
    assert found.values["link"] == pytest.approx(0.4, rel=0.05)
    assert found.values["channel"] == pytest.approx(0.05, rel=0.15)
    names = ("link", "channel")
    logs = np.log([0.3, 0.07])
    value, slope = group_misfit(group, dict(zip(names, np.exp(logs))), names)
    for number in range(2):
        moved = logs + 1e-6 * np.eye(2)[number]
        above, _ = group_misfit(group, dict(zip(names, np.exp(moved))), names)
        assert (above - value) / 1e-6 == pytest.approx(slope[number], rel=1e-3)


def test_next_measurement_prefers_what_the_rivals_foresee_differently():
    # two effects that look alike on one sensor; a second one sees the first only
    answer = np.array([1.0, 1.0, 1.0, 1.0])
    only_first, neither = np.array([3.0]), np.array([0.0])
    covariance = Covariance.of_noise(np.full(6, 0.3), [], {})
    rivals = [
        Rival(name="a", answer=np.concatenate([answer, only_first, [1.0]]),
              slopes=np.concatenate([answer, only_first, [1.0]])[:, None], deviations=np.array([0.1])),
        Rival(name="b", answer=np.concatenate([answer, neither, [1.0]]),
              slopes=np.concatenate([answer, neither, [1.0]])[:, None], deviations=np.array([0.1])),
    ]  # fmt: skip
    proposals = [Proposal(title="second", rows=(0,), cost=2.0), Proposal(title="same", rows=(1,), cost=1.0)]
    foreseen = Foreseen.of(covariance.matrix, answer, rivals)
    found = ranked(foreseen, proposals)
    assert found[0].title == "second"
    alone, moved = 0.3**2, 0.3**2 + 0.1**2 * 9.0  # what b and a leave open
    if_a = 0.5 * (9.0 / alone + moved / alone - 1.0 - np.log(moved / alone))
    if_b = 0.5 * (9.0 / moved + alone / moved - 1.0 - np.log(alone / moved))
    assert found[0].expected_evidence == pytest.approx(min(if_a, if_b), rel=0.02)
    assert found[0].decides
    assert found[1].expected_evidence == pytest.approx(0.0, abs=1e-9)
    together = smallest_set(foreseen, proposals)
    assert together is not None and together.titles == ("second",) and together.cost == 2.0
    assert smallest_set(foreseen, proposals[1:]) is None


def test_the_smallest_set_takes_two_where_one_does_not_decide_and_leaves_out_what_is_superfluous():
    covariance = Covariance.of_noise(np.ones(5), [], {})
    nothing = np.zeros((5, 0))
    foreseen = Foreseen.of(
        covariance.matrix,
        np.zeros(1),
        [
            Rival(name="a", answer=np.array([0.0, 2.0, 2.9, 2.0, 9.0]), slopes=nothing, deviations=np.zeros(0)),
            Rival(name="b", answer=np.zeros(5), slopes=nothing, deviations=np.zeros(0)),
        ],
    )  # fmt: skip
    offers = [
        Proposal(title="first", rows=(0,), cost=0.5),
        Proposal(title="second", rows=(1,), cost=1.1),
        Proposal(title="third", rows=(2,), cost=9.0),
        Proposal(title="dear", rows=(3,), cost=30.0),
    ]
    together = smallest_set(foreseen, offers)
    assert together is not None and together.titles == ("first", "second")
    assert together.expected_evidence == pytest.approx(0.5 * (2.0**2 + 2.9**2))


SETTINGS = (
    OperatingCondition(name="P1", speed=100.0, torque=50.0, inlet_temperature={"test.gear_oil": 350.0}),
    OperatingCondition(name="P2", speed=200.0, torque=80.0, inlet_temperature={"test.gear_oil": 360.0}),
)
CHANNELS = (
    Channel(name="T", quantity="temperature", place="test.outer_warm"),
    Channel(name="M", quantity="torque", place="side", orders=(0.0, 1.0, 2.0)),
)


def library():
    features = features_of(SETTINGS, CHANNELS)
    n = len(features)
    at = {"P1": 0, "P2": n // 2}
    slope = {name: np.zeros(n) for name in at}
    for name, row in at.items():
        slope[name][row] = 0.5
    return Library(
        channels=CHANNELS,
        settings=SETTINGS,
        features=features,
        base=np.arange(float(n)),
        inputs={("inlet_temperature", "test.gear_oil", name): slope[name] for name in at},
        responses={"e": Response(coordinates=np.array([[0.0], [1.0]]), answers=np.array([np.zeros(n), np.ones(n)]))},
        links={},
        sources={},
        dry_sources={},
        powers={"P1": 1.0, "P2": 2.0},
        modes=np.zeros(0),
        error=0.0,
    )  # fmt: skip


def test_library_serves_a_nearby_point_of_fewer_channels_under_other_names():
    run = (
        OperatingCondition(name="late", speed=202.0, torque=79.0, inlet_temperature={"test.gear_oil": 362.0}),
    )
    wanted = (Channel(name="TC7", quantity="temperature", place="test.outer_warm"),)
    served = library().serving(run, wanted)
    assert served is not None
    assert served.features == (Feature("TC7", "late"),)
    assert served.base == pytest.approx([6.0 + 2.0 * 0.5])
    assert served.powers == {"late": 2.0}
    assert set(served.inputs) == {("inlet_temperature", "test.gear_oil", "late")}


def test_distance_of_a_library_is_that_of_its_farthest_point():
    run = OperatingCondition(
        name="late", speed=202.0, torque=79.0, inlet_temperature={"test.gear_oil": 362.0}
    )
    assert library().distance(SETTINGS) == 0.0
    near = [abs(run.speed / 200.0 - 1.0) / 0.05, abs(run.torque / SETTINGS[1].torque - 1.0) / 0.05, 2.0 / 8.0]
    assert library().distance([run]) == pytest.approx(max(near))
    assert library().distance([SETTINGS[0], SETTINGS[0]]) == float("inf")


def test_library_does_not_serve_what_it_does_not_hold():
    far = (
        OperatingCondition(name="P1", speed=150.0, torque=50.0, inlet_temperature={"test.gear_oil": 350.0}),
    )
    assert library().serving(far, CHANNELS) is None
    more = (Channel(name="M", quantity="torque", place="side", orders=(3.0,)),)
    assert library().serving(SETTINGS, more) is None
    twice = (SETTINGS[0], SETTINGS[0])
    assert library().serving(twice, CHANNELS) is None


def test_a_cause_some_teeth_later_turns_its_orders():
    features = features_of(SETTINGS[:1], CHANNELS)
    answers = np.array([[7.0, 5.0, 1.0, 0.0, 0.0, 2.0]])
    turning = Turning.of(features)
    later = turning.turned(answers, 5, 20)
    assert later[0] == pytest.approx([7.0, 5.0, 0.0, -1.0, 0.0, -2.0], abs=1e-12)
    assert turning.turned(later, 15, 20) == pytest.approx(answers)


def test_constants_of_a_healthy_set_are_the_posterior():
    rng = np.random.default_rng(8)
    slopes = rng.normal(size=(30, 2))
    slopes[:, 1] *= 1e-3
    effects = [
        Effect(
            name=f"mesh_loss:{name}",
            title=name,
            family=LOSS,
            signature="",
            parameters=(Parameter(name="factor", unit="", low=0.1, high=10.0, source="", factor=True),),
            change=lambda case, values: {},
            healthy=0.2,
        )
        for name in ("seen", "unseen")
    ]
    columns = [
        Column(name=one.name, kind="constant", values=slopes[:, i], spread=0.2, effect=one.name)
        for i, one in enumerate(effects)
    ]
    covariance = Covariance.of_noise(np.full(30, 0.1), columns, {"constant": 2.0})
    residual = 0.3 * slopes[:, 0] + 0.1 * rng.normal(size=30)
    found = constants(Whitened.of(covariance, residual), effects)
    assert [entry.effect.name for entry in found.entries] == ["mesh_loss:seen"]
    prior = np.diag([0.4**2, 0.4**2])
    posterior = np.linalg.inv(np.linalg.inv(prior) + slopes.T @ slopes / 0.1**2)
    mean = posterior @ slopes.T @ residual / 0.1**2
    entry = found.entries[0]
    assert entry.coordinate == pytest.approx(mean[0], rel=1e-9)
    assert entry.deviation == pytest.approx(np.sqrt(posterior[0, 0]), rel=1e-9)
    assert found.covariance == pytest.approx(posterior[:1, :1], rel=1e-9)
    assert entry.fitted("why").values[0] == pytest.approx(np.exp(mean[0]), rel=1e-9)

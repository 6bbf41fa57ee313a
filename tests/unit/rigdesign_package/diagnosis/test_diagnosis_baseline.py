"""What a set leaves given a healthy set of the same rig: points met again, drifts, their calibration."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.library.library import Library
from rigdesign.diagnosis.residual.baseline import SHARES, Change, Drift, differenced
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.prediction.model import Channel, Feature, OperatingCondition
from tests.blind.calibration import calibrate_drift
from tests.blind.covariance_inflation import inflate_drift
from tests.builders.diagnosis import story

STEP = 0.01
"""By how much the residuals ran faster than its baseline, as a logarithm."""

STILL = Drift(shared=0.01, slope=0.0, shaft=0.0, mesh=0.0, amplitude=0.0, sensors=0.0, constants=0.0)


def moved(library: Library, settings: tuple[OperatingCondition, ...]) -> Library:
    """The library for points met elsewhere; its numbers stay."""
    return replace(library, settings=settings)


def faster(residuals: ResidualProblem, step: float) -> ResidualProblem:
    """The same readings at points run faster."""
    runs = tuple(replace(one, speed=one.speed * float(np.exp(step))) for one in residuals.library.settings)
    return replace(residuals, library=moved(residuals.library, runs))


@pytest.fixture(scope="module")
def pair() -> tuple[ResidualProblem, ResidualProblem]:
    problem = story("mesh loss").problem
    return faster(problem.residuals, STEP), problem.baseline


def more_by(pair: tuple[ResidualProblem, ResidualProblem], drift: Drift) -> np.ndarray:
    """(n, n) what a drift adds to the covariance."""
    change = Change.of(*pair, Amplitudes())
    return change.covariance(drift) - change.covariance(STILL)


def amplitude(feature: Feature, read) -> float:
    """Of the order that a number is part of, zero for others."""
    parts = ("real", "imaginary") if feature.order else ()
    return float(np.linalg.norm([read[replace(feature, part=part)] for part in parts]))


def test_orders_follow_the_speed_as_natural_frequencies_near_them_make_them(pair):
    residuals, baseline = pair
    more = more_by(pair, replace(STILL, shaft=0.3, mesh=2.0, amplitude=0.05))
    read = dict(zip(baseline.features, baseline.values, strict=True))
    steep = residuals.resonances.steepness
    kinds = set()
    for feature, near, variance in zip(residuals.features, steep, np.diag(more), strict=True):
        mesh = feature.order in residuals.mesh_orders
        kinds.add((bool(feature.order), mesh))
        follows = STEP * near * (2.0 if mesh else 0.3)
        alone = 0.05 if mesh else 0.0
        assert variance == pytest.approx((follows**2 + alone**2) * amplitude(feature, read) ** 2, abs=1e-12)
    assert kinds == {(False, False), (True, False), (True, True)}
    assert more == pytest.approx(np.diag(np.diag(more)), abs=1e-12)


def test_orders_lie_near_the_natural_frequencies_predicted_and_read(pair):
    plain = pair[0]
    channel = Channel(name="f_2", quantity="natural_frequency", place="2")
    read = replace(
        plain,
        features=(*plain.features, Feature("f_2", "")),
        values=np.append(plain.values, 840.0),
        library=replace(plain.library, base=np.append(plain.library.base, 900.0)),
        channels={**plain.channels, "f_2": channel},
    )
    unread = replace(read, values=np.append(plain.values, 0.0))
    assert plain.resonances.modes == pytest.approx(2.0 * np.pi * np.array([480.0, 900.0]))
    assert unread.resonances.modes == pytest.approx(plain.resonances.modes)
    assert read.resonances.modes == pytest.approx(2.0 * np.pi * np.array([480.0, 900.0, 840.0]))


def test_shaft_orders_are_off_by_the_error_of_the_natural_frequency_nearby(pair):
    residuals = pair[0]

    def variance(of: ResidualProblem, frequency: float) -> np.ndarray:
        return np.diag(of.base_noise(replace(Amplitudes(), frequency=frequency)))

    more = variance(residuals, 0.02) - variance(residuals, 0.0)
    shaft = np.array([bool(one.order) for one in residuals.features]) & ~residuals.of_mesh
    assert np.all(more[shaft] > 0.0) and not more[~shaft].any()
    assert variance(residuals, 0.04) - variance(residuals, 0.0) == pytest.approx(4.0 * more, rel=1e-6)
    library = replace(residuals.library, modes=np.array(_frequencies(residuals, shaft)))
    nearer = replace(residuals, library=library)
    assert np.all(variance(nearer, 0.02)[shaft] > variance(residuals, 0.02)[shaft])


def _frequencies(residuals: ResidualProblem, some: np.ndarray) -> list[float]:
    """Of some orders at their points [rad/s]."""
    speeds = {setting.name: setting.speed for setting in residuals.library.settings}
    return [
        one.order * speeds[one.setting] for one, taken in zip(residuals.features, some, strict=True) if taken
    ]


def test_orders_follow_the_speed_by_a_share_of_what_the_model_says(pair):
    residuals, baseline = pair
    first = residuals.library.settings[0]
    slope = np.array([0.02 if one.order and one.setting == first.name else 0.0 for one in residuals.features])
    library = replace(residuals.library, inputs={("speed", "", first.name): slope})
    more = more_by((replace(residuals, library=library), baseline), replace(STILL, slope=0.5))
    both = np.sqrt(2.0) * first.speed * slope
    assert np.diag(more) == pytest.approx((0.5 * STEP * both) ** 2)


def test_a_point_met_at_the_same_speed_drifts_by_the_shared_part_alone(pair):
    same = faster(pair[0], -STEP), pair[1]
    assert more_by(same, replace(STILL, slope=1.0, shaft=1.0, mesh=1.0)) == pytest.approx(0.0, abs=1e-15)


def test_points_are_known_by_their_settings_whatever_their_names_and_order(pair):
    residuals, baseline = pair
    runs = baseline.library.settings
    names = {one.name: f"Q{number}" for number, one in enumerate(runs)}
    other = tuple(replace(one, name=names[one.name]) for one in reversed(runs))
    features = tuple(replace(one, setting=names.get(one.setting, "")) for one in baseline.features)
    powers = {names[name]: power for name, power in baseline.library.powers.items()}
    library = replace(baseline.library, settings=other, features=features, powers=powers)
    renamed = replace(baseline, features=features, library=library)
    whole, again = (Change.of(residuals, one, Amplitudes()) for one in (baseline, renamed))
    assert again.expected == pytest.approx(whole.expected, rel=1e-9)
    assert again.known == pytest.approx(whole.known, rel=1e-9)
    assert again.steep == pytest.approx(whole.steep)


def test_an_order_the_model_does_not_know_is_foretold_as_it_was_read(pair):
    """Even where the model's own mesh orders, over which its errors count, follow the other speeds."""
    residuals, baseline = pair
    once = np.array([one.order == 2.0 and one.part == "real" for one in residuals.features])
    mesh = np.array([one.order in residuals.mesh_orders for one in residuals.features])
    base = residuals.library.base * np.where(mesh, 1.3, 1.0)
    library = replace(residuals.library, base=base)
    level = np.where([bool(one.order) for one in residuals.features], 1.3, 1.0) * residuals.level
    steeper = replace(residuals, library=library, level=level)
    healthy = replace(baseline, values=baseline.library.base + 2.0 * once)
    assert Change.of(steeper, healthy, Amplitudes()).expected[once] == pytest.approx(2.0, rel=0.03)


def test_a_point_that_the_baseline_lacks_is_known_less_well(pair):
    residuals, baseline = pair
    gone = baseline.library.settings[0].name
    fewer = baseline.rows([row for row, one in enumerate(baseline.features) if one.setting != gone])
    fewer = replace(fewer, library=moved(fewer.library, fewer.library.settings[1:]))
    own = [row for row, one in enumerate(residuals.features) if one.setting == gone]
    with_it, without = (
        np.diag(Change.of(residuals, one, Amplitudes()).known)[own] for one in (baseline, fewer)
    )
    assert (without > with_it).all()
    assert not Change.of(residuals, fewer, Amplitudes()).steep[own].any()


def test_some_numbers_of_a_change_keep_what_is_known_of_them(pair):
    drift = Drift(shared=0.02, slope=1.0, shaft=0.5, mesh=0.5, amplitude=0.03, sensors=0.3, constants=0.02)
    whole = differenced(*pair, Amplitudes(), drift)
    keep = list(range(0, len(whole.raw), 2))
    part = whole.rows(keep)
    matrix = Change.of(*pair, Amplitudes()).covariance(drift)[np.ix_(keep, keep)]
    assert part.raw == pytest.approx(whole.raw[keep])
    assert part.chi_square == pytest.approx(float(whole.raw[keep] @ np.linalg.solve(matrix, whole.raw[keep])))


def test_drifts_of_healthy_pairs_are_found_again(pair):
    rng = np.random.default_rng(4)
    residuals, baseline = pair
    true = Drift(shared=0.02, slope=0.5, shaft=4.0, mesh=4.0, amplitude=0.05, sensors=0.3, constants=0.02)
    drawn = []
    for _ in range(6):
        covariance = baseline.covariance(Amplitudes())
        before = baseline.library.base + covariance.lower @ rng.normal(size=len(baseline.features))
        healthy = replace(baseline, values=before)
        change = Change.of(residuals, healthy, Amplitudes())
        spread = np.linalg.cholesky(change.covariance(true)) @ rng.normal(size=len(residuals.features))
        drawn.append((replace(residuals, values=residuals.library.base + change.expected + spread), healthy))
    found = calibrate_drift(
        drawn,
        Amplitudes(),
        Drift(shared=0.05, slope=0.5, shaft=2.0, mesh=2.0, amplitude=0.02, sensors=0.6, constants=0.04),
    )
    assert found.shaft == pytest.approx(true.shaft, rel=0.2)
    assert found.amplitude == pytest.approx(true.amplitude, rel=0.4)
    assert found.shared == pytest.approx(true.shared, rel=0.4)
    assert found.sensors == pytest.approx(true.sensors, rel=0.4)


def test_the_drift_is_widened_along_what_changed_from_set_to_set(pair):
    residuals, baseline = pair
    drift = Drift(shared=0.01, slope=1.0, shaft=0.1, mesh=0.1, amplitude=0.01, sensors=0.01, constants=0.001)
    found = inflate_drift([(residuals, baseline)] * 3, Amplitudes(), drift)
    assert replace(found, inflation={}) == drift
    before = differenced(residuals, baseline, Amplitudes(), drift).chi_square
    assert found.inflation and differenced(residuals, baseline, Amplitudes(), found).chi_square < 0.5 * before


def test_what_both_sets_share_is_all_that_is_no_noise(pair):
    """A healthy rig's covariance less noise, scatter and what its answers and resonances have wrong may drift."""
    residuals = pair[0]
    amplitudes = replace(Amplitudes(), answer=0.0, frequency=0.0)
    shared = Change.of(*pair, amplitudes).shared
    scale = residuals.on_the_scale_of(pair[1])
    alone = np.diag(residuals.noise**2) + residuals.scatter
    own = scale.own_spread(amplitudes)
    assert shared == pytest.approx(scale.covariance(amplitudes).matrix - alone, rel=1e-9)
    assert own.max() > 1e-3 * np.sqrt(np.diag(shared)).max()


def test_a_channel_may_shift_by_a_share_of_what_its_measurement_states(pair):
    """As thermocouples good to 0.4 K of which each read 0.1 K more: an alarm in 7 of 8 healthy sets."""
    change = Change.of(*pair, Amplitudes())
    own = np.array([one.channel == "T_gear" for one in change.residuals.features], dtype=np.float64)
    still = Drift(**dict.fromkeys(SHARES, 1e-3))
    square = {
        share: float(own @ np.linalg.solve(change.covariance(replace(still, sensors=share)), own))
        for share in (1e-3, 0.35)
    }
    stated = next(one.spread for one in change.residuals.errors if one.name == "sensor_offset:T_gear")
    assert stated**2 * square[0.35] < 1.0 < 10.0 < stated**2 * square[1e-3]  # no alarm, and one without
    assert (10.0 * stated) ** 2 * square[0.35] > 30.0  # what still is one


def test_losses_and_films_change_from_set_to_set(pair):
    more = more_by(pair, replace(STILL, constants=0.02))
    answers = pair[0].library.responses
    moved = [answers[name].sensitivity() for name in ("mesh_loss:test", "bearing_loss:test")]
    assert more == pytest.approx(0.02**2 * sum(one @ one.T for one in moved), rel=1e-9, abs=1e-12)

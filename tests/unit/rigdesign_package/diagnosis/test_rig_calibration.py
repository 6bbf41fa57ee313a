"""A rig calibrated by its healthy sets: drifts found again, safe values, odd sets, and what a diagnosis makes of it."""

from dataclasses import replace
from functools import cache
from math import exp, log
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError, UsageError
from rigdesign.diagnosis.decision.cross_validation import Problem
from rigdesign.diagnosis.decision.defaults import DEFAULT
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.residual.baseline import Change, Drift, fit_drift
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.rig_calibration import healthy_sets
from rigdesign.diagnosis.rig_calibration.estimate import (
    changes_of,
    estimate,
    fit_with_channels,
    spread_of_sets,
    with_values,
)
from rigdesign.diagnosis.rig_calibration.healthy_sets import (
    QUIET,
    HealthySet,
    calibrate_rig,
    leave_one_out,
    odd_sets,
)
from rigdesign.diagnosis.statistics.amplitudes import PRIOR, Amplitudes, Group, fit
from tests.builders.diagnosis import Rig, result_of, story, the_case, write_set

STILL = Drift(shared=0.0, slope=0.0, shaft=0.0, mesh=0.0, amplitude=0.0, sensors=0.0, constants=0.0)


def healthy(name: str, rig: Rig, offset: float = 0.0) -> HealthySet:
    """A set of the formulas; ``offset`` [K] of one thermometer."""

    def spoil(point, values):
        return {**values, "T_bearing": values["T_bearing"] + offset}

    result = result_of(write_set(Path(mkdtemp()), rig, title=name, spoil=spoil))
    return HealthySet(
        name=name, residuals=result.problem.residuals, seed=result.measurement.hash, repeated=True
    )


@cache
def quiet() -> tuple[HealthySet, ...]:
    return tuple(healthy(f"h{seed}", Rig(seed=10 + seed)) for seed in range(3))


def values(sets, **keys) -> dict:
    return {one.name: one for one in estimate([one.residuals for one in sets], DEFAULT, **keys).estimates}


def healthy_pairs(true: Drift, count: int, seed: int) -> list[tuple[ResidualProblem, ResidualProblem]]:
    """Pairs of one healthy rig each, drawn with a known drift."""
    rng = np.random.default_rng(seed)
    problem = story("mesh loss").problem
    step = 0.01
    runs = tuple(replace(one, speed=one.speed * exp(step)) for one in problem.residuals.library.settings)
    residuals = replace(problem.residuals, library=replace(problem.residuals.library, settings=runs))
    drawn = []
    for _ in range(count):
        spread = problem.baseline.covariance(Amplitudes()).lower
        before = replace(
            problem.baseline, values=problem.baseline.library.base + spread @ rng.normal(size=len(spread))
        )
        change = Change.of(residuals, before, Amplitudes())
        moved = np.linalg.cholesky(change.covariance(true)) @ rng.normal(size=len(spread))
        drawn.append((replace(residuals, values=residuals.library.base + change.expected + moved), before))
    return drawn


# ------------------------------------------------------------------------ likelihood


def test_the_spread_is_that_of_a_scale_known_from_so_many_numbers() -> None:
    """Of k normal numbers ln(sigma) is known to (2 k + 1/1.5^2)^-1/2 at the maximum of likelihood and prior."""
    rng = np.random.default_rng(1)
    drawn = rng.normal(scale=0.3, size=200)
    group = Group(noise=1e-12 * np.eye(200), parts={"a": np.eye(200)}, residuals=drawn[:, None])
    found = fit([group], start={"a": 1.0}, prior={"a": 1.0}, reach={}, fixed={})
    assert found.values["a"] == pytest.approx(float(np.std(drawn)), rel=0.02)
    assert found.spreads["a"] == pytest.approx((2.0 * 200 + PRIOR**-2) ** -0.5, rel=0.02)


def test_what_the_data_do_not_see_stays_with_the_spread_of_the_prior() -> None:
    group = Group(noise=np.eye(3), parts={"a": np.zeros((3, 3))}, residuals=np.ones((3, 1)))
    found = fit([group], start={"a": 0.7}, prior={"a": 0.2}, reach={}, fixed={})
    assert found.values["a"] == pytest.approx(0.2, rel=1e-3)
    assert found.spreads["a"] == pytest.approx(PRIOR, rel=1e-3)


# ------------------------------------------------------------------------ drift


def test_a_known_drift_is_found_again_within_its_spread() -> None:
    """Eight rigs of one pair each: log ratios over their spread scatter as a normal distribution does."""
    true = Drift(shared=0.02, slope=0.5, shaft=4.0, mesh=4.0, amplitude=0.05, sensors=0.3, constants=0.02)
    start = Drift(shared=0.02, slope=0.5, shaft=1.5, mesh=4.0, amplitude=0.02, sensors=0.3, constants=0.02)
    off = []
    for residuals, before in healthy_pairs(true, 8, seed=5):
        change = Change.of(residuals, before, Amplitudes())
        found = fit_drift([change], start)
        off += [
            log(found.values[name] / true.scales[name]) / found.spreads[name]
            for name in ("shaft", "amplitude")
        ]
    assert np.abs(off).max() < 3.5
    assert np.sqrt(np.mean(np.square(off))) < 1.5
    assert abs(np.mean(off)) < 0.8


def test_changes_that_are_not_independent_count_less() -> None:
    pair = healthy_pairs(
        Drift(shared=0.02, slope=0.5, shaft=4.0, mesh=4.0, amplitude=0.05, sensors=0.3, constants=0.02),
        1,
        seed=2,
    )[0]
    start = Drift(shared=0.02, slope=0.5, shaft=1.5, mesh=4.0, amplitude=0.02, sensors=0.3, constants=0.02)
    change = Change.of(*pair, Amplitudes())
    once, twice = fit_drift([change], start), fit_drift([change, change], start, weight=0.5)
    for name in once.values:
        assert twice.values[name] == pytest.approx(once.values[name], rel=1e-3)
        assert twice.spreads[name] == pytest.approx(once.spreads[name], rel=1e-3)


@pytest.mark.parametrize(("sets", "factor"), [(2, 1.90), (3, 1.61), (4, 1.48)])
def test_few_sets_leave_a_drift_open(sets: int, factor: float) -> None:
    assert exp(spread_of_sets(0.0, sets)) == pytest.approx(factor, abs=0.01)
    assert spread_of_sets(PRIOR, sets) == pytest.approx(PRIOR)
    assert spread_of_sets(0.1, sets) == spread_of_sets(0.0, sets)


def test_a_value_is_lowered_by_no_more_than_is_proven_and_raised_as_found() -> None:
    found = values(quiet())
    below = [one for one in found.values() if one.fitted < one.shipped]
    assert {one.kind for one in below} == {"drift", "model error", "channel error"}
    for one in below:
        lowered = min(one.shipped, one.fitted * exp(one.spread))
        assert one.used == pytest.approx(lowered if one.kind == "drift" else one.shipped)
    assert found["drift.amplitude"].used < 0.6 * DEFAULT.drift.amplitude
    loud = values([*quiet()[:1], healthy("loud", Rig({"mesh_loss:test": (log(1.2),)}, seed=3))])
    assert loud["drift.constants"].used == loud["drift.constants"].fitted > 2.0 * DEFAULT.drift.constants
    assert quiet()[0].residuals.covariance(DEFAULT.amplitudes).amplitudes["sensor"] == 1.0
    assert "amplitudes.sensor" not in found and "amplitudes.input" not in found


def test_a_slip_of_a_reading_is_no_drift() -> None:
    """2500 W too much at one point of one set: without that reading the values are nearly the same."""

    def spoil(point, values):
        return {**values, "P": values["P"] + (2500.0 if point == "P04" else 0.0)}

    result = result_of(write_set(Path(mkdtemp()), Rig(seed=12), spoil=spoil))
    spoilt = HealthySet(name="x", residuals=result.problem.residuals, seed="x", repeated=True)
    found, clean = values([*quiet()[:2], spoilt]), values(quiet())
    assert found.keys() == clean.keys()
    for name, one in found.items():
        assert one.used == pytest.approx(clean[name].used, rel=0.15)


def test_one_set_alone_calibrates_nothing() -> None:
    with pytest.raises(ValueError, match="healthy sets = 1"):
        estimate([quiet()[0].residuals], DEFAULT)


# ------------------------------------------------------------------------ channels


def test_the_shift_of_a_channel_is_found_again() -> None:
    """A thermometer put back with another error every time: its shifts have the root mean square that was put in."""
    offsets = [0.0, 1.5, -1.0, 0.8]
    sets = [healthy(f"s{n}", Rig(seed=60 + n), offset) for n, offset in enumerate(offsets)]
    changes = changes_of([one.residuals for one in sets], Amplitudes(sensor=1e-3))
    scales = fit_with_channels(changes, DEFAULT.drift, 1.0 / len(sets)).values
    found = {
        name.removeprefix("channel "): size for name, size in scales.items() if name.startswith("channel ")
    }
    level = [
        one.residuals.level[row]
        for one in sets
        for row, feature in enumerate(one.residuals.features)
        if feature.channel == "T_bearing"
    ]
    steps = [one - other for one in offsets for other in offsets if one is not other]
    expected = float(np.sqrt(np.mean(np.square(steps)) / np.mean(np.square(level))))
    assert found["T_bearing"] == pytest.approx(expected, rel=0.25)
    assert found.keys() == {"T_bearing"}
    assert scales["shared"] < 3.0 * DEFAULT.drift.shared


def test_a_shift_moves_all_numbers_of_the_channel_together_and_no_order() -> None:
    problem = story("mesh loss").problem
    change = Change.of(problem.residuals, problem.baseline, Amplitudes())
    drift = replace(STILL, channels={"T_gear": 0.1, "M_wheel": 0.2, "not there": 5.0})
    more = change.covariance(drift) - change.covariance(STILL)
    expected = np.zeros_like(more)
    for channel, size in (("T_gear", 0.1), ("M_wheel", 0.2)):
        own = np.array([f.channel == channel and not f.order for f in problem.residuals.features])
        level = problem.residuals.level * own
        if channel == "T_gear":
            level = own * np.sqrt(np.sum(level**2) / np.sum(own))
        shift = size * level
        expected += np.outer(shift, shift)
    assert more == pytest.approx(expected, abs=1e-9)


# ------------------------------------------------------------------------ leave one out


def test_healthy_sets_of_one_rig_give_no_alarm() -> None:
    fitted = estimate([one.residuals for one in quiet()], DEFAULT)
    rows = leave_one_out(quiet(), DEFAULT, fitted)
    assert not any(row.alarm for row in rows) and odd_sets(rows) == ()
    assert [(row.name, row.baseline) for row in rows[:3]] == [("h0", None), ("h0", "h1"), ("h0", "h2")]
    for row in rows:
        assert row.name not in row.calibrated_by and len(row.calibrated_by) == 2
        if row.baseline is not None:
            assert 0.6 < row.chi_square < 1.4


def test_a_set_with_an_effect_does_not_look_like_the_others() -> None:
    sets = (*quiet()[:2], healthy("odd", Rig({"mesh_loss:test": (log(1.2),)}, seed=30)))
    rows = leave_one_out(sets, DEFAULT, estimate([one.residuals for one in sets], DEFAULT))
    assert odd_sets(rows) == ("odd",)
    own = [row for row in rows if row.name == "odd" and row.baseline is not None]
    assert [row.named for row in own] == [("mesh_loss:test",)] * 2
    assert min(row.chi_square for row in own) > 10.0


def test_of_two_sets_that_differ_neither_is_taken_for_the_right_one() -> None:
    sets = (quiet()[0], healthy("odd", Rig({"mesh_loss:test": (log(1.2),)}, seed=30)))
    rows = leave_one_out(sets, DEFAULT, estimate([one.residuals for one in sets], DEFAULT))
    assert odd_sets(rows) == ("h0", "odd")
    assert all(row.calibrated_by == () and row.chi_square == row.before for row in rows)


# ------------------------------------------------------------------------ what a diagnosis makes of it


def test_a_rig_whose_thermometer_shifts_is_quiet_once_it_is_calibrated_and_still_gives_names() -> None:
    offsets = (0.0, 1.2, -1.5)
    sets = [healthy(f"s{n}", Rig(seed=80 + n), offset) for n, offset in enumerate(offsets)]
    fitted = estimate([one.residuals for one in sets], DEFAULT).calibration
    assert fitted.drift.channels.keys() == {"T_bearing"}

    def verdict(one: HealthySet, calibration):
        problem = Problem(residuals=one.residuals, baseline=sets[0].residuals, seed=one.seed, repeated=True)
        return diagnose(problem, calibration).decision

    again = healthy("again", Rig(seed=90), 1.4)
    assert verdict(again, DEFAULT).verdict not in QUIET
    assert verdict(again, fitted).verdict in QUIET
    loss = healthy("loss", Rig({"mesh_loss:test": (log(1.2),)}, seed=91), 1.4)
    assert verdict(loss, fitted).named == ("mesh_loss:test",)


def test_what_few_sets_cannot_tell_stays_as_shipped() -> None:
    fitted = estimate([one.residuals for one in quiet()], DEFAULT).calibration
    assert fitted.plain == DEFAULT.plain and fitted.drift.inflation == DEFAULT.drift.inflation
    assert fitted.signature_error == DEFAULT.signature_error and fitted.inflation == DEFAULT.inflation


def test_values_by_name_make_the_calibration_again() -> None:
    fitted = estimate([one.residuals for one in quiet()], DEFAULT)
    again = with_values(DEFAULT, {one.name: one.used for one in fitted.estimates})
    assert again == fitted.calibration


# ------------------------------------------------------------------------ from files


@pytest.fixture
def by_formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    """The formulas as the model."""

    def read(case, measurement, effects, say=lambda message: None):
        result = result_of(measurement.folder)
        return result.data, result.problem.residuals

    monkeypatch.setattr(healthy_sets, "read_residuals", read)


def test_sets_are_called_by_their_folders(by_formulas: None, tmp_path: Path) -> None:
    folders = [write_set(tmp_path / name, Rig(seed=n)) for n, name in enumerate(("a/week", "b/week", "c"))]
    found = calibrate_rig(the_case(), folders)
    assert found.names == ("a/week", "b/week", "c") and found.odd == ()
    assert len(found.left_out) == 9


@pytest.mark.parametrize("count", [0, 1, 5])
def test_the_number_of_sets_is_refused_before_anything_is_read(count: int, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=f"{count} given, 2 to 4"):
        calibrate_rig(the_case(), [tmp_path / "not there"] * count)


def test_the_same_readings_twice_are_no_two_sets(by_formulas: None, tmp_path: Path) -> None:
    first, copy = (write_set(tmp_path / name, Rig(seed=4)) for name in ("a", "b"))
    with pytest.raises(UsageError, match="the same readings"):
        calibrate_rig(the_case(), [first, copy])


def test_sets_have_to_share_operating_points(by_formulas: None, tmp_path: Path) -> None:
    folders = [write_set(tmp_path / "a", Rig(seed=4)), write_set(tmp_path / "b", Rig(seed=5, points=2))]
    with pytest.raises(MeasurementError, match=r"b and a share: 2, at least 3"):
        calibrate_rig(the_case(), folders)

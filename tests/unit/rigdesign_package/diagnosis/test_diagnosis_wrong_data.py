"""Data that are wrong as they stand: exchanged channels and points, readings in another unit or with another sign."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigdesign.diagnosis import run
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.residual.hypotheses import data_error
from rigdesign.diagnosis.statistics.covariance import Covariance
from rigdesign.prediction.model import Channel, Feature
from tests.builders.diagnosis import DESIGN, Rig, result_of, story, the_case, write_set

CHANNELS = {
    "T_front": Channel(name="T_front", quantity="temperature", place="test.outer_cold_front"),
    "T_rear": Channel(name="T_rear", quantity="temperature", place="test.outer_cold_rear"),
    "M": Channel(name="M", quantity="torque", place="pinion_side", orders=(0.0, 1.0)),
    "phi": Channel(name="phi", quantity="angle", place="pinion_side", orders=(0.0,)),
    "P": Channel(name="P", quantity="motor_power", place="motor"),
}
FEATURES = tuple(
    Feature(channel=name, setting=point, order=order)
    for point in ("P01", "P02", "P03")
    for name, channel in CHANNELS.items()
    for order in channel.orders or (0.0,)
)
NOISE = {"T_front": 0.3, "T_rear": 0.3, "M": 0.2, "phi": 1e-6, "P": 5.0}
LEVEL = {"T_front": 350.0, "T_rear": 335.0, "M": 200.0, "phi": 2e-3, "P": 900.0}


def likeliest(change):
    """Name of the explanation that leaves least of readings that were changed."""
    rng = np.random.default_rng(3)
    noise = np.array([NOISE[one.channel] for one in FEATURES])
    expected = np.array([LEVEL[one.channel] for one in FEATURES]) * rng.uniform(0.9, 1.1, len(FEATURES))
    values = change(expected + noise * rng.normal(size=len(FEATURES)))
    covariance = Covariance.of_noise(noise, [], {})
    found = data_error(covariance, FEATURES, CHANNELS, values, expected, met_before=True)
    return min(found, key=lambda one: float(one.residual @ one.residual)).name


def of(name):
    return np.array([one.channel == name for one in FEATURES])


@pytest.mark.parametrize(
    ("channel", "unit", "factor", "shift"),
    [
        ("T_front", "fahrenheit", 1.8, 273.15 - 459.67),
        ("M", "sign", -1.0, 0.0),
        ("M", "kilonewton metre", 1e-3, 0.0),
        ("M", "newton millimetre", 1e3, 0.0),
        ("M", "kilopond metre", 0.1019716, 0.0),
        ("M", "pound-force foot", 0.7375621, 0.0),
        ("M", "pound-force inch", 8.850746, 0.0),
        ("phi", "degrees as milliradians", 0.05729578, 0.0),
        ("phi", "milliradians as radians", 1e3, 0.0),
        ("P", "horsepower", 1.341022e-3, 0.0),
        ("P", "metric horsepower", 1.359622e-3, 0.0),
    ],
)
def test_a_unit_is_recognised(channel, unit, factor, shift):
    found = likeliest(lambda values: np.where(of(channel), factor * values + shift, values))
    assert found == f"unit:{channel} ({unit})"


@pytest.mark.parametrize("angle", [0.2, -1.3])
def test_a_mark_elsewhere_is_found_with_its_angle(angle):
    """Orders 1 and 28 of a torque, read with the mark so far on; tooth by tooth the angle is a pitch of 28 teeth."""
    parts = [(order, part) for order in (1.0, 28.0) for part in ("real", "imaginary")]
    features = tuple(Feature(channel="M", setting="P01", order=order, part=part) for order, part in parts)
    true = np.array([3.0 - 1.0j, 9.0 + 5.0j])
    noise, read = np.full(4, 0.05), true * np.exp(1j * np.array([1.0, 28.0]) * angle)
    expected, values = (np.ravel([(one.real, one.imag) for one in many]) for many in (true, read))
    covariance = Covariance.of_noise(noise, [], {})
    found = {
        known: data_error(covariance, features, CHANNELS, values, expected, met_before=known)
        for known in (True, False)
    }
    [mark] = [one for one in found[True] if one.name.startswith("angle_zero")]
    assert mark.name == f"angle_zero ({angle:+.4f} rad)"
    assert np.abs(mark.residual).max() < 1e-2
    assert not any(one.name.startswith("angle_zero") for one in found[False])


def test_orders_alone_tell_no_unit():
    features = tuple(
        Feature(channel="M", setting="P01", order=28.0, part=part) for part in ("real", "imaginary")
    )
    covariance = Covariance.of_noise(np.full(2, 0.05), [], {})
    read, expected = np.array([-3.0, 8.0]), np.array([9.0, 1.0])
    assert data_error(covariance, features, CHANNELS, read, expected, met_before=False) == []


def test_exchanged_channels_are_recognised():
    def change(values):
        changed = values.copy()
        changed[of("T_front")], changed[of("T_rear")] = values[of("T_rear")], values[of("T_front")]
        return changed

    assert likeliest(change) == "swapped_channels:T_front,T_rear"


def test_exchanged_points_are_recognised():
    def change(values):
        at = {name: np.array([one.setting == name for one in FEATURES]) for name in ("P01", "P03")}
        changed = values.copy()
        changed[at["P01"]], changed[at["P03"]] = values[at["P03"]], values[at["P01"]]
        return changed

    assert likeliest(change) == "swapped_points:P01,P03"


def test_exchanged_channels_are_recognised_where_a_reading_of_one_was_rejected():
    kept = [row for row, one in enumerate(FEATURES) if (one.channel, one.setting) != ("T_front", "P02")]
    features = [FEATURES[row] for row in kept]
    expected = np.array([LEVEL[one.channel] for one in features])
    other = {"T_front": "T_rear", "T_rear": "T_front"}
    values = np.array([LEVEL[other.get(one.channel, one.channel)] for one in features])
    covariance = Covariance.of_noise(np.array([NOISE[one.channel] for one in features]), [], {})
    found = data_error(covariance, features, CHANNELS, values, expected, met_before=True)
    least = min(found, key=lambda one: float(one.residual @ one.residual))
    assert least.name == "swapped_channels:T_front,T_rear"


@pytest.mark.parametrize("with_baseline", [False, True])
def test_what_a_comparison_finds_is_told_by_the_diagnosis(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, with_baseline: bool
) -> None:
    """Exchanged thermocouples, and one number left out because its repeats are far apart."""

    def by_formulas(case, measurement, effects, say=lambda message: None):
        result = result_of(measurement.folder)
        return result.data, result.problem.residuals

    def exchange(point, values):
        wild = 40.0 * next(wilder) if point == "P02" else 0.0
        return {
            **values,
            "T_gear": values["T_bearing"],
            "T_bearing": values["T_gear"],
            "P": values["P"] + 99.0 * wild,
        }

    wilder = iter((0.0, 1.0, 0.0))
    write_set(tmp_path / "healthy", Rig(seed=7))
    folder = write_set(
        tmp_path / "set", Rig(), baseline="../healthy" if with_baseline else "", spoil=exchange
    )
    monkeypatch.setattr(run, "read_residuals", by_formulas)
    found = run.diagnose_measurement(the_case(), folder, propose=False).data.findings
    [swap] = [one for one in found if one.id == "swapped_channels"]
    assert set(swap.channels) == {"T_gear", "T_bearing"} and swap.weight == "suspect"
    [left_out] = [one for one in found if one.id == "repeat_outlier"]
    assert left_out.points == ("P02",)


@pytest.mark.parametrize(
    ("heat", "floor", "verdict"),
    [(False, 30.0, True), (False, 1e6, False), (True, 1e6, True)],
)
def test_an_exchange_needs_as_much_evidence_as_a_name(heat, floor, verdict):
    """As points P02 and P09 of one torque, exchanged by orders that no model knows well, in a healthy rig."""
    problem = story("healthy").problem
    kept = [row for row, one in enumerate(problem.residuals.features) if heat or one.order]
    residuals = problem.residuals.rows(kept)
    place = {feature: row for row, feature in enumerate(residuals.features)}
    other = {"P01": "P06", "P06": "P01"}
    values = [
        residuals.values[place[replace(one, setting=other.get(one.setting, one.setting))]]
        for one in residuals.features
    ]
    thresholds = replace(DESIGN.plain, evidence=30.0, evidence_loop=floor)
    exchanged = replace(problem, residuals=replace(residuals, values=np.array(values)))
    found = diagnose(exchanged, replace(DESIGN, plain=thresholds, least_alone={}))
    assert (found.decision.named == ("swapped_points:P01,P06",)) is verdict, found.decision

"""compare with a healthy set: what both sets share cancels, what is new stays, what the healthy set lacks is told."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.measurement import features, load_measurement
from rigdesign.measurement.comparison import compare as comparing
from rigdesign.measurement.comparison.compare import (
    Comparison,
    compare,
    compare_measurement,
    comparison_document,
    headline,
)
from rigdesign.measurement.processing.baseline import HealthySet, foretold
from rigdesign.measurement.quantities import CHANNELS, to_si
from rigdesign.prediction import Feature, Prediction, features_of
from rigdesign.report.pages.measurement import write_comparison
from tests.builders.measurement import changed_column, order_truth, replaced, truth, write_set
from tests.builders.paths import CASES

MODEL_ERROR = {"TC1": 4.0, "TC2": -3.0, "P": 200.0, "M_wheel": 2.0, "f1": 15.0}
"""What the simulation has wrong in either set [SI]."""


@pytest.fixture(scope="module")
def case():
    return load_case(CASES / "uhcf_prototype")


@pytest.fixture
def pair(tmp_path: Path) -> Path:
    """A set with a healthy one as its baseline, both alike but for 6 K more of TC1."""
    write_set(tmp_path / "healthy")
    folder = write_set(tmp_path / "set")
    replaced(folder, "measurement.toml", 'title = "trial"', 'title = "trial"\nbaseline = "../healthy"')
    changed_column(folder, "TC1", lambda value: value + 6.0)
    return folder


def simulated(settings, channels) -> Prediction:
    """The truth of both sets but for the error of the model."""
    units = {"temperature": "degC", "motor_power": "W", "torque": "N m", "natural_frequency": "Hz"}
    runs = {setting.name: setting for setting in settings}
    quantities = {channel.name: channel.quantity for channel in channels}
    values = []
    for feature in features_of(settings, channels):
        run = runs.get(feature.setting)
        speed, torque = (0.0, 0.0) if run is None else (run.speed * 30.0 / np.pi, run.torque)
        quantity = quantities[feature.channel]
        if feature.order:
            amplitude = order_truth(feature.order, speed, torque)
            value = amplitude.real if feature.part == "real" else amplitude.imag
        else:
            value = to_si(truth(feature.channel, speed, torque), CHANNELS[quantity].kind, units[quantity])
        values.append(value - MODEL_ERROR[feature.channel])
    return Prediction(features=features_of(settings, channels), values=np.array(values))


def compared(folder: Path, case, monkeypatch) -> Comparison:
    monkeypatch.setattr(
        comparing, "predict", lambda case, settings, channels, **_: simulated(settings, channels)
    )
    return compare_measurement(case, folder)


def test_what_model_and_sensors_have_wrong_in_both_sets_cancels(pair: Path, case, monkeypatch) -> None:
    comparison = compared(pair, case, monkeypatch)
    assert len(comparison.sentences) == 1 and comparison.located[0].channels == ("TC1",)
    assert comparison.sentences[0].startswith(
        "Temperatures of the outside of the warm chamber of gearbox test: above"
    )
    assert "above the simulation and the healthy set by up to 6 K" in comparison.sentences[0]
    assert headline(comparison).startswith("Given the healthy set “trial”: ")
    replaced(pair, "measurement.toml", 'baseline = "../healthy"', "")
    alone = compared(pair, case, monkeypatch)
    assert alone.healthy is None and len(alone.sentences) > 3


def test_the_scatter_of_both_sets_remains(pair: Path, case, monkeypatch) -> None:
    """Of the motor power: noise of both; of TC1 the scale of the sensor on what it reads more, besides its inlet."""
    comparison = compared(pair, case, monkeypatch)
    at = {feature: i for i, feature in enumerate(comparison.data.features)}
    i = at[Feature("M_wheel", "P03", 99.0, "real")]
    noise = comparison.data.noise[i], comparison.healthy.data.noise[i]
    assert comparison.spread[i] >= np.hypot(*noise) and comparison.spread[i] < 1.5 * np.hypot(*noise)
    bare = replace(comparison.data, setting_noise=({},) * 6)
    healthy = HealthySet(
        measurement=comparison.healthy.measurement,
        data=replace(comparison.healthy.data, setting_noise=({},) * 6),
        prediction=comparison.healthy.prediction,
    )
    prediction = Prediction(features=bare.features, values=comparison.simulated)
    again = compare(comparison.measurement, bare, prediction, healthy)
    i = at[Feature("TC1", "P03")]
    noise = bare.noise[i], healthy.data.noise[i]
    assert again.spread[i] == pytest.approx(
        np.sqrt(noise[0] ** 2 + noise[1] ** 2 + (0.01 * 6.0) ** 2), rel=1e-6
    )


def test_a_number_that_is_not_used_leaves_the_scatter_of_the_others_as_it_is(
    pair: Path, case, monkeypatch
) -> None:
    """The sensitivity to the settings is that of the simulation, which has the number all the same."""
    comparison = compared(pair, case, monkeypatch)
    healthy, rows = comparison.healthy, comparison.healthy.data.features
    lost = rows.index(Feature("TC1", "P03"))
    usable = healthy.data.usable.copy()
    usable[lost] = False
    less = foretold(comparison.data, replace(healthy, data=replace(healthy.data, usable=usable)))
    row = comparison.data.features.index(Feature("TC1", "P03"))
    others = np.delete(np.arange(len(comparison.data.features)), row)
    assert not less.known[row] and comparison.foretold.known[row]
    assert np.array_equal(less.variance[others], comparison.foretold.variance[others], equal_nan=True)


def test_points_are_known_by_how_they_were_run(pair: Path, case, monkeypatch) -> None:
    for number in range(1, 7):
        for name in ("data.csv", "orders.csv"):
            replaced(pair.parent / "healthy", name, f"P0{number},", f"Q{7 - number},")
    comparison = compared(pair, case, monkeypatch)
    assert comparison.foretold.points["P01"] == "Q6" and len(comparison.sentences) == 1


def test_what_the_healthy_set_lacks_is_held_against_the_simulation_and_told(
    pair: Path, case, monkeypatch
) -> None:
    healthy = pair.parent / "healthy"
    for name in ("data.csv", "orders.csv"):
        lines = (healthy / name).read_text(encoding="utf-8").splitlines()
        kept = [line for line in lines if not line.startswith("P06")]
        (healthy / name).write_text("\n".join(kept) + "\n", encoding="utf-8")
    replaced(healthy, "measurement.toml", 'place = "test.outer_warm"', 'place = "test.outer_cold_front"')
    comparison = compared(pair, case, monkeypatch)
    (finding,) = (one for one in comparison.findings if one.id == "not_in_baseline")
    assert finding.points == ("P06",) and "13 of 49 numbers" in finding.text
    at = {feature: i for i, feature in enumerate(comparison.data.features)}
    for feature, known in (
        (Feature("P", "P06"), False),
        (Feature("TC1", "P01"), False),
        (Feature("P", "P01"), True),
    ):
        i = at[feature]
        assert comparison.foretold.known[i] == known
        assert (comparison.expected[i] == comparison.simulated[i]) != known


def test_the_page_shows_measured_and_simulated_first(pair: Path, tmp_path: Path, case, monkeypatch) -> None:
    comparison = compared(pair, case, monkeypatch)
    write_comparison(comparison, tmp_path / "out", model="full", fidelity="quick")
    page = (tmp_path / "out" / "compare.html").read_text(encoding="utf-8")
    first = page[page.index("<svg") : page.index("</svg>")]
    assert 'aria-label="Measured and simulated over the operating points"' in first
    for words in ("measured", "simulated", "simulated, with the residual of the healthy set", "TC1", "P06"):
        assert f">{words}</text>" in first
    document = json.loads((tmp_path / "out" / "compare.json").read_text(encoding="utf-8"))
    assert document["baseline"]["title"] == "trial" and document["baseline"]["points"]["P01"] == "P01"
    row = next(row for row in document["residuals"] if row["channel"] == "TC1")
    assert row["expected"] - row["simulated"] == pytest.approx(4.0) and row["residual"] == pytest.approx(6.0)
    assert comparison_document(comparison, model="full", fidelity="quick") == document


def test_a_baseline_that_cannot_be_used_is_refused(pair: Path, case, monkeypatch) -> None:
    (pair.parent / "healthy" / "data.csv").write_text("point\n", encoding="utf-8")
    with pytest.raises(MeasurementError, match="healthy"):
        compared(pair, case, monkeypatch)
    assert features(load_measurement(pair, case)).usable.all()

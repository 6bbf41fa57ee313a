"""Root gauges of a measurement set: recordings to numbers of the curve, columns of a table, faults."""

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.measurement import features, load_measurement
from rigdesign.prediction.model import Feature
from rigdesign.prediction.readings import StrainCurve
from rigdesign.rig.model import build_rig
from rigdesign.strain_gauge.turn_average import curve_windows
from tests.builders.root_gauges import CASE, GAUGES, Chain, conditions, write_recordings

PITCH = 2.0 * np.pi / 18
ANGLE = np.linspace(-1.5 * PITCH, 1.5 * PITCH, 400)


def curve(height: float) -> StrainCurve:
    """A tooth that carries a little longer at its exit."""
    place = ANGLE / (0.35 * PITCH)
    return StrainCurve(angle=ANGLE, strain=height * np.exp(-(place**2)) * (1.0 + 0.2 * np.tanh(place)))


@pytest.fixture(scope="module")
def case():
    return load_case(CASE)


@pytest.fixture(scope="module")
def recorded(case, tmp_path_factory):
    strains = [{name: curve(1e-4 * (3 + number)) for number, name in enumerate(GAUGES)} for _ in range(2)]
    points = conditions([(100.0, 189.0), (1500.0, 189.0)])
    chain = Chain(scale=dict.fromkeys(GAUGES, 1.0), turns=6.3)
    folder = write_recordings(
        tmp_path_factory.mktemp("gauges"), build_rig(case, "quick"), points, strains, chain
    )
    return folder, strains


def test_recordings_become_the_numbers_of_the_curve(case, recorded) -> None:
    folder, strains = recorded
    measurement = load_measurement(folder, case)
    for number, name in enumerate(GAUGES):
        known = curve_windows(strains[0][name].angle, strains[0][name].strain, PITCH)
        for point in ("P1", "P2"):
            read = {
                window: measurement.readings[Feature(f"gauge_{name}", point, part=window)][0]
                for window in ("entry", "maximum", "exit", "unloaded")
            }
            for window in ("entry", "maximum", "exit"):
                assert read[window] == pytest.approx(known[window], abs=3e-6), (name, point, window)
            assert read["unloaded"] == pytest.approx(2.0 * 3e-5, rel=0.2), number
    assert any(finding.id == "no_tach" for finding in measurement.findings)
    data = features(measurement)
    assert data.usable.all() and len(data.features) == 2 * 4 * 4


def test_a_table_holds_one_window_in_the_column_of_the_channel(case) -> None:
    measurement = load_measurement(CASE / "measured" / "p1_printed", case)
    assert set(measurement.readings) == {
        Feature("gauge_ii", name, part="maximum") for name in ("n100", "n1500")
    }
    slow, fast = (
        measurement.readings[Feature("gauge_ii", name, part="maximum")][0] for name in ("n100", "n1500")
    )
    assert fast / slow - 1.0 == pytest.approx(-0.07, abs=5e-4)
    assert 206e9 * (slow - fast) == pytest.approx(8.8e6, rel=2e-3)
    assert len([one for one in measurement.findings if one.id == "doubt"]) == 3


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('place = "test.pinion.ii"', 'place = "test.wheel.ii"', "test.pinion.ii"),
        ('windows = ["maximum"]', 'windows = ["maximum", "maximum"]', "must be different"),
        ('windows = ["maximum"]', 'transfer = { kind = "low_pass", frequency = "2 kHz" }', "response_time"),
        ('unit = "um/m"', 'unit = "MPa"', "strain"),
    ],
)
def test_faults_of_a_gauge_name_key_and_remedy(case, tmp_path, old, new, said) -> None:
    source = CASE / "measured" / "p1_printed"
    text = (source / "measurement.toml").read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "measurement.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    (tmp_path / "data.csv").write_text((source / "data.csv").read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(MeasurementError, match=said):
        load_measurement(tmp_path, case)

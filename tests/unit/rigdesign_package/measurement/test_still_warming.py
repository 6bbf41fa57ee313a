"""Repeats with times: a point whose temperatures drift is said to warm up still, by how much an hour."""

from math import hypot
from pathlib import Path

import pytest

from rigdesign.case import load_case
from rigdesign.measurement import load_measurement
from rigdesign.measurement.processing.features import features
from rigdesign.measurement.quality.checks import LEAST, rates
from rigdesign.prediction.model import Feature
from tests.builders.measurement import write_set
from tests.builders.paths import CASES

CASE = load_case(CASES / "uhcf_prototype")
GAP = 20.0
"""Between repeats [min]."""


def drifting(folder: Path, rate: float, *, unit: str = "min", per_unit: float = 1.0) -> Path:
    """A set with times whose TC1 at P03 rises by ``rate`` [K/h] from repeat to repeat."""
    write_set(folder, repeats=3)
    lines = [line.split(",") for line in (folder / "data.csv").read_text(encoding="utf-8").splitlines()]
    place = lines[0].index("TC1")
    rows = [",".join([*lines[0], "time"]), ",".join([*lines[1], unit])]
    for number, cells in enumerate(lines[2:]):
        minutes = GAP * number
        if cells[0] == "P03":
            cells[place] = f"{90.0 + rate * (int(cells[1]) - 1) * GAP / 60.0:.6f}"
        rows.append(",".join([*cells, f"{minutes * per_unit:.12g}"]))
    (folder / "data.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return folder


def warming(folder: Path):
    data = features(load_measurement(folder, CASE))
    return [one for one in data.findings if one.id == "still_warming"]


@pytest.mark.parametrize("unit, per_unit", [("min", 1.0), ("s", 60.0), ("h", 1.0 / 60.0)])
def test_the_rate_is_the_slope_over_the_times(tmp_path: Path, unit: str, per_unit: float) -> None:
    measurement = load_measurement(drifting(tmp_path, 6.0, unit=unit, per_unit=per_unit), CASE)
    found = {rate.channel: rate for rate in rates(measurement, measurement.points[2])}
    assert 3600.0 * found["TC1"].value == pytest.approx(6.0, rel=1e-6)
    # 0.1 K a reading, repeats 20 min from their middle: sqrt(2 * 20^2) min
    assert 3600.0 * found["TC1"].sd == pytest.approx(0.1 / (2.0 * (GAP / 60.0) ** 2) ** 0.5, rel=1e-6)
    assert set(found) == {"TC1", "TC2"}


@pytest.mark.parametrize("day", ["2026-03-04 ", "4.3.2026 ", ""])
def test_time_stamps_of_rows_are_read(tmp_path: Path, day: str) -> None:
    path = drifting(tmp_path, 6.0, unit="") / "data.csv"
    lines = [line.rpartition(",") for line in path.read_text(encoding="utf-8").splitlines()]
    rows = [f"{row},{day}{8 + int(time) // 60}:{int(time) % 60:02d}:00" for row, _, time in lines[2:]]
    rows[-1] = rows[-1].rpartition(",")[0] + ","  # of the row at standstill
    path.write_text(
        "\n".join([*(f"{row},{time}" for row, _, time in lines[:2]), *rows]) + "\n", encoding="utf-8"
    )
    measurement = load_measurement(tmp_path, CASE)
    found = {rate.channel: rate for rate in rates(measurement, measurement.points[2])}
    assert 3600.0 * found["TC1"].value == pytest.approx(6.0, rel=1e-6)
    assert "unused_column" not in {one.id for one in measurement.findings}


def test_rates_are_channels_of_their_own(tmp_path: Path) -> None:
    data = features(load_measurement(drifting(tmp_path, 6.0), CASE))
    known = dict(zip(data.features, zip(data.values, data.noise, data.usable)))
    value, noise, usable = known[Feature("rate of TC1", "P03")]
    assert 3600.0 * value == pytest.approx(6.0, rel=1e-6) and usable
    # the slope of the repeats, and what a steady rig drifts by
    assert 3600.0 * noise == pytest.approx(hypot(0.1 / (2.0 * (GAP / 60.0) ** 2) ** 0.5, 3600.0 * LEAST))
    assert abs(known[Feature("rate of TC1", "P01")][0]) < noise
    assert data.strength == "proven"
    assert not any(
        "rate" in one for one in features(load_measurement(write_set(tmp_path / "x"), CASE)).channels
    )


def test_a_drifting_point_is_told_with_its_rate(tmp_path: Path) -> None:
    (finding,) = warming(drifting(tmp_path, 6.0))
    assert finding.weight == "suspect" and finding.points == ("P03",) and finding.channels == ("TC1",)
    assert "P03: temperatures still rise" in finding.text and "6 K/h at TC1" in finding.text
    assert "steady = false" in finding.text


def test_a_slow_drift_is_a_note_and_scatter_is_none(tmp_path: Path) -> None:
    (cooling,) = warming(drifting(tmp_path / "fast", -4.0))
    assert "still fall" in cooling.text
    assert warming(drifting(tmp_path / "still", 0.0)) == []
    assert warming(drifting(tmp_path / "slow", 0.3)) == []
    assert warming(write_set(tmp_path / "without times", repeats=3)) == []


def test_a_column_of_times_needs_a_unit_of_time(tmp_path: Path) -> None:
    data = features(load_measurement(drifting(tmp_path, 6.0, unit="K"), CASE))
    assert "unused_column" in {one.id for one in data.findings}
    assert load_measurement(tmp_path, CASE).points[0].times is None

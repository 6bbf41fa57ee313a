"""compare: differences put into a simulation by hand are located and told as they were put in."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.measurement import features, load_measurement
from rigdesign.measurement.comparison.compare import (
    Comparison,
    compare,
    comparison_document,
    headline,
    significant,
)
from rigdesign.prediction import Prediction
from rigdesign.report.pages.measurement import write_comparison
from tests.builders.measurement import changed_column, write_set
from tests.builders.paths import CASES


@pytest.fixture(scope="module")
def case():
    return load_case(CASES / "uhcf_prototype")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_set(tmp_path / "set")


def held_against(folder: Path, case, change=None, *, simulated: Path | None = None) -> Comparison:
    """A set against the readings of another one, its simulation, after ``change(feature, setting, value)``."""
    measurement = load_measurement(folder, case)
    data = features(measurement)
    source = data if simulated is None else features(load_measurement(simulated, case))
    settings = {setting.name: setting for setting in data.settings}
    values = source.values.copy()
    if change is not None:
        for i, feature in enumerate(data.features):
            values[i] = change(feature, settings.get(feature.setting), values[i])
    return compare(measurement, data, Prediction(features=data.features, values=values))


def test_agreement_is_told(folder: Path, case) -> None:
    comparison = held_against(folder, case)
    assert not comparison.sentences
    assert "agree within the declared uncertainty" in headline(comparison)


@pytest.mark.parametrize(
    ("variable", "size"),
    [
        ("torque", lambda s: 8.0 * s.torque / 180.0),
        ("constant", lambda s: 6.0),
        ("speed_squared", lambda s: 9.0 * (s.speed / 1256.0) ** 2),
        ("torque_speed", lambda s: 9.0 * s.speed * s.torque / 1256.0 / 180.0),
    ],
)
def test_a_difference_is_located_with_its_variable(folder: Path, case, variable: str, size) -> None:
    def change(feature, setting, value):
        return value - size(setting) if feature.channel == "TC1" else value

    comparison = held_against(folder, case, change)
    first = comparison.located[0]
    assert first.group == "temperatures of the outside of the warm chamber of gearbox test"
    assert first.variable == variable and first.share > 0.99
    assert first.positive == 1.0 and "above the simulation" in comparison.sentences[0]
    assert not any(significant(item) for item in comparison.located[1:])


def test_an_order_is_located_in_its_band(folder: Path, case) -> None:
    def change(feature, setting, value):
        return (
            value + 0.8
            if feature.channel == "M_wheel" and feature.order == 1.0 and feature.part == "real"
            else value
        )

    comparison = held_against(folder, case, change)
    assert comparison.located[0].group == "torque in coupling wheel_side, shaft orders"
    assert "off by up to 0.8 N m" in headline(comparison)


def test_each_quantity_of_a_group_has_its_own_size_and_unit(folder: Path, case) -> None:
    """Power 163 to 324 W and torque 2.1 to 4 N m below the simulation: no number of one in the unit of the other."""
    with (folder / "measurement.toml").open("a", encoding="utf-8") as file:
        file.write('[channels.M_drive]\nquantity = "drive_torque"\nunit = "N m"\nuncertainty = "0.02 N m"\n')
    names, given, *rows = (folder / "data.csv").read_text(encoding="utf-8").splitlines()
    lines = [f"{names},M_drive", f"{given},N m"]
    for row in rows:
        speed, power = row.split(",")[2], row.split(",")[7]
        lines.append(f"{row},{float(power) / (np.pi / 30 * float(speed)) if power else ''}")
    (folder / "data.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    steps = {
        "P": dict(zip(("P01", "P02", "P03", "P04", "P05", "P06"), (163, 163, 200, 220, 250, 324))),
        "M_drive": dict(zip(("P01", "P02", "P03", "P04", "P05", "P06"), (4.0, 3.5, 3.0, 2.9, 2.5, 2.1))),
    }

    def change(feature, setting, value):
        return value + steps.get(feature.channel, {}).get(feature.setting, 0.0)

    sentence = held_against(folder, case, change).sentences[0]
    assert sentence.startswith("Drive power and torque: below the simulation by up to 324 W and 4 N m, all")


def test_chance_alone_is_seldom_significant(folder: Path, case) -> None:
    """Noise as declared: over 40 draws of some ten groups fewer than 2 % come out."""
    measurement = load_measurement(folder, case)
    data = features(measurement)
    rng = np.random.default_rng(5)
    found = whole = 0
    for _ in range(40):
        noisy = data.values + data.noise * rng.standard_normal(len(data.values))
        comparison = compare(measurement, data, Prediction(features=data.features, values=noisy))
        found += len(comparison.sentences)
        whole += len(comparison.located)
    assert found < 0.02 * whole


def test_exchanged_channels_are_suspected(folder: Path, tmp_path: Path, case) -> None:
    healthy = write_set(tmp_path / "healthy")
    lines = [line.split(",") for line in (folder / "data.csv").read_text(encoding="utf-8").splitlines()]
    a, b = lines[0].index("TC1"), lines[0].index("TC2")
    for cells in lines[2:]:
        cells[a], cells[b] = cells[b], cells[a]
    (folder / "data.csv").write_text("\n".join(",".join(c) for c in lines) + "\n", encoding="utf-8")
    comparison = held_against(folder, case, simulated=healthy)
    suspects = [finding for finding in comparison.findings if finding.id == "swapped_channels"]
    assert [set(finding.channels) for finding in suspects] == [{"TC1", "TC2"}]


def test_kilowatts_called_watts_are_suspected(folder: Path, tmp_path: Path, case) -> None:
    healthy = write_set(tmp_path / "healthy")
    changed_column(folder, "P", lambda value: value / 1000.0)
    comparison = held_against(folder, case, simulated=healthy)
    suspect = next(finding for finding in comparison.findings if finding.id == "unit")
    assert suspect.channels == ("P",) and "would fit kW" in suspect.text


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_single_readings_a_thousand_times_off_are_suspected(
    folder: Path, tmp_path: Path, case, factor: float
) -> None:
    healthy = write_set(tmp_path / "healthy")
    readings = iter(range(12))
    changed_column(folder, "P", lambda value: value * (factor if next(readings) in (2, 3) else 1.0))
    comparison = held_against(folder, case, simulated=healthy)
    (suspect,) = (finding for finding in comparison.findings if finding.id == "thousands")
    assert suspect.points == ("P02",) and "a factor of 1000" in suspect.text
    assert not any(finding.id == "unit" for finding in comparison.findings)


def test_a_prediction_of_something_else_is_refused(folder: Path, case) -> None:
    measurement = load_measurement(folder, case)
    data = features(measurement)
    with pytest.raises(ValueError, match="other features"):
        compare(measurement, data, Prediction(features=data.features[1:], values=data.values[1:]))


def test_the_page_stands_alone_and_the_document_is_whole(folder: Path, tmp_path: Path, case) -> None:
    def change(feature, setting, value):
        return value - 5.0 if feature.channel == "TC1" else value

    comparison = held_against(folder, case, change)
    write_comparison(comparison, tmp_path / "out", model="full", fidelity="quick")
    page = (tmp_path / "out" / "compare.html").read_text(encoding="utf-8")
    assert not re.search(r'(?:src|href)="(?!#)', page.replace("xlink:href", "xlink"))
    assert headline(comparison) in page and page.count("<svg") == 4
    document = json.loads((tmp_path / "out" / "compare.json").read_text(encoding="utf-8"))
    assert document["measurement"]["hash"] == comparison.measurement.hash
    assert len(document["residuals"]) == document["numbers"] == int(comparison.data.usable.sum())
    row = next(row for row in document["residuals"] if row["channel"] == "TC1")
    assert row["residual"] == pytest.approx(5.0) and row["residual_unit"] == "K" and row["unit"] == "degC"
    again = comparison_document(comparison, model="full", fidelity="quick")
    assert again == document

"""Pictures of the thermal course and of the seals: what is drawn lies where the numbers say."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rigdesign.report.figures.drawing import drawing_style
from rigdesign.report.figures.seals import seal_gap_figure, seal_round_figure
from rigdesign.report.figures.transient import (
    APART,
    LABEL_ROOM,
    columns_of,
    oil_power_figure,
    transient_figure,
)
from rigdesign.report.numbers import power_text
from rigdesign.report.palette import VERDICT_COLOURS
from rigdesign.results.curves import transient_curves
from rigdesign.results.thermal import OilPowerCurve, TransientCurve, TransientResult, WorstMoment
from tests.builders.report import thermal_and_expansion

TIMES = [0.0, 10.0, 1000.0, 1001.0, 1010.0, 4610.0, 90000.0]
PHASES = ["warm_up"] * 3 + ["bracing to full_torque"] * 2 + ["test"] * 2


@pytest.fixture
def curve() -> TransientCurve:
    gap = [0.6, 0.58, 0.55, 0.55, 0.54, 0.5, 0.52]
    return TransientCurve(
        gearbox="test", branch="schedule", time_s=TIMES, phase=PHASES, speed_rpm=[0.0] * 7,
        temperatures_degC={"housing": [20.0 + i for i in range(7)], "housing_max": [30.0] * 7},
        clearances_mm={
            "seal_gap": {"front": gap, "rear": [0.7] * 7}, "axial_play": {}, "tip_clearance": {},
            "bearing_clearance": {"test.front": [0.08] * 7}, "backlash": {"test.main": [0.1] * 7},
        },
        alignment={
            "coupling_offset_mm": {"a_side": [0.0, 0.1, 0.2, 0.2, 0.2, 0.25, 0.22], "b_side": [0.0] * 7},
            "bore_out_of_round": {"test.front": [0.0] * 7},
        },
    )  # fmt: skip


def result(curve: TransientCurve) -> TransientResult:
    common = {"branch": "schedule", "phase": "test", "time_s": 4610.0, "unit": "mm", "steady": None}
    worst = [
        WorstMoment(quantity="seal_gap", value=0.5, place="front", limit=0.3, **common),
        WorstMoment(quantity="coupling_offset", value=0.25, place="a_side", limit=0.3, **common),
    ]
    return TransientResult(
        curves=[curve], worst=worst, settling=[], soak=[], inputs={}, energy_closure=0.0, missed_temperature_K=0.0
    )  # fmt: skip


def test_columns_are_as_wide_as_their_decades(curve: TransientCurve) -> None:
    columns = columns_of(curve)
    assert [column.phase for column in columns] == ["warm_up", "bracing to full_torque", "test"]
    widths = [column.end - column.start for column in columns]
    assert widths == pytest.approx([3.0, math.log10(30.0), math.log10(88990.0)])
    assert columns[1].start == pytest.approx(columns[0].end + APART)
    # a phase starts from the last entry of the one before
    assert columns[1].at == [2, 3, 4]
    assert columns[2].places(curve) - columns[2].start == pytest.approx(
        [0.0, math.log10(3600.0), math.log10(88990.0)]
    )


def test_rings_stand_at_the_worst_moments_and_lines_break_between_phases(curve: TransientCurve) -> None:
    with drawing_style():
        figure = transient_figure(result(curve), curve)
    temperatures, seal, _, _, offset = figure.axes
    assert temperatures.get_lines()[0].get_label() == "housing"
    place = columns_of(curve)[2].start + math.log10(3600.0)
    for axes, value in ((seal, 0.5), (offset, 0.25)):
        ring = next(line for line in axes.get_lines() if line.get_marker() == "o")
        assert ring.get_xdata() == pytest.approx([place])
        assert ring.get_ydata() == pytest.approx([value])
        course = np.asarray(axes.get_lines()[0].get_ydata(), dtype=float)
        assert np.isnan(course).sum() == 3
    assert np.nanmin(np.asarray(seal.get_lines()[0].get_ydata(), dtype=float)) == 0.5
    assert np.nanmax(np.asarray(offset.get_lines()[0].get_ydata(), dtype=float)) == 0.25


def test_time_labels_keep_clear_of_each_other(curve: TransientCurve) -> None:
    with drawing_style():
        axes = transient_figure(result(curve), curve).axes[-1]
        shown = [
            place
            for place, label in zip(axes.get_xticks(), axes.get_xticklabels(), strict=True)
            if label.get_text()
        ]
    assert min(np.diff(shown)) >= LABEL_ROOM - 1e-9


def test_a_course_without_a_coupling_has_no_row_for_it(curve: TransientCurve) -> None:
    bare = TransientCurve(**{**vars(curve), "alignment": {}})
    with drawing_style():
        assert len(transient_figure(result(bare), bare).axes) == 4


def test_tables_name_quantity_place_and_unit(curve: TransientCurve) -> None:
    ((name, columns),) = transient_curves(result(curve))
    assert name == "transient_test_schedule"
    assert {"coupling_offset a_side [mm]", "bore_out_of_round test.front [1]", "seal_gap front [mm]"} <= set(
        columns
    )


def test_oil_power_is_drawn_and_tabled_with_its_worst_moment(curve: TransientCurve) -> None:
    heater = [0.0, 6700.0, 1500.0, 1500.0, 1450.0, 1400.0, 1380.0]
    power = OilPowerCurve(
        branch="schedule", time_s=TIMES, phase=PHASES, heater_W=heater, cooler_W=[500.0] * 7,
        streams_W={"test.gear_oil": [-value for value in heater]},
    )  # fmt: skip
    moment = WorstMoment(
        quantity="heater_power", value=6.7, unit="kW", time_s=10.0, place="rig", branch="schedule",
        phase="warm_up", steady=1.38, limit=3.0,
    )  # fmt: skip
    whole = replace(result(curve), oil_power=[power], worst=[moment])
    with drawing_style():
        (axes,) = oil_power_figure(whole, power).axes
    ring = next(line for line in axes.get_lines() if line.get_marker() == "o")
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == pytest.approx(
        (columns_of(power)[0].start + 1.0, 6.7)
    )
    limits = [line for line in axes.get_lines() if list(line.get_ydata()) == [3.0, 3.0]]
    assert len(limits) == 1
    columns = dict(transient_curves(whole))["transient_oil_power_schedule"]
    assert columns["heater [W]"][1] == 6700.0
    assert columns["heat into test.gear_oil [W]"][1] == -6700.0


def test_seals_are_closed_round_the_shaft_and_their_least_gap_is_marked() -> None:
    _, expansion = thermal_and_expansion()
    with drawing_style():
        over = seal_gap_figure([expansion]).axes[0]
        round_figure = seal_round_figure(expansion, 0.3)
    for line in over.get_lines()[: len(expansion.seal_gaps)]:
        assert (line.get_xdata()[0], line.get_xdata()[-1]) == (0.0, 360.0)
        assert line.get_ydata()[0] == pytest.approx(line.get_ydata()[-1])
    axes = round_figure.axes[0]
    texts = [text.get_text() for text in axes.texts]
    assert sum("least 0.571 mm at 90°" in text for text in texts) == len(expansion.seal_gaps)
    marks = [line for line in axes.get_lines() if line.get_color() == VERDICT_COLOURS["fail"]]
    for line in marks:
        x, y = line.get_xdata(), line.get_ydata()
        assert x[0] == pytest.approx(x[1])  # 90 degrees: straight up
        assert y[1] > y[0]
    assert len(marks) == len(expansion.seal_gaps)


@pytest.mark.parametrize(
    ("value", "text"), [(1e-3, "10⁻³"), (0.1, "0.1"), (1.0, "1"), (100.0, "100"), (1e4, "10⁴")]
)
def test_powers_of_ten_on_an_axis(value: float, text: str) -> None:
    assert power_text(value) == text

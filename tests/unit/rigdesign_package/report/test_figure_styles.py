"""A gearbox looks the same in every figure, several curves differ by line as well, labels carry no noise digits."""

import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.text import Text

from rigdesign.report.figures import dynamics as dynamics_figures
from rigdesign.report.figures import heat
from rigdesign.report.figures.drawing import drawing_style, inline_svg, stated_quantity, words
from rigdesign.report.figures.dynamics import ramp_figure
from rigdesign.report.figures.seals import seal_gap_figure
from rigdesign.report.figures.teeth import pair_share_figure
from rigdesign.report.figures.vibration import waterfall_figure
from rigdesign.report.numbers import NARROW_SPACE, unit_text
from rigdesign.report.palette import curve_style, gearbox_colours
from rigdesign.report.sections.section import gearbox_styles
from rigdesign.results.teeth import PairShare
from rigdesign.results.units import RPM
from rigdesign.results.vibration import Waterfall
from tests.builders.report import make_result, thermal_and_expansion

NOISE = re.compile(r"\d\.\d{5,}|\d{6,}\.\d|[0-9]e[-+]?\d")
"""Digits that say nothing: 0.30000000000000004, 123456.7, 1e-05."""


@pytest.fixture(scope="module")
def result():
    return make_result()


def colours(axes):
    """Of lines, bands and the piece of line in front of the title."""
    lines = {to_hex(line.get_color()) for line in (*axes.get_lines(), *axes.artists)}
    return lines | {to_hex(band.get_facecolor()[0]) for band in axes.collections}


def test_a_gearbox_has_its_colour_in_every_figure(result):
    styles = gearbox_styles(result)
    assert list(styles) == ["reference", "test"]
    with drawing_style():
        factor = dynamics_figures.dynamic_factor_figure(result.dynamics)
        ramp = ramp_figure(result.dynamics.ramp)
        stress = dynamics_figures.root_stress_figure(result.dynamics.gearboxes["test"], styles["test"])
        seals = seal_gap_figure(result.expansion, styles)
    for name, axes in [
        *zip(result.dynamics.gearboxes, factor.axes),
        *zip(result.dynamics.ramp.torque, ramp.axes[2:]),
        *(("test", axes) for axes in (*stress.axes, *seals.axes)),
    ]:
        (other,) = set(styles) - {name}
        assert styles[name].colour in colours(axes)
        if axes not in seals.axes:
            assert styles[other].colour not in colours(axes)


def test_a_gearbox_without_a_mesh_keeps_its_place_in_the_order(result):
    """Only ``test`` has a field here; its style is that of the second name all the same."""
    assert {item.gearbox for item in result.expansion} == {"test"}
    assert gearbox_styles(result)["test"] == gearbox_colours(["reference", "test"])["test"]
    assert gearbox_styles(replace(result, dynamics=None))["test"] == gearbox_colours(["test"])["test"]


def test_curves_of_one_plot_differ_by_more_than_colour(result):
    _, expansion = thermal_and_expansion()
    with drawing_style():
        seals = seal_gap_figure([expansion]).axes[0]
        factor = dynamics_figures.dynamic_factor_figure(result.dynamics).axes[0]
        spread = heat.convergence_figure([*result.coupling, *result.coupling]).axes[0]
    for axes, least in ((seals, 4), (factor, 4), (spread, 2)):
        drawn = [line for line in axes.get_lines() if line.get_linestyle() != "None"]
        looks = {(str(line._dash_pattern), line.get_marker(), line.get_linewidth()) for line in drawn}
        named = [line for line in drawn if not str(line.get_label()).startswith("_")]
        assert len(looks) == len(named) >= least


def test_words_units_and_ticks_read_as_in_tables(result):
    assert words("test.pinion_rear") == "test pinion rear"
    assert words("x0.8 of_a_variant") == "x0.8 of a variant"
    assert stated_quantity("180 Nm") == f"180 {unit_text('Nm')}"
    with drawing_style():
        text = "".join(
            inline_svg(figure, f"f{number}", "")
            for number, figure in enumerate(
                (
                    dynamics_figures.dynamic_factor_figure(result.dynamics),
                    ramp_figure(result.dynamics.ramp),
                    heat.losses_by_stage_figure(result.losses),
                    heat.losses_by_place_figure(result.losses, "dwell"),
                    heat.oil_figure(result.oil, "dwell"),
                    heat.convergence_figure(result.coupling),
                )
            )
        )
    labels = re.findall(r"<text [^>]*>(.*?)</text>", text, re.DOTALL)
    assert f"10{NARROW_SPACE}000" in labels
    assert [label for label in labels if NOISE.search(label) or "_" in label] == []
    assert "torque, 0-peak" in labels
    assert any(label.endswith("kW") for label in labels)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_titles_of_panels_do_not_run_into_each_other(count: int) -> None:
    """Four meshes of one rig, two panels a line."""
    names = [f"reference_{letter}" for letter in "abcd"[:count]]
    styles = {name: curve_style(number) for number, name in enumerate(names)}
    speed, frequency = np.linspace(600.0, 12000.0, 20), np.linspace(0.0, 1e4, 30)
    waterfall = [
        Waterfall(
            mesh=name, stage="run_up", per_turn=45.0, speed=tuple(speed / RPM), frequency=tuple(frequency),
            amplitude=((5.0,) * 30,) * 20,
        )
        for name in names
    ]  # fmt: skip
    angle = tuple(np.linspace(-5.0, 5.0, 9))
    shares = [
        PairShare(
            mesh=name, stage="test", angle=angle, share=angle, static_share=angle, force=angle, face=angle,
            line_load=angle, static_line_load=angle, most_loaded=0.0,
        )
        for name in names
    ]  # fmt: skip
    with drawing_style():
        for figure in (waterfall_figure(waterfall, styles), pair_share_figure(shares, styles)):
            figure.canvas.draw()
            texts = [
                child for axes in figure.axes for child in axes.get_children() if isinstance(child, Text)
            ]
            boxes = [text.get_window_extent() for text in texts if "Gearbox" in text.get_text()]
            assert len(boxes) == count
            assert all(box.x1 <= figure.bbox.x1 for box in boxes)
            assert not any(a.overlaps(b) for number, a in enumerate(boxes) for b in boxes[:number])

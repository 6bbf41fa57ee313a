"""Colours that stay apart for red-green blind readers, with a second coding, the same for a gearbox everywhere."""

from itertools import combinations

import numpy as np
import pytest

from rigdesign.report.palette import (
    COLD,
    INK,
    LINES,
    MARKERS,
    MUTED,
    SERIES,
    VERDICT_COLOURS,
    WARM,
    curve_style,
    gearbox_colours,
)
from tests.builders.colour_vision import VISIONS, contrast_on_white, distance, seen_lab


def test_the_simulated_vision_confuses_what_a_red_green_blind_reader_confuses():
    """White and blue-yellow stay; a red and a green that are plain to others fall together (Machado et al. 2009)."""
    for vision in VISIONS:
        np.testing.assert_allclose(seen_lab("#ffffff", vision), (100.0, 0.0, 0.0), atol=0.1)
    assert distance("#c80000", "#007c00", "normal") > 100.0
    red_green = distance("#8a6d00", "#5f7f00", "deuteranopia")
    assert red_green < 0.5 * distance("#8a6d00", "#5f7f00", "normal")
    assert distance("#0000ff", "#ffff00", "deuteranopia") > 150.0


@pytest.mark.parametrize("vision", VISIONS)
def test_verdict_colours_stay_apart(vision):
    pairs = {
        pair: distance(*(VERDICT_COLOURS[name] for name in pair), vision)
        for pair in combinations(VERDICT_COLOURS, 2)
    }
    assert min(pairs.values()) > 20.0, pairs


@pytest.mark.parametrize("vision", VISIONS)
def test_series_stay_apart_most_where_they_are_neighbours(vision):
    around = [(SERIES[i - 1], SERIES[i]) for i in range(len(SERIES))]
    assert min(distance(a, b, vision) for a, b in around) > 30.0
    assert min(distance(a, b, vision) for a, b in combinations(SERIES, 2)) > 15.0
    assert distance(WARM, COLD, vision) > 60.0


def test_text_and_lines_stand_out_from_white():
    assert min(contrast_on_white(colour) for colour in (*VERDICT_COLOURS.values(), INK, MUTED)) >= 4.5
    assert min(contrast_on_white(colour) for colour in SERIES) >= 3.0


def test_every_curve_has_a_line_and_a_marker_of_its_own():
    styles = [curve_style(number) for number in range(3 * len(SERIES))]
    assert len(set(styles)) == len(styles)
    assert len({style.line for style in styles[: len(SERIES)]}) == len(LINES) == len(SERIES)
    assert len({style.marker for style in styles[: len(SERIES)]}) == len(MARKERS) == len(SERIES)


def test_a_gearbox_has_one_style_whatever_the_order_of_the_names():
    assert gearbox_colours(["test", "reference"]) == gearbox_colours(("reference", "test", "test"))
    assert gearbox_colours(["reference"])["reference"] == gearbox_colours(["test", "reference"])["reference"]
    styles = list(gearbox_colours(["a", "b", "c"]).values())
    assert len({style.colour for style in styles}) == len({style.line for style in styles}) == 3

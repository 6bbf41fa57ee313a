"""Flow diagrams: widths add up in every node, nothing overlaps, both diagrams carry the heat of the result."""

import re
from dataclasses import replace
from itertools import pairwise

import pytest

from rigdesign.report.figures.drawing import drawing_style, inline_svg, new_figure
from rigdesign.report.figures.flow import Flow, body_flow_figure, layout, rig_flow_figure, spread
from tests.builders.report import make_result, thermal_and_expansion

COLUMNS = [["a", "b", "c"], ["oil", "bodies"], ["cooler", "room"]]
FLOWS = [
    Flow("a", "oil", 60.0),
    Flow("a", "bodies", 5.0),
    Flow("b", "oil", 20.0),
    Flow("c", "bodies", 15.0),
    Flow("oil", "cooler", 80.0),
    Flow("bodies", "cooler", 8.0),
    Flow("bodies", "room", 12.0),
]


def test_widths_add_up_in_every_node() -> None:
    found = layout(COLUMNS, FLOWS)
    for box in found.boxes:
        assert box.high - box.low == pytest.approx(found.scale * box.value)
        leaving = [r.start for r in found.ribbons if r.flow.source == box.name]
        entering = [r.end for r in found.ribbons if r.flow.target == box.name]
        for ends in (leaving, entering):
            if ends:
                assert sum(high - low for _, low, high in ends) == pytest.approx(box.high - box.low)
                assert max(high for _, _, high in ends) == pytest.approx(box.high)
                assert min(low for _, low, _ in ends) == pytest.approx(box.low)
    for ribbon in found.ribbons:
        (_, low, high), (_, low_end, high_end) = ribbon.start, ribbon.end
        assert (
            high - low == pytest.approx(high_end - low_end) == pytest.approx(found.scale * ribbon.flow.value)
        )


def test_nodes_of_a_column_keep_apart_within_the_picture() -> None:
    found = layout(COLUMNS, FLOWS, gap=0.07)
    for number in range(3):
        column = [box for box in found.boxes if box.column == number]
        assert all(above.low - below.high == pytest.approx(0.07) for above, below in pairwise(column))
        assert min(box.low for box in column) > -1e-12
        assert max(box.high for box in column) < 1.0 + 1e-12
    assert min(box.low for box in layout(COLUMNS, FLOWS, low=(1,)).boxes if box.column == 1) == pytest.approx(
        0.0
    )


def test_nothing_is_drawn_of_what_cannot_be_seen() -> None:
    found = layout(COLUMNS, [*FLOWS, Flow("b", "bodies", 1e-3)])
    assert len(found.ribbons) == len(FLOWS)


@pytest.mark.parametrize(
    ("flow", "words"),
    [
        (Flow("a", "oil", -1.0), "turn it round"),
        (Flow("oil", "a", 1.0), "on the right"),
        (Flow("a", "b", 1.0), "on the right"),
        (Flow("a", "sea", 1.0), "on the right"),
    ],
)
def test_flows_that_lead_nowhere_are_refused(flow: Flow, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        layout(COLUMNS, [flow])


def test_labels_keep_their_distance() -> None:
    assert spread([0.9, 0.88, 0.5], 0.1) == pytest.approx([0.9, 0.8, 0.5])
    assert spread([0.1, 0.05, 0.02], 0.1) == pytest.approx([0.2, 0.1, 0.0])
    assert spread([], 0.1) == []


def labels(figure: object) -> dict[str, str]:
    """Text of a figure: name -> number with unit."""
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]  # type: ignore[attr-defined]
    return dict(text.rsplit("  ", 1) for text in texts)


def test_heat_of_the_rig_goes_where_the_balance_says() -> None:
    result = make_result()
    losses = [row for row in result.losses if row.stage == "dwell"]
    with drawing_style():
        figure = rig_flow_figure(losses, result.oil, result.cooler[0])
        assert figure is not None
        found = labels(figure)
        assert rig_flow_figure([], [], replace(result.cooler[0], heater=0.0, cooler=0.0, room=0.0)) is None
    assert found["room"] == "2379 W"
    assert found["cooler"] == "10.5 kW"
    assert found["oil heaters"] == "600 W"
    assert found["windage"] == "700 W"


def test_heat_that_streams_carry_off_has_its_place() -> None:
    result = make_result()
    losses = [row for row in result.losses if row.stage == "dwell"]
    with drawing_style():
        figure = rig_flow_figure(losses, result.oil, replace(result.cooler[0], streams=900.0))
    assert labels(figure)["streams of the housings"] == "900 W"


def test_volumes_of_fluid_are_no_solids() -> None:
    thermal, _ = thermal_and_expansion()
    row = thermal.heat[0]
    fluid = replace(row, surface="jacket", kind="stream", power=-5000.0, area=0.0)
    with drawing_style():
        assert labels(body_flow_figure(replace(thermal, heat=[*thermal.heat, fluid]))) == labels(
            body_flow_figure(thermal)
        )


def test_heat_through_the_bodies_is_drawn_by_kind() -> None:
    thermal, _ = thermal_and_expansion()
    with drawing_style():
        found = labels(body_flow_figure(thermal))
    assert found["oil"] == "2300 W"
    assert found["room air"] == "1762 W"
    assert found["radiation to the room"] == "617 W"
    assert found["housing and field"] == "2379 W"


def test_symbols_in_a_figure_carry_their_index() -> None:
    with drawing_style():
        figure = new_figure(2.0)
        axes = figure.subplots()
        axes.set_title("ratio of σ_F beside K_V(n), run_Z")
        svg = inline_svg(figure, "f1", "x")
    assert re.search(
        r"ratio of σ<tspan [^>]*>F</tspan><tspan [^>]*> beside </tspan>K<tspan [^>]*>V</tspan>", svg
    )
    assert "run_Z" in svg

"""What a study says: where checks pass over an input, what limits them, what fails whatever the input is."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from rigdesign.base.errors import UsageError
from rigdesign.report.figures.drawing import drawing_style
from rigdesign.report.figures.study import tornado_figure
from rigdesign.report.margins.passing_range import slices, study_answer
from rigdesign.report.margins.regions import region_map
from rigdesign.report.margins.table import input_name, study_axis, value_shown
from rigdesign.studies.result import CheckSelection, Swing
from tests.builders.study_points import OIL, TORQUE, check_record, map_points, oil_points, point, study_of

ROOT = "!specimen.root*"


def answered(points, *patterns):
    return study_answer(study_of(points, checks=CheckSelection(patterns)))


def said(points, *patterns):
    return " ".join(answered(points, *patterns).sentences)


def test_a_check_that_always_fails_is_named_and_hides_nothing():
    assert said(oil_points((90, 110, 130, 150))) == (
        "“root stress, ISO 6336-3” fails at every point. Everything else passes up to 118 °C; the limiting check is "
        "“hot tip clearance”."
    )


def test_the_crossing_is_where_the_value_meets_the_limit_not_where_a_line_through_distances_does():
    """The clearance is linear in the temperature, its distance 1 - limit/value is not."""
    answer = answered(oil_points((90, 125)), "clearance.*")
    assert answer.passing.ranges[0].high.value == pytest.approx(118.0, rel=1e-12)
    assert (answer.passing.ranges[0].high.held, answer.passing.ranges[0].high.beyond) == (90.0, 125.0)


def test_order_of_the_points_changes_nothing():
    points = oil_points((150, 90, 130, 110))
    assert said(points) == said(sorted(points, key=lambda p: float(p.values[OIL].split()[0])))


@pytest.mark.parametrize(
    ("patterns", "expected"),
    [
        ((ROOT,), "Every selected check passes up to 118 °C; the limiting check is “hot tip clearance”."),
        (("temperature.*",), "“hottest oil outlet” passes at every point, from 90 °C to 130 °C; 12 % of its limit left "
                             "at 130 °C."),
        (("ramp.*",), "“torque at standstill” passes at every point, from 90 °C to 130 °C; no margin changes."),
        (("temperature.*,ramp.*",), "Every selected check passes at every point, from 90 °C to 130 °C; of the checks "
        "that move, nearest to its "
                                    "limit is “hottest oil outlet”, 12 % of its limit left at 130 °C."),
        (("specimen.root*",), "“root stress, ISO 6336-3” fails at every point."),
    ],
)  # fmt: skip
def test_sentences_of_a_selection(patterns, expected):
    assert said(oil_points((90, 110, 130)), *patterns) == expected


@pytest.mark.parametrize(
    ("path", "name"),
    [
        (OIL, "test oil inlet temperature"),
        (TORQUE, "schedule test torque"),
        ("gearboxes.*.oil.inlet_temperature", "oil inlet temperature of every gearbox"),
        (
            "gearboxes.*.bearings.*.diametral_clearance",
            "diametral clearance of every bearing of every gearbox",
        ),
        ("gearboxes.test.meshes.*.backlash", "backlash of every mesh of gearboxes test"),
        ("gearboxes.test.bearings.pinion_*.width", "width of every bearing pinion_* of gearboxes test"),
        ("drivetrain.couplings.*.stiffness", "stiffness of every coupling"),
    ],
)
def test_inputs_are_named_in_words(path, name):
    assert input_name(path) == name.replace("gearboxes ", "").replace("_", " ")


def test_quantities_among_names_stand_in_printed_units():
    axis = study_axis("oil", [point({"oil": text}) for text in ("as stated", "120 degC", "FVA 3A")])
    assert not axis.numeric
    assert [axis.text(position) for position in axis.positions] == ["as stated", "120 °C", "FVA 3A"]
    assert axis.shown("120 degC") == "120 °C"


def test_a_single_point_is_answered_for_that_point():
    assert said(oil_points((90,)), "!ramp.*") == (
        "“root stress, ISO 6336-3” fails at the only point. Everything else passes at 90 °C; nearest to its limit is "
        "“hottest oil outlet”, 38 % of its limit left."
    )
    assert said(oil_points((90, 110), failed=(110,))).startswith(
        "“root stress, ISO 6336-3” fails at the only point with a result."
    )
    assert said(oil_points((130,)), "clearance.*,temperature.*").startswith(
        "“hot tip clearance” fails at the only"
    )


def test_a_check_that_is_met_by_definition_limits_nothing():
    """The torque at standstill is 10 of 10: nothing left, and not changed by the oil."""
    points = oil_points((90,))
    for record in points[0].record["checks"]:
        record["by_definition"] = record["id"] == "ramp.standstill"
    answer = answered(points, ROOT)
    column, margin = answer.deciding.limiting()
    assert answer.deciding.checks[column[0]].id == "temperature.outlet"
    assert margin[0] == pytest.approx(37.5)
    assert answered(points, "ramp.*").deciding.checks[0].id == "ramp.standstill"


def window(oil):
    return [
        check_record("a.cold", oil, 80.3, comparison=">=", title="too cold"),
        check_record("a.warm", oil, 118.9, title="too warm"),
    ]


def test_both_ends_of_a_range_are_named_and_rounded_to_the_side_that_passes():
    points = [point({OIL: f"{oil} degC"}, window(oil)) for oil in (70, 79, 90, 110, 125)]
    assert said(points) == (
        "Everything passes from 81 °C to 118 °C; the limiting check below 81 °C is “too cold”; the limiting check "
        "above 118 °C is “too warm”."
    )


def test_rounding_stops_at_the_point_that_is_known_to_pass():
    points = [point({OIL: f"{oil} degC"}, [check_record("a.warm", oil, 117.8)]) for oil in (90, 117.5, 137)]
    assert said(points) == "Everything passes up to 117.5 °C."


def test_a_range_from_the_cold_side():
    points = [point({OIL: f"{oil} degC"}, window(oil)) for oil in (60, 75, 90, 110)]
    assert said(points) == "Everything passes from 81 °C; the limiting check is “too cold”."


def test_a_point_without_result_ends_the_range_that_is_proven():
    text = said(oil_points((80, 90, 100, 110, 130), failed=(100,)), ROOT)
    assert text == (
        "Every selected check passes up to 90 °C and from 110 °C to 118 °C; the point after 90 °C has no "
        "result; the point before 110 °C has no result; the limiting check above 118 °C is “hot tip clearance”. "
        "1 of 5 points has no result."
    )


def test_no_point_passes_because_of_several_checks():
    points = [
        point({OIL: f"{oil} degC"}, [check_record("a", oil, 100.0), check_record("b", 200.0 - oil, 100.0)])
        for oil in (60, 90, 110, 150)
    ]
    assert (
        said(points)
        == "Everything fails at every point, because of “a” (2 of 4 points), “b” (2 of 4 points)."
    )


def test_no_result_at_all():
    assert said(oil_points((80, 90), failed=(80, 90))) == "No point has a result."


def test_names_are_listed_not_interpolated():
    points = [
        point({"oil": name}, [check_record("a.film", value, 1.0, comparison=">=", title="film")])
        for name, value in (("FVA 3", 1.4), ("FVA 2", 0.7), ("PAO 46", 1.1))
    ]
    points.append(point({"oil": "mil"}))
    assert said(points) == (
        "Everything passes with FVA 3, PAO 46; fails with FVA 2 (“film”); no result with mil. "
        "1 of 4 points has no result."
    )


def test_two_inputs_are_answered_at_every_value_of_the_second():
    points = map_points((90, 110, 130), (100, 160, 220))
    assert slices(points, answered(points)).rows == (
        ("100 N m", "passes up to 118 °C; the limiting check is “hot tip clearance”"),
        ("160 N m", "passes up to 117 °C; the limiting check is “hot tip clearance”"),
        (
            "220 N m",
            "fails at every point, because of “contact stress” (3 of 3 points), “hot tip clearance” (1 of 3 points)",
        ),
    )
    assert slices(oil_points((90, 110)), answered(oil_points((90, 110)))) is None


def test_of_a_name_and_a_number_the_range_is_of_the_number():
    points = [
        point({"oil": name, OIL: f"{oil} degC"}, [check_record("a", oil + shift, 120.0)])
        for name, shift in (("FVA 3", 0.0), ("FVA 2", 10.0))
        for oil in (90, 130)
    ]
    found = slices(points, answered(points))
    assert found.over.path == "oil"
    assert found.rows == (("FVA 3", "passes up to 120 °C"), ("FVA 2", "passes up to 110 °C"))


def test_a_selection_that_matches_nothing_is_an_error():
    with pytest.raises(UsageError, match=r"no check matches 'temprature\.\*'"):
        said(oil_points((90, 100)), "temprature.*")


@pytest.mark.parametrize(
    ("texts", "positions", "unit"),
    [
        (("40 mm", "4.5 cm", "0.05 m"), (40.0, 45.0, 50.0), "mm"),
        (("90 degC", "80 degC"), (80.0, 90.0), "degC"),
        (("0.2", "0.1"), (0.1, 0.2), ""),
    ],
)
def test_an_axis_of_numbers_is_ascending_in_one_unit(texts, positions, unit):
    axis = study_axis("a", [point({"a": text}) for text in texts])
    assert axis.numeric and axis.unit == unit
    assert axis.positions == pytest.approx(positions)


@pytest.mark.parametrize("texts", [("steel", "bronze"), ("1", "one"), ("1 mm", "1 kg")])
def test_an_axis_of_names_keeps_their_order(texts):
    axis = study_axis("a", [point({"a": text}) for text in texts])
    assert not axis.numeric
    assert axis.texts == texts and axis.positions == (0.0, 1.0)


def a_map(failed=(), temperatures=(90, 110, 130), torques=(100, 160, 220)):
    points = map_points(temperatures, torques, failed)
    answer = answered(points)
    return region_map(answer.axes, points, answer.deciding), answer.deciding


def test_the_map_is_bounded_by_what_the_closed_forms_say():
    """Passes below 200 N m and where 0.708 - 0.006 T - 0.0001 (M - 100) is positive."""
    found, table = a_map()
    oil, torque = np.meshgrid(found.x, found.y)
    clearance = 0.708 - 0.006 * oil - 0.0001 * (torque - 100.0)
    passes = (clearance > 0.0) & (torque < 200.0)
    away = (np.abs(clearance) > 1e-6) & (np.abs(torque - 200.0) > 1e-6)
    assert (found.fails == ~passes)[away].all()
    assert np.sign(found.distance[away & ~passes]).max() < 0 < np.sign(found.distance[away & passes]).min()
    corner = table.checks[found.limiting[0, -1]].title, table.checks[found.limiting[-1, 0]].title
    assert corner == ("hot tip clearance", "contact stress")


def test_the_map_is_blank_around_a_point_without_result():
    found, _ = a_map(failed=((130, 220),))
    assert found.limiting[-1, -1] == -1 and np.isnan(found.margin[-1, -1])
    assert found.limiting[0, 0] >= 0
    assert [(item.x, item.y) for item in found.points if item.failed] == [(130.0, 220.0)]


def test_scattered_points_make_no_map():
    points = map_points((90, 110), (100, 160))[:3]
    answer = answered(points)
    assert region_map(answer.axes, points, answer.deciding) is None


def test_a_map_of_two_of_three_inputs_shows_the_worst_of_the_third():
    points = [
        point(
            {OIL: f"{oil} degC", TORQUE: f"{torque} N m", "c": c},
            [check_record("a", oil + torque + float(c), 300.0)],
        )
        for oil in (90, 130)
        for torque in (100, 160)
        for c in ("0", "50")
    ]
    answer = answered(points)
    found = region_map(answer.axes[:2], points, answer.deciding)
    assert found.margin[0, 0] == pytest.approx(100.0 * (1.0 - 240.0 / 300.0))
    assert found.fails[-1, -1] and not found.fails[0, 0]


@pytest.mark.parametrize(
    ("ends", "low", "high"),
    [
        ([("3000 N s/m", "12000 N s/m", 0.5, 0.85), ("6 um", "0.5 um", 0.5, 0.6)], 15.0, 50.0),
        ([("3000 N s/m", "12000 N s/m", 0.5, 0.5012), ("6 um", "0.5 um", 0.5, 0.4993)], 49.88, 50.07),
        ([("80 degC", "120 degC", 0.4, 0.9)], 10.0, 60.0),
    ],
)
def test_a_tornado_shows_its_labels_whole_and_small_spans_small(ends, low, high):
    """Also where a bar has no length, and where all bars go one way."""
    swings = [
        Swing(
            check="gap", path=f"gearboxes.test.input_{n}", low=first, high=second, distance_stated=0.5,
            distance_low=1.0 - at_low, distance_high=1.0 - at_high,
        )
        for n, (first, second, at_low, at_high) in enumerate(ends)
    ]  # fmt: skip
    with drawing_style():
        figure = tornado_figure("smallest hot gap", swings)
        renderer = FigureCanvasAgg(figure).get_renderer()
    axes = figure.axes[0]
    shown = [text.get_text() for text in axes.texts]
    assert shown == [value_shown(text) for first, second, *_ in ends for text in (first, second)]
    frame = axes.get_window_extent(renderer)
    for text in axes.texts:
        box = text.get_window_extent(renderer)
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1, text.get_text()
    start, end = axes.get_xlim()
    assert start < low and high < end and end - start >= 5.0

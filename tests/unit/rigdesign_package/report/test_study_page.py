"""Pages of studies as Chromium draws them: one input, two, three, samples, names."""

import csv
import random

import numpy as np
import pytest

from rigdesign.base.errors import UsageError
from rigdesign.report.figures.drawing import drawing_style, margin_axis, new_figure
from rigdesign.results.check import Finding
from rigdesign.studies.result import Crossing, PassProbability, SobolIndex, Swing
from tests.builders.browser import browser  # noqa: F401 - a fixture
from tests.builders.study_points import (
    OIL,
    TORQUE,
    WIDTH,
    check_record,
    map_points,
    oil_points,
    point,
    rig_checks,
    written,
)

PHONE = 390


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Folders of studies by name."""
    root = tmp_path_factory.mktemp("studies")
    rng = random.Random(17)
    samples = []
    for number in range(1000):
        oil, torque, width = rng.uniform(60, 180), rng.uniform(100, 260), rng.uniform(6, 8)
        values = {OIL: f"{oil:.6g} degC", TORQUE: f"{torque:.6g} N m", WIDTH: f"{width:.6g} mm"}
        samples.append(point(values, None if number % 97 == 0 else rig_checks(oil, torque)))
    inputs = (OIL, TORQUE, WIDTH)
    found = {
        "swings": [
            Swing(check="clearance.tip", path=path, low="low", high="high", distance_stated=0.2,
                  distance_low=0.2 + 0.1 * number, distance_high=0.2 - 0.2 * number)
            for number, path in enumerate(inputs)
        ],
        "probabilities": [PassProbability(check="clearance.tip", probability=0.42, low=0.4, high=0.44, samples=990)],
        "all_hold": PassProbability(check="all", probability=0.125, low=0.1, high=0.15, samples=990),
        "method": "1000 points of a Latin hypercube",
        "warnings": [Finding(id="study.failed_points", text="11 of 1000 points have no result")],
        "indices": [
            SobolIndex(check="clearance.tip", path=path, first_order=0.3, first_order_interval=(0.2, 0.4), total=0.35,
                       total_interval=(0.25, 0.45))
            for path in inputs
        ],
    }  # fmt: skip
    crossing = Crossing(
        check="clearance.tip", path=OIL, value=118.0, low=117.9, high=118.1, unit="degC", holds="below"
    )
    names = [point({"oil": name}, rig_checks(oil)) for name, oil in (("FVA 3", 90), ("<b>oil</b>", 130))]
    three = [
        point({OIL: f"{oil} degC", TORQUE: f"{torque} N m", WIDTH: f"{width} mm"}, rig_checks(oil, torque))
        for oil in (90, 130)
        for torque in (100, 220)
        for width in (6, 8)
    ]
    return {
        "one": written(
            oil_points((90, 110, 120, 130, 150), failed=(120,)), root / "one", crossings=[crossing]
        ),
        "two": written(
            map_points((90, 110, 130), (100, 160, 220), failed=((130, 220),)), root / "two", "!specimen.root*"
        ),
        "three": written(three, root / "three"),
        "samples": written(samples, root / "samples", design="latin hypercube", **found),
        "names": written([*names, point({"oil": "PAO"})], root / "names"),
        "none": written(oil_points((90, 110), failed=(90, 110)), root / "none"),
    }


@pytest.mark.parametrize("name", ["one", "two", "three", "samples", "names", "none"])
def test_every_page_is_drawn_without_request_or_error_and_fits_a_phone(browser, pages, name):  # noqa: F811
    page = pages[name] / "study.html"
    browser.open(page)
    assert browser.requests() == [] and browser.console() == []
    assert browser.overflow() == 0
    drawn = browser.run(
        "return [...document.querySelectorAll('figure svg')].map(s => [s.clientWidth, s.clientHeight])"
    )
    assert bool(drawn) == (name != "none")
    assert all(min(size) > 100 for size in drawn)
    browser.resize(PHONE)
    assert browser.overflow() == 0
    assert "Example <rig>" in browser.find("h1")[0].text


def test_no_text_of_a_picture_is_cut(browser, pages):  # noqa: F811
    for name in ("one", "two", "three", "samples", "names"):
        browser.open(pages[name] / "study.html")
        cut = browser.run(
            """return [...document.querySelectorAll('figure svg')].flatMap(svg => {
                 const frame = svg.getBoundingClientRect();
                 return [...svg.querySelectorAll('text')].filter(text => {
                   const box = text.getBoundingClientRect();
                   return box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1
                     || box.bottom > frame.bottom + 1;
                 }).map(text => text.textContent);
               })"""
        )
        assert cut == [], name


def test_one_input_says_where_it_passes_and_marks_the_crossing(browser, pages):  # noqa: F811
    browser.open(pages["one"] / "study.html")
    answer = browser.find(".banner")[0].text
    assert "“root stress, ISO 6336-3” fails at every point." in answer
    assert "1 of 5 points has no result." in answer
    main, *groups = browser.find("figure")
    assert "no result" in main.text and "hot tip clearance" in main.text
    assert len(groups) == 2, "clearances and temperatures move, the others do not"
    assert "relax the loop" in browser.find("main")[0].text


def test_a_group_that_the_study_does_not_change_says_so(browser, pages):  # noqa: F811
    for name in ("one", "two"):
        browser.open(pages[name] / "study.html")
        rows = [row.text for row in browser.find("table tbody tr") if row.text.startswith("ramp")]
        assert rows and rows[0].startswith("ramp (not changed by this study) 0 every point"), rows


def test_the_temperature_column_is_there_where_a_point_has_one(browser, pages, tmp_path):  # noqa: F811
    browser.open(pages["one"] / "study.html")
    assert "highest temperature" in browser.find("table.points thead")[0].text
    cold = oil_points((90, 110, 120), failed=(120,))
    for found in cold[:2]:
        found.record["max_temperature_degC"] = None
    browser.open(written(cold, tmp_path) / "study.html")
    assert "highest temperature" not in browser.find("table.points thead")[0].text
    heads = len(browser.find("table.points thead th"))
    assert {
        len(row.find_elements("css selector", "td")) for row in browser.find("table.points tbody tr")
    } == {heads}


def test_a_single_point_of_every_gearbox_reads_as_such(browser, tmp_path):  # noqa: F811
    path = "gearboxes.*.oil.inlet_temperature"
    browser.open(written([point({path: "90 degC"}, rig_checks(90.0))], tmp_path) / "study.html")
    text = browser.find("body")[0].text
    assert "oil inlet temperature of every gearbox" in text and "*" not in text
    assert "1 points" not in text and "passes at every point" not in text
    assert not browser.find("figure")


def test_two_inputs_are_a_map_with_the_range_at_every_value_of_the_second(browser, pages):  # noqa: F811
    browser.open(pages["two"] / "study.html")
    figure = browser.find("figure")[0].text
    for text in ("A contact stress", "B hot tip clearance", "hatched", "computed, passes", "no result"):
        assert text in figure
    rows = [row.text for row in browser.find("table tbody tr")][:3]
    assert rows[0] == "100 N m passes up to 118 °C; the limiting check is “hot tip clearance”"
    assert rows[1].startswith("160 N m passes up to 117 °C")
    assert rows[2].startswith("220 N m fails at every point")


def test_samples_show_probability_tornado_and_indices(browser, pages):  # noqa: F811
    browser.open(pages["samples"] / "study.html")
    headings = [heading.text for heading in browser.find("h2")]
    for heading in (
        "Probability to hold",
        "Each input at its two ends",
        "Share of every input in the scatter",
    ):
        assert heading in headings
    assert len(browser.find("figure")) == 5
    text = browser.find("main")[0].text
    assert "Every check holds in 12.5 % of 990 samples (95 %: 10 … 15 %)." in text
    assert "1000 points of a Latin hypercube" in text and "11 of 1000 points have no result" in text


def test_of_many_inputs_those_that_move_the_margin_are_drawn(browser, tmp_path):  # noqa: F811
    rng = random.Random(3)
    points = []
    for _ in range(60):
        values = {f"input_{n}": rng.uniform(90, 110) for n in range(20)}
        oil = 0.6 * values["input_1"] + values["input_7"] - 50.0
        points.append(point({path: f"{value:.6g} degC" for path, value in values.items()}, rig_checks(oil)))
    browser.open(written(points, tmp_path, design="latin hypercube") / "study.html")
    drawn = [figure.get_attribute("aria-label") for figure in browser.find("figure svg")]
    assert len(drawn) == 8
    assert drawn[0].startswith("Smallest margin over input 7") and drawn[1].startswith(
        "Smallest margin over input 1 "
    )
    assert browser.find("h2")[0].text == "Margins over 20 inputs"
    assert browser.find("table.points tbody td")[0].text == "1"
    assert browser.overflow() == 0


def test_a_thousand_points_are_sorted_and_narrowed(browser, pages):  # noqa: F811
    browser.open(pages["samples"] / "study.html")
    table = "table.points"
    shown = f"return [...document.querySelectorAll('{table} tbody tr')].filter(r => !r.hidden)"
    assert browser.run(shown + ".length") == 1000
    head = browser.find(f"{table} thead button")[0]
    cells = shown + ".map(r => Number(r.cells[0].dataset.sort))"
    browser.run("arguments[0].click()", head)
    ascending = browser.run(cells)
    browser.run("arguments[0].click()", head)
    descending = browser.run(cells)
    assert ascending == sorted(ascending) and descending == sorted(descending, reverse=True)
    assert browser.find(f"{table} thead th")[0].get_attribute("aria-sort") == "descending"
    bar = browser.find(".narrowing")[-1]
    bar.find_element("css selector", "select").send_keys("no result")
    assert browser.run(shown + ".length") == 11
    bar.find_element("css selector", "input").send_keys("no such words")
    assert browser.run(shown + ".length") == 0


def test_without_scripts_the_table_is_whole(pages):
    text = (pages["samples"] / "study.html").read_text(encoding="utf-8")
    before = text.partition("<script>")[0]
    assert before.count("<tr>") > 1000 and "hidden" not in before.partition("table class")[2]


def test_names_are_escaped(pages):
    text = (pages["names"] / "study.html").read_text(encoding="utf-8")
    assert "&lt;b&gt;oil&lt;/b&gt;" in text and "<b>oil</b>" not in text


def test_the_table_of_results_holds_margins_by_group(pages):
    rows = list(csv.DictReader((pages["two"] / "results.csv").read_text(encoding="utf-8").splitlines()))
    warm = next(row for row in rows if row[OIL] == "130 degC" and row[TORQUE] == "100 N m")
    assert warm["clearances: limiting check"] == "clearance.tip"
    assert (
        float(warm["clearances: smallest margin [%]"]) < 0 < float(warm["temperatures: smallest margin [%]"])
    )
    assert warm["specimen: limiting check"] == "specimen.root_stress.pinion", "the table holds all checks"
    failed = next(row for row in rows if row["status"] == "failed")
    assert failed["clearances: limiting check"] == "" and "relax" in failed["error"]


def test_a_pattern_that_matches_nothing_keeps_the_table(tmp_path):
    with pytest.raises(UsageError, match=r"nearest are clearance\.tip; the points are kept in .*study"):
        written(oil_points((90, 110)), tmp_path / "study", "clearence.tip")
    assert [path.name for path in (tmp_path / "study").iterdir()] == ["results.csv"]


@pytest.mark.parametrize("worst", [-40.0, -400.0, -2e4])
def test_no_margin_is_clipped_and_the_limit_keeps_its_room(worst):
    with drawing_style():
        axes = new_figure(4.0).subplots()
        margin_axis(axes, [80.0, 3.0, worst, float("nan")])
    low, high = axes.get_ylim()
    assert low < worst and high > 80.0
    bottom, near, far, top = axes.transData.transform([(0, low), (0, -50.0), (0, 50.0), (0, high)])[:, 1]
    assert (far - near) / (top - bottom) > 0.25
    drawn = axes.transData.transform(np.column_stack([np.zeros(50), np.linspace(worst, 80.0, 50)]))[:, 1]
    assert (np.diff(drawn) > 0).all()


def test_far_margins_of_one_check_leave_the_others_readable(tmp_path):
    checks = [check_record("a.far", 1e6, 1.0, title="far"), check_record("a.near", 0.9, 1.0, title="near")]
    points = [
        point({OIL: f"{oil} degC"}, [*checks, check_record("a.moves", oil, 100.0)]) for oil in (90, 105)
    ]
    page = (written(points, tmp_path) / "study.html").read_text(encoding="utf-8")
    assert "Everything else passes up to 100 °C" in page

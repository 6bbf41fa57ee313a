"""The HTML page: order, escaping, self-containedness, numbers as they read."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise

import matplotlib as mpl
import numpy as np
import pytest
from markupsafe import Markup

from rigdesign.base.part_name import MeshName
from rigdesign.report import numbers, views
from rigdesign.report.figures.drawing import drawing_style, inline_svg, new_figure
from rigdesign.report.figures.dynamics import dynamic_factor_figure, stage_spans
from rigdesign.report.pages.report import environment, report_html, signs, symbol
from rigdesign.results.check import Finding
from rigdesign.results.loads import ModeCrossing
from rigdesign.results.quantity import Records
from rigdesign.results.result import MeshShift
from rigdesign.results.units import RPM
from tests.builders.report import checks, gearbox_field, make_check, make_result

LOOP_CROSSINGS = [
    ModeCrossing(
        kind="mesh", order_of="test", mode=3, shape="test pinion", frequency=4022.7, damping_ratio=0.02, harmonic=k,
        speed=2438.0 / k / RPM, gain=2.0,
    )
    for k in (1, 2)
]  # fmt: skip
VOID = {"meta", "br", "link", "img", "hr", "input"}


class Outline(HTMLParser):
    """Checks that tags nest; collects ids, links and headings."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.targets, self.text = [], [], [], []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)
        found = dict(attrs)
        self.ids += [found["id"]] if "id" in found else []
        self.targets += [found[key] for key in ("href", "src", "xlink:href") if key in found]

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.handle_endtag(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.text.append(data)


@pytest.fixture(scope="module")
def page():
    return report_html(make_result())


def outline(text):
    parser = Outline()
    parser.feed(text)
    parser.close()
    assert parser.open == []
    return parser


def test_page_is_well_formed_with_unique_ids_and_live_references(page):
    parsed = outline(page)
    assert len(parsed.ids) == len(set(parsed.ids))
    inner = [target for target in parsed.targets if not target.startswith("data:image/png;base64,")]
    assert {target[1:] for target in inner} <= set(parsed.ids)
    assert {f"{found}" for found in re.findall(r"url\(#([^)]+)\)", page)} <= set(parsed.ids)


def test_page_needs_nothing_from_elsewhere(page):
    addresses = set(re.findall(r"(?:https?:)?//[\w.]+[^\s\"'<]*", re.sub(r"[A-Za-z0-9+/=]{200,}", "", page)))
    assert addresses <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}
    assert not re.search(r"<(script|link|img|iframe)[^>]*\b(src|href)=", page)
    assert "@import" not in page
    assert "/* " not in page


def test_sections_stand_in_the_order_of_reading(page):
    order = [
        "Checks and margins",
        "Governing checks and reservations",
        "Ramp and loads",
        "Losses and oil",
        "Temperatures",
        "Clearances as drawn and warm",
        "Assumptions behind the verdicts",
        "What is not modelled",
        "Basis of the checks",
        "All assumptions",
        "Dynamics in detail",
        "Losses and oil in detail",
        "Temperatures and heat in detail",
        "Clearances in detail",
        "Hand checks",
        "Warnings",
        "Provenance",
    ]
    positions = [re.search(rf"<h2[^>]*>(?:\d+|[A-Z])&ensp;{title}</h2>", page).start() for title in order]
    assert positions == sorted(positions)


@pytest.mark.parametrize(
    "label",
    [
        "pinion speed n [rpm]",
        "frequency [Hz]",
        "time [s]",
        "torque [N m]",
        "rolling angle φ [°]",
        "radial gap, local [mm]",
        "temperature, steady [°C]",
        "displacement, size [µm]",
        "heat flux, size [kW/m²]",
        "simulated at 180 N m, max / mean",
        "peak-to-peak / mean",
        "0 to peak",
        "iteration [–]",
    ],
)
def test_axes_carry_unit_and_convention(page, label):
    assert label in page


def test_values_reach_the_page(page):
    text = " ".join(outline(page).text)
    for value in (
        "2180 N/mm²",
        "−1230 N/mm²",
        "−129 %",
        "178.6 °C",
        "0.571",
        "29\u202f412",
        "0.6 mm",
        "9c9c9c",
        "1.31",
    ):
        assert value in text, value
    assert "depends on" in text
    assert "no interval without tooth contact" not in text


def test_everything_from_the_case_is_escaped():
    nasty = "<script>alert('x')</script> & $\\frac{1}{0}$ \"q\" 漢"
    base = make_result()
    dynamics = replace(
        base.dynamics,
        gearboxes={nasty: base.dynamics.gearboxes["test"]},
        loop_crossings=Records(replace(item, order_of=nasty, shape=nasty) for item in LOOP_CROSSINGS),
        ramp=replace(
            base.dynamics.ramp, torque={nasty: base.dynamics.ramp.torque["test"]}, stage=[nasty] * 1600
        ),
    )
    result = make_result(
        case={**base.case, "title": nasty, "name": nasty, "path": nasty},
        checks=[make_check("x", 1.0, 0.3, title=nasty, source=nasty, reason=nasty, assumptions=(nasty,))],
        losses=[
            replace(row, place=nasty, kind=nasty, stage=nasty, details={nasty: nasty}) for row in base.losses
        ],
        oil=[replace(row, consumer=nasty, stage=nasty) for row in base.oil],
        thermal=[
            replace(item, gearbox=nasty, stage=nasty, max_temperature_body=nasty) for item in base.thermal
        ],
        expansion=[
            replace(item, gearbox=nasty, seal_gaps=[{**seal, "seal": nasty} for seal in item.seal_gaps])
            for item in base.expansion
        ],
        fields=[replace(item, gearbox=nasty, stage=nasty) for item in base.fields],
        coupling=[replace(item, stage=nasty) for item in base.coupling],
        not_modelled=[nasty],
        warnings=[Finding(id=nasty, text=nasty)],
        dynamics=dynamics,
    )
    page = report_html(result)
    outline(page)
    assert not re.search(r"<(script|link|img|iframe)[^>]*\b(src|href)=", page)
    assert "alert(" in page


@pytest.mark.parametrize(
    "changes",
    [
        {"dynamics": None},
        {"thermal": [], "expansion": [], "fields": [], "coupling": []},
        {"losses": [], "oil": [], "cooler": [], "dynamics": None},
        {
            "checks": [],
            "assumptions": [],
            "warnings": [],
            "not_modelled": [],
            "hand_checks": [],
            "dynamics": None,
        },
        {"checks": [check for check in checks() if check.verdict == "not applicable"], "dynamics": None},
    ],
)
def test_a_result_without_a_part_still_has_its_page(changes):
    outline(report_html(make_result(**changes)))


def test_a_page_prints_names_of_parts_and_keeps_its_own_marks():
    template = environment().from_string("{{ name }} {{ sign }}")
    assert (
        template.render(name=MeshName("test", "a<b"), sign=Markup("<sub>1</sub>"))
        == "test.a&lt;b <sub>1</sub>"
    )


def test_gearbox_without_curves_still_has_its_page():
    base = make_result().dynamics
    bare = replace(
        base.gearboxes["test"],
        dynamic_factor=[],
        dynamic_factor_at={},
        stage_loads=[],
        unsolved=[],
        root_stress=[],
        root_stress_factor=[],
        resonances=[],
        lift_off=[],
        iso_factors={},
    )
    dynamics = replace(base, gearboxes={"test": bare}, ramp=None)
    page = report_html(make_result(dynamics=dynamics, fields=[]))
    assert "no interval without tooth contact for longer than 5 % of a mesh period" in page
    assert "no stage turns under torque" in page
    assert "No time run over the schedule" in page


def test_no_line_is_drawn_over_a_speed_without_solution():
    """The curve at 90 N m has a hole at 1800 rpm: its line breaks there, that of the test torque does not."""
    figure = dynamic_factor_figure(make_result().dynamics)
    lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
    broken = next(line for label, line in lines.items() if label.startswith("simulated at 90 N m"))
    whole = lines["simulated at 180 N m, max / mean"]
    hole = np.isnan(np.asarray(broken.get_ydata(), dtype=float))
    assert np.asarray(broken.get_xdata())[hole].tolist() == [1800.0]
    assert not np.isnan(np.asarray(whole.get_ydata(), dtype=float)).any()


def test_checks_are_ordered_failing_first_then_by_distance():
    ordered = views.sorted_checks(checks())
    assert [check.id for check in ordered[:3]] == ["root_stress_window", "start_torque", "axial_play"]
    assert ordered[-1].verdict == "not applicable"


def test_a_check_says_in_the_table_what_its_value_leaves_out():
    result = make_result()
    first = replace(
        result.checks[0], verdict="open", left_out=("walls of gearbox reference: it has no housing",)
    )
    page = report_html(replace(result, checks=[first, *result.checks[1:]]))
    assert "leaves out walls of gearbox reference: it has no housing" in page


def test_mesh_errors_stand_by_their_share_of_the_margin():
    given = [
        make_check("clearance.seal_gap", 0.5, 0.3, comparison=">=", error=0.02),
        make_check("oil.room", 1.0, 3.0),
        make_check("temperature.housing", 99.0, 100.0, unit="degC", error=0.5),
    ]
    shift = MeshShift(id="temperature.housing", standard=98.8, reference=99.0, shift=0.2, unit="degC")
    result = replace(make_result(), checks=given, reference_shift=[shift])
    rows = views.mesh_errors(result)
    assert [row["check"] for row in rows] == ["temperature.housing", "clearance.seal gap"]
    assert [row["error_over_margin"] for row in rows] == pytest.approx([0.5, 0.1])
    assert rows[0]["shift_on_fine_mesh"] == 0.2
    assert "Discretisation errors" in report_html(result)


def test_drivers_name_the_assumptions_a_check_rests_on():
    drivers = {check.id: records for check, records in views.drivers(make_result())}
    seal = next(check for check in checks() if check.id == "seal_gap_minimum")
    assert views.specific(make_result(), seal)[0].value == "0.6 mm"
    assert drivers["root_stress_window"][0].path == "gearboxes.test.gears.pinion.material"
    assert len(drivers) == views.MAX_DRIVERS
    assert "load_cycles" not in drivers
    many = make_result(checks=[make_check(f"c{n}", 1.0, 0.3) for n in range(9)])
    assert len(views.drivers(many)) == 9


def test_loss_table_adds_places_and_keeps_holes():
    base = make_result().losses[0]
    rows = [
        replace(base, place="a", stage="x", power=1.0),
        replace(base, place="a", stage="x", power=2.0),
        replace(base, place="b", stage="y", power=4.0),
    ]
    assert views.loss_table(rows) == (["x", "y"], [("a", [3.0, None]), ("b", [None, 4.0])])
    assert views.main_stage(make_result(losses=rows)) == "y"


def test_crossing_table_has_a_column_per_harmonic():
    harmonics, lines = views.crossing_table(LOOP_CROSSINGS, ("order_of", "mode"))
    assert harmonics == [1, 2]
    assert lines == [(["test", 3], [pytest.approx(2438.0), pytest.approx(1219.0)])]


def test_bars_end_at_their_limit():
    assert views.bar_width(0.25) == pytest.approx(50.0)
    assert views.bar_width(-6.0) == 100.0
    assert views.bar_width(2.0) == 0.0


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (1234.5, "1234"),
        (12345.6, "12\u202f350"),
        (-0.05, "−0.05"),
        (2.1e9, "2.1 × 10⁹"),
        (3.1e-11, "3.1 × 10⁻¹¹"),
        (0.571234, "0.5712"),
        (None, "–"),
        (999940.0, "999\u202f900"),
        (9999999, "9\u202f999\u202f999"),
        (3153000.0, "3.153 × 10⁶"),
        (29412, "29\u202f412"),
        (-1e-5, "−1 × 10⁻⁵"),
    ],
)
def test_numbers_as_they_read(value, text):
    assert numbers.number_text(value) == text


@pytest.mark.parametrize(
    ("key", "text"),
    [
        ("torque_cold_Nm", "torque as drawn [N m]"),
        ("angle_of_min_deg", "angle of min [°]"),
        ("share", "share"),
        ("diametral_clearance_hot_um", "diametral clearance warm [µm]"),
        ("flow_l_min", "flow [l/min]"),
        ("mode", "mode"),
    ],
)
def test_headings_split_the_unit_off(key, text):
    assert numbers.heading_text(key) == text


def test_limits_and_margins():
    by_id = {check.id: check for check in checks()}
    assert numbers.limit_text(by_id["seal_gap_minimum"]) == "≥ 0.3 mm"
    assert numbers.limit_text(by_id["load_cycles"]) == "1 × 10⁹ … 1 × 10¹⁰"
    assert numbers.limit_text(by_id["bought_part_coupling"]) == "–"
    assert numbers.margin_text(by_id["bearing_film"]) == "9 K"


def test_cells_of_records():
    assert numbers.cell_text({"wall_K": 393.15, "ok": True}) == "wall [K] 393.1, ok yes"
    assert numbers.cell_text(None) == "–"


def test_symbols_carry_an_index():
    assert symbol("c_gamma_alpha") == "c<sub>γα</sub>"
    assert symbol("range") == "range"
    assert symbol("<b>_x") == "&lt;b&gt; x"
    assert signs("Y_deltarelT 1.02, Y_RrelT 0.9") == "Y<sub>δ rel T</sub> 1.02, Y<sub>R rel T</sub> 0.9"
    assert signs("K_V of <i> at f_z, run_up") == "K<sub>V</sub> of &lt;i&gt; at f<sub>z</sub>, run_up"


def test_stages_of_the_ramp_touch():
    ramp = make_result().dynamics.ramp
    spans = stage_spans(ramp)
    assert [name for name, _, _ in spans] == [
        "bracing",
        "to bearing speed",
        "half torque",
        "run-up",
        "full torque",
        "dwell",
        "ramp-down",
    ]
    assert spans[0][1] == 0.0
    assert spans[-1][2] == ramp.time_s[-1]
    assert all(before[2] == after[1] for before, after in pairwise(spans))


def test_drawing_leaves_matplotlib_as_it_was():
    with mpl.rc_context({"font.size": 23.0}):
        with drawing_style():
            assert mpl.rcParams["font.size"] == 8.5
        assert mpl.rcParams["font.size"] == 23.0


def test_users_settings_do_not_change_the_figures(page):
    with mpl.rc_context({"font.size": 23.0, "axes.grid": False, "savefig.dpi": 30}):
        assert report_html(make_result()) == page


def test_svg_has_no_date_and_prefixed_ids():
    with drawing_style():
        figure = new_figure(2.0)
        figure.subplots().plot([0, 1], "o")
        svg = inline_svg(figure, "f9", 'a "quoted" <text>')
    assert "metadata" not in svg
    assert 'aria-label="a &quot;quoted&quot; &lt;text&gt;"' in svg
    assert all(name.startswith("f9-") for name in re.findall(r' id="([^"]*)"', svg))


def test_uniform_temperature_still_has_a_picture():
    field = gearbox_field()
    flat = replace(field, temperature=np.full_like(field.temperature, 300.0))
    outline(report_html(make_result(fields=[flat], dynamics=None)))

"""The first page in words and in a drawing: why, what would turn it, the rig, who signs."""

from dataclasses import replace
from datetime import date

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from rigdesign.case import load_case
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.provenance import InputRow
from rigdesign.report import reasons
from rigdesign.report import reasons as flips
from rigdesign.report.figures.drawing import drawing_style
from rigdesign.report.figures.schematic import phone_schematic_figure, rig_plan, schematic_figure
from rigdesign.report.input_sheets import (
    CaseSheet,
    Issue,
    assumption_groups,
    bearing_sheet,
    gear_sheets,
    governing_ids,
    in_braces,
    joint_sheet,
    material_sheet,
    most_influential,
    oil_sheet,
    shaft_sheet,
    signatures,
)
from rigdesign.report.pages.report import css_string, report_html
from rigdesign.results.check import Checks
from rigdesign.results.result import Flip
from tests.builders.paths import CASES
from tests.builders.report import make_check, make_result
from tests.builders.report_inputs import rig_inputs
from tests.builders.report_ranges import ranges


def prototype_inputs(file):
    """Inputs of the shipped prototype, or of a variant of it."""
    return load_case(CASES / "uhcf_prototype" / file).inputs


def two_methods(iso, path, **more):
    """Root stress checks of the test pinion against 700 to 1100 N/mm2."""
    return [
        make_check(
            f"specimen.root_stress_{method}.test.pinion", value, 1100.0, unit="MPa", role="specimen", group="specimen",
            title=f"root stress of specimen test pinion, {words}", **more,
        )
        for method, words, value in (("iso", "ISO 6336-3", iso), ("path", "over the path", path))
    ]  # fmt: skip


def with_geometry(result):
    """The dynamics of the builder with the gear data of a real run."""
    test = result.dynamics.gearboxes["test"]
    geometry = {"teeth": "99 / 102", "transverse_contact_ratio": 1.26}
    gearboxes = result.dynamics.gearboxes | {"test": replace(test, geometry=geometry)}
    return replace(result, dynamics=replace(result.dynamics, gearboxes=gearboxes))


def test_two_root_stresses_are_told_apart_with_their_reason():
    why = reasons.why(with_geometry(make_result(checks=two_methods(2033.0, 1140.0))))
    first, second = why.sentences
    assert "2033 N/mm² by ISO 6336-3 (fail) and 1140 N/mm² over the path of contact (fail)" in first
    assert "≤ 1100 N/mm²" in first
    assert "1.8 times the other" in second
    assert "(contact ratio 1.26)" in second
    assert "share the force over 2.5 pitches" in second
    assert "influence numbers" in why.decided_by
    assert "strain gauges in the root fillet of test pinion" in why.decided_by


def by_field(result):
    """The same with root stress from influence numbers."""
    test = result.dynamics.gearboxes["test"]
    histories = [replace(history, source="finite-element influence numbers") for history in test.root_stress]
    gearboxes = result.dynamics.gearboxes | {"test": replace(test, root_stress=histories)}
    return replace(result, dynamics=replace(result.dynamics, gearboxes=gearboxes))


def test_a_computed_field_governs_and_the_standard_is_a_hand_check():
    result = by_field(with_geometry(make_result(checks=two_methods(2033.0, 1140.0))))
    why = reasons.why(result)
    assert "1140 N/mm² by the computed field, which governs (fail)" in why.sentences[0]
    assert "2033 N/mm² by ISO 6336-3 as a hand check" in why.sentences[0]
    assert why.decided_by == "Strain gauges in the root fillet of test pinion."
    assert why.root_stress == ""


def test_a_sheet_without_a_failing_root_says_which_stress_governs():
    held = make_result(checks=two_methods(1050.0, 900.0))
    said = reasons.why(by_field(held)).root_stress
    assert "the computed field governs with 900 N/mm²" in said and "1050 N/mm² as a hand check" in said
    assert "K_A" not in said
    raised = by_field(held)
    test = raised.dynamics.gearboxes["test"]
    raised.dynamics.gearboxes["test"] = replace(test, iso_factors=test.iso_factors | {"K_A": 1.25})
    assert "force of every tooth times K_A 1.25; ISO" in reasons.why(raised).root_stress
    said = reasons.why(held).root_stress
    assert "both count" in said and "900 N/mm²" in said and "1050 N/mm²" in said
    assert reasons.why(make_result(checks=[make_check("oil.room", 1.0, 3.0)])).root_stress == ""


def test_one_of_two_methods_failing_is_enough_and_others_are_counted():
    given = [*two_methods(2033.0, 900.0), make_check("oil.room", 4.0, 3.0)]
    first = reasons.why(make_result(checks=given)).sentences[0]
    assert "over the path of contact (pass)" in first
    assert first.endswith("; fails as well: oil.room (4 mm against ≤ 3 mm).")


def test_methods_that_agree_are_not_set_against_each_other():
    why = reasons.why(make_result(checks=two_methods(1205.0, 1200.0)))
    assert "agree within 0 %" in why.sentences[1]
    assert why.decided_by == ""


def test_a_path_above_the_standard_has_its_own_reason():
    assert (
        "times that of ISO 6336-3"
        in reasons.why(make_result(checks=two_methods(1200.0, 2400.0))).sentences[1]
    )


def test_any_other_failing_check_says_what_it_is_and_what_would_decide_it():
    check = make_check(
        "oil.room", 4.0, 3.0, unit="kW", title="heat to the room", reason="stage test; leaves out b"
    )
    why = reasons.why(make_result(checks=[replace(check, left_out=("b",), assumptions=("x", "y"))]))
    assert why.sentences == (
        "Heat to the room: 4 kW against ≤ 3 kW, missed by 33.3 %.",
        "Stage test.",
    )
    assert "the 2 assumed inputs it depends on" in why.decided_by
    stated = replace(check, by_definition=True)
    assert "states value and limit" in reasons.why(make_result(checks=[stated])).decided_by


def test_reservations_and_a_clean_pass_name_the_nearest_check():
    warned = replace(make_check("a", 0.5, 1.0, verdict="open"), left_out=("the room",))
    near = make_check("b", 0.99, 1.0)
    why = reasons.why(make_result(checks=[warned, near]))
    assert why.sentences[0] == (
        "No limit that binds is missed; 1 of 2 checks are open: 1 leaving out a known contributor."
    )
    assert "Nearest to its limit is b" in why.sentences[1]
    assert "the room" in why.decided_by
    commanded = replace(make_check("c", 1.0, 1.0), by_definition=True)
    assert reasons.why(make_result(checks=[near, commanded])).sentences == (
        "All 2 checks that apply hold.", "Nearest to its limit is b: 0.99 mm against ≤ 1 mm, 1 % of it left.",
    )  # fmt: skip
    assert "No check applies" in reasons.why(make_result(checks=[])).sentences[0]


def test_inputs_that_turn_the_verdict_come_from_the_ranges():
    first, second, third = flips.from_ranges(ranges())
    assert (first.path, first.check, first.needed, first.turns) == ("torque", "x", "160 N m", True)
    assert first.effect == "holds from about 160 N m"
    assert (second.check, second.turns) == ("y", False)
    assert second.effect == "still fails at 40 µm, margin −0.5 mm"
    assert third.effect == "fails from about 50 µm"


def test_a_run_that_cannot_tell_says_how_to_find_out():
    plain = make_result(inputs=rig_inputs())
    assert "--ranges" in report_html(plain)
    page = report_html(replace(plain, ranges=ranges()))
    assert "holds from about 160 N m" in page
    assert "looks at the assumed inputs" not in page


def test_inputs_the_run_has_found_stand_before_those_of_the_ranges():
    found = Flip(
        path="schedule.test_torque", title="test torque", stated="180 N m", needed="99 N m", check="x", holds=False,
        turns=True, effect="root stress holds",
    )  # fmt: skip
    page = report_html(make_result(inputs=rig_inputs(), flips=[found], ranges=ranges()))
    first = page[page.index("Inputs that would turn a failing check") : page.index("The rig")]
    assert "<td>test torque</td>" in first
    assert "99 N m" in first and "root stress holds" in first
    assert "Within their ranges, assumed inputs turn" in first


@pytest.mark.parametrize(
    ("stated", "end", "share", "text"),
    [
        ("140 degC", "90 degC", 0.5, "115 °C"),
        ("0", "1", 0.25, "0.25"),
        ("perfect", "loose", 0.5, ""),
        ("1 mm", "2 um", 0.5, ""),
    ],
)
def test_values_between_two_ends(stated, end, share, text):
    assert flips.between(stated, end, share) == text


def test_coupled_shafts_lie_on_one_level_and_mates_next_to_each_other():
    plan = rig_plan(CaseSheet.of(rig_inputs()))
    assert plan.level_of["p1"] == plan.level_of["p2"]
    assert plan.level_of["w1"] == plan.level_of["w2"]
    assert abs(plan.level_of["p1"] - plan.level_of["w1"]) == 1
    assert plan.column_of == {"p1": 0, "w1": 0, "p2": 1, "w2": 1}
    assert plan.levels == 2


def test_idler_between_two_wheels_is_in_the_middle():
    gears = {name: {"shaft": name, "teeth": 20} for name in ("pinion", "a", "b")}
    meshes = {"a": {"pinion": "pinion", "wheel": "a"}, "b": {"pinion": "pinion", "wheel": "b"}}
    from rigdesign.case.provenance import input_rows

    plan = rig_plan(
        CaseSheet.of(list(input_rows({"gearboxes": {"one": {"gears": gears, "meshes": meshes}}})))
    )
    assert sorted(plan.level_of.values()) == [0, 1, 2]
    assert plan.level_of["pinion"] == 1


def test_schematic_names_what_the_rig_is_made_of():
    with drawing_style():
        figure = schematic_figure(CaseSheet.of(rig_inputs()))
        assert schematic_figure(CaseSheet({})) is None
    texts = "\n".join(text.get_text() for text in figure.axes[0].texts)
    for words in (
        "test gearbox (specimen)", "reference (rig)", "coupling upper", "motor", "≤ 20 N m", "shifted",
        "pinion, z = 99", "gear oil MIL-PRF-23699: 140 °C, 5 l/min", "180 N m at 12000 rpm",
        "load unit shifts it axially",
    ):  # fmt: skip
        assert words in texts, words


@pytest.mark.parametrize(
    ("bracing", "words"),
    [
        (
            {"mode": "torque_controlled", "coupling": "pinion_side"},
            "Bracing: coupling pinion_side: twisted, torque controlled.",
        ),
        ({"mode": "twist_held", "coupling": "upper"}, "Bracing: coupling upper: twisted and held."),
        (
            {"mode": "shift_held", "shifted_gear": "test.pinion"},
            "Bracing: test.pinion: shifted axially and held.",
        ),
        (
            {"mode": "torque_controlled", "shifted_gear": "test.pinion"},
            "Bracing: test.pinion: load unit shifts it axially, torque controlled.",
        ),
    ],
)
def test_the_schematic_says_which_part_braces_the_loop_and_how(bracing, words):
    others = [row for row in rig_inputs() if not row.path.startswith("drivetrain.bracing.")]
    own = [InputRow(path=f"drivetrain.bracing.{key}", value=value) for key, value in bracing.items()]
    with drawing_style():
        figure = schematic_figure(CaseSheet.of([*others, *own]))
    texts = " ".join(" ".join(text.get_text().split()) for text in figure.axes[0].texts)
    assert words in texts


def test_no_words_of_the_schematic_of_a_phone_meet():
    with drawing_style():
        figure = phone_schematic_figure(CaseSheet.of(rig_inputs()))
    texts = [text for text in figure.axes[0].texts if text.get_text()]
    renderer = FigureCanvasAgg(figure).get_renderer()
    boxes = [text.get_window_extent(renderer) for text in texts]
    meeting = [
        (texts[i].get_text(), texts[j].get_text())
        for i in range(len(texts))
        for j in range(i)
        if boxes[i].overlaps(boxes[j])
    ]
    assert meeting == []
    frame = figure.bbox
    assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 and box.y1 <= frame.y1 for box in boxes)


def test_data_sheets_echo_the_case():
    result = make_result(inputs=rig_inputs())
    test = gear_sheets(result)[0]
    rows = dict(test.rows)
    assert test.title == "Gear pair test"
    assert rows["number of teeth z"] == ["99", "102"]
    assert rows["face width b"] == ["7 mm", "15 mm"]
    oil = oil_sheet(result)
    cells = dict(oil.rows)
    assert oil.columns == ["test: gear oil", "reference: gear oil"]
    assert cells["kinematic viscosity at 40 °C"] == ["27.6 mm²/s", "32 mm²/s"]
    assert cells["kinematic viscosity at 100 °C"][1] == "5.4 mm²/s"
    assert cells["density there"][1] == "856 kg/m³"
    assert dict(material_sheet(result).rows)["elastic modulus"] == ["206 GPa"]
    assert shaft_sheet(result).rows == [
        ("p1", ["200 mm", "40, 41.92 mm", "flange 0.0002 kg m²", "case hardened steel"])
    ]
    joints = dict(joint_sheet(result).rows)
    assert joints["gear test.pinion"][3] == "0.0005016 kg m²"
    assert joints["coupling upper"][1] == "138\u202f000 N m/rad"
    assert joints["coupling upper"][4] == "–"


def test_data_sheets_show_what_bends():
    """Masses of discs, lateral stiffness of couplings; bearings where the case states a spring of them."""
    result = make_result(inputs=prototype_inputs("table_1_bearings.toml"))
    assert dict(shaft_sheet(result).rows)["test pinion"][2] == "coupling flange 0.000191 kg m², 0.312 kg"
    joints = dict(joint_sheet(result).rows)
    assert joints["coupling pinion side"][4] == "250\u202f000 N/m, 1400 N m/rad"
    assert dict(bearing_sheet(result).rows)["test.pinion_rear"] == [
        "test pinion", "1 × 10⁸ N/m, 40\u202f000 N s/m", "–", "–"
    ]  # fmt: skip
    assert bearing_sheet(make_result(inputs=prototype_inputs("case.toml"))) is None


def test_the_sheet_of_joints_shows_the_loss_factor_of_a_spline():
    rows = rig_inputs()
    path = "gearboxes.test.gears.pinion.spline.torsional_stiffness"
    stated = next(row for row in rows if row.path == path)
    friction = replace(stated, path=path.replace("torsional_stiffness", "loss_factor"), value="0.05")
    joints = dict(joint_sheet(make_result(inputs=[*rows, friction])).rows)
    assert joints["gear test.pinion"][2] == "loss factor 0.05"
    assert joints["gear test.wheel"][2] == "–"


def test_the_gear_sheet_has_the_computed_sizes_drawn_and_warm():
    base = make_result(inputs=rig_inputs())
    geometry = {
        "profile_shifts": "0.0000 / -0.9610", "tip_diameters_cold_mm": "101.000 / 100.667",
        "tip_diameters_hot_mm": "101.163 / 100.820", "centre_distance_hot_mm": 99.550092,
        "transverse_contact_ratio": 1.26, "transverse_contact_ratio_hot": 1.327,
    }  # fmt: skip
    test = replace(base.dynamics.gearboxes["test"], geometry=geometry)
    result = replace(base, dynamics=replace(base.dynamics, gearboxes={"test": test}))
    rows = dict(gear_sheets(result)[0].rows)
    assert rows["profile shift coefficient x"] == ["0", "−0.961"]
    assert rows["tip diameter dₐ, drawn / warm"] == ["101.000 / 101.163 mm", "100.667 / 100.820 mm"]
    assert rows["centre distance a, drawn / warm"] == ["99.5 / 99.550 mm"]
    assert rows["contact ratio ε_α, drawn / warm"] == ["1.26 / 1.327"]


def test_equal_gear_pairs_share_a_sheet():
    from rigdesign.case.provenance import input_rows

    gears = {name: {"shaft": name, "teeth": 45} for name in ("pinion", "a", "b")}
    meshes = {key: {"pinion": "pinion", "wheel": key, "normal_module": "5 mm"} for key in ("a", "b")}
    rows = list(input_rows({"gearboxes": {"one": {"gears": gears, "meshes": meshes}}}))
    (sheet,) = gear_sheets(make_result(inputs=rows, dynamics=None))
    assert sheet.title == "Gear pair one.a, one.b"
    assert sheet.columns == ["pinion", "a, b"]


def test_the_date_stands_in_one_place_and_nothing_else_depends_on_it():
    result = make_result(inputs=rig_inputs())
    first, second = (report_html(result, Issue(date=date(2026, 1, day))) for day in (2, 3))
    assert first != second
    assert first.count("2026-01-02") == 2
    old = '<time id="issued" datetime="2026-01-02">2026-01-02</time>'
    assert first.replace(old, old.replace("2026-01-02", "2026-01-03")) == second


def test_signatures_come_from_the_case_unless_the_command_names_an_author():
    result = make_result(inputs=rig_inputs())
    stated = signatures(result, Issue())
    assert (stated.prepared, stated.project, stated.number, stated.approved) == (
        "A. Engineer",
        "P 17",
        "D-1",
        "",
    )
    assert signatures(result, Issue(author="B. Other")).prepared == "B. Other"
    assert "Project P 17, document D-1" in report_html(result)


def test_running_title_cannot_leave_its_style_sheet():
    assert css_string("a</style>") == '"a\\00003c\\00002fstyle\\00003e"'


def _assumed(path, **more):
    return AssumptionRecord(path=path, value="1 mm", reason=f"as built {path.rpartition('.')[2]}", **more)


def test_assumptions_of_like_parts_share_a_line_and_stand_by_name_where_no_range_was_evaluated():
    """However many checks depend on an input: that says nothing of what it does to them."""
    paths = ("gearboxes.test.bearings.rear.width", "gearboxes.test.bearings.front.width", "losses.share")
    records = [_assumed(path, decides=("a", "b") if path == "losses.share" else ()) for path in paths]
    result = make_result(assumptions=records)
    groups = assumption_groups(result)
    assert list(groups) == ["losses", "test: bearings"]
    (line,) = groups["test: bearings"]
    assert (line.path, line.count, line.moved) == ("{rear,front}.width", 2, None)
    assert most_influential(result, 5) == []
    page = " ".join(report_html(result).split())
    assert "Sorted by name: which of them moves the governing margins most is not known" in page
    assert "rigdesign check uhcf_prototype --ranges works it out" in page and "near limit</th>" not in page


def test_assumptions_are_ranked_by_what_their_ranges_do_to_the_governing_margins():
    """x fails and governs: torque moves it by 0.4; gap moves z alone, which holds, and by more."""
    found = ranges()
    moving = [replace(row, distance_high=-1.0) if row.check == "z" else row for row in found.margins]
    found = replace(found, margins=[row for row in moving if row.check != "y"])
    checks = [make_check("x", 2.0, 1.0), make_check("z", 0.5, 1.0)]
    records = [
        _assumed("gap", range=("40 um", "80 um")),
        _assumed("torque", range=("1", "2")),
        _assumed("other"),
    ]
    result = make_result(assumptions=records, ranges=found, checks=Checks(checks))
    assert governing_ids(result.checks) == {"x"}
    lines = most_influential(result, 5)
    assert [(line.path, line.moved) for line in lines] == [("torque", pytest.approx(0.4))]
    listed = [line for group in assumption_groups(result).values() for line in group]
    assert [line.path for line in listed] == ["torque", "gap", "other"]
    assert "Sorted by how far an input moves the distance to the limit of a governing check" in report_html(
        result
    )
    holds = Checks([make_check("x", 0.5, 1.0), make_check("z", 0.6, 1.0)])
    assert governing_ids(holds) == {"z"}


def test_like_paths_stand_in_braces():
    assert in_braces(["a.x.k", "a.y.k"]) == "a.{x,y}.k"

"""Designs of a study: samples, ranges, boundaries, tornado, and what is refused."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import qmc

from rigdesign.base.errors import CaseError, NotConvergedError, UsageError
from rigdesign.case import load_case
from rigdesign.studies import ledger
from rigdesign.studies.design import StudyDesign, planned
from rigdesign.studies.grid import Sample, parse_ranges, parse_sample, saltelli_points, unit_points
from tests.builders.commands import PROTOTYPE
from tests.builders.study import InProcess, run_study
from tests.builders.study_functions import CURVES, NumberCase, curves, result_of


@pytest.fixture(scope="module", autouse=True)
def _points_that_need_not_outlive_the_power():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ledger, "SYNCHRONOUS", "OFF")
        yield


TWO = NumberCase({"a": "1 mm", "b": "2", "n": "4", "t": "80 degC"}, whole=("n",))


def quiet(study, out):
    """In place of the page."""


def found(case, tmp_path, *, run=curves, **design):
    return run_study(case, StudyDesign(**design), tmp_path, write=quiet, run=run, executor=InProcess()).result


# ---------------------------------------------------------------------------- samples


@pytest.mark.parametrize("size", [7, 64])
def test_a_latin_hypercube_has_one_point_in_every_layer_of_every_input(size):
    points = unit_points(Sample("lhs", size), 3, seed=5)
    for column in points.T:
        assert sorted((column * size).astype(int)) == list(range(size))


def test_the_values_of_a_latin_hypercube_keep_their_layers_after_rounding():
    plan = planned(TWO, StudyDesign(vary=("a=10:20 mm", "b=0:1"), sample="lhs:50"))
    values = np.array([[float(text.split()[0]) for text in point.values.values()] for point in plan.points])
    assert sorted(((values[:, 0] - 10) * 5).astype(int)) == list(range(50))
    assert {point.values["a"].split()[1] for point in plan.points} == {"mm"}


def test_a_sobol_sequence_is_spread_more_evenly_than_chance():
    points = unit_points(Sample("sobol", 256), 4, seed=0)
    random = np.random.default_rng(0).random((256, 4))
    assert qmc.discrepancy(points) < 0.2 * qmc.discrepancy(random)


def test_the_seed_makes_the_sample_and_the_same_seed_the_same_texts():
    def texts(seed):
        design = StudyDesign(vary=("a=10:20 mm",), sample="lhs:8", seed=seed)
        return [point.values["a"] for point in planned(TWO, design).points]

    assert texts(0) == texts(0) and set(texts(0)).isdisjoint(texts(1))
    assert all(len(re.sub(r"[^0-9]", "", text).lstrip("0")) <= 6 for text in texts(0))


def test_the_pages_of_the_design_of_indices_differ_in_one_input_each():
    first, second, *mixed = np.split(saltelli_points(16, 3, seed=2), 5)
    assert not np.isclose(first, second).any()
    for number, page in enumerate(mixed):
        assert np.array_equal(page[:, number], second[:, number])
        others = [column for column in range(3) if column != number]
        assert np.array_equal(page[:, others], first[:, others])


def test_a_whole_number_takes_every_value_of_its_range_as_often():
    plan = planned(TWO, StudyDesign(vary=("n=4:7",), sample="lhs:40"))
    values = [point.values["n"] for point in plan.points]
    assert {value: values.count(value) for value in values} == dict.fromkeys("4567", 10)
    assert plan.variations[0].distribution == "uniform over the whole numbers"


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("lhs", "write --sample lhs:200"),
        ("halton:8", "no such design"),
        ("lhs:1", "2 to 100000"),
        ("lhs:100001", "2 to 100000"),
        ("sobol:100", "sobol:64 or sobol:128"),
    ],
)
def test_samples_that_are_refused(text, named):
    with pytest.raises(UsageError, match=named):
        parse_sample(text)


# ---------------------------------------------------------------------------- ranges


@pytest.mark.parametrize(
    ("text", "ends", "unit"),
    [
        ("a=1 mm:2 mm", (1, 2), "mm"), ("a=1:2 mm", (1, 2), "mm"), ("b=-1:1e1", (-1, 10), ""),
        ("t = 80 degC : 120 degC", (80, 120), "degC"),
    ],
)  # fmt: skip
def test_range_forms(text, ends, unit):
    (entry,) = parse_ranges(TWO, [text])
    assert ((entry.low, entry.high), entry.unit) == (ends, unit)


@pytest.mark.parametrize(
    ("texts", "named"),
    [
        (["a"], "a range is missing"),
        (["=1:2"], "a path is missing"),
        (["a=1:2:0.5"], "leave the step out"),
        (["a=1,2"], "no range of two numbers"),
        (["a=2:1 mm"], "LOW 2 is not below HIGH 1"),
        (["a=1 mm:2 cm"], "units mm and cm"),
        (["a=1 mm:2"], "units mm and none"),
        (["n=1.5:3"], "whole numbers"),
        (["a=1:2 mm", "a=2:3 mm"], "stands twice"),
        ([], "varies nothing"),
        (["assumed"], "states no assumed input with a range"),
        (["oil.name=1:5"], "--vary 'oil.name=v1,v2'"),
        (["oil.name=FVA 3,FVA 4"], "--vary 'oil.name=v1,v2'"),
    ],
)
def test_ranges_that_are_refused(texts, named):
    case = replace(TWO, values={**TWO.values, "oil.name": "FVA 3"}, names=("oil.name",))
    with pytest.raises(UsageError, match=re.escape(named)):
        parse_ranges(case, texts)


@pytest.mark.parametrize("design", [{"sample": "lhs:4"}, {"tornado": True}, {"boundary": True}, {}])
@pytest.mark.parametrize(
    "path", ["gearboxes.test.oil.oil", "losses.friction.law", "gearboxes.test.bearings.*.locating"]
)
def test_numbers_for_a_name_of_a_real_case_are_refused_with_what_to_write(path, design):
    text = f"{path}=1:5" if design else f"{path}=1:5:1"
    with pytest.raises(
        UsageError, match=f"has no range; list its values in a grid: --vary '{re.escape(path)}=v1,v2'"
    ):
        planned(load_case(PROTOTYPE), StudyDesign(vary=(text,), **design))


def test_a_range_of_a_path_that_does_not_exist_names_the_nearest():
    with pytest.raises(CaseError, match=r"gearboxes\.test\.oil\.inlet_temperature"):
        planned(
            load_case(PROTOTYPE),
            StudyDesign(vary=("gearboxes.test.oil.inlet_temprature=90:140 degC",), sample="lhs:4"),
        )


def test_every_assumed_range_of_a_real_case_is_varied_within_its_ends():
    """Whole numbers stay whole, bearings of one shaft stay alike, a written range goes before the assumed one."""
    case = load_case(PROTOTYPE)
    stated = {record.path: record.range for record in case.assumptions if record.range is not None}
    ranges = parse_ranges(case, ["assumed"])
    moved = [path for entry in ranges for path in (entry.path, *entry.together_with)]
    assert sorted(moved) == sorted(stated) and len(moved) > 20
    assert any(entry.together_with for entry in ranges)
    plan = planned(case, StudyDesign(vary=("assumed",), sample="lhs:3"))
    for point in plan.points:
        case.with_values(point.changes)
    assert sorted(plan.points[0].changes) == sorted(stated)
    first = ranges[0]
    other = f"{first.path}={first.text(first.low)}:{first.text(first.low + 0.5 * first.width)}"
    chosen = {entry.path: entry for entry in parse_ranges(case, ["assumed", other])}
    assert len(chosen) == len(ranges) and chosen[first.path].high < first.high


@pytest.mark.parametrize(
    ("design", "named"),
    [
        ({"sample": "lhs:8", "tornado": True}, "--sample and --tornado"),
        ({"indices": True}, "add --sample sobol:256"),
        ({"indices": True, "sample": "lhs:8"}, "add --sample sobol:256"),
        ({"tolerance": "1 K"}, "add --boundary"),
        ({"seed": -1}, "--seed -1"),
    ],
)
def test_options_that_contradict_each_other(design, named):
    with pytest.raises(UsageError, match=named):
        StudyDesign(vary=("a=1:2 mm",), **design)


@pytest.mark.parametrize(
    ("design", "named"),
    [
        ({"vary": ("assumed",)}, "of which a grid is not made"),
        ({"vary": ("a=1:2 mm",)}, "add --sample lhs:200, --tornado or --boundary"),
        ({"vary": ("a=1:2 mm", "b=1:2"), "boundary": True}, "2 inputs are varied"),
        ({"vary": ("t=80:90 degC",), "boundary": True, "tolerance": "1 mm"}, "such as '0.05 K'"),
        ({"vary": ("t=80:90 degC",), "boundary": True, "tolerance": "0 K"}, "above 0"),
        ({"vary": ("a=1:2 mm",), "sample": "sobol:65536", "indices": True}, "196608 points"),
    ],
)
def test_designs_that_cannot_be_made(design, named):
    with pytest.raises(UsageError, match=named):
        planned(TWO, StudyDesign(**design))


# ---------------------------------------------------------------------------- boundary


def test_bisection_finds_every_change_of_every_check_within_the_tolerance(tmp_path):
    """A limit crossed once, one crossed into a window and out of it, one only touched between two first points."""
    result = found(CURVES, tmp_path, vary=("oil.inlet=80:130 degC",), boundary=True, tolerance="0.1 K")
    truth = {
        ("rising", "below"): [117.3],
        ("window", "above"): [100 - 6],
        ("window", "below"): [100 + 6],
        ("narrow", "below"): [91.3 - 20 * 0.02**0.5],
        ("narrow", "above"): [91.3 + 20 * 0.02**0.5],
    }
    assert {(crossing.check, crossing.holds) for crossing in result.crossings} == set(truth)
    for crossing in result.crossings:
        (exact,) = truth[crossing.check, crossing.holds]
        assert crossing.low <= exact <= crossing.high and crossing.high - crossing.low <= 0.1
        assert crossing.value == pytest.approx(exact, abs=0.005) and crossing.unit == "degC"
    values = [float(point.values["oil.inlet"].split()[0]) for point in result.points]
    assert values == sorted(values) and len(values) < 9 + 5 * 8
    assert result.tolerance == 0.1 and result.design == "boundary"


def test_a_boundary_looks_only_at_the_checks_asked_for(tmp_path):
    design = {"vary": ("oil.inlet=80:130 degC",), "boundary": True}
    result = found(CURVES, tmp_path, checks=("rising",), **design)
    assert [crossing.check for crossing in result.crossings] == ["rising"]
    assert result.tolerance == 50 / 200
    assert len(result.points) <= 9 + 5


def test_a_point_without_result_is_no_boundary(tmp_path):
    design = {"vary": ("oil.inlet=123:131 degC",), "boundary": True, "checks": ("always", "rising")}
    result = found(CURVES, tmp_path, **design)
    assert result.points[0].failed and result.crossings == []


def test_a_boundary_of_whole_numbers_lies_between_neighbours(tmp_path):
    result = found(CURVES, tmp_path, vary=("gear.teeth=10:100",), boundary=True, checks=("teeth",))
    (crossing,) = result.crossings
    assert (crossing.low, crossing.high) == (33, 34)


def test_a_grid_finds_crossings_between_neighbouring_points_for_every_other_input(tmp_path):
    vary = ("oil.inlet=80:130:10 degC", "gear.teeth=30,40")
    result = found(CURVES, tmp_path, vary=vary)
    rising = [entry for entry in result.crossings if entry.check == "rising"]
    assert [entry.others for entry in rising] == [{"gear.teeth": "30"}, {"gear.teeth": "40"}]
    assert [(entry.low, entry.high) for entry in rising] == [(110, 120)] * 2
    assert [entry.value for entry in rising] == [pytest.approx(117.3)] * 2
    teeth = [entry for entry in result.crossings if entry.path == "gear.teeth"]
    assert len(teeth) == 6 and all(entry.value == pytest.approx(33.5) for entry in teeth)
    assert sum(entry.check == "window" for entry in result.crossings) == 2 * 2


def held_with_a_warning(case, *, fidelity):
    result = curves(case, fidelity=fidelity)
    checks = [
        replace(check, verdict="open" if check.verdict == "pass" else check.verdict)
        for check in result.checks
    ]
    return replace(result, checks=checks)


def a_gap_at_the_boundary(case, *, fidelity):
    if 100.2 < case.number("oil.inlet") < 104.0:
        raise NotConvergedError("no result here", {})
    return result_of(rising=0.01 * case.number("oil.inlet"))


def test_a_boundary_that_cannot_be_closed_in_says_so(tmp_path):
    """Between 80 and 130 degC the limit is met at 100; points just above it have no result."""
    result = found(
        CURVES, tmp_path, run=a_gap_at_the_boundary, vary=("oil.inlet=80:130 degC",), boundary=True
    )
    (crossing,) = result.crossings
    assert crossing.high - crossing.low > result.tolerance
    assert any("has no result" in warning.text for warning in result.warnings)


def test_sobol_indices_of_one_input_and_one_check(tmp_path):
    design = {
        "vary": ("oil.inlet=80:130 degC",),
        "sample": "sobol:64",
        "indices": True,
        "checks": ("rising",),
    }
    (index,) = found(CURVES, tmp_path, **design).indices
    assert index.total == pytest.approx(1.0, abs=0.1)


def test_a_warning_from_what_is_left_out_counts_as_held(tmp_path):
    design = {"vary": ("oil.inlet=80:130 degC",), "boundary": True, "checks": ("rising",)}
    warned = found(CURVES, tmp_path / "a", run=held_with_a_warning, **design)
    assert warned.crossings == found(CURVES, tmp_path / "b", **design).crossings


# ---------------------------------------------------------------------------- tornado and choice of checks


def plane(case, *, fidelity):
    return result_of(plane=0.5 + 0.1 * case.number("a") - 0.2 * case.number("b"), still=0.3)


def test_a_tornado_moves_one_input_at_a_time_from_the_stated_case(tmp_path):
    case = NumberCase({"a": "1", "b": "2", "c": "3"}, ranges={"b": ("1", "2.5"), "c": ("0", "9")})
    result = found(case, tmp_path, run=plane, vary=("assumed", "a=0:4"), tornado=True)
    assert [tuple(point.values.values()) for point in result.points] == [
        ("1", "2", "3"), ("0", "2", "3"), ("4", "2", "3"), ("1", "1", "3"), ("1", "2.5", "3"), ("1", "2", "0"),
        ("1", "2", "9"),
    ]  # fmt: skip
    assert [(entry.check, entry.path, entry.low, entry.high) for entry in result.swings] == [
        ("plane", "a", "0", "4"), ("plane", "b", "1", "2.5"),
    ]  # fmt: skip
    distances = [(entry.distance_stated, entry.distance_low, entry.distance_high) for entry in result.swings]
    assert distances == [
        pytest.approx((0.8, 0.9, 0.5)), pytest.approx((0.8, 0.6, 0.9)),
    ]  # fmt: skip


def test_a_pattern_that_matches_no_check_of_another_run_is_refused_and_its_points_stay(tmp_path):
    vary = ("oil.inlet=80:130:10 degC",)
    with pytest.raises(UsageError, match="no check matches 'risin'; the nearest are rising"):
        found(CURVES, tmp_path, vary=vary, checks=("risin",))
    outcome = run_study(
        CURVES, StudyDesign(vary=vary), tmp_path, write=quiet, run=curves, executor=InProcess()
    )
    assert (outcome.completed, outcome.reused) == (0, 6)

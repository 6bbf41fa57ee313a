"""Checks chosen by patterns on their ids."""

from concurrent.futures import Executor
from dataclasses import replace
from types import SimpleNamespace

import pytest

from rigdesign.base.errors import CaseError, UsageError
from rigdesign.case import load_case
from rigdesign.results.check import Checks
from rigdesign.studies.analysis import kept_by_copies
from rigdesign.studies.design import StudyDesign, planned
from rigdesign.studies.result import CheckSelection
from tests.builders.commands import Rigdesign
from tests.builders.report import make_check, make_result
from tests.builders.study import run_study

IDS = (
    "dynamics.dynamic_factor.test", "specimen.root_stress_iso.test.pinion", "specimen.root_stress_path.test.pinion",
    "specimen.load_cycles", "temperature.housing", "temperature.oil_outlet", "clearance.seal_gap", "oil.room",
)  # fmt: skip


@pytest.mark.parametrize(
    ("patterns", "expected"),
    [
        ((), IDS),
        (("temperature.*,clearance.*",), IDS[4:7]),
        (("clearance.*", "temperature.*"), IDS[4:7]),
        (("!specimen.root_stress*",), (IDS[0], *IDS[3:])),
        (("specimen.*", "!specimen.root_stress*"), (IDS[3],)),
        (("!specimen.root_stress*, specimen.*",), (IDS[3],)),
        (("oil.room",), ("oil.room",)),
        (("*.test.*",), IDS[1:3]),
    ],
)
def test_patterns_take_and_leave_out(patterns, expected):
    assert CheckSelection(patterns).of(IDS) == expected


@pytest.mark.parametrize(
    ("pattern", "named"),
    [
        ("temperatur.housing", "temperature.housing"),
        ("seal_gap", "clearance.seal_gap"),
        ("!root_stress", "specimen.root_stress_iso.test.pinion, specimen.root_stress_path.test.pinion"),
        ("Temperature.*", "temperature.housing"),
        ("xyz*", r"the groups are dynamics.\*, specimen.\*, temperature.\*"),
    ],
)
def test_a_pattern_that_matches_nothing_names_the_nearest_ids(pattern, named):
    with pytest.raises(
        UsageError, match=rf"no check matches '{pattern.strip('!').replace('*', '.')}'; .*{named}"
    ):
        CheckSelection(("oil.*", pattern)).of(IDS)


@pytest.mark.parametrize("pattern", ["", "!", "oil.*,", " "])
def test_an_empty_pattern_is_refused(pattern):
    with pytest.raises(UsageError, match="the pattern is empty; write --checks"):
        CheckSelection((pattern,))


def test_patterns_that_leave_nothing_over_are_refused():
    with pytest.raises(UsageError, match="no check is left over"):
        CheckSelection(("oil.*", "!*")).of(IDS)


def test_a_study_without_a_result_has_no_check_to_select():
    assert CheckSelection(("oil.*",)).of(()) == ()


@pytest.mark.parametrize("pattern", ["temprature.*", "transient.*"])
def test_a_pattern_that_matches_no_check_of_the_case_is_refused_before_a_point(pattern, tmp_path):
    """Known from the rules of the case: no folder is made, no executor asked."""
    design = StudyDesign(vary=("gearboxes.test.oil.flow=3:7:2 l/min",), checks=(pattern,))
    with pytest.raises(UsageError, match="--checks: no check matches"):
        run_study(load_case("uhcf_prototype"), design, tmp_path / "out", executor=Unasked())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("values", ["FVA 3,MIL-PRF-23699", "FVA 3"])
def test_a_pattern_that_matches_no_check_is_refused_before_a_point_where_names_are_varied(values, tmp_path):
    design = StudyDesign(vary=(f"gearboxes.test.oil.oil={values}",), checks=("root_safty*",))
    with pytest.raises(UsageError, match="--checks: no check matches"):
        run_study(load_case("uhcf_prototype"), design, tmp_path / "out", executor=Unasked())


@pytest.mark.parametrize("values", ["60,75 degC,90 degC", "60,75", "60 degC,75 mm"])
def test_a_value_no_point_can_hold_is_told_before_one_is_computed(values, tmp_path):
    design = StudyDesign(vary=(f"gearboxes.test.oil.sump_temperature={values}",))
    with pytest.raises(CaseError, match=r"sump_temperature = .*give it a unit|not of temperature"):
        run_study(load_case("fzg"), design, tmp_path / "out", executor=Unasked())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("vary", "kept"),
    [
        (("gearboxes.test.oil.level=0,10 mm",), "gearboxes.slave.oil.level"),
        (("gearboxes.*.oil.level=0,10 mm",), ""),
        (("gearboxes.test.gears.pinion.face_width=14,15 mm",), ""),
        (("gearboxes.test.oil.level=0,10 mm", "gearboxes.slave.oil.level=0,10 mm"), ""),
        (("gearboxes.slave.oil.level=0,10 mm",), ""),
    ],
)
def test_a_study_says_which_like_gearboxes_do_not_follow_a_varied_key(vary, kept):
    """The slave of the FZG rig is like its test gearbox but for the face widths."""
    case = load_case("fzg")
    said = [finding.text for finding in kept_by_copies(case, planned(case, StudyDesign(vary=vary)))]
    assert len(said) == bool(kept)
    assert all(kept in text and "vary gearboxes.*.oil.level" in text for text in said)


def test_a_changed_case_remembers_which_gearboxes_are_alike():
    case = load_case("fzg").with_value("ambient.temperature", "30 degC")
    assert case.copies_of("gearboxes.test.oil.level") == ("gearboxes.slave.oil.level",)


def test_checks_that_are_not_selected_do_not_count():
    checks = [
        replace(make_check("a", 60.0, 80.0), id="temperature.housing"),
        replace(make_check("b", 9.0, 5.0), id="oil.flow"),
    ]
    result = make_result(checks=Checks(checks), verdict="fail")
    rig = SimpleNamespace(case=load_case("fzg"))
    judged = CheckSelection(("temperature.*",)).applied(rig, result)
    assert [entry.reason for entry in judged.checks if entry.verdict == "not applicable"] == ["not selected"]
    assert judged.checks["temperature.housing"] == result.checks["temperature.housing"]
    assert judged.verdict == "pass" and "1 of 2 checks" in judged.warnings[0].text
    assert CheckSelection().applied(rig, result) is result


def test_a_pattern_of_a_run_that_matches_no_check_is_refused_before_it_starts(rigdesign: Rigdesign):
    ended = rigdesign("check", "uhcf_prototype", "--checks", "root_safty*")
    assert ended.status == 2 and "no check matches 'root_safty*'" in ended.err and not ended.out


class Unasked(Executor):
    """No point is to be computed."""

    def submit(self, work, /, *arguments, **keywords):
        raise AssertionError

"""Checks chosen by patterns on their ids."""

from concurrent.futures import Executor

import pytest

from rigdesign.base.errors import UsageError
from rigdesign.case import load_case
from rigdesign.studies.design import StudyDesign
from rigdesign.studies.selection import CheckSelection
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


class Unasked(Executor):
    """No point is to be computed."""

    def submit(self, work, /, *arguments, **keywords):
        raise AssertionError

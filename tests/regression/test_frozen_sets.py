"""Twelve frozen sets of two rigs, six operating points each: the diagnosis is right, or silent.

The sets were made once by the virtual rig (`tests/virtual_rig`); `tests/blind/frozen/answers.json` says what is hidden
in them, which the diagnosis does not read. The library of each rig is made here.
"""

import json
from functools import cache

import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.rig_calibration.healthy_sets import calibrate_rig
from rigdesign.diagnosis.run import diagnose_measurement
from tests.blind.metrics import canonical
from tests.builders.paths import ROOT
from tests.builders.shared_runs import run_cache

FROZEN = ROOT / "tests" / "blind" / "frozen"
ANSWERS = json.loads((FROZEN / "answers.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module", autouse=True)
def _cache():
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(run_cache()))
        yield


@cache
def diagnosed(name):
    return diagnose_measurement(
        load_case(ROOT / "cases" / ANSWERS[name]["rig"]), FROZEN / name, propose=False
    ).diagnosis


def hidden(name):
    return {canonical(effect["effect"], ANSWERS[name]["rig"]) for effect in ANSWERS[name]["effects"]}


VERDICTS = {
    "set_00": "within_noise",
    "set_01": "named",
    "set_02": "alias_group",
    "set_03": "named",
    "set_04": "unknown_located",  # one bearing has the heat of three: no effect of the catalogue has that shape
    "set_05": "within_noise",
    "set_06": "within_noise",
    "set_07": "alias_group",
    "set_08": "alias_group",
    "set_09": "unknown_located",
    "set_10": "input_error_suspected",
    "set_11": "within_noise",
}


BY_HAND = ("set_00", *(name for name in VERDICTS if ANSWERS[name]["rig"] == "loop_1to1"))
"""A minute and more each, and two and a half for the library of the loop."""


MARKED = {name: [pytest.mark.slow] if name in BY_HAND else [] for name in VERDICTS}


@pytest.mark.parametrize(
    ("name", "verdict"),
    [pytest.param(name, verdict, marks=MARKED[name]) for name, verdict in VERDICTS.items()],
)
def test_every_set_ends_as_it_should(name, verdict):
    found = diagnosed(name)
    assert found.decision.verdict == verdict, found.decision.reason
    if verdict in ("named", "alias_group", "input_error_suspected"):
        assert hidden(name) <= set(found.named)


@pytest.mark.parametrize("name", [name for name, verdict in VERDICTS.items() if verdict == "named"])
def test_nothing_is_named_that_is_not_hidden(name):
    assert set(diagnosed(name).named) <= hidden(name)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=MARKED[name])
        for name, verdict in VERDICTS.items()
        if verdict == "alias_group"
    ],
)
def test_an_alias_group_is_small(name):
    assert len(diagnosed(name).named) <= 3


@cache
def calibrated():
    case = load_case(ROOT / "cases" / "uhcf_prototype")
    return calibrate_rig(case, [FROZEN / "set_00", FROZEN / "set_05"])


def test_two_healthy_sets_calibrate_their_rig_without_an_alarm():
    found = calibrated()
    assert found.odd == () and not any(row.alarm for row in found.left_out)
    assert all(0.8 < row.chi_square < 1.2 for row in found.left_out if row.baseline is not None)


@pytest.mark.parametrize("name", ["set_01", "set_04"])
def test_verdicts_hold_with_the_calibration_of_the_rig(name):
    """A hidden leak is named, a cause outside the catalogue is not."""
    case, calibration = calibrated().case, calibrated().fit.calibration
    found = diagnose_measurement(case, FROZEN / name, calibration=calibration, propose=False).diagnosis
    assert found.decision.verdict == VERDICTS[name], found.decision.reason
    assert set(found.named) == (hidden(name) if VERDICTS[name] == "named" else set())

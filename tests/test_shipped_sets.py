"""Diagnosis of the sets that ship with the prototype, against the answers that no command reads.

Slow: the first set makes the library of the rig. Run with `python -m pytest -m slow tests/test_shipped_sets.py`.
"""

import json
from pathlib import Path

import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.run import diagnose_measurement
from tests.blind.metrics import canonical

ROOT = Path(__file__).parents[1]
CASE = ROOT / "cases" / "uhcf_prototype"
ANSWERS = json.loads((ROOT / "tests" / "virtual_rig" / "shipped_answers.json").read_text(encoding="utf-8"))

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", autouse=True)
def _cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        yield


WANTED = {
    "set_0": ("too_small", set()),
    "set_1": ("named", {"shell_contact:test"}),
    "set_2": ("named", {"leak_warm_cold:test"}),
    "set_3": ("within_noise", set()),
    "set_4": ("unknown_located", set()),
    "set_5": ("input_error_suspected", {"swapped_points:P05,P08"}),
    "set_6": ("named", {"bearing_loss:test", "film:test.chamber_oil"}),
}
"""Set -> verdict and names it must end with."""


@pytest.mark.parametrize("name", WANTED)
def test_every_set_ends_as_it_should(name):
    verdict, names = WANTED[name]
    found = diagnose_measurement(load_case(CASE), CASE / "measured" / name).diagnosis
    assert (found.decision.verdict, set(found.named)) == (verdict, names)
    answer = ANSWERS.get(f"uhcf_prototype/{name}", {"effects": []})
    hidden = {canonical(effect["effect"], "uhcf_prototype") for effect in answer["effects"]}
    assert names <= hidden


@pytest.mark.parametrize("name", ["set_1", "set_6"])
def test_with_a_baseline_the_gap_shrinks_in_raw_readings(name):
    gap = diagnose_measurement(load_case(CASE), CASE / "measured" / name).diagnosis.gap
    assert gap is not None
    assert gap.raw_after < 0.2 * gap.raw_before

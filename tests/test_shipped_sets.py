"""Diagnosis of the sets that ship with the prototype, against the answers that no command reads.

Slow: the first set makes the library of the rig. Run with `python -m pytest -m slow tests/test_shipped_sets.py`.
"""

import json
from pathlib import Path

import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.run import diagnose_measurement

ROOT = Path(__file__).parents[1]
CASE = ROOT / "cases" / "uhcf_prototype"
ANSWERS = json.loads((ROOT / "tests" / "virtual_rig" / "shipped_answers.json").read_text(encoding="utf-8"))

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", autouse=True)
def _cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.mark.parametrize("name", ["set_1", "set_2", "set_3", "set_4", "set_5"])
def test_nothing_wrong_is_named(name):
    found = diagnose_measurement(load_case(CASE), CASE / "measured" / name).diagnosis
    hidden = {effect["effect"] for effect in ANSWERS[f"uhcf_prototype/{name}"]["effects"]}
    hidden |= {f"swapped_points:{','.join(sorted(one.partition(':')[2].split(',')))}" for one in hidden}
    if found.decision.verdict in ("named", "input_error_suspected"):
        assert set(found.named) <= hidden
    if name == "set_3":
        assert found.decision.verdict in ("within_noise", "too_small")
    if name == "set_5":
        assert found.decision.verdict == "input_error_suspected"

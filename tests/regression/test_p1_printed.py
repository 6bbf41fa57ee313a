"""P1 as printed: -7 % measured, -4 % simulated at one gauge names nothing; how large each cause would be is said.

Slow: influence numbers and the library of the rig take some minutes. Run with
`python -m pytest -m slow tests/regression/test_p1_printed.py`.
"""

import json

import pytest

from rigdesign.cli.main import app
from tests.builders.paths import CASES
from tests.builders.shared_runs import run_cache

CASE = CASES / "strain_gauge_rig"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def document(tmp_path_factory):
    out = tmp_path_factory.mktemp("diagnosis")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RIGDESIGN_CACHE_DIR", str(run_cache()))
        arguments = ["diagnose", str(CASE), str(CASE / "measured" / "p1_printed"), "--out", str(out)]
        assert app(arguments, result_action="return_value") == 0
    assert "How large each cause would have to be" in (out / "diagnosis.html").read_text(encoding="utf-8")
    return json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))


def row(document, effect):
    return next(one for one in document["required_sizes"] if one["effect"] == effect)


def test_two_numbers_name_nothing(document) -> None:
    assert document["verdict"] == "data_insufficient" and document["strength"] == "indicative"
    assert document["named"] == [] and document["patch"]["case"] is None
    assert not any(one["effect"].startswith("swapped") for one in document["suspects"])


def test_every_cause_has_the_size_it_would_need(document) -> None:
    for effect in ("misalignment:test.main", "lead_crowning:test.main", "gauge_lag:test.pinion.ii"):
        found = row(document, effect)
        assert (
            found["size"] and found["bounds"] and found["verdict"] in ("within the bound", "beyond the bound")
        )
    assert row(document, "misalignment:test.main")["verdict"] == "beyond the bound"
    assert row(document, "run_out:test.pinion")["verdict"] == "beyond the bound"
    assert row(document, "gauge_factor:gauge_ii")["verdict"] == "does not explain it"
    assert row(document, "torque_scale")["verdict"] == "does not explain it"
    assert row(document, "unbalance")["verdict"] == "not modelled"


def test_what_would_decide_is_said(document) -> None:
    texts = [one["measurement"] for one in document["next_measurements"]]
    assert any("root strain" in text or "a point" in text for text in texts)
    assert any("operating points" in text for text in texts)

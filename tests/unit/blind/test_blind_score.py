"""The blind score counts what is said, not names alone, and detectable sizes over either floor."""

import json

import numpy as np
import pytest

from tests.blind import score
from tests.blind.metrics import compared, table
from tests.blind.splits import Spec
from tests.virtual_rig import detect
from tests.virtual_rig.generate_plans import plan_points, sensors
from tests.virtual_rig.generate_truth import readings, true_points


def row(kind, verdict, named=(), effects=(), **more):
    return {
        "kind": kind, "rig": "uhcf_prototype", "verdict": verdict, "named": list(named), "effects": list(effects),
        "top": [], "covered": None, "size_error": None, "gap_shrink": None, "gap_worse": None, "seconds": 1.0, **more,
    }  # fmt: skip


def loss(measured, declared):
    return {"effect": "mesh_loss:test", "detectable_sizes": measured, "detectable_sizes_declared": declared}


def numbers(rows, floor="declared"):
    return {line.name: line.measured.split(" ")[0] for line in table(rows, floor)}


def test_false_alarms_are_counted_beside_names():
    swapped = "swapped_channels:TC01,TC02"
    found = numbers(
        [
            row("none", "unknown_located"), row("none", "within_noise"), row("none", "too_small"),
            row("none", "input_error_suspected", [swapped]),
            row("single", "input_error_suspected", ["swapped_points:P01,P02"], [loss(3.0, 3.0)]),
            row("single", "unknown_located", (), [loss(3.0, 3.0)]),
            row("input", "input_error_suspected", ["swapped_channels:TC02,TC01"], [{"effect": swapped}]),
        ]
    )  # fmt: skip
    assert found["false alarm of any kind"] == "2/4"
    assert found["named without an effect"] == "1/4"
    assert found["data suspected where none are wrong"] == "2/6"
    assert found["false exchanges"] == "2/7"
    assert found["input errors found"] == "1/1"


def test_a_suspicion_counts_for_pairs_and_as_an_alarm_and_names_nothing():
    both = [loss(3.0, 3.0), {**loss(3.0, 3.0), "effect": "run_out:test.pinion"}]
    found = numbers(
        [
            row("pair", "suspected", ["mesh_loss:test"], both), row("pair", "named", ["bypass:test"], both),
            row("single", "suspected", ["bypass:test"], [loss(3.0, 3.0)]),
            row("single", "suspected", ["mesh_loss:test"], [loss(3.0, 3.0)]),
            row("none", "suspected", ["bypass:test"]), row("out", "suspected", ["bypass:test"]),
        ]
    )  # fmt: skip
    assert found["pairs: at least one named or suspected"] == "1/2" and found["pairs: invented"] == "1/2"
    assert found["false alarm of any kind"] == "1/1" and found["named without an effect"] == "0/1"
    assert found["wrong suspicion on singles"] == "1/2" and found["wrong or extra name on singles"] == "0/2"
    assert found[">= 2 sizes: named, group or suspected"] == "1/2"
    assert found["named outside the catalogue"] == "0/1" and found["suspected outside the catalogue"] == "1/1"


def test_comparators_are_counted_by_what_they_name():
    rows = [
        row("none", "within_noise", comparators={"BIC": ["leak:test"]}),
        row("single", "too_small", (), [loss(3.0, 3.0)], comparators={"BIC": ["mesh_loss:test"]}),
    ]
    found = {what: text.split(" ")[0] for what, text in compared(rows, "BIC")}
    assert found["named without an effect"] == "1/1"
    assert found["excitation, loss, flow of 2 sizes or more: right"] == "1/1"


def test_effects_count_as_detectable_over_either_floor():
    rows = [
        row("single", "named", ["mesh_loss:test"], [loss(4.0, 9.0)]),
        row("single", "too_small", (), [loss(1.5, 3.0)]),
        row("single", "too_small", (), [loss(2.5, 1.2)]),
        row("single", "within_noise", (), [loss(0.4, 0.9)]),
    ]
    large, between = "excitation, loss, flow: name or group", "1 to 2 sizes: name or group"
    measured = numbers(rows, "measured")
    assert (measured[large], measured[between]) == ("1/2", "0/1")
    assert (numbers(rows, "declared")[large], numbers(rows, "declared")[between]) == ("1/2", "0/1")
    rows += [row("single", "named", ["mesh_loss:test"], [loss(1.9, 2.1)])]
    assert numbers(rows, "measured")[large] == "1/2" and numbers(rows, "declared")[large] == "2/3"


def test_a_set_stored_without_the_declared_size_is_no_silent_zero():
    with pytest.raises(KeyError, match="detectable_sizes_declared"):
        table(
            [row("single", "named", [], [{"effect": "mesh_loss:test", "detectable_sizes": 2.0}])], "declared"
        )


def test_generate_adds_sizes_to_stored_answers_and_leaves_the_set(monkeypatch, tmp_path):
    spec = Spec("0001", "uhcf_prototype", 7, {"kind": "single"})
    answer = tmp_path / "answers" / "dev" / "plain" / "0001.json"
    answer.parent.mkdir(parents=True)
    answer.write_text(json.dumps({"effects": [{"effect": "mesh_loss:test", "detectable_sizes": 2.0}]}))
    made = []

    def again(rig, wanted, seed, folder):
        made.append((rig, wanted, seed))
        assert folder != score.folder_of(tmp_path, "dev", "plain", spec)
        return {"effects": [loss(2.0, 4.0)]}

    monkeypatch.setattr(score, "make_set", again)
    assert "sizes added" in score._generate(("dev", "plain", tmp_path, spec))
    assert json.loads(answer.read_text())["effects"][0]["detectable_sizes_declared"] == 4.0
    assert score._generate(("dev", "plain", tmp_path, spec)) == "there"
    assert made == [("uhcf_prototype", {"kind": "single"}, 7)]
    stored = tmp_path / "results" / "dev_plain.jsonl"
    stored.parent.mkdir()
    stored.write_text(json.dumps({"name": "0001", "effects": [{"effect": "mesh_loss:test"}]}) + "\n")
    (found,) = score.stored_rows("dev", "plain", tmp_path, "")
    assert found["effects"] == [loss(2.0, 4.0)]


def test_the_two_floors_are_those_of_the_history(monkeypatch):
    """763ff1a and 636b546: mesh orders 0.20 and 1.0, power 3 and 6 %, temperatures 0.5 and 1.0 K."""
    rig = "loop_1to1"
    rows = readings(sensors(rig, "rich"), true_points(rig, plan_points(rig, 15)))
    base = np.array([1e3 if one.order else 1.0 for one in rows])
    monkeypatch.setattr(detect, "_sensitivities", lambda rig: (base, np.zeros((len(rows), 1)), ("none",)))
    found = {floor: detect.Detector(rig, "rich", 15, floor=floor) for floor in detect.FLOORS}
    mesh = next(i for i, one in enumerate(found["declared"].rows) if one.order == 28.0)
    ratio = np.sqrt(np.diagonal(found["measured"].floor)[mesh] / np.diagonal(found["declared"].floor)[mesh])
    assert ratio == pytest.approx(1.0 / 0.20)
    change = np.zeros(len(rows))
    change[mesh] = 1.0
    assert found["declared"].delta(change) > 3.0 * found["measured"].delta(change)
    for key, ratio in (("power", 2.0), ("temperature_each", 2.0), ("temperature_common", 2.2)):
        assert detect.MEASURED[key] / detect.DECLARED[key] == pytest.approx(ratio)
    assert detect.detector.__wrapped__(rig, "rich", 15).shares is detect.MEASURED

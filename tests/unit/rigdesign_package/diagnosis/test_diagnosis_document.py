"""diagnosis.json: the contract's keys, sizes with unit and interval, verdicts, picks and refusals."""

import json
from dataclasses import replace
from math import atan2, cos, hypot, log, pi, radians, sin

import numpy as np
import pytest

from rigdesign.base.errors import UsageError
from rigdesign.base.json_text import to_text
from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.not_modelled import WAITING
from rigdesign.diagnosis.decision.naming import Names, formatted
from rigdesign.diagnosis.decision.proposals import (
    NOTHING_NEXT,
    NextMeasurements,
    Offer,
    extras_of,
    next_measurements,
)
from rigdesign.diagnosis.document.advice import LARGEST_ODDS, certainty, headline, steps
from rigdesign.diagnosis.document.document import diagnosis_document, measurement_patch
from rigdesign.diagnosis.document.outcome import check_pick, of_data, outcome
from rigdesign.diagnosis.library.candidates import SPARE, Costs
from rigdesign.diagnosis.run import Result
from rigdesign.diagnosis.statistics.next_measurement import Ranked
from rigdesign.measurement.reading.measurement_set import DataFinding
from tests.builders.diagnosis import library, story, the_case
from tests.builders.effects_page import effects_page
from tests.builders.paths import CASES

CONTRACT = {
    "verdict", "strength", "named", "alternatives", "detectability", "aliases", "gap", "unexplained",
    "next_measurements",
}  # fmt: skip
STORIES = ("mesh loss", "run-out", "tooth", "alias", "exchanged", "angle", "one point", "healthy")


def document(name: str, **keys):
    return diagnosis_document(outcome(story(name), **keys))


def names(name: str = "healthy") -> Names:
    result: Result = story(name)
    return Names(result.effects, result.problem.residuals.errors)


@pytest.mark.parametrize("name", STORIES)
def test_every_verdict_has_the_keys_of_the_contract_and_finite_numbers(name: str) -> None:
    found = document(name)
    assert set(found) >= CONTRACT
    assert found["strength"] in ("proven", "indicative")
    assert json.loads(to_text(found)) == found
    for row in found["named"]:
        assert {"effect", "parameters"} <= set(row)
        for parameter in row["parameters"]:
            assert {"name", "value", "unit", "interval_95"} <= set(parameter)
            low, high = parameter["interval_95"]
            assert low <= parameter["value"] <= high
    total = sum(row["posterior"] for row in found["alternatives"])
    assert total <= 1.0 + 1e-9
    assert [row["posterior"] for row in found["alternatives"]] == sorted(
        (row["posterior"] for row in found["alternatives"]), reverse=True
    )
    assert any(row["explanation"] == "none" for row in found["alternatives"])


@pytest.mark.parametrize(
    ("name", "verdict", "named"),
    [
        ("mesh loss", "named", ["mesh_loss:test"]),
        ("run-out", "named", ["run_out:reference.pinion"]),
        ("tooth", "named", ["single_pitch:test.pinion"]),
        ("angle", "named", ["angle_zero"]),
        ("alias", "alias_group", []),
        ("exchanged", "input_error_suspected", []),
        ("one point", "data_insufficient", []),
        ("healthy", "within_noise", []),
    ],
)
def test_only_what_is_named_stands_under_named(name: str, verdict: str, named: list[str]) -> None:
    found = document(name)
    assert found["verdict"] == verdict
    assert [row["effect"] for row in found["named"]] == named


def test_suspected_data_are_told_with_the_mass_that_all_numbers_give_them() -> None:
    found = document("exchanged")
    (suspect,) = found["suspects"]
    assert suspect["posterior"] > 0.5
    first = found["alternatives"][0]
    assert (first["effects"], first["posterior"]) == ([suspect["effect"]], suspect["posterior"])


def test_a_harmonic_is_told_by_amplitude_and_phase() -> None:
    (row,) = document("run-out")["named"]
    values = {parameter["name"]: parameter for parameter in row["parameters"]}
    along, across = (values[f"eccentricity along {part}"]["value"] for part in ("cosine", "sine"))
    assert values["eccentricity"]["value"] == pytest.approx(hypot(along, across), rel=1e-5)
    assert values["phase"]["value"] == pytest.approx(atan2(across, along) % (2 * pi), rel=1e-5)
    assert values["run-out F_r"]["value"] == pytest.approx(2.0 * hypot(along, across), rel=1e-5)
    assert values["eccentricity"]["unit"] == "m" and values["phase"]["unit"] == "rad"
    for name, hidden in (("eccentricity along cosine", 25e-6), ("eccentricity along sine", -10e-6)):
        low, high = values[name]["interval_95"]
        assert low <= hidden <= high
    low, high = values["eccentricity"]["interval_95"]
    assert 0.0 < low < hypot(25e-6, 10e-6) < high


def test_interval_of_amplitude_and_phase_holds_as_many_draws_as_it_says() -> None:
    rng = np.random.default_rng(4)
    true, sd = np.array([20e-6, 9e-6]), 1.5e-6
    inside = np.zeros(2)
    known = names()
    for _ in range(500):
        drawn = true + sd * rng.normal(size=2)
        ends = [(value - 1.96 * sd, value + 1.96 * sd) for value in drawn]
        size, phase, *_ = known.sized("run_out:test.pinion", drawn, ends).shown
        inside[0] += size.interval[0] <= hypot(*true) <= size.interval[1]
        turn = (atan2(true[1], true[0]) - phase.value + pi) % (2 * pi) - pi
        inside[1] += phase.interval[0] <= phase.value + turn <= phase.interval[1]
    assert inside / 500 == pytest.approx([0.95, 0.95], abs=0.03)


def test_a_harmonic_that_may_be_zero_has_any_phase() -> None:
    shown = names().sized("run_out:test.pinion", (1e-6, 0.0), [(-2e-6, 4e-6), (-3e-6, 3e-6)]).shown
    assert shown[0].interval[0] == 0.0
    assert shown[1].interval[1] - shown[1].interval[0] == pytest.approx(2 * pi, rel=1e-5)
    nothing = names().sized("run_out:test.pinion", (0.0, 0.0), [(-3e-6, 3e-6), (-4e-6, 4e-6)]).shown
    assert nothing[0].value == 0.0 and nothing[0].interval[1] == pytest.approx(5e-6)


def test_a_factor_is_told_as_a_factor_and_open_at_its_bound() -> None:
    (one,) = names().sized("mesh_loss:test", (log(1.25),), [(log(0.9), log(1.6))]).shown
    assert one.value == pytest.approx(1.25) and one.factor and one.open
    assert formatted(one) == "factor x 1.25 (0.9 to 1.6, open at a bound)"
    (share,) = names().sized("bypass:test", (0.1,), [(0.0, 0.2)]).shown
    assert formatted(share) == "share 10 % (0 to 20)" and not share.open


def test_a_tooth_is_told_with_its_number() -> None:
    (row,) = document("tooth")["named"]
    assert row["tooth"] == 5 and row["explanation"] == "single_pitch:test.pinion/5"
    (deviation,) = row["parameters"]
    low, high = deviation["interval_95"]
    assert low <= 30e-6 <= high


def test_names_know_orders_from_teeth() -> None:
    known = names()
    entry, tooth = known.entry("cumulative_pitch:test.pinion/3") or (None, None)
    assert entry is not None and entry.name == "cumulative_pitch:test.pinion/3" and tooth is None
    assert known.plain("single_pitch:test.wheel/11") == "single_pitch:test.wheel"
    assert known.entry("unknown: heat at body:gear ~n") is None
    assert known.entry("run_out:test.pinion/4") is None
    assert known.title("swapped_points:P01,P02") == "operating points P01 and P02 exchanged"
    assert known.title("angle_zero (+0.2 rad)") == "index pulse offset by +0.2 rad"
    assert known.title("unit:P (kilowatt)") == "P in another unit or sign: kilowatt"
    with pytest.raises(ValueError, match="no size"):
        known.sized("swapped_points:P01,P02", (), ())


def test_gap_of_a_channel_is_that_of_its_readings_on_the_points_kept_aside() -> None:
    result, found = story("mesh loss"), document("mesh loss")
    aside = found["gap"]["held_out_points"]
    assert aside == [row["point"] for row in found["data"]["points"] if row["held_out"]]
    diagnosis, residuals = result.diagnosis, result.problem.residuals
    rows = [i for i, f in enumerate(residuals.features) if f.channel == "T_gear" and f.setting in aside]
    assert diagnosis.kept == tuple(range(len(residuals.features)))
    before = np.sqrt(np.mean(diagnosis.residual[rows] ** 2))
    after = np.sqrt(np.mean((diagnosis.residual - diagnosis.answer)[rows] ** 2))
    row = next(row for row in found["gap"]["channels"] if row["channel"] == "T_gear")
    assert row["before"] == pytest.approx(before, rel=1e-9) and row["unit"] == "K"
    assert row["after"] == pytest.approx(after, rel=1e-9)
    assert row["after"] < 0.1 * row["before"]
    assert found["gap"]["floor"] == 1.0 and found["gap"]["after"] < found["gap"]["before"]


def test_teeth_of_one_gear_share_a_row_and_no_effect_is_left_out() -> None:
    found = document("tooth")
    rows = {row["effect"]: row for row in found["detectability"]}
    assert len(rows) == len(found["detectability"])
    assert rows["single_pitch:test.pinion"]["teeth"] == 28
    assert set(rows) >= {effect.name for effect in story("tooth").effects}
    assert rows["weak_tooth:test.wheel"]["verdict"] == "not testable here"
    assert rows["mesh_loss:test"]["detectable"] > 1.0
    pairs = [row["effects"] for row in found["aliases"]]
    assert ["run_out:test.pinion", "run_out:test.wheel"] in pairs
    assert all(first != second for first, second in pairs)


def test_an_alias_group_is_refused_until_the_user_picks_one() -> None:
    found = document("alias")
    assert {row["effect"] for row in found["suspects"]} == {"run_out:test.pinion", "run_out:test.wheel"}
    assert found["patch"]["case"] is None and "--name" in found["patch"]["refused"]
    picked = document("alias", pick="run_out:test.wheel")
    assert picked["verdict"] == "alias_group" and picked["named"] == []
    assert picked["picked"]["effect"] == "run_out:test.wheel"
    assert picked["patch"]["case"] == "case.patch.json" and picked["patch"]["picked_by_user"]


def test_a_pick_that_means_nothing_is_refused_with_what_is_near() -> None:
    with pytest.raises(UsageError, match=r"did you mean run_out:test\.pinion"):
        check_pick(effects_of(the_case()), "runout:test.pinion")
    for good in ("run_out:test.pinion", "single_pitch:test.wheel/3", "sensor_offset:TC1", "angle_zero"):
        check_pick(effects_of(the_case()), good)
    with pytest.raises(UsageError, match="do not see it"):
        outcome(story("alias"), pick="inertia:motor")
    with pytest.raises(UsageError, match="the data name mesh_loss:test"):
        outcome(story("mesh loss"), pick="run_out:test.wheel")


def test_refusals_say_why_and_what_to_do() -> None:
    one = document("one point")
    assert one["strength"] == "indicative" and one["gap"] is None
    assert "single reading" in one["certainty"] and "held out" in one["certainty"]
    asked = [row["measurement"] for row in one["next_measurements"]]
    assert any("9 to 15 operating points" in text for text in asked)
    assert any("repeat every" in text for text in asked)
    assert any("baseline" in text for text in asked)
    healthy = document("healthy")
    assert healthy["patch"]["case"] is None and healthy["unexplained"]["groups"] == []
    assert "residual is within that of a healthy rig" in healthy["headline"]


def test_a_set_in_which_nothing_is_named_tells_what_a_comparison_suspects() -> None:
    """Before, a healthy verdict stood above exchanged channels that `compare` names."""
    told_ = outcome(story("healthy"))
    text = "T_gear and T_bearing: exchanged, they leave 3.0% of their squared residual"
    finding = DataFinding(
        id="swapped_channels", weight="suspect", channels=("T_gear", "T_bearing"), text=text
    )
    data = replace(told_.result.data, findings=(*told_.result.data.findings, finding))
    assert headline(replace(told_, result=replace(told_.result, data=data))).endswith(
        f"is within that of a healthy rig. Readings in doubt: {text}."
    )


def test_exchanged_channels_are_put_right_in_the_measurement() -> None:
    told_ = outcome(story("exchanged"))
    assert "channels T_gear and T_bearing exchanged" in headline(told_)
    patch = measurement_patch(told_)
    places = {row["path"]: row["value"] for row in patch["operations"]}
    assert places == {
        "/channels/T_gear/place": "test.bearing_oil",
        "/channels/T_bearing/place": "test.gear_oil",
    }
    assert patch["measurement"]["hash"] == story("exchanged").measurement.hash


def test_a_sensor_that_is_off_leaves_the_case_alone() -> None:
    told_ = outcome(story("angle"))
    assert told_.case_patch is None and "case stays" in told_.refused
    (correction,) = measurement_patch(told_)["corrections"]
    low, high = correction["parameters"][0]["interval_95"]
    assert low <= 0.02 <= high
    assert headline(told_).startswith("Wrong in the measurement")


@pytest.mark.parametrize(
    ("name", "path", "value"),
    [
        ("unit:T_gear (fahrenheit)", "/channels/T_gear/unit", "degF"),
        ("unit:P (kilowatt)", "/channels/P/unit", "kW"),
        ("unit:M_wheel (kilonewton metre)", "/channels/M_wheel/unit", "kN m"),
    ],
)
def test_a_misread_unit_is_stated_anew(name: str, path: str, value: str) -> None:
    found = of_data(name, story("healthy").measurement)
    assert found.operations == ({"op": "replace", "path": path, "value": value},)


def test_what_no_key_says_is_a_correction_in_words() -> None:
    measurement = story("healthy").measurement
    for name in (
        "unit:P (sign)",
        "unit:P (horsepower)",
        "unit:M (pound-force inch)",
        "swapped_points:P01,P02",
    ):
        found = of_data(name, measurement)
        assert found.operations == () and found.text


def test_proposals_come_first_and_keep_their_numbers() -> None:
    proposal = Ranked(title="wheel put on further", expected_evidence=15.5, cost=5.0, decides=True)
    told_ = outcome(replace(story("mesh loss"), next_measurements=NextMeasurements(ranked=(proposal,))))
    first = steps(told_)[0]
    assert (first.text, first.expected_evidence, first.cost, first.decides) == (
        "wheel put on further",
        15.5,
        5.0,
        True,
    )
    assert first.odds == LARGEST_ODDS
    assert certainty(told_).startswith("Proven")


def test_correction_of_the_phase_follows_the_reading() -> None:
    """A mark that stands 0.02 rad late turns order k by 0.02 k: adding it to the angle undoes that."""
    order, true = 28.0, complex(2.0, 1.0)
    seen = true * complex(cos(order * 0.02), sin(order * 0.02))
    for angle in np.linspace(0.0, 2 * pi, 7):
        signal = (seen * complex(cos(order * angle), sin(order * angle))).real
        put_right = angle + 0.02
        assert signal == pytest.approx((true * complex(cos(order * put_right), sin(order * put_right))).real)


def test_degrees_are_what_an_engineer_reads() -> None:
    phase = names().sized(
        "run_out:test.pinion", (cos(radians(30)) * 1e-5, sin(radians(30)) * 1e-5), [(0, 2e-5)] * 2
    )
    assert formatted(phase.shown[1]).startswith("phase 30 deg")


def test_the_page_of_effects_is_that_of_the_catalogue() -> None:
    shipped = ("loop_1to1", "loop_hunting", "uhcf_prototype", "uhcf_main", "strain_gauge_rig")
    cases = [load_case(CASES / name) for name in shipped]
    written = (CASES / "effects.md").read_text(encoding="utf-8")
    assert written == effects_page(cases), (
        "python -m tests.builders.effects_page cases/loop_1to1 cases/loop_hunting cases/uhcf_prototype "
        "cases/uhcf_main cases/strain_gauge_rig > cases/effects.md"
    )


def test_what_waits_is_not_in_the_catalogue() -> None:
    kinds = {effect.kind for effect in effects_of(the_case())}
    waiting = {one.name for one in WAITING}
    assert len(waiting) == len(WAITING) and not waiting & kinds


USUAL = Costs()


def proposed(name: str, *, rivals: int = 3, costs: Costs = USUAL) -> NextMeasurements:
    """What is to be measured next where the run-out of the wheel turns round with its place on the shaft."""
    result = story(name)
    extras = extras_of(result.case, result.data.settings)
    channels = [entry.channel for entry in result.data.channels.values()]
    offered = library((*result.data.settings, *(extra.setting for extra in extras)), channels)
    wheel = offered.responses["run_out:test.wheel"]
    there = np.array([feature.setting == f"{SPARE}re-indexed" for feature in offered.features])
    turned = replace(wheel, answers=np.where(there, -wheel.answers, wheel.answers))
    offered = replace(offered, responses={**offered.responses, "run_out:test.wheel": turned})
    first, *others = result.diagnosis.evaluations
    alone = [one for one in first.evidence if one.hypothesis.family == "physical"]
    few = replace(first, evidence=tuple(alone[:rivals]))
    found = replace(result.diagnosis, evaluations=(few, *others))
    offer = Offer(library=offered, extras=extras, costs=costs)
    return next_measurements(result.problem, found, lambda: offer, result.calibration)


def test_the_point_that_tells_members_of_a_group_apart_is_proposed_first() -> None:
    found = proposed("alias", rivals=2)
    best, *others = found.ranked
    assert best.title.endswith("put on five teeth further") and best.decides
    assert [one.expected_evidence for one in others] == pytest.approx([0.0] * 3, abs=1e-9)
    assert found.together is not None and found.together.titles == (best.title,)
    assert dict(found.verified) == {"run_out:test.pinion": True, "run_out:test.wheel": True}


def test_stated_costs_decide_between_measurements() -> None:
    usual = proposed("mesh loss", rivals=3)
    assert usual == NOTHING_NEXT
    cheap = proposed("alias", rivals=2, costs=Costs(stated={"reassembly": 2.0}))
    assert cheap.together is not None and cheap.together.cost == 2.0


def test_a_single_explanation_has_nothing_to_be_told_from_but_nothing_at_all() -> None:
    assert proposed("alias", rivals=1) == NOTHING_NEXT
    assert proposed("mesh loss") == NOTHING_NEXT
    assert proposed("one point", rivals=0) == NOTHING_NEXT
    from_nothing = [one.expected_evidence for one in proposed("one point", rivals=1).ranked]
    assert from_nothing and min(from_nothing) > 0.0

import csv
import json
import math
from dataclasses import replace
from itertools import product
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from rigdesign.base.errors import OutputError, UsageError
from rigdesign.case import load_case
from rigdesign.case.shipped import case_folder
from rigdesign.cli.commands.validate import validate
from rigdesign.cli.terminal.validation import print_validation
from rigdesign.report.pages.validation import write_validation
from rigdesign.results.result import RunResult
from rigdesign.validation import headline, published_rows, validation_document
from tests.builders.report import make_result
from tests.builders.rig import TABLE_2
from tests.published import benchmarks, films, gears, main_rig, mechanics, p1, prototype, response
from tests.published.prototype import Prototype
from tests.published.rows import (
    Gate,
    Goal,
    PublishedQuantity,
    Window,
    compare,
    compare_printed,
    not_modelled,
)
from tests.published.run_rows import run_rows
from tests.published.speed_sweeps import FINE, SpeedSweep, simulation_laws, smooth, speed_sweep
from thermal.conduction.balance import HeatFlow

KEYS = {
    "id", "quantity", "source", "published", "computed", "unit", "deviation", "tolerance", "verdict", "basis",
    "free_parameters", "assumptions",
}  # fmt: skip


def quantity(**changes):
    given = {"id": "x", "text": "q", "source": "s", "value": 2.0, "unit": "1"}
    return PublishedQuantity(**{**given, **changes})


def row(criterion=None, *, computed=2.1, basis="predicted", **changes):
    """Row of a published 2.0, or of what ``changes`` say."""
    return compare(quantity(**changes), computed, basis, criterion)


@pytest.fixture(scope="module")
def rows():
    return published_rows()


@pytest.fixture(scope="module")
def shipped():
    return Prototype(case_folder())


# ---- what a row is


@pytest.mark.parametrize(
    ("criterion", "verdict"),
    [
        (None, "shown"),
        (Gate(0.051), "gate held"),
        (Gate(0.049), "gate missed"),
        (Goal(0.051), "goal met"),
        (Goal(0.049), "goal missed"),
        (Window(2.05, 2.15), "gate held"),
        (Window(2.11, 2.15), "gate missed"),
    ],
)
def test_verdict_of_a_comparison(criterion, verdict):
    assert row(criterion).verdict == verdict
    assert row(criterion).deviation == pytest.approx(0.05)


def test_a_gate_on_words_is_refused():
    with pytest.raises(ValueError, match="words have no deviation"):
        row(Gate(0.1), value=None, printed="low")


@pytest.mark.parametrize(
    ("published", "computed", "bound", "deviation"),
    [
        ((1.8, 1.9), 1.85, None, 0.0),
        ((1.8, 1.9), 1.71, None, -0.05),
        ((1.8, 1.9), 1.995, None, 0.05),
        (1.5, 1.8, "at least", 0.0),
        (1.5, 1.35, "at least", -0.1),
        (50.0, 20.0, "at most", 0.0),
        (50.0, 60.0, "at most", 0.2),
        (-105.0, -106.05, None, -0.01),
    ],
)
def test_deviation_counts_from_the_nearer_end_and_on_the_wrong_side_only(
    published, computed, bound, deviation
):
    assert row(value=published, computed=computed, bound=bound).deviation == pytest.approx(deviation)


@pytest.mark.parametrize(("computed", "verdict"), [(1.00349, "gate held"), (1.00351, "gate missed")])
def test_printed_digits_are_half_a_unit_of_the_last(computed, verdict):
    found = compare_printed(quantity(value=None, printed="1.003"), computed)
    assert found.verdict == verdict
    assert found.published_text == "1.003"


def test_words_have_no_deviation_and_a_missing_model_no_number():
    words = row(Window(2.5, math.inf), computed=2.0, value=None, printed="low")
    assert (words.deviation, words.verdict) == (None, "gate missed")
    missing = not_modelled(quantity(value=None, printed="1.03"), "fitted", reason="no model")
    assert (missing.computed, missing.verdict, missing.published_text) == (None, "not modelled", "1.03")


# ---- the table


def test_every_gate_holds(rows):
    assert [r.id for r in rows if r.verdict == "gate missed"] == []
    assert sum(r.verdict == "gate held" for r in rows) > 50


def test_what_the_case_states_is_no_gate(rows):
    """A number that is put in comes out: it may not count among the gates that hold."""
    gates = [
        r.id for r in rows if r.basis in ("input", "arithmetic") and r.verdict in ("gate held", "gate missed")
    ]
    assert not set(gates) & {"P2-eps-TG", "P2-alpha-bearing", "P2-ramp-rules"}


@pytest.mark.parametrize(
    ("gap", "wheel", "verdicts"), [(0.55, 0.39, "goal met"), (0.44, 0.38, "goal missed")]
)
def test_expansion_of_the_main_rig_is_held_to_one_goal(gap, wheel, verdicts):
    """0.44 mm for the printed 0.6 is 27 % off, 0.38 mm for 0.43 12 %: both miss; 0.55 and 0.39 do not. The gap is the
    mean, as P2 has one; the least stands beside it as our own finding."""
    expansion = SimpleNamespace(
        shafts=[{"shaft": "test_pinion", "growth_mm": 0.53}, {"shaft": "test_wheel_a", "growth_mm": wheel}],
        seal_gaps=[
            {"hot_mean_mm": gap - 0.01, "hot_min_mm": 0.41},
            {"hot_mean_mm": gap + 0.01, "hot_min_mm": 0.43},
        ],
    )
    thermal = SimpleNamespace(heat=[], max_temperature=451.15, max_temperature_body="gear")
    result = cast(RunResult, SimpleNamespace(thermal=[thermal], expansion=[expansion]))
    rows = {row.id: row for row in main_rig.main_rig_rows(lambda _: result)}
    assert rows["P2-growth-seal-gap"].computed == pytest.approx(gap)
    assert "ours is 0.41 mm at its narrowest" in rows["P2-growth-seal-gap"].assumptions
    found = {name: row.verdict for name, row in rows.items()}
    assert found["P2-growth-pinion"] == "goal met"
    assert found["P2-growth-wheel"] == found["P2-growth-seal-gap"] == verdicts


def test_a_number_that_nobody_printed_is_no_gate(rows):
    """P2's 20 K are those of the warm gear oil; for K_V of the reference gear's main resonance it prints none."""
    by_id = {r.id: r for r in rows}
    rises = [r for r in rows if r.id.startswith("P2-oil-") and r.unit == "K"]
    assert len(rises) == 3
    for r in rises:
        assert (r.verdict, r.window, r.tolerance) == ("shown", None, None)
        assert r.deviation == pytest.approx(r.computed / 20.0 - 1.0) and r.deviation < 0.0
        assert "density and heat capacity" in r.assumptions and "warm gear oil" in r.assumptions
    main = by_id["P2-KVsim-RG-main"]
    assert (main.published, main.deviation, main.verdict) == (None, None, "shown")
    assert "no number" in main.published_text
    assert by_id["P2-KV-RG-super"].published == 1.32


def test_what_follows_from_table_2_is_fitted(rows):
    """The shafts are fitted to Table 2: their crossings, and the peaks of a loop made of them, predict nothing."""
    follows = [r for r in rows if r.id.startswith(("P2-T2-", "P2-cross-", "P2-peak-"))]
    assert len(follows) == 12 + 10 + 7
    assert all(r.basis == "fitted" and r.free_parameters >= 10 for r in follows)


def figure_12() -> RunResult:
    """A run that meets every number of the figure."""
    heat = [
        HeatFlow(surface=surface, kind=kind, power=-power, area=1.0, mean_temperature=323.15, piece=0)
        for _, _, power, kind, surfaces in main_rig.HEAT
        for surface in (surfaces[0],)
    ]
    thermal = SimpleNamespace(heat=heat, max_temperature=451.74, max_temperature_body="gear")
    expansion = SimpleNamespace(
        shafts=[{"shaft": shaft, "growth_mm": value} for _, shaft, value in main_rig.EXPANSION],
        seal_gaps=[{"hot_mean_mm": 0.7, "hot_min_mm": 0.5}, {"hot_mean_mm": 0.5, "hot_min_mm": 0.4}],
    )
    return cast(RunResult, SimpleNamespace(thermal=[thermal], expansion=[expansion]))


def test_figure_12_is_shown_for_both_readings_of_the_main_rig():
    """One row per printed number and reading, from the results of runs made up here."""
    asked = []

    def run(reading: str) -> RunResult:
        asked.append(reading)
        return figure_12()

    found = list(main_rig.main_rig_rows(run))
    assert asked == ["as_published", "fitted"]
    assert len(found) == 2 * len({row.id.removesuffix("-printed") for row in found}) == 20
    goals = {row.id: row.tolerance for row in found}
    assert goals["P2-growth-pinion"] == goals["P2-growth-wheel"] == goals["P2-growth-seal-gap"] == 0.1
    assert all(row.deviation == pytest.approx(0.0, abs=1e-12) and row.basis == "fitted" for row in found)


def made_up_sweep(*_, **__):
    """One peak of both meshes at 3000 rpm, in place of the periodic response over speed."""
    factor = 1.0 + 0.3 / (1.0 + ((FINE - 3000.0) / 60.0) ** 2)
    both = np.column_stack([factor, factor])
    return SpeedSweep(
        speed=FINE, factor=both, half=both, mean=np.full(both.shape, 180.0), drive=np.ones(FINE.size)
    )


PRINTED = {
    # "Comparison of MBS and standard" and Figure 8
    "P2-nE-TG": 2953.48, "P2-nE-RG": 3069.1, "P2-eps-TG": 1.26, "P2-eps-RG": 5.59,
    "P2-KV-TG-2500": 1.25, "P2-KV-TG-main": (1.8, 1.9), "P2-KV-TG-super": 0.87, "P2-KV-RG-super": 1.32,
    "P2-KVsim-TG-sub": 1.5, "P2-KVsim-TG-main": 1.3, "P2-KVsim-TG-super": 1.2, "P2-KVsim-RG-super": 1.008,
    # torques of Figure 7 and of the drive [N m], resonance speed of the simulation [rpm]
    "P2-dM-TG-max-mean": 150.0, "P2-dM-TG-max-min": 150.0, "P2-dM-TG-3000-max-mean": 50.0,
    "P2-dM-TG-3000-max-min": 50.0, "P2-dM-RG-max-mean": 50.0, "P2-dM-RG-max-min": 50.0,
    "P2-drive": 9.0, "P2-nE-RG-sim": 3069.1,
    # Figure 11 and Formula 4 [W/(m2 K)], oil flow of Figure 4 [l/min]
    "P2-alpha-warm": 19.5, "P2-alpha-cold": 15.09, "P2-alpha-field-turbulent": 6.3,
    "P2-alpha-field-dimensional": 6.3, "P2-alpha-gears": 150.0, "P2-alpha-contact": 75.0, "P2-alpha-nut": 68.0,
    "P2-alpha-bearing": 1240.41, "P2-oil-flow": 750.0,
    # Figure 12 [W, degC] and the text beside it [mm]
    "P2-heat-sum": 4200.0, "P2-heat-field-radiation": 706.0, "P2-heat-housing-radiation": 617.0,
    "P2-heat-field-convection": 1179.0, "P2-heat-field-radiation-model": 706.0, "P2-heat-housing-warm": 800.0,
    "P2-heat-housing-cold": 962.0, "P2-heat-housing-radiation-model": 617.0, "P2-heat-bearings": 345.23,
    "P2-Tmax": 178.59, "P2-growth-pinion": 0.53, "P2-growth-wheel": 0.43, "P2-growth-seal-gap": 0.6,
}  # fmt: skip
"""Read off P2, by the row that holds it against ours."""


@pytest.fixture(scope="module")
def response_rows(shipped):
    """Rows of a response that is made up: what they hold ours against."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(response, "speed_sweep", made_up_sweep)
        return list(response.response_rows(shipped))


def test_rows_hold_what_the_paper_prints(shipped, response_rows):
    found = {
        row.id: row.published
        for row in (
            *gears.gear_rows(shipped), *response_rows, *films.film_rows(),
            *main_rig.main_rig_rows(lambda _: figure_12()),
        )
    }  # fmt: skip
    assert {name: found[name] for name in PRINTED} == PRINTED
    for name, reading in product(("TG-sub", "TG-main", "TG-super", "RG-super"), response.READINGS):
        assert found[f"P2-KVsim-{name}-{reading}"] == PRINTED[f"P2-KVsim-{name}"]


def test_resonances_are_those_of_table_2(response_rows):
    """P2 names shaft, mode and harmonic of each: 60 f / (99 h) rpm."""
    found = {row.id: row.published for row in response_rows}
    for name, shaft, mode, harmonic in (
        ("TG-2", "test_pinion", 1, 2), ("TG-3", "test_wheel", 1, 2), ("RG-1", "reference_pinion", 1, 2),
        ("RG-2-h3", "reference_pinion", 2, 3), ("RG-2-h2", "reference_pinion", 2, 2),
        ("RG-3", "reference_pinion", 1, 1), ("RG-4", "reference_pinion", 2, 1),
    ):  # fmt: skip
        speed = 60.0 * TABLE_2[shaft][mode - 1] / (99.0 * harmonic)
        assert found[f"P2-peak-{name}"] == pytest.approx(speed, abs=0.51)


def test_film_of_the_nut_by_hand():
    """12,000 rpm are 1256.6 rad/s, of a shaft of 80 mm 50.3 m/s; Jungnickel's two films in series."""
    cylinder = 3.75 * 1256.637**0.7 * 0.040**0.4
    gap = 0.765 * 50.2655**0.666 / 0.6e-3**0.333
    nut = next(row for row in films.film_rows() if row.id == "P2-alpha-nut")
    assert nut.computed == pytest.approx(cylinder * gap / (cylinder + gap), rel=1e-6)


IN_VIEW_OF_FIGURE_12 = {
    "gearboxes.test.housing.boundary.plate_air.heat_transfer_coefficient": "top and sides: P2 prints more",
    "gearboxes.test.bearings.pinion_front.diameter": "P2's 68 W/(m2 K)",
    "gearboxes.test.bearings.pinion_front.width": "P2's heat flow asks for",
    "gearboxes.test.housing.shafts.test_pinion.bore_diameter": "more heat to the bearings than P2 prints",
    "gearboxes.test.housing.shafts.test_pinion.overhang_front": "its growth is 1.23 times that of the wheels",
    "gearboxes.test.housing.shafts.test_wheel_a.overhang_rear": "0.516 m long",
}
"""Some of the values of the main rig as published that P2 leaves open, each with the reason the case gives for it."""


def test_free_parameters_of_the_main_rig_are_what_its_files_assume():
    """Counted by one rule: (key, value) that the file of a reading assumes and case.toml does not."""
    reasons = {one.path: one.reason for one in load_case("cases/uhcf_main/as_published.toml").assumptions}
    for path, reason in IN_VIEW_OF_FIGURE_12.items():
        assert reason in reasons[path]
    assert {name: main_rig.free_parameters(name) for name in main_rig.READINGS} == {
        "as_published": 16,
        "fitted": 20,
    }
    row = next(row for row in published_rows() if row.id == "P2-growth-seal-gap")
    assert row.free_parameters == 20


def test_speeds_without_a_response_are_told():
    nothing = np.zeros((2, 2))
    speed_sweep = SpeedSweep(
        speed=np.array([1000.0, 3000.0]), factor=nothing, half=nothing, mean=nothing, drive=np.zeros(2),
        missing=(2000.0, 2050.0, 9000.0),
    )  # fmt: skip
    assert speed_sweep.left_out((750.0, 2500.0)) == " (2 speeds without a periodic response: 2000, 2050 rpm)"
    assert speed_sweep.left_out((3000.0, 4000.0)) == ""


def test_every_number_of_the_brief_has_its_row(rows):
    ids = [r.id for r in rows]
    assert len(ids) == len(set(ids))
    wanted = (
        "P2-nE-TG", "P2-nE-RG", "P2-nE-RG-low-load", "P2-KV-TG-2500", "P2-KV-TG-main", "P2-KV-TG-super",
        "P2-KV-RG-super", "P2-eps-TG", "P2-eps-RG-full", "P2-cross-RG-4", "P2-KVsim-TG-sub", "P2-KVsim-RG-super",
        "P2-KVsim-TG-sub-unscaled", "P2-dM-TG-max-mean", "P2-dM-TG-3000-max-min", "P2-free-reference",
        "P2-free-influence-reference", "P2-ramp-half-torque", "P2-alpha-warm", "P2-alpha-cold", "P2-alpha-nut",
        "P2-alpha-bearing", "P2-heat-sum", "P2-heat-field-radiation", "P2-heat-bearings", "P2-Tmax",
        "P2-growth-pinion", "P2-oil-FVA 3A", "P2-oil-flow", "P2-sampling", "P1-eps-free", "P1-eps-loaded",
        "P1-sigma", "P1-static-MBS", "P1-coupling", "P1-speed-measured", "P1-pattern-140", "P1-pattern-shift",
        "TR6336-30-1-c_gamma_alpha",
        "TR6336-30-1-sigma_H0", "NAFEMS-T2", "NAFEMS-T4", "NAFEMS-T-axi", "NAFEMS-LE11", "V4-up-0.85", "V4-down-0.75",
        "V5-rotor",
        "V11-energy-control", "V12-closure", "V12-momentum", "FZG-C-HV",
    )  # fmt: skip
    assert [name for name in wanted if name not in ids] == []
    assert sum(name.startswith("P2-T2-") for name in ids) == 12


def test_rows_say_what_they_rest_on(rows):
    for r in rows:
        assert r.quantity
        assert r.source
        assert r.assumptions or r.basis == "verification"
        assert (r.computed is None) == (r.verdict == "not modelled")
        assert r.computed is None or math.isfinite(r.computed)
        if r.basis == "fitted" and r.id.startswith("P2"):
            assert r.free_parameters > 0


def test_simulated_dynamic_factors_name_what_they_hang_on(rows):
    by_id = {r.id: r for r in rows}
    for name in ("TG-sub", "TG-main", "TG-super", "RG-super"):
        found = by_id[f"P2-KVsim-{name}"]
        assert found.tolerance == 0.15
        assert "mesh damping 300 N s/m" in found.assumptions
        assert found.computed > 1.0


def test_full_addendum_and_low_load_readings_as_calculated_in_the_sheet(rows):
    """Sheet d2: 5.96 to 5.98 with full addendum; n_E 3276 to 3394 then; 3027 to 3040 with x1 = 0 and the factor."""
    by_id = {r.id: r.computed for r in rows}
    assert 5.96 < by_id["P2-eps-RG-full"] < 5.98
    assert 3314.0 < by_id["P2-nE-RG-full"] < 3394.5
    assert 3276.0 < by_id["P2-nE-RG-full-low-load"] < 3354.5
    assert 3027.0 < by_id["P2-nE-RG-x1-0-low-load"] < 3040.0
    assert by_id["P2-nE-RG-x1-0"] == pytest.approx(3075.6, abs=0.5)


def test_headline_counts_predicted_rows_and_shows_the_others_by_basis():
    met, missed, plain = row(criterion=Goal(0.1)), row(criterion=Goal(0.01)), row()
    held, broken = (
        row(basis="fitted", criterion=Gate(0.1)),
        row(basis="verification", criterion=Window(3.0, 4.0)),
    )
    flattering, waiting = row(basis="fitted", criterion=Goal(0.1)), next(p1.own_curve_rows())
    assert headline([met, missed, plain, held, broken, flattering, waiting]) == {
        "rows": 7,
        "predicted_with_goal": 2,
        "predicted_met": 1,
        "gates": {"fitted": {"held": 1, "missed": 0}, "verification": {"held": 0, "missed": 1}},
        "goals": {"predicted": {"met": 1, "missed": 1}, "fitted": {"met": 1, "missed": 0}},
        "gates_held": 1,
        "gates_missed": 1,
        "goals_met": 2,
        "goals_missed": 1,
        "not_modelled": 1,
    }
    assert headline([row(criterion=Gate(0.1))])["predicted_met"] == 1


def test_document_keeps_the_contract_and_is_strict_json(rows):
    document = json.loads(json.dumps(validation_document(rows), allow_nan=False))
    assert len(document["rows"]) == len(rows)
    assert all(set(entry) >= KEYS for entry in document["rows"])
    bases = {entry["basis"] for entry in document["rows"]}
    assert bases <= {"predicted", "fitted", "arithmetic", "input", "verification"}
    control = next(entry for entry in document["rows"] if entry["id"] == "V11-energy-control")
    assert control["window"] == [0.3, None]


def test_files_are_written_whole(rows, tmp_path):
    write_validation(rows, tmp_path / "out")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "validation.csv",
        "validation.html",
        "validation.json",
    ]
    with (tmp_path / "out" / "validation.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    assert [line["id"] for line in table] == [r.id for r in rows]
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(OutputError):
        write_validation(rows, tmp_path / "file")


def test_table_and_headline_in_the_terminal(rows, capsys):
    missed = [
        row(id="broken", criterion=Gate(0.01)),
        row(id="far", criterion=Goal(0.02), unit="mm"),
        row(id="outside", criterion=Window(3.0, 4.0)),
    ]
    print_validation([*rows, *missed])
    printed = " ".join(capsys.readouterr().out.split())
    assert "P2-nE-TG" in printed
    assert "gate missed: broken, q, 2.1 against 2: +5.00 %, allowed 1 %" in printed
    assert "goal missed: far, q, 2.1 mm against 2: +5.00 %, allowed 2 %" in printed
    assert "gate missed: outside, q, 2.1 against 2, allowed 3 to 4" in printed
    assert "P1-static-MBS, P1-static-FE" in printed
    count = headline([*rows, *missed])
    assert (
        f"predicted rows within their goal: {count['predicted_met']} of {count['predicted_with_goal']}"
        in printed
    )
    for kind, good in (("gates", "held"), ("goals", "met")):
        for basis, found in count[kind].items():
            assert f"{basis} {found[good]} {good}, {found['missed']} missed" in printed
        assert f"{kind}: {count[f'{kind}_{good}']} {good}, {count[f'{kind}_missed']} missed (" in printed


def test_the_table_keeps_to_80_columns_and_breaks_no_word(rows, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    print_validation(rows)
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    words = {word.rstrip(";") for line in lines for word in line.split()}
    for shown in rows:
        said = (
            shown.id,
            shown.quantity,
            shown.published_text,
            shown.computed_text,
            shown.verdict,
            shown.basis,
        )
        assert {word.rstrip(";") for text in said for word in text.split()} <= words, shown.id


@pytest.mark.parametrize(("limit", "status"), [(0.1, 0), (0.01, 1)])
def test_command_fails_when_a_gate_is_missed_and_counts_a_missed_goal(limit, status, monkeypatch, capsys):
    made = (row(criterion=Gate(limit)), row(criterion=Goal(0.01)))
    monkeypatch.setattr("rigdesign.validation.published_rows", lambda: made)
    assert validate(json=True) == status
    document = json.loads(capsys.readouterr().out)
    assert document["rows"][0]["id"] == "x"
    assert document["headline"]["goals"] == {"predicted": {"met": 0, "missed": 1}}


# ---- parts


def test_prototype_is_found_or_the_places_are_named(monkeypatch, tmp_path):
    assert (case_folder() / "case.toml").is_file()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match="no_such_case"):
        case_folder("no_such_case")


def test_another_split_moves_the_resonance_speed(shipped):
    """x1 = 0 meets P2's 2953.48 rpm to 0.003 %, x1 = x2 is 0.66 % off: the split is fitted, not free."""
    first = gears.resonance_speed(shipped.test_pair, prototype.TEST_OPTIONS)
    assert first == pytest.approx(gears.TEST_RESONANCE, rel=5e-5)
    equal = gears.resonance_speed(shipped.equal_shifts, prototype.TEST_OPTIONS)
    assert equal / first - 1.0 == pytest.approx(0.0066, abs=5e-4)


def test_benchmark_gates_can_fail(monkeypatch):
    film = benchmarks.constant
    monkeypatch.setattr(benchmarks, "constant", lambda value, source: film(0.99 * value, source))
    verdicts = {r.id: r.verdict for r in benchmarks.heat_rows()}
    assert verdicts["NAFEMS-T2"] == "gate held"
    assert verdicts["NAFEMS-T4"] == "gate missed"


def test_smooth_meshes_excite_nothing(shipped):
    laws = [smooth(law) for law in simulation_laws(shipped)]
    found = speed_sweep(shipped, laws, np.array([900.0, 2400.0, 9000.0]))
    assert found.factor == pytest.approx(1.0, abs=1e-6)


def test_a_sweep_reads_peaks_and_amplitudes():
    speed = np.arange(1000.0, 2000.0, 50.0)
    factor = 1.0 + 0.3 / (1.0 + ((speed - 1500.0) / 60.0) ** 2)
    found = SpeedSweep(
        speed=speed,
        factor=np.column_stack([factor, np.ones_like(factor)]),
        half=np.column_stack([1.0 + 0.8 * (factor - 1.0), np.ones_like(factor)]),
        mean=np.full((speed.size, 2), 180.0),
        drive=np.zeros_like(speed),
    )
    assert found.peaks(0).tolist() == [1500.0]
    assert found.peaks(1).size == 0
    assert found.highest(0, (1000.0, 2000.0)) == pytest.approx((1.3, 1500.0))
    assert found.highest(0, (1000.0, 1200.0))[1] == 1200.0
    assert found.amplitude(0, (1000.0, 2000.0)) == pytest.approx((54.0, 86.4))


def test_series_stiffness_feels_every_part_of_the_loop(shipped):
    rig = shipped.simulated
    laws = [smooth(law) for law in simulation_laws(shipped)]
    whole = mechanics._series_stiffness(rig, laws)
    stiffer = mechanics._series_stiffness(
        rig, [law._replace(mean_stiffness=2.0 * law.mean_stiffness) for law in laws]
    )
    radius = laws[0].base_radius_1, laws[1].base_radius_1
    gained = sum(0.5 / (law.mean_stiffness * r**2) for law, r in zip(laws, radius))
    assert 1.0 / whole - 1.0 / stiffer == pytest.approx(gained)


def test_contact_of_the_strain_gauge_rig_is_as_its_paper_describes_it(rows):
    """1.24 at 238 N m within 2 %; P1's blank corners carry next to nothing at any torque, the pattern stands right."""
    by_id = {r.id: r for r in rows}
    assert by_id["P1-eps-loaded"].verdict == "goal met"
    assert by_id["P1-eps-free"].computed == pytest.approx(1.0, abs=0.01)
    assert all(by_id[f"P1-pattern-{torque}"].computed < 0.08 for torque in (140, 336, 483))
    assert by_id["P1-pattern-shift"].computed > 0.5


def test_stress_at_the_gauges_of_the_strain_gauge_rig(rows):
    """110.4 N/mm² at gauge II; P1 about 125. All maxima together."""
    by_id = {r.id: r for r in rows}
    assert by_id["P1-sigma"].computed == pytest.approx(110.4, abs=0.5)
    assert by_id["P1-sigma"].verdict == "goal missed"
    assert by_id["P1-maxima"].verdict == "goal met"
    assert by_id["P1-rise"].computed == pytest.approx(0.338, abs=0.01)


def test_rows_without_a_model_carry_the_published_text():
    for r in p1.own_curve_rows():
        assert r.verdict == "not modelled"
        assert r.published_text
        assert r.assumptions


# ---- rows of a run


def test_rows_of_a_run():
    found = {r.id: r for r in run_rows(make_result())}
    assert found["run-closure-test-dwell"].verdict == "gate held"
    assert found["run-Tmax-test-dwell"].computed == pytest.approx(178.6, rel=1e-12)
    assert found["run-loss-test_mesh"].computed == 2900.0
    assert found["run-loss-bearing"].computed == pytest.approx(690.0)
    assert found["run-drive"].computed == 9.1
    assert found["run-seal-gap-test-dwell"].computed == 0.59
    assert "0.57 mm at its narrowest" in found["run-seal-gap-test-dwell"].assumptions


def test_open_heat_balance_misses_its_gate():
    result = make_result()
    leaking = replace(result, thermal=[replace(result.thermal[0], closure_relative=2e-8)])
    found = {r.id: r for r in run_rows(leaking)}
    assert found["run-closure-test-dwell"].verdict == "gate missed"


def test_run_without_drivetrain_has_no_drive_rows():
    assert not any(r.id.startswith(("run-drive", "V12")) for r in run_rows(make_result(dynamics=None)))

"""The shipped cases give what they are expected to give, at the fidelity that a user gets without options.

``cases/<name>/expected.json`` lists the verdict of every check that applies, its value within 0.5 % (0.0005 of the
limit near zero) and one line of engineering reason. After a change that moves them for a good reason, run

    python -m tests.regression.expected

which carries verdicts and values over, and read the diff: its commit says why they moved; the reasons stay, or are
thought over again.
"""

import json
import re
import subprocess
import sys
import time
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.cli.terminal.checks import print_checks
from rigdesign.report.pages.report import report_html
from rigdesign.report.results_json import read_result, results_document
from rigdesign.report.writing import write_results
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult
from rigdesign.rig.model import build_rig
from rigdesign.run.main import run_case
from tests.builders.checks import check, rule_ids
from tests.builders.shared_runs import quick_run, shipped_run
from tests.builders.shortened import shortened_case
from tests.regression import expected
from tests.regression.expected import CASES, NAMES, NOT_APPLICABLE

PROTOTYPE = CASES / "uhcf_prototype"
NUMBER = r"\d+\.?\d*"
EXPECTED = {name: expected.read(name) for name in NAMES}


@cache
def shipped(name: str) -> RunResult:
    return shipped_run(name)


def prototype() -> RunResult:
    return shipped("uhcf_prototype")


MARKED = {name: [pytest.mark.slow] if name == "fzg" else [] for name in NAMES}
"""FZG at its default by hand: a minute and a half of a processor."""


@pytest.mark.parametrize("name", [pytest.param(name, marks=MARKED[name]) for name in NAMES])
def test_a_shipped_case_gives_what_is_expected(name: str) -> None:
    result, entries = shipped(name), EXPECTED[name]["checks"]
    applied = [check for check in result.checks if check.status != NOT_APPLICABLE]
    assert [check.id for check in applied] == list(entries)
    assert {check.id for check in result.checks} == rule_ids(load_case(CASES / name))
    assert all(check.value is None for check in result.checks if check.status == NOT_APPLICABLE)
    assert all(entry["reason"] for entry in entries.values())
    off = {
        check.id: (check.status, check.value, entries[check.id])
        for check in applied
        if check.status != entries[check.id]["verdict"]
        or not expected.agrees(entries[check.id]["value"], check)
    }
    assert off == {}
    assert result.verdict == EXPECTED[name]["verdict"]


VARIANTS = sorted(str(file.relative_to(CASES)) for file in CASES.glob("*/*.toml") if file.name != "case.toml")


@pytest.mark.slow
@pytest.mark.parametrize("name", [*NAMES, *VARIANTS])
def test_every_case_and_variant_runs_at_its_default(name: str, tmp_path: Path) -> None:
    """As a user starts it, in a process of its own; by hand and before every release. Prints status and time."""
    command = [sys.executable, "-m", "rigdesign", "check", str(CASES / name), "--out", str(tmp_path / "out")]
    started = time.perf_counter()
    ended = subprocess.run(command, capture_output=True, text=True)
    print(f"\n{name}: status {ended.returncode}, {time.perf_counter() - started:.0f} s")
    assert ended.returncode in (0, 1), ended.stderr
    assert (
        json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["fidelity"] == "standard"
    )


@pytest.mark.parametrize(("name", "fails"), [("uhcf_prototype", 5), ("loop_1to1", 4)])
def test_the_terminal_says_what_decides_on_one_screen(
    name: str, fails: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Under 26 lines of at most 80 columns, and four for each failing check."""
    monkeypatch.setenv("COLUMNS", "80")
    print_checks(shipped(name), Path("out"))
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) < 26 + 4 * fails and all(len(line) <= 80 for line in lines)
    assert lines[1].startswith(f"verdict: {shipped(name).verdict} (")
    assert sum(line.startswith("fail: ") for line in lines) == fails
    assert lines[-1] == "report: out/report.html"


@pytest.mark.parametrize(
    ("stored", "found", "same"),
    [
        (0.8, 0.8039, True),
        (0.8, 0.8041, False),
        (0.8, 0.7959, False),
        (0.02, 0.0204, True),
        (0.02, 0.0206, False),
        (0.0, 0.0, True),
        (None, None, True),
        (None, 0.0, False),
        (0.0, None, False),
        (0.8, float("nan"), False),
    ],
)
def test_values_agree_within_half_a_per_cent(stored: float | None, found: float | None, same: bool) -> None:
    assert expected.agrees(stored, replace(check("x"), value=found, limit=1.0)) is same


def test_expected_results_are_carried_over_with_their_reasons() -> None:
    def valued(name: str, value: float | None) -> Check:
        return replace(check(name), value=value, limit=1.0, verdict="open")

    entry = {"verdict": "pass", "value": 0.5, "reason": "as built"}
    old = {"verdict": "pass", "checks": dict.fromkeys(("kept", "moved", "gone"), entry)}
    idle = replace(valued("idle", None), verdict="not applicable")
    checks = [valued("moved", 0.61234567), valued("kept", 0.502), valued("new", None), idle]
    new = expected.renewed(old, "open", checks)
    assert new["verdict"] == "open"
    assert list(new["checks"].items()) == [
        ("moved", {"verdict": "open", "value": 0.612346, "reason": "as built"}),
        ("kept", {"verdict": "open", "value": 0.5, "reason": "as built"}),
        ("new", {"verdict": "open", "value": None, "reason": ""}),
    ]
    assert expected.renewed(old, "open", checks, every=True)["checks"]["kept"]["value"] == 0.502
    assert list(expected.changes(old, new)) == [
        "verdict pass -> open",
        "kept: pass 0.5 -> open 0.5",
        "moved: pass 0.5 -> open 0.612346 (+22.47 %)",
        "gone: gone",
        "new: new, reason to be written",
    ]


def test_the_report_of_the_prototype_stays_below_three_and_a_half_megabytes() -> None:
    """With its turnable picture, the drawing library in it, a still picture of every field and of the vibration."""
    page = report_html(prototype())
    assert 'id="viewer-library"' in page
    assert len(page.encode("utf-8")) < 3.5e6


@pytest.mark.parametrize("name", ["uhcf_main", "strain_gauge_rig"])
def test_a_result_is_written_and_its_report_made_again(name: str, tmp_path: Path) -> None:
    """All that stands in results.json and the files beside it is what the run shows."""
    write_results(shipped(name), tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    again, _ = read_result(tmp_path)
    (texts, numbers), (same_texts, same_numbers) = (parted(text) for text in (page, report_html(again)))
    assert texts == same_texts
    assert numbers == pytest.approx(same_numbers, rel=2e-3)


def parted(page: str) -> tuple[list[str], list[float]]:
    """Text of a page between its numbers, and these: ten digits of a result read again may round another way."""
    plain = re.sub(r"<(svg|script)\b.*?</\1>", "", page, flags=re.DOTALL)
    return re.split(NUMBER, plain), [float(number) for number in re.findall(NUMBER, plain)]


def test_heat_of_the_rig_closes() -> None:
    """Losses and heaters leave by cooler and room; what is open is the tolerance of the coupling loop."""
    for row in prototype().cooler:
        assert abs(row.imbalance) < 1e-4 * row.losses
    assert all(row.closure_relative < 1e-8 for row in prototype().thermal)


def test_motor_power_is_the_sum_of_all_losses() -> None:
    """Bearings, windage, oil, seals, squeezing, tooth friction and damping; joints take next to nothing."""
    assert prototype().dynamics is not None
    for row in prototype().dynamics.torque_balance:
        assert row.losses == pytest.approx(row.drive_power, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "file"), [("loop_1to1", "case.toml"), ("uhcf_prototype", "given_losses.toml")]
)
def test_two_runs_are_the_same_but_for_their_times(name: str, file: str) -> None:
    """A power loop, and a housing with its heat; one of the runs may be of another process."""
    again = run_case(load_case(CASES / name / file), fidelity="quick")
    first, second = (results_document(result) for result in (quick_run(name, file), again))
    for document in (first, second):
        document.pop("timings_s")
    assert json.dumps(first) == json.dumps(second)


def test_given_losses_leave_the_checks_of_loads_open() -> None:
    result = quick_run("uhcf_prototype", "given_losses.toml")
    assert result.dynamics is None
    of_loads = [
        check
        for check in result.checks
        if check.id.startswith(("dynamics.", "specimen.root_stress", "strength.", "flank."))
    ]
    assert {check.verdict for check in of_loads} == {"open", "not applicable"}
    for one in of_loads:
        if one.verdict == "open":
            assert one.reason == "losses are given (losses.basis = input): there are no dynamic loads"
    assert result.losses and all(row.basis == "input" for row in result.losses)


def test_full_addendum_raises_the_contact_ratio_of_the_reference_gear() -> None:
    rig = build_rig(load_case(PROTOTYPE / "full_addendum.toml"), "quick")
    assert rig.pairs["reference.main"].total_contact_ratio > 5.85


@pytest.mark.slow
def test_run_up_of_the_paper_breaks_its_own_ramp_rules() -> None:
    """180 N m at standstill: P2 does so for a more stable calculation, no rig could."""
    result = run_case(load_case(PROTOTYPE / "run_up_simulation.toml"), fidelity="quick")
    verdicts = {check.id: check.verdict for check in result.checks}
    assert verdicts["ramp.start_torque"] == verdicts["ramp.run_up_torque"] == "fail"
    assert result.dynamics is not None and result.dynamics.ramp is not None
    assert max(result.dynamics.ramp.speed_rpm) == pytest.approx(12000.0, rel=0.01)
    assert max(abs(torque) for torque in result.dynamics.ramp.drive_torque_Nm) == pytest.approx(9.0, rel=1e-3)


@pytest.mark.slow
def test_events_of_the_prototype_reach_every_check_that_depends_on_them() -> None:
    """Two teeth lost load the loop more than one, both more than the stages; a torque flange at 220 N m misses one lost
    tooth. At the held stage the time run has the torques of the periodic response: within 3 % of the loop's torque."""
    result = run_case(shortened_case(load_case(PROTOTYPE / "events.toml")), fidelity="quick")
    checks = {check.id: check for check in result.checks}
    verdicts = {name: check.verdict for name, check in checks.items() if name.startswith("event.")}
    assert verdicts.pop("event.trip_time_maximum.one_tooth") == "fail"
    assert set(verdicts.values()) == {"pass"} and len(verdicts) == 16
    flange = [checks[f"bought_part{key}.torque_flange"].value for key in ("", "_event")]
    assert flange[0] is not None and flange[1] is not None and 180.0 < flange[0] < flange[1] < 400.0
    peaks = {
        event.name: {(row.place, row.quantity): row.peak for row in event.peaks} for event in result.events
    }
    one, two = (peaks[name]["test.pinion", "seat torque"] for name in ("one_tooth", "two_teeth"))
    assert 1.5 * 180.0 < one < two
    assert result.dynamics is not None and result.dynamics.section_torques is not None
    for row in result.dynamics.section_torques["held"]:
        assert row["time_run_peak_Nm"] == pytest.approx(row["peak_Nm"], abs=0.03 * 180.0)

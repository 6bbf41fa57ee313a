"""The terminal of check: one screen that loses no failing check, or everything."""

import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from rigdesign.cli.application import print_json
from rigdesign.cli.terminal.checks import print_checks, reason_groups
from rigdesign.cli.terminal.console import plain_streams, verbosity
from rigdesign.report.pages.report import report_html
from rigdesign.results.check import Check, Finding
from rigdesign.results.ranges import RangesResult
from rigdesign.results.result import RunResult
from tests.builders.report import make_check, make_result, small_result

Printed = Callable[..., list[str]]
NO_HOUSING = "walls of gearbox reference: it has no housing"
UNEXPANDED = "thermal expansion of gearbox reference: its housing is not expanded"


@pytest.fixture
def printed(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Printed:
    """Lines of a result in a terminal of 80 columns."""
    monkeypatch.setenv("COLUMNS", "80")

    def lines(result: RunResult, *, everything: bool = False, out: Path | None = None) -> list[str]:
        print_checks(result, out, everything=everything)
        return capsys.readouterr().out.splitlines()

    return lines


def left_out(number: int, *texts: str) -> list[Check]:
    """Checks that are open because of what their values leave out."""
    reason = "; ".join(f"leaves out {text}" for text in texts)
    return [
        make_check(
            f"left.out_{n}", 1.0, 4.0 + n, verdict="open", left_out=texts, reason=f"somewhere; {reason}"
        )
        for n in range(number)
    ]


def notes(number: int) -> list[Finding]:
    return [Finding(id="loss", text=f"note {n} " + "x" * 200) for n in range(number)]


def failing(number: int) -> list[Check]:
    return [
        make_check(f"failing.check_{n}", 3.0, 1.0, title=f"failing check {n}", reason="word " * 30 + "; more")
        for n in range(number)
    ]


def test_a_screen_of_eighty_columns_holds_what_decides(printed: Printed) -> None:
    near = [make_check(f"near.check_{n}", 0.5 + 0.05 * n, 1.0) for n in range(8)]
    checks = [*failing(2), *left_out(16, NO_HOUSING), *left_out(3, "a long word " * 5 + ": why"), *near]
    lines = printed(small_result(checks=checks, warnings=notes(26)), out=Path("out"))
    assert len(lines) < 30 and all(len(line) <= 80 for line in lines)
    assert lines[1] == "verdict: fail (2 fail, 19 open, 8 pass)"
    assert sum(line.startswith("fail: ") for line in lines) == 2
    assert any("16 checks leave out walls of gearbox reference: it has no housing" in line for line in lines)
    table = next(number for number, line in enumerate(lines) if line.startswith("nearest margins"))
    assert [line.split()[0] for line in lines[table + 1 : table + 6]] == [
        f"near.check_{n}" for n in (7, 6, 5, 4, 3)
    ]
    assert lines[-2:] == ["notes: 26 loss; --all prints them and every check", "report: out/report.html"]


def test_every_failing_check_is_printed_with_value_limit_and_reason(printed: Printed) -> None:
    lines = printed(small_result(checks=failing(40)))
    for number in range(40):
        [at] = [
            n for n, line in enumerate(lines) if line == f"fail: failing check {number}: 3 mm, limit ≤ 1 mm"
        ]
        assert lines[at + 1].startswith("      word word") and "more" not in lines[at + 2]


def test_everything_prints_every_check_and_every_note(printed: Printed) -> None:
    checks = [*failing(1), *left_out(2, NO_HOUSING), make_check("held.check", 0.2, 1.0, title="holds")]
    absent = make_check("no.limit", 1.0, 1.0, verdict="not applicable", reason="the case states no limit")
    lines = printed(small_result(checks=[*checks, absent], warnings=notes(3)), everything=True)
    text = "\n".join(lines)
    assert "holds" in text and text.count("note loss: ") == 3
    assert text.count("open: left.out") == 2
    assert "not applicable: no.limit: the case states no limit" in text


def test_everything_names_every_check_by_its_id(printed: Printed) -> None:
    """As `explain --check` and `study --checks` take it."""
    names = ("strength.root_safety_path.reference.pinion", "oil.flow", "failing.check_0", "left.out_0")
    title = "a title of more words than fit into one line of the table"
    held = [make_check(name, 0.2, 1.0, title=title) for name in names[:2]]
    checks = [*held, *failing(1), *left_out(1, NO_HOUSING)]
    absent = make_check("no.limit", 1.0, 1.0, verdict="not applicable", title="absent", reason="no limit")
    lines = printed(small_result(checks=[*checks, absent]), everything=True)
    assert max(map(len, lines)) <= 80
    rows = [line.split() for line in lines]
    verdicts = {row[0]: row[-1] for row in rows if row and row[0] in names}
    assert verdicts == {**dict.fromkeys(names[:2], "pass"), "failing.check_0": "fail", "left.out_0": "open"}
    assert "not applicable: no.limit: no limit" in lines
    flow = next(number for number, row in enumerate(rows) if row[:1] == ["oil.flow"])
    assert rows[flow][1:-1] == ["0.8", "mm", "80", "%"]
    assert lines[flow + 1].startswith("  a title of more words") and lines[flow + 1].endswith(
        "0.2 mm  ≤ 1 mm"
    )


def test_checks_by_definition_are_no_near_margins(printed: Printed) -> None:
    """Whatever they use of their limit; a predicted value at its limit is one."""
    stated = [
        make_check("ramp.test_torque", 180.0, 180.0, unit="N m", by_definition=True),
        make_check("bought_part.rig_speed", 9000.0, 12000.0, unit="rpm", by_definition=True),
    ]
    lines = printed(small_result(checks=[*stated, make_check("near.check", 0.999, 1.0)]))
    assert not any(line.startswith(("ramp.test_torque", "bought_part.rig_speed")) for line in lines)
    assert any(line.startswith("near.check") for line in lines)
    assert "2 checks of one input against another: not in this list" in lines


def test_a_limit_of_a_power_stands_in_the_unit_of_its_value(printed: Printed) -> None:
    lines = printed(small_result(checks=[make_check("oil.cooler", 226200.0, 250000.0, unit="W")]))
    [row] = [line for line in lines if line.startswith("oil.cooler")]
    assert "226.2 kW" in row and "250 kW" in row


def test_what_does_not_apply_is_counted_by_its_reason(printed: Printed) -> None:
    checks = [
        make_check(f"absent.{n}", 1.0, 1.0, verdict="not applicable", reason=reason)
        for n, reason in enumerate(["no limit"] * 3 + ["no housing"] * 2 + ["a", "b"])
    ]
    lines = printed(small_result(checks=checks))
    assert lines[2:5] == [
        "3 not applicable: no limit",
        "2 not applicable: no housing",
        "2 not applicable for other reasons",
    ]


def test_quiet_leaves_the_line_of_the_verdict(printed: Printed) -> None:
    before = verbosity.set("quiet")
    try:
        assert printed(small_result(checks=failing(2)), out=Path("out")) == ["verdict: fail (2 fail)"]
    finally:
        verbosity.reset(before)


def test_ends_of_ranges_without_a_result_are_named(printed: Printed) -> None:
    ranges = RangesResult(
        fidelity="quick",
        method="two ends",
        inputs=[],
        checks=[],
        margins=[],
        max_temperature=None,
        left_out=[],
    )
    lines = printed(replace(small_result(checks=failing(1)), ranges=ranges), everything=True)
    assert "ranges: two ends" in lines


# ---------------------------------------------------------------------------- open checks and flags by reason


def texts(*checks: Check) -> list[str]:
    return [group.text for group in reason_groups(checks)]


def test_open_checks_of_one_gearbox_are_one_group() -> None:
    checks = [*left_out(2, NO_HOUSING), *(replace(c, id=f"x{c.id}") for c in left_out(3, UNEXPANDED))]
    assert texts(*checks) == ["5 checks leave out effects in gearbox reference: it has no housing"]


def test_two_gearboxes_that_the_same_checks_leave_out_are_one_group() -> None:
    checks = left_out(3, NO_HOUSING, NO_HOUSING.replace("reference", "test"))
    assert texts(*checks) == ["3 checks leave out effects in gearbox reference and test: it has no housing"]


def test_every_cause_of_an_open_check_and_every_flag_is_named() -> None:
    near = make_check("near", 0.97, 1.0, flags=("close",))
    mesh = make_check("mesh", 0.5, 1.0, verdict="open", error=0.7)
    decided = make_check(
        "decided", 0.5, 1.0, verdict="open", reason="there; decided by assumption a.b = 3 mm"
    )
    broken = make_check("broken", 2.0, 1.0, flags=("advisory",))
    doubt = make_check("doubt", 0.5, 1.0, flags=("doubt",), reason="there; two methods differ")
    beyond = make_check(
        "beyond", 0.5, 1.0, verdict="open", reason="there; outside of the range of the formula"
    )
    assert texts(near, mesh, decided, broken, doubt, beyond) == [
        "mesh has a margin below the error of its value",
        "decided is decided by assumption a.b = 3 mm",
        "beyond: outside of the range of the formula",
        "near has less than 5 % of its limit left",
        "broken misses a limit that does not bind",
        "doubt: two methods differ",
    ]
    assert [group.head for group in reason_groups([near, mesh, broken])] == ["open", "close", "advisory"]


def test_no_reason_is_lost() -> None:
    checks = [*left_out(4, NO_HOUSING, "the rest"), make_check("near", 0.97, 1.0, flags=("close",))]
    grouped = {check.id for group in reason_groups(checks) for check in group.checks}
    assert grouped == {check.id for check in checks}
    assert texts(make_check("held", 0.5, 1.0)) == []


# ---------------------------------------------------------------------------- streams without the signs


def test_a_stream_in_ascii_prints_words_for_signs(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr("sys.stdout", stream)
    plain_streams()
    print("5.032 × 10⁸ ≥ 1\u202f000 N/mm², 20 °C, 3 µm, −4 … 5, 10⁻³, 漢", flush=True)
    printed = stream.buffer.getvalue().decode("ascii")  # type: ignore[attr-defined]
    assert printed == "5.032 x 10^8 >= 1 000 N/mm2, 20 degC, 3 um, -4 ... 5, 10^-3, ?\n"


def test_json_stays_whole_in_a_stream_in_ascii(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr("sys.stdout", stream)
    plain_streams()
    print_json({"unit": "°C"})
    stream.flush()
    assert json.loads(stream.buffer.getvalue()) == {"unit": "°C"}  # type: ignore[attr-defined]


def test_unusual_inputs_stand_on_the_screen_and_on_the_first_page(printed: Printed) -> None:
    """A wrong power of ten on the permissive side is in no group of reasons that may be cut off."""
    found = [Finding(id="unusual_input", text="ambient.temperature = 293 degC is outside of its usual range")]
    result = make_result(warnings=found)
    assert any(line.startswith("unusual: ambient.temperature = 293 degC") for line in printed(result))
    page = report_html(result)
    assert "ambient.temperature = 293" in page[: page.index("<h2>Why</h2>")]

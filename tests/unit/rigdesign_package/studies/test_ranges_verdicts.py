"""Verdicts over ranges from made-up ends: shifts, what decides a check, ends without a result, the report."""

from dataclasses import replace

import pytest

from rigdesign.case.fields import MODEL_PARTS
from rigdesign.report.figures.ranges import margins_figure
from rigdesign.report.pages.report import report_html
from rigdesign.report.results_json import results_document
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult
from rigdesign.studies.assumed_ranges import CheckAtEnd, EndResult, RangeEnd, joined
from rigdesign.studies.modified_rig import parts_of
from tests.builders.report import make_check, make_result

GAP, OIL = "gearboxes.test.seals.gap", "gearboxes.test.oil.flow"


def end(path: str, which: str, value: str) -> RangeEnd:
    return RangeEnd(
        path=path, together_with=(), end=which, value=value, stated="5", parts=("coupling",), case=None
    )  # type: ignore[arg-type]


def at(margin: float, used: float, verdict: str = "pass") -> CheckAtEnd:
    return CheckAtEnd(value=0.0, margin=margin, distance=1.0 - used, verdict=verdict)  # type: ignore[arg-type]


def outcome(hottest: float | None = 150.0, error: str | None = None, **checks: CheckAtEnd) -> EndResult:
    return EndResult(checks=checks, max_temperature=hottest, parts=("coupling",), error=error)


def ranged(stated: EndResult, ends: list[tuple[RangeEnd, EndResult]], *checks: Check) -> RunResult:
    slim = make_result(
        checks=list(checks), verdict="pass", dynamics=None, fields=[], expansion=[], losses=[], oil=[]
    )
    return joined(slim, stated, ends, [])


GAP_CHECK = replace(make_check("seal_gap", 0.55, 0.5, comparison=">="), assumptions=(GAP, OIL))
"""Margin 0.05 mm."""
STATED = outcome(seal_gap=at(0.04, 0.5 / 0.54))
"""The same at quick fidelity: 0.01 mm less."""


def both(path: str, low: EndResult, high: EndResult) -> list[tuple[RangeEnd, EndResult]]:
    return [(end(path, "low", "4 mm"), low), (end(path, "high", "6 mm"), high)]


def test_a_margin_at_an_end_is_that_of_the_run_plus_what_the_end_changes() -> None:
    ends = both(GAP, outcome(seal_gap=at(0.02, 0.5 / 0.52)), outcome(seal_gap=at(0.06, 0.5 / 0.56)))
    result = ranged(STATED, ends, GAP_CHECK)
    assert result.ranges is not None
    (row,) = result.ranges.margins
    assert (row.margin_low, row.margin_high) == (pytest.approx(0.03), pytest.approx(0.07))
    assert result.checks[0].verdict == result.verdict == "pass"
    (line,) = result.ranges.checks
    assert line.worst_margin == pytest.approx(0.03) and line.worst_value == "4 mm"
    assert line.all_worst_margin == pytest.approx(0.03)
    assert line.decided_by == ()


def test_a_check_that_fails_at_an_end_is_open_and_names_the_assumption() -> None:
    """0.055 mm are lost between the stated value and the end; the run has 0.05 mm."""
    broken = outcome(seal_gap=at(-0.015, 1.03, "fail"))
    result = ranged(STATED, both(GAP, broken, STATED), GAP_CHECK)
    assert result.checks[0].verdict == "open" and result.verdict == "open"
    assert f"decided by assumption {GAP}: fails at 4 mm (margin -0.005 mm)" in result.checks[0].reason
    assert result.ranges is not None
    assert result.ranges.checks[0].decided_by == (GAP,)
    assert result.ranges.inputs[0].changes == ("seal_gap",)
    assert (result.ranges.margins[0].verdict_low, result.ranges.margins[0].verdict_high) == ("fail", "pass")


def test_what_breaks_at_quick_and_holds_at_the_run_holds() -> None:
    result = ranged(STATED, both(GAP, outcome(seal_gap=at(-0.005, 1.01, "fail")), STATED), GAP_CHECK)
    assert result.checks[0].verdict == "pass"
    assert result.ranges is not None
    assert result.ranges.margins[0].verdict_low == "pass"
    assert result.ranges.margins[0].margin_low == pytest.approx(0.005)


def test_a_check_that_fails_as_stated_stays_failed_and_says_where_it_would_hold() -> None:
    failing = replace(make_check("seal_gap", 0.45, 0.5, comparison=">="), assumptions=(GAP,))
    stated = outcome(seal_gap=at(-0.05, 1.11, "fail"))
    result = ranged(stated, both(GAP, stated, outcome(seal_gap=at(0.05, 0.9))), failing)
    assert result.checks[0].verdict == result.verdict == "fail"
    assert f"{GAP}: would hold at 6 mm (margin 0.05 mm)" in result.checks[0].reason
    assert result.ranges is not None and result.ranges.checks[0].decided_by == (GAP,)


def test_an_end_without_a_result_makes_what_depends_on_it_open() -> None:
    other = replace(make_check("backlash", 0.1, 0.02, comparison=">="), assumptions=(OIL,))
    stated = outcome(seal_gap=at(0.04, 0.9), backlash=at(0.08, 0.2))
    lost = outcome(None, "coupling did not converge\nin 30 passes")
    result = ranged(stated, both(GAP, lost, stated), GAP_CHECK, other)
    assert [check.verdict for check in result.checks] == ["open", "pass"]
    assert (
        f"no result at {GAP} = 4 mm, on which it depends: coupling did not converge"
        in result.checks[0].reason
    )
    assert result.ranges is not None
    assert result.ranges.inputs[0].low_error == "coupling did not converge\nin 30 passes"
    assert result.ranges.inputs[0].max_temperature_low_degC is None


def test_round_off_between_two_solutions_decides_nothing() -> None:
    """A rule met to the digit (a commanded speed) is not broken by the last bit of a second solution."""
    exact = replace(make_check("seal_gap", 0.5, 0.5, comparison=">="), assumptions=(GAP,))
    stated = outcome(seal_gap=at(1e-3, 0.98))
    result = ranged(stated, both(GAP, outcome(seal_gap=at(1e-3 - 1e-14, 0.98)), stated), exact)
    assert result.checks[0].verdict == "pass"


def test_temperatures_and_shifts_add_up_over_the_inputs() -> None:
    """Stated 150 at quick; the run has its own. GAP: -8/+3, OIL: +5/-1: from -8 to +5, both warm ends +8."""

    def hot(value: float, margin: float) -> EndResult:
        return outcome(value, seal_gap=at(margin, 0.9))

    ends = [*both(GAP, hot(142.0, 0.03), hot(153.0, 0.05)), *both(OIL, hot(155.0, 0.02), hot(149.0, 0.05))]
    result = ranged(STATED, ends, GAP_CHECK)
    assert result.ranges is not None and result.ranges.max_temperature is not None
    hottest = max(row.max_temperature - 273.15 for row in result.thermal)
    found = result.ranges.max_temperature
    assert (found.stated_degC, found.low_degC, found.high_degC) == (hottest, hottest - 8.0, hottest + 5.0)
    assert (found.low_path, found.high_path) == (GAP, OIL)
    assert found.all_high_degC == pytest.approx(hottest + 8.0)
    assert result.ranges.checks[0].all_worst_margin == pytest.approx(0.05 - 0.01 - 0.02)
    assert [row.path for row in result.ranges.inputs] == [GAP, OIL]
    assert result.ranges.inputs[0].max_temperature_low_degC == pytest.approx(hottest - 8.0)


@pytest.mark.parametrize(
    ("path", "parts"),
    [
        ("limits.clearances.seal_gap_minimum", ()),
        ("limits.dynamics.resonance_distance_minimum", ("curves",)),
        ("limits.dynamics.dynamic_factor_maximum", ()),
        ("schedule.stages.run_up.duration", ("time run",)),
        ("gearboxes.test.oil.inlet_temperature", MODEL_PARTS),
        ("gearboxes.test.heat_split.mesh_into_gears", MODEL_PARTS),
        ("gearboxes.test.housing.wall_thickness", ("coupling",)),
        ("gearboxes.test.bearings.pinion_front.feed_share", ("coupling",)),
        ("gearboxes.test.bearings.pinion_front.position", MODEL_PARTS),
        ("gearboxes.test.meshes.main.damping", MODEL_PARTS),
        ("losses.friction.lubricant_factor", ("coupling",)),
        ("a.key.nobody.has.thought.of", MODEL_PARTS),
    ],
)
def test_an_input_solves_again_what_it_touches_and_an_unknown_one_everything(
    path: str, parts: tuple[str, ...]
) -> None:
    assert parts_of(path) == parts


def test_report_and_json_have_the_ranges_only_where_they_were_evaluated() -> None:
    plain = make_result(dynamics=None, fields=[], expansion=[], losses=[], oil=[])
    assert results_document(plain)["ranges"] is None
    assert "Verdicts over the ranges" not in report_html(plain)
    broken, lost = outcome(142.0, seal_gap=at(-0.03, 1.06, "fail")), outcome(None, "did <not> settle")
    result = ranged(STATED, [*both(GAP, broken, STATED), *both(OIL, lost, STATED)], GAP_CHECK)
    document = results_document(result)["ranges"]
    assert document["checks"][0]["verdict"] == "open"
    assert document["inputs"][1]["low_error"] == "did <not> settle"
    page = report_html(result)
    assert "Verdicts over the ranges" in page and "Checks that an assumption decides" in page
    assert "did &lt;not&gt; settle" in page
    assert page.count("Highest temperature of all housings with one input") == 1


def test_the_figure_of_margins_leaves_out_what_does_not_move() -> None:
    still = ranged(STATED, both(GAP, STATED, STATED), GAP_CHECK)
    assert still.ranges is not None and margins_figure(still.ranges, {}) is None
    ends = both(GAP, outcome(seal_gap=at(0.02, 0.96)), STATED)
    moved = ranged(STATED, ends, GAP_CHECK)
    assert moved.ranges is not None
    figure = margins_figure(moved.ranges, {"seal_gap": "smallest gap"})
    assert figure is not None
    assert [text.get_text() for text in figure.axes[0].get_yticklabels()] == ["smallest gap"]

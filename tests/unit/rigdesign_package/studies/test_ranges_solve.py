"""Ends of ranges solved on a small rig without housing: what is reused is what a full solution gives."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.case import Case
from rigdesign.case.fields import MODEL_PARTS, ModelPart
from rigdesign.results.check import Check
from rigdesign.run.main import run_case
from rigdesign.studies import modified_rig
from rigdesign.studies.assumed_ranges import EndResult, RangeEnd, plan, solve_end, solve_stated, with_ranges
from rigdesign.studies.modified_rig import parts_of
from rigdesign.studies.reference_rig import Reference
from tests.builders.paths import CASES

pytestmark = pytest.mark.whole_run

PROTOTYPE = CASES / "uhcf_prototype"
HEADER = 'name = "small"\ntitle = "small"\n[gearboxes.test]\nremove = ["housing"]\n'
STAGES = (
    ("bracing", "load", 'torque = "10 N m"', "20 ms"),
    ("slow", "run_up", 'speed = "750 rpm"', "200 ms"),
    ("half", "load", "torque_share = 0.5", "20 ms"),
    ("run_up", "run_up", 'speed = "12000 rpm"', "3 s"),
    ("full", "load", "torque_share = 1.0", "50 ms"),
    ("test", "dwell", "held = true", "50 ms"),
)
LOOP = (
    f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\n{HEADER}'
    '[drivetrain.motor]\ntorque_limit = "40 N m"\n[limits.bought_parts.motor]\nlimit = "40 N m"\n'
    '[numerics]\ncurve_speeds = 2\n[schedule]\nremove = ["stages"]\n'
    + "".join(
        f'[[schedule.stages]]\nname = "{name}"\nkind = "{kind}"\n{key}\nduration = "{duration}"\n'
        for name, kind, key, duration in STAGES
    )
)
GIVEN = (
    f'extends = "{(PROTOTYPE / "given_losses.toml").as_posix()}"\n{HEADER}'
    "[gearboxes.test.bearings.pinion_front]\n"
    'feed_share = { value = 1.0, assumed = "all of it", range = [1.0, 1.5] }\n'
)
FLOW, COOLER, TRAVEL = (
    "gearboxes.test.oil.flow", "limits.oil.cooler_power_maximum", "gearboxes.test.seals.pinion.axial_travel"
)  # fmt: skip
SHARE = "gearboxes.test.bearings.pinion_front.feed_share"


def written(folder: Path, text: str) -> Case:
    file = folder / "case.toml"
    file.write_text(text, encoding="utf-8")
    return load_case(file)


@pytest.fixture(scope="module")
def loop(tmp_path_factory: pytest.TempPathFactory) -> tuple[Reference, EndResult]:
    """Reference and stated checks of the power loop, settled."""
    return solve_stated(written(tmp_path_factory.mktemp("loop"), LOOP))


def end(case: Case, path: str, value: str, *more: ModelPart) -> RangeEnd:
    return RangeEnd(
        path=path, together_with=(), end="low", value=value, stated="", case=case.with_value(path, value),
        parts=(*parts_of(path), *more),
    )  # fmt: skip


def differences(one: EndResult, other: EndResult) -> Iterator[tuple[str, float]]:
    """Check -> difference of its distance."""
    assert one.error is None and other.error is None and set(one.checks) == set(other.checks)
    for name, check in one.checks.items():
        if check.distance is not None:
            yield name, abs(check.distance - (other.checks[name].distance or 0.0))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("losses.chamber_density", "20 kg/m3"),
        pytest.param("losses.friction.lubricant_factor", "1.0", marks=pytest.mark.slow),
    ],
)
def test_losses_need_no_march_for_the_torque_of_the_motor(
    loop: tuple[Reference, EndResult], path: str, value: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four times the windage, a quarter more friction: the shifted run against the marched one.

    What the shift leaves out is the lag of the speed control in the run-up, 3 s here. The checks on loads keep
    their stated run: marched with these losses they would move by less than 2 % of their limits. As this is more than
    is listed, gears that become so much warmer are solved in full: that is switched off here.
    """
    reference, stated = loop
    assert solve_end(end(reference.case, path, value), reference=reference).parts == MODEL_PARTS
    monkeypatch.setattr(modified_rig, "LOADS_MOVE", {})
    quick = solve_end(end(reference.case, path, value), reference=reference)
    full = solve_end(end(reference.case, path, value, "time run"), reference=reference)
    assert (quick.parts, full.parts) == (("coupling",), ("coupling", "time run"))
    motor = [outcome.checks["bought_part.motor"].value for outcome in (stated, quick, full)]
    assert None not in motor
    before, shifted, marched = (float(value or 0.0) for value in motor)
    assert marched - before > 0.05
    assert shifted - before == pytest.approx(marched - before, rel=0.03)
    found = dict(differences(quick, full))
    assert max(found.values()) < 0.02
    assert (
        max(gap for name, gap in found.items() if name.startswith(("temperature", "oil", "bearing"))) < 1e-3
    )


def test_a_limit_moves_its_own_check_and_nothing_else(loop: tuple[Reference, EndResult]) -> None:
    reference, stated = loop
    outcome = solve_end(end(reference.case, COOLER, "15 kW"), reference=reference)
    assert outcome.parts == ()
    assert outcome.checks["oil.cooler"].margin == pytest.approx(
        (stated.checks["oil.cooler"].margin or 0.0) - 5.0
    )
    moved = [name for name, gap in differences(outcome, stated) if gap > 1e-9]
    assert moved == ["oil.cooler"]


def test_an_end_is_the_same_whatever_was_solved_before_it(loop: tuple[Reference, EndResult]) -> None:
    """The stated value as an end gives the stated checks; another end in between leaves no trace."""
    reference, stated = loop
    same = end(reference.case, FLOW, "5 l/min")
    first = solve_end(same, reference=reference)
    assert max(gap for _, gap in differences(first, stated)) < 1e-6
    solve_end(end(reference.case, FLOW, "10 l/min"), reference=reference)
    assert solve_end(same, reference=reference) == first


def test_an_end_that_misses_a_stage_passes_nothing_that_needs_it(loop: tuple[Reference, EndResult]) -> None:
    reference, stated = loop
    outcome = solve_end(end(reference.case, "drivetrain.motor.torque_limit", "12 N m"), reference=reference)
    assert outcome.error is None and outcome.checks["bought_part.motor"].verdict != "pass"
    held = outcome.checks["dynamics.dynamic_factor.test"]
    assert held.margin == pytest.approx(stated.checks["dynamics.dynamic_factor.test"].margin)


def test_the_torque_of_a_motor_at_its_limit_is_marched(
    loop: tuple[Reference, EndResult], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(modified_rig, "LOADS_MOVE", {})
    reference, _ = loop
    assert reference.ramp is not None
    most = 1.0001 * float(np.abs(reference.ramp.drive_torque).max())
    tight = reference.case.with_value("drivetrain.motor.torque_limit", f"{most} N m")
    outcome = solve_end(
        end(tight, "losses.chamber_density", "6 kg/m3"), reference=replace(reference, case=tight, key="tight")
    )
    assert outcome.parts == ("coupling", "time run")


def resting(check: Check, *paths: str) -> Check:
    return replace(check, assumptions=paths)


def test_ranges_of_a_case_in_a_worker_process(tmp_path: Path) -> None:
    """Flow and limit solved; the travel decides nothing; a share above 1 is no valid case."""
    case = written(tmp_path, GIVEN)
    run = run_case(case, fidelity="quick")
    on = {"oil.cooler": (FLOW, COOLER), "temperature.oil_outlet": (FLOW,), "bearing.specific_load": (SHARE,)}
    checks = [resting(check, *on.get(check.id, ())) for check in run.checks]
    seen: list[tuple[int, int]] = []
    result = with_ranges(
        case,
        replace(run, checks=checks),
        workers=1,
        count=lambda done, whole, last: seen.append((done, whole)),
    )
    ranges = result.ranges
    assert ranges is not None
    assert seen == [(n, 4) for n in range(1, 5)]
    assert [row.path for row in ranges.inputs] == [FLOW, SHARE, COOLER]
    assert TRAVEL in {row.path for row in ranges.left_out}
    by_path = {row.path: row for row in ranges.inputs}
    assert SHARE in (by_path[SHARE].high_error or "") and by_path[SHARE].low_error is None
    assert by_path[FLOW].solved_again == ("coupling",) and by_path[COOLER].solved_again == ()
    found = {check.id: check for check in result.checks}
    assert found["bearing.specific_load"].verdict == "open"
    assert "no result at" in found["bearing.specific_load"].reason
    outlet = next(row for row in ranges.margins if row.check == "temperature.oil_outlet")
    assert outlet.path == FLOW
    assert (outlet.margin_low or 0.0) < (outlet.margin_high or 0.0)
    assert "ranges" in result.timings_s


def test_bearings_of_one_shaft_move_together_and_stated_ends_are_not_solved() -> None:
    case = load_case(PROTOTYPE)
    path = "gearboxes.test.bearings.{}.width"
    check = Check(
        id="x", title="x", value=1.0, limit=2.0, unit="mm", comparison="<=", margin=1.0, distance=0.5,
        verdict="pass", source="", role="rig",
        assumptions=(path.format("pinion_front"), path.format("pinion_rear"), "losses.chamber_density"),
    )  # fmt: skip
    ends, left = plan(case, [check])
    assert [(e.path, e.end, e.same) for e in ends] == [
        (path.format("pinion_front"), "low", False),
        (path.format("pinion_front"), "high", True),
        ("losses.chamber_density", "low", False),
        ("losses.chamber_density", "high", False),
    ]
    assert ends[0].together_with == (path.format("pinion_rear"),)
    assert ends[0].case is not None
    bearings = ends[0].case.gearboxes["test"].bearings
    assert [bearings[f"{shaft}_rear"].width for shaft in ("pinion", "wheel")] == pytest.approx([0.02, 0.03])
    assert all("no check" in row.reason for row in left)

"""What the pages show, picked and ordered from a result: pure functions, no drawing and no markup."""

import math
from collections.abc import Sequence
from typing import Any

from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.report.numbers import unit_text
from rigdesign.results.check import STATUSES, Check
from rigdesign.results.loads import ModeCrossing
from rigdesign.results.quantity import value_in_unit
from rigdesign.results.result import RunResult
from rigdesign.results.thermal import LossRow

BAR_END = 1.5
"""Share of a limit used up at the right end of a bar in the table of checks."""
MAX_DRIVERS = 4


def sorted_checks(checks: Sequence[Check]) -> list[Check]:
    """Failing checks first, then open ones and advisory limits; within each the farthest beyond its limit first."""
    return sorted(
        checks, key=lambda c: (STATUSES.index(c.status), math.inf if c.distance is None else c.distance)
    )


def applicable(checks: Sequence[Check]) -> list[Check]:
    """Those that apply to the rig."""
    return [check for check in checks if check.verdict != "not applicable"]


def predicted(checks: Sequence[Check]) -> list[Check]:
    """Those that hold a computed value against a limit."""
    return [check for check in applicable(checks) if not check.by_definition]


def stated(checks: Sequence[Check]) -> list[Check]:
    """Those that hold the case against itself."""
    return [check for check in applicable(checks) if check.by_definition]


def inapplicable(checks: Sequence[Check]) -> dict[str, list[Check]]:
    """The others by their reason."""
    found: dict[str, list[Check]] = {}
    for check in checks:
        if check.verdict == "not applicable":
            found.setdefault(check.reason or "no reason given", []).append(check)
    return found


def reservations(checks: Sequence[Check]) -> dict[str, list[Check]]:
    """Open checks by what their value leaves out, the commonest first; a check may stand under several."""
    found: dict[str, list[Check]] = {}
    for check in checks:
        for text in check.left_out if check.verdict == "open" else ():
            found.setdefault(text, []).append(check)
    return dict(sorted(found.items(), key=lambda item: -len(item[1])))


def remarked(checks: Sequence[Check]) -> list[Check]:
    """Checks that are open for a reason of their own or carry a flag, in the order of `sorted_checks`."""
    return [
        check
        for check in sorted_checks(checks)
        if check.flags or (check.verdict == "open" and not check.left_out)
    ]


def specific(result: RunResult, check: Check) -> list[AssumptionRecord]:
    """The assumed inputs that a check depends on, those of few other checks and with a range first."""
    mine = set(check.assumptions)
    records = [record for record in result.assumptions if record.path in mine]
    return sorted(records, key=lambda record: (len(record.decides), record.range is None))


def drivers(result: RunResult) -> list[tuple[Check, list[AssumptionRecord]]]:
    """The checks that decide the verdict, each with the assumptions its value depends on.

    Every failing check, filled up with the others nearest to their limits to ``MAX_DRIVERS``.
    """
    records = {record.path: record for record in result.assumptions}
    ordered = sorted_checks(predicted(result.checks)) or sorted_checks(stated(result.checks))
    failing = sum(check.status == "fail" for check in ordered)
    chosen = ordered[: max(MAX_DRIVERS, failing)]
    return [
        (check, [records.get(p, AssumptionRecord(path=p, value="", reason="")) for p in check.assumptions])
        for check in chosen
    ]


def main_stage(result: RunResult) -> str:
    """The stage that turns over the most heat, shown in the figures of one stage; empty without losses."""
    totals: dict[str, float] = {}
    for row in result.losses:
        totals[row.stage] = totals.get(row.stage, 0.0) + row.power
    return max(totals, key=lambda stage: totals[stage]) if totals else ""


def bar_width(distance: float) -> float:
    """Width of the bar of a check [%], which ends at ``BAR_END``: what of its limit is used up."""
    return 100 * min(max(1.0 - distance, 0.0), BAR_END) / BAR_END


def mesh_errors(result: RunResult) -> list[dict[str, Any]]:
    """What the housing mesh leaves open in every check that depends on it, largest share of the margin first.

    At `reference` with the change that the fine mesh made.
    """
    shifts = {entry.id: entry.shift for entry in result.reference_shift}
    rows = []
    for check in result.checks:
        if check.error is None or check.value is None:
            continue
        share = abs(check.error / check.margin) if check.margin else None
        row = {
            "check": check.title, "value": check.value, "unit": unit_text(check.unit), "margin": check.margin,
            "error": check.error, "error_over_margin": share,
        }  # fmt: skip
        rows.append(row | ({"shift_on_fine_mesh": shifts[check.id]} if check.id in shifts else {}))
    return sorted(rows, key=lambda row: -(row["error_over_margin"] or 0.0))


def columns(rows: list[dict[str, Any]]) -> list[str]:
    """Keys of all records in their order of appearance, lists (curves) left out."""
    keys = dict.fromkeys(key for row in rows for key in row)
    return [key for key in keys if not any(isinstance(row.get(key), list | tuple) for row in rows)]


def loss_table(losses: Sequence[LossRow]) -> tuple[list[str], list[tuple[str, list[float | None]]]]:
    """Stages, and (place, power at each stage [W]) with None where a place has no entry."""
    stages = list(dict.fromkeys(row.stage for row in losses))
    powers: dict[str, dict[str, float]] = {}
    for row in losses:
        at_place = powers.setdefault(row.place, {})
        at_place[row.stage] = at_place.get(row.stage, 0.0) + row.power
    return stages, [(place, [found.get(stage) for stage in stages]) for place, found in powers.items()]


def crossing_table(
    crossings: Sequence[ModeCrossing], names: Sequence[str]
) -> tuple[list[Any], list[tuple[list[Any], list[Any]]]]:
    """Harmonics, and (values of ``names``, speed by harmonic [rpm]) of every natural frequency."""
    harmonics = sorted({item.harmonic for item in crossings})
    speeds: dict[tuple[Any, ...], dict[Any, float]] = {}
    for item in crossings:
        by_harmonic = speeds.setdefault(tuple(value_in_unit(item, name) for name in names), {})
        by_harmonic[item.harmonic] = value_in_unit(item, "speed")
    return harmonics, [(list(key), [found.get(k) for k in harmonics]) for key, found in speeds.items()]


def is_number(value: Any) -> bool:
    """True for what stands right-aligned in a table."""
    return isinstance(value, int | float) and not isinstance(value, bool)

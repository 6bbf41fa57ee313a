"""Which inputs would turn the verdict, by how much: from the ranges of a run, or as the run itself has found."""

from rigdesign.base.units import number_match
from rigdesign.report.numbers import margin_unit, number_text, quantity_text, stated_text
from rigdesign.results.ranges import CheckRange, RangedInput, RangeMargin, RangesResult
from rigdesign.results.result import Flip, RunResult

SHOWN = 4
"""Inputs on the first page."""


def flips(result: RunResult) -> list[Flip]:
    """The inputs nearest to turning the verdict: as the run found them, else from its ranges."""
    if result.flips or result.ranges is None:
        return result.flips[:SHOWN]
    return from_ranges(result.ranges)[:SHOWN]


def searched(result: RunResult) -> str:
    """What was moved to turn which checks, for how long, and what was not looked at; empty where nothing was asked."""
    search, titles = result.flip_search, {check.id: check.title for check in result.checks}
    if search is None:
        return ""
    said = []
    if search.checks:
        aim = "so that they hold" if any(c.status == "fail" for c in result.checks) else "until it fails"
        wanted = ", ".join(titles[name] for name in search.checks)
        turned = {flip.check for flip in result.flips if flip.path}
        outcome = "" if turned else "; none turns it within a factor of five"
        said.append(
            f"Looked at: {wanted}. Moved {aim}, each alone: {', '.join(search.inputs) or 'no input'}, in "
            f"{number_text(result.timings_s.get('flips', 0.0), 2)} s{outcome}."
        )
        if any(c.status == "fail" for c in result.checks) and not any(flip.turns for flip in result.flips):
            said.append("None of them alone turns the verdict.")
    if search.not_searched:
        listed = ", ".join(titles[name] for name in search.not_searched)
        said.append(f"Not looked at, as that would take the run again: {listed}.")
    return " ".join(said)


def within_ranges(result: RunResult) -> list[Flip]:
    """The assumed inputs that turn a check within their ranges, where the run evaluated them."""
    found = [] if result.ranges is None else from_ranges(result.ranges)
    return [flip for flip in found if flip.turns][:SHOWN]


def from_ranges(ranges: RangesResult) -> list[Flip]:
    """Failing checks first, each with the input that moves it furthest; then what would break a check that holds."""
    inputs = {row.path: row for row in ranges.inputs}
    failing = [row for row in ranges.checks if row.verdict_stated == "fail"]
    holding = [row for row in ranges.checks if row.verdict_stated != "fail" and row.decided_by]
    found = [flip for row in failing for flip in _of_check(ranges, row, inputs)[:1]]
    return found + [flip for row in holding for flip in _of_check(ranges, row, inputs)[:1] if flip.turns]


def _of_check(ranges: RangesResult, check: CheckRange, inputs: dict[str, RangedInput]) -> list[Flip]:
    """Every input that moves one check to the other side or nearest to it, the strongest first."""
    if check.margin is None:
        return []
    better = check.margin < 0.0
    rows = [row for row in ranges.margins if row.check == check.check and row.path in inputs]
    ends = [(end, row) for row in rows for end in ("low", "high") if _margin(row, end) is not None]
    ends.sort(key=lambda item: _margin(item[1], item[0]) or 0.0, reverse=better)
    return [_flip(check, inputs[row.path], row, end) for end, row in ends]


def _margin(row: RangeMargin, end: str) -> float | None:
    return row.margin_low if end == "low" else row.margin_high


def _flip(check: CheckRange, given: RangedInput, row: RangeMargin, end: str) -> Flip:
    """One end of one range: does the check change sides on the way there?"""
    at_end = _margin(row, end)
    assert at_end is not None and check.margin is not None
    limit = given.low if end == "low" else given.high
    turned = (at_end >= 0.0) != (check.margin >= 0.0)
    share = check.margin / (check.margin - at_end) if turned else 1.0
    needed = between(given.stated, limit, share) if turned else ""
    side = "holds" if check.margin < 0.0 else "fails"
    margin = quantity_text(at_end, margin_unit(check.unit))
    if turned:
        text = f"{side} from about {needed}" if needed else f"{side} at {stated_text(limit)}"
    else:
        text = f"still {'fails' if check.margin < 0.0 else 'holds'} at {stated_text(limit)}, margin {margin}"
    return Flip(
        path=given.path, title=given.path, holds=check.margin >= 0.0, stated=stated_text(given.stated), needed=needed,
        check=check.check, turns=turned, effect=text,
    )  # fmt: skip


def between(stated: str, end: str, share: float) -> str:
    """The value at ``share`` of the way between two of one unit; empty where they have no number or other units."""
    first, last = number_match(stated), number_match(end)
    if first is None or last is None or first[2] != last[2]:
        return ""
    value = float(first[1]) + share * (float(last[1]) - float(first[1]))
    return stated_text(f"{number_text(value, 3)} {first[2]}".strip())

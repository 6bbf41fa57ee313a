"""Assumed inputs by part of the rig, those with the most influence on the verdicts first."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.report.numbers import stated_text
from rigdesign.results.check import Check
from rigdesign.results.ranges import RangesResult
from rigdesign.results.result import RunResult

NEAR = 0.9
"""Distance from which a check counts as near its limit."""


@dataclass(frozen=True, kw_only=True)
class AssumptionLine:
    """One assumption, or several that say the same of like parts.

    path : relative to its group, names of like parts in braces
    moved : largest shift of a distance over its range; None where the range was not evaluated
    near : checks at or beyond their limit, or near it, that depend on it; checks : all that do
    """

    path: str
    value: str
    range: str
    reason: str
    moved: float | None
    near: int
    checks: int
    count: int = 1

    @property
    def influence(self) -> tuple[float, int, bool, int]:
        """To sort by: what it moves, how much is near, whether it has a range, how much depends on it at all."""
        return (self.moved or 0.0, self.near, bool(self.range), self.checks)


def assumption_groups(result: RunResult) -> dict[str, list[AssumptionLine]]:
    """Lines by part of the rig; groups and lines by falling influence."""
    near = {check.id for check in result.checks if _is_near(check)}
    moved = _moved(result.ranges)
    groups: dict[str, list[tuple[str, AssumptionRecord]]] = {}
    for record in result.assumptions:
        group, rest = _split(record.path)
        groups.setdefault(group, []).append((rest, record))
    lined = {group: _lines(records, near, moved) for group, records in groups.items()}
    return dict(sorted(lined.items(), key=lambda item: item[1][0].influence, reverse=True))


def most_influential(result: RunResult, number: int) -> list[AssumptionLine]:
    """The first of all groups together, with full paths."""
    near = {check.id for check in result.checks if _is_near(check)}
    lines = _lines([(record.path, record) for record in result.assumptions], near, _moved(result.ranges))
    return lines[:number]


def _is_near(check: Check) -> bool:
    return check.verdict == "fail" or (check.distance or 0.0) > NEAR


def _moved(ranges: RangesResult | None) -> dict[str, float]:
    """Largest shift of a distance by path."""
    if ranges is None:
        return {}
    stated = {row.check: row.distance or 0.0 for row in ranges.checks}
    found: dict[str, float] = {}
    for row in ranges.margins:
        ends = (end for end in (row.distance_low, row.distance_high) if end is not None)
        shift = max((abs(end - stated.get(row.check, 0.0)) for end in ends), default=0.0)
        found[row.path] = max(found.get(row.path, 0.0), shift)
    return found


def _split(path: str) -> tuple[str, str]:
    """Part of the rig and the rest: ``gearboxes.test.gears.pinion.teeth`` -> (``test: gears``, ``pinion.teeth``)."""
    parts = path.split(".")
    if parts[0] == "gearboxes" and len(parts) > 3:
        return f"{parts[1]}: {parts[2].replace('_', ' ')}", ".".join(parts[3:])
    depth = 2 if parts[0] == "drivetrain" and len(parts) > 2 else 1
    return ": ".join(part.replace("_", " ") for part in parts[:depth]), ".".join(parts[depth:]) or path


def _lines(
    records: Iterable[tuple[str, AssumptionRecord]], near: set[str], moved: Mapping[str, float]
) -> list[AssumptionLine]:
    """Records that say the same of like parts as one line, by falling influence."""
    alike: dict[tuple[object, ...], list[tuple[str, AssumptionRecord]]] = {}
    for rest, record in records:
        parts = rest.split(".")
        key = (
            len(parts),
            parts[0] if len(parts) > 3 else "",
            parts[-1],
            record.value,
            record.reason,
            record.range,
        )
        alike.setdefault(key, []).append((rest, record))
    lines = [_line(same, near, moved) for same in alike.values()]
    return sorted(lines, key=lambda line: line.influence, reverse=True)


def _line(
    same: Sequence[tuple[str, AssumptionRecord]], near: set[str], moved: Mapping[str, float]
) -> AssumptionLine:
    first = same[0][1]
    decided = {identity for _, record in same for identity in record.decides}
    shifts = [moved[record.path] for _, record in same if record.path in moved]
    return AssumptionLine(
        path=in_braces([rest for rest, _ in same]),
        value=stated_text(first.value),
        range="" if first.range is None else stated_text(f"{first.range[0]} to {first.range[1]}"),
        reason=first.reason,
        moved=max(shifts) if shifts else None,
        near=len(decided & near),
        checks=len(decided),
        count=len(same),
    )


def in_braces(paths: Sequence[str]) -> str:
    """``a.x.k`` and ``a.y.k`` -> ``a.{x,y}.k``; paths of one length."""
    columns = zip(*(path.split(".") for path in paths), strict=True)
    names = (list(dict.fromkeys(column)) for column in columns)
    return ".".join(found[0] if len(found) == 1 else "{" + ",".join(found) + "}" for found in names)

"""Assumed inputs by part of the rig: by what they do to the governing margins where that is known, else by name."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.report.numbers import stated_text
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult

NEAR = 0.1
"""Distance from which a check counts as near its limit."""


@dataclass(frozen=True, kw_only=True)
class AssumptionLine:
    """One assumption, or several that say the same of like parts.

    path : relative to its group, names of like parts in braces
    moved : largest shift of the distance of a governing check over its range; None where it was not evaluated
    """

    path: str
    value: str
    range: str
    reason: str
    moved: float | None
    count: int = 1

    @property
    def order(self) -> tuple[float, str]:
        """To sort by: what it moves, then its path."""
        return -(self.moved or 0.0), self.path


def assumption_groups(result: RunResult) -> dict[str, list[AssumptionLine]]:
    """Lines by part of the rig; groups and lines by what they move, without ranges by name."""
    moved = _moved(result)
    groups: dict[str, list[tuple[str, AssumptionRecord]]] = {}
    for record in result.assumptions:
        group, rest = _split(record.path)
        groups.setdefault(group, []).append((rest, record))
    lined = {group: _lines(records, moved) for group, records in groups.items()}
    return dict(sorted(lined.items(), key=lambda item: (item[1][0].order[0], item[0])))


def most_influential(result: RunResult, number: int) -> list[AssumptionLine]:
    """Those that move a governing margin most, with full paths; none where no range was evaluated."""
    lines = _lines([(record.path, record) for record in result.assumptions], _moved(result))
    return [line for line in lines if line.moved][:number]


def governing_ids(checks: Sequence[Check]) -> set[str]:
    """Checks that fail; without one those with less than `NEAR` of their limit left, else the nearest to it."""
    predicted = [check for check in checks if not check.by_definition]
    left = {check.id: check.distance for check in predicted if check.distance is not None}
    failing = {check.id for check in checks if check.status == "fail"}
    near = {identity for identity, distance in left.items() if distance < NEAR}
    return failing or near or ({min(left, key=lambda identity: left[identity])} if left else set())


def _moved(result: RunResult) -> dict[str, float]:
    """Largest shift of the distance of a governing check by path; every range that was evaluated has one."""
    ranges = result.ranges
    if ranges is None:
        return {}
    governing = governing_ids(result.checks)
    stated = {row.check: row.distance or 0.0 for row in ranges.checks if row.check in governing}
    found = {entry.path: 0.0 for entry in ranges.inputs}
    for row in ranges.margins:
        if row.check in stated:
            ends = (end for end in (row.distance_low, row.distance_high) if end is not None)
            shift = max((abs(end - stated[row.check]) for end in ends), default=0.0)
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
    records: Iterable[tuple[str, AssumptionRecord]], moved: Mapping[str, float]
) -> list[AssumptionLine]:
    """Records that say the same of like parts as one line, in their order."""
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
    return sorted((_line(same, moved) for same in alike.values()), key=lambda line: line.order)


def _line(same: Sequence[tuple[str, AssumptionRecord]], moved: Mapping[str, float]) -> AssumptionLine:
    first = same[0][1]
    shifts = [moved[record.path] for _, record in same if record.path in moved]
    return AssumptionLine(
        path=in_braces([rest for rest, _ in same]),
        value=stated_text(first.value),
        range="" if first.range is None else stated_text(f"{first.range[0]} to {first.range[1]}"),
        reason=first.reason,
        moved=max(shifts) if shifts else None,
        count=len(same),
    )


def in_braces(paths: Sequence[str]) -> str:
    """``a.x.k`` and ``a.y.k`` -> ``a.{x,y}.k``; paths of one length."""
    columns = zip(*(path.split(".") for path in paths), strict=True)
    names = (list(dict.fromkeys(column)) for column in columns)
    return ".".join(found[0] if len(found) == 1 else "{" + ",".join(found) + "}" for found in names)

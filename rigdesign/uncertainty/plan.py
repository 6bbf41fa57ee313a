"""Which assumed inputs are moved to the ends of their ranges."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from rigdesign.base.errors import CaseError
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.reanalysis.affected_parts import Part, parts_of
from rigdesign.results.check import Check
from rigdesign.results.ranges import LeftOut

End = Literal["low", "high"]

ALIKE = ("diameter", "width", "diametral_clearance")
"""What the bearings of one shaft have in common (`case.surfaces`)."""


@dataclass(frozen=True, kw_only=True)
class RangeEnd:
    """One assumed input at one end of its range.

    value, stated : as the case writes them; case : None where that is no valid case, ``error`` then says why
    same : the end is the stated value
    """

    path: str
    together_with: tuple[str, ...]
    end: End
    value: str
    stated: str
    parts: tuple[Part, ...]
    case: Case | None
    error: str | None = None
    same: bool = False


def plan(case: Case, checks: Sequence[Check]) -> tuple[list[RangeEnd], list[LeftOut]]:
    """Both ends of every range that decides something, in the order of the case; and the inputs left out."""
    ends: list[RangeEnd] = []
    left: list[LeftOut] = []
    decisive = {path for check in checks for path in check.assumptions}
    moved: set[str] = set()
    for record in case.assumptions:
        if record.range is None or record.path in moved:
            continue
        if record.path not in decisive:
            left.append(LeftOut(path=record.path, reason="no check that applies depends on it"))
            continue
        ends += _ends(case, record, tied_inputs(case, record))
        moved |= {end_path for end in ends[-2:] for end_path in (end.path, *end.together_with)}
    return ends, left


def tied_inputs(case: Case, record: AssumptionRecord) -> tuple[str, ...]:
    """Paths that have the value of ``record`` in every valid case: the other bearings of its shaft, if so ranged."""
    names = record.path.split(".")
    if len(names) != 5 or names[2] != "bearings" or names[4] not in ALIKE:
        return ()
    bearings = case.gearboxes[names[1]].bearings
    alike = {
        f"gearboxes.{names[1]}.bearings.{other}.{names[4]}"
        for other, bearing in bearings.items()
        if bearing.shaft == bearings[names[3]].shaft and other != names[3]
    }
    same = (record.value, record.range)
    return tuple(r.path for r in case.assumptions if r.path in alike and (r.value, r.range) == same)


def _ends(case: Case, record: AssumptionRecord, tied: tuple[str, ...]) -> Iterator[RangeEnd]:
    assert record.range is not None
    before = case.model_dump()
    ends: tuple[End, End] = ("low", "high")
    for end, value in zip(ends, record.range, strict=True):
        changed, error = None, None
        try:
            changed = changed_together(case, dict.fromkeys((record.path, *tied), value))
        except CaseError as fault:
            error = str(fault)
        yield RangeEnd(
            path=record.path,
            together_with=tied,
            end=end,
            value=str(value),
            stated=record.value,
            parts=parts_of(record.path),
            case=changed,
            error=error,
            same=changed is not None and changed.model_dump() == before,
        )

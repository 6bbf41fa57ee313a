"""Checks and other results that differ between two runs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from rigdesign.difference.reading import CheckValue

LEAST = 1e-6
"""Relative change from which a result counts as moved: above the last digits of another machine."""
RANKS = {"pass": 1, "advisory": 2, "open": 3, "fail": 4}
NOT_APPLICABLE = "not applicable"

Change = Literal[
    "newly failing", "flipped", "now applicable", "no longer applicable", "moved", "added", "removed"
]
"""What became of a check: it fails and did not apply before; another verdict; it applies to one of the results only;
other numbers; one result has it."""
CHANGES: tuple[Change, ...] = get_args(Change)
"""In the order in which they are listed."""


@dataclass(frozen=True, kw_only=True)
class CheckChange:
    """A check that differs; ``before`` or ``after`` is None where one result has it not."""

    id: str
    change: Change
    before: CheckValue | None
    after: CheckValue | None

    @property
    def known(self) -> CheckValue:
        """The later of both."""
        found = self.after or self.before
        assert found is not None
        return found

    @property
    def worse(self) -> bool:
        """Whether it newly fails, or its verdict flipped to a worse one."""
        if self.change == "newly failing":
            return True
        if self.before is None or self.after is None:
            return False
        ranks = (RANKS.get(side.verdict, 0) for side in (self.before, self.after))
        return self.change == "flipped" and next(ranks) < next(ranks)

    @property
    def distance_change(self) -> float | None:
        """Change of the distance, None where one has none."""
        if self.before is None or self.after is None:
            return None
        if self.before.distance is None or self.after.distance is None:
            return None
        return self.after.distance - self.before.distance


@dataclass(frozen=True, kw_only=True)
class QuantityChange:
    """Another result that differs; None where one result has it not."""

    quantity: str
    place: str
    unit: str
    before: float | None
    after: float | None

    @property
    def relative(self) -> float | None:
        """Change over the value before; None for temperatures (their zero means nothing) and without a value."""
        if self.before is None or self.after is None or self.before == 0.0 or self.unit == "degC":
            return None
        return (self.after - self.before) / abs(self.before)


def changed_checks(
    before: Mapping[str, CheckValue], after: Mapping[str, CheckValue]
) -> tuple[CheckChange, ...]:
    """Checks that newly fail, verdicts that flipped (to the worse first), the others; each by change of distance."""
    found = []
    for identity in dict.fromkeys([*before, *after]):
        old, new = before.get(identity), after.get(identity)
        change = _change(old, new)
        if change is not None:
            found.append(CheckChange(id=identity, change=change, before=old, after=new))
    return tuple(
        sorted(
            found,
            key=lambda row: (
                CHANGES.index(row.change),
                not row.worse,
                -abs(row.distance_change or 0.0),
                row.id,
            ),
        )
    )


def _change(before: CheckValue | None, after: CheckValue | None) -> Change | None:
    """What became of a check; None where nothing did."""
    applied = before is not None and before.verdict != NOT_APPLICABLE
    if after is not None and after.verdict == "fail" and not applied:
        return "newly failing"
    if before is None or after is None:
        return "added" if before is None else "removed"
    if before.verdict != after.verdict:
        if before.verdict == NOT_APPLICABLE:
            return "now applicable"
        return "no longer applicable" if after.verdict == NOT_APPLICABLE else "flipped"
    numbers = ("value", "limit", "distance")
    return "moved" if any(_moved(getattr(before, key), getattr(after, key)) for key in numbers) else None


def changed_quantities(
    before: Mapping[tuple[str, str], tuple[float, str]], after: Mapping[tuple[str, str], tuple[float, str]]
) -> tuple[QuantityChange, ...]:
    """Quantities that moved: by kind in the order of the result, the largest change of a kind first."""
    found: dict[str, list[QuantityChange]] = {}
    for key in dict.fromkeys([*before, *after]):
        old, new = before.get(key), after.get(key)
        unit = (new or old or (0.0, ""))[1]
        if old is None or new is None or _moved(old[0], new[0]):
            row = QuantityChange(
                quantity=key[0], place=key[1], unit=unit, before=old and old[0], after=new and new[0]
            )
            found.setdefault(row.quantity, []).append(row)
    return tuple(row for rows in found.values() for row in sorted(rows, key=_by_size))


def _by_size(row: QuantityChange) -> tuple[float, str]:
    return -abs((row.after or 0.0) - (row.before or 0.0)), row.place


def _moved(first: float | None, second: float | None) -> bool:
    if first is None or second is None:
        return first is not second
    return abs(first - second) > LEAST * max(abs(first), abs(second))


def added_and_gone(before: Sequence[str], after: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Texts that only the second has, and only the first, in their order and once each."""
    first, second = dict.fromkeys(before), dict.fromkeys(after)
    return tuple(text for text in second if text not in first), tuple(
        text for text in first if text not in second
    )

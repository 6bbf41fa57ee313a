"""The difference of two results, and its JSON document."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from rigdesign.base.version import __version__
from rigdesign.studies.stored_results import (
    CheckedResults,
    CheckValue,
    InputChange,
    changed_inputs,
    read_results,
)

# Checks and other results that differ between two runs.

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


SCHEMA_VERSION = 1


@dataclass(frozen=True, kw_only=True)
class TextChanges:
    """Assumptions, warnings or omissions that came and went."""

    added: tuple[str, ...]
    gone: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ResultsDifference:
    """How result ``b`` differs from ``a``.

    notices : what else than the inputs may be behind it: fidelity, tool version, another case
    """

    a: CheckedResults
    b: CheckedResults
    notices: tuple[str, ...]
    inputs: tuple[InputChange, ...]
    checks: tuple[CheckChange, ...]
    quantities: tuple[QuantityChange, ...]
    assumptions: TextChanges
    warnings: TextChanges
    not_modelled: TextChanges

    @property
    def flipped(self) -> tuple[CheckChange, ...]:
        """Checks that apply to both and have another verdict."""
        return self.checks_that("flipped")

    def checks_that(self, *changes: Change) -> tuple[CheckChange, ...]:
        """Checks that changed in one of these ways."""
        return tuple(row for row in self.checks if row.change in changes)

    @property
    def same(self) -> bool:
        """Whether nothing differs."""
        texts = (self.assumptions, self.warnings, self.not_modelled)
        return not (self.inputs or self.checks or self.quantities or any(t.added or t.gone for t in texts))


def results_difference(a: Path, b: Path) -> ResultsDifference:
    """Read and compare two results of `rigdesign check`.

    Raises
    ------
    UsageError
        If one of them cannot be read.
    """
    return difference_of(read_results(a), read_results(b))


def difference_of(a: CheckedResults, b: CheckedResults) -> ResultsDifference:
    """Compare two results."""
    return ResultsDifference(
        a=a,
        b=b,
        notices=tuple(_notices(a, b)),
        inputs=changed_inputs(a.inputs, b.inputs),
        checks=changed_checks(a.checks, b.checks),
        quantities=changed_quantities(a.quantities, b.quantities),
        assumptions=_texts(_lines(a.assumptions), _lines(b.assumptions)),
        warnings=_texts([text for _, text in a.warnings], [text for _, text in b.warnings]),
        not_modelled=_texts(a.not_modelled, b.not_modelled),
    )


def headline(difference: ResultsDifference) -> str:
    """Both verdicts and the counts of what is listed, in a sentence."""
    if difference.same:
        return f"nothing differs: {difference.a.verdict} in both"
    a, b = difference.a.verdict, difference.b.verdict
    verdict = f"{a} in both" if a == b else f"{a} → {b}"
    failing, now, no_longer, moved, single = (
        len(difference.checks_that(*changes))
        for changes in (
            ("newly failing",),
            ("now applicable",),
            ("no longer applicable",),
            ("moved",),
            ("added", "removed"),
        )
    )
    counts = [
        f"{_count(len(difference.inputs), 'input')} changed",
        f"{_count(failing, 'check')} newly failing" if failing else "",
        f"{_count(len(difference.flipped), 'verdict')} flipped",
        f"{_count(now, 'check')} now applicable" if now else "",
        f"{_count(no_longer, 'check')} no longer applicable" if no_longer else "",
        f"{_count(moved, 'other check')} moved",
        f"{_count(single, 'check')} in one result only" if single else "",
    ]
    return f"{verdict}: {', '.join(filter(None, counts))}"


def difference_document(difference: ResultsDifference) -> dict[str, Any]:
    """The JSON document of `rigdesign diff --json`."""
    return {
        "schema_version": SCHEMA_VERSION,
        "tool_version": __version__,
        "a": _source(difference.a),
        "b": _source(difference.b),
        "same": difference.same,
        "notices": list(difference.notices),
        "inputs": [_input(row) for row in difference.inputs],
        "checks": [_check(row) for row in difference.checks],
        "results": [asdict(row) | {"relative": row.relative} for row in difference.quantities],
        "assumptions": _lists(difference.assumptions),
        "warnings": _lists(difference.warnings),
        "not_modelled": _lists(difference.not_modelled),
    }


def _notices(a: CheckedResults, b: CheckedResults) -> list[str]:
    found = []
    if a.name != b.name:
        found.append(f"the cases are two: {a.name} and {b.name}")
    if a.fidelity != b.fidelity:
        found.append(
            f"fidelity {a.fidelity} and {b.fidelity}: results also move with the size of the models; "
            "run both at one fidelity to see the inputs alone"
        )
    if a.tool_version != b.tool_version:
        found.append(
            f"rigdesign {a.tool_version} and {b.tool_version}: results also move with the models; "
            "run both with one version to see the inputs alone"
        )
    return found


def _lines(assumptions: Any) -> list[str]:
    return [f"{path}: {reason}" for path, reason in assumptions.items()]


def _texts(before: Any, after: Any) -> TextChanges:
    added, gone = added_and_gone(before, after)
    return TextChanges(added=added, gone=gone)


def _lists(texts: TextChanges) -> dict[str, list[str]]:
    return {"added": list(texts.added), "gone": list(texts.gone)}


def _source(results: CheckedResults) -> dict[str, Any]:
    return {
        "path": str(results.path),
        "case": {"name": results.name, "title": results.title, "hash": results.hash},
        "tool_version": results.tool_version,
        "fidelity": results.fidelity,
        "verdict": results.verdict,
    }


def _input(row: InputChange) -> dict[str, Any]:
    return {
        "path": row.path,
        "change": row.change,
        "before": None if row.before is None else asdict(row.before),
        "after": None if row.after is None else asdict(row.after),
        "relative": row.relative,
    }


def _check(row: CheckChange) -> dict[str, Any]:
    keys = ("verdict", "value", "comparison", "limit", "upper_limit", "margin", "distance", "reason")

    def side(check: Any) -> dict[str, Any] | None:
        return None if check is None else {key: getattr(check, key) for key in keys}

    return {
        "id": row.id,
        "title": row.known.title,
        "unit": row.known.unit,
        "change": row.change,
        "before": side(row.before),
        "after": side(row.after),
        "distance_change": row.distance_change,
    }


def _count(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"

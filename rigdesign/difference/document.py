"""The difference of two results, and its JSON document."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rigdesign.base.version import __version__
from rigdesign.difference.inputs import InputChange, changed_inputs
from rigdesign.difference.reading import CheckedResults, read_results
from rigdesign.difference.results import (
    Change,
    CheckChange,
    QuantityChange,
    added_and_gone,
    changed_checks,
    changed_quantities,
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

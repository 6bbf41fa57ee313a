"""`rigdesign validate`: published numbers beside ours, each with the assumption it depends on.

The rows are data of the package, computed at the default fidelity by ``python -m tests.published`` in the source tree,
where a test holds them current.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from importlib.resources import files
from typing import Any, Literal, get_args

from rigdesign.base.json_text import csv_text
from rigdesign.base.version import __version__

SCHEMA_VERSION = 1
ROWS = "published_rows.json"

Basis = Literal["predicted", "fitted", "arithmetic", "input", "verification"]
RowVerdict = Literal["gate held", "gate missed", "goal met", "goal missed", "shown", "not modelled"]
Published = float | tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class ValidationRow:
    """A published quantity and ours.

    ``basis`` says what agreement is worth: a number that a fit was made to meet is ``fitted``, a textbook or
    benchmark case ``verification``, only ``predicted`` rows count in the headline.
    """

    id: str
    quantity: str
    source: str
    published: Published | None
    """A number, a range, or None where the publication gives words only."""
    published_text: str
    computed: float | None
    unit: str
    deviation: float | None
    """Relative; from the nearer end of a range, zero inside it."""
    tolerance: float | None
    """Largest deviation that holds the gate or meets the goal."""
    verdict: RowVerdict
    basis: Basis
    window: tuple[float, float] | None = None
    """Limits of the computed value where a gate is stated as such, instead of a tolerance."""
    free_parameters: int = 0
    """Inputs that the publication leaves open and that were chosen with this number in view."""
    assumptions: str = ""

    @property
    def computed_text(self) -> str:
        """Our number as printed in tables."""
        return "" if self.computed is None else f"{self.computed:.6g}"


def published_rows() -> tuple[ValidationRow, ...]:
    """Rows that ship with the package."""
    return tuple(_row(given) for given in json.loads((files("rigdesign") / ROWS).read_text("utf-8"))["rows"])


def _row(given: dict[str, Any]) -> ValidationRow:
    pairs: dict[str, tuple[float, float]] = {}
    for name, ends in (("published", (math.nan, math.nan)), ("window", (-math.inf, math.inf))):
        if isinstance(given[name], list):
            low, high = (end if value is None else value for value, end in zip(given[name], ends))
            pairs[name] = (low, high)
    return ValidationRow(**{**given, **pairs})


def headline(rows: Sequence[ValidationRow]) -> dict[str, Any]:
    """Counts of the rows: what is predicted, then gates and goals by basis, then what has no model.

    ``predicted_with_goal`` and ``predicted_met`` count the predicted rows that have a goal or gate and those that
    meet it: they alone say what the model is worth. ``gates`` {basis: {held, missed}} and ``goals`` {basis: {met,
    missed}} name the bases that occur; ``gates_missed`` decides the exit status, ``goals_missed`` does not.
    """
    gates, goals = _by_basis(rows, "gate", ("held", "missed")), _by_basis(rows, "goal", ("met", "missed"))
    predicted = [counts.get("predicted", {}) for counts in (gates, goals)]
    return {
        "rows": len(rows),
        "predicted_with_goal": sum(sum(counts.values()) for counts in predicted),
        "predicted_met": sum(counts.get("held", 0) + counts.get("met", 0) for counts in predicted),
        "gates": gates,
        "goals": goals,
        "gates_held": _total(gates, "held"),
        "gates_missed": _total(gates, "missed"),
        "goals_met": _total(goals, "met"),
        "goals_missed": _total(goals, "missed"),
        "not_modelled": sum(row.verdict == "not modelled" for row in rows),
    }


def _by_basis(
    rows: Sequence[ValidationRow], kind: str, outcomes: tuple[str, str]
) -> dict[str, dict[str, int]]:
    """{basis: {outcome: number of rows}} of the gates or goals, in the order of ``Basis``."""
    counts = {
        basis: {
            outcome: sum(row.basis == basis and row.verdict == f"{kind} {outcome}" for row in rows)
            for outcome in outcomes
        }
        for basis in get_args(Basis)
    }
    return {basis: found for basis, found in counts.items() if any(found.values())}


def _total(counts: dict[str, dict[str, int]], outcome: str) -> int:
    return sum(found[outcome] for found in counts.values())


def validation_document(rows: Sequence[ValidationRow]) -> dict[str, Any]:
    """The JSON document of `rigdesign validate --json`; open ends of a window are null."""
    return {
        "schema_version": SCHEMA_VERSION,
        "tool_version": __version__,
        "headline": headline(rows),
        "rows": [_plain(row) for row in rows],
    }


def validation_json(rows: Sequence[ValidationRow]) -> str:
    """Text of validation.json."""
    return json.dumps(validation_document(rows), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def validation_csv(rows: Sequence[ValidationRow]) -> str:
    """Text of validation.csv, a row each; published numbers as printed."""
    names = [field.name for field in fields(ValidationRow) if field.name not in ("published", "window")]
    return csv_text(names, ([getattr(row, name) for name in names] for row in rows))


def _plain(row: ValidationRow) -> dict[str, Any]:
    return {field.name: _json(getattr(row, field.name)) for field in fields(ValidationRow)}


def _json(value: object) -> object:
    if isinstance(value, tuple):
        return [_json(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value

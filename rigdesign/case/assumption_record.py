"""An assumption of a case as results list it."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class AssumptionRecord:
    """An input marked as assumed in the case file, or left out and replaced by an idealisation."""

    path: str
    value: str
    reason: str
    range: tuple[str | int | float, str | int | float] | None = None
    """Lowest and highest plausible value, as written."""
    decides: tuple[str, ...] = ()
    """Ids of the checks that depend on it."""

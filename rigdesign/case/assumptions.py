"""Assumptions of a case: those it marks, and those it makes by saying nothing, which a report lists as well."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rigdesign.case.gearbox import Gearbox


@dataclass(frozen=True, kw_only=True)
class AssumptionRecord:
    """An input marked as assumed in the case file, or left out and replaced by an idealisation."""

    path: str
    value: str
    reason: str
    range: tuple[str, str] | None = None
    decides: tuple[str, ...] = ()
    """Ids of the checks that depend on it."""


def implied_assumptions(gearboxes: Mapping[str, Gearbox]) -> Iterator[AssumptionRecord]:
    """Inputs that are left out and whose place an idealisation takes, in the order of the case."""
    for name, box in gearboxes.items():
        if box.housing is not None and box.housing.foot_contact is None:
            yield AssumptionRecord(
                path=f"gearboxes.{name}.housing.foot_contact",
                value="perfect",
                reason="not stated: foot and field share their nodes, no joint holds heat back and the field holds "
                "the foot; write a conductance (bolted machined faces about 2000 W/(m2 K), 75 to 7000 plausible)",
            )

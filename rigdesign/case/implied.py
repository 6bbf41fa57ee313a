"""Assumptions a case makes by saying nothing: they belong in the list of a report as much as those it marks."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.results.result import AssumptionRecord

if TYPE_CHECKING:
    from rigdesign.case.model import Case


def implied_assumptions(case: "Case") -> Iterator[AssumptionRecord]:
    """Inputs that are left out and whose place an idealisation takes, in the order of the case."""
    for name, box in case.gearboxes.items():
        if box.housing is not None and box.housing.foot_contact is None:
            yield AssumptionRecord(
                path=f"gearboxes.{name}.housing.foot_contact",
                value="perfect",
                reason="not stated: foot and field share their nodes, no joint holds heat back and the field holds "
                "the foot; write a conductance (bolted machined faces about 2000 W/(m2 K), 75 to 7000 believable)",
            )

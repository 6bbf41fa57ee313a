"""Overload of bought couplings, torque flanges and shafts in the events of a case."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.base.units import KINDS, display
from rigdesign.case.limits import PASSED, BoughtPart
from rigdesign.case.model import Case
from rigdesign.checks.component_limits import GROUP, is_at
from rigdesign.checks.registry import REGISTRY, RuleFamily, Topic
from rigdesign.checks.rules import Rule, hold, not_applicable, not_evaluated, worst
from rigdesign.results.check import NO_LOADS, Check
from rigdesign.results.units import NUMBER

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

KEY = "bought_part_event"


@dataclass(frozen=True, kw_only=True)
class OverloadFamily(RuleFamily):
    """Limits of bought couplings and shafts on their torque in the events."""

    def rules(self, case: Case) -> Iterator[Rule]:
        """The rule of every bought part that the torque of the events passes through."""
        return (_rule(name, part) for name, part in _parts(case))

    def limits_of(self, rule: Rule) -> tuple[str, ...]:
        """The overload of the part, or the limit that stands for it."""
        at = f"limits.bought_parts.{rule.id.partition('.')[2]}"
        return f"{at}.overload", f"{at}.limit"


FAMILY = OverloadFamily(
    key=KEY,
    title="highest dynamic torque in the events",
    procedure=(
        "Time integration through every event: largest torque of a coupling or of the sections of a shaft; in a stop "
        "also the periodic responses passed during run-down. Compared with overload of the part, or with its limit "
        "where none is stated."
    ),
    unit=NUMBER,
    group=GROUP,
    source="limits.bought_parts",
    moved_by=frozenset({"events", "housing"}),
    one_limit_suffices=True,
)


def checks(solved: SolvedRig) -> Iterator[Check]:
    """One for each bought part that the torque of the events passes through."""
    return (_check(solved, name, part) for name, part in _parts(solved.case))


def _parts(case: Case) -> Iterator[tuple[str, BoughtPart]]:
    if case.events:
        for name, part in case.limits.bought_parts.items():
            if part.quantity == "torque_peak" and part.given is None and part.part.startswith(PASSED):
                yield name, part


def _rule(name: str, part: BoughtPart) -> Rule:
    return Rule(
        id=f"{KEY}.{name}", title=f"{part.title} in the events ({part.part})", unit=KINDS[part.kind].display_unit,
        source=part.source, group=GROUP, limit=display(part.overload_si, part.kind),
    )  # fmt: skip


def _check(solved: SolvedRig, name: str, part: BoughtPart) -> Check:
    rule = _rule(name, part)
    if solved.loads is None:
        return not_evaluated(rule, NO_LOADS)
    found = [
        torque for torque in solved.part_torques if torque.event is not None and is_at(torque, part.part)
    ]
    if not found:
        return not_applicable(rule, "no event gives a torque for this part")
    value, where = worst((torque.torque, f"{torque.place}, {torque.where}") for torque in found)
    return hold(rule, display(value, part.kind), where)


REGISTRY.register(Topic(order=61, families=(FAMILY,), checks=checks))

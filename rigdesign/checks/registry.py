"""Where checks register: every family of rules with what it needs, what it leaves out and what moves it.

A check is added by one `RuleFamily` in a topic (or a topic of its own in a new module of this folder) and, if it has a
limit, the key of that limit in `case.limits`. Nothing else lists checks.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.case.fields import Influence
from rigdesign.case.limits import Limits
from rigdesign.case.model import Case
from rigdesign.checks.places import whole_rig
from rigdesign.checks.rules import Comparison, Omission, Rule, hold, not_applicable, not_evaluated, worst
from rigdesign.results.check import NO_HOUSING, NO_LIMIT, NO_LOADS, Check
from rigdesign.results.units import DisplayUnit

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

Values = Iterable[tuple[float, str]]
"""(value [SI], where it occurs)."""
Finder = Callable[["SolvedRig", Check], Iterator[Omission]]
"""What the value of a held check leaves out."""
PATH = re.compile(r"[a-z_0-9]+(?:\.[a-z_0-9]+)+")
"""Paths of the case in the source of a rule."""
SPEEDS = (
    "schedule", "gearboxes.*.gears.*.teeth", "gearboxes.*.gears.*.shaft", "gearboxes.*.gears.*.role",
    "gearboxes.*.meshes.*.pinion", "gearboxes.*.meshes.*.wheel", "drivetrain.couplings.*.shafts",
    "drivetrain.torque_at",
)  # fmt: skip
"""Inputs behind the stated speeds and torques of all shafts: the schedule and the ratios."""


@dataclass(frozen=True)
class Need:
    """What of the solved rig a rule cannot do without."""

    met: Callable[[SolvedRig], bool]
    reason: str
    """Why the rule cannot be evaluated where it is not met."""


LOADS = Need(lambda solved: solved.loads is not None, NO_LOADS)


@dataclass(frozen=True, kw_only=True)
class RuleFamily:
    """Rules that share the beginning of their ids: one of the rig, or one for each of several places."""

    key: str
    """Id of the rule; of several ``key.place``."""
    title: str
    """``{place}`` stands for the place."""
    unit: DisplayUnit
    group: str
    """Section of the report; sections stand in the order of the checks."""
    source: str
    """Where the limit stands, as a path of the case, and the basis of the value; ``{place}`` stands for the place."""
    procedure: str
    """How the value is computed, in words."""
    places: Callable[[Case], Iterable[str]] = whole_rig
    """Where in a case rules of the family hold."""
    limit_keys: tuple[str, ...] = ()
    """Paths of the limits, where the source does not begin with the only one."""
    one_limit_suffices: bool = False
    """Whether any of ``limit_keys`` makes the check apply, each standing for the others."""
    comparison: Comparison = "<="
    needs: Need | None = None
    absent: str | Callable[[SolvedRig], str] = NO_HOUSING
    """Why there is no value where there is none: the rule does not apply, but for want of a housing it is open."""
    unconfirmed: str = ""
    """What of its sources was written from memory and could not be compared with a copy."""
    advisory: bool = False
    """A missed limit does not bind (`rules.Rule`)."""
    housed: bool = False
    """Without a housing there is no value."""
    leaves_out: tuple[Finder, ...] = ()
    """Known contributors that the value does not count, in the order in which they are reported."""
    moved_by: frozenset[Influence] = frozenset()
    """Groups of inputs that move the value, beyond those that move every check (`assumptions`)."""
    only_inputs: tuple[str, ...] | None = None
    """Inputs of a rule that is arithmetic of a few; None for all others."""
    across_gearboxes: bool = False
    """Inputs that move the checks of their own gearbox only move those of the others as well."""
    by_definition: bool = False
    """Value and limit are both commanded by the case, by its schedule or its flows: nothing is predicted."""

    def rule(self, limit: float | None, place: str = "") -> Rule:
        """The rule of one place with its limit [SI]."""
        return Rule(
            id=f"{self.key}.{place}" if place else self.key,
            title=self.title.format(place=place),
            unit=self.unit.name,
            source=self.source.format(place=place),
            group=self.group,
            limit=None if limit is None else self.unit.shown(limit),
            comparison=self.comparison,
            advisory=self.advisory,
            by_definition=self.by_definition,
        )

    def rules(self, case: Case) -> Iterator[Rule]:
        """The rules of a case before anything is solved, without their limits."""
        return (self.rule(None, place) for place in self.places(case))

    def limits_of(self, rule: Rule) -> tuple[str, ...]:
        """Paths of the limits of one of its rules."""
        return self.limit_keys or tuple(PATH.findall(rule.source.partition(";")[0]))[:1]

    def cut_run(self, solved: SolvedRig) -> str:
        """Which stages a rule over the time run lacks and why; empty where it has all."""
        if "time run" not in self.moved_by or solved.run is None or not solved.run.ramp.cut:
            return ""
        end = float(solved.run.ramp.windows.time[-1])
        return (
            f"the stages of the time run after {end:.2f} s, which were not evaluated: {solved.run.ramp.cut}"
        )

    def worst(self, solved: SolvedRig, rule: Rule, values: Values) -> Check:
        """Hold the governing one of some values against a rule of this family, or say why there is none."""
        if rule.limit is None:
            return not_applicable(rule, NO_LIMIT)
        if self.needs is not None and not self.needs.met(solved):
            stated = any(solved.case.origin.value_of.get(path) for path in self.limits_of(rule))
            case = solved.case
            asked = stated or (case.drivetrain is not None and case.losses.basis != "input")
            return (not_evaluated if asked else not_applicable)(rule, self.needs.reason)
        listed = list(values)
        if not listed:
            absent = self.absent if isinstance(self.absent, str) else self.absent(solved)
            missing = self.cut_run(solved) or absent
            lacking = missing != absent or missing in (NO_HOUSING, solved.no_clearances)
            return (not_evaluated if lacking else not_applicable)(rule, missing)
        value, where = worst(listed, smallest=self.comparison == ">=")
        return hold(rule, self.unit.shown(value), where)


@dataclass(frozen=True, kw_only=True)
class RigRule(RuleFamily):
    """One rule of the rig: the worst of all places against one limit of the case."""

    limit: Callable[[Limits], float | None]
    """[SI]"""
    values: Callable[[SolvedRig], Values]

    def check(self, solved: SolvedRig) -> Check:
        """The check of the rig."""
        return self.worst(solved, self.rule(self.limit(solved.case.limits)), self.values(solved))


@dataclass(frozen=True, kw_only=True)
class Topic:
    """Rules of one module."""

    order: int
    """Place in the report."""
    families: tuple[RuleFamily, ...]
    checks: Callable[[SolvedRig], Iterable[Check]]
    """All checks of the topic in the order of the report."""
    of_housing_mesh: bool = False
    """Whether the values depend on the mesh of the housings, so that its refinement tells their errors."""


class Registry:
    """Every registered topic."""

    def __init__(self) -> None:
        self._topics: list[Topic] = []
        self._families: dict[str, RuleFamily] = {}

    def register(self, topic: Topic) -> Topic:
        """Add a topic.

        Raises
        ------
        ValueError
            A family has the key of another one.
        """
        for family in topic.families:
            if family.key in self._families:
                raise ValueError(f"rule {family.key} is registered twice; give each family a key of its own")
            self._families[family.key] = family
        self._topics.append(topic)
        return topic

    def topics(self) -> list[Topic]:
        """All of them in the order of the report."""
        return sorted(self._topics, key=lambda topic: topic.order)

    def families(self) -> list[RuleFamily]:
        """All families by topic, in the order of the report."""
        return [family for topic in self.topics() for family in topic.families]

    def family_of(self, case: Case, check: Check) -> RuleFamily:
        """The family of a check, by its id; of a bought part by its quantity.

        Raises
        ------
        KeyError
            No family has this id.
        """
        key = key_of(case, check)
        while key not in self._families:
            key, dot, _ = key.rpartition(".")
            if not dot:
                raise KeyError(
                    f"no rule is registered for check {check.id}; register its family in rigdesign.checks"
                )
        return self._families[key]


REGISTRY = Registry()


def key_of(case: Case, check: Check) -> str:
    """Id of a check; of a bought part its quantity instead of its name, ``given`` where the case gives the value."""
    group, _, name = check.id.partition(".")
    if group != "bought_part":
        return check.id
    bought = case.limits.bought_parts[name]
    return f"{group}.{bought.quantity if bought.given is None else 'given'}"


def load_topics(package: str, paths: Iterable[str]) -> None:
    """Import every module of a package, so that its topics register."""
    for module in sorted(pkgutil.iter_modules(paths), key=lambda found: found.name):
        importlib.import_module(f"{package}.{module.name}")

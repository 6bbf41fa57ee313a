"""The checks of a case before it is solved, each with its family."""

from collections.abc import Iterator

from rigdesign.case.inputs import is_label
from rigdesign.case.model import Case
from rigdesign.checks.assumptions import depends
from rigdesign.checks.registry import REGISTRY, RuleFamily
from rigdesign.checks.rules import Rule, not_applicable
from rigdesign.results.check import Check


def declared_rules(case: Case) -> Iterator[tuple[RuleFamily, Rule]]:
    """Every rule of a case in the order of the report; those of the thermal history as well."""
    for family in REGISTRY.families():
        for rule in family.rules(case):
            yield family, rule


def declared_checks(case: Case) -> list[Check]:
    """The checks of a case without values."""
    return [not_applicable(rule, "not computed") for _, rule in declared_rules(case)]


def depends_on(case: Case, check: Check, path: str) -> bool:
    """Whether the value or limit of a check depends on an input, by what its family declares."""
    return not is_label(path) and depends(case, check, path)

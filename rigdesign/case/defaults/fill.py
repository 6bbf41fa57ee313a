"""Fills what a case leaves out, topic by topic: later topics build on what earlier ones have filled in."""

import copy
from collections.abc import Mapping
from typing import Any

from rigdesign.case.defaults import drivetrains, gearboxes, housings, runs
from rigdesign.case.defaults.limit_set import fill_limits
from rigdesign.case.defaults.raw_tree import RawTree
from rigdesign.case.defaults.rule import DefaultRule, fill
from rigdesign.case.paths import path_pattern


def rules() -> tuple[DefaultRule, ...]:
    """Every rule in the order in which it is asked.

    Measures of a housing come before the places on its shafts, these before the bores of the gears and the shafts of
    the housing, and all of them before the run.
    """
    housing, parts = list(housings.book.rules), list(gearboxes.book.rules)
    late = [rule for rule in housing if ".housing.shafts" in rule.path or rule.path.endswith(".boundary")]
    seats = [rule for rule in parts if rule.path.endswith(("bore_diameter", "oil.volume"))]
    walls = [rule for rule in housing if rule not in late]
    first = [rule for rule in parts if rule not in seats]
    return (*first, *walls, *drivetrains.book.rules, *seats, *late, *runs.book.rules)


def filled_as_a_whole(path: str) -> bool:
    """Whether a rule fills in the table or list at a path with all that is in it, rather than key by key."""
    if path == "limits" or path_pattern("gearboxes.*.housing.boundary.*").fullmatch(path):
        return True
    return any(not rule.completes and path_pattern(rule.path).fullmatch(path) for rule in rules())


def with_defaults(tree: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of the tree of a case with every key filled in that it leaves out and a rule knows."""
    filled = RawTree(copy.deepcopy(dict(tree)))
    for rule in rules():
        fill(filled, rule)
    fill_limits(filled)
    return filled.root

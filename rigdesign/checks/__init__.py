"""Design checks: every rule of the case held against the solved rig."""

from rigdesign.checks import dynamics, ramp, thermal
from rigdesign.checks.subject import Subject
from rigdesign.results import Check

__all__ = ["Subject", "all_checks"]


def all_checks(subject: Subject) -> list[Check]:
    """Every check in the order of the report."""
    return [*dynamics.checks(subject), *thermal.checks(subject), *ramp.checks(subject)]

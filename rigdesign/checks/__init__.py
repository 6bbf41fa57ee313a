"""Design checks: every rule of the case held against the solved rig."""

from rigdesign.checks import dynamics, ramp, strength, thermal
from rigdesign.checks.assumptions import with_assumptions
from rigdesign.checks.subject import Subject
from rigdesign.results import Check

__all__ = ["Subject", "all_checks"]


def all_checks(subject: Subject) -> list[Check]:
    """Every check in the order of the report, each with the assumed inputs it rests on."""
    checks = [
        *dynamics.checks(subject),
        *strength.checks(subject),
        *thermal.checks(subject),
        *ramp.checks(subject),
    ]
    return [with_assumptions(subject.case, check) for check in checks]

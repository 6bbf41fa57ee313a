"""Design checks: every rule of the case held against the solved rig."""

from rigdesign.checks import alignment, dynamics, ramp, strength, thermal
from rigdesign.checks.assumptions import with_assumptions
from rigdesign.checks.omissions import omissions
from rigdesign.checks.rules import with_error, with_omissions
from rigdesign.records.solved_rig import Subject
from rigdesign.results.result import Check

__all__ = ["Subject", "all_checks", "held_checks"]


def all_checks(subject: Subject) -> list[Check]:
    """Every check in the order of the report, each with its discretisation error and the assumed inputs it rests on."""
    return [
        with_error(with_assumptions(subject.case, check), subject.mesh_errors.get(check.id))
        for check in held_checks(subject)
    ]


def held_checks(subject: Subject) -> list[Check]:
    """Every check in the order of the report with what its value leaves out, without its assumed inputs."""
    held = (
        *dynamics.checks(subject),
        *strength.checks(subject),
        *thermal.checks(subject),
        *alignment.checks(subject),
        *ramp.checks(subject),
    )
    return [with_omissions(check, omissions(subject, check)) for check in held]

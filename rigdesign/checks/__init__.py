"""Design checks: every rule of the case held against the solved rig."""

from rigdesign.checks import alignment, dynamics, ramp, strength, thermal
from rigdesign.checks.assumptions import with_assumptions
from rigdesign.checks.omissions import omissions
from rigdesign.checks.rules import with_error, with_omissions
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.result import Check

__all__ = ["all_checks", "held_checks"]


def all_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report, each with its discretisation error and the inputs it depends on."""
    return [
        with_error(with_assumptions(solved.case, check), solved.mesh_errors.get(check.id))
        for check in held_checks(solved)
    ]


def held_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report with what its value leaves out, without its assumed inputs."""
    held = (
        *dynamics.checks(solved),
        *strength.checks(solved),
        *thermal.checks(solved),
        *alignment.checks(solved),
        *ramp.checks(solved),
    )
    return [with_omissions(check, omissions(solved, check)) for check in held]

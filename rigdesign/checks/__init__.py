"""Design checks: every registered rule held against the solved rig."""

from collections.abc import Iterable

from rigdesign.checks.assumptions import with_assumptions
from rigdesign.checks.omissions import omissions
from rigdesign.checks.registry import REGISTRY, load_topics
from rigdesign.checks.rules import with_error, with_omissions
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check

__all__ = ["all_checks", "estimated_checks", "held_checks", "mesh_checks"]

load_topics(__name__, __path__)


def all_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report, each with its discretisation error and the inputs it depends on."""
    return [with_assumptions(solved.case, check) for check in estimated_checks(solved)]


def estimated_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report with its discretisation error, without its assumed inputs."""
    errors = solved.mesh_errors
    return [with_error(check, errors.get(check.id)) for check in held_checks(solved)]


def held_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report with what its value leaves out, without its assumed inputs."""
    held: Iterable[Check] = (check for topic in REGISTRY.topics() for check in topic.checks(solved))
    return [with_omissions(check, omissions(solved, check)) for check in held]


def mesh_checks(solved: SolvedRig) -> list[Check]:
    """The checks that apply and whose values depend on the mesh of the housings, as bare values against limits."""
    topics = (topic for topic in REGISTRY.topics() if topic.of_housing_mesh)
    return [check for topic in topics for check in topic.checks(solved) if check.value is not None]

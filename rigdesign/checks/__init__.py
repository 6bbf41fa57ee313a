"""Design checks: every registered rule held against the solved rig."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.case.usual import unusual_inputs
from rigdesign.checks.assumptions import depends, with_assumptions
from rigdesign.checks.law_ranges import out_of_range
from rigdesign.checks.omissions import omissions
from rigdesign.checks.registry import REGISTRY, load_topics
from rigdesign.checks.rules import joined, unjudged, with_doubt, with_error, with_omissions
from rigdesign.results.check import Check, Finding, HandCalculation

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import LawSpread, SolvedRig
    from rigdesign.rig.model import Rig

__all__ = ["all_checks", "estimated_checks", "held_checks", "mesh_checks", "of_other_law"]

load_topics(__name__, __path__)


def all_checks(solved: SolvedRig, hand: Sequence[HandCalculation] = ()) -> list[Check]:
    """Every check in the order of the report with its error, what makes it doubtful and the inputs it depends on.

    hand : calculations by hand of this rig
    """
    causes, case = list(_disagreeing(hand)), solved.case
    checks = (_with_doubts(case, check, causes) for check in estimated_checks(solved))
    unusual = list(unusual_inputs(case))
    return [with_assumptions(case, _of_unusual(case, check, unusual)) for check in checks]


def estimated_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report with the error of its value, without its assumed inputs."""
    errors = solved.mesh_errors
    checks = [with_error(check, errors.get(check.id)) for check in held_checks(solved)]
    for spread in solved.law_spreads:
        checks = [of_other_law(check, spread) for check in checks]
    found = out_of_range(solved, {point.point.stage: point.last.losses for point in solved.points})
    checks = [_out_of_range(check, found) for check in checks]
    return [_of_face_positions(solved.rig, check) for check in checks]


def _with_doubts(case: Case, check: Check, causes: Sequence[tuple[tuple[str, ...], str]]) -> Check:
    """A check that fails or is close with what makes its value doubtful.

    causes : calculations by hand that do not agree; a source that could not be confirmed comes first
    """
    if not (check.missed or "close" in check.flags):
        return check
    doubts = [REGISTRY.family_of(case, check).unconfirmed]
    doubts += [text for patterns, text in causes if check.is_one_of(patterns)]
    return with_doubt(check, joined(*doubts)) if any(doubts) else check


def _of_unusual(case: Case, check: Check, paths: Sequence[str]) -> Check:
    """A check in doubt where it depends on inputs outside of their usual range."""
    if check.value is None:
        return check
    moving = [path for path in paths if depends(case, check, path)]
    return with_doubt(check, f"unusual input: {', '.join(moving)}") if moving else check


ENTERS = {
    "sliding loss": ("temperature.*", "flank.scuffing_safety.*", "flank.film_ratio.*"),
    "thermal expansion of": ("clearance.axial_play",),
    "mean gap of seal": ("clearance.seal_gap",),
    "hot diametral clearance of": ("clearance.bearing_clearance",),
    "rise of the shaft at coupling": ("alignment.coupling_offset.*",),
}
"""Beginning of a quantity -> the checks whose value it enters."""
DISAGREES = 0.25
"""Deviation from which a calculation by hand is a cause to doubt the checks that its quantity enters."""
LINE_LOAD_ERROR: Mapping[Fidelity, float] = {"quick": 0.12, "standard": 0.04, "reference": 0.04}
"""Share of the highest stress that the face positions of the influence numbers leave open
(`dynamics.tooth.elastic_segment.NEAR_ENDS`)."""
BY_LINE_LOAD = {
    "specimen.root_stress*": 1.0, "strength.root_safety*": 1.0, "flank.contact_pressure*": 1.0, "flank.*": 0.5
}  # fmt: skip
"""Checks that follow the load over the face -> their share of `LINE_LOAD_ERROR`."""


def _out_of_range(check: Check, findings: Sequence[Finding]) -> Check:
    """A check that depends on what is outside of the range of its law: open if it held, doubtful if not."""
    texts = [finding.text for finding in findings if check.is_one_of(finding.checks)]
    if not texts or check.value is None:
        return check
    cause = joined(texts[0], f"{len(texts) - 1} more like it" if len(texts) > 1 else "")
    return with_doubt(check, cause) if check.missed else unjudged(check, cause)


def of_other_law(check: Check, spread: LawSpread) -> Check:
    """A check with what another law of a loss moves in it added to its error."""
    change = spread.changes.get(check.id, 0.0)
    return with_error(check, (check.error or 0.0) + change, spread.cause) if change else check


def _of_face_positions(rig: Rig, check: Check) -> Check:
    """A check that follows the load over the face with the error of its positions."""
    shares = [share for pattern, share in BY_LINE_LOAD.items() if check.is_one_of((pattern,))]
    if not shares or check.value is None or rig.mesh_stiffness != "influence_numbers":
        return check
    return with_error(
        check, (check.error or 0.0) + LINE_LOAD_ERROR[rig.fidelity] * shares[0] * abs(check.value)
    )


def held_checks(solved: SolvedRig) -> list[Check]:
    """Every check in the order of the report with what its value leaves out, without its assumed inputs."""
    held: Iterable[Check] = (check for topic in REGISTRY.topics() for check in topic.checks(solved))
    return [with_omissions(check, omissions(solved, check)) for check in held]


def mesh_checks(solved: SolvedRig) -> list[Check]:
    """The checks that apply and whose values depend on the mesh of the housings, as bare values against limits."""
    topics = (topic for topic in REGISTRY.topics() if topic.of_housing_mesh)
    return [check for topic in topics for check in topic.checks(solved) if check.value is not None]


def _disagreeing(calculations: Sequence[HandCalculation]) -> Iterator[tuple[tuple[str, ...], str]]:
    """(patterns of check ids, cause of doubt) of every one whose two numbers do not agree."""
    for row in calculations:
        patterns = next((ids for start, ids in ENTERS.items() if row.quantity.startswith(start)), ())
        if patterns and abs(row.computed - row.by_hand) > DISAGREES * abs(row.by_hand):
            numbers = f"{row.computed:.3g} {row.unit}, by hand {row.by_hand:.3g} {row.unit}"
            yield patterns, f"{row.quantity}: {numbers}"

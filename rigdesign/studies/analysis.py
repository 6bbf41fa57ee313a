"""What follows from the points of a study: crossings, swings, probabilities, Sobol indices."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from rigdesign.results.check import Finding
from rigdesign.studies.design import Plan
from rigdesign.studies.result import Crossing, StudyPoint, StudyResult, check_ids
from rigdesign.studies.statistics import crossings_over, swings

if TYPE_CHECKING:
    from rigdesign.case import Case


def analysed(case: "Case", fidelity: str, plan: Plan, points: Sequence[StudyPoint]) -> StudyResult:
    """The result of a study whose points are all known, in the order of the design (a boundary: rising values)."""
    checks = plan.selection.of(check_ids(points))
    result = computed_so_far(case, fidelity, plan, points)
    if plan.search is not None:
        search = plan.search
        ordered = sorted(points, key=lambda point: search.entry.number(point.values[search.entry.path]))
        variation = search.variation(ordered)
        found = list(crossings_over(variation, ordered, checks))
        return replace(
            result,
            variations=[variation],
            points=ordered,
            crossings=found,
            tolerance=search.tolerance,
            warnings=[*result.warnings, *_wide_brackets(found, search.tolerance)],
        )
    if plan.kind == "grid":
        found = [
            entry for variation in plan.variations for entry in crossings_over(variation, points, checks)
        ]
        return replace(result, crossings=found)
    if plan.kind == "one at a time":
        return replace(result, swings=list(swings(plan.ranges, points, checks)))
    return _with_probabilities(result, plan, checks)


def computed_so_far(case: "Case", fidelity: str, plan: Plan, points: Sequence[StudyPoint]) -> StudyResult:
    """The points that are known, without what follows from all of them."""
    return StudyResult(
        case=case,
        fidelity=fidelity,
        design=plan.kind,
        method=plan.method,
        variations=plan.variations,
        points=points,
        checks=plan.selection,
        warnings=[*kept_by_copies(case, plan), *_failed(plan, points)],
    )


def kept_by_copies(case: "Case", plan: Plan) -> Iterator[Finding]:
    """Varied keys that gearboxes made ``like`` another one do not follow."""
    varied = [variation.path for variation in plan.variations]
    for path in varied:
        copies = [copy for copy in case.copies_of(path) if copy not in varied]
        if copies:
            all_boxes = ".".join(["gearboxes", "*", *path.split(".")[2:]])
            text = f"{path} is varied alone: {', '.join(copies)}, taken from it by `like` in the case, keeps its value"
            yield Finding(id="not_carried", text=f"{text}; vary {all_boxes} to move all")


def _wide_brackets(crossings: Sequence[Crossing], tolerance: float) -> Iterator[Finding]:
    """Boundaries between points that could not be brought nearer: a point between them has no result."""
    for entry in crossings:
        if entry.high - entry.low > tolerance * (1.0 + 1e-6):
            yield Finding(
                id="study.boundary",
                text=f"{entry.check}: between {entry.low:g} and {entry.high:g} {entry.unit} only; a point between them "
                f"has no result, so that the tolerance of {tolerance:g} is not reached and the value is that of a "
                "straight line",
            )


def _with_probabilities(result: StudyResult, plan: Plan, checks: Sequence[str]) -> StudyResult:
    from rigdesign.studies.statistics import pass_probabilities, probability_of_all, variance_shares

    points = result.points
    # of the design of Sobol indices the first two pages are independent samples
    samples = points[: 2 * len(points) // (len(plan.ranges) + 2)] if plan.indices else points
    result = replace(
        result,
        probabilities=list(pass_probabilities(samples, checks)),
        all_hold=probability_of_all(samples, checks),
    )
    if not plan.indices:
        return result
    failed = [point for point in points if point.failed]
    if failed:
        text = (
            f"Sobol indices are not given: {len(failed)} of {len(points)} points have no result (the first: "
            f"{str(failed[0].record['error']).partition(chr(10))[0]}), and they need every one; narrow the ranges "
            "to where the case can be computed, or mend the points and run again with --retry"
        )
        return replace(result, warnings=[*result.warnings, Finding(id="study.indices", text=text)])
    paths = [entry.path for entry in plan.ranges]
    return replace(result, indices=list(variance_shares(points, checks, paths, plan.seed)))


def _failed(plan: Plan, points: Sequence[StudyPoint]) -> Iterator[Finding]:
    """Points without result that a count leaves out."""
    failed = [point for point in points if point.failed]
    if failed and plan.kind in ("latin hypercube", "sobol"):
        yield Finding(
            id="study.failed_points",
            text=f"{len(failed)} of {len(points)} points have no result and do not count in the probabilities: what "
            "they would be is not known, and they may lie where checks are broken",
        )

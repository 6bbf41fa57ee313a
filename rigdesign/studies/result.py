"""What a study found: its points and what follows from them, immutable."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from rigdesign.results.check import Check, Verdict
from rigdesign.results.result import Finding, RunResult
from rigdesign.studies.grid import Variation
from rigdesign.studies.selection import CheckSelection

if TYPE_CHECKING:
    from rigdesign.case import Case

Design = Literal["grid", "boundary", "one at a time", "latin hypercube", "sobol"]
"""How the points were chosen."""
Record = dict[str, Any]
"""What is kept of a point: {verdict, max_temperature_degC, checks: [...]} or {error, kind}."""

ALL_CHECKS = CheckSelection()


@dataclass(frozen=True, kw_only=True)
class CheckedPoint:
    """What a study keeps of a computed case."""

    verdict: Verdict
    max_temperature_degC: float | None  # noqa: N815
    """Highest of all housings."""
    checks: Sequence[Check]


def checked_point(result: RunResult) -> CheckedPoint:
    """Of a whole run."""
    hottest = max((item.max_temperature_degC for item in result.thermal), default=None)
    return CheckedPoint(verdict=result.verdict, max_temperature_degC=hottest, checks=result.checks)


@dataclass(frozen=True, kw_only=True)
class StudyPoint:
    """One point of a study with what came of it.

    values : varied values by path
    record : {verdict, max_temperature_degC, checks} of a computed point, {error} of a failed one
    """

    values: dict[str, str]
    failed: bool
    record: Record

    def check(self, identity: str) -> Record | None:
        """The record of a check; None where the point has no result or no such check."""
        return self._checks.get(identity)

    @cached_property
    def _checks(self) -> dict[str, Record]:
        return {check["id"]: check for check in self.record.get("checks", ())}


def check_ids(points: Sequence[StudyPoint]) -> list[str]:
    """Ids of every check that some point has, in the order of their appearance."""
    return list(dict.fromkeys(check["id"] for point in points for check in point.record.get("checks", ())))


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """The value of an input at which a check changes from held to broken, between two computed points.

    A check whose margin rises and falls has several.

    value : in ``unit``, as the study varies it; ``low`` and ``high`` bracket it
    holds : the side of the value on which the check holds
    others : values of the other varied inputs
    """

    check: str
    path: str
    value: float
    low: float
    high: float
    unit: str
    holds: Literal["below", "above"]
    others: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Swing:
    """A check with one input at its two ends, all others as stated: a bar of a tornado plot.

    A distance is None where the point has no result, or the check none there.
    """

    check: str
    path: str
    low: str
    high: str
    distance_stated: float | None
    distance_low: float | None
    distance_high: float | None


@dataclass(frozen=True, kw_only=True)
class PassProbability:
    """Share of the samples in which a check holds, with its 95 % interval (Wilson).

    samples : computed ones to which the check applies; ``failed`` ones have no result and do not count
    """

    check: str
    probability: float
    low: float
    high: float
    samples: int
    failed: int = 0


@dataclass(frozen=True, kw_only=True)
class SobolIndex:
    """Share of the variance of a check's distance that an input causes: alone, and with all its interactions."""

    check: str
    path: str
    first_order: float
    first_order_interval: tuple[float, float]
    total: float
    total_interval: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class StudyResult:
    """All points in the order of the design, and what was found from them.

    method : how the points were chosen, in a sentence
    checks : checks the study is read for
    all_hold : probability that every selected check holds in one rig, of a sampled design
    tolerance : of the values in ``crossings``, of a boundary search [unit of the varied input]
    warnings : what the study does not say, and why
    """

    case: "Case"
    fidelity: str
    design: Design
    variations: Sequence[Variation]
    points: Sequence[StudyPoint]
    method: str = ""
    checks: CheckSelection = ALL_CHECKS
    crossings: Sequence[Crossing] = ()
    swings: Sequence[Swing] = ()
    probabilities: Sequence[PassProbability] = ()
    all_hold: PassProbability | None = None
    indices: Sequence[SobolIndex] = ()
    tolerance: float | None = None
    warnings: Sequence[Finding] = ()

"""What a study found: its points and what follows from them, immutable."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from fnmatch import fnmatchcase
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from rigdesign.base.errors import UsageError, shortened
from rigdesign.results.check import Check, Finding, Verdict
from rigdesign.results.result import RunResult
from rigdesign.results.units import ZERO
from rigdesign.studies.grid import Variation

if TYPE_CHECKING:
    from rigdesign.case import Case
    from rigdesign.postprocessing.solved_rig import SolvedRig

# Which checks a run or study is read for: patterns on their ids, as ``--checks`` gives them.

EXAMPLE = (
    "write --checks 'temperature.*,clearance.*' to take checks, '!specimen.root_stress*' to leave some out"
)
NOT_SELECTED = "not selected"
"""Why a check that ``rigdesign check --checks`` leaves out does not apply."""
NEAREST = 3
"""Ids that a message names for a pattern that matches none."""


class CheckSelection:
    """Checks chosen by patterns on their ids (``*``, ``?``, ``[…]``; letters count by case).

    Every pattern takes the checks it matches; one that starts with ``!`` leaves out those it matches, whatever else
    takes them. Patterns with ``!`` alone leave out of all checks. No pattern selects every check.

    Parameters
    ----------
    patterns : one or several of them a text, joined by commas

    Raises
    ------
    UsageError
        If a pattern is empty.
    """

    def __init__(self, patterns: Iterable[str] = ()) -> None:
        self.patterns = tuple(part.strip() for text in patterns for part in text.split(","))
        for pattern in self.patterns:
            if not pattern.removeprefix("!"):
                raise UsageError(f"--checks {pattern!r}: the pattern is empty; {EXAMPLE}")
        self._taken = [pattern for pattern in self.patterns if not pattern.startswith("!")]
        self._left_out = [pattern[1:] for pattern in self.patterns if pattern.startswith("!")]

    def __str__(self) -> str:
        return ", ".join(self.patterns) or "all checks"

    @property
    def selects_all(self) -> bool:
        """Whether there is no pattern."""
        return not self.patterns

    def require(self, case: "Case", *, transient: bool) -> None:
        """Refuse what :meth:`of` refuses before anything is computed; ``transient``: with the thermal history."""
        self.of(declared_ids(case, transient=transient))

    def applied(self, solved: "SolvedRig", result: "RunResult") -> "RunResult":
        """The result of a run in which the checks that are not selected do not apply, and its verdict then."""
        from rigdesign.checks.rules import not_applicable
        from rigdesign.explanation.keys import declared_rules
        from rigdesign.results.check import Checks, Finding, overall

        if self.selects_all:
            return result
        selected = self.of([check.id for check in result.checks])
        rules = {rule.id: rule for _, rule in declared_rules(solved.case)}
        checks = [
            check if check.id in selected else not_applicable(rules[check.id], NOT_SELECTED)
            for check in result.checks
        ]
        text = f"{len(selected)} of {len(checks)} checks are judged, those that --checks {self} selects"
        return replace(
            result,
            checks=Checks(checks),
            verdict=overall(checks),
            warnings=[
                Finding(id="checks_selected", text=f"{text}; the others do not count"),
                *result.warnings,
            ],
        )

    def of(self, identities: Sequence[str]) -> tuple[str, ...]:
        """The selected ids, in their order.

        Raises
        ------
        UsageError
            If a pattern matches no id, with the nearest ids; if the patterns leave no check over.
        """
        for pattern in (*self._taken, *self._left_out):
            if identities and not _matches(pattern, identities):
                raise UsageError(
                    f"--checks: no check matches {shortened(pattern)!r}; {_nearest(pattern, identities)}"
                )
        taken = _matching(self._taken, identities) if self._taken else set(identities)
        left = taken - _matching(self._left_out, identities)
        if identities and not left:
            raise UsageError(f"--checks {shortened(str(self))!r}: no check is left over; leave fewer out")
        return tuple(identity for identity in identities if identity in left)


def declared_ids(case: "Case", *, transient: bool = False) -> list[str]:
    """Ids of the checks of a case, known before anything is computed.

    transient : with those of the thermal history
    """
    from rigdesign.explanation.keys import declared_rules

    ids = [rule.id for _, rule in declared_rules(case)]
    return ids if transient else [identity for identity in ids if not identity.startswith("transient.")]


def _matches(pattern: str, identities: Iterable[str]) -> list[str]:
    return [identity for identity in identities if fnmatchcase(identity, pattern)]


def _matching(patterns: Iterable[str], identities: Sequence[str]) -> set[str]:
    return {identity for pattern in patterns for identity in _matches(pattern, identities)}


def _nearest(pattern: str, identities: Sequence[str]) -> str:
    """Ids that look like the pattern, else the groups there are."""
    words = pattern.strip("*?[]")
    near = [identity for identity in identities if words and words.lower() in identity.lower()]
    near = near or get_close_matches(words, identities, n=NEAREST, cutoff=0.4)
    if near:
        more = f" and {len(near) - NEAREST} more" if len(near) > NEAREST else ""
        return f"the nearest are {', '.join(near[:NEAREST])}{more}"
    groups = dict.fromkeys(identity.partition(".")[0] for identity in identities)
    named = (f"{group}.*" if _matches(f"{group}.*", identities) else group for group in groups)
    return f"the groups are {', '.join(named)}"


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
    hottest = max((item.max_temperature - ZERO for item in result.thermal), default=None)
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

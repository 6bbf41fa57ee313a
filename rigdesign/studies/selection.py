"""Which checks a run or study is read for: patterns on their ids, as ``--checks`` gives them."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from rigdesign.base.errors import UsageError, shortened

if TYPE_CHECKING:
    from rigdesign.case import Case
    from rigdesign.records.solved_rig import SolvedRig
    from rigdesign.results.result import RunResult

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
        from rigdesign.results.check import Checks, overall
        from rigdesign.results.result import Finding

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

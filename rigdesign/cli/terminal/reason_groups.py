"""Why checks are open, advisory, close or in doubt, by reason: most of them share a few."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import get_args

from rigdesign.checks.rules import CLOSE
from rigdesign.results.check import Check, Flag

OF_GEARBOX = re.compile(r"\bgearbox (\w+)\b")
DECIDED = "decided by assumption "
"""How the doubt of a check begins that does not hold over a range."""


NO_HOUSING, UNEXPANDED = "it has no housing", "its housing is not expanded"
"""Two reasons of one gearbox, of which the first holds the second."""


@dataclass(frozen=True)
class ReasonGroup:
    """Checks that are open, or carry a flag, for one reason."""

    head: str
    """``open``, ``advisory``, ``close`` or ``doubt``."""

    reason: str
    """With the verb in the number of the checks: ``leave out …``."""
    checks: tuple[Check, ...]

    @property
    def text(self) -> str:
        """The checks and the reason: a number of checks, or the id of the only one."""
        who = self.checks[0].id if len(self.checks) == 1 else f"{len(self.checks)} checks"
        return f"{who}{' ' if self.reason.startswith(VERBS) else ': '}{self.reason}"


@dataclass(frozen=True)
class _Cause:
    """One cause.

    kind : advisory, close, error, decided, gearbox, left out, open or doubt
    scope : what the checks of a group have in common beyond the kind: a gearbox, a reason
    what, why : what a value leaves out, and why
    """

    kind: str
    scope: str = ""
    what: str = ""
    why: str = ""


WORDS = {
    "advisory": ("misses a limit that does not bind", "miss limits that do not bind"),
    "close": (
        f"has less than {100 * CLOSE:.0f} % of its limit left",
        f"have less than {100 * CLOSE:.0f} % of their limits left",
    ),
    "error": ("has a margin below the error of its value", "have margins below the errors of their values"),
}
"""Causes without further words, of one check and of several."""
VERBS = ("leave", "has ", "have ", "miss", "is ", "are ")
"""Beginnings of reasons that follow their subject."""
FLAGS: tuple[Flag, ...] = get_args(Flag)
"""Causes that are flags; all others make a check open."""


def reason_groups(checks: Iterable[Check]) -> list[ReasonGroup]:
    """The checks that do not simply pass or fail by cause, open ones first, then the largest group; a check with
    several causes is in several groups."""
    found: dict[tuple[str, str], list[tuple[_Cause, Check]]] = {}
    for check in checks:
        for cause in _causes(check):
            found.setdefault((cause.kind, cause.scope), []).append((cause, check))
    together: dict[tuple[object, ...], list[_Cause]] = {}
    members: dict[tuple[object, ...], tuple[Check, ...]] = {}
    for (kind, scope), entries in found.items():
        own = {check.id: check for _, check in entries}
        key = (kind, *own) if kind == "gearbox" else (kind, scope)
        together.setdefault(key, []).extend(cause for cause, _ in entries)
        members[key] = tuple(own.values())
    groups = [
        ReasonGroup(
            head=kind if (kind := causes[0].kind) in FLAGS else "open",
            reason=_reason(causes, len(members[key])),
            checks=members[key],
        )
        for key, causes in together.items()
    ]
    return sorted(groups, key=lambda group: (group.head != "open", -len(group.checks)))


def _causes(check: Check) -> Iterator[_Cause]:
    """Of its flags, and why it is open, from its record; the words of its reason where nothing else tells."""
    for flag in check.flags:
        yield _Cause(flag, check.reason if flag == "doubt" else "", why=check.reason.rpartition("; ")[2])
    if check.verdict != "open":
        return
    causes = []
    error = check.error
    if error is not None and check.margin is not None and abs(check.margin) < error:
        causes.append(_Cause("error"))
    doubts = [part for part in check.reason.split("; ") if part.startswith(DECIDED)]
    causes += [_Cause("decided", part, why=part) for part in doubts]
    for text in check.left_out:
        what, _, why = text.rpartition(": ")
        box = OF_GEARBOX.search(what)
        kind, scope = ("gearbox", box[1]) if box is not None else ("left out", why if what else text)
        causes.append(_Cause(kind, scope, what or text, why if what else ""))
    yield from causes or [_Cause("open", check.reason, why=check.reason.rpartition("; ")[2])]


def _reason(causes: list[_Cause], number: int) -> str:
    """Words for causes of one kind, with the verb for a number of checks."""
    kind = causes[0].kind
    if kind in WORDS:
        return WORDS[kind][number > 1]
    if kind == "decided":
        return f"{'are' if number > 1 else 'is'} {causes[0].why}"
    if kind in ("open", "doubt"):
        return causes[0].why
    whats = list(dict.fromkeys(cause.what for cause in causes))
    whys = list(dict.fromkeys(cause.why for cause in causes if cause.why))
    if NO_HOUSING in whys and UNEXPANDED in whys:
        whys.remove(UNEXPANDED)
    what = whats[0] if len(whats) == 1 else f"{whats[0]} and {len(whats) - 1} more"
    if kind == "gearbox" and len(whats) > 1:
        what = "effects in gearbox " + " and ".join(dict.fromkeys(cause.scope for cause in causes))
    return f"leave{'' if number > 1 else 's'} out {': '.join([what, '; '.join(whys)] if whys else [what])}"

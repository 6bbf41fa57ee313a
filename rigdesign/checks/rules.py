"""Design rules: a value held against a limit gives a Check with margin, distance, verdict and flags.

Margins are in the unit of the value and positive when the rule holds. Distance is the one measure by which checks of
all kinds are compared; it rises with the margin whatever the comparison, is 0 at the limit and 1 as far away as can be:

    upper limit      margin / limit
    lower limit      margin / value where it holds, so that a safety counts as the stress behind it; margin / limit
                     where it is missed: -1.2 is missed by 120 % of the limit
    window           the nearer of its two limits

Temperatures count from 20 degC, the reference temperature of ISO 1: the zero of their scale means nothing. For a limit
of zero the unit of the check stands in its place, for a negative one its size; an upper limit of zero that holds, where
nothing can be less, has all of it left.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from rigdesign.base.json_text import finite
from rigdesign.results.check import Check, Flag, Role

Comparison = Literal["<=", ">=", "within"]
CLOSE = 0.05
"""A rule that holds with less than this share of its limit left is close to it."""
REFERENCE_TEMPERATURE = 20.0
"""From which every temperature [degC] counts (ISO 1)."""


@dataclass(frozen=True, kw_only=True)
class Rule:
    """What is held against what; everything of a check but the value."""

    id: str
    title: str
    unit: str
    source: str
    group: str
    role: Role = "rig"
    limit: float | None = None
    upper_limit: float | None = None
    comparison: Comparison = "<="
    advisory: bool = False
    """A rule of good practice or a hand check: a missed limit does not bind."""
    by_definition: bool = False
    """The case states the value as well: met to the digit it is met, not near its limit."""


def hold(rule: Rule, value: float, reason: str = "", *, doubt: str = "", undecided: str = "") -> Check:
    """Hold ``value``, in the unit of the rule, against ``rule``.

    reason : how the value came about
    doubt : what makes the value doubtful: a flag beside the verdict
    undecided : why a held rule cannot be judged (a formula outside its range, say): the verdict is open

    Raises
    ------
    ValueError
        The rule has no limit.
    NonFiniteResultError
        Value or limit is NaN or infinite.
    """
    if rule.limit is None:
        raise ValueError(f"rule {rule.id} has no limit; give one or use not_evaluated")
    finite(f"value of check {rule.id}", value)
    finite(f"limit of check {rule.id}", rule.limit)
    finite(f"upper limit of check {rule.id}", rule.limit if rule.upper_limit is None else rule.upper_limit)
    margin, space = _margin(rule, value), distance(rule, value)
    flags: list[Flag] = ["advisory"] if margin < 0.0 and rule.advisory else []
    if margin >= 0.0 and space < CLOSE and not rule.by_definition:
        flags.append("close")
    if doubt:
        flags.append("doubt")
    return Check(
        id=rule.id,
        title=rule.title,
        value=value,
        limit=rule.limit,
        upper_limit=rule.upper_limit,
        unit=rule.unit,
        comparison=rule.comparison,
        margin=margin,
        distance=space,
        verdict="fail" if margin < 0.0 else "open" if undecided else "pass",
        flags=tuple(flags),
        source=rule.source,
        role=rule.role,
        reason=joined(reason, undecided, doubt),
        group=rule.group,
        by_definition=rule.by_definition,
    )


def not_applicable(rule: Rule, reason: str) -> Check:
    """The rule does not apply to this rig; ``reason`` says why."""
    return Check(
        id=rule.id,
        title=rule.title,
        value=None,
        limit=rule.limit,
        upper_limit=rule.upper_limit,
        unit=rule.unit,
        comparison=rule.comparison,
        margin=None,
        distance=None,
        verdict="not applicable",
        source=rule.source,
        role=rule.role,
        reason=reason,
        group=rule.group,
        by_definition=rule.by_definition,
    )


def not_evaluated(rule: Rule, reason: str) -> Check:
    """The rig has what the rule asks for and the model of this run does not: open where there is a limit."""
    check = not_applicable(rule, reason)
    return check if rule.limit is None else replace(check, verdict="open")


def joined(*parts: str) -> str:
    """Parts of a reason as one text."""
    return "; ".join(part for part in parts if part)


def distance(rule: Rule, value: float) -> float:
    """How far ``value`` is from the limit of ``rule`` [-], as the head of this module defines it."""
    datum = REFERENCE_TEMPERATURE if rule.unit == "degC" else 0.0
    lower, upper = _limits(rule)
    ends = []
    if lower is not None:
        margin, scale = value - lower, abs(lower - datum) or 1.0
        ends.append(margin / (scale + max(margin, 0.0)))
    if upper is not None:
        ends.append(1.0 if value <= upper == datum else (upper - value) / (abs(upper - datum) or 1.0))
    return min(ends)


def _margin(rule: Rule, value: float) -> float:
    lower, upper = _limits(rule)
    ends = [] if lower is None else [value - lower]
    return min(ends if upper is None else [*ends, upper - value])


def _limits(rule: Rule) -> tuple[float | None, float | None]:
    """Least and largest value; None where there is no such limit."""
    return (None, rule.limit) if rule.comparison == "<=" else (rule.limit, rule.upper_limit)


@dataclass(frozen=True)
class Omission:
    """A known contributor that the value of a check leaves out."""

    text: str
    size: float | None = None
    """The most by which it would use up the margin, in the unit of the value; None where nothing tells."""


def with_omissions(check: Check, omissions: Sequence[Omission]) -> Check:
    """A check that knows what its value leaves out.

    A held rule is then open, unless the omissions of known size together are less than the margin and there are no
    others; a broken one stays as it is.
    """
    if check.margin is None or not omissions:
        return check
    sizes = [omission.size for omission in omissions]
    known = [size for size in sizes if size is not None]
    undecided = len(known) < len(sizes) or sum(known) >= check.margin
    text = "leaves out " + "; leaves out ".join(omission.text for omission in omissions)
    return replace(
        check,
        left_out=tuple(omission.text for omission in omissions),
        verdict="open" if undecided and check.verdict == "pass" else check.verdict,
        reason=joined(check.reason, text),
    )


def with_error(check: Check, error: float | None, cause: str = "the discretisation") -> Check:
    """A check with the error of its value: one whose margin is smaller than it is open, held or missed.

    cause : what leaves the error, in words
    """
    if error is None or check.margin is None:
        return check
    finite(f"error of check {check.id}", error)
    known = replace(check, error=error)
    if abs(check.margin) >= error:
        return known
    unit = "K" if check.unit == "degC" else check.unit
    return unjudged(known, f"{cause} leaves {error:.2g} {unit} open, more than the margin")


def unjudged(check: Check, cause: str) -> Check:
    """A check that has a value and cannot be judged for a cause outside it, held or missed."""
    flags = tuple(flag for flag in check.flags if flag != "advisory")
    return replace(check, verdict="open", flags=flags, reason=joined(check.reason, cause))


def with_doubt(check: Check, cause: str) -> Check:
    """A check with a cause to doubt its value, beside its verdict."""
    flags = check.flags if "doubt" in check.flags else (*check.flags, "doubt")
    return replace(check, flags=flags, reason=joined(check.reason, cause))


def worst(items: Iterable[tuple[float, str]], *, smallest: bool = False) -> tuple[float, str]:
    """The governing value and where it occurs; the first of equals.

    items : (value, where)

    Raises
    ------
    NonFiniteResultError
        A value is NaN or infinite: it has no place in an order.
    """
    ordered = sorted(items, key=lambda item: finite(item[1], item[0]), reverse=not smallest)
    return ordered[0]

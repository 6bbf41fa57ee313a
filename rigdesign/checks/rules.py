"""Design rules: a value held against a limit gives a Check with margin, utilisation and verdict.

Margins are in the unit of the value and positive when the rule holds. Utilisation is the used share of the
limit, 1 at the limit: value/limit below an upper limit, limit/value above a lower one, the larger of both in a
window. A temperature counts from 20 degC, the reference temperature of ISO 1, wherever it is held: the zero of its
scale means nothing, and from a fixed temperature the utilisation can only rise with the temperature, whatever the
room does. A value beyond a lower limit of zero or below zero is counted as 1 plus the shortfall in limits.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from rigdesign.base.finite import finite
from rigdesign.results.check import Check, Role
from rigdesign.results.verdict import Verdict

Comparison = Literal["<=", ">=", "within"]
WARN_UTILISATION = 0.95
"""A rule that holds with more than this share of its limit used is a warning."""
REFERENCE_TEMPERATURE = 20.0
"""From which every temperature [degC] is counted as used up (ISO 1)."""


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
    warn_only: bool = False
    """A broken rule warns instead of failing (a rule of good practice, not a limit)."""
    by_definition: bool = False
    """The case states the value as well: met to the digit it is met, not near its limit."""

    @property
    def datum(self) -> float:
        """From where the utilisation of an upper limit counts, in ``unit``."""
        return REFERENCE_TEMPERATURE if self.unit == "degC" else 0.0


def hold(rule: Rule, value: float, reason: str = "", *, doubt: str = "") -> Check:
    """Hold ``value``, in the unit of the rule, against ``rule``.

    reason : how the value came about
    doubt : why a held rule is still only a warning (a formula outside its range, say)

    Raises
    ------
    ValueError
        The rule has no limit.
    NonFiniteResultError
        Value or limit is NaN or infinite.
    """
    if rule.limit is None:
        raise ValueError(f"rule {rule.id} has no limit; give one or use not_applicable")
    finite(f"value of check {rule.id}", value)
    finite(f"limit of check {rule.id}", rule.limit)
    finite(f"upper limit of check {rule.id}", rule.limit if rule.upper_limit is None else rule.upper_limit)
    margin = _margin(rule, value)
    utilisation = _utilisation(rule, value)
    return Check(
        id=rule.id,
        title=rule.title,
        value=value,
        limit=rule.limit,
        upper_limit=rule.upper_limit,
        unit=rule.unit,
        comparison=rule.comparison,
        margin=margin,
        utilisation=utilisation,
        verdict=_verdict(rule, margin, utilisation, doubt),
        source=rule.source,
        role=rule.role,
        reason="; ".join(part for part in (reason, doubt) if part),
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
        utilisation=None,
        verdict="not applicable",
        source=rule.source,
        role=rule.role,
        reason=reason,
        group=rule.group,
        by_definition=rule.by_definition,
    )


def overall(checks: Sequence[Check]) -> Literal["pass", "warn", "fail"]:
    """The worst verdict; rules that do not apply do not count."""
    verdicts = {check.verdict for check in checks}
    if "fail" in verdicts:
        return "fail"
    return "warn" if "warn" in verdicts else "pass"


def _margin(rule: Rule, value: float) -> float:
    assert rule.limit is not None
    if rule.comparison == "<=":
        return rule.limit - value
    if rule.comparison == ">=":
        return value - rule.limit
    assert rule.upper_limit is not None
    return min(value - rule.limit, rule.upper_limit - value)


def _utilisation(rule: Rule, value: float) -> float:
    assert rule.limit is not None
    if rule.comparison == "<=":
        return _upper_share(value - rule.datum, rule.limit - rule.datum)
    if rule.comparison == ">=":
        return _lower_share(value, rule.limit)
    assert rule.upper_limit is not None
    return max(_lower_share(value, rule.limit), _upper_share(value, rule.upper_limit))


def _upper_share(value: float, limit: float) -> float:
    if limit > 0:
        return max(0.0, value / limit)
    return 0.0 if value <= limit else 1.0 + (value - limit)


def _lower_share(value: float, limit: float) -> float:
    if limit <= 0:
        return 0.0 if value >= limit else 1.0 + (limit - value)
    if value > 0:
        return limit / value
    return 1.0 + (limit - value) / limit


def _verdict(rule: Rule, margin: float, utilisation: float, doubt: str) -> Verdict:
    if margin < 0:
        return "warn" if rule.warn_only else "fail"
    near = utilisation > WARN_UTILISATION and not rule.by_definition
    return "warn" if doubt or near else "pass"


@dataclass(frozen=True)
class Omission:
    """A known contributor that the value of a check leaves out."""

    text: str
    size: float | None = None
    """The most by which it would use up the margin, in the unit of the value; None where nothing tells."""


def with_omissions(check: Check, omissions: Sequence[Omission]) -> Check:
    """A check that knows what its value leaves out.

    A held rule is then at best a warning, unless the omissions of known size together are less than the margin and
    there are no others; a broken one stays as it is.
    """
    if check.margin is None or not omissions:
        return check
    sizes = [omission.size for omission in omissions]
    known = [size for size in sizes if size is not None]
    open_ = len(known) < len(sizes) or sum(known) >= check.margin
    text = "leaves out " + "; leaves out ".join(omission.text for omission in omissions)
    return replace(
        check,
        left_out=tuple(omission.text for omission in omissions),
        verdict="warn" if open_ and check.verdict == "pass" else check.verdict,
        reason="; ".join(part for part in (check.reason, text) if part),
    )


def with_error(check: Check, error: float | None) -> Check:
    """A check with the discretisation error of its value: a verdict that depends on the discretisation says so.

    A held rule whose margin is smaller than the error is a warning; a broken one stays as it is.
    """
    if error is None or check.margin is None:
        return check
    finite(f"discretisation error of check {check.id}", error)
    known = replace(check, discretisation_error=error)
    if abs(check.margin) >= error:
        return known
    unit = "K" if check.unit == "degC" else check.unit
    doubt = f"the discretisation leaves {error:.2g} {unit} open, more than the margin: refine it"
    return replace(
        known,
        verdict="warn" if check.verdict == "pass" else check.verdict,
        reason="; ".join(part for part in (check.reason, doubt) if part),
    )

"""Numbers that a part cannot have: one fault with key, value, limit and remedy."""

import math
from typing import NoReturn

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.quantity_kinds import ZERO_CELSIUS


def refuse(key: str, given: str, problem: str, remedy: str) -> NoReturn:
    """Raise CaseError with one fault."""
    raise CaseError([Fault(key, given, problem, remedy)])


def require_above(key: str, value: float, unit: str, remedy: str, *, limit: float = 0.0) -> None:
    """Raise CaseError unless ``value`` is finite and above ``limit``."""
    if not (math.isfinite(value) and value > limit):
        refuse(key, _written(value, unit), f"must be above {_written(limit, unit)}", remedy)


def require_at_least(key: str, value: float, unit: str, remedy: str, *, limit: float = 0.0) -> None:
    """Raise CaseError unless ``value`` is finite and at least ``limit``."""
    if not (math.isfinite(value) and value >= limit):
        refuse(key, _written(value, unit), f"must be at least {_written(limit, unit)}", remedy)


def require_share(key: str, value: float, remedy: str, *, zero: bool = True) -> None:
    """Raise CaseError unless ``value`` lies within 0 to 1; ``zero``: whether 0 itself is a share."""
    if not (0.0 <= value <= 1.0 and (zero or value > 0.0)):
        refuse(key, f"{value:.6g}", f"must lie within 0 to 1{'' if zero else ', above 0'}", remedy)


def celsius(temperature: float) -> str:
    """A temperature [K] as a message shows it."""
    return f"{temperature - ZERO_CELSIUS:.4g} degC"


def _written(value: float, unit: str) -> str:
    return f"{value:.6g} {unit}".strip()

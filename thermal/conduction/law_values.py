"""What a law of a film, an exchange or a contact must give."""

import math

from thermal.conditions.boundary import ConditionError


def checked_value(value: float, surface: str, kind: str) -> float:
    """The coefficient [W/(m2 K)] if it is a number of at least zero, else ConditionError."""
    if not (math.isfinite(value) and value >= 0.0):
        raise ConditionError(
            f"{surface}: coefficient of {kind!r} is {value} W/(m2 K); a film law must give a number >= 0"
        )
    return value

"""Names of surfaces with stars."""

import re
from collections.abc import Iterable


def matched(patterns: Iterable[str], names: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Surface -> what each ``*`` stood for, for every name that a pattern fits."""
    known = tuple(names)
    found = {}
    for pattern in patterns:
        expression = re.compile("(.+)".join(re.escape(part) for part in pattern.split("*")))
        for name in known:
            match = expression.fullmatch(name)
            if match is not None:
                found[name] = match.groups()
    return found

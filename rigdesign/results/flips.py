"""What would turn the verdict: immutable records, named as they stand in results.json."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Flip:
    """One input at the value at which the governing check changes between held and broken, all others as stated.

    path : of the input; empty for the limit of the check itself; several that move together share a ``*``
    stated, needed : as the case would write them; ``needed`` is empty where none within the factor looked at does it
    check : the governing check; ``holds`` says whether it holds at the stated value
    """

    path: str
    title: str
    unit: str
    stated: str
    needed: str
    check: str
    holds: bool
    reachable: bool
    text: str
    """The row in words."""

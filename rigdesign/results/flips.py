"""Inputs that would turn failing checks: immutable records, named as they stand in results.json."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Flip:
    """One input at the value at which a check changes between held and broken, all others as stated.

    path : of the input; empty for the limit of the check itself; ``*`` where several move together
    stated, needed : as the case would write them; ``needed`` is empty where no value is known
    check : the check; ``holds`` says whether it holds at the stated value
    turns : whether the verdict turns with it: no other check fails then
    effect : what follows, in words
    """

    path: str
    title: str
    stated: str
    needed: str
    check: str
    holds: bool
    turns: bool
    effect: str


@dataclass(frozen=True, kw_only=True)
class FlipSearch:
    """What was looked at for `Flip` rows.

    inputs : titles of the inputs that were moved, each alone
    checks : ids of the checks that they were to turn; ``not_searched`` the other failing
        ones, which would take the run again
    """

    inputs: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()
    not_searched: tuple[str, ...] = ()

"""Inputs that would turn the verdict: immutable records, named as they stand in results.json."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Flip:
    """One input at the value at which the governing check changes between held and broken, all others as stated.

    path : of the input; empty for the limit of the check itself; ``*`` where several move together
    stated, needed : as the case would write them; ``needed`` is empty where no value is known
    check : the governing check; ``holds`` says whether it holds at the stated value
    turns : whether the verdict turns with it: within the range looked at, and no check breaks that held
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
